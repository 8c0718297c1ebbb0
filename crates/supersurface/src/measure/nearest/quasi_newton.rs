//! Minimum of a function of two numbers with slopes almost everywhere: Broyden, Fletcher, Goldfarb and Shanno's method
//! with a line search that asks little (Lewis and Overton 2013), which also runs down along the bottom of an edge.

use nalgebra::{Matrix2, Vector2};

/// Value and gradient; an infinite value where there is none.
pub(super) type Sample = (f64, Vector2<f64>);

const ROUNDS: usize = 120;
const TRIALS: usize = 40;

/// The lowest value found and its place, from a start where the function has a value. It should not lie on an edge
/// itself: there the slope of one side says nothing.
pub(super) fn lowest(
    f: impl Fn(&Vector2<f64>) -> Sample,
    start: Vector2<f64>,
) -> (f64, Vector2<f64>) {
    let mut x = start;
    let (mut value, mut slope) = f(&x);
    let mut inverse = Matrix2::identity();
    let mut fresh = true;
    for _ in 0..ROUNDS {
        let direction = -(inverse * slope);
        let fall = direction.dot(&slope);
        let found = if fall < 0.0 { search(&f, &x, value, &direction, fall) } else { None };
        let Some((step, (lower, steep))) = found else {
            // on an edge: along it, if it falls there
            let Some((moved, sample)) = along_edge(&f, &x, value) else { break };
            x += moved;
            (value, slope) = sample;
            (inverse, fresh) = (Matrix2::identity() * step_size(value, &slope), true);
            continue;
        };
        let (moved, turned) = (direction * step, steep - slope);
        let curved = moved.dot(&turned);
        if curved > 0.0 {
            if fresh {
                inverse = Matrix2::identity() * (curved / turned.norm_squared());
            }
            let half = Matrix2::identity() - moved * turned.transpose() / curved;
            inverse = half * inverse * half.transpose() + moved * moved.transpose() / curved;
            fresh = false;
        }
        x += moved;
        (value, slope) = (lower, steep);
        if moved.norm() < 1e-14 {
            break;
        }
    }
    (value, x)
}

/// A step down from a place around which the slopes differ: against the shortest mean of the slopes in a circle
/// (gradient sampling: Burke, Lewis and Overton 2005), for ever smaller circles.
fn along_edge(
    f: &impl Fn(&Vector2<f64>) -> Sample,
    x: &Vector2<f64>,
    value: f64,
) -> Option<(Vector2<f64>, Sample)> {
    (2..10).find_map(|digits| {
        let radius = 10f64.powi(-digits);
        let slopes: Vec<Vector2<f64>> = (0..8)
            .map(|k| {
                let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(k) + 0.3).sin_cos();
                f(&(x + Vector2::new(cos, sin) * radius))
            })
            .filter_map(|(value, slope)| value.is_finite().then_some(slope))
            .collect();
        let shortest = shortest_mean(&slopes)?;
        let direction = -shortest * (radius / shortest.norm());
        let (step, sample) = search(f, x, value, &direction, direction.dot(&shortest))?;
        Some((direction * step, sample))
    })
}

/// The shortest weighted mean of vectors; `None` when it is 0.
fn shortest_mean(slopes: &[Vector2<f64>]) -> Option<Vector2<f64>> {
    let pairs = slopes.iter().flat_map(|a| slopes.iter().map(move |b| (a, b)));
    let between = pairs.map(|(a, b)| {
        let along = b - a;
        let share = -a.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
        a + along * share.clamp(0.0, 1.0)
    });
    let shortest = between.min_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    // every slope lies beyond it, unless they surround 0
    let square = shortest.norm_squared();
    let beyond = slopes.iter().all(|s| s.dot(&shortest) >= square * (1.0 - 1e-9));
    (square > 0.0 && beyond).then_some(shortest)
}

/// A first step of about a thousandth.
fn step_size(value: f64, slope: &Vector2<f64>) -> f64 {
    let size = slope.norm();
    if size > 0.0 { 1e-3 / size } else { 1.0 / value.max(f64::MIN_POSITIVE) }
}

/// A step that lowers the value, after which it falls less steeply.
fn search(
    f: &impl Fn(&Vector2<f64>) -> Sample,
    x: &Vector2<f64>,
    value: f64,
    direction: &Vector2<f64>,
    fall: f64,
) -> Option<(f64, Sample)> {
    let (mut low, mut high, mut step) = (0.0, f64::INFINITY, 1.0);
    let mut best: Option<(f64, Sample)> = None;
    for _ in 0..TRIALS {
        let found = f(&(x + direction * step));
        if found.0.is_finite() && found.0 < value + 1e-4 * step * fall {
            best = Some((step, found));
            if found.1.dot(direction) >= 0.5 * fall {
                break;
            }
            low = step;
        } else {
            high = step;
        }
        step = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * low };
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bowls_and_edges() {
        let bowl = |x: &Vector2<f64>| {
            let [a, b] = [x.x - 0.3, 7.0 * (x.y + x.x)];
            (a * a + b * b, Vector2::new(2.0 * a + 14.0 * b, 14.0 * b))
        };
        assert!((lowest(bowl, Vector2::zeros()).1 - Vector2::new(0.3, -0.3)).norm() < 1e-7);
        // |y + x²| + (x - 0.3)²: a bent edge
        let edge = |x: &Vector2<f64>| {
            let (a, b) = (x.x - 0.3, x.y + x.x * x.x);
            let s = if b < 0.0 { -1.0 } else { 1.0 };
            (b.abs() + a * a, Vector2::new(2.0 * a + 2.0 * x.x * s, s))
        };
        let (_, found) = lowest(edge, Vector2::new(0.02, 0.01));
        assert!((found - Vector2::new(0.3, -0.09)).norm() < 1e-4, "{found}");
    }
}
