//! The point nearest to the origin of those before several planes.

use crate::Vector;

/// Exchanges of planes before the search gives up.
const MOST: usize = 100;
/// By how much a plane may be missed, relative to the point's and the plane's distance: less by those that are exchanged,
/// or nearly equal ones take turns.
const EXACT: f64 = 1e-13;
const EXCHANGED: f64 = 1e-14;

/// The half space of the points `p` with `normal·p >= offset`, in metres; the normal is a unit vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: Vector,
    pub(super) offset: f64,
}

impl Plane {
    /// How far a point is on the wrong side.
    pub(super) fn missed(&self, p: &Vector) -> f64 {
        self.offset - self.normal.dot(p)
    }
}

/// The nearest point to the origin that lies in all half spaces, by the dual active set method: the planes that it lies
/// on, at most three, are exchanged for those that are missed. `None` where no point lies in all.
pub(super) fn foot(planes: &[Plane]) -> Option<Vector> {
    let mut at = Vector::zeros();
    let mut active: Vec<Plane> = Vec::new();
    for _ in 0..MOST {
        let worst = planes.iter().max_by(|p, q| p.missed(&at).total_cmp(&q.missed(&at)))?;
        if worst.missed(&at) <= EXACT * (at.norm() + worst.offset.abs()) {
            return Some(at);
        }
        active.push(*worst);
        (at, active) = nearest(&active)?;
    }
    None
}

/// The same for at most four planes, and those that the point lies on.
fn nearest(planes: &[Plane]) -> Option<(Vector, Vec<Plane>)> {
    let mut best: Option<(Vector, Vec<Plane>)> = None;
    for chosen in 1u32..1 << planes.len() {
        let on: Vec<Plane> =
            (0..planes.len()).filter(|k| chosen >> k & 1 == 1).map(|k| planes[k]).collect();
        let Some(at) = meeting(&on) else { continue };
        let inside =
            planes.iter().all(|p| p.missed(&at) <= EXCHANGED * (at.norm() + p.offset.abs()));
        if inside && best.as_ref().is_none_or(|(other, _)| at.norm() < other.norm()) {
            best = Some((at, on));
        }
    }
    best
}

/// The point of one to three planes that is nearest to the origin, along normals that are made orthogonal one after
/// the other: it misses its planes by rounding alone, however small the angles between them are.
fn meeting(planes: &[Plane]) -> Option<Vector> {
    let mut at = Vector::zeros();
    let mut axes = [Vector::zeros(); 3];
    for (k, plane) in planes.iter().enumerate() {
        let mut axis = plane.normal;
        // the second time takes away what rounding left at small angles
        for _ in 0..2 {
            for other in &axes[..k] {
                axis -= other * other.dot(&axis);
            }
            axis.try_normalize_mut(0.0)?;
        }
        at += axis * (plane.missed(&at) / plane.normal.dot(&axis));
        *axes.get_mut(k)? = axis;
    }
    at.iter().all(|v| v.is_finite()).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(normal: [f64; 3], offset: f64) -> Plane {
        Plane { normal: Vector::from(normal).normalize(), offset }
    }

    #[test]
    fn a_plane_an_edge_and_a_corner() {
        let [x, y, z] = [
            plane([1.0, 0.0, 0.0], 1.0),
            plane([0.0, 1.0, 0.0], 2.0),
            plane([0.0, 0.0, -1.0], 3.0),
        ];
        assert_eq!(foot(&[]), None);
        assert_eq!(foot(&[x]), Some(Vector::new(1.0, 0.0, 0.0)));
        assert_eq!(foot(&[y, x]), Some(Vector::new(1.0, 2.0, 0.0)));
        assert_eq!(foot(&[z, y, x]), Some(Vector::new(1.0, 2.0, -3.0)));
        // a plane that all others imply, and one that leaves nothing
        assert_eq!(foot(&[x, plane([1.0, 0.0, 0.0], 0.5)]), Some(Vector::new(1.0, 0.0, 0.0)));
        assert_eq!(foot(&[x, plane([-1.0, 0.0, 0.0], 0.5)]), None);
    }
}
