#!/usr/bin/env python3
"""Reads a map's files by their published formats alone, and prints what is in them as JSON.

  read_map.py FOLDER NAME            reads NAME.ply, NAME.pcd, NAME.yaml and the image that this names
  read_map.py FOLDER NAME LIBRARY    checks that open3d, pcl (Debian's pcl-tools) or pillow (with yaml) reads the same
                                     in them; exits with 77 where it is not installed

The occupancy grid is read as ROS's map_server does: p = (255 - value) / 255, occupied above occupied_thresh, free
below free_thresh; `origin` is the lower left corner of the lower left pixel. Needs nothing but Python.
"""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

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


def read_pcd(path, is_padded=False):
    with open(path, "rb") as file:
        header = {}
        for line in iter(file.readline, b""):
            words = line.decode().split()
            header[words[0]] = words[1:]
            if words[0] == "DATA":
                break
        assert header["DATA"] == ["binary"] and int(header["WIDTH"][0]) * int(header["HEIGHT"][0]) == int(header["POINTS"][0])
        types = "".join(PCD_TYPES[t, int(s)] for t, s in zip(header["TYPE"], header["SIZE"]))
        count = int(header["POINTS"][0])
        data = file.read(count * struct.calcsize("<" + types)) if is_padded else file.read()
        return header["FIELDS"], rows_of(data, types, count)


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
    origin = [float(v) for v in settings["origin"].strip("[]").split(",")]
    return cells_of(image, width, float(settings["resolution"]), origin, float(settings["occupied_thresh"]),
                    float(settings["free_thresh"]))


def cells_of(image, width, resolution, origin, occupied_thresh, free_thresh):
    """Centres of the cells by state."""
    height, (x0, y0, yaw) = len(image) // width, origin
    assert yaw == 0
    cells = {"occupied": [], "free": [], "unknown": []}
    for k, value in enumerate(image):
        p = (255 - value) / 255
        state = "occupied" if p > occupied_thresh else "free" if p < free_thresh else "unknown"
        cells[state].append((x0 + (k % width + 0.5) * resolution, y0 + (height - 1 - k // width + 0.5) * resolution))
    return cells


def check_open3d(base):
    import open3d
    _, points, _ = read_ply(base + ".ply")
    for ending in (".ply", ".pcd"):
        cloud = open3d.t.io.read_point_cloud(base + ending).point
        columns = [cloud[name].numpy() for name in ("positions", "normals", "intensity", "time")]
        assert [tuple(v for column in columns for v in column[k]) for k in range(len(columns[0]))] == \
            [point[:8] for point in points], ending


def check_pcl(base):
    if not shutil.which("pcl_ply2pcd"):
        raise ImportError("pcl-tools")
    points = read_ply(base + ".ply")[1]
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "copy.pcd")
        for command in (["pcl_ply2pcd", base + ".ply", copy], ["pcl_convert_pcd_ascii_binary", base + ".pcd", copy, "1"]):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            assert read_pcd(copy, is_padded=True)[1] == points, command


def check_pillow(base):
    import PIL.Image
    import yaml
    with open(base + ".yaml") as file:
        settings = yaml.safe_load(file)
    image = PIL.Image.open(os.path.join(os.path.dirname(base), settings["image"]))
    assert image.mode == "L" and settings["mode"] == "trinary"
    assert cells_of(image.tobytes(), image.width, settings["resolution"], settings["origin"], settings["occupied_thresh"],
                    settings["free_thresh"]) == read_grid(base + ".yaml")


def main():
    folder, name = sys.argv[1:3]
    for library in sys.argv[3:]:
        try:
            {"open3d": check_open3d, "pcl": check_pcl, "pillow": check_pillow}[library](os.path.join(folder, name))
        except ImportError:
            return 77
    names, points, robots = read_ply(os.path.join(folder, name + ".ply"))
    fields, same = read_pcd(os.path.join(folder, name + ".pcd"))
    assert fields[:3] == names[:3] and points == same
    cells = read_grid(os.path.join(folder, name + ".yaml"))
    extent = [f(p[axis] for p in points) for axis in range(3) for f in (min, max)]
    xs = sorted(p[0] for p in cells["occupied"])
    ys = sorted(p[1] for p in cells["occupied"])
    print(json.dumps({"names": names, "robots": robots, "points": len(points), "extent": extent,
                      "cells": {state: len(of) for state, of in cells.items()}, "centres": cells,
                      "occupied": [xs[0], xs[-1], ys[0], ys[-1]]}))
    return 0


sys.exit(main())
