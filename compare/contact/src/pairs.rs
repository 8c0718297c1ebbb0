//! Random pairs of posed superellipsoids, a given gap apart.
//!
//! Body B is put so that the support points of A along `n` and of B along `-n` are `gap * n` apart. For
//! `gap >= 0` the plane between them separates the bodies, so the gap is their distance, exactly. For
//! `gap < 0` it bounds the depth from above only: another direction may part the bodies sooner.

use std::f64::consts::FRAC_PI_2;

use supersurface::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Posed, Superellipsoid, SupportMap};
use supersurface::{Direction, Point, Pose, Vector};

use crate::options::Shapes;

/// How the bodies of a pair lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Regime {
    /// Apart by 0.1 to 2 sizes.
    Separated,
    /// Apart by 1e-4 to 1e-2 sizes.
    Near,
    /// Pushed in by 1e-3 to 1e-2 of the smallest semi-axis.
    Shallow,
    /// Pushed in by 0.2 to 0.8 of the smallest semi-axis.
    Deep,
}

impl Regime {
    /// All, from far to deep.
    pub const ALL: [Self; 4] = [Self::Separated, Self::Near, Self::Shallow, Self::Deep];

    /// Its name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Separated => "separated",
            Self::Near => "near",
            Self::Shallow => "shallow",
            Self::Deep => "deep",
        }
    }
}

/// Two posed bodies.
#[derive(Clone, Debug)]
pub struct Pair {
    /// How they lie.
    pub regime: Regime,
    /// The first body.
    pub a: Posed<Superellipsoid>,
    /// The second body.
    pub b: Posed<Superellipsoid>,
    /// The second body a little later, for warm starts: moved by 1e-3 of size, turned by 1e-3 rad.
    pub b_later: Posed<Superellipsoid>,
    /// Mean of the largest semi-axes, in metres: what errors are relative to.
    pub size: f64,
    /// The signed distance where it is exact by construction.
    pub constructed: Option<f64>,
}

/// The exponents of the sweep; 0.1 to 1.9.
const EXPONENTS: [f64; 10] = [0.1, 0.2, 0.3, 0.5, 0.8, 1.0, 1.2, 1.5, 1.8, 1.9];
/// The axis ratios of the sweep.
const RATIOS: [f64; 4] = [1.0, 3.0, 10.0, 20.0];

/// `count` pairs of a regime; the same for the same seed.
pub fn draw(regime: Regime, count: usize, shapes: Shapes, seed: u64) -> Vec<Pair> {
    (0..count)
        .map(|k| {
            let stream = (k * Regime::ALL.len() + regime as usize) as u64;
            pair(regime, k, shapes, &mut Stream::new(seed, stream))
        })
        .collect()
}

fn pair(regime: Regime, k: usize, shapes: Shapes, random: &mut Stream) -> Pair {
    let mut body = || {
        let shape = match shapes {
            Shapes::Sweep => {
                let ratio = RATIOS[k / EXPONENTS.len() % RATIOS.len()];
                superellipsoid(ratio, [EXPONENTS[k % EXPONENTS.len()]; 2], random)
            }
            Shapes::Mixed => {
                let exponents = [random.between(0.1, 1.9), random.between(0.1, 1.9)];
                superellipsoid(log_between(random, 1.0, 20.0), exponents, random)
            }
        };
        (shape, rotation(random))
    };
    let [(a, turn_a), (b, turn_b)] = [body(), body()];

    let largest = |s: &Superellipsoid| s.semi_axes().into_iter().fold(0.0, f64::max);
    let smallest = |s: &Superellipsoid| s.semi_axes().into_iter().fold(f64::MAX, f64::min);
    let size = 0.5 * (largest(&a) + largest(&b));
    let thin = smallest(&a).min(smallest(&b));
    let gap = match regime {
        Regime::Separated => size * log_between(random, 0.1, 2.0),
        Regime::Near => size * log_between(random, 1e-4, 1e-2),
        Regime::Shallow => -thin * log_between(random, 1e-3, 1e-2),
        Regime::Deep => -thin * log_between(random, 0.2, 0.8),
    };

    // Half of the directions are uniform, half are normals at points all round A: those favour faces.
    // Ten pairs share a ratio, so the two kinds change places after each ten.
    let uniform = direction(random);
    let normal = match (k + k / EXPONENTS.len()) % 2 {
        0 => uniform,
        _ => Direction::new_normalize(turn_a * a.gradient(&surface_point(&a, &uniform))),
    };
    let at_a = turn_a * a.support_point(&turn_a.inverse_transform_vector(&normal)).coords;
    let at_b = turn_b * b.support_point(&turn_b.inverse_transform_vector(&-*normal)).coords;
    let origin = Vector::from_fn(|_, _| random.between(-1.0, 1.0));
    let centre_b = origin + at_a - at_b + gap * *normal;

    let step = 1e-3 * size * *direction(random);
    let turn = UnitQuaternion::from_axis_angle(&direction(random), 1e-3);
    Pair {
        regime,
        a: posed(a, origin, turn_a),
        b: posed(b, centre_b, turn_b),
        b_later: posed(b, centre_b + step, turn * turn_b),
        size,
        constructed: (gap >= 0.0).then_some(gap),
    }
}

