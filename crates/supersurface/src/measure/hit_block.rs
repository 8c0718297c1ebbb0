//! Where a block of rays from one point first meets a convex superellipsoid.
//!
//! The method is that of [`first_hit`](super::first_hit): Newton's from the box around the solid, which a convex gauge
//! lets run monotonically to the first hit or to the proof that there is none. Here all rays of a block take their steps
//! together, in vector registers.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use crate::numeric::lanes::{Job, Lane, WIDTH, dispatch, exp, ln};
use crate::numeric::superellipse::norm_of_logs;
use crate::shape::Superellipsoid;

/// Steps after which a ray that neither arrived nor missed is taken to miss.
const STEPS: usize = 60;
/// A gauge this close to 1 is on the surface.
const ON_SURFACE: f64 = 1e-14;

/// A number for each ray of a block.
type Row = [f64; WIDTH];

/// Where the rays of a block meet a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockHits {
    /// Distance along each ray in metres; infinite for one that misses.
    pub(crate) distance: Row,
    /// Outward normal there, in the solid's frame and of any length.
    pub(crate) normal: [Row; 3],
}

/// The first hits of rays from `origin` along unit `directions`, all in the solid's frame and from outside it, nearer than
/// `farthest`. Exponents are at most 2.
pub(crate) fn block_hits(
    solid: &Superellipsoid,
    origin: &[f64; 3],
    directions: &[Row; 3],
    farthest: &Row,
) -> BlockHits {
    let mut hits = BlockHits { distance: [f64::INFINITY; WIDTH], normal: [[0.0; WIDTH]; 3] };
    dispatch(Approach { solid, origin, directions, farthest, hits: &mut hits });
    hits
}

struct Approach<'a> {
    solid: &'a Superellipsoid,
    origin: &'a [f64; 3],
    directions: &'a [Row; 3],
    farthest: &'a Row,
    hits: &'a mut BlockHits,
}

impl Job for Approach<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let axes = self.solid.semi_axes();
        let [e1, e2] = self.solid.exponents();
        let [outer, inner] = [[2.0 / e1; WIDTH], [2.0 / e2; WIDTH]];
        let [outer_inverse, inner_inverse] = [[0.5 * e1; WIDTH], [0.5 * e2; WIDTH]];
        let d = self.directions;
        let (mut near, mut far) = ([0.0; WIDTH], *self.farthest);
        for k in 0..3 {
            for i in 0..WIDTH {
                let inverse = 1.0 / d[k][i];
                let half = axes[k].copysign(inverse);
                // along a face: infinities, or NaN that no comparison takes
                near[i] = near[i].most((-half - self.origin[k]) * inverse);
                far[i] = far[i].least((half - self.origin[k]) * inverse);
            }
        }
        let mut t = near;
        // 0 once a ray has arrived or missed
        let mut live = [0.0; WIDTH];
        let mut distance = [f64::INFINITY; WIDTH];
        for i in 0..WIDTH {
            live[i] = f64::from(u8::from(near[i] <= far[i]));
        }
        let mut normal = [[0.0; WIDTH]; 3];
        for _ in 0..STEPS {
            let mut p = [[0.0; WIDTH]; 3];
            let mut logs = p;
            for k in 0..3 {
                let inverse = 1.0 / axes[k];
                for i in 0..WIDTH {
                    let at = t[i].times_plus::<FUSED>(d[k][i], self.origin[k]);
                    // next to a plane of symmetry, where the share is 0 anyway
                    let size = (at.abs() * inverse).most(f64::TINY);
                    p[k][i] = (size * axes[k]).copysign(at);
                    logs[k][i] = ln::<FUSED>(size);
                }
            }
            let (planar, [s1, s2]) =
                norm_of_logs::<FUSED, f64, WIDTH>(&logs[0], &logs[1], &inner, &inner_inverse);
            let (whole, [s12, s3]) =
                norm_of_logs::<FUSED, f64, WIDTH>(&planar, &logs[2], &outer, &outer_inverse);
            let mut any = 0.0;
            for i in 0..WIDTH {
                let gauge = exp::<FUSED>(whole[i]);
                let rates = [s12[i] * s1[i] / p[0][i], s12[i] * s2[i] / p[1][i], s3[i] / p[2][i]];
                let slope = gauge * (rates[0] * d[0][i] + rates[1] * d[1][i] + rates[2] * d[2][i]);
                let value = gauge - 1.0;
                let next = t[i] - value / slope;
                let arrived = value <= ON_SURFACE || next <= t[i] && slope < 0.0;
                let missed = slope >= 0.0 || next > far[i];
                let now = live[i] > 0.0;
                if now && arrived {
                    distance[i] = t[i];
                    for k in 0..3 {
                        normal[k][i] = rates[k];
                    }
                }
                live[i] = if arrived || missed { 0.0 } else { live[i] };
                t[i] = if live[i] > 0.0 { next } else { t[i] };
                any += live[i];
            }
            if any == 0.0 {
                break;
            }
        }
        *self.hits = BlockHits { distance, normal };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::first_hit;
    use crate::numeric::random::Stream;
    use crate::shape::Ray;
    use crate::{Direction, Point, Vector};

    #[test]
    fn blocks_meet_what_single_rays_meet() {
        let (mut met, mut missed) = (0, 0);
        for k in 0..2000 {
            let mut stream = Stream::new(3, k);
            let mut draw = |low, high| stream.between(low, high);
            let solid = Superellipsoid::new(
                [draw(0.1, 1.0), draw(0.1, 1.0), draw(0.1, 1.0)],
                [draw(0.05, 2.0), draw(0.05, 2.0)],
            );
            let solid = solid.unwrap();
            let origin = [draw(-3.0, 3.0), draw(-3.0, 3.0), draw(1.5, 3.0)];
            let aims: [Direction; WIDTH] = std::array::from_fn(|_| {
                let at = Vector::new(draw(-0.8, 0.8), draw(-0.8, 0.8), draw(-0.8, 0.8));
                Direction::new_normalize(at - Vector::from(origin))
            });
            let directions = [0, 1, 2].map(|k| aims.map(|aim| aim[k]));
            let hits = block_hits(&solid, &origin, &directions, &[f64::INFINITY; WIDTH]);
            for (i, direction) in aims.into_iter().enumerate() {
                let ray = Ray { origin: Point::from(origin), direction };
                let normal = Vector::from(hits.normal.map(|row| row[i]));
                match first_hit(&solid, &ray, f64::INFINITY) {
                    Some(hit) => {
                        met += 1;
                        assert!(
                            (hits.distance[i] - hit.distance).abs() < 1e-7,
                            "{solid:?} {ray:?}"
                        );
                        let gauge =
                            crate::shape::Implicit::gauge(&solid, &ray.at(hits.distance[i]));
                        assert!((gauge - 1.0).abs() < 1e-12);
                        let turned = normal.normalize().dot(&hit.normal);
                        assert!(turned > 1.0 - 1e-3, "{solid:?} {ray:?} {turned}");
                    }
                    None => {
                        missed += 1;
                        assert!(hits.distance[i] == f64::INFINITY, "{solid:?} {ray:?}");
                    }
                }
            }
        }
        assert!(met > 3000 && missed > 3000, "{met} {missed}");
    }
}
