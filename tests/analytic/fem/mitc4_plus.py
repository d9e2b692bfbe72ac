"""The shell element MITC4+ itself, written from its papers, on the meshes of shell_course.hpp.

Ko, Lee, Bathe, Comput. Struct. 182 (2017) 404 (membrane); Dvorkin, Bathe, Eng. Comput. 1 (1984) 77 (transverse shear).
Degenerated from a solid: mid-surface bilinear through the nodes, directors exact, 2 x 2 x 2 points. It has no drilling
stiffness; one of 1e-7 G t and less, relative to the surface's own rotation, keeps K regular.

Prints a line for each problem and mesh: name, mesh, thickness, deflection.
"""
import numpy as np

CORNER_R, CORNER_S = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
GAUSS = (-1 / np.sqrt(3), 1 / np.sqrt(3))
N = 16


def grid_point(grid, i, j):
    if grid == "regular":
        return i / N, j / N
    if grid == "mirrored":
        u, v = grid_point("distorted", N - i, j)
        return 1 - u, v
    divide = lambda k: k * (k + 1) / (N * (N + 1))
    bottom, top, left, right = divide(i), 1 - divide(N - i), divide(j), 1 - divide(N - j)
    u = (bottom + (top - bottom) * left) / (1 - (top - bottom) * (right - left))
    return u, left + (right - left) * u


def shape(r, s):
    return (0.25 * (1 + CORNER_R * r) * (1 + CORNER_S * s), 0.25 * CORNER_R * (1 + CORNER_S * s),
            0.25 * CORNER_S * (1 + CORNER_R * r))


def dot(a, B):
    return np.einsum("ek,ekd->ed", a, B)


