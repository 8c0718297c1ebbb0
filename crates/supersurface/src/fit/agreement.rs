//! How well two surfaces agree, as a found one with the true one: by their distance and by what they fill.
//!
//! The distance is the mean of the Euclidean distances of points that are uniform over the area of each surface to the
//! other one, (mean over A of d(a, B) + mean over B of d(b, A))/2. What both fill, over what either fills, is
//! `1/(1/P(B|A) + 1/P(A|B) - 1)`, with the shares of points in A that are in B and the other way round: that needs no
//! volumes, and bodies that are the same have exactly 1. A solid in place of a thick ring may be near everywhere and yet
//! fill a hole; the second number tells.
//!
//! Both are estimates from fixed random numbers: their standard deviations are about 2 % of the distance (6 % where one of
//! the bodies is deformed, from which a distance takes long) and 0.005.

use crate::Point;
use crate::measure::{ClosestFinder, NearestFinder};
use crate::mesh::{SurfaceSampler, TessellateError};
use crate::numeric::random::Stream;
use crate::shape::{Implicit, Posed};
use crate::surface::{Solid, Surface};

/// Points on each surface, the same where the other is deformed, and places in the box of each body.
const POINTS: usize = 2000;
const FEW_POINTS: usize = 200;
const PLACES: u64 = 16384;
/// Seed of both.
const SEED: u64 = 11;

/// How well two surfaces agree.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Agreement {
    /// Mean distance between the surfaces, in metres.
    pub distance: f64,
    /// Volume of the intersection over that of the union, in [0, 1].
    pub overlap: f64,
}

impl Agreement {
    /// Of two surfaces in one frame. Fails for a surface that cannot be sampled (as [`SurfaceSampler::new`]).
    ///
    /// ```
    /// use supersurface::{Pose, fit::Agreement, shape::{Posed, Superellipsoid}, surface::Surface};
    /// let ball = |r| Superellipsoid::new([r; 3], [1.0; 2]).map(Surface::Superellipsoid);
    /// let [small, large] = [ball(0.09)?, ball(0.1)?];
    /// let [small, large] = [Posed::new(small, Pose::identity())?, Posed::new(large, Pose::identity())?];
    /// let found = Agreement::of(&small, &large)?;
    /// assert!((found.distance - 0.01).abs() < 1e-6 && (found.overlap - 0.729).abs() < 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(a: &Posed<Surface>, b: &Posed<Surface>) -> Result<Self, TessellateError> {
        let distance = 0.5 * (one_sided(a, b)? + one_sided(b, a)?);
        let [in_a, in_b] = [share(a, b), share(b, a)];
        let overlap = match in_a > 0.0 && in_b > 0.0 {
            true => 1.0 / (1.0 / in_a + 1.0 / in_b - 1.0),
            false => 0.0,
        };
        Ok(Self { distance, overlap })
    }
}

/// Mean distance of the points of one surface from another, in metres.
fn one_sided(from: &Posed<Surface>, to: &Posed<Surface>) -> Result<f64, TessellateError> {
    let (from_solid, to_solid) = (Solid::from(*from.shape()), Solid::from(*to.shape()));
    let is_deformed = !matches!(to.shape(), Surface::Superellipsoid(_) | Surface::Supertoroid(_));
    let count = if is_deformed { FEW_POINTS } else { POINTS };
    let points = SurfaceSampler::new(&from_solid, None)?.points(count, SEED);
    let into = to.pose().inverse() * from.pose();
    let mean = |distance: &dyn Fn(&Point) -> f64| {
        points.iter().map(|p| distance(&(into * p.point))).sum::<f64>() / points.len() as f64
    };
    let by_chart = |finder: &ClosestFinder| {
        mean(&|p| finder.find(p).map_or(f64::INFINITY, |found| found.distance.abs()))
    };
    Ok(match to.shape() {
        Surface::Superellipsoid(s) => by_chart(&ClosestFinder::superellipsoid(s)),
        Surface::Supertoroid(s) => by_chart(&ClosestFinder::supertoroid(s)),
        _ => {
            let finder = NearestFinder::of_surface(&to_solid);
            mean(&|p| finder.find(p).map_or(f64::INFINITY, |found| found.distance.abs()))
        }
    })
}

