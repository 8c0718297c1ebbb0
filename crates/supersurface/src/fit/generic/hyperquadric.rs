//! Hyperquadrics of a known number of terms, `F = Σ |n_i·p + d_i|^{ε_i}` (equation 24, FORMULAS §5).
//!
//! The function that is fitted is `F^(1/E)` with the mean exponent E: to first order its distance is that of the
//! shape's own gauge.

use super::GenericShape;
use super::jet::Jet;
use super::member::{Body, Member, Range, range};
use super::search::Ground;
use crate::Vector;
use crate::fit::start::quantile;
use crate::numeric::random::Stream;
use crate::shape::{Hyperquadric, InvalidShape};

/// Logarithms of the exponents stay between those of 0.8 and 40.
const EXPONENTS: [f64; 2] = [-0.223, 3.689];
/// Directions in which the cloud is measured.
const DIRECTIONS: usize = 120;
/// Points of space that the slabs should cut off.
const PROBES: usize = 800;

#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    pub(super) count: usize,
}

impl Member for Terms {
    const POSED: bool = false;

    fn range(&self, number: usize) -> Range {
        match number % 5 {
            4 => range(EXPONENTS[0], EXPONENTS[1], 0.5),
            _ => range(-20.0, 20.0, 0.5),
        }
    }

    fn log_gauge(&self, numbers: &[Jet], [x, y, z]: &[Jet; 3]) -> Jet {
        let mut sum = Jet::constant(f64::NEG_INFINITY);
        let mut mean = Jet::constant(0.0);
        for [a, b, c, d, log_exponent] in numbers.as_chunks::<5>().0 {
            let exponent = log_exponent.exp();
            let term = (*a * *x + *b * *y + *c * *z + *d).log() * exponent;
            sum = if sum.value.is_finite() { Jet::log_sum(&sum, &term) } else { term };
            mean = mean + exponent;
        }
        sum * (mean * (1.0 / self.count.max(1) as f64)).inverse()
    }

    fn shape(&self, numbers: &[f64], scale: f64) -> Result<GenericShape, InvalidShape> {
        let terms = numbers.as_chunks::<5>().0;
        let planes: Vec<[f64; 4]> =
            terms.iter().map(|[a, b, c, d, _]| [a / scale, b / scale, c / scale, *d]).collect();
        let exponents: Vec<f64> = terms.iter().map(|t| t[4].exp()).collect();
        Ok(GenericShape::Hyperquadric(Hyperquadric::new(&planes, &exponents)?))
    }
}

/// The space between two planes across a direction that hold the cloud.
#[derive(Clone, Debug)]
struct Slab {
    normal: Vector,
    middle: f64,
    half: f64,
    /// Which probes lie outside.
    cut: Vec<bool>,
}

impl Slab {
    fn new(normal: Vector, points: &[Vector], probes: &[Vector]) -> Self {
        let mut heights: Vec<f64> = points.iter().map(|p| p.dot(&normal)).collect();
        let (low, high) = (quantile(&mut heights, 0.005), quantile(&mut heights, 0.995));
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(0.02));
        let cut = probes.iter().map(|p| (p.dot(&normal) - middle).abs() > half).collect();
        Self { normal, middle, half, cut }
    }

    /// The term whose planes `|h| = 1` are a little outside of the slab.
    fn term(&self, exponent: f64) -> [f64; 5] {
        let s = 0.93 / self.half;
        let n = self.normal * s;
        [n.x, n.y, n.z, -self.middle * s, exponent.ln()]
    }
}

impl Terms {
    /// Slabs that hold the cloud and cut off as much of the space around it as they can, chosen one after the other;
    /// the first ones are free, or the axes of a superellipsoid.
    pub(super) fn starts(&self, ground: &Ground) -> Vec<Body<Self>> {
        let mut random = Stream::new(0, 0);
        let reach = ground.points.iter().map(|p| p.amax()).fold(0.1, f64::max);
        let probes: Vec<Vector> =
            (0..PROBES).map(|_| Vector::from_fn(|_, _| random.between(-reach, reach))).collect();
        let slab = |n: Vector| Slab::new(n, &ground.points, &probes);
        let slabs: Vec<Slab> = half_sphere(DIRECTIONS).map(slab).collect();
        let mut bases: Vec<Vec<Slab>> = vec![Vec::new()];
        // each kind of first slab leads to another choice
        let mut best: Vec<&Slab> = slabs.iter().collect();
        best.sort_by_key(|s| std::cmp::Reverse(s.cut.iter().filter(|c| **c).count()));
        for other in [3, 8, 16] {
            bases.extend(best.get(other).map(|s| vec![(*s).clone()]));
        }
        for frame in &ground.frames {
            let columns = frame.rotation.matrix();
            bases.push((0..3).map(|k| slab(columns.column(k).into())).collect());
        }
        let mut out = Vec::new();
        for base in bases {
            let chosen = self.completed(base, &slabs);
            for exponent in [3.0, 10.0] {
                let numbers = chosen.iter().flat_map(|s| s.term(exponent)).collect();
                out.push(Body {
                    member: *self,
                    numbers,
                    position: Vector::zeros(),
                    rotation: nalgebra::Rotation3::identity(),
                });
            }
        }
        out
    }

    /// As many slabs as there are terms: each next one cuts off most of what the others leave.
    fn completed(&self, mut chosen: Vec<Slab>, slabs: &[Slab]) -> Vec<Slab> {
        let mut left = vec![true; PROBES];
        let take = |left: &mut [bool], s: &Slab| {
            left.iter_mut().zip(&s.cut).for_each(|(l, c)| *l &= !c);
        };
        chosen.iter().for_each(|s| take(&mut left, s));
        while chosen.len() < self.count {
            let gain = |s: &Slab| left.iter().zip(&s.cut).filter(|(l, c)| **l && **c).count();
            let Some(next) = slabs.iter().max_by_key(|s| gain(s)) else { break };
            take(&mut left, next);
            chosen.push(next.clone());
        }
        chosen
    }
}

/// Directions spread over a half sphere along a golden spiral.
fn half_sphere(count: usize) -> impl Iterator<Item = Vector> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |i| {
        let z = (i as f64 + 0.5) / count as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector::new(r * cos, r * sin, z)
    })
}