class Elements:
    """All elements side by side; dofs of one: u and theta of node after node. x, v: corners and directors (e, 4, 3)."""

    def __init__(self, x, v, t):
        self.x, self.v, self.t, self.n = x, v, t, len(x)
        zero, (a, b, c) = np.zeros(v.shape[:2]), np.moveaxis(v, -1, 0)
        self.turned = np.stack([np.stack([zero, c, -b], -1), np.stack([-c, zero, a], -1),
                                np.stack([b, -a, zero], -1)], -2)  # theta x v

    def at(self, r, s):
        """x, v and the operators of u and theta x v with their derivatives in r and s, by name."""
        fields = {}
        for key, weights in zip(("", "_r", "_s"), shape(r, s)):
            fields["x" + key] = np.einsum("i,eik->ek", weights, self.x)
            fields["v" + key] = np.einsum("i,eik->ek", weights, self.v)
            u, w = np.zeros((self.n, 3, 24)), np.zeros((self.n, 3, 24))
            for i in range(4):
                u[:, [0, 1, 2], [6 * i, 6 * i + 1, 6 * i + 2]] = weights[i]
                w[:, :, 6 * i + 3:6 * i + 6] = weights[i] * self.turned[:, i]
            fields["u" + key], fields["w" + key] = u, w
        return fields

    def membrane(self, r, s):
        f = self.at(r, s)
        return (dot(f["x_r"], f["u_r"]), dot(f["x_s"], f["u_s"]),
                0.5 * (dot(f["x_r"], f["u_s"]) + dot(f["x_s"], f["u_r"])))

    def tie(self):
        """Covariant strains that are interpolated: those of the membrane at five places, of shear at four."""
        self.A, self.B = self.membrane(0, 1)[0], self.membrane(0, -1)[0]
        self.C, self.D = self.membrane(1, 0)[1], self.membrane(-1, 0)[1]
        self.E = self.membrane(0, 0)[2]
        f = self.at(0, 0)
        normal = np.cross(f["x_r"], f["x_s"])
        area = np.linalg.norm(normal, axis=1)[:, None]
        normal /= area
        x_d = 0.25 * np.einsum("i,eik->ek", CORNER_R * CORNER_S, self.x)
        c_r = np.sum(x_d * np.cross(f["x_s"], normal), 1, keepdims=True) / area
        c_s = np.sum(x_d * np.cross(normal, f["x_r"]), 1, keepdims=True) / area
        d = c_r**2 + c_s**2 - 1
        self.bent = (c_r * (c_r - 1) * self.A + c_r * (c_r + 1) * self.B + c_s * (c_s - 1) * self.C +
                     c_s * (c_s + 1) * self.D + 4 * c_r * c_s * self.E) / (2 * d)  # a_A A + a_B B + ...
        shear_r = lambda f: 0.25 * self.t * (dot(f["x_r"], f["w"]) + dot(f["v"], f["u_r"]))
        shear_s = lambda f: 0.25 * self.t * (dot(f["x_s"], f["w"]) + dot(f["v"], f["u_s"]))
        self.shear = (shear_r(self.at(0, 1)), shear_r(self.at(0, -1)), shear_s(self.at(1, 0)), shear_s(self.at(-1, 0)))

    def strains(self, r, s, f):
        """Covariant strains as polynomials of zeta: rr, ss, rs by 1, zeta, zeta^2; the two transverse shears."""
        h = 0.5 * self.t
        A, B, C, D, bent = self.A, self.B, self.C, self.D, self.bent
        rr = [0.5 * (A + B) + 0.5 * s * (A - B) + (s * s - 1) * bent,
              h * (dot(f["x_r"], f["w_r"]) + dot(f["v_r"], f["u_r"])), h * h * dot(f["v_r"], f["w_r"])]
        ss = [0.5 * (C + D) + 0.5 * r * (C - D) + (r * r - 1) * bent,
              h * (dot(f["x_s"], f["w_s"]) + dot(f["v_s"], f["u_s"])), h * h * dot(f["v_s"], f["w_s"])]
        rs = [self.E + 0.25 * r * (A - B) + 0.25 * s * (C - D) + r * s * bent,
              0.5 * h * (dot(f["x_r"], f["w_s"]) + dot(f["v_s"], f["u_r"]) + dot(f["x_s"], f["w_r"]) +
                         dot(f["v_r"], f["u_s"])),
              0.5 * h * h * (dot(f["v_r"], f["w_s"]) + dot(f["v_s"], f["w_r"]))]
        up, down, right, left = self.shear
        return rr, ss, rs, 0.5 * (1 + s) * up + 0.5 * (1 - s) * down, 0.5 * (1 + r) * right + 0.5 * (1 - r) * left

    def stiffness(self, E, nu, drilling):
        self.tie()
        G, h = 0.5 * E / (1 + nu), 0.5 * self.t
        Q = np.zeros((5, 5))
        Q[:2, :2] = E / (1 - nu * nu) * np.array([[1, nu], [nu, 1]])
        Q[2, 2], Q[3, 3], Q[4, 4] = G, 5 / 6 * G, 5 / 6 * G
        K = np.zeros((self.n, 24, 24))
        for r in GAUSS:
            for s in GAUSS:
                f = self.at(r, s)
                rr, ss, rs, rz, sz = self.strains(r, s, f)
                for z in GAUSS:
                    g_r, g_s, g_z = f["x_r"] + z * h * f["v_r"], f["x_s"] + z * h * f["v_s"], h * f["v"]
                    volume = np.sum(np.cross(g_r, g_s) * g_z, 1)
                    contravariant = np.linalg.inv(np.stack([g_r, g_s, g_z], 1))
                    e_3 = np.cross(g_r, g_s)
                    e_3 /= np.linalg.norm(e_3, axis=1)[:, None]
                    e_1 = np.cross(g_s, e_3)
                    e_1 /= np.linalg.norm(e_1, axis=1)[:, None]
                    to_local = np.einsum("eak,eki->eai", np.stack([e_1, np.cross(e_3, e_1), e_3], 1), contravariant)
                    covariant = np.zeros((self.n, 3, 3, 24))
                    at_z = lambda e: e[0] + z * e[1] + z * z * e[2]
                    covariant[:, 0, 0], covariant[:, 1, 1] = at_z(rr), at_z(ss)
                    covariant[:, 0, 1] = covariant[:, 1, 0] = at_z(rs)
                    covariant[:, 0, 2] = covariant[:, 2, 0] = rz
                    covariant[:, 1, 2] = covariant[:, 2, 1] = sz
                    local = np.einsum("eai,ebj,eijd->eabd", to_local, to_local, covariant, optimize=True)
                    B = np.stack([local[:, 0, 0], local[:, 1, 1], 2 * local[:, 0, 1], 2 * local[:, 0, 2],
                                  2 * local[:, 1, 2]], 1)
                    K += np.einsum("eai,ab,ebj,e->eij", B, Q, B, volume, optimize=True)
                normal = np.cross(f["x_r"], f["x_s"])
                area = np.linalg.norm(normal, axis=1)[:, None]
                normal /= area
                spin = 0.5 * (dot(np.cross(normal, np.cross(f["x_s"], normal)), f["u_r"]) +
                              dot(np.cross(normal, np.cross(normal, f["x_r"])), f["u_s"])) / area
                for i, weight in enumerate(shape(r, s)[0]):
                    spin[:, 6 * i + 3:6 * i + 6] -= weight * normal
                K += drilling * G * self.t * np.einsum("ei,ej,e->eij", spin, spin, area[:, 0])
        return K


