//! Kinds of things as TOML, two lists built in.

use std::path::Path;

use serde::Deserialize;
use supersurface::scene::{Likeness, Range, Recipe};

use crate::error::{Fault, ReadError};
use crate::read::load;

/// Names of the lists that need no file, with their content.
pub const BUILT_IN_THINGS: [(&str, &str); 2] = [
    ("household", include_str!("../things/household.toml")),
    ("members", include_str!("../things/members.toml")),
];

/// Kinds of things by the name of a built-in list or from a file (`docs/scene.md`).
///
/// ```
/// let things = supersurface_io::read_things("household")?;
/// assert!(things.iter().any(|kind| kind.name == "mug"));
/// # Ok::<(), supersurface_io::ReadError>(())
/// ```
pub fn read_things(name_or_file: &str) -> Result<Vec<Recipe>, ReadError> {
    if let Some((name, text)) = BUILT_IN_THINGS.iter().find(|(name, _)| *name == name_or_file) {
        return parse(name, text);
    }
    let path = Path::new(name_or_file);
    let fault = |place: &str, problem: String| {
        ReadError::malformed(name_or_file, "list of things", Fault::new(place, problem))
    };
    if !path.exists() {
        let known: Vec<&str> = BUILT_IN_THINGS.iter().map(|(name, _)| *name).collect();
        let problem = format!("no such file, nor one of the built-in {}", known.join(", "));
        return Err(fault("name", problem));
    }
    let text = String::from_utf8(load(path)?)
        .map_err(|_| fault("content", "is no text (UTF-8)".to_owned()))?;
    parse(name_or_file, &text)
}

fn parse(file: &str, text: &str) -> Result<Vec<Recipe>, ReadError> {
    let fault = |place: String, problem: String| {
        ReadError::malformed(file, "list of things", Fault::new(place, problem))
    };
    let read: File = toml::from_str(text).map_err(|e| {
        let line = e.span().map_or(1, |s| text[..s.start.min(text.len())].lines().count().max(1));
        fault(format!("line {line}"), e.message().to_owned())
    })?;
    if read.kind.is_empty() {
        return Err(fault("content".into(), "has no [[kind]]".into()));
    }
    let kinds = read.kind.into_iter().enumerate();
    kinds
        .map(|(k, kind)| {
            let place = format!("kind {} ({})", k + 1, kind.name);
            kind.recipe().map_err(|problem| fault(place, problem))
        })
        .collect()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    kind: Vec<Kind>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Kind {
    name: String,
    #[serde(default = "one")]
    weight: f64,
    density: Numbers,
    friction: Numbers,
    shape: Shape,
}

const fn one() -> f64 {
    1.0
}

/// A number, or the ends of a range.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged)]
enum Numbers {
    One(f64),
    Two([f64; 2]),
}

impl Default for Numbers {
    fn default() -> Self {
        Self::One(0.0)
    }
}

impl Numbers {
    fn range(self, what: &str) -> Result<Range, String> {
        let [low, high] = match self {
            Self::One(v) => [v; 2],
            Self::Two(ends) => ends,
        };
        match low.is_finite() && high.is_finite() && low <= high {
            true => Ok([low, high]),
            false => Err(format!("{what} is [{low}, {high}]: the smaller number comes first")),
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Shape {
    Superellipsoid {
        semi_axes: [Numbers; 3],
        exponents: [Numbers; 2],
        #[serde(default)]
        taper: Numbers,
        #[serde(default)]
        twist: Numbers,
        #[serde(default)]
        bend: Numbers,
    },
    Round {
        radius: Numbers,
        height: Numbers,
        exponent: Numbers,
        #[serde(default)]
        taper: Numbers,
    },
    Ring {
        radius: Numbers,
        hole: Numbers,
        height: Numbers,
        exponent: Numbers,
    },
    Mug {
        radius: Numbers,
        height: Numbers,
        wall: Numbers,
    },
    Bottle {
        radius: Numbers,
        height: Numbers,
    },
    Bowl {
        radius: Numbers,
        depth: Numbers,
    },
    Hammer {
        length: Numbers,
    },
}

impl Kind {
    fn recipe(self) -> Result<Recipe, String> {
        let likeness = match self.shape {
            Shape::Superellipsoid {
                semi_axes: [a, b, c],
                exponents: [e1, e2],
                taper,
                twist,
                bend,
            } => Likeness::Superellipsoid {
                semi_axes: [a.range("a1")?, b.range("a2")?, c.range("a3")?],
                exponents: [e1.range("exponent ε1")?, e2.range("exponent ε2")?],
                taper: taper.range("taper")?,
                twist: twist.range("twist")?,
                bend: bend.range("bend")?,
            },
            Shape::Round { radius, height, exponent, taper } => Likeness::Round {
                radius: radius.range("radius")?,
                height: height.range("height")?,
                exponent: exponent.range("exponent")?,
                taper: taper.range("taper")?,
            },
            Shape::Ring { radius, hole, height, exponent } => Likeness::Ring {
                radius: radius.range("radius")?,
                hole: hole.range("hole")?,
                height: height.range("height")?,
                exponent: exponent.range("exponent")?,
            },
            Shape::Mug { radius, height, wall } => Likeness::Mug {
                radius: radius.range("radius")?,
                height: height.range("height")?,
                wall: wall.range("wall")?,
            },
            Shape::Bottle { radius, height } => Likeness::Bottle {
                radius: radius.range("radius")?,
                height: height.range("height")?,
            },
            Shape::Bowl { radius, depth } => {
                Likeness::Bowl { radius: radius.range("radius")?, depth: depth.range("depth")? }
            }
            Shape::Hammer { length } => Likeness::Hammer { length: length.range("length")? },
        };
        let (density, friction) =
            (self.density.range("density")?, self.friction.range("friction")?);
        Ok(Recipe { name: self.name, weight: self.weight, likeness, density, friction })
    }
}
