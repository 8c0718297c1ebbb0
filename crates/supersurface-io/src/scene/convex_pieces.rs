//! Convex pieces of parts that are not convex: simulators take the hull of a mesh, and that would close the hole of a
//! ring and fill the bow of a banana.
//!
//! A supertoroid is cut by planes through its axis, at the corners of a polygon on its ring. Between two of them lies
//! `{α u + β v + z e : α, β >= 0, (α + β, z) in the profile}` for the directions u and v of the two corners: convex
//! where the profile is, since it is the profile's image back under a linear map. A bent or twisted part is cut across
//! its axis into slices that turn little; their hulls are meant.

use std::f64::consts::{FRAC_PI_2, TAU};

use supersurface::Point;
use supersurface::deform::Deformation;
use supersurface::mesh::Mesh;
use supersurface::numeric::powers::power;
use supersurface::numeric::superellipse::norm;
use supersurface::shape::Supertoroid;
use supersurface::surface::Surface;

/// Distances of chords from their arcs, as a share of the size.
const CHORD: f64 = 0.005;
/// Most spans of a quarter of a superellipse.
const MOST_SPANS: usize = 12;
/// Most slices of a bent or twisted part.
const MOST_SLICES: usize = 48;
/// Radians that a slice bends: its hull fills 0.3 % of the inner radius.
const BEND: f64 = 0.15;
/// Radians that a slice twists: its hull adds half as much of the section's reach to its flat sides.
const TWIST: f64 = 0.04;

/// The pieces, in the part's own frame, closed and facing outwards; none where the hull of the whole is as good.
pub(super) fn convex_pieces(surface: &Surface) -> Vec<Mesh> {
    match surface {
        Surface::Supertoroid(ring) => sectors(ring),
        _ => slices(surface),
    }
}

/// Between 16 and 48 sectors of a ring.
fn sectors(ring: &Supertoroid) -> Vec<Mesh> {
    let [a1, a2, a3] = ring.semi_axes();
    let [e1, e2] = ring.exponents();
    let a4 = ring.ring_ratio();
    let mean = 0.5 * (a1 + a2);
    let profile: Vec<[f64; 2]> =
        hull_of_profile([mean, a3], e1).into_iter().map(|[x, z]| [a4 + x / mean, z]).collect();
    let corners = superellipse([a1, a2], e2);
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).filter_map(|(u, v)| sector(&profile, [*u, *v])).collect()
}

/// What lies between the profile along one direction and along the next.
fn sector(profile: &[[f64; 2]], directions: [[f64; 2]; 2]) -> Option<Mesh> {
    let mut vertices = Vec::new();
    let mut loops = [Vec::new(), Vec::new()];
    for (side, [x, y]) in directions.into_iter().enumerate() {
        for (k, [rho, z]) in profile.iter().enumerate() {
            // where the ring has no hole both sides meet on the axis
            let twin = loops[0].get(k).copied().filter(|_| side == 1 && *rho <= 1e-12);
            loops[side].push(twin.unwrap_or(vertices.len() as u32));
            if twin.is_none() {
                vertices.push(Point::new(rho * x, rho * y, *z));
            }
        }
    }
    stacked(vertices, &loops)
}

/// Slices across the axis of a part that turns along it.
fn slices(surface: &Surface) -> Vec<Mesh> {
    let [a1, a2, a3] = surface.semi_axes();
    let [e1, e2] = surface.exponents();
    let bow = surface.bend().map_or(0.0, |b| b.curvature().abs() * 2.0 * a3);
    let turn = surface.twist().map_or(0.0, |t| t.turns().abs() * TAU);
    let count = ((bow / BEND + turn / TWIST).ceil() as usize).min(MOST_SLICES);
    if count < 2 {
        return Vec::new();
    }
    let cuts = (0..=count).map(|i| (2.0 * i as f64 / count as f64 - 1.0) * a3);
    let mut heights: Vec<f64> =
        superellipse([0.5 * (a1 + a2), a3], e1).into_iter().map(|[_, z]| z).collect();
    heights.extend(cuts.clone());
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * a3);
    let section = superellipse([a1, a2], e2);
    let row = |z: f64| -> Vec<Point> {
        let share = (1.0 - power((z / a3).abs(), 2.0 / e1)).max(0.0);
        let radius = power(share, 0.5 * e1);
        let place = |[x, y]: &[f64; 2]| deformed(surface, Point::new(radius * x, radius * y, z));
        match radius < 1e-9 {
            true => vec![deformed(surface, Point::new(0.0, 0.0, z))],
            false => section.iter().map(place).collect(),
        }
    };
    let ends: Vec<f64> = cuts.collect();
    let slice = |pair: &[f64]| {
        let [low, high] = [pair.first()?, pair.last()?];
        let slack = 2e-6 * a3;
        let inside = heights.iter().filter(|z| **z >= low - slack && **z <= high + slack);
        let mut vertices = Vec::new();
        let mut loops: Vec<Vec<u32>> = Vec::new();
        for z in inside {
            let points = row(*z);
            let first = vertices.len() as u32;
            loops.push(match points.len() {
                1 => vec![first; section.len()],
                n => (first..first + n as u32).collect(),
            });
            vertices.extend(points);
        }
        stacked(vertices, &loops)
    };
    ends.windows(2).filter_map(slice).collect()
}

