//! Our own JSON of a scene, read back (`docs/scene.md`).

use std::path::Path;

use nalgebra::UnitQuaternion;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use supersurface::camera::Camera;
use supersurface::combine::{Assembly, Joint, JointKind, Part};
use supersurface::scene::{Board, Body, FRICTION, Scene};
use supersurface::shape::Plane;
use supersurface::surface::Surface;
use supersurface::{Direction, Point, Pose, Vector};

use super::scene_json::FORMAT;
use super::{SceneCamera, SceneExtras, Site, Touch};
use crate::error::{Fault, ReadError};
use crate::read::{BOM, load, shown_name};
use crate::shape_json::{quaternion, row, surface};

/// A scene that was read, and what goes with it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneFile {
    /// The table, the bodies and the boards.
    pub scene: Scene,
    /// Cameras, named frames and contacts.
    pub extras: SceneExtras,
}

/// Reads a scene file; `-` is standard input.
pub fn read_scene(file: &Path) -> Result<SceneFile, ReadError> {
    parse_scene(&shown_name(file), &load(file)?)
}

/// A scene from the bytes of a JSON file; the name is for errors.
///
/// ```
/// let text = br#"{"format": "supersurface-scene", "version": 1, "support": {"half_size": [0.5, 0.4]}, "bodies": [
///     {"name": "can", "position": [0, 0, 0.05], "parts": [{"name": "can", "density": 500,
///      "shape": {"type": "superellipsoid", "semi_axes": [0.03, 0.03, 0.05], "exponents": [0.1, 1]}}]}]}"#;
/// let scene = supersurface_io::parse_scene("can", text)?.scene;
/// assert_eq!(scene.bodies[0].pose.translation.z, 0.05);
/// let wrong = String::from_utf8_lossy(text).replace("500", "-500");
/// let error = supersurface_io::parse_scene("can", wrong.as_bytes()).unwrap_err().to_string();
/// assert!(error.contains("bodies[0].parts[0]: density of a part is -500"), "{error}");
/// # Ok::<(), supersurface_io::ReadError>(())
/// ```
pub fn parse_scene(name: &str, bytes: &[u8]) -> Result<SceneFile, ReadError> {
    let fault = |f| ReadError::malformed(name, "scene JSON", f);
    let bytes = bytes.strip_prefix(BOM).unwrap_or(bytes);
    let value: Value = serde_json::from_slice(bytes)
        .map_err(|e| fault(Fault::new(format!("line {}", e.line()), e.to_string())))?;
    scene(value).map_err(fault)
}

fn scene(value: Value) -> Result<SceneFile, Fault> {
    if value.get("format").is_none_or(|f| f != FORMAT) {
        let problem =
            format!("is not {FORMAT:?}: this is no scene, or not one that this program wrote");
        return Err(Fault::new("format", problem));
    }
    if value.get("version").is_none_or(|v| v != 1) {
        return Err(Fault::new("version", "is not 1: a newer supersurface may read this scene"));
    }
    let file: FileRow = row(value, "scene")?;
    let support = match file.support.normal {
        Some(normal) => Plane::new(normal.into(), file.support.offset)
            .map_err(|e| Fault::new("support", e.to_string()))?,
        None => Plane::through(&Point::new(0.0, 0.0, -file.support.offset), Vector::z_axis()),
    };
    let half_size = positive(file.support.half_size, "support.half_size")?;
    let scene = Scene {
        bodies: each(file.bodies, "bodies", body)?,
        boards: each(file.boards, "boards", board)?,
        support,
        half_size,
    };
    let extras = SceneExtras {
        cameras: each(file.cameras, "cameras", camera)?,
        sites: each(file.sites, "sites", site)?,
        touches: each(file.contacts, "contacts", touch)?,
    };
    Ok(SceneFile { scene, extras })
}