/// Share of one body that another one fills too.
fn share(of: &Posed<Surface>, other: &Posed<Surface>) -> f64 {
    let [low, high] = of.shape().bounds();
    let (mut own, mut both) = (0.0, 0.0);
    for k in 0..PLACES {
        let mut stream = Stream::new(SEED, k);
        let at = Point::from((high - low).map(|side| side * stream.uniform())) + low.coords;
        if of.shape().contains(&at) {
            own += 1.0;
            both += f64::from(u8::from(other.contains(&(of.pose() * at))));
        }
    }
    both / f64::max(own, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Superellipsoid, Supertoroid};
    use crate::{Pose, Vector};

    #[test]
    fn what_is_the_same_agrees_and_what_is_apart_does_not() {
        let ring =
            Surface::Supertoroid(Supertoroid::new([0.01, 0.01, 0.02], 3.0, [0.4, 1.0]).unwrap());
        let tin = Superellipsoid::new([0.03, 0.03, 0.05], [0.2, 1.0]).unwrap();
        for shape in [ring, Surface::Superellipsoid(tin)] {
            let pose = Pose::new(Vector::new(0.1, -0.2, 0.7), Vector::new(0.4, 1.0, -0.3));
            let here = Posed::new(shape, pose).unwrap();
            let same = Agreement::of(&here, &here).unwrap();
            assert!(same.distance < 1e-9 && same.overlap == 1.0, "{same:?}");
            let there = here.moved(&Pose::translation(1.0, 0.0, 0.0));
            let apart = Agreement::of(&here, &there).unwrap();
            assert!(apart.overlap == 0.0 && (0.8..1.0).contains(&apart.distance), "{apart:?}");
        }
    }

    #[test]
    fn it_agrees_with_meshes_and_other_random_numbers() {
        let solid = |a, e| Surface::Superellipsoid(Superellipsoid::new(a, e).unwrap());
        let ring = Supertoroid::new([0.02, 0.015, 0.03], 2.5, [1.5, 0.4]).unwrap();
        let tin = Superellipsoid::new([0.03, 0.03, 0.05], [0.2, 1.0]).unwrap();
        let leans = Vector::y() * 0.1;
        // means over 40,000 points of each surface to fine meshes of the other, and 400,000 places in each body
        for (truth, found, at, turn, distance, overlap) in [
            (
                solid([0.05, 0.03, 0.08], [0.3, 1.2]),
                solid([0.055, 0.03, 0.075], [0.5, 0.8]),
                Vector::new(0.002, 0.0, 0.0),
                leans,
                4.133e-3,
                0.7678,
            ),
            (
                Surface::Supertoroid(ring),
                solid([0.07, 0.05, 0.03], [0.2, 0.5]),
                Vector::zeros(),
                leans,
                6.433e-3,
                0.5387,
            ),
            (
                Surface::tapered(tin, [0.3, 0.1]).unwrap(),
                Surface::Superellipsoid(tin),
                Vector::zeros(),
                Vector::zeros(),
                2.342e-3,
                0.8247,
            ),
        ] {
            let truth = Posed::new(truth, Pose::identity()).unwrap();
            let found = Posed::new(found, Pose::new(at, turn)).unwrap();
            let agreement = Agreement::of(&found, &truth).unwrap();
            let off = agreement.distance / distance - 1.0;
            assert!(off.abs() < 0.1, "{agreement:?}, {distance}");
            assert!((agreement.overlap - overlap).abs() < 0.015, "{agreement:?}, {overlap}");
        }
    }

    #[test]
    fn a_hole_that_is_filled_shows() {
        let pose = Pose::identity();
        let ring = Supertoroid::new([0.02; 3], 1.5, [0.1, 1.0]).unwrap();
        let disc = Superellipsoid::new([0.05, 0.05, 0.02], [0.1, 1.0]).unwrap();
        let ring = Posed::new(Surface::Supertoroid(ring), pose).unwrap();
        let disc = Posed::new(Surface::Superellipsoid(disc), pose).unwrap();
        let found = Agreement::of(&ring, &disc).unwrap();
        // the hole's radius is a fifth of the disc's
        assert!((found.overlap - 0.96).abs() < 0.01 && found.distance < 0.003, "{found:?}");
    }
}
