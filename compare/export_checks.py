"""What the programs that exported scenes are for see in them, each compared with the scene.json beside."""

import atexit
import contextlib
import functools
import importlib
import json
import logging
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SHARE = 1e-3  # most that masses and inertias may be off
OVERLAP, DRIFT, TURN = 1e-3, 5e-3, 5.0  # metres, metres, degrees
SECONDS = 2.0


class Skipped(Exception):
    """The program is not installed."""


class Wrong(Exception):
    """The program does not see what we meant."""


def needed(module):
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise Skipped(f"{error.name or module} is not installed") from None


def require(right, problem):
    if not right:
        raise Wrong(problem)


@contextlib.contextmanager
def quiet():
    """Native libraries print past Python."""
    sys.stdout.flush()
    kept = [os.dup(1), os.dup(2)]
    with open(os.devnull, "w") as nowhere:
        for stream in (1, 2):
            os.dup2(nowhere.fileno(), stream)
        try:
            yield
        finally:
            sys.stdout.flush()
            for stream, copy in zip((1, 2), kept):
                os.dup2(copy, stream)
                os.close(copy)


# ---------------------------------------------------------------- geometry


def rotation(wxyz):
    w, x, y, z = wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def joined(links):
    """Mass, centre and inertia about it of links given as such."""
    links = list(links)
    mass = sum(m for m, _, _ in links)
    centre = sum(m * np.asarray(c) for m, c, _ in links) / mass
    inertia = np.zeros((3, 3))
    for m, c, i in links:
        d = np.asarray(c) - centre
        inertia += np.asarray(i) + m * (d @ d * np.eye(3) - np.outer(d, d))
    return mass, centre, inertia


def in_world(mass, centre, inertia, turn, at):
    return mass, turn @ centre + at, turn @ inertia @ turn.T


class Scene:
    """What a folder should hold."""

    def __init__(self, folder):
        self.folder = folder
        self.rest = None
        self.file = json.loads((folder / "scene.json").read_text())
        self.bodies = {body["id"]: body for body in self.file["bodies"]}
        self.parts = {part["id"]: part for body in self.file["bodies"] for part in body["parts"]}

    def __truediv__(self, name):
        path = self.folder / name
        require(path.exists(), f"{name} is missing")
        return str(path)

    def truth(self, body, world=False):
        body = self.bodies[body]
        local = body["mass"], np.array(body["centre_of_mass"]), np.array(body["inertia"])
        if not world:
            return local
        return in_world(*local, rotation(body["orientation_wxyz"]), np.array(body["position"]))

    def compare(self, found, world=False):
        """The largest share by which a mass, centre or inertia is off; `found` has (m, c, I) by body."""
        require(set(found) == set(self.bodies), f"bodies {sorted(found)} are not those of scene.json")
        worst = 0.0
        for name, (mass, centre, inertia) in found.items():
            m, c, i = self.truth(name, world)
            gyration = np.sqrt(np.trace(i) / (2 * m))
            known, seen = np.linalg.eigvalsh(i), np.linalg.eigvalsh(inertia)
            shares = [
                abs(mass / m - 1),
                np.linalg.norm(centre - c) / gyration,
                np.abs(seen / known - 1).max(),
                np.abs(inertia - i).max() / known.max(),
            ]
            require(max(shares) <= SHARE, f"{name}: mass, centre, moments, inertia are off by {np.round(shares, 6)}")
            worst = max(worst, *shares)
        return f"masses and inertias within {worst:.1e}"

    def compare_views(self, found):
        """Cameras by id, as (axes that look along -z with y up, place), against optical frames; sites likewise, as they are."""
        flip = np.diag([1.0, -1.0, -1.0])
        known = {c["id"]: (rotation(c["orientation_wxyz"]) @ flip, c["position"]) for c in self.file["cameras"]}
        known |= {s["id"]: (rotation(s["orientation_wxyz"]), s["position"]) for s in self.file["sites"]}
        for name, (turn, at) in known.items():
            require(name in found, f"{name} is missing")
            off = max(np.abs(found[name][0] - turn).max(), np.abs(found[name][1] - np.array(at)).max())
            require(off < 1e-5, f"{name} stands elsewhere, by {off:.1e}")

    def rings(self):
        """Parts that have a hole: body, centre and axis in the world, tube radius, radius of the hole and of the ring."""
        for body in self.file["bodies"]:
            if body["joints"]:  # which may turn parts
                continue
            turn, at = rotation(body["orientation_wxyz"]), np.array(body["position"])
            for part in body["parts"]:
                shape = part["shape"]
                if shape.get("ring_ratio", 1) <= 1.2:
                    continue
                axes = turn @ rotation(shape["orientation_wxyz"])
                centre = turn @ np.array(shape["position"]) + at
                a, ratio = shape["semi_axes"], shape["ring_ratio"]
                yield body["id"], centre, axes, a, min(a[:2]) * (ratio - 1), a[0] * ratio


