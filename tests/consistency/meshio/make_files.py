"""Writes meshes by meshio in the formats that tenon reads, each with a .truth file of what it holds.

usage: make_files.py FOLDER COUNT
"""
import sys

import meshio
import numpy as np

WIDTHS = dict(vertex=1, line=2, line3=3, triangle=3, triangle6=6, quad=4, quad8=8, quad9=9, tetra=4, tetra10=10,
              hexahedron=8, hexahedron20=20, hexahedron27=27, wedge=6, wedge15=15, wedge18=18, pyramid=5, pyramid13=13)
try:  # meshio 5.0 does not know the dimension of some types that its formats hold
    from meshio._mesh import topological_dimension

    WIDTHS = {name: width for name, width in WIDTHS.items() if name in topological_dimension}
except ImportError:
    pass
ABAQUS = ["line", "triangle", "triangle6", "quad", "quad8", "quad9", "tetra", "tetra10", "hexahedron", "hexahedron20",
          "wedge", "wedge15"]
MED = ["vertex", "quad", "quad8", "line", "line3", "triangle", "triangle6"]  # it does not turn solids as MED does
NASTRAN = ["line", "quad", "triangle", "quad8", "triangle6"]  # in the order in which tenon keeps its blocks
FORMATS = {
    "vtu-ascii": ("vtu", dict(binary=False), 11),
    "vtu-zlib": ("vtu", dict(binary=True), 17),
    "vtu-raw": ("vtu", dict(binary=True, compression=None), 17),
    "vtu-wide": ("vtu", dict(binary=True, header_type="UInt64"), 17),
    "vtk42-ascii": ("vtk42", dict(binary=False), 16),
    "vtk42-binary": ("vtk42", dict(binary=True), 17),
    "vtk51-ascii": ("vtk51", dict(binary=False), 16),
    "vtk51-binary": ("vtk51", dict(binary=True), 17),
    "gmsh22-ascii": ("gmsh22", dict(binary=False), 16),
    "gmsh22-binary": ("gmsh22", dict(binary=True), 17),
    "gmsh41-ascii": ("gmsh", dict(binary=False), 16),
    "gmsh41-binary": ("gmsh", dict(binary=True), 17),
    "abaqus": ("abaqus", dict(), 16),
    "xdmf-text": ("xdmf", dict(data_format="XML"), 16),
    "xdmf-binary": ("xdmf", dict(data_format="Binary"), 17),
    "xdmf-hdf": ("xdmf", dict(data_format="HDF"), 17),
    "med": ("med", dict(), 17),
    "nastran": ("nastran", dict(), 15),
}
ENDINGS = {"vtu": "vtu", "vtk42": "vtk", "vtk51": "vtk", "gmsh22": "msh", "gmsh": "msh", "abaqus": "inp", "xdmf": "xdmf",
           "med": "med", "nastran": "bdf"}


def random_mesh(rng, types, cell_numbers, one_type):
    n_points = int(rng.integers(27, 90))
    points = rng.normal(size=(n_points, 3)) * 10.0 ** rng.integers(-3, 4)
    chosen = [t for t in types if rng.random() < 0.5] or [types[0]]
    if one_type:  # meshio's limit for Gmsh 4.1
        chosen = [types[rng.integers(len(types))]]
    cells, number = [], []
    for t in chosen:
        nodes = [rng.permutation(n_points)[:WIDTHS[t]] for _ in range(int(rng.integers(1, 6)))]
        distinct = {tuple(sorted(n)): n for n in nodes}  # MSH 2 cannot tell two equal cells from one in two groups
        cells.append((t, np.array(list(distinct.values()))))
        number.append(rng.integers(1, 4, size=len(distinct)))
    data = {"T": rng.normal(size=n_points), "u": rng.normal(size=(n_points, 3))} if cell_numbers else {}
    return meshio.Mesh(points, cells, point_data=data, cell_data={"part": number} if cell_numbers else {})


def write_truth(path, mesh, digits):
    with open(path, "w") as out:
        out.write(f"digits {digits}\npoints {len(mesh.points)}\n")
        for x in mesh.points:
            out.write(" ".join(repr(float(v)) for v in x) + "\n")
        for block in mesh.cells:
            out.write(f"cells {block.type} {len(block.data)}\n")
            for nodes in block.data:
                out.write(" ".join(str(int(n)) for n in nodes) + "\n")
        for name, values in mesh.point_data.items():
            rows = np.asarray(values).reshape(len(mesh.points), -1)
            out.write(f"point_data {name} {rows.shape[1]}\n")
            for row in rows:
                out.write(" ".join(repr(float(v)) for v in row) + "\n")
        for name, blocks in mesh.cell_data.items():
            out.write(f"cell_data {name}\n")
            for values in blocks:
                out.write(" ".join(str(int(v)) for v in values) + "\n")


def main():
    folder, count = sys.argv[1], int(sys.argv[2])
    rng = np.random.default_rng(20170401)
    for k in range(count):
        for name, (kind, options, digits) in FORMATS.items():
            types = dict(abaqus=[t for t in ABAQUS if t in WIDTHS], med=MED, nastran=NASTRAN).get(kind, list(WIDTHS))
            if kind.startswith("gmsh"):
                types.remove("wedge18")  # which meshio 5.0 writes in VTK's order
            mesh = random_mesh(rng, types, kind.startswith("vt") or kind in ("xdmf", "med"), kind == "gmsh")
            if kind == "nastran":  # what sixteen columns hold: meshio stops at some numbers of more digits
                mesh.points = np.vectorize(lambda x: float(f"{x:.7g}"))(mesh.points)
            stem = f"{folder}/{name}-{k}"
            write_truth(f"{stem}.truth", mesh, digits)
            meshio.write(f"{stem}.{ENDINGS[kind]}", mesh, file_format=kind, **options)


main()
