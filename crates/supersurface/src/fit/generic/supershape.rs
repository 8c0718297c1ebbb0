//! Supershapes: two superformulas of given symmetry, multiplied (FORMULAS §5).
//!
//! `ln r(φ) = -(1/n1) ln(|cos ψ|^n2 e^(-n1 ln r0) + |sin ψ|^n3 e^(-n1 ln r1))` with `ψ = mφ/4`: in place of the scales
//! a, b stand the radii r0 at `ψ = 0` and r1 at `ψ = π/2`, and in place of n2, n3 their ratios to n1. The symmetries m
//! are whole numbers, which a start brings with it; an odd one around z closes only where both terms are alike.

use std::f64::consts::{LN_2, PI, TAU};

use nalgebra::Rotation3;

use super::GenericShape;
use super::jet::Jet;
use super::member::{Body, Member, Range, range};
use super::search::{Frame, Ground};
use crate::Vector;
use crate::shape::{InvalidShape, Superformula, Supershape};
use crate::surface::Solid;

/// Symmetries that are tried.
const SYMMETRIES: [u8; 9] = [0, 1, 2, 3, 4, 5, 6, 7, 8];
/// Numbers of one curve: `ln n1`, `ln n2/n1`, `ln n3/n1`, `ln r0`, `ln r1`.
const CURVE: usize = 5;
/// Exponents of starts with tips at `ψ = 0`, and with tips between.
const STAR: f64 = 1.6;
const POLYGON: f64 = 2.6;

/// The symmetries around z and from pole to pole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symmetries {
    pub(super) around: u8,
    pub(super) along: u8,
}

impl Symmetries {
    fn terms_alike(&self) -> bool {
        self.around % 2 == 1
    }
}

/// `ln r` of one curve at an angle.
fn log_radius(m: u8, [n1, n2, n3, r0, r1]: &[Jet; CURVE], angle: &Jet) -> Jet {
    let [cos, sin] = (*angle * (0.25 * f64::from(m))).cos_sin();
    // the bracket's logarithm over n1, so that no exponent overflows
    let first = n2.exp() * cos.log() - *r0;
    let second = n3.exp() * sin.log() - *r1;
    let exponent = (-*n1).exp() * 2.0;
    -Jet::layer(&first, &second, &exponent)
}

fn curve(m: u8, [n1, n2, n3, r0, r1]: [f64; CURVE]) -> Result<Superformula, InvalidShape> {
    let first = n1.exp();
    // a^-n2 = r0^-n1
    let scales = [(r0 / n2.exp()).exp(), (r1 / n3.exp()).exp()];
    Superformula::new(f64::from(m), [first, first * n2.exp(), first * n3.exp()], scales)
}

impl Member for Symmetries {
    const POSED: bool = true;

    fn range(&self, number: usize) -> Range {
        let tied = self.terms_alike() && (number == 2 || number == 4);
        match number % CURVE {
            _ if tied => range(-9.0, 9.0, 0.0),
            0 => range(-1.6, 3.7, 0.4),
            1 | 2 => range(-1.4, 3.0, 0.3),
            _ => range(-5.0, 3.0, 0.4),
        }
    }

    fn log_gauge(&self, numbers: &[Jet], [x, y, z]: &[Jet; 3]) -> Jet {
        let Some((around, along)) = numbers.split_first_chunk::<CURVE>() else {
            return Jet::constant(0.0);
        };
        let Some(along) = along.first_chunk::<CURVE>() else { return Jet::constant(0.0) };
        let mut around = *around;
        if self.terms_alike() {
            (around[2], around[4]) = (around[1], around[3]);
        }
        let theta = Jet::atan2(y, x);
        let u = (*x * *x + *y * *y).sqrt() * (-log_radius(self.around, &around, &theta)).exp();
        let phi = Jet::atan2(z, &u);
        (u * u + *z * *z).sqrt().log() - log_radius(self.along, along, &phi)
    }

    fn shape(&self, numbers: &[f64], scale: f64) -> Result<GenericShape, InvalidShape> {
        let at = |k: usize| numbers.get(k).copied().unwrap_or(0.0);
        let mut around: [f64; CURVE] = std::array::from_fn(at);
        let mut along: [f64; CURVE] = std::array::from_fn(|k| at(CURVE + k));
        if self.terms_alike() {
            (around[2], around[4]) = (around[1], around[3]);
        }
        // the longitude is a factor without unit: the latitude holds the metres
        along[3] += scale.ln();
        along[4] += scale.ln();
        let shape = Supershape::new(curve(self.around, around)?, curve(self.along, along)?)?;
        Ok(GenericShape::Solid(Solid::Supershape(Box::new(shape))))
    }
}

