#!/usr/bin/env python3
"""Times our depth frames of scenes against Open3D's ray casting of meshes of them, on one core each, in the same run.

    cargo build --release
    cargo build --release -p supersurface-io --example look_speed
    python compare/look_open3d.py --bin target/release --seeds 5

Scenes are made by `supersurface scene random`. Ours is the whole frame: rays, depth, labels and normals of the exact
surfaces, into new images and again over those of the frame before. Open3D's is `RaycastingScene.cast_rays` alone, into new
images, on triangles no farther than --tolerance from the surfaces (several are rows of their own); what its
`create_rays_pinhole` needs is told apart, and so is its preparation, which no ratio counts. Needs the Python packages open3d
and numpy.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import numpy as np
    import open3d as o3d
except ImportError as error:
    sys.exit(f"look_open3d: {error}: pip install open3d numpy (and Debian's libusb-1.0-0)")

RUNS = 7  # of which the fastest counts, as in the example
JUMP = 5e-3  # metres: pixels that differ by more see another thing, beside an edge


def rotation(wxyz):
    w, x, y, z = wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def cuboid(half, place):
    """Corners and triangles of a board."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    turn = rotation(place.get("orientation_wxyz", [1, 0, 0, 0]))
    return signs * half @ turn.T + place["position"], np.array(triangles)


def meshes(scene, folder):
    """Vertices and triangles of all that the camera sees, the parts of bodies first."""
    for file in sorted(folder.glob("part_*.ply")):
        mesh = o3d.io.read_triangle_mesh(str(file))
        yield np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    for board in scene["boards"]:
        yield cuboid(board["half_extents"], board)
    x, y = scene["support"]["half_size"]
    yield np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]]), np.array([[0, 1, 2], [0, 2, 3]])


def rays(camera):
    """Origin and direction of each pixel's ray; directions have a length of 1 along the optical axis."""
    if any(camera.get("D", [])):
        sys.exit("look_open3d: the camera has distortion, for which rays are not made here")
    u, v = np.meshgrid(np.arange(camera["width"]), np.arange(camera["height"]))
    along = np.stack([(u - camera["cx"]) / camera["fx"], (v - camera["cy"]) / camera["fy"], np.ones(u.shape)], -1)
    turned = along @ rotation(camera["orientation_wxyz"]).T
    eyes = np.broadcast_to(np.array(camera["position"]), turned.shape)
    return o3d.core.Tensor(np.concatenate([eyes, turned], -1).astype(np.float32))


def fastest(work, runs=RUNS):
    """CPU milliseconds of the fastest run, and what it returned."""
    best = float("inf")
    for _ in range(runs):
        began = time.process_time()
        found = work()
        best = min(best, 1e3 * (time.process_time() - began))
    return best, found


def spent(said):
    """Milliseconds of a frame into new images and of one over the last, as the example says them."""
    new, again = said.split(",")[:2]
    return float(new.split()[0]), float(again.split()[1])


