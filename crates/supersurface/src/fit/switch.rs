//! The near-symmetries of the family: other bodies that look almost the same, tried once the search has
//! settled, because least squares cannot cross between them.

use nalgebra::{Matrix3, Rotation3};

use super::parameters::{EXPONENTS, Parameters, RINGS};
use crate::Vector;

/// Share of the outside up to which a hole is closed, and that of the hole that is tried instead.
const CLOSED: f64 = 0.1;
const OPEN: f64 = 0.35;

/// Bodies that are nearly `s`: other axis roles, the 45 degree dual, other holes, and to the only `eye` other depths.
pub(super) fn relatives(s: &Parameters, eye: Option<Vector>) -> Vec<Parameters> {
    let mut out = Vec::new();
    if s.family.is_ring() {
        let hole = (s.ring - 1.0) / (s.ring + 1.0);
        if hole > CLOSED {
            out.extend([0.6, 1.5].map(|factor| other_hole(s, factor)));
        } else {
            // a ring seen from its side shows no hole
            let open = other_hole(s, OPEN / hole);
            out.extend(std::iter::once(open).chain(eye.map(|eye| other_depth(&open, &eye, 1.7))));
        }
        out.extend(dual(s));
    } else if !s.family.is_deformed() {
        let others = [1, 2].map(|shift| cycled(s, shift));
        out.extend(others);
        out.extend([*s, others[0], others[1]].iter().filter_map(dual));
    } else {
        out.extend(dual(s));
    }
    if let Some(eye) = eye {
        out.extend([0.6, 1.6].map(|factor| other_depth(s, &eye, factor)));
    }
    out
}

/// The same box with its axes in other roles and the mean exponent.
pub(super) fn cycled(s: &Parameters, shift: usize) -> Parameters {
    let order = [shift % 3, (shift + 1) % 3, (shift + 2) % 3];
    let m = s.rotation.matrix();
    let columns = order.map(|k| Vector::from(m.column(k)));
    Parameters {
        log_axes: order.map(|k| s.log_axes[k]),
        exponents: [0.5 * (s.exponents[0] + s.exponents[1]); 2],
        rotation: Rotation3::from_matrix_unchecked(Matrix3::from_columns(&columns)),
        ..*s
    }
}

/// A section with exponent `2 - ε2`, turned by 45 degrees: for equal axes it has nearly the same outline,
/// `a' = a 2^((1 - ε2)/2)`. `None` where the axes differ too much.
pub(super) fn dual(s: &Parameters) -> Option<Parameters> {
    let difference = (s.log_axes[0] - s.log_axes[1]).abs();
    if difference > 0.5 {
        return None;
    }
    let factor = 0.5 * (1.0 - s.exponents[1]) * std::f64::consts::LN_2;
    let mean = 0.5 * (s.log_axes[0] + s.log_axes[1]) + factor;
    let turn = Rotation3::new(Vector::z() * std::f64::consts::FRAC_PI_4);
    let other = (2.0 - s.exponents[1]).clamp(EXPONENTS[0], EXPONENTS[1]);
    Some(Parameters {
        log_axes: [mean, mean, s.log_axes[2]],
        exponents: [s.exponents[0], other],
        rotation: s.rotation * turn,
        ..*s
    })
}

/// The hole scaled by `factor`, the outside kept.
fn other_hole(s: &Parameters, factor: f64) -> Parameters {
    let outer = 1.0 + s.ring;
    let hole = ((s.ring - 1.0) / outer * factor).clamp(0.03, 0.85);
    let ring = ((1.0 + hole) / (1.0 - hole)).clamp(RINGS[0], RINGS[1]);
    let shift = (outer / (1.0 + ring)).ln();
    Parameters {
        ring,
        log_axes: [s.log_axes[0] + shift, s.log_axes[1] + shift, s.log_axes[2]],
        ..*s
    }
}

/// The axis that points most along the view scaled by `factor`, the near side kept.
fn other_depth(s: &Parameters, eye: &Vector, factor: f64) -> Parameters {
    let view = (s.position - eye).normalize();
    let local = s.rotation.inverse_transform_vector(&view);
    let k = local.iamax();
    let half = s.half_extents()[k];
    let mut next = *s;
    next.log_axes[k] += factor.ln();
    let away = Vector::from(s.rotation.matrix().column(k)) * local[k].signum();
    next.position += away * (half * (factor - 1.0));
    next
}
