#!/usr/bin/env python3
"""Times coal's distance queries on convex hulls of the pairs that the crate in compare/contact times ours on.

    compare-contact --write-pairs PAIRS.jsonl
    python compare/contact_coal.py PAIRS.jsonl

coal has no superellipsoids: each body becomes the hull of points on its surface. The times are those of coal's own
C++ query: the same Python loop over pairs of spheres, whose distance coal has in closed form, is timed as well and
taken off. Needs the Python packages coal and numpy.
"""

import argparse
import json
import os
import statistics
import sys
import time
from pathlib import Path

try:
    import coal
    import numpy as np
except ImportError as error:
    sys.exit(f"contact_coal: {error.name} is not installed: pip install coal numpy")

BATCHES, QUERIES, PASSES = 5, 16, 3  # as in the crate
GOLDEN_ANGLE = np.pi * (3 - 5**0.5)


def read_pairs(path, most):
    """The pairs by regime, at most so many of each, in the file's order."""
    regimes = {}
    try:
        for number, line in enumerate(path.read_text().splitlines(), 1):
            pair = json.loads(line)
            for body in (pair["A"], pair["B"]):
                if [len(body[key]) for key in "aeqt"] != [3, 2, 4, 3]:
                    raise ValueError("a body needs 3 semi-axes a, 2 exponents e, a quaternion q and a centre t")
            group = regimes.setdefault(pair["regime"], [])
            if len(group) < most:
                group.append(pair)
    except OSError as error:
        sys.exit(f"contact_coal: cannot read {path}: {error.strerror}")
    except (ValueError, KeyError, TypeError) as error:
        sys.exit(f"contact_coal: {path}, line {number}: {type(error).__name__}: {error}")
    if not regimes:
        sys.exit(f"contact_coal: {path} has no pairs")
    return regimes


def norm(u, v, power):
    """`(u^power + v^power)^(1/power)` of two arrays that are nowhere both 0."""
    largest = np.maximum(u, v)
    return largest * ((u / largest) ** power + (v / largest) ** power) ** (1 / power)


def directions(count):
    """Spread evenly over the sphere."""
    k = np.arange(count) + 0.5
    z = 1 - 2 * k / count
    radius, angle = np.sqrt(1 - z * z), GOLDEN_ANGLE * k
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)


def points_by_rays(body, count):
    """Where rays from the centre, stretched like the body, meet its surface."""
    rays = directions(count)
    x, y, z = np.abs(rays).T
    gauge = norm(norm(x, y, 2 / body["e"][1]), z, 2 / body["e"][0])
    return rays / gauge[:, None] * body["a"]


def points_by_normals(body, count):
    """Where the surface has normals that are stretched inversely: crowded where it bends sharply."""
    normals = directions(count)
    (x, y, z), (e1, e2) = np.abs(normals).T, body["e"]
    planar = norm(x, y, 2 / (2 - e2))
    whole = norm(planar, z, 2 / (2 - e1))
    t1, t2 = e1 / (2 - e1), e2 / (2 - e2)
    share = (planar / whole) ** t1
    unit = np.stack([share * (x / planar) ** t2, share * (y / planar) ** t2, (z / whole) ** t1], axis=1)
    return np.copysign(unit, normals) * body["a"]


