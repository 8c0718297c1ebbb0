//! Grids of points on superellipsoids and supertoroids, by angles or by arcs of the two superellipses.
//!
//! The section gives directions around z, and along each of them the profile, a superellipse with the semi-axes
//! `a_ω` (how far the section reaches there) and a3, gives a meridian (FORMULAS §7.5). Equal steps of the angles crowd
//! points at poles and where curvature is high; equal arcs keep neighbours on a meridian as far apart as is asked for,
//! exactly or by Pilu and Fisher's steps. None of these is uniform over the area: meridians meet at poles and the
//! section's points are far apart on the outside of a ring. [`SurfaceSampler`](super::SurfaceSampler) is.

use std::f64::consts::TAU;

use super::{SuperellipseArc, pilu_fisher};
use crate::Point;
use crate::numeric::powers::{quadrant_cos_sin, signed_power};
use crate::shape::{InvalidShape, Superellipsoid, Supertoroid};

/// How points follow each other along a superellipse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// By equal angles, as many as equal arcs would give.
    Angle,
    /// By Pilu and Fisher's steps.
    PiluFisher,
    /// By equal arcs.
    EqualArc,
}

impl Spacing {
    /// Points about `distance` metres apart around a whole superellipse, counter-clockwise from `(a, 0)`.
    fn around(
        self,
        [a, b]: [f64; 2],
        exponent: f64,
        distance: f64,
    ) -> Result<Vec<[f64; 2]>, InvalidShape> {
        let fits = distance >= 1e-5 * a.max(b) && distance.is_finite();
        InvalidShape::check(
            fits,
            "distance of points",
            distance,
            "at least 1e-5 of the semi-axes",
        )?;
        if self == Self::PiluFisher {
            return pilu_fisher([a, b], exponent, distance);
        }
        let arc = SuperellipseArc::new([a, b], exponent)?;
        // whole quarters, so that the ends of the axes are among them
        let count = 4 * (arc.quarter_length() / distance).round().max(1.0) as usize;
        if self == Self::EqualArc {
            return Ok(arc.equal_arcs(count));
        }
        let at = |i: usize| {
            let (c, s) = quadrant_cos_sin(TAU * (i as f64 / count as f64));
            [a * signed_power(c, exponent), b * signed_power(s, exponent)]
        };
        Ok((0..count).map(at).collect())
    }
}

/// Points about `distance` metres apart along the section and along each meridian of a superellipsoid; both poles
/// come last. Fails for a distance under 1e-5 of a semi-axis, or semi-axes over 1e5 times as long as others.
///
/// ```
/// use supersurface::mesh::{Spacing, superellipsoid_grid};
/// use supersurface::shape::{Implicit, Superellipsoid};
/// let tin = Superellipsoid::new([0.03, 0.03, 0.05], [0.2, 1.0])?;
/// let points = superellipsoid_grid(&tin, Spacing::EqualArc, 0.005)?;
/// assert!(points.len() > 500 && points.iter().all(|p| (tin.gauge(p) - 1.0).abs() < 1e-9));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn superellipsoid_grid(
    shape: &Superellipsoid,
    spacing: Spacing,
    distance: f64,
) -> Result<Vec<Point>, InvalidShape> {
    let [a1, a2, a3] = shape.semi_axes();
    let mut points =
        grid([a1, a2, a3], shape.exponents(), spacing, distance, |out| (out > 0.0).then_some(out))?;
    points.extend([a3, -a3].map(|z| Point::new(0.0, 0.0, z)));
    Ok(points)
}

