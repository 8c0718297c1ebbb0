//! The last resort for bodies that are apart, or that no cell of directions shows to overlap: the algorithm of Gilbert,
//! Johnson and Keerthi (1988).
//!
//! The direction of the origin from the Minkowski difference is that of its nearest point on a simplex of support
//! points, which a new support point improves until none is nearer. It needs no derivatives, so that nothing can
//! stall it, but some ten times as many support points; Newton's method then takes its last digits.

use super::descent::{Minimum, descend};
use super::difference::{Difference, Triple, cross, difference, dot, scaled, sum};

const STEPS: usize = 500;
/// Width of the bounds, in the pair's size, at which Newton's method takes over.
const NEAR: f64 = 1e-11;

/// The minimum of `φ` of bodies that are apart; else one below the best direction that was met.
pub(super) fn gilbert(pair: &Difference, start: &[Triple; 2]) -> Minimum {
    let mut simplex: Vec<Triple> = Vec::with_capacity(4);
    let mut normal = *start;
    let mut best = (f64::INFINITY, normal);
    for _ in 0..STEPS {
        let at = pair.expand::<false>(&normal, &[[[0.0; 3]; 2]; 2]);
        if at.value < best.0 {
            best = (at.value, normal);
        }
        simplex.push(at.gap);
        if let [a, b, c, d] = simplex[..]
            && holds_origin(&[a, b, c, d])
        {
            break;
        }
        let (nearest, kept) = nearest(&simplex);
        let distance = dot(&nearest, &nearest).sqrt();
        if distance + best.0 < NEAR || simplex[..simplex.len() - 1].contains(&at.gap) {
            break;
        }
        simplex = kept;
        let n = scaled(&nearest, -1.0 / distance);
        normal = [n, pair.to_b(&n)];
    }
    descend(pair, &best.1, f64::INFINITY)
}

/// True where the origin is inside a tetrahedron: the bodies overlap.
fn holds_origin(corners: &[Triple; 4]) -> bool {
    let [a, b, c, d] = corners;
    let volume = |p: &Triple, q: &Triple, r: &Triple| dot(p, &cross(q, r));
    // those that the origin makes with the faces, each seen from the opposite corner
    let parts = [volume(b, d, c), volume(a, c, d), volume(a, d, b), volume(a, b, c)];
    parts.iter().all(|v| *v > 0.0) || parts.iter().all(|v| *v < 0.0)
}

/// The point of a simplex of up to four that is nearest to the origin, and the vertices that it lies between.
fn nearest(simplex: &[Triple]) -> (Triple, Vec<Triple>) {
    match *simplex {
        [a] => (a, vec![a]),
        [a, b] => on_edge(a, b),
        [a, b, c] => on_triangle(a, b, c),
        [a, b, c, d] => {
            let faces = [[a, b, d], [b, c, d], [c, a, d], [a, b, c]];
            let feet = faces.map(|[p, q, r]| on_triangle(p, q, r));
            let nearer = |x: &(Triple, Vec<Triple>), y: &(Triple, Vec<Triple>)| {
                dot(&x.0, &x.0).total_cmp(&dot(&y.0, &y.0))
            };
            feet.into_iter().min_by(nearer).unwrap_or((a, vec![a]))
        }
        _ => ([0.0; 3], Vec::new()),
    }
}

fn on_edge(a: Triple, b: Triple) -> (Triple, Vec<Triple>) {
    let along = difference(&b, &a);
    let t = -dot(&a, &along) / dot(&along, &along);
    if t > 0.0 && t < 1.0 {
        (sum(&a, &scaled(&along, t)), vec![a, b])
    } else if t >= 1.0 {
        (b, vec![b])
    } else {
        (a, vec![a])
    }
}

fn on_triangle(a: Triple, b: Triple, c: Triple) -> (Triple, Vec<Triple>) {
    let normal = cross(&difference(&b, &a), &difference(&c, &a));
    let square = dot(&normal, &normal);
    // the shares of the foot: signed areas of the triangles that it makes with the edges
    let area = |p: &Triple, q: &Triple| dot(&normal, &cross(p, q));
    if square > 0.0 && area(&a, &b) > 0.0 && area(&b, &c) > 0.0 && area(&c, &a) > 0.0 {
        return (scaled(&normal, dot(&normal, &a) / square), vec![a, b, c]);
    }
    let edges = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    let [first, second, third] = edges;
    let square = |x: &(Triple, Vec<Triple>)| dot(&x.0, &x.0);
    let nearer = if square(&second) < square(&first) { second } else { first };
    if square(&third) < square(&nearer) { third } else { nearer }
}
