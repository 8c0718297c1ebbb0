//! How a shape is said on the command line: a file, JSON itself, or flags, all read as the same JSON.

use std::path::Path;

use clap::Args;
use supersurface_io::{Model, parse_shape, read_shape, shown_name};

use crate::exit::Failure;

/// The name for messages of a shape that no file has.
const COMMAND_LINE: &str = "the shape on the command line";

/// Which shape.
#[derive(Debug, Args)]
#[group(skip)]
pub(crate) struct ShapeArgs {
    /// Shape as a JSON file, - for standard input, or JSON itself: '{"type": "superellipsoid", ...}' (docs/shape.md
    /// has all types).
    #[arg(required_unless_present_any = ["superellipsoid", "supertoroid"])]
    shape: Option<String>,
    /// A superellipsoid: semi-axes in metres and exponents.
    #[arg(
        long,
        value_name = "A1,A2,A3,E1,E2",
        value_delimiter = ',',
        num_args = 1,
        conflicts_with = "shape"
    )]
    superellipsoid: Option<Vec<f64>>,
    /// A supertoroid: semi-axes of the tube in metres, ring ratio, exponents.
    #[arg(
        long,
        value_name = "A1,A2,A3,A4,E1,E2",
        value_delimiter = ',',
        num_args = 1,
        conflicts_with_all = ["shape", "superellipsoid"]
    )]
    supertoroid: Option<Vec<f64>>,
    /// A dish of this depth in its upper side, in half heights, in [0, 2).
    #[arg(long, value_name = "C", conflicts_with = "shape")]
    cavity: Option<f64>,
    /// Sections grow by these shares from the middle to the top, and shrink to the bottom.
    #[arg(
        long,
        value_name = "KX,KY",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true,
        conflicts_with = "shape"
    )]
    taper: Option<Vec<f64>>,
    /// Full turns from bottom to top.
    #[arg(long, value_name = "TURNS", allow_hyphen_values = true, conflicts_with = "shape")]
    twist: Option<f64>,
    /// Curvature of the bent z axis in 1/m, and the angle of the plane of the bend from the xz plane in radians.
    #[arg(
        long,
        value_name = "K[,ANGLE]",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true,
        conflicts_with = "shape"
    )]
    bend: Option<Vec<f64>>,
}

impl ShapeArgs {
    /// The name for messages.
    pub(crate) fn name(&self) -> String {
        self.shape.as_deref().map_or_else(|| COMMAND_LINE.into(), named)
    }

    /// Fails when a file to be written is the one that is read.
    pub(crate) fn is_not(&self, output: &Path) -> Result<(), Failure> {
        let input = self.shape.as_ref().and_then(|s| Path::new(s).canonicalize().ok());
        match input.is_some() && input == output.canonicalize().ok() {
            true => Err(Failure::usage(format!("{}: is the input", output.display()))),
            false => Ok(()),
        }
    }

    /// The shape.
    pub(crate) fn model(&self) -> Result<Model, Failure> {
        match &self.shape {
            Some(shape) => read(shape),
            None => parse_shape(COMMAND_LINE, self.json()?.as_bytes()).map_err(Failure::input),
        }
    }

    /// The flags as a shape file, deformations in the order cavity, taper, twist, bend.
    fn json(&self) -> Result<String, Failure> {
        let shape = match (&self.superellipsoid, &self.supertoroid) {
            (Some(v), _) => {
                let [a1, a2, a3, e1, e2] = numbers("--superellipsoid", v)?;
                format!(
                    r#""type": "superellipsoid", "semi_axes": [{a1}, {a2}, {a3}], "exponents": [{e1}, {e2}]"#
                )
            }
            (None, Some(v)) => {
                let [a1, a2, a3, a4, e1, e2] = numbers("--supertoroid", v)?;
                format!(
                    r#""type": "supertoroid", "semi_axes": [{a1}, {a2}, {a3}], "ring_ratio": {a4}, "exponents": [{e1}, {e2}]"#
                )
            }
            (None, None) => return Err(Failure::usage("no shape")),
        };
        let mut list = Vec::new();
        if let Some(depth) = self.cavity {
            let [depth] = numbers("--cavity", &[depth])?;
            list.push(format!(r#"{{"type": "cavity", "depth": {depth}}}"#));
        }
        if let Some(slopes) = &self.taper {
            let [kx, ky] = numbers("--taper", slopes)?;
            list.push(format!(r#"{{"type": "taper", "slopes": [{kx}, {ky}]}}"#));
        }
        if let Some(turns) = self.twist {
            let [turns] = numbers("--twist", &[turns])?;
            list.push(format!(r#"{{"type": "twist", "turns": {turns}}}"#));
        }
        if let Some(bend) = &self.bend {
            let padded = if bend.len() == 1 { vec![bend[0], 0.0] } else { bend.clone() };
            let [k, angle] = numbers("--bend", &padded)?;
            list.push(format!(r#"{{"type": "bend", "curvature": {k}, "angle": {angle}}}"#));
        }
        Ok(format!(r#"{{{shape}, "deformations": [{}]}}"#, list.join(", ")))
    }
}

/// The name for messages of a shape that is said by a file, by - or by JSON itself.
pub(crate) fn named(shape: &str) -> String {
    match shape {
        _ if is_json(shape) => COMMAND_LINE.into(),
        file => shown_name(file.as_ref()),
    }
}

/// Such a shape.
pub(crate) fn read(shape: &str) -> Result<Model, Failure> {
    let read = match is_json(shape) {
        true => parse_shape(COMMAND_LINE, shape.as_bytes()),
        false => read_shape(shape.as_ref()),
    };
    read.map_err(Failure::input)
}

/// True for JSON itself, not the name of a file.
pub(crate) fn is_json(text: &str) -> bool {
    text.trim_start().starts_with('{')
}

/// So many finite numbers, no more and no fewer, as JSON has them.
fn numbers<const N: usize>(flag: &str, given: &[f64]) -> Result<[String; N], Failure> {
    let wrong = |what: String| Failure::usage(format!("{flag}: {what}"));
    let values: [f64; N] =
        given.try_into().map_err(|_| wrong(format!("{} numbers, {N} needed", given.len())))?;
    match values.iter().find(|v| !v.is_finite()) {
        Some(v) => Err(wrong(format!("{v} is no finite number"))),
        // with all digits, and no integer that JSON would take for another type
        None => Ok(values.map(|v| format!("{v:e}"))),
    }
}

/// Three numbers of a flag.
pub(crate) fn triple(flag: &str, given: &[f64]) -> Result<[f64; 3], Failure> {
    given
        .try_into()
        .map_err(|_| Failure::usage(format!("{flag}: {} numbers, 3 needed", given.len())))
}