# ---------------------------------------------------------------- consumers


def mujoco_loads(scene):
    mujoco = needed("mujoco")
    model = mujoco.MjModel.from_xml_path(scene / "scene.xml")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    said = scene.compare(mujoco_masses(scene, model, data), world=True)
    cameras = {model.cam(k).name: (data.cam_xmat[k].reshape(3, 3), data.cam_xpos[k]) for k in range(model.ncam)}
    sites = {model.site(k).name: (data.site_xmat[k].reshape(3, 3), data.site_xpos[k]) for k in range(model.nsite)}
    scene.compare_views(cameras | sites)
    return said


def mujoco_rests(scene):
    """Nothing overlaps at the start, and nothing moves."""
    mujoco = needed("mujoco")
    model = mujoco.MjModel.from_xml_path(scene / "scene.xml")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    overlap = max([-float(d) for d in data.contact.dist] + [0.0])
    places, turns = data.xpos.copy(), data.xquat.copy()
    while data.time < SECONDS:
        mujoco.mj_step(model, data)
    require(not sum(w.number for w in data.warning), "MuJoCo warned during the replay")
    drift = np.linalg.norm(data.xpos - places, axis=1)[1:]
    cosines = np.clip(np.abs(np.sum(turns * data.xquat, axis=1)), 0, 1)
    turned = np.degrees(2 * np.arccos(cosines))[1:]
    moved = [model.body(k + 1).name for k in np.flatnonzero((drift >= DRIFT) | (turned >= TURN))]
    scene.rest = {"overlap": overlap, "bodies": len(drift), "moved": moved}
    said = f"overlap {overlap * 1e3:.2f} mm, drift {drift.max() * 1e3:.2f} mm, {turned.max():.2f} degrees in {SECONDS} s"
    require(overlap < OVERLAP, f"overlap at the start: {overlap * 1e3:.2f} mm")
    require(not moved, f"{', '.join(moved)} moved: {said}")
    return said


def mujoco_masses(scene, model, data):
    links = {name: [] for name in scene.bodies}
    for k in range(1, model.nbody):
        turn = data.ximat[k].reshape(3, 3)
        root = model.body(model.body_rootid[k]).name
        inertia = turn @ np.diag(model.body_inertia[k]) @ turn.T
        if root in links:
            links[root].append((model.body_mass[k], data.xipos[k].copy(), inertia))
    return {name: joined(found) for name, found in links.items() if found}


