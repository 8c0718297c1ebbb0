#!/usr/bin/env python3
"""Measures whether the covariance of our fits is honest.

    python compare/fit_calibration.py --supersurface target/release/supersurface DATA ...

Fits the superellipsoids of data folders whose truth is known, and says in what share of the fits the 90 % interval of
each parameter, estimate ± 1.645 standard deviations, holds the true value. Of the equivalent poses of a body the one
nearest to the fit counts. Fits with the axes in other roles are another optimum, not noise: they are counted apart.
Chance alone scatters a share of n fits by 30 %/√n, so that few clouds say little.
"""

import argparse
import json
import math
import sys
from pathlib import Path

from fit_speed import read_cases
from fitters import CannotRun, FitFailed, Supersurface
from geometry import equivalents, product, rotation, rotation_vector, transposed

PARAMETERS = ("a1", "a2", "a3", "e1", "e2", "x", "y", "z", "rx", "ry", "rz")
# Half the width of a 90 % interval in standard deviations.
INTERVAL = 1.645
# Turn in radians and relative change of the semi-axes, together, above which a fit is in other roles.
FAR = 0.5


def deviations(truth, report):
    """The errors of a fit in its own standard deviations, by parameter; None for axes in other roles."""
    surface, covariance = report["surface"], report["covariance"]
    variances = {name: row[k] for k, (name, row) in enumerate(zip(covariance["parameters"], covariance["matrix"]))}
    flat = [value for row in truth["R"] for value in (row if isinstance(row, list) else [row])]
    fitted = transposed(rotation(surface["orientation_wxyz"]))
    axes = surface["semi_axes"]

    def apart(candidate):
        return math.hypot(*candidate[1]) + max(abs(t - a) for t, a in zip(candidate[0], axes)) / max(axes)

    candidates = [
        ([truth["a"][k] for k in order], rotation_vector(product(fitted, matrix)))
        for order, matrix in equivalents([flat[0:3], flat[3:6], flat[6:9]])
    ]
    nearest = min(candidates, key=apart)
    if apart(nearest) > FAR:
        return None
    true = [*nearest[0], *truth["e"], *truth["t"], *nearest[1]]
    found = [*axes, *surface["exponents"], *surface["position"], 0.0, 0.0, 0.0]
    return {name: (f - t) / math.sqrt(variances[name]) for name, f, t in zip(PARAMETERS, found, true)}


def summary(name, fits):
    """The row of some fits, each a dict of deviations or the text why there are none."""
    known = [fit for fit in fits if isinstance(fit, dict)]
    row = {"class": name, "n": len(fits), "other_roles": fits.count("other roles")}
    row["failed"] = len(fits) - len(known) - row["other_roles"]
    if known:
        for key, value in (
            ("coverage", lambda z: sum(abs(v) < INTERVAL for v in z) / len(z)),
            ("mean", lambda z: sum(z) / len(z)),
            ("rms", lambda z: math.sqrt(sum(v * v for v in z) / len(z))),
        ):
            row[key] = {p: value([fit[p] for fit in known]) for p in PARAMETERS}
    return row


def line(row):
    text = f"{row['class']:20} {row['n']:4} {row['other_roles']:5} {row['failed']:6}"
    return text + "".join(f" {100 * value:5.1f}" for value in row.get("coverage", {}).values())


HEADER = f"{'class':20} {'n':>4} {'roles':>5} {'failed':>6}" + "".join(f" {name:>5}" for name in PARAMETERS)


def judge(fitter, case, truth):
    try:
        report = fitter.report(case)
        if not report.get("covariance"):
            return "no covariance"
        return deviations(json.loads(truth.read_text())["primitive"], report) or "other roles"
    except FitFailed as error:
        return str(error)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise CannotRun(f"{case.id}: no truth or no report that can be read: {type(error).__name__}: {error}") from None


def run(args):
    groups = {}
    for data in args.data:
        found = read_cases(data, args.classes.split(","), None)
        listed = json.loads((data / "index.json").read_text())["cases"]
        truths = {case["id"]: data / case.get("gt", case["file"].rsplit(".", 1)[0] + ".gt.json") for case in listed}
        for group, cases in found.items():
            if all(case.model == "superellipsoid" for case in cases):
                groups.setdefault(group, []).extend((case, truths[case.id]) for case in cases)
    fitter = Supersurface(args.supersurface, args.timeout)
    if not args.json:
        print(f"90 % intervals of {fitter.version}: share that holds the truth, in percent\n\n{HEADER}", flush=True)
    rows, sides = [], {"all around": [], "one view": []}
    for group, cases in groups.items():
        fits = [judge(fitter, case, truth) for case, truth in cases]
        sides["one view" if cases[0][0].viewpoint else "all around"] += fits
        rows.append(summary(group, fits))
        if not args.json:
            print(line(rows[-1]), flush=True)
    sides["all"] = [fit for fits in sides.values() for fit in fits]
    totals = [summary(name, fits) for name, fits in sides.items() if fits]
    if args.json:
        print(json.dumps({"supersurface": fitter.version, "classes": rows, "totals": totals}, indent=1))
    else:
        print("\n".join(["", *map(line, totals)]))
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "data", metavar="DATA", type=Path, nargs="+", help="folders with index.json, clouds and their .gt.json"
    )
    parser.add_argument("--supersurface", required=True, help="our program")
    parser.add_argument("--classes", default="b_,d_view_depth", help="classes whose names begin so [b_,d_view_depth]")
    parser.add_argument("--timeout", type=float, default=120, metavar="S", help="seconds for one fit [120]")
    parser.add_argument("--json", action="store_true", help="print JSON, with means and root mean squares")
    try:
        return run(parser.parse_args())
    except CannotRun as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
