//! A scene as simulators think of it: links of parts that move as one, ball joints between them, and fixed boxes.
//!
//! A link's frame has the axes of its body's frame, at rest. The root's stands where the body's does, that of any other
//! link at its joint's anchor. All formats are written from this.

use std::path::Path;

use nalgebra::{Matrix3, UnitQuaternion};
use supersurface::combine::{Assembly, Joint, JointKind};
use supersurface::mesh::Mesh;
use supersurface::scene::{Body, Scene};
use supersurface::shape::{Mass, MassProperties, Posed};
use supersurface::surface::Surface;
use supersurface::{Point, Pose, Vector};

use super::convex_pieces::convex_pieces;
use super::names::Names;
use super::part_mesh::part_mesh;
use super::{SceneCamera, SceneExtras, Site};
use crate::error::{WriteError, printable};

/// Half the thickness of the table's top, in metres.
const TABLE: f64 = 0.02;
/// Most links of a body: they may hang one from the other, and files nest as deep.
const MOST_LINKS: usize = 500;
/// Names that files or simulators keep for themselves.
const RESERVED: [&str; 7] =
    ["scene", "scene_world", "meshes", "world", "materials", "physics", "default"];

/// All that is written.
pub(super) struct Prepared<'a> {
    pub(super) scene: &'a Scene,
    pub(super) extras: &'a SceneExtras,
    pub(super) bodies: Vec<Tree<'a>>,
    /// The table's top first, then the boards.
    pub(super) boxes: Vec<FixedBox>,
    pub(super) cameras: Vec<(String, &'a SceneCamera)>,
    pub(super) sites: Vec<(String, &'a Site)>,
}

/// A body's links; parents come before their children.
pub(super) struct Tree<'a> {
    /// Also the id of the root link.
    pub(super) id: String,
    pub(super) body: &'a Body,
    pub(super) links: Vec<Link>,
}

/// Parts that move as one.
pub(super) struct Link {
    pub(super) id: String,
    pub(super) joint: Option<Ball>,
    /// Origin of the link's frame in the body's, at rest.
    pub(super) origin: Vector,
    pub(super) parts: Vec<LinkPart>,
    /// In the link's frame.
    pub(super) mass: Mass,
}

/// A ball joint at the origin of a link, which turns against its parent.
pub(super) struct Ball {
    /// Index of the parent among the links.
    pub(super) parent: usize,
    /// N m/rad.
    pub(super) stiffness: f64,
    /// N m s/rad.
    pub(super) damping: f64,
}

/// A part of a link.
pub(super) struct LinkPart {
    pub(super) id: String,
    /// Which of the body's parts it is.
    pub(super) index: usize,
    /// In the link's frame.
    pub(super) solid: Posed<Surface>,
    /// In the part's own frame.
    pub(super) mesh: Mesh,
    /// Convex pieces in the part's own frame; none where the mesh's hull will do.
    pub(super) pieces: Vec<Mesh>,
}

impl LinkPart {
    /// True for a plain ellipsoid, which simulators know.
    pub(super) fn is_ellipsoid(&self) -> bool {
        matches!(self.solid.shape(), Surface::Superellipsoid(s) if s.exponents() == [1.0; 2])
    }
}

/// A cuboid that does not move.
pub(super) struct FixedBox {
    pub(super) id: String,
    pub(super) half_extents: [f64; 3],
    pub(super) pose: Pose,
}