def mujoco_holes(scene):
    """A rod stands in each hole and touches nothing; beside it, in the tube, it does. A thin rod falls through."""
    mujoco = needed("mujoco")
    rings = list(scene.rings())
    if not rings:
        return "no toroids"
    capsule = mujoco.mjtGeom.mjGEOM_CAPSULE
    spec = mujoco.MjSpec.from_file(scene / "scene.xml")
    for k, (_, centre, axes, a, hole, ring) in enumerate(rings):
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, np.ascontiguousarray(axes).ravel())
        for kind, place, radius in (("hole", 0.0, 0.8 * hole), ("tube", ring, 0.3 * a[0])):
            probe = spec.worldbody.add_body(name=f"{kind} {k}", pos=centre + axes @ [place, 0, 0], quat=quat)
            probe.add_freejoint()
            probe.add_geom(type=capsule, size=[radius, 1.5 * a[2], 0])
    model, data = started(mujoco, spec)
    met = {frozenset(model.body(model.geom_bodyid[g]).name for g in c.geom) for c in data.contact}
    for k, (body, *_) in enumerate(rings):
        require(frozenset([body, f"hole {k}"]) not in met, f"{body}: a rod in the hole is met")
        require(frozenset([body, f"tube {k}"]) in met, f"{body}: a rod in the tube meets nothing")

    # a rod meets the ring's body and the ground: what else lies in a pile may be in its way
    level = [ring for ring in rings if abs(ring[2][2, 2]) > 0.99]
    spec = mujoco.MjSpec.from_file(scene / "scene.xml")
    bits = {body: 2 << k for k, body in enumerate(sorted({ring[0] for ring in level}))}
    for geom in spec.geoms:
        if geom.contype:  # others are to be seen only
            geom.contype |= sum(bits.values()) if geom.parent.name == "world" else bits.get(geom.parent.name, 0)
    for k, (body, centre, _, a, hole, _) in enumerate(level):
        # right above: a shelf's next board is near
        rod = spec.worldbody.add_body(name=f"rod {k}", pos=centre + [0, 0, a[2] + 0.5 * hole + 0.021])
        rod.add_freejoint()
        rod.add_geom(type=capsule, size=[0.5 * hole, 0.02, 0], mass=0.02, contype=0, conaffinity=bits[body])
    model, data = started(mujoco, spec)
    lowest = np.full(len(level), np.inf)
    rods = [model.body(f"rod {k}").id for k in range(len(level))]
    while data.time < 1.0 and rods:
        mujoco.mj_step(model, data)
        lowest = np.minimum(lowest, data.xpos[rods, 2])
    for (body, centre, _, a, hole, _), stops in zip(level, lowest):
        below = centre[2] - a[2]  # what the ring lies on
        require(stops < below + 0.5 * hole + 0.021, f"{body}: a rod that is dropped through stops at {stops * 1e3:.1f} mm")
    return f"{len(rings)} holes open, rods fall through {len(level)}"


def started(mujoco, spec):
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def usd_loads(scene):
    needed("pxr")
    from pxr import Usd, UsdGeom, UsdPhysics, UsdValidation

    stage = Usd.Stage.Open(scene / "scene.usda")
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    require(not errors, f"{len(errors)} validation errors, the first: {errors and errors[0].GetMessage()}")
    require(UsdGeom.GetStageUpAxis(stage) == "Z", "z is not up")
    require(UsdGeom.GetStageMetersPerUnit(stage) == 1, "units are not metres")
    places = UsdGeom.XformCache()
    links = {name: [] for name in scene.bodies}
    meshes, numbers = 0, 0
    for prim in stage.Traverse():
        numbers += prim.HasAttribute("supersurface:semiAxes")
        if prim.IsA(UsdGeom.Mesh):
            mesh, meshes = UsdGeom.Mesh(prim), meshes + 1
            faces = np.array(mesh.GetFaceVertexIndicesAttr().Get())
            points = np.array(mesh.GetPointsAttr().Get(), dtype=float)
            counts = mesh.GetFaceVertexCountsAttr().Get()
            right, why = UsdGeom.Mesh.ValidateTopology(mesh.GetFaceVertexIndicesAttr().Get(), counts, len(points))
            require(right, f"{prim.GetPath()}: {why}")
            closed_and_outward(faces.reshape(-1, 3), points, prim.GetPath())
        if prim.HasAPI(UsdPhysics.RigidBodyAPI):
            body = str(prim.GetPath()).split("/")[2]
            mass = UsdPhysics.MassAPI(prim)
            q = mass.GetPrincipalAxesAttr().Get()
            axes = rotation([q.GetReal(), *q.GetImaginary()])
            inertia = axes @ np.diag(mass.GetDiagonalInertiaAttr().Get()) @ axes.T
            matrix = np.array(places.GetLocalToWorldTransform(prim)).T
            local = mass.GetMassAttr().Get(), np.array(mass.GetCenterOfMassAttr().Get()), inertia
            links[body].append(in_world(*local, matrix[:3, :3], matrix[:3, 3]))
    views = {}
    for placed in scene.file["cameras"] + scene.file["sites"]:
        matrix = np.array(places.GetLocalToWorldTransform(stage.GetPrimAtPath(f"/World/{placed['id']}"))).T
        views[placed["id"]] = matrix[:3, :3], matrix[:3, 3]
    scene.compare_views(views)
    require(numbers == len(scene.parts), f"{numbers} of {len(scene.parts)} parts have their numbers")
    said = scene.compare({name: joined(found) for name, found in links.items() if found}, world=True)
    return f"{said}; {meshes} closed meshes"


