//! A point well inside of `F < 1`: the least value of F.
//!
//! Each step solves a weighted least squares problem with the weights `ε max(1, ε-1) |h|^(ε-2)`: Newton's
//! method for terms with `ε >= 2`, Weiszfeld's iteration (which never increases F) for the others. F spans
//! hundreds of decades, so shares of the terms and `ln F` stand for F, and steps are lengthened as long as
//! that helps: along a single steep term Newton's step is short by the factor `ε - 1`.

use nalgebra::{Matrix3, SymmetricEigen};

use super::form::HyperquadricForm;
use crate::{Point, Vector};

/// Steps at most.
const STEPS: usize = 200;
/// A term this close to its crease is treated as this far from it.
const FLOOR: f64 = 1e-9;

/// The point found and `ln F` there. It is the least for convex forms; for others the best that a search from
/// all vertices of the planes found.
pub(super) fn least(form: &HyperquadricForm) -> (Point, f64) {
    let mut best = descend(form, centre(form));
    if form.is_convex() {
        return best;
    }
    // terms with ε < 1 are concave between their planes: the least lies where planes meet
    let planes = &form.terms;
    for (i, a) in planes.iter().enumerate() {
        for (j, b) in planes.iter().enumerate().skip(i + 1) {
            for c in planes.iter().skip(j + 1) {
                let rows = Matrix3::from_rows(&[a, b, c].map(|t| t.normal.normalize().transpose()));
                let right = Vector::from([a, b, c].map(|t| -t.offset / t.normal.norm()));
                let Some(inverse) = rows.try_inverse() else { continue };
                let p = Point::from(inverse * right);
                let value = form.log_value(&p).0;
                if value < best.1 {
                    best = (p, value);
                }
            }
        }
    }
    let polished = descend(form, best.0);
    if polished.1 < best.1 { polished } else { best }
}

/// Where the sum of squares `Σ h²` is least.
fn centre(form: &HyperquadricForm) -> Point {
    let mut matrix = Matrix3::zeros();
    let mut right = Vector::zeros();
    for t in &form.terms {
        // each plane counts by its distance: lengths of the normals differ by decades
        let size = t.normal.norm();
        matrix += t.normal * t.normal.transpose() / (size * size);
        right -= t.normal * t.offset / (size * size);
    }
    Point::from(solve(matrix, right))
}

fn descend(form: &HyperquadricForm, start: Point) -> (Point, f64) {
    let mut at = start;
    let (mut value, mut shares) = form.log_value(&at);
    for _ in 0..STEPS {
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector::zeros());
        for (t, share) in form.terms.iter().zip(&shares) {
            let h = t.height(&at);
            let size = h.abs().max(FLOOR);
            let slope = t.exponent * share / size;
            matrix +=
                t.normal * t.normal.transpose() * (slope * (t.exponent - 1.0).max(1.0) / size);
            right -= t.normal * (slope * h.signum());
        }
        let step = solve(matrix, right);
        let along = |length: f64| form.log_value(&(at + step * length)).0;
        let (mut length, mut reached) = (1.0, along(1.0));
        while reached.is_nan() || reached >= value {
            length *= 0.5;
            if length < 1e-6 {
                return (at, value);
            }
            reached = along(length);
        }
        loop {
            let further = along(2.0 * length);
            if further.is_nan() || further >= reached {
                break;
            }
            (length, reached) = (2.0 * length, further);
            if length > 1e6 {
                break;
            }
        }
        let gain = value - reached;
        at += step * length;
        (value, shares) = form.log_value(&at);
        if gain < 1e-10 || value < -200.0 {
            break;
        }
    }
    (at, value)
}

/// The shortest solution of a symmetric system, in the directions that it says something about.
fn solve(matrix: Matrix3<f64>, right: Vector) -> Vector {
    let size = matrix.amax();
    if !(size > 0.0 && size.is_finite()) {
        return Vector::zeros();
    }
    let eigen = SymmetricEigen::new(matrix / size);
    let mut x = Vector::zeros();
    for (value, axis) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > 1e-13 {
            x += axis * (axis.dot(&right) / (value * size));
        }
    }
    if x.iter().all(|v| v.is_finite()) { x } else { Vector::zeros() }
}
