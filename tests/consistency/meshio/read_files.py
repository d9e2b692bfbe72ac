"""Reads by meshio what tenon wrote (.msh, .vtu) and holds it to the .truth file beside each.

usage: read_files.py FOLDER
"""
import glob
import os
import sys

import meshio
import numpy as np


DIMENSIONS = dict(vertex=0, line=1, triangle=2, quad=2)  # of the word a type begins with; all others are solids


def read_truth(path):
    truth = dict(points=[], cells={}, sets={}, point_data={}, cell_data={})
    lines = iter(open(path).read().splitlines())
    for line in lines:
        word, *rest = line.split()
        if word == "points":
            truth["points"] = np.array([next(lines).split() for _ in range(int(rest[0]))], float)
        elif word == "cells":
            truth["cells"].setdefault(rest[0], []).extend(
                tuple(map(int, next(lines).split())) for _ in range(int(rest[1])))
        elif word == "set":  # of a name: cells of one type by their nodes
            truth["sets"].setdefault(rest[0], set()).update(
                (rest[1],) + tuple(map(int, next(lines).split())) for _ in range(int(rest[2])))
        elif word == "point_data":
            truth["point_data"][rest[0]] = np.array([next(lines).split() for _ in truth["points"]], float)
        elif word == "cell_data":  # a number for each cell, by its nodes
            truth["cell_data"][rest[0]] = {
                (rest[1],) + tuple(map(int, row[1:])): float(row[0])
                for row in (next(lines).split() for _ in range(int(rest[2])))} | truth["cell_data"].get(rest[0], {})
    return truth


def compare(path, mesh, truth, digits, sets):
    scale = np.abs(truth["points"]).max()
    assert mesh.points.shape == truth["points"].shape, "number of points"
    assert np.abs(mesh.points - truth["points"]).max() <= 10.0 ** -digits * scale, "coordinates"
    found = {}
    for block in mesh.cells:
        found.setdefault(block.type, []).extend(tuple(map(int, nodes)) for nodes in block.data)
    assert {t: sorted(c) for t, c in found.items()} == {t: sorted(c) for t, c in truth["cells"].items()}, "cells"
    for name, values in truth["point_data"].items():
        read = np.asarray(mesh.point_data[name]).reshape(len(values), -1)
        assert np.abs(read[:, :values.shape[1]] - values).max() <= 10.0 ** -digits * np.abs(values).max(), name
    if sets:
        compare_groups(mesh, truth)
    for name, of_cells in truth["cell_data"].items():
        if path.endswith(".binary.msh"):
            break  # written without
        for block, values in zip(mesh.cells, mesh.cell_data[name]):
            for nodes, value in zip(block.data, np.ravel(values)):
                expected = of_cells[(block.type,) + tuple(map(int, nodes))]
                assert abs(value - expected) <= 10.0 ** (1 - digits) * abs(expected), f"{name}: {value}, {expected}"


def compare_groups(mesh, truth):
    groups = {}
    for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        dimension = DIMENSIONS.get(block.type.rstrip("0123456789"), 3)
        for nodes, tag in zip(block.data, tags):
            names = [n for n, (t, d) in mesh.field_data.items() if (t, d) == (tag, dimension)]
            assert len(names) == 1, f"tag {tag} of dimension {dimension} has the names {names}"
            groups.setdefault(names[0], set()).add((block.type,) + tuple(map(int, nodes)))
    assert groups == truth["sets"], "groups"


def main():
    count = 0
    for path in sorted(glob.glob(os.path.join(sys.argv[1], "*.truth"))):
        stem = path[:-len(".truth")]
        truth = read_truth(path)
        for ending, digits, sets in ((".msh", 16, True), (".binary.msh", 17, True), (".vtu", 17, False)):
            if not os.path.exists(stem + ending):
                continue
            try:
                kind = "vtu" if ending == ".vtu" else "gmsh"
                compare(stem + ending, meshio.read(stem + ending, kind), truth, digits, sets)
            except Exception as fault:
                sys.exit(f"{os.path.basename(stem + ending)}: {type(fault).__name__}: {fault}")
            count += 1
    print(count)


main()
