//! The nearest or deepest points of two convex shapes that only have support points, step by step.
//!
//! GJK's iterations with two changes for pairs that stay together. What parted them in the step before is tried first, and
//! mostly still does. And shapes that touched are looked at apart, shifted by the reach along their last normal: GJK needs no
//! second algorithm (EPA) then where they overlap, and many fewer iterations where they only just touch. The normal that
//! is found belongs to the shifted pair; as it is the next step's shift, it is the true one once the pair is at rest.

use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;

/// Iterations, after which parry's own are asked.
const STEPS: usize = 50;
/// The distance is found to within this share.
const TOLERANCE: f64 = 1e-4;

/// How two shapes lie, all in the first one's frame.
pub(super) enum Found {
    /// Farther apart than the reach: the direction that shows it, zero where none is known.
    Apart(ParryVector),
    /// The nearest or deepest points and the normal.
    Touching([ParryVector; 2], ParryVector),
}

/// The nearest or deepest points of shapes within a reach. `before` is a direction that may part them, of the step before
/// where `touched` says that they did.
pub(super) fn search(
    pos12: &ParryPose,
    g1: &(impl SupportMap + ?Sized),
    g2: &(impl SupportMap + ?Sized),
    reach: f64,
    before: ParryVector,
    touched: bool,
) -> Found {
    let shift = before * if touched { reach } else { 0.0 };
    let mut shifted = *pos12;
    shifted.translation += shift;
    let far = reach + shift.dot(before);
    let first = CsoPoint::from_shapes(&shifted, g1, g2, before);
    if -first.point.dot(before) > far {
        return Found::Apart(before);
    }
    match nearest(&shifted, g1, g2, far, first) {
        Some(Found::Touching([p1, p2], n)) => {
            let p2 = p2 - shift;
            if (p2 - p1).dot(n) > reach { Found::Apart(n) } else { Found::Touching([p1, p2], n) }
        }
        Some(apart) => apart,
        None => {
            let simplex = &mut VoronoiSimplex::new();
            match contact_support_map_support_map_with_params(
                pos12,
                g1,
                g2,
                reach,
                simplex,
                Some(before),
            ) {
                GJKResult::ClosestPoints(p1, p2, n) => Found::Touching([p1, p2], n),
                GJKResult::NoIntersection(n) => Found::Apart(n),
                _ => Found::Apart(ParryVector::ZERO),
            }
        }
    }
}

/// `None` for shapes that overlap, or so nearly that rounding decides.
fn nearest(
    pos12: &ParryPose,
    g1: &(impl SupportMap + ?Sized),
    g2: &(impl SupportMap + ?Sized),
    reach: f64,
    first: CsoPoint,
) -> Option<Found> {
    let mut simplex = VoronoiSimplex::new();
    simplex.reset(first);
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let nearest = simplex.project_origin_and_reduce();
        let distance = nearest.length();
        if simplex.dimension() == 3 || distance <= 1e-9 * reach {
            return None;
        }
        let n = -nearest / distance;
        let point = CsoPoint::from_shapes(pos12, g1, g2, n);
        let least = -n.dot(point.point);
        if least > reach {
            return Some(Found::Apart(n));
        }
        let stuck = distance >= last;
        if distance - least <= TOLERANCE * distance || stuck || !simplex.add_point(point) {
            let sum = |of: fn(&CsoPoint) -> ParryVector| {
                (0..=simplex.dimension())
                    .map(|i| of(simplex.point(i)) * simplex.proj_coord(i))
                    .sum()
            };
            let points = [sum(|p| p.orig1), sum(|p| p.orig2)];
            return (least > 0.0).then_some(Found::Touching(points, n));
        }
        last = distance;
    }
    None
}