/// Points about `distance` metres apart along the tube's section and, on the circle through the tube's middle less
/// its radius, around z; on the outside they are farther apart. Fails as [`superellipsoid_grid`] does.
///
/// ```
/// use supersurface::mesh::{Spacing, supertoroid_grid};
/// use supersurface::shape::{Implicit, Supertoroid};
/// let ring = Supertoroid::new([0.01, 0.01, 0.02], 3.0, [0.5, 1.0])?;
/// let points = supertoroid_grid(&ring, Spacing::PiluFisher, 0.002)?;
/// assert!(points.iter().all(|p| (ring.gauge(p) - 1.0).abs() < 1e-9));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn supertoroid_grid(
    shape: &Supertoroid,
    spacing: Spacing,
    distance: f64,
) -> Result<Vec<Point>, InvalidShape> {
    let ring = shape.ring_ratio();
    grid(shape.semi_axes(), shape.exponents(), spacing, distance, |out| Some(ring + out))
}

/// Along each direction of the section, `place` says how many times its reach a point of the profile is away from z.
fn grid(
    [a1, a2, a3]: [f64; 3],
    [e1, e2]: [f64; 2],
    spacing: Spacing,
    distance: f64,
    place: impl Fn(f64) -> Option<f64>,
) -> Result<Vec<Point>, InvalidShape> {
    let mut points = Vec::new();
    for [x, y] in spacing.around([a1, a2], e2, distance)? {
        let reach = x.hypot(y);
        for [out, z] in spacing.around([reach, a3], e1, distance)? {
            if let Some(share) = place(out / reach) {
                points.push(Point::new(x * share, y * share, z));
            }
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Implicit;

    const ALL: [Spacing; 3] = [Spacing::Angle, Spacing::PiluFisher, Spacing::EqualArc];

    #[test]
    fn points_lie_on_the_surface_and_repeat_nothing() {
        for e in [[0.1, 0.1], [0.5, 1.6], [1.0, 1.0], [1.9, 0.4]] {
            let solid = Superellipsoid::new([0.3, 0.5, 0.2], e).unwrap();
            let ring = Supertoroid::new([0.3, 0.5, 0.2], 1.5, e).unwrap();
            for spacing in ALL {
                let points = superellipsoid_grid(&solid, spacing, 0.04).unwrap();
                let on = points.iter().filter(|p| (solid.gauge(p) - 1.0).abs() < 1e-9).count();
                assert_eq!(on, points.len(), "{e:?} {spacing:?}");
                assert_eq!(points.iter().filter(|p| p.x.hypot(p.y) < 1e-9).count(), 2);
                let points = supertoroid_grid(&ring, spacing, 0.04).unwrap();
                let on = points.iter().filter(|p| (ring.gauge(p) - 1.0).abs() < 1e-9).count();
                assert_eq!(on, points.len(), "{e:?} {spacing:?}");
            }
        }
    }

    #[test]
    fn neighbours_on_a_meridian_are_apart_as_asked() {
        // the largest gap in distances: angles leave the faces of a box empty
        let solid = Superellipsoid::new([0.3, 0.3, 0.4], [0.1, 1.0]).unwrap();
        let gap = |spacing| {
            let points = superellipsoid_grid(&solid, spacing, 0.02).unwrap();
            let meridian: Vec<_> =
                points.iter().filter(|p| p.y == 0.0 && p.x > 0.0).map(|p| [p.x, p.z]).collect();
            let nearest = |p: &[f64; 2]| {
                let far = |q: &&[f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
                // the next one counter-clockwise
                let next = meridian.iter().filter(|q| p[0] * q[1] > p[1] * q[0]);
                next.map(|q| far(&q)).fold(f64::INFINITY, f64::min)
            };
            let gaps = meridian.iter().map(nearest).filter(|g| g.is_finite());
            gaps.fold(0.0, f64::max) / 0.02
        };
        assert!(gap(Spacing::EqualArc) < 1.05);
        assert!(gap(Spacing::PiluFisher) < 1.3);
        assert!(gap(Spacing::Angle) > 5.0);
        for bad in [0.0, f64::NAN, 1e-9, f64::INFINITY] {
            assert!(superellipsoid_grid(&solid, Spacing::EqualArc, bad).is_err());
        }
    }
}