/// Curves of all starts around z: symmetry, numbers, and where the body's x axis turns to.
struct Outline {
    m: u8,
    curve: [f64; CURVE],
    turn: f64,
}

/// A star or polygon of `m` tips whose radius varies by the factor `e^(±amplitude)`.
fn wavy(m: u8, exponent: f64, amplitude: f64, log_mean: f64) -> [f64; CURVE] {
    // ln r between the terms is (n/2 - 1) ln 2/n1 above the ends
    let rise = (0.5 * exponent - 1.0) * LN_2;
    let first = (0.5 * rise.abs() / amplitude.max(0.01)).clamp(0.4, 6.0);
    let ratio = (exponent / first).ln();
    let end = if m == 0 { log_mean } else { log_mean - 0.5 * rise / first };
    [first.ln(), ratio, ratio, end, end]
}

/// Outlines around the z axis of a frame, by the waves of the cloud's radius.
fn outlines(frame: &Frame, points: &[Vector]) -> Vec<Outline> {
    let [a, b, c] = frame.half;
    let belt: Vec<(f64, f64)> = points
        .iter()
        .map(|p| frame.rotation.inverse_transform_vector(&(p - frame.position)))
        .filter(|q| q.z.abs() < 0.6 * c)
        .map(|q| (q.y.atan2(q.x), q.x.hypot(q.y).max(1e-3).ln()))
        .collect();
    let n = belt.len().max(1) as f64;
    let mean = belt.iter().map(|(_, r)| r).sum::<f64>() / n;
    let e = frame.exponents[1].clamp(0.15, 1.8);
    let same = (2.0f64 / e).ln();
    let mut out = vec![Outline { m: 4, curve: [same, 0.0, 0.0, a.ln(), b.ln()], turn: 0.0 }];
    for m in SYMMETRIES {
        if m == 0 {
            out.push(Outline { m, curve: wavy(0, 2.0, 0.3, mean), turn: 0.0 });
            continue;
        }
        let wave = |f: fn(f64) -> f64| {
            let sum: f64 = belt.iter().map(|(t, r)| f(f64::from(m) * t) * (r - mean)).sum();
            2.0 * sum / n
        };
        let (cos, sin) = (wave(f64::cos), wave(f64::sin));
        let (amplitude, crest) = (cos.hypot(sin), sin.atan2(cos) / f64::from(m));
        let half = PI / f64::from(m);
        // every other tip is of the other term
        let turns = [
            (STAR, crest),
            (POLYGON, crest + half),
            (STAR, crest + 2.0 * half),
            (POLYGON, crest - half),
        ];
        let kinds = if m % 2 == 1 { 2 } else { 4 };
        for (exponent, turn) in turns.into_iter().take(kinds) {
            out.push(Outline { m, curve: wavy(m, exponent, amplitude, mean), turn });
        }
    }
    out
}

/// Outlines of a star's symmetry around each axis, with a superelliptic profile.
pub(super) fn starts(ground: &Ground) -> Vec<Body<Symmetries>> {
    let mut out = Vec::new();
    for frame in ground.frames.iter().flat_map(|f| f.roles()) {
        let same = (2.0f64 / frame.exponents[0].clamp(0.15, 1.8)).ln();
        let along = [same, 0.0, 0.0, 0.0, frame.half[2].ln()];
        for Outline { m, curve, turn } in outlines(&frame, &ground.points) {
            out.push(Body {
                member: Symmetries { around: m, along: 4 },
                numbers: curve.into_iter().chain(along).collect(),
                position: frame.position,
                rotation: frame.rotation * Rotation3::new(Vector::z() * (turn % TAU)),
            });
        }
    }
    out
}

/// The same outline with profiles of other symmetries.
pub(super) fn relatives(body: &Body<Symmetries>) -> Vec<Body<Symmetries>> {
    let Some((around, along)) = body.numbers.split_first_chunk::<CURVE>() else {
        return Vec::new();
    };
    let height = along.get(4).copied().unwrap_or(0.0);
    let level = along.get(3).copied().unwrap_or(0.0);
    let mean = 0.5 * (height + level);
    let mut out = Vec::new();
    for m in SYMMETRIES {
        for exponent in [STAR, POLYGON] {
            let mut outline = *around;
            // the equator keeps its size, the pole its height
            outline[3] += level - mean;
            outline[4] += level - mean;
            let profile = wavy(m, exponent, 0.15, mean);
            out.push(Body {
                member: Symmetries { around: body.member.around, along: m },
                numbers: outline.into_iter().chain(profile).collect(),
                ..body.clone()
            });
        }
    }
    out
}
