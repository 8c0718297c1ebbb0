#!/usr/bin/env python3
"""Times our fitter against EMS on the same clouds in the same run.

    python compare/fit_speed.py --ems INSTALLED_EMS --supersurface target/release/supersurface DATA

For each cloud the two take turns on one core with one thread each; a cloud's time is the CPU time of the fit
alone, the best of its repetitions. A class's times are over the clouds that both fitted; the rest are counted.
"""

import argparse
import json
import math
import os
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

from fitters import CannotRun, Ems, FitFailed, Supersurface

# The family of a class, by how its name begins; the other classes are superellipsoids.
MODELS = {
    "e_tor": "supertoroid", "f_taper_bend": "tapered_bent", "f_taper": "tapered", "f_bend": "bent",
    "f_twist": "twisted",
}  # fmt: skip


@dataclass
class Case:
    """One cloud: its name, class and file, the family to fit, and where the sensor is if it is one view."""

    id: str
    group: str
    cloud: Path
    model: str
    viewpoint: str


def read_cases(data, classes, per_class):
    """The cases of a data folder by class, in the order of its index.json."""
    try:
        listed = json.loads((data / "index.json").read_text())["cases"]
        groups = {}
        for case in listed:
            group = case["cls"]
            if classes and not any(group.startswith(start) for start in classes):
                continue
            guess = next((model for start, model in MODELS.items() if group.startswith(start)), "superellipsoid")
            viewpoint = "0,0,0" if "view" in group else ""
            cloud = (data / case["file"]).resolve()
            groups.setdefault(group, []).append(Case(case["id"], group, cloud, case.get("hint") or guess, viewpoint))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise CannotRun(f"{data} is no data folder: index.json: {type(error).__name__}: {error}") from None
    if not groups:
        raise CannotRun("no class begins so; there are " + ", ".join(sorted({case["cls"] for case in listed})))
    groups = {group: cases[:per_class] for group, cases in groups.items()}
    for case in (case for cases in groups.values() for case in cases):
        if not case.cloud.is_file():
            raise CannotRun(f"{data / 'index.json'} lists {case.cloud}, which is not there")
    return groups


def time_cloud(fitters, case, repeats):
    """Each fitter's best CPU seconds, or the text of its failure."""
    times = {fitter.name: [] for fitter in fitters}
    failures = {}
    for _ in range(repeats):
        for fitter in fitters:
            if fitter.name not in failures:
                try:
                    times[fitter.name].append(fitter.fit(case))
                except FitFailed as error:
                    failures[fitter.name] = str(error)
    return {name: failures.get(name) or min(spent) for name, spent in times.items()}


def summary(group, clouds):
    """The row of a class from its clouds' times."""
    both = [cloud for cloud in clouds if all(isinstance(spent, float) for spent in cloud["cpu_s"].values())]
    ems = [1e3 * cloud["cpu_s"]["EMS"] for cloud in both]
    ours = [1e3 * cloud["cpu_s"]["supersurface"] for cloud in both]
    row = {
        "class": group,
        "n": len(clouds),
        "ems_failed": sum(isinstance(cloud["cpu_s"]["EMS"], str) for cloud in clouds),
        "supersurface_failed": sum(isinstance(cloud["cpu_s"]["supersurface"], str) for cloud in clouds),
        "both_fitted": len(both),
    }
    if both:
        row["ems_ms"] = statistics.median(ems)
        row["supersurface_ms"] = statistics.median(ours)
        row["supersurface_p99_ms"] = percentile(ours, 0.99)
        row["ratio"] = row["ems_ms"] / row["supersurface_ms"]
    return row


def percentile(values, share):
    """The value below which this share lies, linear between neighbours."""
    values = sorted(values)
    at = share * (len(values) - 1)
    low, high = values[math.floor(at)], values[math.ceil(at)]
    return low + (high - low) * (at - math.floor(at))


HEADER = f"{'class':22} {'n':>3} {'fitted EMS':>10} {'ours':>4} {'EMS ms':>8} {'ours ms':>8} {'p99':>8} {'ratio':>7}"


def line(row):
    n = row["n"]
    text = f"{row['class']:22} {n:3} {n - row['ems_failed']:10} {n - row['supersurface_failed']:4}"
    if "ratio" not in row:
        return text + "   no cloud that both fitted"
    ms = (row["ems_ms"], row["supersurface_ms"], row["supersurface_p99_ms"])
    return text + "".join(f" {value:8.2f}" for value in ms) + f" {row['ratio']:7.1f}"


def pin(core):
    """Binds this process and its children to one core; tells which, or None where the system cannot."""
    if not hasattr(os, "sched_setaffinity"):
        return None
    allowed = os.sched_getaffinity(0)
    if core is None:
        core = max(allowed)
    if core not in allowed:
        raise CannotRun(f"--core {core}: only {', '.join(map(str, sorted(allowed)))} can be used")
    os.sched_setaffinity(0, {core})
    return core


