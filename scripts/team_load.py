#!/usr/bin/env python3
"""What agents cost: processor time, memory and messages, by team size or over a long time.

  scripts/team_load.py [-o FOLDER] [--seconds S] [SIZE ...]     teams that live through a mission in real time
  scripts/team_load.py [-o FOLDER] --soak MINUTES               three agents at ten times the mission's speed

The first writes load.csv and load.svg; default: 60 s, teams of 2, 5 and 10. The second writes soak.csv, and fails where
an agent's memory grows by more than 5 % after the first third, from when on the robots stand still. Needs build/release.
"""
import argparse, csv, json, os, pathlib, subprocess, sys, time

HERE = pathlib.Path(__file__).resolve().parent.parent
TICKS = os.sysconf("SC_CLK_TCK")


def agents_of(mission):
    """Robot, processor time in seconds and resident MiB of every agent that replays the mission."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
            if not words[0].endswith(b"radioslam-agent") or os.fsencode(mission) not in words:
                continue
            stat = (process / "stat").read_text().rsplit(")", 1)[1].split()
            pages = int((process / "statm").read_text().split()[1])
        except (OSError, IndexError):
            continue
        robot = words[words.index(b"--robot") + 1].decode()
        yield robot, (int(stat[11]) + int(stat[12])) / TICKS, pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def live_through(program, mission, out, rate):
    """Samples (seconds, robot, processor seconds, MiB) while a team lives through a mission."""
    begin, samples = time.time(), []
    team = subprocess.Popen([program, "team", mission, "--rate", str(rate), "-o", out])
    while team.poll() is None:
        samples += [(time.time() - begin, *of) for of in agents_of(mission)]
        time.sleep(1)
    if team.returncode:
        sys.exit(f"scripts/team_load.py: the team of {mission} ended with status {team.returncode}")
    return samples


def simulate(program, folder, robots, **settings):
    subprocess.run([program, "simulate", "city", "--robots", str(robots), "--seed", "1", "-o", folder, "--set",
                    *(f"{name}={value}" for name, value in settings.items())], check=True, stdout=subprocess.DEVNULL)


def plot(rows, path):
    """A panel for each column but the first, which is the abscissa."""
    names = list(rows[0])
    width, height = 260, 180
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * (len(names) - 1)}" height="{height}" '
             'font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="white"/>']
    for k, name in enumerate(names[1:]):
        most_x, most_y = max(row[names[0]] for row in rows), max(row[name] for row in rows)
        at = [(k * width + 45 + 190 * row[names[0]] / most_x, 145 - 110 * row[name] / most_y) for row in rows]
        parts.append(f'<text x="{k * width + 45}" y="18">{name}</text>'
                     f'<path d="M{k * width + 45} 30V145H{k * width + 240}" fill="none" stroke="#888"/>'
                     f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in at)}" fill="none" stroke="#06c"/>')
        for row, (x, y) in zip(rows, at):
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="#06c"/>'
                         f'<text x="{x:.1f}" y="{y - 7:.1f}" text-anchor="middle">{row[name]:.3g}</text>'
                         f'<text x="{x:.1f}" y="160" text-anchor="middle">{row[names[0]]}</text>')
        parts.append(f'<text x="{k * width + 140}" y="175" text-anchor="middle">{names[0]}</text>')
    path.write_text("\n".join(parts + ["</svg>\n"]))


def write_csv(path, names, rows):
    with open(path, "w", newline="") as file:
        csv.writer(file).writerows([names, *rows])


def loads(program, folder, sizes, seconds):
    rows = []
    for size in sizes:
        mission, out = folder / f"team{size}", folder / f"team{size}-out"
        simulate(program, mission, size, speed_mps=4, path_length_m=4 * seconds)
        samples = live_through(program, str(mission), str(out), 1)
        last = {robot: used / at for at, robot, used, _ in samples}
        said = [json.load(open(out / "agents" / robot / "summary.json")) for robot in last]
        rows.append({"robots": size,
                     "% of a core, mean agent": 100 * sum(last.values()) / size,
                     "MiB, largest agent": max(of[3] for of in samples),
                     "kB a second sent, mean agent": sum(of["bytes_sent"] for of in said) / size / seconds / 1000})
        print(", ".join(f"{name}: {value:.4g}" for name, value in rows[-1].items()), flush=True)
    write_csv(folder / "load.csv", list(rows[0]), [list(row.values()) for row in rows])
    plot(rows, folder / "load.svg")


def soak(program, folder, minutes):
    mission, seconds = folder / "soak", 60 * minutes * 10
    simulate(program, mission, 3, speed_mps=4, path_length_m=4 * seconds / 3)
    for robot in mission.glob("robots/*/odometry.tum"):  # then each stands where it is
        words = robot.read_text().splitlines()[-1].split()
        with open(robot, "a") as file:
            for k in range(1, int(seconds * 2 / 3)):
                print(float(words[0]) + k, *words[1:], file=file)
    samples = live_through(program, str(mission), str(folder / "soak-out"), 10)
    write_csv(folder / "soak.csv", ["t_s", "robot", "processor_s", "mib"], samples)
    failed = False
    for robot in sorted({of[1] for of in samples}):
        of_robot = [(at, mib) for at, name, _, mib in samples if name == robot]
        third = max(mib for at, mib in of_robot if at <= 0.4 * of_robot[-1][0])
        most = max(mib for _, mib in of_robot[:-5])  # at the end it writes its results
        print(f"agent {robot}: {third:.1f} MiB after a third, at most {most:.1f} MiB")
        failed |= most > 1.05 * third
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", type=pathlib.Path, default=HERE / "build" / "team-load", metavar="FOLDER")
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--soak", type=float, metavar="MINUTES")
    parser.add_argument("sizes", type=int, nargs="*", default=[2, 5, 10], metavar="SIZE")
    options = parser.parse_args()
    options.o.mkdir(parents=True, exist_ok=True)
    program = str(HERE / "build" / "release" / "radioslam")
    if options.soak:
        sys.exit(soak(program, options.o, options.soak))
    loads(program, options.o, options.sizes, options.seconds)


if __name__ == "__main__":
    main()
