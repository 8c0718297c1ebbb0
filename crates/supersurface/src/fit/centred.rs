//! Points about their mean, along their principal axes and in units of their root mean square distance from it: what
//! every fit works on, so that neither place nor turn nor unit matters. Points that determine no surface are told apart
//! here.

use nalgebra::{Isometry3, Matrix3, Rotation3, SymmetricEigen, UnitQuaternion};

use super::FitError;
use crate::{Point, Vector};

/// Where normalised coordinates lie in the frame of a cloud: `x = centre + scale axes q`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// The mean, in the cloud's frame and metres.
    pub(super) centre: Vector,
    /// The principal axes.
    pub(super) axes: Rotation3<f64>,
    /// The root mean square, in metres.
    pub(super) scale: f64,
}

impl Placement {
    /// Normalised coordinates themselves.
    pub(super) fn identity() -> Self {
        Self { centre: Vector::zeros(), axes: Rotation3::identity(), scale: 1.0 }
    }

    /// A point of the cloud's frame in normalised coordinates.
    pub(super) fn inward(&self, p: &Point) -> Vector {
        self.turned_inward(&((p.coords - self.centre) / self.scale))
    }

    /// A direction of the cloud's frame in normalised coordinates.
    pub(super) fn turned_inward(&self, direction: &Vector) -> Vector {
        self.axes.inverse_transform_vector(direction)
    }

    /// A point of normalised coordinates in the cloud's frame.
    pub(super) fn outward(&self, q: &Vector) -> Point {
        Point::from(self.centre + self.axes * q * self.scale)
    }

    /// The pose in the cloud's frame of something with a place and a turn in normalised coordinates.
    pub(super) fn pose(&self, position: &Vector, rotation: &Rotation3<f64>) -> Isometry3<f64> {
        let turn = UnitQuaternion::from_rotation_matrix(&(self.axes * rotation));
        Isometry3::from_parts(self.outward(position).coords.into(), turn)
    }
}

/// Cells of the grid on which normalised coordinates lie, in a unit of length: no more than single precision tells apart.
const GRID: f64 = (1u32 << 24) as f64;

/// A coordinate on the grid. What a move, a turn or a change of units leaves in the last digits is gone there, so that a
/// search takes the same way.
pub(super) fn on_grid(x: f64) -> f64 {
    // adding 1.5 2^52 rounds to an integer
    const ROUND: f64 = 6_755_399_441_055_744.0;
    (x * GRID + ROUND - ROUND) / GRID
}

/// A cloud with zero mean and unit root mean square, along its principal axes, on a grid.
#[derive(Clone, Debug)]
pub(super) struct Centred {
    pub(super) points: Vec<Vector>,
    pub(super) placement: Placement,
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
        let mut points: Vec<Vector> = points.iter().map(|p| (p - centre) / scale).collect();
        let (axes, values) = principal_axes(&points);
        if values[1] < 1e-10 * values[2] {
            return Err(FitError::Line { points: found });
        }
        points.iter_mut().for_each(|p| *p = axes.inverse_transform_vector(p).map(on_grid));
        Ok(Self { points, placement: Placement { centre, axes, scale } })
    }
}

/// The principal axes of points, the thinnest first, and the mean squares along them. The axes point to where the farther
/// points are, so that they turn with the cloud.
fn principal_axes(points: &[Vector]) -> (Rotation3<f64>, [f64; 3]) {
    let axes = axes_of(&scatter(points.iter()));
    let mean = |k: usize, power: i32| {
        let powers = points.iter().map(|p| p.dot(&axes.column(k)).powi(power));
        powers.sum::<f64>() / points.len() as f64
    };
    let towards = |k: usize| axes.column(k) * 1f64.copysign(mean(k, 3));
    let (x, y) = (towards(0), towards(1));
    let turned = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    (Rotation3::from_matrix_unchecked(turned), [0, 1, 2].map(|k| mean(k, 2)))
}

/// Eigenvectors in rising order of the eigenvalues, right-handed.
pub(super) fn axes_of(m: &Matrix3<f64>) -> Matrix3<f64> {
    let eigen = SymmetricEigen::new(*m);
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let x: Vector = eigen.eigenvectors.column(order[0]).into();
    let y: Vector = eigen.eigenvectors.column(order[1]).into();
    Matrix3::from_columns(&[x, y, x.cross(&y)])
}

/// Covariance of points about their mean.
pub(super) fn scatter<'a>(points: impl Iterator<Item = &'a Vector> + Clone) -> Matrix3<f64> {
    let n = points.clone().count().max(1) as f64;
    let mean: Vector = points.clone().sum::<Vector>() / n;
    points.map(|p| (p - mean) * (p - mean).transpose()).sum::<Matrix3<f64>>() / n
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
    let at = move |i: usize| {
        let turns = GOLDEN * i as f64;
        ((i as f64 + (turns - (turns as usize) as f64)) * stretch) as usize
    };
    (0..taken).map(move |i| at(i).min(n - 1))
}