def compare(fitters, groups, repeats, say):
    """All rows and clouds; stops at Ctrl-C with the classes that are whole."""
    rows, clouds = [], []
    try:
        for group, cases in groups.items():
            measured = []
            for k, case in enumerate(cases):
                if sys.stderr.isatty():
                    print(f"\r{group} {k + 1}/{len(cases)}\033[K", end="\r", file=sys.stderr, flush=True)
                measured.append({"id": case.id, "class": group, "cpu_s": time_cloud(fitters, case, repeats)})
            clouds += measured
            rows.append(summary(group, measured))
            say(line(rows[-1]))
    except KeyboardInterrupt:
        return rows, clouds, False
    return rows, clouds, True


def say_end(rows, clouds, say):
    ratios = {row["class"]: row["ratio"] for row in rows if "ratio" in row}
    if ratios:
        least = min(ratios, key=ratios.get)
        say(f"\nEMS takes {statistics.median(ratios.values()):.1f} times our CPU time in the median class, "
            f"{ratios[least]:.1f} times in the least ({least})")  # fmt: skip
    for name, title in (("EMS", "EMS"), ("supersurface", "ours")):
        failed = [(cloud["id"], cloud["cpu_s"][name]) for cloud in clouds if isinstance(cloud["cpu_s"][name], str)]
        say(f"{title}: {len(clouds) - len(failed)} of {len(clouds)} clouds fitted")
        for cloud, why in failed[:10]:
            say(f"  {cloud}: {why}")
        if len(failed) > 10:
            say(f"  and {len(failed) - 10} more")


def arguments():
    def positive(text):
        if not (text.isdecimal() and int(text) > 0):
            raise argparse.ArgumentTypeError(f"{text} is no positive whole number")
        return int(text)

    def share(text):
        try:
            if 0 <= float(text) < 1:
                return float(text)
        except ValueError:
            pass
        raise argparse.ArgumentTypeError(f"{text} is not in 0 to 1")

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="DATA", type=Path, help="folder with index.json and the clouds it lists")
    parser.add_argument("--ems", required=True, help="where EMS is: its checkout, environment or package folder")
    parser.add_argument("--supersurface", required=True, help="our program")
    parser.add_argument("--python", help="the Python with EMS's packages [that of --ems's environment, or this one]")
    parser.add_argument("--w", type=share, default=0.1, help="EMS's outlier ratio, 0 to 1 [0.1, its own default]")
    parser.add_argument("--classes", default="", help="only classes whose names begin so, separated by commas")
    parser.add_argument("--per-class", type=positive, metavar="N", help="the first N clouds of each class [all]")
    parser.add_argument("--repeats", type=positive, default=2, help="fits of each cloud, the best counts [2]")
    parser.add_argument("--timeout", type=positive, default=120, metavar="S", help="seconds for one fit [120]")
    parser.add_argument("--core", type=int, help="the core to run on [the last]")
    parser.add_argument("--json", action="store_true", help="print JSON, with every cloud's times, and no table")
    return parser.parse_args()


def run(args, fitters):
    groups = read_cases(args.data, [start for start in args.classes.split(",") if start], args.per_class)
    core = pin(args.core)
    fitters.append(Supersurface(args.supersurface, args.timeout))
    fitters.append(Ems(args.ems, args.python, args.w, args.timeout))
    ours, ems = fitters
    say = (lambda _: None) if args.json else (lambda text: print(text, flush=True))
    versions = ", ".join(f"{name} {version}" for name, version in ems.versions.items())
    where = "any core" if core is None else f"core {core}"
    load = os.getloadavg()[0]
    say(f"EMS w = {args.w:g} ({versions}) and {ours.version}")
    say(f"CPU ms of the fit alone, best of {args.repeats}, one thread on {where}, load of the machine {load:.1f}\n")
    say(HEADER)
    rows, clouds, whole = compare(fitters, groups, args.repeats, say)
    say_end(rows, clouds, say)
    if args.json:
        ratios = [row["ratio"] for row in rows if "ratio" in row]
        print(json.dumps({
            "w": args.w, "ems": ems.versions, "supersurface": ours.version, "repeats": args.repeats, "core": core,
            "load": load, "complete": whole, "median_ratio": statistics.median(ratios) if ratios else None,
            "least_ratio": min(ratios, default=None), "classes": rows, "clouds": clouds,
        }, indent=1))  # fmt: skip
    if not whole:
        print(f"interrupted: {len(rows)} of {len(groups)} classes are whole", file=sys.stderr)
    return 0 if whole else 130


def main():
    args = arguments()
    fitters = []
    try:
        return run(args, fitters)
    except CannotRun as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted before anything was timed", file=sys.stderr)
        return 130
    finally:
        for ems in fitters[1:]:
            ems.close()


if __name__ == "__main__":
    sys.exit(main())