/// Where the deformations put a point, in their order.
fn deformed(surface: &Surface, p: Point) -> Point {
    let p = surface.taper().map_or(p, |t| t.forward(&p));
    let p = surface.twist().map_or(p, |t| t.forward(&p));
    surface.bend().map_or(p, |b| b.forward(&p))
}

/// Loops of as many vertices each, one on the other, with a fan over the first and the last.
fn stacked(vertices: Vec<Point>, loops: &[Vec<u32>]) -> Option<Mesh> {
    let mut triangles = Vec::new();
    for (low, high) in loops.iter().zip(loops.iter().skip(1)) {
        let below = low.iter().zip(low.iter().cycle().skip(1));
        let above = high.iter().zip(high.iter().cycle().skip(1));
        for ((a, b), (d, c)) in below.zip(above) {
            triangles.extend([[*a, *b, *c], [*a, *c, *d]]);
        }
    }
    let fan = |ring: &[u32]| -> Vec<[u32; 3]> {
        let Some((hub, rest)) = ring.split_first() else { return Vec::new() };
        rest.iter().zip(rest.iter().skip(1)).map(|(b, c)| [*hub, *b, *c]).collect()
    };
    triangles.extend(fan(loops.last()?));
    triangles.extend(fan(loops.first()?).into_iter().map(|[a, b, c]| [a, c, b]));
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let mesh = Mesh::new(vertices, triangles).ok()?;
    Some(if mesh.volume() < 0.0 { mesh.flipped() } else { mesh })
}

/// The convex hull of a profile: its four ends where it is hollow between them.
fn hull_of_profile(axes: [f64; 2], exponent: f64) -> Vec<[f64; 2]> {
    match exponent < 2.0 {
        true => superellipse(axes, exponent),
        false => vec![[axes[0], 0.0], [0.0, axes[1]], [-axes[0], 0.0], [0.0, -axes[1]]],
    }
}

