//! The nearest point of a quadric, certainly: one root of one monotone function.
//!
//! In the frame of its normal form the quadric is `Σ s_i x_i² = c` or `= z`. With Lagrange's multiplier
//! `x_i = y_i/(1 + t s_i)` (and `z = y_z + t/2` for a paraboloid), and of all stationary points the nearest is the one
//! whose `1 + t s_i` are all at least 0 (Moré 1993, one quadratic constraint). There the left side falls with `t`, so
//! that the root is one. Where it lies at an end of the range, `1 + t s_i = 0`, the coordinate `y_i` is 0 and takes up
//! what is missing: of two such points, either.

use super::Closest;
use crate::Point;
use crate::shape::{NormalForm, Quadric, QuadricType};

/// The nearest point of a quadric. The distance has the sign of [`Quadric::value`] at the point. `None` for the types
/// that have no real point, and for a point that is not finite or beyond 1e100 m.
///
/// ```
/// use supersurface::{Point, measure::nearest_on_quadric, shape::Quadric};
/// // the cone x² + y² = z²
/// let cone = Quadric::new([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])?;
/// let found = nearest_on_quadric(&cone, &Point::new(2.0, 0.0, 0.0)).unwrap();
/// assert!((found.distance - 2f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn nearest_on_quadric(quadric: &Quadric, p: &Point) -> Option<Closest> {
    let form = quadric.normal_form();
    let point = form.pose * nearest(&form, &form.pose.inverse_transform_point(p))?;
    let distance = (point - p).norm();
    distance.is_finite().then(|| Closest { point, distance: distance.copysign(quadric.value(p)) })
}

/// The nearest point in the frame of the normal form.
fn nearest(form: &NormalForm, y: &Point) -> Option<Point> {
    let parabolic = match form.kind {
        QuadricType::ImaginaryEllipsoid
        | QuadricType::ImaginaryEllipticCylinder
        | QuadricType::ImaginaryParallelPlanes => return None,
        QuadricType::EllipticParaboloid
        | QuadricType::HyperbolicParaboloid
        | QuadricType::ParabolicCylinder => true,
        _ => false,
    };
    let constant = match form.kind {
        _ if parabolic => 0.0,
        QuadricType::Point
        | QuadricType::EllipticCone
        | QuadricType::Line
        | QuadricType::IntersectingPlanes
        | QuadricType::CoincidentPlanes => 0.0,
        _ => 1.0,
    };
    if !y.iter().all(|v| v.abs() < 1e100) {
        return None;
    }
    let equation = Equation { squares: form.squares, y: *y, constant, parabolic };
    Some(equation.point(equation.root(equation.range())))
}

struct Equation {
    squares: [f64; 3],
    y: Point,
    constant: f64,
    parabolic: bool,
}

impl Equation {
    /// Where all `1 + t s_i >= 0`.
    fn range(&self) -> [f64; 2] {
        let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
        for s in self.squares {
            if s > 0.0 {
                low = low.max(-1.0 / s);
            } else if s < 0.0 {
                high = high.min(-1.0 / s);
            }
        }
        [low, high]
    }

    /// `Σ s_i x_i² - c`, or `- z`, at a multiplier: falls with it. Coordinates that vanish stay 0.
    fn value(&self, t: f64) -> f64 {
        let mut sum = -self.constant;
        for (s, y) in self.squares.iter().zip(self.y.iter()) {
            if *s != 0.0 && *y != 0.0 {
                let x = y / (1.0 + t * s);
                sum += s * x * x;
            }
        }
        if self.parabolic { sum - (self.y.z + 0.5 * t) } else { sum }
    }

    /// The root inside the range, or the end of it beyond which it would be.
    fn root(&self, [low, high]: [f64; 2]) -> f64 {
        // finite ends: grow from 0, which lies inside
        let scale = self.squares.iter().fold(0.0f64, |m, s| m.max(s.abs()));
        let grown = |side: f64| {
            let mut t = side / scale;
            for _ in 0..2000 {
                let enough = if side < 0.0 { self.value(t) >= 0.0 } else { self.value(t) <= 0.0 };
                if enough || !t.is_finite() {
                    break;
                }
                t *= 4.0;
            }
            t
        };
        let mut below = if low.is_finite() { low } else { grown(-1.0) };
        let mut above = if high.is_finite() { high } else { grown(1.0) };
        for _ in 0..2200 {
            let middle = below + 0.5 * (above - below);
            if !(middle > below && middle < above) {
                break;
            }
            if self.value(middle) > 0.0 {
                below = middle;
            } else {
                above = middle;
            }
        }
        // no change of sign inside: the end that was approached
        0.5 * (below + above)
    }

