//! A scene as our own JSON: format `supersurface-scene`, version 1 (`docs/scene.md`).
//!
//! What follows from the rest (ids, masses, inertias) is written for programs, and not read back.

use serde::Serialize;
use supersurface::combine::{Joint, JointKind, Part};
use supersurface::shape::{Mass, MassProperties};
use supersurface::surface::Surface;

use super::links::{LinkPart, Prepared, Tree};
use super::{GRAVITY, SceneCamera, Touch};
use crate::surface_row::{PoseRow, SurfaceRow};

/// The value of `format`.
pub(super) const FORMAT: &str = "supersurface-scene";

/// The text of `scene.json`.
pub(super) fn text(prepared: &Prepared<'_>) -> String {
    let scene = prepared.scene;
    let file = File {
        format: FORMAT,
        version: 1,
        units: Units { length: "m", mass: "kg", angle: "rad", quaternion: "wxyz" },
        gravity: [0.0, 0.0, -GRAVITY],
        support: SupportRow {
            normal: scene.support.normal().into_inner().into(),
            offset: scene.support.offset(),
            half_size: scene.half_size,
        },
        bodies: prepared.bodies.iter().map(BodyRow::new).collect(),
        boards: (prepared.boxes.iter().skip(1).zip(&scene.boards))
            .map(|(fixed, board)| BoardRow {
                name: &board.name,
                id: &fixed.id,
                half_extents: board.half_extents,
                pose: PoseRow::new(&board.pose),
            })
            .collect(),
        cameras: prepared.cameras.iter().map(|(id, c)| CameraRow::new(id, c)).collect(),
        sites: (prepared.sites.iter())
            .map(|(id, site)| SiteRow { name: &site.name, id, pose: PoseRow::new(&site.pose) })
            .collect(),
        contacts: prepared.extras.touches.iter().map(TouchRow::new).collect(),
    };
    // plain structs of numbers and strings: serialisation has nothing to fail on
    serde_json::to_string_pretty(&file).unwrap_or_default()
}

#[derive(Serialize)]
struct File<'a> {
    format: &'static str,
    version: u32,
    units: Units,
    gravity: [f64; 3],
    support: SupportRow,
    bodies: Vec<BodyRow<'a>>,
    boards: Vec<BoardRow<'a>>,
    cameras: Vec<CameraRow<'a>>,
    sites: Vec<SiteRow<'a>>,
    contacts: Vec<TouchRow<'a>>,
}

#[derive(Serialize)]
struct Units {
    length: &'static str,
    mass: &'static str,
    angle: &'static str,
    quaternion: &'static str,
}

#[derive(Serialize)]
struct SupportRow {
    normal: [f64; 3],
    offset: f64,
    half_size: [f64; 2],
}

#[derive(Serialize)]
struct BodyRow<'a> {
    name: &'a str,
    id: &'a str,
    #[serde(flatten)]
    pose: PoseRow,
    friction: f64,
    #[serde(flatten)]
    mass: MassRow,
    parts: Vec<PartRow<'a>>,
    joints: Vec<JointRow>,
}

impl<'a> BodyRow<'a> {
    fn new(tree: &'a Tree<'_>) -> Self {
        let body = tree.body;
        let mut parts: Vec<&LinkPart> = tree.links.iter().flat_map(|link| &link.parts).collect();
        parts.sort_by_key(|part| part.index);
        let volume = body.shape.parts().iter().map(|p| p.body().shape().volume()).sum();
        Self {
            name: &body.name,
            id: &tree.id,
            pose: PoseRow::new(&body.pose),
            friction: body.friction,
            mass: MassRow::new(&body.mass(), volume),
            parts: (body.shape.parts().iter().zip(parts))
                .map(|(part, LinkPart { id, .. })| PartRow::new(id, part))
                .collect(),
            joints: body.shape.joints().iter().map(JointRow::new).collect(),
        }
    }
}

/// In the frame of the row that holds it.
#[derive(Serialize)]
struct MassRow {
    mass: f64,
    volume: f64,
    centre_of_mass: [f64; 3],
    inertia: [[f64; 3]; 3],
}

impl MassRow {
    fn new(mass: &Mass, volume: f64) -> Self {
        Self {
            mass: mass.mass,
            volume,
            centre_of_mass: mass.centre.into(),
            inertia: mass.inertia.into(),
        }
    }
}

#[derive(Serialize)]
struct PartRow<'a> {
    name: &'a str,
    id: &'a str,
    density: f64,
    #[serde(flatten)]
    mass: MassRow,
    shape: SurfaceRow,
}

impl<'a> PartRow<'a> {
    fn new(id: &'a str, part: &'a Part<Surface>) -> Self {
        let (shape, pose) = (part.body().shape(), part.body().pose());
        let mass = shape.mass_properties(part.density()).moved(pose);
        Self {
            name: part.name(),
            id,
            density: part.density(),
            mass: MassRow::new(&mass, shape.volume()),
            shape: SurfaceRow::new(part.body()),
        }
    }
}

#[derive(Serialize)]
struct JointRow {
    parent: usize,
    child: usize,
    anchor: [f64; 3],
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    fixed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    spring: Option<SpringRow>,
}

#[derive(Serialize)]
struct SpringRow {
    stiffness: f64,
    damping: f64,
    rest_orientation_wxyz: [f64; 4],
}

impl JointRow {
    fn new(joint: &Joint) -> Self {
        let spring = match joint.kind() {
            JointKind::Spring { stiffness, damping, rest } => Some(SpringRow {
                stiffness,
                damping,
                rest_orientation_wxyz: [rest.w, rest.i, rest.j, rest.k],
            }),
            JointKind::Fixed | JointKind::Spherical => None,
        };
        Self {
            parent: joint.parent(),
            child: joint.child(),
            anchor: joint.anchor().into(),
            fixed: joint.kind() == JointKind::Fixed,
            spring,
        }
    }
}

#[derive(Serialize)]
struct BoardRow<'a> {
    name: &'a str,
    id: &'a str,
    half_extents: [f64; 3],
    #[serde(flatten)]
    pose: PoseRow,
}

#[derive(Serialize)]
struct CameraRow<'a> {
    name: &'a str,
    id: &'a str,
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    #[serde(rename = "D", skip_serializing_if = "Option::is_none")]
    distortion: Option<[f64; 8]>,
    #[serde(flatten)]
    pose: PoseRow,
}

impl<'a> CameraRow<'a> {
    fn new(id: &'a str, placed: &'a SceneCamera) -> Self {
        let camera = &placed.camera;
        let ([width, height], [fx, fy], [cx, cy]) =
            (camera.size(), camera.focal(), camera.centre());
        let distortion = Some(camera.distortion()).filter(|d| *d != [0.0; 8]);
        let pose = PoseRow::new(&placed.pose);
        Self { name: &placed.name, id, width, height, fx, fy, cx, cy, distortion, pose }
    }
}

#[derive(Serialize)]
struct SiteRow<'a> {
    name: &'a str,
    id: &'a str,
    #[serde(flatten)]
    pose: PoseRow,
}

#[derive(Serialize)]
struct TouchRow<'a> {
    between: &'a [String; 2],
    point: [f64; 3],
    normal: [f64; 3],
    distance: f64,
}

impl<'a> TouchRow<'a> {
    fn new(touch: &'a Touch) -> Self {
        Self {
            between: &touch.between,
            point: touch.point.into(),
            normal: touch.normal.into_inner().into(),
            distance: touch.distance,
        }
    }
}
