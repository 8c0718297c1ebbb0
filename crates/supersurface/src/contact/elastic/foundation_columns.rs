//! Forces of a block of vertices and their sums; [`Foundation::forces`] is the reference.

use super::foundation::{Application, Block, FoundationOptions};
use super::foundation_error::FoundationError;
use super::indentation::{BLOCK, Indentations};
use super::twist::Twist;
use crate::Pose;
use crate::numeric::lanes::{Job, WIDTH, fused};

#[cfg(doc)]
use super::foundation::Foundation;

/// The options and the motion, in the solid's frame.
pub(super) struct Law {
    stiffness: f64,
    /// `3/2 c`.
    damping: f64,
    friction: f64,
    slip_square: f64,
    /// How far along the indentation the force acts, 0 or 1.
    along: f64,
    linear: [f64; 3],
    angular: [f64; 3],
}

impl Law {
    pub(super) fn new(
        solid: &Pose,
        motion: &Twist,
        options: &FoundationOptions,
    ) -> Result<Self, FoundationError> {
        options.check()?;
        let numbers = motion.linear.iter().chain(&motion.angular).chain(motion.about.iter());
        FoundationError::finite("a number of the motion", numbers)?;
        let motion = motion.moved_to(&solid.translation.vector.into());
        Ok(Self {
            stiffness: options.stiffness,
            damping: 1.5 * options.damping,
            friction: options.friction,
            slip_square: options.slip_speed * options.slip_speed,
            along: f64::from(options.application == Application::Surface),
            linear: solid.inverse_transform_vector(&motion.linear).into(),
            angular: solid.inverse_transform_vector(&motion.angular).into(),
        })
    }
}

/// Sums over vertices, in the solid's frame about its origin.
#[derive(Default)]
pub(super) struct Sums {
    pub(super) force: [f64; 3],
    pub(super) moment: [f64; 3],
    pub(super) vertices: usize,
    pub(super) area: f64,
    pub(super) deepest: f64,
}

/// Adds the forces of a block.
pub(super) struct Push<'a> {
    pub(super) block: &'a Block,
    pub(super) found: &'a Indentations,
    pub(super) law: &'a Law,
    pub(super) sums: &'a mut Sums,
}

impl Job for Push<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { block, found, law, sums } = self;
        let (mut forces, mut moments) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; 3]);
        for i in 0..BLOCK {
            let depth = found.depths[i];
            let n = [found.normals[0][i], found.normals[1][i], found.normals[2][i]];
            let way = law.along * depth;
            let at: [f64; 3] =
                std::array::from_fn(|k| fused::<FUSED>(way, n[k], block.points[k][i]));
            let turning = cross::<FUSED>(law.angular, at);
            let v: [f64; 3] = std::array::from_fn(|k| law.linear[k] + turning[k]);
            let closing = -dot::<FUSED>(v, n);
            let slip: [f64; 3] = std::array::from_fn(|k| fused::<FUSED>(closing, n[k], v[k]));
            let damped = fused::<FUSED>(law.damping, closing, 1.0);
            let damped = if damped > 0.0 { damped } else { 0.0 };
            let push = law.stiffness * depth * damped * block.areas[i];
            let drag = law.friction / (dot::<FUSED>(slip, slip) + law.slip_square).sqrt();
            let f: [f64; 3] = std::array::from_fn(|k| push * fused::<FUSED>(-drag, slip[k], n[k]));
            let m = cross::<FUSED>(at, f);
            for k in 0..3 {
                forces[k][i] = f[k];
                moments[k][i] = m[k];
            }
        }
        for k in 0..3 {
            sums.force[k] += total(&forces[k]);
            sums.moment[k] += total(&moments[k]);
        }
        for (depth, area) in found.depths.iter().zip(&block.areas) {
            let inside = *depth > 0.0 && *area > 0.0;
            sums.vertices += usize::from(inside);
            sums.area += if inside { *area } else { 0.0 };
            sums.deepest = if inside { sums.deepest.max(*depth) } else { sums.deepest };
        }
    }
}

#[inline(always)]
fn dot<const FUSED: bool>(a: [f64; 3], b: [f64; 3]) -> f64 {
    fused::<FUSED>(a[2], b[2], fused::<FUSED>(a[1], b[1], a[0] * b[0]))
}

#[inline(always)]
fn cross<const FUSED: bool>(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let minor = |i: usize, j: usize| fused::<FUSED>(a[i], b[j], -(a[j] * b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[inline(always)]
fn total(column: &[f64; BLOCK]) -> f64 {
    let mut sums = [0.0; WIDTH];
    for chunk in column.as_chunks::<WIDTH>().0 {
        for i in 0..WIDTH {
            sums[i] += chunk[i];
        }
    }
    sums.iter().sum()
}
