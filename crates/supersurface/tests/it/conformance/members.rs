//! Random members of the family. All lengths are multiplied by `scale`, so that the same numbers at two scales are
//! two sizes of one shape.

use supersurface::combine::{Alpha, Blend, CombinedSolid};
use supersurface::deform::{Bend, Cavity, Deformed, ShearBend, Taper, Twist};
use supersurface::numeric::random::Stream;
use supersurface::shape::{
    ExtendedSuperellipsoid, Hyperquadric, InvalidShape, Posed, Quadric, RadialExtended,
    SeparableSuperquadric, Supercone, Supercylinder, Superellipsoid, Superformula,
    SuperhyperboloidOneSheet, SuperhyperboloidTwoSheets, Superparaboloid, Supershape, Supertoroid,
};
use supersurface::{Pose, Vector};

/// A maker: the same stream and another scale give the same shape in another size.
pub(super) type Make<S> = fn(&mut Stream, f64) -> Result<S, InvalidShape>;

/// From 0.1 to 2.5; every third a special one.
fn exponent(random: &mut Stream) -> f64 {
    let special = [0.1, 0.5, 1.0, 1.5, 2.0, 2.5];
    let free = random.between(0.1, 2.5);
    let chosen = special[random.index(special.len())];
    if random.uniform() < 0.33 { chosen } else { free }
}

fn exponents(random: &mut Stream) -> [f64; 2] {
    [exponent(random), exponent(random)]
}

/// From `scale` down to a hundredth of it; every third shape has equal ones.
fn axes(random: &mut Stream, scale: f64) -> [f64; 3] {
    let ratio = if random.uniform() < 0.33 { 1.0 } else { 100f64 };
    if !(1e-100..=1e100).contains(&scale) && random.uniform() < 0.5 {
        // the ends of the numbers, all in one shape
        let ends = [5e-324, 1e-300, 1.0, 1e300, scale];
        return [0; 3].map(|_| ends[random.index(ends.len())]);
    }
    [0; 3].map(|_| scale * (-random.uniform() * ratio.ln()).exp())
}

/// As the deformations have them: not longer than 5:1, exponents up to 1.9.
fn stick(random: &mut Stream, scale: f64) -> Result<Superellipsoid, InvalidShape> {
    let [x, y] = [0; 2].map(|_| scale * random.between(0.1, 0.5));
    let z = scale * random.between(0.2, 0.5);
    let exponents = [0; 2].map(|_| exponent(random).min(1.9));
    Superellipsoid::new([x, y, z], exponents)
}

pub(super) fn superellipsoid(r: &mut Stream, scale: f64) -> Result<Superellipsoid, InvalidShape> {
    Superellipsoid::new(axes(r, scale), exponents(r))
}

pub(super) fn supertoroid(r: &mut Stream, scale: f64) -> Result<Supertoroid, InvalidShape> {
    let (axes, ring) = (axes(r, scale), r.between(1.0, 4.0));
    Supertoroid::new(axes, if r.uniform() < 0.2 { 1.0 } else { ring }, exponents(r))
}

pub(super) fn one_sheet(
    r: &mut Stream,
    scale: f64,
) -> Result<SuperhyperboloidOneSheet, InvalidShape> {
    SuperhyperboloidOneSheet::new(axes(r, scale), exponents(r))
}

pub(super) fn two_sheets(
    r: &mut Stream,
    scale: f64,
) -> Result<SuperhyperboloidTwoSheets, InvalidShape> {
    SuperhyperboloidTwoSheets::new(axes(r, scale), exponents(r))
}

pub(super) fn superparaboloid(r: &mut Stream, scale: f64) -> Result<Superparaboloid, InvalidShape> {
    Superparaboloid::new(axes(r, scale), exponents(r))
}

pub(super) fn supercylinder(r: &mut Stream, scale: f64) -> Result<Supercylinder, InvalidShape> {
    Supercylinder::new(axes(r, scale), exponent(r))
}

