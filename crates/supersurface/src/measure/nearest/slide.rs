//! Newton's method on a level surface: towards the point where the line to `p` stands on it.
//!
//! At a surface point `x` with unit normal `n`, tangents `B` and slope `|∇g|` the squared distance to `p` has the
//! tangential slope `-Bᵀ(p - x)` and the second derivatives `I + μ BᵀHB`, `μ = (p - x)·n/|∇g|` (those of the
//! Lagrangian). A step leads along the tangents and then back to the surface along the gradient.

use nalgebra::{Matrix2, Matrix3, Vector2};

use super::simplex::lowest;
use crate::measure::implicit_curvature::tangents;
use crate::shape::Implicit;
use crate::{Direction, Point, Vector};

/// [`SecondOrder::hessian`](crate::shape::SecondOrder::hessian) of a shape that has it.
pub(super) type Hessian<S> = fn(&S, &Point) -> Option<Matrix3<f64>>;

/// A gauge with the second derivatives that are known of it.
#[derive(Debug)]
pub(super) struct Surface<'a, S> {
    pub(super) shape: &'a S,
    pub(super) hessian: Option<Hessian<S>>,
}

/// A point of the surface and what it promises.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) point: Point,
    pub(super) squared: f64,
    /// The line to it stands on the surface, and no direction leads nearer.
    pub(super) settled: bool,
}

const STEPS: usize = 80;
/// A surface point has a gauge this near to 1.
const ON_SURFACE: f64 = 1e-9;

impl<S: Implicit> Surface<'_, S> {
    /// From a point near the surface to a point of the surface that is locally nearest to `p`.
    pub(super) fn slide(&self, start: &Point, p: &Point) -> Option<Foot> {
        let mut now = self.land(start, p)?;
        let mut longest = f64::INFINITY;
        for _ in 0..STEPS {
            let Some((normal, slope)) = self.normal(&now.point) else { break };
            let away = p - now.point;
            let basis = tangents(&normal);
            let drift = Vector2::new(basis[0].dot(&away), basis[1].dot(&away));
            let lever = away.dot(&normal) / slope;
            let bend = self.bend(&now.point, &basis, slope);
            let (mut step, downhill) = newton(&drift, &(Matrix2::identity() + bend * lever));
            if drift.norm() <= 1e-11 * away.norm() {
                match downhill {
                    None => {
                        now.settled = true;
                        break;
                    }
                    // a saddle or the farthest point: off along the direction that bends away
                    Some(direction) => step += direction * (0.1 * away.norm()),
                }
            }
            if step.norm() > longest {
                step *= longest / step.norm();
            }
            let moved = now.point + basis[0] * step.x + basis[1] * step.y;
            match self.land(&moved, p).filter(|next| next.squared < now.squared) {
                Some(next) => {
                    let gain = (now.squared - next.squared) / now.squared;
                    now = next;
                    longest *= 2.0;
                    // rounding is all that is left to gain
                    if gain < 1e-16 && drift.norm() <= 1e-7 * away.norm() {
                        now.settled = true;
                        break;
                    }
                }
                None if step.norm() <= 1e-9 * away.norm() => {
                    now.settled = drift.norm() <= 1e-7 * away.norm() && downhill.is_none();
                    break;
                }
                None => longest = 0.25 * step.norm(),
            }
        }
        Some(now)
    }

    /// A point nearer than `start`, which may lie on an edge: places on the plane that faces `p` there, each taken back
    /// to the surface.
    pub(super) fn narrow(&self, start: &Point, p: &Point) -> Option<Foot> {
        let away = p - start;
        let distance = away.norm();
        let [u, v] = tangents(&Direction::try_new(away, 1e-300)?);
        let place = |at: &Vector2<f64>| start + (u * at.x + v * at.y) * distance;
        let length = |at: [f64; 2]| {
            self.land(&place(&at.into()), p).map_or(f64::INFINITY, |foot| foot.squared)
        };
        let (_, at) = lowest(length, [0.0; 2], 0.03, 1e-12);
        self.land(&place(&at.into()), p)
    }

    /// The surface point that is reached along the gradient; `None` where there is none near.
    pub(super) fn land(&self, start: &Point, p: &Point) -> Option<Foot> {
        let mut point = *start;
        let mut excess = self.shape.gauge(&point) - 1.0;
        for _ in 0..25 {
            if excess.abs() <= 2.0 * f64::EPSILON || !excess.is_finite() {
                break;
            }
            let gradient = self.shape.gradient(&point);
            let largest = gradient.amax();
            let unit = gradient / largest;
            let moved = point - unit * (excess / largest / unit.norm_squared());
            let next = self.shape.gauge(&moved) - 1.0;
            if next.is_nan() || next.abs() >= excess.abs() {
                break;
            }
            (point, excess) = (moved, next);
        }
        let squared = (point - p).norm_squared();
        (excess.abs() <= ON_SURFACE && squared.is_finite()).then_some(Foot {
            point,
            squared,
            settled: false,
        })
    }

    fn normal(&self, p: &Point) -> Option<(Direction, f64)> {
        let gradient = self.shape.gradient(p);
        let largest = gradient.amax();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let scaled = gradient / largest;
        let slope = scaled.norm();
        Some((Direction::new_unchecked(scaled / slope), slope * largest))
    }

    /// `BᵀHB`, by differences of the gradient where there is no second derivative; 0 where neither is finite.
    fn bend(&self, p: &Point, [u, v]: &[Vector; 2], slope: f64) -> Matrix2<f64> {
        let columns = match self.hessian.and_then(|hessian| hessian(self.shape, p)) {
            Some(hessian) => [hessian * u, hessian * v],
            None => [u, v].map(|direction| {
                let h = 1e-6 / slope;
                let at = |side: f64| self.shape.gradient(&(p + direction * (side * h)));
                (at(1.0) - at(-1.0)) / (2.0 * h)
            }),
        };
        let [hu, hv] = columns;
        let mixed = 0.5 * (u.dot(&hv) + v.dot(&hu));
        let bend = Matrix2::new(u.dot(&hu), mixed, mixed, v.dot(&hv));
        if bend.iter().all(|b| b.is_finite()) { bend } else { Matrix2::zeros() }
    }
}

/// The step `|M|⁻¹ d` with the magnitudes of the eigenvalues, which always leads down, and the direction of a
/// negative eigenvalue.
fn newton(drift: &Vector2<f64>, m: &Matrix2<f64>) -> (Vector2<f64>, Option<Vector2<f64>>) {
    let (a, b, c) = (m[(0, 0)], m[(0, 1)], m[(1, 1)]);
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let radius = half.hypot(b);
    let (sine, cosine) = (0.5 * b.atan2(half)).sin_cos();
    let (first, second) = (Vector2::new(cosine, sine), Vector2::new(-sine, cosine));
    let (larger, smaller) = (mean + radius, mean - radius);
    let floor = 1e-6 * (mean.abs() + radius).max(1e-300);
    let part = |v: Vector2<f64>, value: f64| v * (v.dot(drift) / value.abs().max(floor));
    let step = part(first, larger) + part(second, smaller);
    (step, (smaller < -1e-6 * (1.0 + larger.abs())).then_some(second))
}
