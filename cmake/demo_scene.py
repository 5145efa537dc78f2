#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""demo_scene.py OUT.glb [--models N] [--objects N] [--faces N]: a scene for demonstrations.

Writes a binary glTF 2.0 file of bumpy lumps, each model another shape of about --faces triangles
and 40 to 80 mm across, and of objects that show them in turn: on a grid, turned, of 0.5 to 1.5
times the size, each tenth model's mirrored, some rough. Every number follows from the object's own, so the same
arguments give the same bytes. Standard library only.
"""
import argparse
import json
import math
import struct
import sys

GOLDEN = math.pi * (3.0 - math.sqrt(5.0))
SPACING_M = 0.15


def fraction(number, salt):
    """A number of 0 to 1 that looks like chance and is none."""
    return math.modf(0.5 + number * 0.6180339887498949 + salt * 0.7548776662466927)[0]


def lump(number, faces):
    """A closed surface round the origin, in metres: positions, triangles."""
    rows = max(3, round(math.sqrt(faces / 4.0)))
    columns = 2 * rows
    waves, turns = 2 + number % 5, 1 + number % 4
    radius, height = 0.02 + 0.02 * fraction(number, 1), 0.002 + 0.004 * fraction(number, 2)

    def place(row, column):
        up = math.pi * row / rows
        angle = 2.0 * math.pi * column / columns
        bump = math.sin(waves * up) * math.cos(turns * angle) * math.sin(up) ** 2
        r = radius + height * bump
        return (r * math.sin(up) * math.cos(angle), r * math.sin(up) * math.sin(angle),
                r * math.cos(up))

    positions = [place(0, 0)]
    positions += [place(row, column) for row in range(1, rows) for column in range(columns)]
    positions.append(place(rows, 0))
    last = len(positions) - 1
    triangles = []
    for column in range(columns):
        right = (column + 1) % columns
        triangles.append((0, 1 + column, 1 + right))
        for row in range(rows - 2):
            a, b = 1 + row * columns + column, 1 + row * columns + right
            triangles += [(a, a + columns, b), (b, a + columns, b + columns)]
        ring = 1 + (rows - 2) * columns
        triangles.append((ring + column, last, ring + right))
    return positions, triangles


def node(number, models, side):
    """An object, on a grid of `side` by `side` in x and y."""
    turn = GOLDEN * number
    tilt = math.pi * fraction(number, 3)
    scale = 0.5 + fraction(number, 4)
    mirror = -1.0 if number % models % 10 == 9 else 1.0  # A model's objects agree.
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    half = 0.5 * turn
    result = {
        "name": f"object-{number:03d}",
        "mesh": number % models,
        "translation": [SPACING_M * (number % side - 0.5 * (side - 1)),
                        SPACING_M * (number // side - 0.5 * (side - 1)),
                        0.1 * (fraction(number, 5) - 0.5)],
        "rotation": [math.sin(half) * axis[0], math.sin(half) * axis[1],
                     math.sin(half) * axis[2], math.cos(half)],
        "scale": [mirror * scale, scale, scale],
    }
    if number % 4 == 0:
        result["extras"] = {"tactus": {"material": {"stiffness": 300 + 100 * (number % 5),
                                                    "static": 0.5, "dynamic": 0.3}}}
    return result


def write_glb(path, scene, binary):
    text = json.dumps(scene, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("out")
    parser.add_argument("--models", type=int, default=20)
    parser.add_argument("--objects", type=int, default=200)
    parser.add_argument("--faces", type=int, default=5000)
    arguments = parser.parse_args()
    if not (1 <= arguments.models <= arguments.objects <= 4096 and
            100 <= arguments.faces <= 1_000_000):
        parser.error("1 to 4096 objects, no more models than these, 100 to 1000000 faces")
    side = math.ceil(math.sqrt(arguments.objects))
    binary, views, accessors, meshes = bytearray(), [], [], []
    for number in range(arguments.models):
        positions, triangles = lump(number, arguments.faces)
        for values, form, kind, component in (
                (positions, "<3f", "VEC3", 5126), (triangles, "<3I", "SCALAR", 5125)):
            data = b"".join(struct.pack(form, *value) for value in values)
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            accessors.append({"bufferView": len(views) - 1, "componentType": component,
                              "type": kind,
                              "count": len(values) * (3 if kind == "SCALAR" else 1)})
            binary += data
        stored = [struct.unpack("<3f", struct.pack("<3f", *place)) for place in positions]
        accessors[-2]["min"] = [min(axis) for axis in zip(*stored)]
        accessors[-2]["max"] = [max(axis) for axis in zip(*stored)]
        meshes.append({"name": f"lump-{number:02d}",
                       "primitives": [{"attributes": {"POSITION": len(accessors) - 2},
                                       "indices": len(accessors) - 1}]})
    scene = {
        "asset": {"version": "2.0", "generator": "demo_scene.py"},
        "scene": 0,
        "scenes": [{"nodes": list(range(arguments.objects))}],
        "nodes": [node(number, arguments.models, side) for number in range(arguments.objects)],
        "meshes": meshes,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    write_glb(arguments.out, scene, bytes(binary))
    return 0


if __name__ == "__main__":
    sys.exit(main())