pub(super) fn supercone(r: &mut Stream, scale: f64) -> Result<Supercone, InvalidShape> {
    Supercone::new(axes(r, scale), exponent(r))
}

pub(super) fn separable(r: &mut Stream, scale: f64) -> Result<SeparableSuperquadric, InvalidShape> {
    let mut power = || {
        let special = [0.2, 0.6, 0.999, 1.0, 1.0001, 1e3, 1e6];
        let chosen = special[r.index(special.len())];
        if r.uniform() < 0.2 { chosen } else { 2.0 / exponent(r) }
    };
    let powers = [power(), power(), power()];
    SeparableSuperquadric::new(axes(r, scale), powers)
}

/// The ellipsoid that ten coefficients come to.
pub(super) fn quadric(r: &mut Stream, scale: f64) -> Result<Posed<Superellipsoid>, InvalidShape> {
    let turn = pose(r, 1.0).rotation.to_rotation_matrix().into_inner();
    let squares = Vector::from([0; 3].map(|_| r.between(1.0, 30.0)));
    let m = turn * supersurface::nalgebra::Matrix3::from_diagonal(&squares) * turn.transpose();
    let centre = Vector::from_fn(|_, _| r.between(-0.5, 0.5));
    let n = m * centre * (-2.0 * scale);
    let constant = ((m * centre).dot(&centre) - 1.0) * scale * scale;
    let q = Quadric::new([
        m[(0, 0)],
        m[(1, 1)],
        m[(2, 2)],
        2.0 * m[(0, 1)],
        2.0 * m[(1, 2)],
        2.0 * m[(0, 2)],
        n.x,
        n.y,
        n.z,
        constant,
    ])?;
    q.as_ellipsoid().ok_or(InvalidShape {
        what: "type of the quadric",
        value: 0.0,
        range: "an ellipsoid",
    })
}

pub(super) fn supershape(r: &mut Stream, scale: f64) -> Result<Supershape, InvalidShape> {
    let mut curve = |symmetries: &[f64], scale: f64| {
        let m = symmetries[r.index(symmetries.len())];
        let n = [r.between(1.0, 4.0), r.between(1.2, 8.0), r.between(1.2, 8.0)];
        // (…)^(-1/n1): lengths grow where the sum falls
        let [n1, n2, n3] = n;
        let scales = [scale.ln() * n1 / n2, scale.ln() * n1 / n3].map(f64::exp);
        Superformula::new(m, n, scales)
    };
    let longitude = curve(&[2.0, 4.0, 6.0, 8.0], 1.0)?;
    Supershape::new(longitude, curve(&[2.0, 4.0], 0.5 * scale)?)
}

pub(super) fn hyperquadric(r: &mut Stream, scale: f64) -> Result<Hyperquadric, InvalidShape> {
    let count = 3 + r.index(4);
    let mut planes = Vec::new();
    for k in 0..count {
        // the first three span space
        let normal = Vector::from_fn(|i, _| f64::from(i == k) * 2.0 + r.between(-0.7, 0.7));
        let [a, b, c] = (normal / scale).into();
        planes.push([a, b, c, r.between(-0.3, 0.3)]);
    }
    let exponents: Vec<f64> = (0..count).map(|_| r.between(1.0, 8.0)).collect();
    Hyperquadric::new(&planes, &exponents)
}

pub(super) fn extended(r: &mut Stream, scale: f64) -> Result<ExtendedSuperellipsoid, InvalidShape> {
    let axes = [0; 3].map(|_| scale * r.between(0.2, 1.0));
    let mut few = |count: usize| (0..count).map(|_| r.between(0.3, 1.8)).collect::<Vec<f64>>();
    ExtendedSuperellipsoid::new(axes, &few(4), &few(6))
}

pub(super) fn extended_radial(r: &mut Stream, scale: f64) -> Result<RadialExtended, InvalidShape> {
    Ok(extended(r, scale)?.radial())
}

pub(super) type Changed<D> = Deformed<Superellipsoid, D>;