/// All rows of a list, with their places for errors.
fn each<T>(
    values: Vec<Value>,
    list: &str,
    read: impl Fn(Value, &str) -> Result<T, Fault>,
) -> Result<Vec<T>, Fault> {
    let values = values.into_iter().enumerate();
    values.map(|(i, value)| read(value, &format!("{list}[{i}]"))).collect()
}

fn positive<const N: usize>(values: [f64; N], at: &str) -> Result<[f64; N], Fault> {
    match values.iter().find(|v| !(**v > 0.0 && v.is_finite())) {
        Some(v) => Err(Fault::new(at, format!("has {v}: lengths must be positive"))),
        None => Ok(values),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRow {
    #[serde(rename = "format")]
    _format: IgnoredAny,
    #[serde(rename = "version")]
    _version: IgnoredAny,
    #[serde(rename = "units", default)]
    _units: IgnoredAny,
    #[serde(rename = "gravity", default)]
    _gravity: IgnoredAny,
    support: SupportRow,
    #[serde(default)]
    bodies: Vec<Value>,
    #[serde(default)]
    boards: Vec<Value>,
    #[serde(default)]
    cameras: Vec<Value>,
    #[serde(default)]
    sites: Vec<Value>,
    #[serde(default)]
    contacts: Vec<Value>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SupportRow {
    normal: Option<[f64; 3]>,
    #[serde(default)]
    offset: f64,
    half_size: [f64; 2],
}

/// Fields that begin with an underscore follow from the rest, and are not read.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyRow {
    name: String,
    #[serde(rename = "id", default)]
    _id: IgnoredAny,
    #[serde(default)]
    position: [f64; 3],
    #[serde(default = "no_turn")]
    orientation_wxyz: [f64; 4],
    friction: Option<f64>,
    #[serde(rename = "mass", default)]
    _mass: IgnoredAny,
    #[serde(rename = "volume", default)]
    _volume: IgnoredAny,
    #[serde(rename = "centre_of_mass", default)]
    _centre: IgnoredAny,
    #[serde(rename = "inertia", default)]
    _inertia: IgnoredAny,
    parts: Vec<Value>,
    #[serde(default)]
    joints: Vec<Value>,
}

fn no_turn() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

fn pose(position: [f64; 3], orientation_wxyz: [f64; 4], at: &str) -> Result<Pose, Fault> {
    let rotation = quaternion(orientation_wxyz)
        .map_err(|e| Fault::new(format!("{at}.orientation_wxyz"), e))?;
    Ok(Pose::from_parts(Vector::from(position).into(), rotation))
}

fn body(value: Value, at: &str) -> Result<Body, Fault> {
    let body: BodyRow = row(value, at)?;
    let friction = body.friction.unwrap_or(FRICTION);
    if !(friction >= 0.0 && friction.is_finite()) {
        let problem = format!("is {friction}: it must be finite and not negative");
        return Err(Fault::new(format!("{at}.friction"), problem));
    }
    let parts = each(body.parts, &format!("{at}.parts"), part)?;
    let joints = each(body.joints, &format!("{at}.joints"), joint)?;
    let shape = Assembly::new(parts, joints).map_err(|e| Fault::new(at, e.to_string()))?;
    let pose = pose(body.position, body.orientation_wxyz, at)?;
    Ok(Body { name: body.name, shape, pose, friction })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PartRow {
    name: String,
    #[serde(rename = "id", default)]
    _id: IgnoredAny,
    density: f64,
    #[serde(rename = "mass", default)]
    _mass: IgnoredAny,
    #[serde(rename = "volume", default)]
    _volume: IgnoredAny,
    #[serde(rename = "centre_of_mass", default)]
    _centre: IgnoredAny,
    #[serde(rename = "inertia", default)]
    _inertia: IgnoredAny,
    shape: Value,
}

fn part(value: Value, at: &str) -> Result<Part<Surface>, Fault> {
    let part: PartRow = row(value, at)?;
    let solid = surface(part.shape, &format!("{at}.shape"))?;
    Part::new(part.name, solid, part.density).map_err(|e| Fault::new(at, e.to_string()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JointRow {
    parent: usize,
    child: usize,
    anchor: [f64; 3],
    #[serde(default)]
    fixed: bool,
    spring: Option<SpringRow>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpringRow {
    stiffness: f64,
    #[serde(default)]
    damping: f64,
    #[serde(default = "no_turn")]
    rest_orientation_wxyz: [f64; 4],
}

fn joint(value: Value, at: &str) -> Result<Joint, Fault> {
    let joint: JointRow = row(value, at)?;
    let kind = match (joint.fixed, joint.spring) {
        (true, None) => JointKind::Fixed,
        (true, Some(_)) => {
            return Err(Fault::new(at, "is fixed and has a spring: leave one of both out"));
        }
        (false, None) => JointKind::Spherical,
        (false, Some(s)) => {
            let place = || format!("{at}.spring.rest_orientation_wxyz");
            let rest: UnitQuaternion<f64> =
                quaternion(s.rest_orientation_wxyz).map_err(|e| Fault::new(place(), e))?;
            JointKind::Spring { stiffness: s.stiffness, damping: s.damping, rest }
        }
    };
    Joint::new(joint.parent, joint.child, joint.anchor.into(), kind)
        .map_err(|e| Fault::new(at, e.to_string()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoardRow {
    name: String,
    #[serde(rename = "id", default)]
    _id: IgnoredAny,
    half_extents: [f64; 3],
    #[serde(default)]
    position: [f64; 3],
    #[serde(default = "no_turn")]
    orientation_wxyz: [f64; 4],
}

fn board(value: Value, at: &str) -> Result<Board, Fault> {
    let board: BoardRow = row(value, at)?;
    let half_extents = positive(board.half_extents, &format!("{at}.half_extents"))?;
    let pose = pose(board.position, board.orientation_wxyz, at)?;
    Ok(Board { name: board.name, half_extents, pose })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraRow {
    name: String,
    #[serde(rename = "id", default)]
    _id: IgnoredAny,
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    #[serde(rename = "D", default)]
    distortion: [f64; 8],
    #[serde(default)]
    position: [f64; 3],
    #[serde(default = "no_turn")]
    orientation_wxyz: [f64; 4],
}

fn camera(value: Value, at: &str) -> Result<SceneCamera, Fault> {
    let c: CameraRow = row(value, at)?;
    let camera = Camera::new([c.width, c.height], [c.fx, c.fy], [c.cx, c.cy])
        .and_then(|camera| camera.with_distortion(c.distortion))
        .map_err(|e| Fault::new(at, e.to_string()))?;
    Ok(SceneCamera { name: c.name, camera, pose: pose(c.position, c.orientation_wxyz, at)? })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SiteRow {
    name: String,
    #[serde(rename = "id", default)]
    _id: IgnoredAny,
    #[serde(default)]
    position: [f64; 3],
    #[serde(default = "no_turn")]
    orientation_wxyz: [f64; 4],
}

fn site(value: Value, at: &str) -> Result<Site, Fault> {
    let site: SiteRow = row(value, at)?;
    Ok(Site { name: site.name, pose: pose(site.position, site.orientation_wxyz, at)? })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TouchRow {
    between: [String; 2],
    point: [f64; 3],
    normal: [f64; 3],
    distance: f64,
}

fn touch(value: Value, at: &str) -> Result<Touch, Fault> {
    let touch: TouchRow = row(value, at)?;
    let length = Vector::from(touch.normal).norm();
    if (length - 1.0).abs() > 1e-3 {
        let problem = format!("has the length {length}: a unit normal has 1");
        return Err(Fault::new(format!("{at}.normal"), problem));
    }
    // as it is where it is a unit vector but for rounding, so that it comes back with every digit
    let normal = match (length - 1.0).abs() <= 1e-15 {
        true => Direction::new_unchecked(touch.normal.into()),
        false => Direction::new_normalize(touch.normal.into()),
    };
    let (point, distance) = (touch.point.into(), touch.distance);
    Ok(Touch { between: touch.between, point, normal, distance })
}
