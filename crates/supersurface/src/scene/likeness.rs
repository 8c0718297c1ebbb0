//! Things of several parts, put together from supersurfaces that are fixed to each other.
//!
//! Their z axis is upright and the origin stands in the middle of their height.

use crate::combine::{Assembly, Joint, JointKind, Part};
use crate::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use crate::surface::Surface;
use crate::{Point, Pose, Vector};
use nalgebra::{Translation3, UnitQuaternion};
use std::f64::consts::PI;

/// Exponent of edges that are nearly sharp.
const CRISP: f64 = 0.2;
/// Angle over which a handle goes round: a bit more than half a circle, so that its ends are in the wall.
const HANDLE: f64 = 1.1 * PI;
/// How many times a hammer's head is as dense as its handle.
const HEAD: f64 = 10.0;

/// The first part with all others fixed to it.
fn fixed(parts: Vec<Part<Surface>>) -> Result<Assembly<Surface>, InvalidShape> {
    let joint = |child| Joint::new(0, child, Point::origin(), JointKind::Fixed);
    let joints = (1..parts.len()).map(joint).collect::<Result<_, _>>()?;
    Assembly::new(parts, joints)
}

fn part(
    name: &str,
    surface: Surface,
    at: Vector,
    turn: UnitQuaternion<f64>,
    density: f64,
) -> Result<Part<Surface>, InvalidShape> {
    let pose = Pose::from_parts(Translation3::from(at), turn);
    Part::new(name, Posed::new(surface, pose)?, density)
}

fn upright(
    name: &str,
    surface: Surface,
    z: f64,
    density: f64,
) -> Result<Part<Surface>, InvalidShape> {
    part(name, surface, Vector::z() * z, UnitQuaternion::identity(), density)
}

/// A disc or can of a radius and half a height.
fn disc(radius: f64, half: f64) -> Result<Surface, InvalidShape> {
    Ok(Surface::Superellipsoid(Superellipsoid::new([radius, radius, half], [CRISP, 1.0])?))
}

/// A wall that goes round: outer radius, half of its thickness, half of its height.
fn wall(radius: f64, thick: f64, half: f64) -> Result<Surface, InvalidShape> {
    let ratio = (radius - thick) / thick;
    Ok(Surface::Supertoroid(Supertoroid::new([thick, thick, half], ratio, [CRISP, 1.0])?))
}

pub(super) fn mug(
    radius: f64,
    height: f64,
    thickness: f64,
    density: f64,
) -> Result<Assembly<Surface>, InvalidShape> {
    let (half, thick) = (0.5 * height, 0.5 * thickness);
    // the handle is a bent bar whose ends lie in the wall
    let (reach, bar) = (0.3 * height, (1.2 * thickness).min(0.1 * height));
    let core = Superellipsoid::new([bar, bar, 0.5 * HANDLE * reach], [CRISP, 1.0])?;
    let handle = Surface::bent(core, 1.0 / reach, PI)?;
    let out = radius - thick + reach;
    fixed(vec![
        upright("wall", wall(radius, thick, half)?, 0.0, density)?,
        upright("bottom", disc(radius - thick, thick)?, thick - half, density)?,
        part("handle", handle, Vector::x() * out, UnitQuaternion::identity(), density)?,
    ])
}

pub(super) fn bottle(
    radius: f64,
    height: f64,
    density: f64,
) -> Result<Assembly<Surface>, InvalidShape> {
    let neck = 0.35 * radius;
    let [body_half, shoulder_half, neck_half] = [0.3, 0.12, 0.1].map(|share| share * height);
    let middle = 0.5 * (radius + neck);
    let core = Superellipsoid::new([middle, middle, shoulder_half], [CRISP, 1.0])?;
    // as wide as the body below and as the neck above
    let slope = (neck - radius) / (neck + radius);
    let body_at = body_half - 0.5 * height;
    let shoulder_at = body_at + body_half + 0.9 * shoulder_half;
    fixed(vec![
        upright("body", disc(radius, body_half)?, body_at, density)?,
        upright("shoulder", Surface::tapered(core, [slope, slope])?, shoulder_at, density)?,
        upright("neck", disc(neck, neck_half)?, 0.5 * height - neck_half, density)?,
    ])
}

pub(super) fn bowl(
    radius: f64,
    depth: f64,
    density: f64,
) -> Result<Assembly<Surface>, InvalidShape> {
    const RINGS: usize = 4;
    let base = 0.5 * radius;
    let step = [(radius - base) / RINGS as f64, depth / RINGS as f64];
    // each ring overlaps the one below by a fifth of a step
    let thick = 0.6 * step[0];
    let mut parts =
        vec![upright("bottom", disc(base, 0.3 * step[1])?, 0.3 * step[1] - 0.5 * depth, density)?];
    for k in 0..RINGS {
        let outer = base + (k + 1) as f64 * step[0];
        let at = (k as f64 + 0.5) * step[1] - 0.5 * depth;
        let half = if k + 1 == RINGS { 0.5 } else { 0.6 } * step[1];
        // the lowest must not reach below the bottom
        let (at, half) = if k == 0 { (at + 0.05 * step[1], 0.55 * step[1]) } else { (at, half) };
        parts.push(upright(&format!("ring {}", k + 1), wall(outer, thick, half)?, at, density)?);
    }
    fixed(parts)
}

pub(super) fn hammer(length: f64, density: f64) -> Result<Assembly<Surface>, InvalidShape> {
    let half = 0.5 * length;
    let thick = 0.06 * length;
    let handle = Superellipsoid::new([0.7 * thick, thick, half], [CRISP, 0.8])?;
    let head = Superellipsoid::new([thick, thick, 0.22 * length], [CRISP, 0.6])?;
    // it lies: the handle's z axis along x of the whole, the head's along y
    let along = UnitQuaternion::from_axis_angle(&Vector::y_axis(), 0.5 * PI);
    let across = UnitQuaternion::from_axis_angle(&Vector::x_axis(), -0.5 * PI);
    let at = Vector::x() * (half - thick);
    fixed(vec![
        part("handle", Surface::Superellipsoid(handle), Vector::zeros(), along, density)?,
        part("head", Surface::Superellipsoid(head), at, across, HEAD * density)?,
    ])
}
