//! Minimum of a function of two numbers without derivatives (Nelder and Mead 1965, with restarts).
//!
//! The triangle stretches along valleys that run askew, such as those on both sides of an edge, where steps along
//! fixed directions get stuck.

/// A place with its value.
type Corner = (f64, [f64; 2]);

const ROUNDS: usize = 250;
const RESTARTS: usize = 4;

/// The lowest place found from `start` by triangles of `size` and then smaller ones, down to about `least`.
pub(super) fn lowest(
    f: impl Fn([f64; 2]) -> f64,
    start: [f64; 2],
    size: f64,
    least: f64,
) -> Corner {
    let corner = |at: [f64; 2]| {
        let value = f(at);
        (if value.is_nan() { f64::INFINITY } else { value }, at)
    };
    let mut best = corner(start);
    let mut size = size;
    for turn in 0..RESTARTS {
        // turned a little each time, so that no direction is left out
        let (sin, cos) = (1.1 * turn as f64 + 0.2).sin_cos();
        let [x, y] = best.1;
        let corners = [
            best,
            corner([x + size * cos, y + size * sin]),
            corner([x - size * sin, y + size * cos]),
        ];
        let before = best.0;
        best = descend(&corner, corners, least);
        size = if best.0 < before { 0.1 * size } else { 1e-3 * size };
    }
    best
}

fn descend(corner: &impl Fn([f64; 2]) -> Corner, mut corners: [Corner; 3], least: f64) -> Corner {
    for _ in 0..ROUNDS {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [best, good, worst] = corners;
        let width = |a: Corner| (a.1[0] - best.1[0]).abs().max((a.1[1] - best.1[1]).abs());
        if width(good).max(width(worst)) <= least {
            break;
        }
        // on the line from the worst through the middle of the others
        let along = |t: f64| {
            let at = [0, 1].map(|k: usize| {
                let middle = 0.5 * (best.1[k] + good.1[k]);
                middle + t * (middle - worst.1[k])
            });
            corner(at)
        };
        let mirrored = along(1.0);
        let next = if mirrored.0 < best.0 {
            let farther = along(2.0);
            if farther.0 < mirrored.0 { farther } else { mirrored }
        } else if mirrored.0 < good.0 {
            mirrored
        } else {
            along(if mirrored.0 < worst.0 { 0.5 } else { -0.5 })
        };
        if next.0 < worst.0 {
            corners[2] = next;
        } else {
            let halved = |c: Corner| corner([0, 1].map(|k: usize| 0.5 * (c.1[k] + best.1[k])));
            corners = [best, halved(good), halved(worst)];
        }
    }
    corners.into_iter().fold(corners[0], |a, b| if b.0 < a.0 { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valleys_with_and_without_slopes() {
        let bowl = |[x, y]: [f64; 2]| (x - 0.3) * (x - 0.3) + 50.0 * (y + x) * (y + x);
        let found = lowest(bowl, [2.0, 2.0], 0.5, 1e-10);
        assert!(found.0 < 1e-15, "{found:?}");
        // an edge askew
        let edge = |[x, y]: [f64; 2]| (x - 0.3) * (x - 0.3) + (y + 0.7 * x).abs();
        let found = lowest(edge, [2.0, 2.0], 0.5, 1e-10);
        assert!(found.0 < 1e-12, "{found:?}");
    }
}