/// Points on `|x/a|^(2/ε) + |y/b|^(2/ε) = 1`, counter-clockwise from (a, 0), the same in every quarter: 4 spans in each,
/// and more where chords are far from their arcs.
fn superellipse([a, b]: [f64; 2], exponent: f64) -> Vec<[f64; 2]> {
    let at = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let reach = norm(c.abs(), s.abs(), 2.0 / exponent);
        [a * c / reach, b * s / reach]
    };
    let sagitta = |from: f64, to: f64| {
        let [p, q, m] = [from, to, 0.5 * (from + to)].map(at);
        let [dx, dy] = [q[0] - p[0], q[1] - p[1]];
        ((m[0] - p[0]) * dy - (m[1] - p[1]) * dx).abs() / dx.hypot(dy)
    };
    let mut angles: Vec<f64> = (0..=4).map(|i| FRAC_PI_2 * f64::from(i) / 4.0).collect();
    while angles.len() <= MOST_SPANS {
        let spans = angles.windows(2).map(|w| (w[0], w[1]));
        let farther =
            |x: &(f64, f64), y: &(f64, f64)| sagitta(x.0, x.1).total_cmp(&sagitta(y.0, y.1));
        let Some((from, to)) = spans.max_by(farther) else { break };
        if sagitta(from, to) <= CHORD * a.max(b) {
            break;
        }
        angles.push(0.5 * (from + to));
        angles.sort_by(f64::total_cmp);
    }
    let last = angles.len() - 1;
    let mut quarter: Vec<[f64; 2]> = angles.into_iter().map(at).collect();
    quarter[0] = [a, 0.0];
    quarter[last] = [0.0, b];
    let mut all = quarter[..last].to_vec();
    all.extend(quarter[1..].iter().rev().map(|[x, y]| [-x, *y]));
    all.extend(quarter[..last].iter().map(|[x, y]| [-x, -y]));
    all.extend(quarter[1..].iter().rev().map(|[x, y]| [*x, -y]));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use supersurface::shape::{Implicit, Superellipsoid};

    /// The largest distance of a vertex from the inner side of a face.
    fn bulge(mesh: &Mesh) -> f64 {
        let mut most = 0.0f64;
        for [a, b, c] in mesh.corners() {
            let Some(n) = (b - a).cross(&(c - a)).try_normalize(1e-14) else { continue };
            most = mesh.vertices().iter().map(|v| (v - a).dot(&n)).fold(most, f64::max);
        }
        most
    }

    #[test]
    fn sectors_cover_a_ring_and_keep_its_hole() {
        for (a, a4, e) in [
            ([0.0125, 0.0125, 0.016], 3.0, [0.8, 1.0]),
            ([0.01, 0.02, 0.01], 2.0, [0.1, 0.1]),
            ([0.01, 0.01, 0.01], 1.0, [1.0, 1.0]),
            ([0.01, 0.01, 0.02], 4.0, [2.5, 1.7]),
        ] {
            let ring = Supertoroid::new(a, a4, e).unwrap();
            let pieces = convex_pieces(&Surface::Supertoroid(ring));
            assert!((16..=48).contains(&pieces.len()), "{}", pieces.len());
            let mut volume = 0.0;
            for piece in &pieces {
                assert!(piece.is_watertight() && piece.volume() > 0.0, "{ring:?}");
                assert!(bulge(piece) < 1e-9, "{ring:?}: {}", bulge(piece));
                volume += piece.volume();
            }
            // a hollow profile is filled up to its hull
            if e[0] <= 2.0 {
                let share = volume / ring.volume();
                assert!((0.95..1.001).contains(&share), "{ring:?}: {share}");
            }
            // a ring has its hole where |x/a1|^(2/ε2) + |y/a2|^(2/ε2) is small
            let reach = |p: &Point| norm((p.x / a[0]).abs(), (p.y / a[1]).abs(), 2.0 / e[1]);
            let nearest = pieces.iter().flat_map(|m| m.corners()).map(|[p, q, r]| {
                let middle = nalgebra::center(&p, &q);
                reach(&p).min(reach(&middle)).min(reach(&nalgebra::center(&middle, &r)))
            });
            let least = nearest.fold(f64::INFINITY, f64::min);
            assert!(least >= 0.93 * (a4 - 1.0), "{ring:?}: {least}");
        }
    }

    #[test]
    fn slices_follow_what_turns() {
        let stick = Superellipsoid::new([0.01, 0.012, 0.06], [0.7, 1.0]).unwrap();
        for surface in [
            Surface::bent(stick, 15.0, 0.4).unwrap(),
            Surface::twisted(Superellipsoid::new([0.01, 0.03, 0.05], [0.2, 0.2]).unwrap(), 0.3)
                .unwrap(),
            Surface::tapered_bent(stick, [0.4, 0.4], 10.0, 0.0).unwrap(),
        ] {
            let pieces = convex_pieces(&surface);
            assert!(pieces.len() >= 3, "{}", pieces.len());
            let mut volume = 0.0;
            for piece in &pieces {
                assert!(piece.is_watertight() && piece.volume() > 0.0, "{surface:?}");
                assert!(piece.vertices().iter().all(|v| surface.gauge(v) < 1.0 + 1e-6));
                assert!(bulge(piece) < 4e-3, "{}", bulge(piece));
                volume += piece.volume();
            }
            let share = volume / surface.volume();
            assert!((0.95..1.01).contains(&share), "{surface:?}: {share}");
        }
        let straight = Surface::Superellipsoid(stick);
        assert!(convex_pieces(&straight).is_empty());
    }
}