pub(super) fn tapered(r: &mut Stream, scale: f64) -> Result<Changed<Taper>, InvalidShape> {
    let shape = stick(r, scale)?;
    let slopes = [0; 2].map(|_| r.between(-0.9, 0.9));
    Deformed::new(shape, Taper::new(slopes, shape.semi_axes()[2])?)
}

pub(super) fn twisted(r: &mut Stream, scale: f64) -> Result<Changed<Twist>, InvalidShape> {
    let shape = stick(r, scale)?;
    Deformed::new(shape, Twist::new(r.between(-0.6, 0.6), shape.semi_axes()[2])?)
}

pub(super) fn bent(r: &mut Stream, scale: f64) -> Result<Changed<Bend>, InvalidShape> {
    let shape = stick(r, scale)?;
    let [a1, a2, a3] = shape.semi_axes();
    let most = (0.8 / a1.hypot(a2)).min(2.5 / a3);
    Deformed::new(shape, Bend::new(r.between(-most, most), r.between(-3.0, 3.0))?)
}

pub(super) fn shear_bent(r: &mut Stream, scale: f64) -> Result<Changed<ShearBend>, InvalidShape> {
    let shape = stick(r, scale)?;
    let radius = scale * r.between(0.2, 2.0);
    Deformed::new(shape, ShearBend::new(if r.uniform() < 0.5 { radius } else { -radius })?)
}

pub(super) fn hollowed(r: &mut Stream, scale: f64) -> Result<Changed<Cavity>, InvalidShape> {
    let shape = stick(r, scale)?;
    Deformed::new(shape, Cavity::new(r.between(0.0, 1.6), &shape)?)
}

pub(super) fn posed(r: &mut Stream, scale: f64) -> Result<Posed<Superellipsoid>, InvalidShape> {
    let shape = stick(r, scale)?;
    Posed::new(shape, pose(r, scale))
}

/// A random pose up to about two lengths away.
pub(super) fn pose(random: &mut Stream, scale: f64) -> Pose {
    let mut vector = || Vector::from_fn(|_, _| random.normal());
    Pose::new(vector() * scale, vector())
}

/// A stick and a ball or a ring beside it, with a hole and cut by a block; every second one with a fillet.
pub(super) fn combined(r: &mut Stream, scale: f64) -> Result<CombinedSolid, InvalidShape> {
    let near = |r: &mut Stream| {
        let mut vector = |size: f64| Vector::from_fn(|_, _| size * r.between(-1.0, 1.0));
        Pose::new(vector(0.15 * scale), vector(3.0))
    };
    let body = CombinedSolid::new(Posed::new(stick(r, scale)?, near(r))?);
    let size = scale * r.between(0.1, 0.3);
    let ball = Posed::new(Superellipsoid::new([size; 3], [1.0; 2])?, near(r))?;
    let ring = Posed::new(Supertoroid::new([0.3 * size; 3], 3.0, exponents(r))?, near(r))?;
    let beside =
        if r.uniform() < 0.5 { CombinedSolid::new(ball) } else { CombinedSolid::new(ring) };
    let alphas = [Alpha::SMOOTH, Alpha::EXACT, Alpha::new(0.5)?, Alpha::new(-0.4)?];
    let alpha = alphas[r.index(alphas.len())];
    let whole = if r.uniform() < 0.5 {
        body.blend_union(beside, Blend::new(r.between(0.0, 0.2), [0.5, r.between(0.2, 1.0)])?)
    } else {
        body.union(beside, alpha)
    };
    let hole = scale * r.between(0.05, 0.1);
    let hole = Superellipsoid::new([hole, hole, scale], [exponent(r).min(1.9); 2])?;
    let block = Superellipsoid::new([0.4 * scale; 3], [0.2, exponent(r).min(1.9)])?;
    Ok(whole
        .difference(CombinedSolid::new(Posed::new(hole, near(r))?), alpha)
        .intersection(CombinedSolid::new(block), alpha))
}
