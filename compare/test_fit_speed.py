"""The comparison against a made peer and a made program: python -m unittest discover compare"""

import importlib.util
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest
from pathlib import Path

COMMAND = Path(__file__).with_name("fit_speed.py")

PEER = """
    import time
    from types import SimpleNamespace

    def EMS_recovery(points, OutlierRatio):
        print("a word that is no answer")
        if len(points) == 3:
            raise ArithmeticError("three are too few")
        while len(points) == 5:
            time.sleep(0.01)
        spent = time.process_time() + 0.02
        while time.process_time() < spent:
            pass
        return SimpleNamespace(shape=[1.0, 1.0], scale=[1.0], euler=[0.0], translation=points[0]), None
"""

PROGRAM = """
    #!{python}
    import json, os, sys
    if "--version" in sys.argv:
        print("supersurface of the test")
    elif "--help" not in sys.argv:
        cloud, again = sys.argv[2:4]
        assert cloud == again
        if "broken" in cloud:
            sys.exit("error: broken")
        assert os.environ["RAYON_NUM_THREADS"] == "1"
        assert ("supertoroid" in sys.argv) == ("e_tor" in cloud)
        assert any(a.startswith("--viewpoint=") for a in sys.argv) == ("view" in cloud)
        for spent in (0.002, 0.001):
            print(json.dumps({{"cpu_s": spent, "surface": {{}}}}))
"""


def write_cloud(path, count):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
    header += "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + struct.pack(f"<{3 * count}f", *range(3 * count)))


@unittest.skipUnless(importlib.util.find_spec("numpy"), "the peer's side reads clouds with numpy")
class FitSpeed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.peer = self.folder / "peer"
        (self.peer / "EMS").mkdir(parents=True)
        (self.peer / "EMS" / "__init__.py").touch()  # comes before a real EMS that is installed
        (self.peer / "EMS" / "EMS_recovery.py").write_text(textwrap.dedent(PEER))
        for package in ("scipy", "numba"):
            if not importlib.util.find_spec(package):
                info = self.peer / f"{package}-0.dist-info"
                info.mkdir()
                (info / "METADATA").write_text(f"Name: {package}\nVersion: 0\n")
        self.program = self.folder / "supersurface"
        self.program.write_text(textwrap.dedent(PROGRAM).format(python=sys.executable).lstrip())
        self.program.chmod(0o755)

    def data(self, **sizes):
        """A data folder with one cloud of this many points for each class."""
        data = self.folder / "data"
        data.mkdir()
        for group, count in sizes.items():
            write_cloud(data / f"{group}.ply", count)
        cases = [{"id": f"{group}_0", "cls": group, "file": f"{group}.ply"} for group in sizes]
        (data / "index.json").write_text(json.dumps({"cases": cases}))
        return data

    def command(self, data, *options):
        fixed = ["--ems", self.peer, "--supersurface", self.program, data]
        return [sys.executable, COMMAND, *map(str, fixed), *options]

    def run_command(self, data, *options):
        return subprocess.run(self.command(data, *options), capture_output=True, text=True, timeout=60)

    def test_times_are_the_fits_and_failures_count(self):
        data = self.data(a=10, e_tor_view=10, f_few=3, g_broken=10)
        done = self.run_command(data, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        answer = json.loads(done.stdout)
        self.assertTrue(answer["complete"])
        a, toroid, few, broken = answer["classes"]
        for row in (a, toroid):
            self.assertAlmostEqual(row["supersurface_ms"], 1.0)
            self.assertTrue(20 <= row["ems_ms"] < 25, row)
            self.assertAlmostEqual(row["ratio"], row["ems_ms"])
        self.assertEqual((few["ems_failed"], few["supersurface_failed"], few["both_fitted"]), (1, 0, 0))
        self.assertEqual((broken["ems_failed"], broken["supersurface_failed"], broken["both_fitted"]), (0, 1, 0))
        table = self.run_command(data, "--classes", "f").stdout
        self.assertIn("f_few_0: ArithmeticError: three are too few", table)

    def test_a_fit_without_end_is_a_failure(self):
        done = self.run_command(self.data(a=5), "--timeout", "1")
        self.assertIn("a_0: TimeoutError: out of time", done.stdout)

    def test_what_is_missing_is_named(self):
        data = self.data(a=10)
        for options, text in (
            (["--ems", str(self.folder)], "holds no package EMS"),
            (["--supersurface", "/nowhere"], "no program at /nowhere"),
            (["--python", "/nowhere"], "no Python at /nowhere"),
            (["--classes", "z"], "no class begins so; there are a"),
        ):
            done = self.run_command(data, *options)
            self.assertEqual(done.returncode, 2)
            self.assertIn(text, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
        (self.peer / "EMS" / "EMS_recovery.py").write_text("import a_missing_package")
        self.assertIn("No module named 'a_missing_package'", self.run_command(data).stderr)

    def test_ctrl_c_keeps_whole_classes(self):
        process = subprocess.Popen(
            self.command(self.data(a=10, b=5)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        while not process.stdout.readline().startswith("a "):
            pass
        time.sleep(0.2)
        os.kill(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130)
        self.assertIn("EMS: 1 of 1 clouds fitted", out)
        self.assertIn("interrupted: 1 of 2 classes are whole", err)
        self.assertNotIn("Traceback", err)


if __name__ == "__main__":
    unittest.main()
