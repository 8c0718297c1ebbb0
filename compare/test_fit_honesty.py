"""The checks of calibration and invariance against a made program: python -m unittest discover compare"""

import json
import math
import random
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

from fit_calibration import PARAMETERS, deviations
from fit_invariance import Motion, difference, read_ply, write_ply
from geometry import equivalents, product, rotation, rotation_vector, surface_points

HERE = Path(__file__).parent

# A fitter for which a cloud is a ball about its first point that reaches its second, sure to 1; off in x by 2 where the
# file's name says so.
PROGRAM = """
    #!{python}
    import array, json, math, sys
    if "--version" in sys.argv:
        print("supersurface of the test")
    elif "--help" not in sys.argv:
        cloud = sys.argv[2]
        values = array.array("d")
        values.frombytes(open(cloud, "rb").read().partition(b"end_header\\n")[2])
        p, size = list(values[0:3]), math.dist(values[0:3], values[3:6])
        p[0] += 2.0 if "wrong" in cloud else 0.0
        surface = {{"type": "superellipsoid", "semi_axes": [size] * 3, "exponents": [1.0, 1.0],
                   "position": p, "orientation_wxyz": [1.0, 0.0, 0.0, 0.0]}}
        names = "a1 a2 a3 e1 e2 x y z rx ry rz".split()
        matrix = [[float(i == j) for i in names] for j in names]
        answer = {{"cpu_s": 0.1, "surface": surface, "covariance": {{"parameters": names, "matrix": matrix}}}}
        print(json.dumps(answer))
"""


def body(**other):
    surface = {"type": "superellipsoid", "semi_axes": [0.3, 0.2, 0.1], "exponents": [0.4, 1.3],
               "position": [1.0, -2.0, 0.5], "orientation_wxyz": [0.5, -0.1, 0.7, 0.2]}  # fmt: skip
    return {**surface, **other}


class Geometry(unittest.TestCase):
    def test_rotations(self):
        matrix = rotation([math.cos(0.6), 0.0, math.sin(0.6), 0.0])
        self.assertTrue(all(abs(v - w) < 1e-12 for v, w in zip(rotation_vector(matrix), [0.0, 1.2, 0.0])))
        self.assertEqual(len(list(equivalents(matrix))), 8)

    def test_equivalent_poses_have_the_same_points(self):
        for extra in ({}, {"type": "supertoroid", "ring_ratio": 2.5}):
            here = surface_points(body(**extra))
            turn = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
            quarter = [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
            w, x, y, z = body()["orientation_wxyz"]
            a, _, _, d = quarter
            turned = [a * w - d * z, a * x + d * y, a * y - d * x, a * z + d * w]
            same = product(rotation(body()["orientation_wxyz"]), turn)
            self.assertLess(max(abs(v - s) for r, t in zip(rotation(turned), same) for v, s in zip(r, t)), 1e-12)
            other = surface_points(body(semi_axes=[0.2, 0.3, 0.1], orientation_wxyz=turned, **extra))
            self.assertLess(max(min(math.dist(p, q) for q in other) for p in here), 1e-12)


class Calibration(unittest.TestCase):
    def test_deviations_are_those_of_the_nearest_equivalent(self):
        surface = body()
        matrix = [[0.01 * (i == j) for i in range(11)] for j in range(11)]
        report = {"surface": surface, "covariance": {"parameters": list(PARAMETERS), "matrix": matrix}}
        straight = rotation(surface["orientation_wxyz"])
        for order, turned in equivalents(straight):
            axes = [surface["semi_axes"][k] for k in order]
            truth = {"a": axes, "e": [0.5, 1.3], "t": [1.0, -2.0, 0.7], "R": turned}
            found = deviations(truth, report)
            expected = {**dict.fromkeys(PARAMETERS, 0.0), "e1": -1.0, "z": -2.0}
            for name in PARAMETERS:
                self.assertAlmostEqual(found[name], expected[name], msg=name)
        # another axis along z is another role
        cycled = [[row[k] for k in (1, 2, 0)] for row in straight]
        self.assertIsNone(deviations({"a": [0.2, 0.1, 0.3], "e": [1, 1], "t": [0, 0, 0], "R": cycled}, report))


class Invariance(unittest.TestCase):
    def test_a_moved_surface_is_the_same_and_a_changed_one_not(self):
        for extra in ({}, {"deformations": {"taper": [0.3, -0.2], "bend": {"k": 2.0, "alpha": 0.4}}}):
            still = Motion(1e-9, 0.6, random.Random(1), still=True)
            small = body(semi_axes=[3e-10, 2e-10, 1e-10], position=[1e-9, -2e-9, 5e-10], **extra)
            if extra:
                small["deformations"] = {**extra["deformations"], "bend": {"k": 2e9, "alpha": 0.4}}
            self.assertLess(difference(body(**extra), small, still), 1e-9)
            self.assertGreater(difference(body(**extra), {**small, "exponents": [0.4, 1.31]}, still), 1e-3)

    def test_motions_go_back(self):
        motion = Motion(1e3, 2.0, random.Random(3))
        p = [0.1, 0.2, -0.3]
        self.assertLess(math.dist(motion.back(motion.there(p)), p), 1e-12)


class Commands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.data = Path(folder.name)
        self.program = self.data / "supersurface"
        self.program.write_text(textwrap.dedent(PROGRAM).format(python=sys.executable).lstrip())
        self.program.chmod(0o755)
        cases = []
        for name in ("b_right", "b_wrong"):
            write_ply(self.data / f"{name}.ply", [[1.0, 2.0, 3.0], [1.0, 2.0, 4.0]])
            truth = {"a": [1.0] * 3, "e": [1.0, 1.0], "t": [1.0, 2.0, 3.0], "R": [1, 0, 0, 0, 1, 0, 0, 0, 1]}
            (self.data / f"{name}.gt.json").write_text(json.dumps({"primitive": truth}))
            cases.append({"id": name, "cls": "b", "file": f"{name}.ply"})
        (self.data / "index.json").write_text(json.dumps({"cases": cases}))

    def answer(self, script, *options):
        command = [sys.executable, HERE / script, self.data, "--supersurface", self.program, "--json", *options]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_calibration_counts_what_the_intervals_hold(self):
        (row,) = self.answer("fit_calibration.py", "--classes", "b")["classes"]
        self.assertEqual((row["n"], row["other_roles"], row["failed"]), (2, 0, 0))
        self.assertEqual((row["coverage"]["x"], row["coverage"]["y"]), (0.5, 1.0))

    def test_invariance_tells_the_clouds_apart(self):
        self.assertEqual(read_ply(self.data / "b_right.ply"), [[1.0, 2.0, 3.0], [1.0, 2.0, 4.0]])
        # the program's sphere moves along with the cloud
        self.assertEqual(self.answer("fit_invariance.py", "--scales", "1e-3,1e3", "--still")["same"], 1.0)


if __name__ == "__main__":
    unittest.main()