/// Semi-axes in a random order, the largest `ratio` times the smallest; their product is 1.
fn superellipsoid(ratio: f64, exponents: [f64; 2], random: &mut Stream) -> Superellipsoid {
    let middle = log_between(random, 1.0, ratio);
    let mean = (ratio * middle).cbrt();
    let mut axes = [ratio / mean, middle / mean, 1.0 / mean];
    axes.swap(0, random.index(3));
    axes.swap(1, 1 + random.index(2));
    Superellipsoid::new(axes, exponents).expect("what is drawn lies in the shape's range")
}

fn posed(
    shape: Superellipsoid,
    centre: Vector,
    turn: UnitQuaternion<f64>,
) -> Posed<Superellipsoid> {
    let pose = Pose::from_parts(Translation3::from(centre), turn);
    Posed::new(shape, pose).expect("what is drawn is finite")
}

/// Where the ray from the centre along `d`, stretched like the body, meets its surface.
fn surface_point(shape: &Superellipsoid, d: &Direction) -> Point {
    let stretched = Vector::from(shape.semi_axes()).component_mul(d);
    Point::from(stretched / shape.gauge(&stretched.into()))
}

fn log_between(random: &mut Stream, low: f64, high: f64) -> f64 {
    random.between(low.ln(), high.ln()).exp()
}

/// Uniform on the sphere.
fn direction(random: &mut Stream) -> Direction {
    let height: f64 = random.between(-1.0, 1.0);
    let (sin, cos) = random.between(0.0, 4.0 * FRAC_PI_2).sin_cos();
    let radius = (1.0 - height * height).sqrt();
    Direction::new_normalize(Vector::new(radius * cos, radius * sin, height))
}

/// Uniform over all rotations.
fn rotation(random: &mut Stream) -> UnitQuaternion<f64> {
    let [w, x, y, z] = [(); 4].map(|()| random.normal());
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_parts_separated_pairs_by_the_constructed_gap_and_no_less() {
        for shapes in [Shapes::Sweep, Shapes::Mixed] {
            for pair in draw(Regime::Near, 80, shapes, 3) {
                let gap = pair.constructed.unwrap();
                assert!(gap > 0.9e-4 * pair.size && gap < 1.1e-2 * pair.size);
                // moved together by the gap, the bodies touch, so no direction parts them any more
                let mut random = Stream::new(5, 0);
                for _ in 0..500 {
                    let n = direction(&mut random);
                    let parted = -pair.a.support(&n) - pair.b.support(&-*n);
                    assert!(parted <= gap + 1e-12 * pair.size);
                }
            }
        }
    }

    #[test]
    fn ratios_and_exponents_are_those_asked_for() {
        let pairs = draw(Regime::Deep, 40, Shapes::Sweep, 1);
        for (k, pair) in pairs.iter().enumerate() {
            let axes = pair.a.shape().semi_axes();
            let [least, most] = [
                axes.iter().copied().fold(f64::MAX, f64::min),
                axes.iter().copied().fold(0.0, f64::max),
            ];
            assert!((most / least / RATIOS[k / 10] - 1.0).abs() < 1e-12);
            assert_eq!(pair.b.shape().exponents(), [EXPONENTS[k % 10]; 2]);
            assert_eq!(pair.constructed, None);
        }
    }
}