def closed_and_outward(faces, points, name):
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there = {tuple(edge) for edge in edges.tolist()}
    require(len(there) == len(edges), f"{name}: an edge is run along twice")
    require(all((b, a) in there for a, b in there), f"{name}: not closed")
    a, b, c = (points[faces[:, k]] for k in range(3))
    require(np.einsum("ij,ij->", a, np.cross(b, c)) > 0, f"{name}: inside out")


def urdf_files(scene):
    return ["scene.urdf"] + [f"{name}.urdf" for name in scene.bodies]


def yourdfpy_loads(scene):
    yourdfpy = needed("yourdfpy")
    logging.disable(logging.WARNING)
    found = {}
    for file in urdf_files(scene):
        robot = yourdfpy.URDF.load(scene / file, load_meshes=True, load_collision_meshes=True, build_collision_scene_graph=True)
        require(robot.validate(), f"{file} does not validate: {robot.errors}")
        links = []
        for link in robot.robot.links:
            if link.inertial is None:
                continue
            moments = np.linalg.eigvalsh(link.inertial.inertia)
            solid = moments[0] > 0 and moments[2] <= moments[0] + moments[1] + 1e-12
            require(solid, f"{file}: {link.name} has the inertia of no solid")
            matrix = robot.get_transform(link.name)
            own = link.inertial.origin if link.inertial.origin is not None else np.eye(4)
            matrix = matrix @ own
            links.append(in_world(link.inertial.mass, np.zeros(3), link.inertial.inertia, matrix[:3, :3], matrix[:3, 3]))
        if file != "scene.urdf":
            found[file.removesuffix(".urdf")] = joined(links)
    return f"{scene.compare(found)}; {1 + len(found)} files"


def check_urdf_loads(scene):
    if not shutil.which("check_urdf"):
        raise Skipped("check_urdf is not installed")
    for file in urdf_files(scene):
        ran = subprocess.run(["check_urdf", scene / file], capture_output=True, text=True)
        right = ran.returncode == 0 and "Successfully Parsed" in ran.stdout
        require(right, f"{file}: {(ran.stderr or ran.stdout).strip()[:200]}")
    return f"{len(urdf_files(scene))} files"


def pybullet_loads(scene):
    with quiet():
        bullet = needed("pybullet")
        client = bullet.connect(bullet.DIRECT)
    found, shapes = {}, 0
    try:
        for name in scene.bodies:
            # without the flag Bullet makes inertias of boxes around the shapes
            with quiet():
                body = bullet.loadURDF(scene / f"{name}.urdf", flags=bullet.URDF_USE_INERTIA_FROM_FILE)
            at, turn = bullet.getBasePositionAndOrientation(body)
            back = bullet.invertTransform(*bullet.getDynamicsInfo(body, -1)[3:5])
            frame = bullet.multiplyTransforms(at, turn, *back)
            links = []
            for k in range(-1, bullet.getNumJoints(body)):
                info = bullet.getDynamicsInfo(body, k)
                pose = (at, turn) if k < 0 else bullet.getLinkState(body, k, computeForwardKinematics=True)[:2]
                at_link, turn_link = bullet.multiplyTransforms(*bullet.invertTransform(*frame), *pose)
                axes = np.array(bullet.getMatrixFromQuaternion(turn_link)).reshape(3, 3)
                links.append((info[0], np.array(at_link), axes @ np.diag(info[2]) @ axes.T))
                shapes += len(bullet.getCollisionShapeData(body, k))
            found[name] = joined(links)
        with quiet():
            whole = bullet.loadURDF(scene / "scene.urdf", useFixedBase=True, flags=bullet.URDF_USE_INERTIA_FROM_FILE)
        names = {bullet.getJointInfo(whole, k)[12].decode() for k in range(bullet.getNumJoints(whole))}
        require(set(scene.bodies) <= names, "bodies are missing in scene.urdf")
    finally:
        bullet.disconnect(client)
    return f"{scene.compare(found)}; {shapes} shapes"


