"""The two fitters that are compared, each as `fit(case) -> CPU seconds of the fit alone`.

Both raise `FitFailed` where a fit fails (that is counted) and `CannotRun` where there is no use in going on.
"""

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

THREADS = (
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS", "NUMEXPR_NUM_THREADS", "NUMBA_NUM_THREADS", "RAYON_NUM_THREADS",
)  # fmt: skip


class FitFailed(Exception):
    """This cloud has no fit; the text says why."""


class CannotRun(Exception):
    """A fitter is missing or broken; the text says what to do."""


def one_thread():
    """The environment of a child that computes on one thread, set before it loads anything."""
    return {**os.environ, **dict.fromkeys(THREADS, "1")}


class Ems:
    """EMS in a process of its own, warmed up once and then asked for one fit after another."""

    name = "EMS"

    def __init__(self, path, python, outlier_ratio, allowed_s):
        package = ems_folder(Path(path))
        self.python = python or python_of(package)
        worker = Path(__file__).with_name("ems_worker.py")
        self._command = [self.python, str(worker), str(package), str(outlier_ratio), str(allowed_s)]
        self._errors = tempfile.TemporaryFile("w+")
        self._start()

    def _start(self):
        print("EMS warms up", file=sys.stderr)
        try:
            self._process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True,
                env=one_thread(), start_new_session=True,
            )  # fmt: skip
        except OSError as error:
            raise CannotRun(f"no Python at {self.python}: {error.strerror}") from None
        try:
            self.versions = self._answer()
        except FitFailed as error:
            self.close()
            raise CannotRun(
                f"EMS does not run under {self.python}: {error}\n"
                "It needs numpy, scipy, numba and plyfile there; --python names another Python"
            ) from None
        except KeyboardInterrupt:
            self.close()
            raise

    def _answer(self):
        line = self._process.stdout.readline()
        if not line:
            self._errors.seek(0)
            last = self._errors.read().strip().splitlines()[-1:]
            raise FitFailed("its process ended" + "".join(f": {text}" for text in last))
        answer = json.loads(line)
        if "error" in answer:
            raise FitFailed(answer["error"])
        return answer

    def fit(self, case):
        if self._process.poll() is not None:
            self._start()
        try:
            print(json.dumps({"cloud": str(case.cloud)}), file=self._process.stdin, flush=True)
            return self._answer()["cpu_s"]
        except BrokenPipeError:
            raise FitFailed("its process ended") from None

    def close(self):
        self._process.kill()
        self._process.wait()


def ems_folder(path):
    """The folder that holds the package EMS: the path itself, or where a checkout or an environment keeps it."""
    inside = [path, path / "src", path / "Python" / "src", *path.glob("lib/python3*/site-packages")]
    for folder in [*inside, path.parent] if path.name == "EMS" else inside:
        if (folder / "EMS" / "EMS_recovery.py").is_file():
            return folder.resolve()
    what = "holds no package EMS" if path.is_dir() else "is no folder"
    raise CannotRun(f"--ems {path} {what}: name the folder where it is installed (compare/README.md says how)")


def python_of(folder):
    """The Python of the virtual environment that the folder belongs to, or else the one that runs this."""
    for parent in (folder, *folder.parents):
        if (parent / "pyvenv.cfg").is_file():
            return str(parent / "bin" / "python")
    return sys.executable


class Supersurface:
    """Our command; its reports tell the CPU time of the fits without the files."""

    name = "supersurface"

    def __init__(self, path, allowed_s):
        found = shutil.which(path)
        if not found:
            raise CannotRun(f"no program at {path}: build it by `cargo build --release`, or correct --supersurface")
        self._program = str(Path(found).resolve())
        self._allowed_s = allowed_s
        try:
            version = subprocess.run([self._program, "--version"], capture_output=True, text=True, timeout=10)
            helped = subprocess.run([self._program, "fit", "--help"], capture_output=True, timeout=10)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise CannotRun(f"{path} does not run: {error}") from None
        if helped.returncode != 0:
            raise CannotRun(f"{path} has no subcommand fit: build it again from this repository")
        self.version = version.stdout.strip()

    def fit(self, case):
        """The second of two fits in one process, as EMS's is not the first of its own."""
        spent = self._reports(case, 2)[-1].get("cpu_s")
        if not (isinstance(spent, float) and spent > 0):
            raise FitFailed("no cpu_s in the report")
        return spent

    def report(self, case):
        """The whole report of a fit."""
        return self._reports(case, 1)[0]

    def _reports(self, case, count):
        command = [self._program, "fit", *[str(case.cloud)] * count, "--json", "--model", case.model]
        if case.viewpoint:
            command.append(f"--viewpoint={case.viewpoint}")
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, errors="replace", timeout=self._allowed_s, env=one_thread()
            )
        except subprocess.TimeoutExpired:
            raise FitFailed("TimeoutError: out of time") from None
        if done.returncode != 0:
            last = done.stderr.strip().splitlines()[-1:] or [f"exit status {done.returncode}"]
            raise FitFailed(last[0])
        try:
            answers = list(json_values(done.stdout))
        except ValueError as error:
            raise FitFailed(f"no report: {error}") from None
        if len(answers) != count:
            raise FitFailed(f"{len(answers)} reports of {count} fits")
        for answer in answers:
            if not isinstance(answer, dict):
                raise FitFailed("the report is no object")
            if answer.get("status", "ok") != "ok":
                raise FitFailed(f"status {answer['status']}")
            if not finite(answer):
                raise FitFailed("the fit is not finite")
        return answers


def json_values(text):
    """The JSON values that follow each other in a text, each on one line or on several."""
    decoder, text = json.JSONDecoder(), text.strip()
    while text:
        value, end = decoder.raw_decode(text)
        yield value
        text = text[end:].lstrip()


def finite(value):
    """Whether all numbers of a JSON value are finite."""
    if isinstance(value, dict):
        return all(map(finite, value.values()))
    if isinstance(value, list):
        return all(map(finite, value))
    return not isinstance(value, float) or math.isfinite(value)
