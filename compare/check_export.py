#!/usr/bin/env python3
"""Loads exported scenes with the programs that they are for, and says whether these see what we meant.

    cargo run --release --example export_scene FOLDER
    python compare/check_export.py FOLDER/table FOLDER/workshop
    python compare/check_export.py --seeds 100 --supersurface target/release/supersurface

Each folder has a scene.json, whose masses, centres and inertias are the truth. With --seeds scenes are made and removed
again; one may have bodies that move, as long as few of all do. What is not installed is skipped, and said to be. Exit
status 1 when anything fails. README.md says how to install all of it.
"""

import argparse
import collections
import functools
import multiprocessing
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    from export_checks import OVERLAP, Scene, Skipped, Wrong, all_checks, sdf_links
except ImportError as error:
    sys.exit(f"check_export: {error.name} is not installed: pip install {error.name}")

RESTING = 0.98  # share of bodies that must not move, of many scenes
PATIENCE = 300  # seconds that a scene may take
RENEWED = 20  # scenes after which a process ends: the programs keep tens of megabytes of each
LAYOUTS, THINGS = ("pile", "packed", "shelf", "single"), ("household", "members")


def check(scene, checks):
    """Asks all programs: the format, the program, ok, FAILED or skipped, and what it said, for each."""
    for format, program, ask in checks:
        try:
            said, word = ask(scene), "ok"
        except Skipped as reason:
            said, word = str(reason), "skipped"
        except Wrong as problem:
            said, word = str(problem), "FAILED"
        except Exception as error:  # a program that refuses a file has errors of its own
            said, word = f"{type(error).__name__}: {str(error)[:300]}", "FAILED"
        yield format, program, word, said


def of_seed(options, seed):
    """Makes the scene of a seed, each of a layout and a list in turn: what was asked and said, and how it rests."""
    kinds = [(layout, things) for layout in LAYOUTS for things in THINGS]
    layout, things = kinds[seed % len(kinds)]
    with tempfile.TemporaryDirectory() as folder:
        made = [options.supersurface, "scene", "random", "--quiet", "--formats", "all", "-o", folder]
        made += ["--seed", str(seed), "--layout", layout, "--things", things]
        made += ["-n", "1"] if layout == "single" else []
        try:
            ran = subprocess.run(made, capture_output=True, text=True, timeout=PATIENCE)
            problem = ran.stderr.strip()[:300] if ran.returncode else None
        except subprocess.TimeoutExpired:
            problem = f"not made in {PATIENCE} s"
        rows = [("scene", "random", "FAILED" if problem else "ok", problem)]
        if problem:
            return f"seed {seed}: {layout} of {things}", rows, None
        scene = Scene(Path(folder))
        rows += check(scene, all_checks(options.node_modules))
        return f"seed {seed}: {layout} of {things}", rows, scene.rest


def of_seeds(options, totals):
    """Scenes of many seeds; `totals` gets how often each program passed, failed and was skipped."""
    rests = []
    sdf_links()  # once for all processes
    seeds = range(options.first, options.first + options.seeds)
    with multiprocessing.get_context("fork").Pool(options.jobs, maxtasksperchild=RENEWED) as pool:
        for title, rows, rest in pool.imap(functools.partial(of_seed, options), seeds):
            print(title, flush=True)
            tell(rows, totals, True)
            rests += [rest] if rest else []
    if not rests:
        return
    bodies, moved = sum(r["bodies"] for r in rests), sum(len(r["moved"]) for r in rests)
    worst = max(r["overlap"] for r in rests)
    print(f"{moved} of {bodies} bodies moved ({1 - moved / bodies:.2%} rest), worst overlap {worst * 1e3:.3f} mm")
    # single bodies may
    if moved <= (1 - RESTING) * bodies and worst < OVERLAP:
        totals["MJCF", "MuJoCo, rest"]["FAILED"] = 0


def tell(rows, totals, quietly):
    for format, program, word, said in rows:
        totals[format, program][word] += 1
        if word == "FAILED" or not quietly:
            print(f"  {format:14} {program:14} {word:8} {said}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folders", nargs="*", type=Path, help="folders with a scene.json and all formats")
    parser.add_argument("--seeds", type=int, default=0, help="scenes to make and check")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--jobs", type=int, default=1, help="processes that check them")
    parser.add_argument("--supersurface", help="the command that makes them")
    parser.add_argument("--node-modules", default=".", help="folder in which npm installed gltf-validator")
    options = parser.parse_args()
    if options.seeds and not options.supersurface or not options.seeds and not options.folders:
        parser.error("give folders, or --seeds with --supersurface")
    totals = collections.defaultdict(collections.Counter)
    for folder in options.folders:
        try:
            scene = Scene(folder)
        except (OSError, ValueError, KeyError) as error:
            sys.exit(f"check_export: {folder}/scene.json: {type(error).__name__}: {error}")
        print(f"{folder}: {len(scene.bodies)} bodies, {len(scene.parts)} parts")
        tell(check(scene, all_checks(options.node_modules)), totals, False)
    if options.seeds:
        of_seeds(options, totals)
        for (format, program), words in totals.items():
            print(f"  {format:14} {program:14} " + ", ".join(f"{count} {word}" for word, count in words.items() if count))
    passed, failed, skipped = (sum(words[word] for words in totals.values()) for word in ("ok", "FAILED", "skipped"))
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