    /// The point of a multiplier. Coordinates whose factor nearly vanishes are a quotient of rounding: they share what
    /// the equation leaves to them in the ratio of those quotients.
    fn point(&self, t: f64) -> Point {
        let mut x = self.y;
        let factors = self.squares.map(|s| 1.0 + t * s);
        let free = [0, 1, 2].map(|k: usize| self.squares[k] != 0.0 && factors[k].abs() < 1e-4);
        let quotients = [0, 1, 2].map(|k: usize| self.y[k] / factors[k].abs().max(1e-16));
        let (mut held, mut toward, mut square) = (0.0, 0.0f64, 0.0);
        for k in 0..3 {
            if free[k] {
                toward = toward.hypot(quotients[k]);
                square = self.squares[k];
            } else if self.squares[k] != 0.0 {
                x[k] = self.y[k] / factors[k];
                held += self.squares[k] * x[k] * x[k];
            }
        }
        if self.parabolic {
            x.z = self.y.z + 0.5 * t;
        }
        let right = if self.parabolic { x.z } else { self.constant };
        let radius = ((right - held) / square).max(0.0).sqrt();
        let mut first = true;
        for k in (0..3).filter(|k| free[*k]) {
            let share = if toward > 0.0 { quotients[k] / toward } else { f64::from(first) };
            x[k] = radius * share;
            first = false;
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use crate::numeric::random::Stream;

    /// The point is on the quadric, and where lines meet the quadric none is nearer.
    #[test]
    fn no_point_of_any_quadric_is_nearer() {
        let (mut kinds, mut none) = (Vec::new(), 0);
        for case in 0..3000 {
            let mut random = Stream::new(17, case);
            // whole numbers of few values make all of the types
            let coefficients = [0; 10].map(|_| (random.index(5) as f64 - 2.0) * 0.5);
            let flat = coefficients.map(|c| if random.uniform() < 0.4 { 0.0 } else { c });
            let Ok(quadric) = Quadric::new(flat) else { continue };
            let kind = quadric.normal_form().kind;
            let on_grid = |random: &mut Stream| random.index(7) as f64 * 0.5 - 1.5;
            let p = match case % 3 {
                0 => Point::from([0; 3].map(|_| on_grid(&mut random))),
                _ => Point::from([0; 3].map(|_| 2.0 * random.normal())),
            };
            let Some(found) = nearest_on_quadric(&quadric, &p) else {
                none += 1;
                continue;
            };
            kinds.push(kind);
            let distance = found.distance.abs();
            let size = 1.0 + p.coords.norm() + distance;
            let off = quadric.value(&found.point).abs();
            assert!(off < 1e-9 * size * size, "{case} {kind:?}: {flat:?} {p} {found:?} {off}");
            for _ in 0..300 {
                let from = p + Vector::from_fn(|_, _| random.normal()) * distance * 0.7;
                let along = Vector::from_fn(|_, _| random.normal()).normalize();
                let (zero, one) = (quadric.value(&from), quadric.value(&(from + along)));
                let minus = quadric.value(&(from - along));
                let (a, b) = (0.5 * (one + minus) - zero, 0.5 * (one - minus));
                let root = b * b - 4.0 * a * zero;
                if root < 0.0 || a.abs() < 1e-6 {
                    continue;
                }
                for t in [(-b + root.sqrt()) / (2.0 * a), (-b - root.sqrt()) / (2.0 * a)] {
                    let other = (from + along * t - p).norm();
                    assert!(
                        other > distance - 1e-6 * size,
                        "{case} {kind:?}: {flat:?} {p} {other} {found:?}"
                    );
                }
            }
        }
        kinds.sort_by_key(|k| k.name());
        kinds.dedup();
        assert!(kinds.len() >= 13 && none > 0, "{kinds:?} {none}");
    }

    #[test]
    fn symmetric_points_and_wild_ones() {
        let tube = Quadric::new([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).unwrap();
        for p in [Point::origin(), Point::new(0.0, 0.0, 3.0)] {
            let found = nearest_on_quadric(&tube, &p).unwrap();
            assert!(tube.value(&found.point).abs() < 1e-12, "{found:?}");
            assert!(found.distance < 0.0);
        }
        for hard in [f64::NAN, f64::INFINITY, 1e200] {
            assert!(nearest_on_quadric(&tube, &Point::new(hard, 0.0, 0.0)).is_none());
        }
        let far = nearest_on_quadric(&tube, &Point::new(1e90, 1.0, -1e90)).unwrap();
        assert!(far.distance.is_finite());
        let nothing = Quadric::new([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).unwrap();
        assert!(nearest_on_quadric(&nothing, &Point::origin()).is_none());
    }
}