def hull(body, vertices):
    """coal's hull of points of the surface. Neither kind alone does: rays miss the corners of boxes, normals the
    edges of octahedra."""
    points = coal.StdVec_Vec3s()
    for point in (*points_by_rays(body, vertices // 2), *points_by_normals(body, vertices - vertices // 2)):
        points.append(point)
    return coal.Convex.convexHull(points, True, "Qt")  # triangulated, as coal asks for


def transform(body):
    w, x, y, z = body["q"]
    return coal.Transform3s(coal.Quaternion(w, x, y, z), np.array(body["t"]))


class Query:
    """One pair of shapes at its poses. It holds the shapes, as coal's functor does not."""

    def __init__(self, shapes, pair):
        self.shapes = shapes
        self.call = (coal.ComputeDistance(*shapes), transform(pair["A"]), transform(pair["B"]))


def new_request():
    """coal's defaults: signed distances with nearest points and a normal, tolerances of 1e-6, nothing cached."""
    return coal.DistanceRequest(), coal.DistanceResult()


def repeated(query):
    """Microseconds of the same query again and again, best batch, Python's share included."""
    function, a, b = query.call
    request, result = new_request()
    best = float("inf")
    for _ in range(BATCHES):
        start = time.perf_counter()
        for _ in range(QUERIES):
            result.clear()
            function(a, b, request, result)
        best = min(best, time.perf_counter() - start)
    return 1e6 * best / QUERIES


def streaming(queries):
    """Mean microseconds of one pass over distinct pairs, best pass, Python's share included."""
    calls = [query.call for query in queries]
    request, result = new_request()
    best = float("inf")
    for _ in range(PASSES):
        start = time.perf_counter()
        for function, a, b in calls:
            result.clear()
            function(a, b, request, result)
        best = min(best, time.perf_counter() - start)
    return 1e6 * best / len(calls)


def errors(queries, pairs):
    """Errors over size where the true distance is known, and the number of wrong signs among them."""
    found, wrong = [], 0
    request, result = new_request()
    for query, pair in zip(queries, pairs, strict=True):
        if pair.get("distance") is not None:
            result.clear()
            function, a, b = query.call
            distance = function(a, b, request, result)
            found.append(abs(distance - pair["distance"]) / pair["size"])
            wrong += distance * pair["distance"] <= 0
    return sorted(found), wrong


def measure(regime, pairs, vertices):
    """The row of a regime."""
    hulls = [Query([hull(pair[which], vertices) for which in "AB"], pair) for pair in pairs]
    # as many spheres, so that Python's own loop and objects cost the same
    spheres = [Query([coal.Sphere(0.5), coal.Sphere(0.4)], pair) for pair in pairs]
    taken = [(repeated(sphere), repeated(query)) for sphere, query in zip(spheres, hulls, strict=True)]
    overhead = statistics.median(sphere for sphere, _ in taken)
    times = [spent - overhead for _, spent in taken]
    stream_overhead = streaming(spheres)
    found, wrong = errors(hulls, pairs)
    at = lambda share: found[round(share * (len(found) - 1))] if found else None
    return {
        "regime": regime, "pairs": len(pairs),
        "vertices_median": statistics.median(shape.num_points for query in hulls for shape in query.shapes),
        "cold_median_us": statistics.median(times), "cold_mean_us": statistics.mean(times),
        "streaming_us": streaming(hulls) - stream_overhead,
        "overhead_us": overhead, "streaming_overhead_us": stream_overhead,
        "known": len(found), "error_median": at(0.5), "error_99": at(0.99), "error_largest": at(1),
        "wrong_sign_percent": 100 * wrong / len(found) if found else None,
    }  # fmt: skip


def line(row):
    def number(value, form):
        return "-" if value is None else format(value, form)

    errors = " ".join(f"{number(row[key], '.0e'):>8}" for key in ("error_median", "error_99", "error_largest"))
    return (
        f"{row['regime']:9} {row['pairs']:6} {row['vertices_median']:8.0f}  {row['cold_median_us']:7.2f} "
        f"{row['cold_mean_us']:8.2f} {row['streaming_us']:10.2f}  {row['overhead_us']:6.2f} "
        f"{row['streaming_overhead_us']:6.2f}  {errors}  {number(row['wrong_sign_percent'], '.2f'):>6}"
    )


def positive(text):
    if not (text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"{text} is no positive whole number")
    return int(text)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pairs", metavar="PAIRS", type=Path, help="the file that --write-pairs of the crate made")
    parser.add_argument("--vertices", type=positive, default=500, help="points that a hull is made of [500]")
    parser.add_argument("--pairs-per-regime", type=positive, default=1000, metavar="N", help="the first N [1000]")
    parser.add_argument("--core", type=int, help="the core to run on [any]")
    parser.add_argument("--json", action="store_true", help="print JSON instead of the table")
    args = parser.parse_args()
    if args.vertices < 20:
        parser.error("a hull needs 20 vertices or more")
    return args


def main():
    args = arguments()
    regimes = read_pairs(args.pairs, args.pairs_per_regime)
    if args.core is not None:
        try:
            os.sched_setaffinity(0, {args.core})
        except (OSError, OverflowError, AttributeError):
            sys.exit(f"contact_coal: cannot run on core {args.core}")
    rows = []
    if not args.json:
        print(
            f"coal {coal.__version__}, hulls of {args.vertices} points. Microseconds of coal's query alone: median and "
            "mean of one\npair again and again, mean of one pass over all pairs; py: Python's share, taken off.\n\n"
            "regime     pairs vertices  cold us  mean us  stream us   py us py str     err50    err99  largest  sign %"
        )
    for regime, pairs in regimes.items():
        rows.append(measure(regime, pairs, args.vertices))
        if not args.json:
            print(line(rows[-1]), flush=True)
    if args.json:
        print(json.dumps({"coal": coal.__version__, "vertices": args.vertices, "rows": rows}, indent=1))


if __name__ == "__main__":
    main()
