//! Where to begin: bodies laid into frames that the structure of the cloud suggests.
//!
//! Frames come from the support (upright, turned to the least bounding rectangle), from the principal axes
//! of all points and of those on flat and dense patches, and from the scatter of local normals. Each gives three choices of the z axis and, where
//! two axes are alike, a start turned by 45 degrees. Semi-axes are half extents between low quantiles; the
//! side that the camera does not see is completed along the viewing direction.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4};

use nalgebra::{Matrix3, Rotation3};

use super::centred::{axes_of, scatter};
use super::parameters::{Family, Parameters, RINGS};
use super::patches::{Patch, firmest, flattest, patches};
use super::terms::{Sight, Terms};
use crate::Vector;

/// Points by which the least rectangle is found, at most.
const FOOTPRINT: usize = 200;
/// Quantile that stands for an end of the cloud along an axis.
const TAIL: f64 = 0.02;
/// How far the hidden side is completed, in lateral sizes.
const DEPTHS: [f64; 2] = [0.3, 1.0];
/// Exponents of every start.
const EXPONENT: f64 = 0.6;
/// Half the angle of the bends from which is searched, in radians.
const BENDING: f64 = 0.35;
/// Turns of the twists from which is searched.
const TWIST: f64 = 0.12;
/// Shares of the neighbourhoods: the most flat and dense, and the flattest.
const FIRM: f64 = 1.0 / 3.0;
const FLAT: f64 = 0.5;
/// Neighbourhoods by which a careful fit finds its frames.
pub(super) const NEIGHBOURHOODS: usize = 320;
/// Fewer neighbourhoods than this make no frame.
const LEAST_PATCHES: usize = 8;
/// Two frames whose axes agree within this cosine are one.
const SAME_AXIS: f64 = 0.985;
/// How far two starts may be apart, in place or in size as a ratio, that are one.
const ALIKE: f64 = 0.1;

/// All starts of a family in the frames of a cloud; rings with these shares of the widest hole.
pub(super) fn starts(
    frames: &[Frame],
    terms: &Terms,
    family: Family,
    holes: &[f64],
) -> Vec<Parameters> {
    let mut out = Vec::new();
    for frame in frames {
        let extents = Extents::of(frame, terms);
        let hidden = terms.sight == Sight::OneSide && !frame.whole;
        let depths: &[f64] = if hidden { &DEPTHS } else { &[0.0] };
        for depth in depths {
            extents.completed(*depth).bodies(frame, family, holes, &mut out);
        }
    }
    out
}

/// A right-handed frame and the points that a body in it should hold.
pub(super) struct Frame {
    axes: Matrix3<f64>,
    points: Vec<Vector>,
    /// True where the points show all sides.
    whole: bool,
}

/// Frames of points that show all sides, though the cloud does not.
pub(super) fn whole_frames(points: &[Vector]) -> Vec<Frame> {
    let terms = Terms { sight: Sight::OneSide, ..Terms::default() };
    let frames = frames(points, &terms, NEIGHBOURHOODS).into_iter();
    frames.map(|f| Frame { whole: true, ..f }).collect()
}

/// Frames for normalised points, without near duplicates, some by up to `looked_at` neighbourhoods.
pub(super) fn frames(points: &[Vector], terms: &Terms, looked_at: usize) -> Vec<Frame> {
    let mut out = Vec::new();
    if let Some(support) = terms.support {
        push(&mut out, upright(points, &support.normal), points.to_vec(), terms);
    }
    push(&mut out, axes_of(&scatter(points.iter())), points.to_vec(), terms);
    let patches = patches(points, looked_at);
    let of = |patches: &[Patch]| patches.iter().map(|p| p.point).collect::<Vec<_>>();
    let firm = of(&firmest(&patches, FIRM));
    let flat = flattest(&patches, FLAT);
    if firm.len() >= LEAST_PATCHES {
        push(&mut out, axes_of(&scatter(firm.iter())), firm, terms);
        let normals = flat.iter().map(|p| p.normal * p.normal.transpose()).sum();
        push(&mut out, axes_of(&normals), of(&flat), terms);
    }
    out
}

/// The frame of all points turned to all sides: by 45 degrees about its axes and by 60 about the diagonals, which no axis
/// of a cube is farther from.
pub(super) fn turned_frames(points: &[Vector], terms: &Terms) -> Vec<Frame> {
    let axes = axes_of(&scatter(points.iter()));
    let about_axes = [Vector::x(), Vector::y(), Vector::z()].map(|way| way * FRAC_PI_4);
    let diagonals = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let about_diagonals = diagonals.map(|[x, y]| Vector::new(x, y, 1.0).normalize() * FRAC_PI_3);
    let mut out = Vec::new();
    for turn in about_axes.into_iter().chain(about_diagonals) {
        let turned = axes * Rotation3::new(turn).matrix();
        push(&mut out, turned, points.to_vec(), terms);
    }
    out
}