def deflections(grid, surface, t, E, nu, load, held, drilling=1e-7):
    """surface(u, v) -> point, normal; load(x, cells) -> f; held(x, d)."""
    places = [surface(*grid_point(grid, i, j)) for j in range(N + 1) for i in range(N + 1)]
    x, v = (np.array([p[k] for p in places]) for k in (0, 1))
    cells = np.array([[j * (N + 1) + i, j * (N + 1) + i + 1, (j + 1) * (N + 1) + i + 1, (j + 1) * (N + 1) + i]
                      for j in range(N) for i in range(N)])
    dofs = (6 * cells[:, :, None] + np.arange(6)).reshape(-1, 24)
    K = np.zeros((6 * len(x), 6 * len(x)))
    np.add.at(K, (dofs[:, :, None], dofs[:, None, :]), Elements(x[cells], v[cells], t).stiffness(E, nu, drilling))
    free = np.array([not held(p, d) for p in x for d in range(6)])
    u = np.zeros(6 * len(x))
    u[free] = np.linalg.solve(K[np.ix_(free, free)], load(x, cells)[free])
    return u


def zero(a):
    return abs(a) < 1e-9


def symmetric(x, d, axis):
    return zero(x[axis]) and (d == axis if d < 3 else d - 3 != axis)


def cylinder(angle, radius, length):
    def surface(u, v):
        n = np.array([np.sin(angle * u), 0, np.cos(angle * u)])
        return radius * n + np.array([0, length * v, 0]), n

    return surface


def roof(grid):
    def load(x, cells):
        f = np.zeros(6 * len(x))
        for r in GAUSS:
            for s in GAUSS:
                weights, along_r, along_s = shape(r, s)
                area = np.linalg.norm(np.cross(np.einsum("i,eik->ek", along_r, x[cells]),
                                               np.einsum("i,eik->ek", along_s, x[cells])), axis=1)
                for i in range(4):
                    np.add.at(f, 6 * cells[:, i] + 2, -90 * weights[i] * area)
        return f

    held = lambda x, d: symmetric(x, d, 0) or symmetric(x, d, 1) or (zero(x[1] - 25) and d in (0, 2))
    return -deflections(grid, cylinder(np.radians(40), 25, 25), 0.25, 4.32e8, 0.0, load, held)[6 * N + 2]


def pinched_cylinder(grid):
    def load(x, cells):
        f = np.zeros(6 * len(x))
        f[2] = -0.25
        return f

    held = lambda x, d: any(symmetric(x, d, a) for a in range(3)) or (zero(x[1] - 300) and d in (0, 2))
    return -deflections(grid, cylinder(np.pi / 2, 300, 300), 3.0, 3e6, 0.3, load, held)[2]


def hemisphere(grid, t):
    def surface(u, v):
        around, up = 0.5 * np.pi * u, 0.4 * np.pi * v
        n = np.array([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)])
        return 10 * n, n

    def load(x, cells):
        f = np.zeros(6 * len(x))
        f[0], f[6 * N + 1] = 1, -1
        return f

    held = lambda x, d: symmetric(x, d, 0) or symmetric(x, d, 1) or (d == 2 and zero(x[1]) and zero(x[2]))
    return (t / 0.04)**3 * deflections(grid, surface, t, 6.825e7, 0.3, load, held, min(1e-7, 1e-5 * t * t))[0]


def ring(grid, t):
    def surface(u, v):
        n = np.array([np.cos(0.5 * np.pi * u), 0, np.sin(0.5 * np.pi * u)])
        return n + np.array([0, v, 0]), -n  # as the nodes go round

    def load(x, cells):
        f = np.zeros(6 * len(x))
        for j in range(N):
            low, high = j * (N + 1), (j + 1) * (N + 1)
            for k in (low, high):
                f[6 * k] += 0.25 * (x[high][1] - x[low][1])
        return f

    held = lambda x, d: any(symmetric(x, d, a) for a in range(3))
    return 2 * deflections(grid, surface, t, 1.0, 0.0, load, held, min(1e-7, 1e-3 * t * t))[0]


for grid in ("regular", "distorted", "mirrored"):
    print("roof", grid, 0.25, roof(grid))
    print("cylinder", grid, 3.0, pinched_cylinder(grid))
    for t in (0.04, 0.004, 0.0004):
        print("hemisphere", grid, t, hemisphere(grid, t))
    for t in (1e-2, 1e-3, 1e-4, 1e-5):
        print("ring", grid, t, ring(grid, t))
