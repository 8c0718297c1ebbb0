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
    /// The finite points but those at `without`. Fails when they are fewer than `needed`, one point or on one line.
    pub(super) fn new(
        points: &[Point],
        needed: usize,
        without: Option<Point>,
    ) -> Result<Self, FitError> {
        let counts = |p: &&Point| is_finite(&p.coords) && Some(**p) != without;
        let points: Vec<Vector> = points.iter().filter(counts).map(|p| p.coords).collect();
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

pub(super) fn is_finite(v: &Vector) -> bool {
    v.iter().all(|x| x.is_finite())
}

/// About `count` of the points, evenly spread over their order: one of each of `count` equal stretches, not the
/// same of each, as a step of the rows of a regular cloud would see only some of its columns.
pub(super) fn spread(points: &[Vector], count: usize) -> Vec<Vector> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let n = points.len();
    let taken = n.min(count);
    let stretch = n as f64 / taken.max(1) as f64;
    let at = |i: usize| ((i as f64 + (GOLDEN * i as f64).fract()) * stretch) as usize;
    (0..taken).map(|i| points[at(i).min(n - 1)]).collect()
}