impl<'a> Prepared<'a> {
    /// Fails where a number is out of range, or a link's mass and inertia are those of no solid; `folder` is for errors.
    pub(super) fn new(
        folder: &Path,
        scene: &'a Scene,
        extras: &'a SceneExtras,
    ) -> Result<Self, WriteError> {
        let failed = |problem| WriteError::new(folder, std::io::Error::other(problem));
        let mut names = Names::new(&RESERVED);
        let boxes = boxes(scene, &mut names).map_err(failed)?;
        let ids: Vec<String> =
            scene.bodies.iter().map(|body| names.give(&body.name, "body")).collect();
        let mut bodies = Vec::with_capacity(ids.len());
        for (body, id) in scene.bodies.iter().zip(ids) {
            let named = |e: String| failed(format!("body {}: {e}", shown(&body.name)));
            checked(body).map_err(named)?;
            bodies.push(Tree::new(body, id, &mut names).map_err(named)?);
        }
        let camera = |c: &'a SceneCamera| (names.give(&c.name, "camera"), c);
        let cameras = extras.cameras.iter().map(camera).collect();
        let site = |s: &'a Site| (names.give(&s.name, "site"), s);
        let sites: Vec<_> = extras.sites.iter().map(site).collect();
        let poses = extras.cameras.iter().map(|c| (&c.name, &c.pose));
        for (name, pose) in poses.chain(extras.sites.iter().map(|s| (&s.name, &s.pose))) {
            finite(pose).map_err(|e| failed(format!("{}: {e}", shown(name))))?;
        }
        for touch in &extras.touches {
            let numbers = touch.point.iter().chain(touch.normal.iter()).chain([&touch.distance]);
            if !numbers.copied().all(f64::is_finite) {
                let [a, b] = &touch.between;
                let problem = "a number is not finite";
                return Err(failed(format!("contact of {} and {}: {problem}", shown(a), shown(b))));
            }
        }
        Ok(Self { scene, extras, bodies, boxes, cameras, sites })
    }
}

impl Prepared<'_> {
    /// The parts of all bodies.
    pub(super) fn parts(&self) -> impl Iterator<Item = &LinkPart> {
        self.bodies.iter().flat_map(|tree| &tree.links).flat_map(|link| &link.parts)
    }
}

/// The table's top as a cuboid under its plane, and the boards.
fn boxes(scene: &Scene, names: &mut Names) -> Result<Vec<FixedBox>, String> {
    let normal = scene.support.normal();
    let turn = UnitQuaternion::rotation_between(&Vector::z(), &normal);
    let top = scene.support.project(&Point::origin());
    let middle = top - normal.into_inner() * TABLE;
    // where there is none the normal points straight down
    let turn = turn.unwrap_or_else(|| {
        UnitQuaternion::from_axis_angle(&Vector::x_axis(), std::f64::consts::PI)
    });
    let [x, y] = scene.half_size;
    let mut boxes = vec![FixedBox {
        id: names.give("table", "table"),
        half_extents: [x, y, TABLE],
        pose: Pose::from_parts(middle.coords.into(), turn),
    }];
    boxes.extend(scene.boards.iter().map(|board| FixedBox {
        id: names.give(&board.name, "board"),
        half_extents: board.half_extents,
        pose: board.pose,
    }));
    for (k, fixed) in boxes.iter().enumerate() {
        let name = match k.checked_sub(1).and_then(|k| scene.boards.get(k)) {
            Some(board) => format!("board {}", shown(&board.name)),
            None => "table".to_owned(),
        };
        finite(&fixed.pose).map_err(|e| format!("{name}: {e}"))?;
        if let Some(half) = fixed.half_extents.iter().find(|h| !(**h > 0.0 && h.is_finite())) {
            return Err(format!("{name}: half an edge is {half} m: it must be positive"));
        }
    }
    Ok(boxes)
}

fn checked(body: &Body) -> Result<(), String> {
    finite(&body.pose)?;
    match body.friction >= 0.0 && body.friction.is_finite() {
        true => Ok(()),
        false => Err(format!("friction is {}: it must be finite, not negative", body.friction)),
    }
}

fn finite(pose: &Pose) -> Result<(), String> {
    let numbers = pose.translation.vector.iter().chain(pose.rotation.coords.iter());
    match numbers.copied().all(f64::is_finite) {
        true => Ok(()),
        false => Err("its pose is not finite".to_owned()),
    }
}

/// The parts of a link to be, and the joint that carries it with its anchor in the body's frame.
struct Group {
    parts: Vec<usize>,
    joint: Option<(Ball, Vector)>,
}