/// Adds a frame. Two with the same axes differ only where outliers stretch one of them, which on a single view is left
/// out.
fn push(out: &mut Vec<Frame>, axes: Matrix3<f64>, points: Vec<Vector>, terms: &Terms) {
    let same = |other: &Frame| {
        let alike = |i, j| axes.column(i).dot(&other.axes.column(j)).abs() > SAME_AXIS;
        (0..3).all(|i| (0..3).any(|j| alike(i, j)))
    };
    if terms.sight != Sight::OneSide || !out.iter().any(same) {
        out.push(Frame { axes, points, whole: false });
    }
}

/// The frame with z along `normal` in which the footprint's bounding rectangle is least.
fn upright(points: &[Vector], normal: &Vector) -> Matrix3<f64> {
    let helper = if normal.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
    let u = (helper - normal * normal.dot(&helper)).normalize();
    let v = normal.cross(&u);
    let some = points.iter().step_by(points.len().div_ceil(FOOTPRINT).max(1));
    let flat: Vec<[f64; 2]> = some.map(|p| [p.dot(&u), p.dot(&v)]).collect();
    let mut buffer = Vec::with_capacity(flat.len());
    let mut width = |angle: f64| {
        let (s, c) = angle.sin_cos();
        buffer.clear();
        buffer.extend(flat.iter().map(|p| p[0] * c + p[1] * s));
        let low = quantile(&mut buffer, TAIL);
        quantile(&mut buffer, 1.0 - TAIL) - low
    };
    let mut best = (f64::INFINITY, 0.0);
    for degrees in (0..90).step_by(6) {
        let angle = f64::from(degrees).to_radians();
        let area = width(angle) * width(angle + FRAC_PI_2);
        if area < best.0 {
            best = (area, angle);
        }
    }
    let (s, c) = best.1.sin_cos();
    let x = u * c + v * s;
    Matrix3::from_columns(&[x, normal.cross(&x), *normal])
}

/// The box of a cloud along the axes of a frame.
#[derive(Clone, Copy)]
struct Extents {
    low: [f64; 3],
    high: [f64; 3],
    /// Cosines between the axes and the viewing direction, zero along the support's normal.
    hidden: [f64; 3],
    /// Size across the viewing direction.
    lateral: f64,
}

impl Extents {
    fn of(frame: &Frame, terms: &Terms) -> Self {
        let mut e = Self { low: [0.0; 3], high: [0.0; 3], hidden: [0.0; 3], lateral: 0.0 };
        let mut buffer = Vec::with_capacity(frame.points.len());
        for k in 0..3 {
            let axis: Vector = frame.axes.column(k).into();
            buffer.clear();
            buffer.extend(frame.points.iter().map(|p| p.dot(&axis)));
            e.low[k] = quantile(&mut buffer, TAIL);
            e.high[k] = quantile(&mut buffer, 1.0 - TAIL);
        }
        if !terms.eyes.is_empty() && !frame.whole {
            // of several views what one does not see another may
            let views = terms.eyes.iter().map(|eye| (-eye.place).normalize());
            let view = views.sum::<Vector>() / terms.eyes.len() as f64;
            let (mut sum, mut weights) = (0.0, 1e-9);
            for k in 0..3 {
                e.hidden[k] = frame.axes.column(k).dot(&view);
                let across = 1.0 - e.hidden[k] * e.hidden[k];
                sum += across * (e.high[k] - e.low[k]);
                weights += across;
            }
            e.lateral = sum / weights;
        }
        if let Some(support) = terms.support.filter(|s| s.standing) {
            for k in 0..3 {
                let c = frame.axes.column(k).dot(&support.normal);
                if c.abs() > SAME_AXIS {
                    // along the normal both ends are known: the plane and the seen top
                    e.hidden[k] = 0.0;
                    let ground = -support.offset / c;
                    if c > 0.0 { e.low[k] = ground } else { e.high[k] = ground }
                }
            }
        }
        e
    }

    fn completed(mut self, depth: f64) -> Self {
        for k in 0..3 {
            let grow = depth * self.lateral * self.hidden[k];
            if grow > 0.0 { self.high[k] += grow } else { self.low[k] += grow }
        }
        self
    }

