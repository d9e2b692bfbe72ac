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


def add_field(file, name, entity, kind, rows, step=NOW, create=True):
    width = len(rows[0])
    if create:
        MEDfieldCr(file, name, MED_FLOAT64, width, names(16, *"abc"[:width]), names(16, *"uvw"[:width]), "s", "part")
    MEDfieldValueWr(file, name, *step, 0.0, entity, kind, MED_FULL_INTERLACE, MED_ALL_CONSTITUENT, len(rows),
                    MEDFLOAT([x for row in rows for x in row]))


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
    """One solid of second order of each shape: corners as MED counts them, the first face's normal outwards."""
    square = [(0, 0), (0, 1), (1, 1), (1, 0)]
    triangle = [(0, 0), (0, 1), (1, 0)]
    ring = lambda n, low: [(low + i, low + (i + 1) % n) for i in range(n)]
    pillars = lambda n: [(i, i + n) for i in range(n)]
    file = create(path)
    points = []
    shapes = [
        (MED_HEXA20, [(x, y, z) for z in (0, 1) for x, y in square], ring(4, 0) + ring(4, 4) + pillars(4)),
        (MED_PENTA15, [(x, y, z) for z in (0, 1) for x, y in triangle], ring(3, 0) + ring(3, 3) + pillars(3)),
        (MED_TETRA10, [(x, y, 0) for x, y in triangle] + [(0, 0, 1)], ring(3, 0) + [(i, 3) for i in range(3)]),
        (MED_PYRA13, [(x, y, 0) for x, y in square] + [(0, 0, 1)], ring(4, 0) + [(i, 4) for i in range(4)]),
    ]
    cells = []
    for kind, corners, edges in shapes:
        middles = [tuple((a + b) / 2 for a, b in zip(corners[i], corners[j])) for i, j in edges]
        first = len(points) + 1
        points += corners + middles
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


def main():
    folder = sys.argv[1]
    plate(f"{folder}/plate.med", None)
    plate(f"{folder}/plate3.med", 3)
    brick(f"{folder}/brick.med")
    flat(f"{folder}/flat.med")
    refused(folder)


main()
