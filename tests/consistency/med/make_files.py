"""Writes meshes by MED-fichier, the library of the format itself (Debian's python3-med).

usage: make_files.py FOLDER
"""
import sys

from med.medenum import *
from med.medfamily import *
from med.medfield import *
from med.medfile import *
from med.medmesh import *

NOW = (MED_NO_DT, MED_NO_IT)


def names(width, *words):
    return "".join(f"{word:<{width}}" for word in words)


def create(path, minor=None, kind=MED_UNSTRUCTURED_MESH, axes=MED_CARTESIAN, mesh="part", space=3, unit="mm"):
    version = (3, 3, 1) if minor == 3 else (4, 1, 0)
    file = MEDfileVersionOpen(path, MED_ACC_CREAT, *version)
    add_mesh(file, mesh, kind, axes, space, unit)
    return file


def add_mesh(file, mesh, kind=MED_UNSTRUCTURED_MESH, axes=MED_CARTESIAN, space=3, unit="mm"):
    MEDmeshCr(file, mesh, space, 2, kind, "", "s", MED_SORT_DTIT, axes, names(16, *"xyz"[:space]),
              names(16, *[unit] * space))


def add_points(file, points, mesh="part", step=NOW):
    flat = [float(x) for point in points for x in point]
    MEDmeshNodeCoordinateWr(file, mesh, *step, 0.0, MED_FULL_INTERLACE, len(points), MEDFLOAT(flat))


def add_cells(file, kind, cells, mesh="part"):
    flat = [node for cell in cells for node in cell]
    MEDmeshElementConnectivityWr(file, mesh, *NOW, 0.0, MED_CELL, kind, MED_NODAL, MED_FULL_INTERLACE, len(cells),
                                 MEDINT(flat))


def add_family(file, name, number, groups):
    MEDfamilyCr(file, "part", name, number, len(groups), MEDCHAR(names(80, *groups)))


def of_families(file, entity, kind, numbers):
    MEDmeshEntityFamilyNumberWr(file, "part", *NOW, entity, kind, len(numbers), MEDINT(numbers))


def numbered(file, entity, kind, numbers):
    MEDmeshEntityNumberWr(file, "part", *NOW, entity, kind, len(numbers), MEDINT(numbers))


def add_field(file, name, entity, kind, rows, step=NOW, create=True, whole=False):
    width = len(rows[0])
    if create:
        MEDfieldCr(file, name, MED_INT32 if whole else MED_FLOAT64, width, names(16, *["a"] * width),
                   names(16, *["u"] * width), "s", "part")
    MEDfieldValueWr(file, name, *step, 0.0, entity, kind, MED_FULL_INTERLACE, MED_ALL_CONSTITUENT, len(rows),
                    (MEDINT if whole else MEDFLOAT)([x for row in rows for x in row]))


def plate(path, minor):
    """A quad, a triangle and two lines, groups that overlap, numbers with gaps, fields of nodes and of cells."""
    file = create(path, minor)
    add_points(file, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.25), (2, 0.5, 0)])
    add_cells(file, MED_QUAD4, [(1, 2, 3, 4)])
    add_cells(file, MED_SEG2, [(1, 2), (2, 5)])
    add_cells(file, MED_TRIA3, [(2, 5, 3)])
    add_family(file, "FAMILLE_ZERO", 0, [])
    add_family(file, "1", -1, ["skin", "all of it"])
    add_family(file, "2", -2, ["edge"])
    add_family(file, "3", -3, ["all of it"])
    add_family(file, "4", 4, ["tip"])
    of_families(file, MED_CELL, MED_QUAD4, [-1])
    of_families(file, MED_CELL, MED_SEG2, [0, -2])
    of_families(file, MED_CELL, MED_TRIA3, [-3])
    of_families(file, MED_NODE, MED_NO_GEOTYPE, [0, 0, 0, 0, 4])
    numbered(file, MED_NODE, MED_NO_GEOTYPE, [10, 20, 30, 40, 50])
    numbered(file, MED_CELL, MED_QUAD4, [7])
    numbered(file, MED_CELL, MED_SEG2, [3, 4])
    numbered(file, MED_CELL, MED_TRIA3, [11])
    add_field(file, "u", MED_NODE, MED_NO_GEOTYPE, [(i, 10.0 * i) for i in range(5)])
    add_field(file, "s", MED_CELL, MED_QUAD4, [(7.5, 8.5)])
    add_field(file, "moving", MED_NODE, MED_NO_GEOTYPE, [(float(i),) for i in range(5)], (1, 1))
    add_field(file, "moving", MED_NODE, MED_NO_GEOTYPE, [(2.0 * i,) for i in range(5)], (2, 1), create=False)
    add_field(file, "at corners", MED_NODE_ELEMENT, MED_TRIA3, [(1.0,), (2.0,), (3.0,)])
    MEDfileClose(file)


