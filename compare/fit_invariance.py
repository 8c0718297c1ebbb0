#!/usr/bin/env python3
"""Measures whether our fits depend on where the frame stands and on the unit.

    python compare/fit_invariance.py --supersurface target/release/supersurface DATA

Fits each cloud as it is and moved and scaled (a turn and a shift by chance for each scale), all written in double
precision, maps the surfaces back and says on what share of the clouds they are the same: points of one lie within
1e-6 of its size of the other's, and the exponents agree as well. The sensor of a view moves along.
"""

import argparse
import array
import json
import math
import random
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from fit_speed import read_cases
from fitters import CannotRun, FitFailed, Supersurface
from geometry import rotation, surface_points, transposed, turned

SAME = 1e-6


def read_ply(path):
    """The points of a binary little-endian PLY file with nothing but x, y, z of one type."""
    head, found, body = path.read_bytes().partition(b"end_header\n")
    lines = head.decode("latin-1").split("\n")
    kinds = [line.split()[1] for line in lines if line.startswith("property")]
    code = {"float": "f", "float32": "f", "double": "d", "float64": "d"}.get(kinds[0] if kinds else "")
    count = next((int(line.split()[2]) for line in lines if line.startswith("element vertex")), 0)
    if not found or "format binary_little_endian 1.0" not in lines or len(kinds) != 3 or len(set(kinds)) != 1 or not code:
        raise CannotRun(f"{path}: only binary little-endian PLY with x, y, z alone can be moved")
    values = array.array(code)
    values.frombytes(body[: 3 * count * values.itemsize])
    if sys.byteorder == "big":
        values.byteswap()
    return [list(values[i : i + 3]) for i in range(0, 3 * count, 3)]


def write_ply(path, points):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    values = array.array("d", (value for p in points for value in p))
    if sys.byteorder == "big":
        values.byteswap()
    path.write_bytes(header.encode() + values.tobytes())


class Motion:
    """`x -> scale (R x + t)` and back."""

    def __init__(self, scale, size, chance, still=False):
        self.scale = scale
        self._turn = rotation([1.0, 0.0, 0.0, 0.0] if still else [chance.gauss(0, 1) for _ in range(4)])
        self._shift = [0.0 if still else size * chance.uniform(-2, 2) for _ in range(3)]

    def there(self, p):
        return [self.scale * (q + t) for q, t in zip(turned(self._turn, p), self._shift)]

    def back(self, p):
        return turned(transposed(self._turn), [q / self.scale - t for q, t in zip(p, self._shift)])


def difference(surface, other, motion):
    """Between a surface and another in a moved frame: greatest distance of points in sizes, or of exponents."""
    if surface["type"] != other["type"]:
        return math.inf
    here, there = surface_points(surface), [motion.back(p) for p in surface_points(other)]
    size = max(max(column) - min(column) for column in zip(*here))
    # in order where the poses are the same, else the nearest
    gap = max(map(math.dist, here, there))
    if gap > SAME * size:
        gap = max(min(math.dist(p, q) for q in there) for p in here)
    exponents = zip(surface["exponents"], other["exponents"])
    return max(gap / size, *(abs(e - f) for e, f in exponents))


def compare(fitter, case, args, folder):
    """The differences of a cloud's fits from the one of the cloud as it is, by scale."""
    points = read_ply(case.cloud)
    size = max(max(column) - min(column) for column in zip(*points))
    chance = random.Random(f"{args.seed} {case.id}")
    cloud = Path(folder, "cloud.ply")

    def fitted(motion):
        write_ply(cloud, [motion.there(p) for p in points] if motion else points)
        sensor = [float(value) for value in case.viewpoint.split(",")] if case.viewpoint else []
        sensor = motion.there(sensor) if motion and sensor else sensor
        return fitter.report(replace(case, cloud=cloud, viewpoint=",".join(map(repr, sensor))))["surface"]

    reference = fitted(None)
    found = {}
    for scale in args.scales:
        motion = Motion(scale, size, chance, args.still)
        try:
            found[scale] = difference(reference, fitted(motion), motion)
        except FitFailed as error:
            print(f"{case.id} at scale {scale:g}: {error}", file=sys.stderr)
            found[scale] = math.inf
    return found


def run(args):
    groups = read_cases(args.data, [start for start in args.classes.split(",") if start], args.per_class)
    fitter = Supersurface(args.supersurface, args.timeout)
    columns = "".join(f" {scale:>7g}" for scale in args.scales)
    if not args.json:
        print(f"Share of clouds whose moved fits of {fitter.version} are the same to {SAME:g}, in percent, by scale\n")
        print(f"{'class':20} {'n':>4}{columns} {'all':>6}", flush=True)
    clouds = []

    def row(name, some):
        shares = [[cloud["difference"][scale] <= SAME for cloud in some] for scale in args.scales]
        shares.append([cloud["same"] for cloud in some])
        text = "".join(f" {100 * sum(same) / len(some):7.1f}" for same in shares[:-1])
        return f"{name:20} {len(some):4}{text} {100 * sum(shares[-1]) / len(some):6.1f}"

    with tempfile.TemporaryDirectory() as folder:
        for group, cases in groups.items():
            some = []
            for case in cases:
                try:
                    found = compare(fitter, case, args, folder)
                except FitFailed as error:
                    print(f"{case.id} as it is: {error}", file=sys.stderr)
                    found = dict.fromkeys(args.scales, math.inf)
                same = all(value <= SAME for value in found.values())
                some.append({"id": case.id, "class": group, "difference": found, "same": same})
            clouds += some
            if not args.json:
                print(row(group, some), flush=True)
    if args.json:
        for cloud in clouds:
            found = cloud["difference"].items()
            cloud["difference"] = {f"{scale:g}": value if value < math.inf else None for scale, value in found}
        share = sum(cloud["same"] for cloud in clouds) / len(clouds)
        print(json.dumps({"supersurface": fitter.version, "seed": args.seed, "same": share, "clouds": clouds}, indent=1))
    else:
        print("\n" + row("all", clouds))
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="DATA", type=Path, help="folder with index.json and the clouds it lists")
    parser.add_argument("--supersurface", required=True, help="our program")
    parser.add_argument("--classes", default="", help="only classes whose names begin so, separated by commas")
    parser.add_argument("--per-class", type=int, metavar="N", help="the first N clouds of each class [all]")
    parser.add_argument("--scales", type=lambda text: [float(value) for value in text.split(",")],
                        default=[1.0, 1e-9, 1e-3, 1e3, 1e9], help="[1,1e-9,1e-3,1e3,1e9]")  # fmt: skip
    parser.add_argument("--still", action="store_true", help="scale only, neither turn nor shift")
    parser.add_argument("--seed", type=int, default=1, help="of the motions [1]")
    parser.add_argument("--timeout", type=float, default=120, metavar="S", help="seconds for one fit [120]")
    parser.add_argument("--json", action="store_true", help="print JSON, with every cloud's differences, and no table")
    try:
        return run(parser.parse_args())
    except CannotRun as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
