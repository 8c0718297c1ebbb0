//! How the signed distance changes when bodies move, turn, grow or change their exponents.
//!
//! The signed distance is the best of many separations, `d = max_n [n·Δ - h_A(R_Aᵀ n) - h_B(R_Bᵀ n)]`, so its derivative is
//! that of the separation at the best direction held fixed (Danskin's theorem): for a shift of B the normal, for a
//! turn the moment of the normal about the body's centre, and for the shape that of the support function. With the
//! shares `s` of the axes in the support function `h` (see `difference.rs`) `∂h/∂a_i = w_i h / a_i`,
//! `∂h/∂ε1 = h (S ln S + S3 ln S3)/2` and `∂h/∂ε2 = h S (s1 ln s1 + s2 ln s2)/2`.

use super::query::{CELLS, CONTENT, Contact, WarmStart, answer};
use super::{Convex, difference::Triple};
use crate::Vector;
use crate::shape::Posed;

/// Derivatives of the signed distance with respect to one body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodyDerivative {
    /// By a shift of the body, in the world's frame; without unit.
    pub translation: Vector,
    /// By a turn of the body about its centre, a rotation vector in the world's frame; metres per radian.
    pub rotation: Vector,
    /// By the semi-axes; without unit.
    pub semi_axes: [f64; 3],
    /// By the exponents; metres.
    pub exponents: [f64; 2],
}

/// The contact of two bodies as [`pair`](super::pair) gives it, and the derivatives of its distance with respect to A
/// and B; `None` where there are none, because other directions separate the bodies as well.
///
/// ```
/// use supersurface::contact::{Convex, WarmStart, differentiate};
/// use supersurface::{Pose, shape::{Posed, Superellipsoid}};
/// let ball = Convex::new(Superellipsoid::new([0.02; 3], [1.0; 2])?)?;
/// let at = |x: f64| Posed::new(ball, Pose::translation(x, 0.0, 0.0));
/// let (contact, derivatives) = differentiate(&at(0.0)?, &at(0.05)?, &mut WarmStart::default());
/// let [of_a, of_b] = derivatives.unwrap();
/// assert!((contact.distance - 0.01).abs() < 1e-15);
/// assert!((of_b.translation.x - 1.0).abs() < 1e-12 && (of_a.semi_axes[0] + 1.0).abs() < 1e-12);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn differentiate(
    a: &Posed<Convex>,
    b: &Posed<Convex>,
    start: &mut WarmStart,
) -> (Contact, Option<[BodyDerivative; 2]>) {
    let answer = answer(a, b, start, CONTENT, CELLS);
    let contact = answer.contact(a, b);
    if !answer.unique || !answer.minimum.is_isolated(&answer.pair) {
        return (contact, None);
    }
    let normal = contact.normal.into_inner();
    let of = |which: usize, body: &Posed<Convex>, away: f64| {
        let arm = contact.witnesses[which] - body.pose().translation.vector;
        let turn = body.pose().rotation;
        // both as if the body were touched from outside along its own outward normal
        let outward = turn.inverse() * (normal * away);
        let point = turn.inverse() * arm.coords;
        let shape = body.shape().shape();
        let (semi_axes, exponents) = of_support(&shape.semi_axes(), &point.into(), &outward.into());
        BodyDerivative {
            translation: normal * -away,
            rotation: normal.cross(&arm.coords) * away,
            semi_axes: semi_axes.map(|v| -v),
            exponents: exponents.map(|v| -v),
        }
    };
    (contact, Some([of(0, a, 1.0), of(1, b, -1.0)]))
}

/// Derivatives of the support function by semi-axes and exponents, from the support point of a direction.
fn of_support(semi_axes: &Triple, point: &Triple, normal: &Triple) -> (Triple, [f64; 2]) {
    let parts: Triple = std::array::from_fn(|k| (point[k] * normal[k]).max(0.0));
    let planar = parts[0] + parts[1];
    let whole = planar + parts[2];
    let entropy = |part: f64, whole: f64| {
        let share = part / whole;
        if share > 0.0 { 0.5 * share * share.ln() } else { 0.0 }
    };
    let outer = whole * (entropy(planar, whole) + entropy(parts[2], whole));
    let inner = planar * (entropy(parts[0], planar) + entropy(parts[1], planar));
    (std::array::from_fn(|k| parts[k] / semi_axes[k]), [outer, inner])
}