/// Parts that are fixed to each other, from the root outwards.
fn groups(shape: &Assembly<Surface>) -> Vec<Group> {
    let motions = shape.motions(&shape.rest_rotations());
    let mut groups = vec![Group { parts: vec![shape.root()], joint: None }];
    let mut waiting: Vec<&Joint> = shape.joints().iter().collect();
    while !waiting.is_empty() {
        let before = waiting.len();
        waiting.retain(|joint| {
            let parent = groups.iter().position(|g| g.parts.contains(&joint.parent()));
            let Some(parent) = parent else { return true };
            let [stiffness, damping] = match joint.kind() {
                JointKind::Fixed => {
                    groups[parent].parts.push(joint.child());
                    return false;
                }
                JointKind::Spherical => [0.0; 2],
                JointKind::Spring { stiffness, damping, .. } => [stiffness, damping],
            };
            let motion = motions.get(joint.parent()).copied().unwrap_or_default();
            let anchor = (motion * joint.anchor()).coords;
            let joint_of = (Ball { parent, stiffness, damping }, anchor);
            groups.push(Group { parts: vec![joint.child()], joint: Some(joint_of) });
            false
        });
        // the joints are a tree, so that each round reaches a part
        if waiting.len() == before {
            break;
        }
    }
    groups
}

impl<'a> Tree<'a> {
    fn new(body: &'a Body, id: String, names: &mut Names) -> Result<Self, String> {
        let solids = body.shape.bodies(&body.shape.rest_rotations());
        let parts: Vec<_> = body.shape.parts().iter().zip(&solids).collect();
        let mut links = Vec::new();
        let groups = groups(&body.shape);
        if groups.len() > MOST_LINKS {
            let problem = format!("{} links: at most {MOST_LINKS} are written", groups.len());
            return Err(format!("{problem}; fix parts to each other that need not move"));
        }
        for Group { parts: members, joint } in groups {
            let origin = joint.as_ref().map_or_else(Vector::zeros, |(_, anchor)| *anchor);
            let to_link = Pose::from_parts((-origin).into(), UnitQuaternion::identity());
            let mut mass = Mass { mass: 0.0, centre: Point::origin(), inertia: Matrix3::zeros() };
            let mut held = Vec::new();
            for index in members {
                let Some((part, solid)) = parts.get(index) else { continue };
                let solid = solid.moved(&to_link);
                let own = solid.shape().mass_properties(part.density()).moved(solid.pose());
                mass = mass.joined(&own);
                let mesh = part_mesh(solid.shape())
                    .map_err(|e| format!("part {}: {e}", shown(part.name())))?;
                let part_id = match parts.len() {
                    1 => id.clone(),
                    _ => names.give(&format!("{id}_{}", part.name()), "part"),
                };
                let pieces = convex_pieces(solid.shape());
                held.push(LinkPart { id: part_id, index, solid, mesh, pieces });
            }
            of_a_solid(&mass)?;
            let own = held.first().filter(|_| joint.is_some()).map_or(&id, |part| &part.id);
            let (id, joint) = (own.clone(), joint.map(|(ball, _)| ball));
            links.push(Link { id, joint, origin, parts: held, mass });
        }
        Ok(Self { id, body, links })
    }
}

/// A name in quotes, fit for a message.
fn shown(name: &str) -> String {
    printable(&format!("{name:?}"))
}

/// Checks what simulators do not: a mass, and an inertia whose principal moments are positive and keep the triangle
/// inequality, as those of every solid do.
pub(super) fn of_a_solid(mass: &Mass) -> Result<(), String> {
    if !(mass.mass > 0.0 && mass.mass.is_finite()) {
        let problem = format!("its mass is {} kg: simulators need one", mass.mass);
        return Err(format!("{problem}; give its parts a density"));
    }
    let mut moments = mass.inertia.symmetric_eigenvalues();
    moments.as_mut_slice().sort_by(f64::total_cmp);
    let [least, middle, most] = moments.into();
    match least > 0.0 && most <= (least + middle) * (1.0 + 1e-9) && most.is_finite() {
        true => Ok(()),
        false => Err(format!(
            "its principal moments of inertia are {least:e}, {middle:e} and {most:e} kg m²: those of no solid"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inertias_of_no_solid_are_refused() {
        let mass = |mass, moments: [f64; 3]| Mass {
            mass,
            centre: Default::default(),
            inertia: Matrix3::from_diagonal(&moments.into()),
        };
        assert!(of_a_solid(&mass(1.0, [1.0, 2.0, 2.9])).is_ok());
        assert!(of_a_solid(&mass(0.0, [1.0; 3])).unwrap_err().contains("density"));
        for moments in [[1.0, 2.0, 3.1], [-1.0, 2.0, 1.5], [0.0, 1.0, 1.0], [f64::NAN, 1.0, 1.0]] {
            assert!(of_a_solid(&mass(1.0, moments)).is_err(), "{moments:?}");
        }
    }
}
