"""Fits clouds with an installed EMS and tells the CPU time of each fit.

Run by fitters.py under the Python that has the peer's packages:

    python ems_worker.py FOLDER_OF_PACKAGE_EMS OUTLIER_RATIO SECONDS_ALLOWED

It fits a made cloud first, so that numba has compiled before anything is timed, and writes one line of
JSON with the versions. Then each line read, {"cloud": PATH}, is answered by {"cpu_s": SECONDS} or
{"error": TEXT}. Files are read outside the timing.
"""

import importlib.metadata
import json
import os
import platform
import signal
import sys
import time
import types

import numpy as np

PLY_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip


def read_points(path):
    """The x, y, z of a PLY file whose first element is its vertices, ascii or binary, as an n by 3 array."""
    with open(path, "rb") as file:
        if file.readline().strip() != b"ply":
            raise ValueError(f"{path} is no PLY file")
        layout, elements = None, []
        for line in file:
            words = line.decode("latin-1").split()
            if words[:1] == ["format"]:
                layout = words[1]
            elif words[:1] == ["element"]:
                elements.append((words[1], int(words[2]), []))
            elif words[:1] == ["property"]:
                elements[-1][2].append((words[-1], words[1]))
            elif words == ["end_header"]:
                break
        if not elements or elements[0][0] != "vertex":
            raise ValueError(f"{path} does not begin with vertices")
        _, count, properties = elements[0]
        names = [name for name, _ in properties]
        if layout == "ascii":
            rows = np.loadtxt(file, max_rows=count, ndmin=2)
            return np.stack([rows[:, names.index(axis)] for axis in "xyz"], axis=1)
        order = "<" if layout == "binary_little_endian" else ">"
        row = np.dtype([(name, order + PLY_TYPES[kind]) for name, kind in properties])
        vertices = np.frombuffer(file.read(count * row.itemsize), row)
        return np.stack([vertices[axis] for axis in "xyz"], axis=1).astype(float)


def made_cloud():
    """An ellipsoid of 400 points with a little scatter; two axes near in length, so that a switch is tried."""
    k = np.arange(400)
    z = (2 * k + 1) / 400 - 1
    turn = k * np.pi * (3 - 5**0.5)
    round_points = np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=1)
    return round_points * [1.0, 0.9, 0.5] * (1 + 0.01 * np.sin(7.0 * k))[:, None]


def import_peer(folder):
    """EMS_recovery, with stand-ins for what its import asks for and a fit does not need."""
    # It was written when NumPy still had this other name of Python's int.
    if "int" not in vars(np):
        np.int = int
    # mayavi only draws, and wants a display.
    mayavi = types.ModuleType("mayavi")
    mayavi.mlab = types.ModuleType("mayavi.mlab")
    sys.modules.update({"mayavi": mayavi, "mayavi.mlab": mayavi.mlab})
    sys.path.insert(0, folder)
    from EMS.EMS_recovery import EMS_recovery

    return EMS_recovery


def timed_fit(recover, points, outlier_ratio):
    """CPU seconds of one fit; raises where the fit does, and where its answer is not finite."""
    start = time.process_time()
    found, _ = recover(points, OutlierRatio=outlier_ratio)
    spent = time.process_time() - start
    for values in (found.shape, found.scale, found.euler, found.translation):
        if not np.all(np.isfinite(values)):
            raise ArithmeticError("the fit is not finite")
    return spent


def said(error):
    return f"{type(error).__name__}: {error}".splitlines()[0]


def too_long(_signal, _frame):
    raise TimeoutError("out of time")


def main():
    folder, outlier_ratio, allowed = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    # What the peer prints must not get between the answers.
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)

    def answer(**what):
        answers.write(json.dumps(what) + "\n")

    try:
        recover = import_peer(folder)
        timed_fit(recover, made_cloud(), outlier_ratio)
    except Exception as error:
        answer(error=said(error))
        return
    packages = ("numpy", "scipy", "numba")
    answer(python=platform.python_version(), **{name: importlib.metadata.version(name) for name in packages})
    signal.signal(signal.SIGALRM, too_long)
    for line in sys.stdin:
        try:
            points = read_points(json.loads(line)["cloud"])
            signal.setitimer(signal.ITIMER_REAL, allowed)
            spent = timed_fit(recover, points, outlier_ratio)
            signal.setitimer(signal.ITIMER_REAL, 0)
            answer(cpu_s=spent)
        except Exception as error:
            signal.setitimer(signal.ITIMER_REAL, 0)
            answer(error=said(error))


if __name__ == "__main__":
    main()
