//! Solids filled by lines from their middle to their surface, and the moments that follow, also where a map moves them.
//!
//! A solid is cut into pieces; in each, a point `(u, v)` of the unit square says a line and a number `r` in (0, 1) the
//! place on it: `x(u, v, r)` with the volume element `w du dv dr`. For a body seen from inside, `x = c + r b` and
//! `w = r² det(b, ∂b/∂u, ∂b/∂v)`. A map `T` makes `T(x)` and `w det J` of it, so that integrals over deformed solids
//! are integrals over what they were made of, where no slope is infinite (compare FORMULAS §4). Gauss's rule with nodes
//! drawn to the ends integrates each piece, and twice as many nodes a side give the error.

use super::{Mass, MassEstimate, Moments};
use crate::numeric::gauss::Rule;
use crate::numeric::superellipse::norm;
use crate::{Point, Vector};

/// Nodes a side: the second time twice as many, and so on while the error is above [`ENOUGH`].
const NODES: [usize; 4] = [8, 16, 32, 48];
/// The same where an integral is along a line.
const NODES_OF_A_LINE: [usize; 4] = [16, 32, 64, 128];
/// Relative error at which no more nodes are taken.
const ENOUGH: f64 = 1e-7;

/// A solid that lines fill.
///
/// ```
/// use supersurface::shape::{Filled, Superellipsoid};
/// let ball = Superellipsoid::new([1.0; 3], [1.0; 2])?;
/// let mut reach = 0.0f64;
/// ball.along(0, [0.3, 0.6], &[0.5, 1.0], &mut |p, _| reach = reach.max(p.coords.norm()));
/// assert!((reach - 1.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub trait Filled {
    /// Number of pieces in which the lines change smoothly.
    fn pieces(&self) -> usize;

    /// Calls `each` with points at the `shares` (in (0, 1)) of the line that stands at `at` (in (0, 1)²) in a piece, and
    /// with their volume element in m³ by the three numbers. A piece that does not exist is the last one.
    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64));

    /// Calls `each` with points and weights that integrate, in m³, every function that is a cubic polynomial across z at
    /// each height; along z by a rule of nodes and weights on (0, 1). False, and no call, where no such points are known.
    fn sections(&self, _rule: &[[f64; 2]], _each: &mut dyn FnMut(Point, f64)) -> bool {
        false
    }
}

impl<S: Filled + ?Sized> Filled for Box<S> {
    fn pieces(&self) -> usize {
        (**self).pieces()
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        (**self).along(piece, at, shares, each);
    }

    fn sections(&self, rule: &[[f64; 2]], each: &mut dyn FnMut(Point, f64)) -> bool {
        (**self).sections(rule, each)
    }
}

/// Mass properties by integration along the lines.
pub(crate) fn filled_mass(solid: &(impl Filled + ?Sized), density: f64) -> MassEstimate {
    refined(NODES, density, |nodes| moments(solid, nodes))
}

/// Mass properties by integration along z of what a solid's [`Filled::sections`], moved by a map, say; `None` where they say
/// nothing. The map and its volume element are linear across z.
pub(crate) fn mass_of_sections(
    solid: &impl Filled,
    map: impl Fn(&Point) -> (Point, f64),
    density: f64,
) -> Option<MassEstimate> {
    let mut known = true;
    let found = refined(NODES_OF_A_LINE, density, |nodes| {
        let mut sum = Moments::nothing();
        known &= solid.sections(&Rule::drawn_to_ends(nodes).nodes, &mut |p, volume| {
            let (moved, share) = map(&p);
            sum.add(volume * share, &moved.coords);
        });
        sum
    });
    known.then_some(found)
}

/// Twice as many nodes until the error is small.
fn refined<const N: usize>(
    counts: [usize; N],
    density: f64,
    mut moments: impl FnMut(usize) -> Moments,
) -> MassEstimate {
    let nothing = Moments::nothing().mass(1.0);
    let mut found = MassEstimate { mass: nothing, error: f64::INFINITY };
    for (k, nodes) in counts.into_iter().enumerate() {
        let finer = moments(nodes).mass(1.0);
        if k == 0 {
            found.mass = finer;
            continue;
        }
        found = MassEstimate::refined(&found.mass, finer);
        if found.error < ENOUGH {
            break;
        }
    }
    let Mass { mass, centre, inertia } = found.mass;
    let mass = Mass { mass: mass * density, centre, inertia: inertia * density };
    MassEstimate { mass, ..found }
}

fn moments(solid: &(impl Filled + ?Sized), nodes: usize) -> Moments {
    let rule = Rule::drawn_to_ends(nodes).nodes;
    // along the lines everything is smooth
    let lengthwise = Rule::gauss(nodes).nodes;
    let shares: Vec<f64> = lengthwise.iter().map(|[r, _]| *r).collect();
    let mut sum = Moments::nothing();
    for piece in 0..solid.pieces() {
        for [u, across] in &rule {
            for [v, up] in &rule {
                let mut weights = lengthwise.iter().map(|[_, w]| w * across * up);
                solid.along(piece, [*u, *v], &shares, &mut |p, volume| {
                    let weight = weights.next().unwrap_or(0.0);
                    sum.add(weight * volume, &p.coords);
                });
            }
        }
    }
    sum
}

/// Signs and order of a piece, taken from its number bit by bit.
pub(super) struct Bits(usize);

impl Bits {
    pub(super) const fn of(piece: usize) -> Self {
        Self(piece)
    }

    pub(super) const fn next(&mut self) -> bool {
        let bit = self.0 % 2 == 1;
        self.0 /= 2;
        bit
    }

    pub(super) const fn sign(&mut self) -> f64 {
        if self.next() { -1.0 } else { 1.0 }
    }
}

/// A point of an eighth of the unit superellipse of the exponent `p`, `(1, s)/n` or `(s, 1)/n` with signs, and its turn
/// `det(b, b') = 1/n²` by `s`, without a sign. Three bits.
pub(super) fn eighth(bits: &mut Bits, s: f64, p: f64) -> ([f64; 2], f64) {
    let n = norm(1.0, s, p);
    let (first, second) = if bits.next() { (s, 1.0) } else { (1.0, s) };
    ([bits.sign() * first / n, bits.sign() * second / n], 1.0 / (n * n))
}

/// Pieces of [`star`]: signs and order of the three coordinates.
pub(super) const STAR_PIECES: usize = 48;

/// A line of a body seen from `centre`, with a gauge about it that is homogeneous of degree 1: the direction is
/// `(1, u, uv)` in some order, with signs and times `size`. Calls `each` as [`Filled::along`] says.
pub(super) fn star(
    [centre, size]: [Vector; 2],
    (piece, [u, v]): (usize, [f64; 2]),
    gauge: impl Fn(&Vector) -> f64,
    shares: &[f64],
    each: &mut dyn FnMut(Point, f64),
) {
    let mut bits = Bits::of(piece);
    let signs = Vector::from_fn(|_, _| bits.sign());
    let ordered = match bits.0 {
        0 => Vector::new(1.0, u, u * v),
        1 => Vector::new(1.0, u * v, u),
        2 => Vector::new(u, 1.0, u * v),
        3 => Vector::new(u * v, 1.0, u),
        4 => Vector::new(u, u * v, 1.0),
        _ => Vector::new(u * v, u, 1.0),
    };
    let direction = ordered.component_mul(&signs).component_mul(&size);
    let reach = 1.0 / gauge(&direction);
    let volume = size.product() * u * reach * reach * reach;
    for r in shares {
        each(Point::from(centre + direction * (reach * r)), volume * r * r);
    }
}
