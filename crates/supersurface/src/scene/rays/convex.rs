//! Where a block of rays from one point first meets a convex superellipsoid, plain or tapered.
//!
//! From outside a ray steps to the plane that touches the solid below it: below the point `p` of the ray lies the surface
//! point `T(u/g)`, where `u = T⁻¹(p)` and `g` is the gauge of the solid without its taper `T`. A convex solid lies behind
//! that plane, so that no step leads too far, and a plane that the ray does not reach is the proof of a miss; without a
//! taper this is Newton's method. Planes at earlier hits say the same, and give the rays beside them a start next to the
//! surface.
//!
//! A taper of equal slopes `K` keeps the solid convex while its profile `(1 + K z) (1 - |z|^p)^(1/p)`, `p = 2/ε1`, is
//! concave: for `|K| <= (1 - ε1/2) 2^(ε1/2)`.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::block::{Block, Gauge, Hits, RAYS, Solid, gauge};
use crate::numeric::lanes::Lane;
use crate::surface::Surface;

/// Steps after which a ray that neither arrived nor missed is taken to miss.
const STEPS: usize = 60;
/// A gauge this close to 1 is on the surface.
const ON_SURFACE: f64 = 1e-14;
/// Planes that are kept.
const PLANES: usize = 6;

/// A convex solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Convex {
    axes: [f64; 3],
    exponents: [f64; 2],
    /// By how much a metre of height widens the section.
    taper: f64,
}

/// Planes that touch a solid, at hits of earlier rays.
#[derive(Clone, Copy, Debug, Default)]
struct Planes {
    /// Outward normal, and how far the origin of the rays is behind the plane: a negative number.
    planes: [([f64; 3], f64); PLANES],
    count: usize,
    next: usize,
}

impl Convex {
    /// `None` where it is not certain that the surface bounds a convex solid.
    pub(super) fn new(surface: &Surface) -> Option<Self> {
        let (axes, exponents) = (surface.semi_axes(), surface.exponents());
        let [kx, ky] = match surface {
            Surface::Superellipsoid(_) => [0.0; 2],
            Surface::Tapered(solid) => solid.deformation().slopes(),
            _ => return None,
        };
        let most = (1.0 - 0.5 * exponents[0]) * (0.5 * exponents[0]).exp2();
        let convex = exponents.iter().all(|e| *e <= 2.0) && kx == ky && kx.abs() <= most;
        convex.then_some(Self { axes, exponents, taper: kx / axes[2] })
    }
}

impl Planes {
    /// Those at the first and the last hit.
    #[inline(always)]
    fn keep(&mut self, block: &Block, hits: &Hits) {
        let met = |i: &usize| hits.depth[*i].is_finite();
        let ends = [(0..RAYS).find(met), (0..RAYS).rfind(met)];
        for i in ends.into_iter().flatten() {
            let normal = hits.normal.map(|row| row[i]);
            let along: f64 = (0..3).map(|k| normal[k] * block.directions[k][i]).sum();
            if let Some(place) = self.planes.get_mut(self.next) {
                *place = (normal, along * hits.depth[i]);
                self.next = (self.next + 1) % PLANES;
                self.count = (self.count + 1).min(PLANES);
            }
        }
    }
}

/// A convex solid with planes that touch it.
pub(super) struct Approach<'a> {
    solid: &'a Convex,
    planes: Planes,
}

impl<'a> Approach<'a> {
    pub(super) fn new(solid: &'a Convex) -> Self {
        Self { solid, planes: Planes::default() }
    }
}

impl Solid for Approach<'_> {
    #[inline(always)]
    fn hits<const FUSED: bool>(&mut self, block: &Block) -> Hits {
        let Convex { axes, exponents, taper } = *self.solid;
        let (d, far) = (&block.directions, &block.far);
        let mut t = block.near;
        for (normal, behind) in self.planes.planes.iter().take(self.planes.count) {
            for i in 0..RAYS {
                let mut along = normal[0] * d[0][i];
                for k in 1..3 {
                    along = normal[k].times_plus::<FUSED>(d[k][i], along);
                }
                let enters = if along < 0.0 { behind / along } else { f64::INFINITY };
                t[i] = t[i].most(enters);
            }
        }
        // 0 once a ray has arrived or missed
        let mut live = [0.0; RAYS];
        let mut hits = Hits::NONE;
        for i in 0..RAYS {
            live[i] = f64::from(u8::from(t[i] <= far[i]));
            t[i] = t[i].least(far[i]);
        }
        for _ in 0..STEPS {
            let p = block.at::<FUSED>(&t);
            let mut u = p;
            for i in 0..RAYS {
                let inverse = 1.0 / taper.times_plus::<FUSED>(p[2][i], 1.0);
                u[0][i] *= inverse;
                u[1][i] *= inverse;
            }
            let Gauge { value, slopes } = gauge::<FUSED>(&u, axes, exponents);
            let mut any = 0;
            for i in 0..RAYS {
                // the normal J^{-T} ∇g below the point, and how far the point is above the plane
                let shrunk = 1.0 / value[i];
                let widened = taper.times_plus::<FUSED>(p[2][i] * shrunk, 1.0);
                let (nx, ny) = (slopes[0][i] / widened, slopes[1][i] / widened);
                let across = nx * u[0][i] + ny * u[1][i];
                let nz = slopes[2][i] - taper * shrunk * across;
                let below = (widened * across + nz * p[2][i]) * shrunk;
                let above = nx * p[0][i] + ny * p[1][i] + nz * p[2][i];
                let rate = nx * d[0][i] + ny * d[1][i] + nz * d[2][i];
                let next = t[i] - (above - below) / rate;
                let arrived = value[i] - 1.0 <= ON_SURFACE || next <= t[i] && rate < 0.0;
                let missed = rate >= 0.0 || next > far[i];
                if live[i] > 0.0 && arrived {
                    hits.depth[i] = t[i];
                    (hits.normal[0][i], hits.normal[1][i], hits.normal[2][i]) = (nx, ny, nz);
                }
                live[i] = if arrived || missed { 0.0 } else { live[i] };
                t[i] = if live[i] > 0.0 { next } else { t[i] };
                any |= live[i].to_bits();
            }
            if any == 0 {
                break;
            }
        }
        self.planes.keep(block, &hits);
        hits
    }
}