def brick(path):
    """A cell of each kind that has an inside: corners as MED counts them, the first face's normal outwards."""
    square = [(0, 0), (0, 1), (1, 1), (1, 0)]
    triangle = [(0, 0), (0, 1), (1, 0)]
    ring = lambda n, low: [(low + i, low + (i + 1) % n) for i in range(n)]
    pillars = lambda n: [(i, i + n) for i in range(n)]
    sides = lambda n: [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    hexa, penta = [[(x, y, z) for z in (0, 1) for x, y in base] for base in (square, triangle)]
    tetra, pyra = [[(x, y, 0) for x, y in base] + [(0, 0, 1)] for base in (triangle, square)]
    edges = {n: ring(n, 0) + ring(n, n) + pillars(n) for n in (3, 4)}
    roofs = {n: ring(n, 0) + [(i, n) for i in range(n)] for n in (3, 4)}
    faces = [(0, 1, 2, 3)] + sides(4) + [(4, 5, 6, 7), range(8)]
    shapes = [
        (MED_HEXA8, hexa, []), (MED_HEXA20, hexa, edges[4]), (MED_HEXA27, hexa, edges[4] + faces),
        (MED_PENTA6, penta, []), (MED_PENTA15, penta, edges[3]), (MED_PENTA18, penta, edges[3] + sides(3)),
        (MED_TETRA4, tetra, []), (MED_TETRA10, tetra, roofs[3]),
        (MED_PYRA5, pyra, []), (MED_PYRA13, pyra, roofs[4]),
        (MED_QUAD9, hexa[3::-1], ring(4, 0) + [range(4)]),
    ]
    mean = lambda points: tuple(sum(x) / len(points) for x in zip(*points))
    file = create(path)
    points, cells = [], []
    for kind, corners, middles in shapes:
        first = len(points) + 1
        points += corners + [mean([corners[i] for i in ends]) for ends in middles]
        cells.append((kind, list(range(first, len(points) + 1))))
    add_points(file, points)
    for kind, nodes in cells:
        add_cells(file, kind, [nodes])
    MEDfileClose(file)


def refused(folder):
    file = create(f"{folder}/two.med")
    add_mesh(file, "other")
    MEDfileClose(file)
    MEDfileClose(create(f"{folder}/cylindrical.med", axes=MED_CYLINDRICAL))
    MEDfileClose(create(f"{folder}/grid.med", kind=MED_STRUCTURED_MESH))
    MEDfileClose(create(f"{folder}/bare.med"))
    file = create(f"{folder}/polygon.med")
    add_points(file, [(0, 0, 0), (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0)])
    MEDmeshPolygonWr(file, "part", *NOW, 0.0, MED_CELL, MED_NODAL, 2, MEDINT([1, 6]), MEDINT([1, 2, 3, 4, 5]))
    MEDfileClose(file)


def flat(path):
    """Two coordinates a node, no unit, a later step of the mesh."""
    file = create(path, space=2, unit="")
    add_points(file, [(0, 0), (3, 0), (0, 4)])
    add_cells(file, MED_TRIA3, [(1, 2, 3)])
    MEDmeshComputationStepCr(file, "part", *NOW, 1, 1, 1.0)
    add_points(file, [(0, 0), (6, 0), (0, 8)], step=(1, 1))
    MEDfileClose(file)


def named_alike(path):
    """Groups mat_1, mat_2 of one line each, and whole numbers `mat` at lines that would be sets of the same names."""
    file = create(path, unit="")
    add_points(file, [(0, 0, 0), (1, 0, 0), (2, 0, 0)])
    add_cells(file, MED_SEG2, [(1, 2), (2, 3)])
    for number in (1, 2):
        add_family(file, str(number), -number, [f"mat_{number}"])
    of_families(file, MED_CELL, MED_SEG2, [-1, -2])
    add_field(file, "mat", MED_CELL, MED_SEG2, [(2,), (1,)], whole=True)
    add_field(file, "part", MED_CELL, MED_SEG2, [(5,), (5,)], whole=True)
    MEDfileClose(file)


def wide(path):
    """A field of 1000 components at one line beside 40,000 points, which all would get a row of."""
    file = create(path)
    add_points(file, [(0, 0, 0), (1, 0, 0)])
    add_cells(file, MED_POINT1, [(1,)] * 40000)
    add_cells(file, MED_SEG2, [(1, 2)])
    add_field(file, "wide", MED_CELL, MED_SEG2, [[1.0] * 1000])
    MEDfileClose(file)


def main():
    folder = sys.argv[1]
    plate(f"{folder}/plate.med", None)
    plate(f"{folder}/plate3.med", 3)
    brick(f"{folder}/brick.med")
    flat(f"{folder}/flat.med")
    refused(folder)
    named_alike(f"{folder}/alike.med")
    wide(f"{folder}/wide.med")


main()