@functools.cache
def sdf_links():
    """The program that prints what libsdformat reads, built once; None where that is not installed."""
    compiler, config = shutil.which("g++"), shutil.which("pkg-config")
    listed = config and subprocess.run([config, "--list-all"], capture_output=True, text=True).stdout
    packages = [line.split()[0] for line in (listed or "").splitlines() if line.startswith("sdformat")]
    packages = [p for p in packages if p.removeprefix("sdformat").isdigit()]
    if not compiler or not packages:
        return None
    folder = tempfile.TemporaryDirectory()
    atexit.register(folder.cleanup)
    flags = subprocess.run([config, "--cflags", "--libs", packages[-1]], capture_output=True, text=True).stdout.split()
    program = f"{folder.name}/sdf_links"
    subprocess.run([compiler, "-std=c++17", str(HERE / "export/sdf_links.cc"), "-o", program, *flags], check=True)
    return program


def libsdformat_loads(scene):
    if not sdf_links():
        raise Skipped("libsdformat-dev, g++ or pkg-config is not installed")
    ran = subprocess.run([sdf_links(), scene / "scene_world.sdf"], capture_output=True, text=True)
    require(ran.returncode == 0, ran.stderr.strip()[:200])
    links = {name: [] for name in scene.bodies}
    shapes = 0
    for line in ran.stdout.splitlines():
        model, *numbers = line.split()
        numbers = np.array(numbers, dtype=float)
        links[model].append((numbers[0], numbers[1:4], numbers[4:13].reshape(3, 3)))
        shapes += int(numbers[13])
    return f"{scene.compare({name: joined(found) for name, found in links.items()})}; {shapes} shapes"


def drake_loads(kind):
    def load(scene):
        needed("pydrake.multibody.plant")
        from pydrake.multibody.parsing import Parser
        from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
        from pydrake.systems.framework import DiagramBuilder

        logging.disable(logging.WARNING)
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, 1e-3)
        parser = Parser(plant)
        models = {}
        if kind == "sdf":
            parser.AddModels(scene / "scene_world.sdf")
        elif kind == "scene.urdf":
            parser.AddModels(scene / "scene.urdf")
        else:
            for name in scene.bodies:
                models[name] = parser.AddModels(scene / f"{name}.urdf")[0]
        plant.Finalize()
        context = plant.CreateDefaultContext()
        if kind == "scene.urdf":
            for name, body in scene.bodies.items():
                if len(body["parts"]) == 1:
                    mass = plant.GetBodyByName(name).default_mass()
                    require(abs(mass / body["mass"] - 1) <= SHARE, f"{name}: mass {mass}")
            return f"{plant.num_bodies() - 1} links, {plant.num_positions()} positions"
        found = {}
        for name in scene.bodies:
            model = models.get(name) or plant.GetModelInstanceByName(name_in(plant, name))
            frame = plant.GetBodyByName(name, model).body_frame()
            whole = plant.CalcSpatialInertia(context, frame, plant.GetBodyIndices(model))
            m, c = whole.get_mass(), whole.get_com()
            inertia = whole.CalcRotationalInertia().CopyToFullMatrix3()
            found[name] = m, c, inertia - m * (c @ c * np.eye(3) - np.outer(c, c))
        diagram = builder.Build()
        diagram.ForcedPublish(diagram.CreateDefaultContext())
        return f"{scene.compare(found)}; {plant.num_collision_geometries()} shapes"

    def name_in(plant, name):
        """Models of a world are called after the world."""
        return name if plant.HasModelInstanceNamed(name) else f"scene::{name}"

    return load


def mujoco_urdf_loads(scene):
    mujoco = needed("mujoco")
    found = {}
    for file in urdf_files(scene):
        model = mujoco.MjModel.from_xml_path(scene / file)
        if file == "scene.urdf":
            require(all(model.body(name).id >= 0 for name in scene.bodies), "bodies are missing in scene.urdf")
            data = mujoco.MjData(model)
            mujoco.mj_forward(model, data)
            whole = mujoco_masses(scene, model, data)
    return f"{scene.compare(whole, world=True)}; {len(urdf_files(scene))} files"


