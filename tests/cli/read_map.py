#!/usr/bin/env python3
"""Reads a map's files by their published formats alone, and prints what is in them as JSON.

  read_map.py FOLDER NAME      reads NAME.ply, NAME.pcd, NAME.yaml and the image that this names

The occupancy grid is read as ROS's map_server does: p = (255 - value) / 255, occupied above occupied_thresh, free
below free_thresh; `origin` is the lower left corner of the lower left pixel. Needs nothing but Python.
"""
import json
import os
import struct
import sys

PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}
PCD_TYPES = {("F", 4): "f", ("F", 8): "d", ("U", 1): "B", ("U", 2): "H", ("U", 4): "I", ("I", 4): "i"}


def read_ply(path):
    with open(path, "rb") as file:
        assert file.readline() == b"ply\n"
        names, types, count, robots = [], "", 0, {}
        for line in iter(file.readline, b"end_header\n"):
            words = line.decode().split()
            if words[0] == "format":
                assert words[1:] == ["binary_little_endian", "1.0"]
            elif words[:2] == ["comment", "robot"]:
                robots[int(words[2])] = words[3]
            elif words[:2] == ["element", "vertex"]:
                count = int(words[2])
            elif words[0] == "property":
                types += PLY_TYPES[words[1]]
                names.append(words[2])
        return names, rows_of(file.read(), types, count), robots


def read_pcd(path):
    with open(path, "rb") as file:
        header = {}
        for line in iter(file.readline, b""):
            words = line.decode().split()
            header[words[0]] = words[1:]
            if words[0] == "DATA":
                break
        assert header["DATA"] == ["binary"] and int(header["WIDTH"][0]) * int(header["HEIGHT"][0]) == int(header["POINTS"][0])
        types = "".join(PCD_TYPES[t, int(s)] for t, s in zip(header["TYPE"], header["SIZE"]))
        return header["FIELDS"], rows_of(file.read(), types, int(header["POINTS"][0]))


def rows_of(data, types, count):
    record = struct.Struct("<" + types)
    assert len(data) == count * record.size, (len(data), count, record.size)
    return list(record.iter_unpack(data))


def read_grid(path):
    settings = {}
    with open(path) as file:
        for line in file:
            key, value = line.split(":", 1)
            settings[key] = value.strip()
    with open(os.path.join(os.path.dirname(path), settings["image"]), "rb") as file:
        assert file.readline() == b"P5\n"
        width, height = map(int, file.readline().split())
        assert file.readline() == b"255\n"
        image = file.read()
    assert len(image) == width * height and settings["negate"] == "0"
    resolution = float(settings["resolution"])
    x0, y0, yaw = (float(v) for v in settings["origin"].strip("[]").split(","))
    assert yaw == 0
    cells = {"occupied": [], "free": [], "unknown": []}
    for k, value in enumerate(image):
        p = (255 - value) / 255
        state = ("occupied" if p > float(settings["occupied_thresh"]) else
                 "free" if p < float(settings["free_thresh"]) else "unknown")
        cells[state].append((x0 + (k % width + 0.5) * resolution, y0 + (height - 1 - k // width + 0.5) * resolution))
    return cells


def main():
    folder, name = sys.argv[1:]
    names, points, robots = read_ply(os.path.join(folder, name + ".ply"))
    fields, same = read_pcd(os.path.join(folder, name + ".pcd"))
    assert fields[:3] == names[:3] and points == same
    cells = read_grid(os.path.join(folder, name + ".yaml"))
    extent = [f(p[axis] for p in points) for axis in range(3) for f in (min, max)]
    xs = sorted(p[0] for p in cells["occupied"])
    ys = sorted(p[1] for p in cells["occupied"])
    print(json.dumps({"names": names, "robots": robots, "points": len(points), "extent": extent,
                      "cells": {state: len(of) for state, of in cells.items()},
                      "occupied": [xs[0], xs[-1], ys[0], ys[-1]]}))


main()
