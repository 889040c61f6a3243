#!/usr/bin/env python3
"""Compares what two builds of radioslam write, to the byte, on simulated and recorded missions.

  scripts/compare_runs.py OLD NEW [--data DIR] [--only NAME,...] [--seeds 1,2] [--threads 1,4] [--keep DIR]

OLD and NEW are two `radioslam` programs. OLD makes the missions; NEW must simulate the same ones. Then both run each
mission with every number of threads:

  *.tum, *.csv, graph.g2o           must be equal byte for byte
  summary.json, report.html (data)  must be equal once times are left out; texts may be reworded, but the
                                    numbers in them must be the same, in the same order

--data is a folder with recordings, laid out as below; without one, or where a recording is missing, the case is
skipped, and says so. Exit status: 0 all equal, 1 something differs, 2 wrong call.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SCENARIOS = ["carpark", "city", "hall", "corridors", "csi"]
TIMES = {"seconds", "timings"}
WORDING = {"description", "meaning", "level"}
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def call(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{program} {' '.join(map(str, arguments))}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


# ---- cases: (name, function(program, folder) -> list of run inputs or None if the recording is missing) ------------------

def simulated(scenario, seed):
    def make(program, folder, _data):
        call(program, "simulate", scenario, "-o", folder / "mission", "--seed", seed)
        return folder / "mission"
    return make


def imported(kind, *parts, unpack=None):
    def make(program, folder, data):
        source = data.joinpath(*parts)
        if not source.exists():
            return None
        if unpack:
            unpack(source, folder / "source")
            source = folder / "source"
        call(program, "import", kind, source, "-o", folder / "mission")
        return folder / "mission"
    return make


def unpack_scans(source, target):
    """A KITTI sequence out of an archive of scans, with its times and poses."""
    target.mkdir()
    subprocess.run(["tar", "--zstd", "-xf", str(source), "-C", str(target)], check=True)
    (target / "bin").rename(target / "velodyne")
    shutil.copy(source.parent / "times.txt", target)
    shutil.copy(source.parent / "poses_kitti.txt", target / "poses.txt")


def graph_file(*parts):
    def make(_program, _folder, data):
        source = data.joinpath(*parts)
        return source if source.exists() else None
    return make


def cases(seeds):
    found = [(f"{scenario}-{seed}", simulated(scenario, seed)) for scenario in SCENARIOS for seed in seeds]
    found += [
        ("aces", imported("carmen", "lidar2d", "aces.clf.bz2")),
        ("lidar3d", imported("kitti", "lidar3d", "scans_voxel0p1_bin.tar.zst", unpack=unpack_scans)),
        ("tiers", graph_file("range_aided", "tiers.pyfg.zst")),
        ("mrclam6", graph_file("range_aided", "mrclam6.pyfg.zst")),
        ("ilc20", imported("indoor-location", "ilc20", "slim", "site2", "B1")),
    ]
    return found


# ---- comparison ---------------------------------------------------------------------------------------------------------

def page_data(path):
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    return json.loads(found.group(1))


class Differences:
    def __init__(self):
        self.lines = []
        self.reworded = 0

    def add(self, where, what):
        self.lines.append(f"{where}: {what}")

    def compare(self, where, old, new):
        if isinstance(old, dict) and isinstance(new, dict):
            old = {k: v for k, v in old.items() if k not in TIMES | WORDING}
            new = {k: v for k, v in new.items() if k not in TIMES | WORDING}
            for key in old.keys() | new.keys():
                if key not in old or key not in new:
                    self.add(f"{where}.{key}", "only in the new one" if key in new else "only in the old one")
                else:
                    self.compare(f"{where}.{key}", old[key], new[key])
        elif isinstance(old, list) and isinstance(new, list):
            if len(old) != len(new):
                self.add(where, f"{len(old)} entries, now {len(new)}")
            for k, (a, b) in enumerate(zip(old, new)):
                self.compare(f"{where}[{k}]", a, b)
        elif isinstance(old, str) and isinstance(new, str):
            self.compare_text(where, old, new)
        elif old != new or type(old) is not type(new):
            self.add(where, f"{old!r}, now {new!r}")

    def compare_text(self, where, old, new):
        if old == new:
            return
        if NUMBER.findall(old) == NUMBER.findall(new) and " " in new:
            self.reworded += 1
        else:
            self.add(where, f"{old[:120]!r}, now {new[:120]!r}")


def compare_folders(old, new, differences, bytes_alone=False):
    files = {p.relative_to(old) for p in old.rglob("*") if p.is_file()}
    others = {p.relative_to(new) for p in new.rglob("*") if p.is_file()}
    for name in sorted(files | others):
        if name not in files or name not in others:
            differences.add(name, "only in the new run" if name in others else "only in the old run")
        elif not bytes_alone and name.name == "summary.json":
            differences.compare(str(name), json.loads((old / name).read_text()), json.loads((new / name).read_text()))
        elif not bytes_alone and name.name == "report.html":
            differences.compare(str(name), page_data(old / name), page_data(new / name))
        elif (old / name).read_bytes() != (new / name).read_bytes():
            differences.add(name, "other bytes")


def run_case(name, make, arguments, folder):
    missions = {}
    for label, program in (("old", arguments.old), ("new", arguments.new)):
        (folder / label).mkdir(parents=True)
        missions[label] = make(program, folder / label, arguments.data)
    if missions["old"] is None:
        print(f"{name}: SKIPPED, no recording", flush=True)
        return True
    differences = Differences()
    if missions["old"].is_dir():
        compare_folders(missions["old"], missions["new"], differences, bytes_alone=True)
    runs = []
    for threads in arguments.threads:
        out = {label: folder / label / f"run{threads}" for label in ("old", "new")}
        for label, program in (("old", arguments.old), ("new", arguments.new)):
            if label == "old" and threads != arguments.threads[0]:
                out[label] = runs[0]["old"]  # the old program's bytes do not depend on the threads; once is enough
                continue
            call(program, "run", missions["old"], "-o", out[label], "--threads", threads)
        runs.append(out)
        compare_folders(out["old"], out["new"], differences)
    shown = differences.lines[:12]
    verdict = "equal" if not differences.lines else f"{len(differences.lines)} DIFFERENCES"
    reworded = f", {differences.reworded} texts reworded" if differences.reworded else ""
    print(f"{name}: {verdict}{reworded}", flush=True)
    for line in shown:
        print(f"    {line}", flush=True)
    return not differences.lines


def run_angles(arguments, folder):
    """Angles of arrival of every recorded trial. A trial that OLD cannot read has nothing to be compared with."""
    trials = arguments.data / "wsr" / "raw"
    if not trials.exists():
        print("wsr: SKIPPED, no recording", flush=True)
        return True
    authors = arguments.data / "wsr" / "2D-Displacement_output_files"
    equal, refused, different = 0, [], []
    for trial in sorted(path.parent for path in trials.rglob("groundtruth_positions.json")):
        tables = {}
        try:
            for label, program in (("old", arguments.old), ("new", arguments.new)):
                out = folder / trial.name / label
                call(program, "reproduce", "aoa", "--dataset", trial, "--authors", authors, "-o", out)
                tables[label] = (out / "links.csv").read_bytes() + (out / "table.csv").read_bytes()
        except RuntimeError:
            if label == "new":
                raise
            refused.append(trial.name)
            continue
        if tables["old"] == tables["new"]:
            equal += 1
        else:
            different.append(trial.name)
    note = f"; not read by the old program: {', '.join(refused)}" if refused else ""
    print(f"wsr: {equal} trials equal, {len(different)} different{note}", flush=True)
    for name in different:
        print(f"    {name}", flush=True)
    return not different


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--only", default="")
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--threads", default="1,4")
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.threads = [int(n) for n in arguments.threads.split(",")]
    wanted = [n for n in arguments.only.split(",") if n]
    root = arguments.keep or pathlib.Path(tempfile.mkdtemp())
    root.mkdir(parents=True, exist_ok=True)
    good = True
    try:
        for name, make in cases([int(n) for n in arguments.seeds.split(",")]):
            if not wanted or any(name.startswith(w) for w in wanted):
                good = run_case(name, make, arguments, root / name) and good
        if not wanted or "wsr" in wanted:
            good = run_angles(arguments, root / "wsr") and good
    finally:
        if not arguments.keep:
            shutil.rmtree(root, ignore_errors=True)
    print("all equal" if good else "NOT equal")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
