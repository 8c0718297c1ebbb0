//! The options of `supersurface fit`, checked.

use std::ffi::OsString;
use std::path::{Path, PathBuf, is_separator};

use clap::{Args, ValueEnum};
use supersurface::fit::{Completion, Family, FitOptions};
use supersurface::shape::Plane;
use supersurface::{Point, Vector};

use crate::args::Units;
use crate::exit::Failure;
use crate::input::viewpoint;
use crate::places::Places;
use crate::threads::MOST;

/// Which clouds, and what is known of them.
#[derive(Debug, Args)]
pub(crate) struct FitArgs {
    /// Clouds of one object each (.pcd, .ply, .xyz, .csv); - reads standard input.
    #[arg(required = true, value_name = "CLOUD")]
    pub(super) clouds: Vec<PathBuf>,
    /// Write each fit as JSON (fields: docs/fit.md) as soon as it is done: to this file, or for several clouds, or
    /// where OUT is a folder, to NAME.json in it.
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// Family of surfaces.
    #[arg(long, value_enum, default_value_t = Model::Auto)]
    model: Model,
    /// The clouds are single views from this place (in their frame and unit). `none`, the default: the objects were
    /// seen from all around.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    viewpoint: Option<String>,
    /// The plane on which the objects stand: A,B,C,D of Ax + By + Cz + D = 0 in the clouds' frame and unit, (A, B, C)
    /// towards the objects.
    #[arg(
        long,
        value_name = "A,B,C,D",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true
    )]
    plane: Option<Vec<f64>>,
    /// From what guess of the side that a single view hides the search begins too; the seen points decide alone.
    #[arg(long, value_enum, value_name = "BY", default_value_t = Complete::None)]
    complete: Complete,
    /// Unit of the clouds' coordinates. Results are in metres.
    #[arg(long, value_enum, default_value_t = Units::M)]
    pub(super) units: Units,
    /// Print as JSON (fields: docs/fit.md); of several clouds one object a line, in their order.
    #[arg(long)]
    pub(super) json: bool,
    /// Number of threads for several clouds; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    pub(super) threads: Option<u16>,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Families that can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
enum Model {
    /// Chosen by evidence.
    Auto,
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid,
    /// Ring, roll, rim.
    Supertoroid,
    /// Cup, cone, wedge.
    Tapered,
    /// Banana, handle.
    Bent,
    /// Sections that turn.
    Twisted,
    /// Horn.
    TaperedBent,
}

/// Guesses of the hidden side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Complete {
    /// None but a few depths.
    None,
    /// The seen points mirrored at a plane that faces the sensor.
    Mirror,
}

impl Complete {
    const fn by(self) -> Completion {
        match self {
            Self::None => Completion::Nothing,
            Self::Mirror => Completion::Mirror,
        }
    }
}

impl Model {
    const fn options(self) -> FitOptions {
        FitOptions::only(match self {
            Self::Auto => return FitOptions::ALL,
            Self::Superellipsoid => Family::Superellipsoid,
            Self::Supertoroid => Family::Supertoroid,
            Self::Tapered => Family::Tapered,
            Self::Bent => Family::Bent,
            Self::Twisted => Family::Twisted,
            Self::TaperedBent => Family::TaperedBent,
        })
    }
}

/// What is known of the clouds, in metres.
pub(super) struct Known {
    pub(super) viewpoint: Option<Point>,
    pub(super) support: Option<Plane>,
    pub(super) options: FitOptions,
}

impl FitArgs {
    pub(super) fn known(&self) -> Result<Known, Failure> {
        let metres = self.units.metres();
        let seen_from = self.viewpoint.as_deref().map(viewpoint).transpose()?.flatten();
        let seen_from = seen_from.map(|p| p * metres);
        if seen_from.is_some_and(|p| p.iter().any(|v| !v.is_finite())) {
            return Err(Failure::usage("--viewpoint: is too far away in this unit"));
        }
        let support = match self.plane.as_deref() {
            None => None,
            Some([a, b, c, d]) => {
                let normal = Vector::new(*a, *b, *c);
                let plane = Plane::new(normal, d / normal.norm() * metres);
                Some(plane.map_err(|e| Failure::usage(format!("--plane: {e}")))?)
            }
            Some(v) => {
                let problem = format!("--plane needs A,B,C,D; {} numbers were given", v.len());
                return Err(Failure::usage(problem));
            }
        };
        if self.complete == Complete::Mirror && seen_from.is_none() {
            return Err(Failure::usage("--complete mirror needs --viewpoint"));
        }
        let options = FitOptions { complete: self.complete.by(), ..self.model.options() };
        Ok(Known { viewpoint: seen_from, support, options })
    }

    /// The file of each cloud's JSON, the folder of which is made; none where none is asked for. No file is read and
    /// written, or written twice.
    pub(super) fn files(&self) -> Result<Vec<Option<PathBuf>>, Failure> {
        let count = self.clouds.len();
        if self.clouds.iter().filter(|c| is_input(c)).count() > 1 {
            return Err(Failure::usage("-: standard input can be read only once"));
        }
        let Some(out) = &self.output else { return Ok(vec![None; count]) };
        let mut places = Places::read(self.clouds.iter().map(PathBuf::as_path));
        let is_folder = out.is_dir() || out.to_string_lossy().ends_with(is_separator);
        if count == 1 && !is_folder {
            places.take("-o", out)?;
            return Ok(vec![Some(out.clone())]);
        }
        let shown = out.display();
        if out.exists() && !out.is_dir() {
            return Err(Failure::usage(format!("-o {shown}: {count} clouds need a folder")));
        }
        let files: Vec<PathBuf> = self.clouds.iter().map(|c| out.join(json_name(c))).collect();
        for (i, file) in files.iter().enumerate() {
            if let Some(k) = files[..i].iter().position(|f| f == file) {
                let [one, other] = [k, i].map(|i| self.clouds[i].display());
                let problem = format!(
                    "-o {shown}: {one} and {other} would both become {}; fit one of them apart",
                    file.display()
                );
                return Err(Failure::usage(problem));
            }
        }
        std::fs::create_dir_all(out).map_err(|e| Failure::output(format!("{shown}: {e}")))?;
        // after the folder is there, so that links to it are seen through
        files.iter().try_for_each(|file| places.take("-o", file))?;
        Ok(files.into_iter().map(Some).collect())
    }
}

fn is_input(cloud: &Path) -> bool {
    cloud == Path::new("-")
}

/// `NAME.json` of a cloud's file.
fn json_name(cloud: &Path) -> OsString {
    let stem = cloud.file_stem().filter(|_| !is_input(cloud));
    let mut name = stem.unwrap_or("standard_input".as_ref()).to_owned();
    name.push(".json");
    name
}
