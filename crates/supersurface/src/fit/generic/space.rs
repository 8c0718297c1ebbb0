//! How much surface a body has, and how dense outliers are about it.
//!
//! The points are a density on the surface, so of two bodies that are as near to them the smaller one is likelier, by
//! `N ln area`; and outliers spread over the volume V of the cloud's box lie about a surface with the density `area/V` a
//! unit of distance. The area is that of a layer about the surface over its thickness (Minkowski's content), from the
//! first-order distances of fixed probes.

use super::member::{Body, Member};
use crate::Vector;
use crate::numeric::random::Stream;

const PROBES: usize = 1000;
/// Width of the layer, in root mean squares of the cloud.
const WIDTH: f64 = 0.1;
/// How far the box of the probes reaches beyond that of the cloud.
const MARGIN: f64 = 0.25;
/// 1/√(2π).
const GAUSS: f64 = 0.398_942_280_401_432_7;

/// Probes in the box of a cloud.
#[derive(Clone, Debug)]
pub(super) struct Space {
    probes: Vec<Vector>,
    volume: f64,
    cloud: f64,
}

impl Space {
    pub(super) fn about(points: &[Vector]) -> Self {
        let edge = |pick: fn(f64, f64) -> f64, from: f64| {
            points.iter().fold(Vector::repeat(from), |e, p| e.zip_map(p, pick))
        };
        let (low, high) = (edge(f64::min, f64::INFINITY), edge(f64::max, f64::NEG_INFINITY));
        let mut random = Stream::new(1, 0);
        let mut between = |l: f64, h: f64| random.between(l - MARGIN, h + MARGIN);
        let probes = (0..PROBES).map(|_| low.zip_map(&high, &mut between)).collect();
        let volume = (high - low).map(|s| s + 2.0 * MARGIN).product();
        let cloud = (high - low).map(|s| s.max(0.1)).product();
        Self { probes, volume, cloud }
    }

    /// Surface area of a body within the box, within some tenths, in squares of the root mean square.
    pub(super) fn area<M: Member>(&self, body: &Body<M>) -> f64 {
        let layer = |d: &f64| (-0.5 * (d / WIDTH) * (d / WIDTH)).exp() * (GAUSS / WIDTH);
        let sum: f64 = body.distances(&self.probes).iter().map(layer).sum();
        (sum * self.volume / PROBES as f64).max(1e-3)
    }

    /// Density of outliers a unit of distance from a surface of an area.
    pub(super) fn outlier_density(&self, area: f64) -> f64 {
        (area / self.cloud).clamp(1e-4, 1e3)
    }
}