def compare(folder, program, tolerance):
    scene = json.loads((folder / "scene.json").read_text())
    command = [program, folder / "scene.json", folder / "look", "--tolerance", str(tolerance)]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode:
        sys.exit(f"look_open3d: {program}: {ran.stderr.strip()}")
    ours = spent(ran.stdout)
    solids = [(v.astype(np.float32), t.astype(np.uint32)) for v, t in meshes(scene, folder / "look")]

    def prepare():
        casting = o3d.t.geometry.RaycastingScene(nthreads=1)
        for vertices, triangles in solids:
            casting.add_triangles(o3d.core.Tensor(vertices), o3d.core.Tensor(triangles))
        # built by the first question
        casting.cast_rays(o3d.core.Tensor(np.array([[0, 0, 9, 0, 0, 1]], dtype=np.float32)), nthreads=1)
        return casting

    prepared, casting = fastest(prepare, 1)
    camera = scene["cameras"][0]
    aimed = rays(camera)
    focal = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]])
    lens, place = o3d.core.Tensor(focal), o3d.core.Tensor(np.eye(4))
    size = camera["width"], camera["height"]
    aiming, _ = fastest(lambda: o3d.t.geometry.RaycastingScene.create_rays_pinhole(lens, place, *size))
    theirs, hits = fastest(lambda: casting.cast_rays(aimed, nthreads=1))
    # ours again, as the machine may have been busy
    again = subprocess.run(command, capture_output=True, text=True)
    ours = [min(pair) for pair in zip(ours, spent(again.stdout))]

    exact = np.fromfile(folder / "look/depth.f32", dtype=np.float32).reshape(camera["height"], camera["width"])
    found = hits["t_hit"].numpy()
    parts = len(list((folder / "look").glob("part_*.ply")))
    on_bodies = (hits["geometry_ids"].numpy() < parts) & np.isfinite(exact)
    off = np.abs(found - exact)[on_bodies]
    near = off[off < JUMP]
    return {
        "new": ours[0],
        "again": ours[1],
        "theirs": theirs,
        "aiming": aiming,
        "prepared": prepared,
        "triangles": sum(len(t) for _, t in solids[:parts]),
        "median": 1e3 * float(np.median(near)),
        "most": 1e3 * float(np.percentile(near, 99)),
        "elsewhere": (len(off) - len(near)) / len(off),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bin", type=Path, required=True, help="folder of the built programs, target/release")
    parser.add_argument("--seeds", type=int, default=5, help="scenes of each layout and list")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--tolerance", type=float, nargs="+", default=[1e-4], help="of the meshes, in metres")
    options = parser.parse_args()
    rows = {tolerance: [] for tolerance in options.tolerance}
    print(
        f"{'scene':22} {'mesh mm':>8} {'new ms':>7} {'again ms':>8} {'Open3D ms':>10} {'ratios':>12} {'rays ms':>8}"
        f" {'set-up ms':>10} {'triangles':>10}  off mm: median, 99 %"
    )
    with tempfile.TemporaryDirectory() as out:
        for things in ("household", "members"):
            for layout in ("pile", "packed", "shelf"):
                for seed in range(options.first, options.first + options.seeds):
                    folder = Path(out) / f"{things}_{layout}_{seed}"
                    made = [options.bin / "supersurface", "scene", "random", "--quiet", "--noise", "none", "-o", folder]
                    made += ["--seed", str(seed), "--layout", layout, "--things", things]
                    subprocess.run(made, check=True, stdout=subprocess.DEVNULL)
                    for tolerance in options.tolerance:
                        row = compare(folder, options.bin / "examples/look_speed", tolerance)
                        rows[tolerance].append(row)
                        ratios = f"{row['theirs'] / row['new']:.2f} {row['theirs'] / row['again']:.2f}"
                        print(
                            f"{folder.name:22} {1e3 * tolerance:8.3f} {row['new']:7.1f} {row['again']:8.1f} {row['theirs']:10.1f}"
                            f" {ratios:>12} {row['aiming']:8.1f} {row['prepared']:10.0f} {row['triangles']:10}"
                            f"  {row['median']:.4f} {row['most']:.3f}  ({row['elsewhere']:.2%} beside edges)",
                            flush=True,
                        )
    for tolerance, found in rows.items():
        print(f"meshes within {1e3 * tolerance:g} mm, {len(found)} scenes: {summary(found)}")


def summary(rows):
    def of(key):
        return [row[key] for row in rows]

    def ratio(ours):
        ratios = sorted(row["theirs"] / row[ours] for row in rows)
        return f"{statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"

    middle = {key: statistics.median(of(key)) for key in ("new", "again", "theirs", "prepared")}
    return (
        f"medians: ours {middle['new']:.1f} ms, again {middle['again']:.1f}; Open3D {middle['theirs']:.1f}, and"
        f" {middle['prepared']:.0f} to prepare; ratio {ratio('new')}, again {ratio('again')}"
    )


if __name__ == "__main__":
    main()