    fn bodies(&self, frame: &Frame, family: Family, holes: &[f64], out: &mut Vec<Parameters>) {
        let middle = Vector::from_fn(|k, _| 0.5 * (self.low[k] + self.high[k]));
        let half: [f64; 3] =
            std::array::from_fn(|k| (0.5 * (self.high[k] - self.low[k])).max(0.03));
        let position = frame.axes * middle;
        for z in [2, 1, 0] {
            let order = [(z + 1) % 3, (z + 2) % 3, z];
            let axes = order.map(|k| half[k]);
            let columns = order.map(|k| Vector::from(frame.axes.column(k)));
            let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&columns));
            let start = Parameters {
                log_axes: axes.map(f64::ln),
                exponents: [EXPONENT; 2],
                position,
                rotation,
                ..Parameters::ball(family)
            };
            if family.is_ring() {
                for hole in holes {
                    let start = ringed(&start, axes, &frame.points, *hole);
                    if !out.iter().any(|known| is_alike(known, &start)) {
                        out.push(start);
                    }
                }
                continue;
            }
            if out.iter().any(|known| is_alike(known, &start)) {
                continue;
            }
            let square = axes[0].max(axes[1]) < 1.5 * axes[0].min(axes[1]);
            for start in [Some(start), square.then(|| turned(&start, axes))].into_iter().flatten() {
                deformed(&start, axes[2], out);
            }
        }
    }
}

/// True for starts, without their deformations, of which one leads where the other does.
fn is_alike(a: &Parameters, b: &Parameters) -> bool {
    let near = |i: usize, j: usize| (a.log_axes[i] - b.log_axes[j]).abs() < ALIKE;
    let along = |i: usize, j: usize| {
        let axes = [a.rotation.matrix().column(i), b.rotation.matrix().column(j)];
        axes[0].dot(&axes[1]).abs() > SAME_AXIS
    };
    // the first two axes may have changed places
    let across = |[i, j]: [usize; 2]| near(0, i) && near(1, j) && along(0, i);
    near(2, 2)
        && (a.position - b.position).norm() < ALIKE
        && (a.ring / b.ring).ln().abs() < ALIKE
        && along(2, 2)
        && (across([0, 1]) || across([1, 0]))
}

/// The start with the deformations from which its family is searched: four ways to bend, two to twist; a taper is
/// found from none.
fn deformed(start: &Parameters, height: f64, out: &mut Vec<Parameters>) {
    if start.family.is_bent() {
        let k = BENDING / height;
        out.extend(
            [[k, 0.0], [0.0, k], [-k, 0.0], [0.0, -k]].map(|bend| Parameters { bend, ..*start }),
        );
    } else if start.family.is_twisted() {
        out.extend([-TWIST, TWIST].map(|twist| Parameters { twist, ..*start }));
    } else {
        out.push(*start);
    }
}

/// The start turned by 45 degrees about its z axis.
fn turned(start: &Parameters, axes: [f64; 3]) -> Parameters {
    let mean = 0.55 * (axes[0] + axes[1]);
    let turn = Rotation3::new(Vector::z() * FRAC_PI_4);
    Parameters {
        log_axes: [mean.ln(), (0.97 * mean).ln(), axes[2].ln()],
        rotation: start.rotation * turn,
        ..*start
    }
}

/// The toroid in the same box whose hole is this share of a low quantile of the planar radius.
fn ringed(start: &Parameters, axes: [f64; 3], points: &[Vector], share: f64) -> Parameters {
    let mut radii: Vec<f64> = points
        .iter()
        .map(|p| {
            let q = start.rotation.inverse_transform_vector(&(p - start.position));
            let (x, y) = (q.x / axes[0], q.y / axes[1]);
            (x * x + y * y).sqrt()
        })
        .collect();
    let hole = (share * quantile(&mut radii, 2.0 * TAIL)).clamp(0.1, 0.8);
    let ring = ((1.0 + hole) / (1.0 - hole)).clamp(RINGS[0], RINGS[1]);
    let scale = 1.0 / (1.0 + ring);
    Parameters {
        log_axes: [(axes[0] * scale).ln(), (axes[1] * scale).ln(), axes[2].ln()],
        ring,
        ..*start
    }
}

/// The value below which a share `q` of the values lies; 0 for none.
pub(super) fn quantile(values: &mut [f64], q: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let k = ((values.len() - 1) as f64 * q).round() as usize;
    *values.select_nth_unstable_by(k, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_that_lead_to_one_body_are_alike() {
        let start = Parameters {
            log_axes: [0.1, -0.4, 0.6],
            rotation: Rotation3::new(Vector::new(0.3, -0.8, 0.2)),
            ..Parameters::ball(Family::Superellipsoid)
        };
        let turned =
            |by: Vector| Parameters { rotation: start.rotation * Rotation3::new(by), ..start };
        let half = turned(Vector::x() * std::f64::consts::PI);
        let quarter = turned(Vector::z() * FRAC_PI_2);
        let swapped = Parameters { log_axes: [-0.4, 0.1, 0.6], ..quarter };
        assert!([start, half, swapped].iter().all(|other| is_alike(&start, other)));
        let longer = Parameters { log_axes: [0.1, -0.4, 0.8], ..start };
        let moved = Parameters { position: Vector::y() * 0.2, ..start };
        let wider = Parameters { ring: 3.0, ..start };
        let others = [quarter, longer, moved, wider, turned(Vector::y() * 0.5)];
        assert!(others.iter().all(|other| !is_alike(&start, other)));
    }
}
