//! What is drawn by lot: kinds of things with ranges of their sizes.

use super::likeness::{bottle, bowl, hammer, mug};
use super::{Body, SceneError};
use crate::Pose;
use crate::combine::{Assembly, Part};
use crate::numeric::random::Stream;
use crate::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use crate::surface::Surface;

/// The least and the greatest value of a number that is drawn, each as likely as any between.
pub type Range = [f64; 2];

/// A kind of thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// What its bodies are called, with a number.
    pub name: String,
    /// How often it is drawn, relative to the others; not negative.
    pub weight: f64,
    /// What it looks like.
    pub likeness: Likeness,
    /// Density of each part, in kg/m³.
    pub density: Range,
    /// Coefficient of friction.
    pub friction: Range,
}

/// A shape with ranges of its parameters: lengths in metres.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Likeness {
    /// One superellipsoid, plain or deformed: the slopes of its taper are those of both directions.
    Superellipsoid {
        /// `[a1, a2, a3]`.
        semi_axes: [Range; 3],
        /// `[ε1, ε2]`.
        exponents: [Range; 2],
        /// Of the taper, in (-1, 1).
        taper: Range,
        /// Full turns from end to end.
        twist: Range,
        /// Angle between the ends, in radians, less than 2π.
        bend: Range,
    },
    /// Box, can, ball: a superellipsoid with a round section.
    Round {
        /// Of the section.
        radius: Range,
        /// From end to end.
        height: Range,
        /// ε1, that of the profile.
        exponent: Range,
        /// Of the taper, in (-1, 1).
        taper: Range,
    },
    /// Ring, roll of tape: a supertoroid that is round about z.
    Ring {
        /// Of its outer edge.
        radius: Range,
        /// Radius of the hole relative to that of the outer edge, in (0, 1).
        hole: Range,
        /// Along z.
        height: Range,
        /// ε1, that of the tube's section.
        exponent: Range,
    },
    /// Wall, bottom and handle.
    Mug {
        /// Outer radius of the wall.
        radius: Range,
        /// From the bottom to the rim.
        height: Range,
        /// Thickness of wall and bottom.
        wall: Range,
    },
    /// Body, shoulder, neck.
    Bottle {
        /// Of the body.
        radius: Range,
        /// From the bottom to the end of the neck.
        height: Range,
    },
    /// A bottom and rings that widen.
    Bowl {
        /// Of the rim.
        radius: Range,
        /// From the bottom to the rim, relative to the radius.
        depth: Range,
    },
    /// A handle and a head ten times as dense.
    Hammer {
        /// Of the handle.
        length: Range,
    },
}

/// `count` bodies drawn from the recipes, at the origin of the world. Each has its own stream of random numbers, so that
/// the first of many are those of a few.
///
/// ```
/// use supersurface::scene::{Likeness, Recipe, draw};
/// let can = Likeness::Round {
///     radius: [0.03, 0.04], height: [0.08, 0.12], exponent: [0.1, 0.2], taper: [0.0, 0.0],
/// };
/// let (density, friction) = ([300.0, 900.0], [0.4, 0.8]);
/// let recipe = Recipe { name: "can".into(), weight: 1.0, likeness: can, density, friction };
/// let bodies = draw(&[recipe], 3, 7)?;
/// assert_eq!(bodies[2].name, "can_3");
/// # Ok::<(), supersurface::scene::SceneError>(())
/// ```
pub fn draw(recipes: &[Recipe], count: usize, seed: u64) -> Result<Vec<Body>, SceneError> {
    for recipe in recipes {
        recipe.check()?;
    }
    let whole: f64 = recipes.iter().map(|r| r.weight).sum();
    InvalidShape::check(whole > 0.0, "sum of the weights", whole, "positive and finite")?;
    let one = |k: usize| {
        let mut stream = Stream::new(seed, k as u64);
        let mut rest = stream.between(0.0, whole);
        let chosen = recipes.iter().find(|r| {
            rest -= r.weight;
            rest < 0.0
        });
        // rounding may leave a bit over
        let recipe = chosen.or(recipes.iter().rfind(|r| r.weight > 0.0));
        recipe.map(|r| r.body(k + 1, &mut stream)).transpose()
    };
    (0..count).filter_map(|k| one(k).transpose()).collect()
}

impl Recipe {
    /// Fails for what no draw could use.
    fn check(&self) -> Result<(), InvalidShape> {
        let weight = self.weight >= 0.0 && self.weight.is_finite();
        InvalidShape::check(weight, "weight of a kind", self.weight, "finite and not negative")?;
        for (range, what) in [(self.density, "density"), (self.friction, "friction")] {
            let right = range[0] >= 0.0 && range[0] <= range[1] && range[1].is_finite();
            InvalidShape::check(right, what, range[0], "a range of finite numbers, not negative")?;
        }
        Ok(())
    }

    fn body(&self, number: usize, stream: &mut Stream) -> Result<Body, SceneError> {
        let mut draw = |[low, high]: Range| stream.between(low, high);
        let (density, friction) = (draw(self.density), draw(self.friction));
        let shape = self.likeness.assembly(density, &mut draw)?;
        let name = format!("{}_{number}", self.name);
        Ok(Body { name, shape, pose: Pose::identity(), friction })
    }
}

impl Likeness {
    fn assembly(
        &self,
        density: f64,
        draw: &mut impl FnMut(Range) -> f64,
    ) -> Result<Assembly<Surface>, InvalidShape> {
        let surface = match *self {
            Self::Superellipsoid { semi_axes, exponents, taper, twist, bend } => {
                let axes = semi_axes.map(&mut *draw);
                let core = Superellipsoid::new(axes, exponents.map(&mut *draw))?;
                let (slope, turns, angle) = (draw(taper), draw(twist), draw(bend));
                deformed(core, slope, turns, angle)?
            }
            Self::Round { radius, height, exponent, taper } => {
                let radius = draw(radius);
                let axes = [radius, radius, 0.5 * draw(height)];
                deformed(Superellipsoid::new(axes, [draw(exponent), 1.0])?, draw(taper), 0.0, 0.0)?
            }
            Self::Ring { radius, hole, height, exponent } => {
                let (outer, hole) = (draw(radius), draw(hole));
                let tube = 0.5 * outer * (1.0 - hole);
                let axes = [tube, tube, 0.5 * draw(height)];
                let ratio = (1.0 + hole) / (1.0 - hole);
                Surface::Supertoroid(Supertoroid::new(axes, ratio, [draw(exponent), 1.0])?)
            }
            Self::Mug { radius, height, wall } => {
                return mug(draw(radius), draw(height), draw(wall), density);
            }
            Self::Bottle { radius, height } => return bottle(draw(radius), draw(height), density),
            Self::Bowl { radius, depth } => {
                let radius = draw(radius);
                return bowl(radius, radius * draw(depth), density);
            }
            Self::Hammer { length } => return hammer(draw(length), density),
        };
        Ok(Assembly::single(Part::new("body", Posed::new(surface, Pose::identity())?, density)?))
    }
}

/// A superellipsoid with the first deformation that is one.
fn deformed(
    core: Superellipsoid,
    slope: f64,
    turns: f64,
    angle: f64,
) -> Result<Surface, InvalidShape> {
    if slope != 0.0 {
        Surface::tapered(core, [slope, slope])
    } else if turns != 0.0 {
        Surface::twisted(core, turns)
    } else if angle != 0.0 {
        Surface::bent(core, 0.5 * angle / core.semi_axes()[2], 0.0)
    } else {
        Ok(Surface::Superellipsoid(core))
    }
}