def trimesh_loads(scene):
    trimesh = needed("trimesh")
    worst, count = 0.0, 0
    for name, part in scene.parts.items():
        for kind in ("obj", "stl", "ply"):
            mesh = trimesh.load(scene / f"meshes/{name}.{kind}", force="mesh")
            worst = max(worst, mesh_is_right(mesh, part, f"{name}.{kind}"))
            count += 1
    return f"{count} files closed, volumes and inertias within {worst:.1e}"


def mesh_is_right(mesh, part, name):
    require(mesh.is_watertight and mesh.is_winding_consistent, f"{name} is not closed")
    ring = "ring_ratio" in part["shape"] and part["shape"]["ring_ratio"] > 1
    require(mesh.euler_number == (0 if ring else 2), f"{name} has the Euler characteristic {mesh.euler_number}")
    known = np.linalg.eigvalsh(part["inertia"]) / part["density"]
    seen = np.linalg.eigvalsh(mesh.moment_inertia)
    shares = [abs(mesh.volume / part["volume"] - 1), *np.abs(seen / known - 1)]
    require(max(shares) <= SHARE, f"{name}: volume and moments are off by {np.round(shares, 5)}")
    return max(shares)


def glb_loads(scene):
    trimesh = needed("trimesh")
    loaded = trimesh.load(scene / "scene.glb")
    up = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], dtype=float)
    worst = 0.0
    for name, part in scene.parts.items():
        require(name in loaded.geometry, f"{name} is missing")
        worst = max(worst, mesh_is_right(loaded.geometry[name], part, name))
    # trimesh keeps no nodes without a mesh
    glb = (scene.folder / "scene.glb").read_bytes()
    nodes = json.loads(glb[20 : 20 + int.from_bytes(glb[12:16], "little")])["nodes"]
    turns = {n["name"]: (rotation(np.roll(n["rotation"], 1)), n.get("translation", np.zeros(3))) for n in nodes}
    scene.compare_views(turns)
    for name, body in scene.bodies.items():
        matrix = loaded.graph.get(name)[0]
        off = np.linalg.norm(matrix[:3, 3] - up @ np.array(body["position"]))
        require(off < 1e-6, f"{name} stands {off} m off")
    return f"{len(scene.parts)} meshes closed, volumes and inertias within {worst:.1e}"


def khronos_loads(modules):
    def load(scene):
        if not shutil.which("node") or not (Path(modules) / "node_modules/gltf-validator").exists():
            raise Skipped("node or its module gltf-validator is not installed (--node-modules FOLDER)")
        command = ["node", str(HERE / "export/gltf_issues.mjs"), scene / "scene.glb", str(Path(modules).resolve())]
        ran = subprocess.run(command, capture_output=True, text=True)
        require(ran.returncode == 0, ran.stderr.strip()[-200:])
        issues = json.loads(ran.stdout)
        require(not issues["errors"] and not issues["warnings"], ran.stdout.strip()[:300])
        return "no errors, no warnings"

    return load


def all_checks(node_modules):
    """(format, program, what asks it): each takes a scene, says what it saw, and raises Skipped or Wrong."""
    return [
        ("MJCF", "MuJoCo", mujoco_loads),
        ("MJCF", "MuJoCo, holes", mujoco_holes),
        ("MJCF", "MuJoCo, rest", mujoco_rests),
        ("URDF", "MuJoCo", mujoco_urdf_loads),
        ("URDF", "yourdfpy", yourdfpy_loads),
        ("URDF", "check_urdf", check_urdf_loads),
        ("URDF", "PyBullet", pybullet_loads),
        ("URDF, bodies", "Drake", drake_loads("bodies")),
        ("URDF, scene", "Drake", drake_loads("scene.urdf")),
        ("SDFormat", "libsdformat", libsdformat_loads),
        ("SDFormat", "Drake", drake_loads("sdf")),
        ("USDA", "OpenUSD", usd_loads),
        ("GLB", "trimesh", glb_loads),
        ("GLB", "Khronos", khronos_loads(node_modules)),
        ("OBJ, STL, PLY", "trimesh", trimesh_loads),
    ]
