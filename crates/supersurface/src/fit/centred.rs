//! Points about their mean, in units of their root mean square distance from it: what every fit works on, so that
//! neither place nor unit matters. Points that determine no surface are told apart here.

use nalgebra::SymmetricEigen;

use super::FitError;
use super::patches::scatter;
use crate::{Point, Vector};

/// A cloud with zero mean and unit root mean square.
#[derive(Clone, Debug)]
pub(super) struct Centred {
    pub(super) points: Vec<Vector>,
    /// The mean, in the cloud's frame and metres.
    pub(super) centre: Vector,
    /// The root mean square, in metres.
    pub(super) scale: f64,
}

impl Centred {
    /// Fails when the points are fewer than `needed`, one point or on one line. They must be finite.
    pub(super) fn new(points: &[Vector], needed: usize) -> Result<Self, FitError> {
        let found = points.len();
        let Some(origin) = points.first().copied().filter(|_| found >= needed) else {
            return Err(FitError::TooFewPoints { found, needed });
        };
        // about the first point and by the largest offset, so that nothing cancels or overflows
        let reach = points.iter().map(|p| (p - origin).amax()).fold(0.0, f64::max);
        let magnitude = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        if reach <= 1e-12 * magnitude || !reach.is_normal() {
            return Err(FitError::OnePoint { points: found });
        }
        let n = found as f64;
        let mean: Vector = points.iter().map(|p| (p - origin) / reach).sum::<Vector>() / n;
        let centre = origin + mean * reach;
        let square = points.iter().map(|p| ((p - centre) / reach).norm_squared()).sum::<f64>() / n;
        let scale = square.sqrt() * reach;
        if !scale.is_normal() || !is_finite(&centre) {
            return Err(FitError::OnePoint { points: found });
        }
        let points: Vec<Vector> = points.iter().map(|p| (p - centre) / scale).collect();
        let mut values = SymmetricEigen::new(scatter(points.iter())).eigenvalues;
        values.as_mut_slice().sort_by(f64::total_cmp);
        if values[1] < 1e-10 * values[2] {
            return Err(FitError::Line { points: found });
        }
        Ok(Self { points, centre, scale })
    }

    /// A point of the cloud's frame in these units.
    pub(super) fn inward(&self, p: &Point) -> Vector {
        (p.coords - self.centre) / self.scale
    }
}

/// The finite points.
pub(super) fn finite(points: &[Point]) -> Vec<Vector> {
    points.iter().map(|p| p.coords).filter(is_finite).collect()
}

pub(super) fn is_finite(v: &Vector) -> bool {
    v.iter().all(|x| x.is_finite())
}

/// About `count` of the points, evenly spread over their order: one of each of `count` equal stretches, not the
/// same of each, as a step of the rows of a regular cloud would see only some of its columns.
pub(super) fn spread(points: &[Vector], count: usize) -> Vec<Vector> {
    spread_over(points.len(), count).map(|i| points[i]).collect()
}

/// The same as places among `n`.
pub(super) fn spread_over(n: usize, count: usize) -> impl Iterator<Item = usize> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let taken = n.min(count);
    let stretch = n as f64 / taken.max(1) as f64;
    let at = move |i: usize| ((i as f64 + (GOLDEN * i as f64).fract()) * stretch) as usize;
    (0..taken).map(move |i| at(i).min(n - 1))
}
