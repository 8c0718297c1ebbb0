//! The options of `supersurface fit`, checked.

use std::ffi::OsString;
use std::path::{Path, PathBuf, is_separator};

use clap::{Args, ValueEnum};
use supersurface::fit::{Completion, Family, FitOptions, PoseError};
use supersurface::shape::Plane;
use supersurface::{Point, Pose, Vector};

use crate::args::Units;
use crate::exit::Failure;
use crate::input::{pose, viewpoint};
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
    /// seen from all around. With --merge once for all, or once for each.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    viewpoint: Vec<String>,
    /// The clouds are views of one object: one surface for all.
    #[arg(long)]
    pub(super) merge: bool,
    /// Pose of a view's frame in one that all share, once for each in their order: X,Y,Z,QW,QX,QY,QZ or the 16 numbers of a
    /// matrix, row by row. Without, the clouds are in one frame.
    #[arg(long, value_name = "POSE", requires = "merge", allow_hyphen_values = true)]
    pose: Vec<String>,
    /// How far the poses of all views but the first may be off (standard deviations): the views are moved to agree.
    #[arg(long, value_name = "LENGTH,DEGREES", requires = "merge", allow_hyphen_values = true)]
    pose_error: Option<String>,
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
    /// Of each cloud, in its own frame.
    pub(super) viewpoints: Vec<Option<Point>>,
    /// Of each cloud; empty where all are in one frame.
    pub(super) poses: Vec<Pose>,
    pub(super) pose_error: PoseError,
    pub(super) support: Option<Plane>,
    pub(super) options: FitOptions,
}

impl FitArgs {
    pub(super) fn known(&self) -> Result<Known, Failure> {
        let metres = self.units.metres();
        let viewpoints = self.for_each("--viewpoint", &self.viewpoint, |text| {
            let seen_from = viewpoint(text)?.map(|p| p * metres);
            if seen_from.is_some_and(|p| p.iter().any(|v| !v.is_finite())) {
                return Err(Failure::usage("--viewpoint: is too far away in this unit"));
            }
            Ok(seen_from)
        })?;
        let poses = match &self.pose[..] {
            [] => Vec::new(),
            all if all.len() == self.clouds.len() => {
                all.iter().map(|text| self.pose(text)).collect::<Result<_, _>>()?
            }
            all => {
                let counts = format!("{} are given for {} clouds", all.len(), self.clouds.len());
                return Err(Failure::usage(format!("--pose: {counts}; each needs one")));
            }
        };
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
        let pose_error =
            self.pose_error.as_deref().map(|text| self.pose_error(text)).transpose()?;
        if self.complete == Complete::Mirror && viewpoints.iter().all(Option::is_none) {
            return Err(Failure::usage("--complete mirror needs --viewpoint"));
        }
        Ok(Known {
            viewpoints,
            poses,
            pose_error: pose_error.unwrap_or(PoseError::NONE),
            support,
            options: FitOptions { complete: self.complete.by(), ..self.model.options() },
        })
    }

    /// What each cloud was given by an option: the one value of all, or its own where they are merged.
    fn for_each<T: Clone + Default>(
        &self,
        option: &str,
        given: &[String],
        parse: impl Fn(&str) -> Result<T, Failure>,
    ) -> Result<Vec<T>, Failure> {
        let count = self.clouds.len();
        let values: Vec<T> = given.iter().map(|text| parse(text)).collect::<Result<_, _>>()?;
        match &values[..] {
            [] => Ok(vec![T::default(); count]),
            [one] => Ok(vec![one.clone(); count]),
            all if self.merge && all.len() == count => Ok(values),
            all => {
                let problem = format!("{option}: given {} times for {count} clouds", all.len());
                let mend = "give it once, or with --merge once for each";
                Err(Failure::usage(format!("{problem}; {mend}")))
            }
        }
    }

    fn pose(&self, text: &str) -> Result<Pose, Failure> {
        let mut found = pose("--pose", &numbers("--pose", text)?)?;
        found.translation.vector *= self.units.metres();
        Ok(found)
    }

    fn pose_error(&self, text: &str) -> Result<PoseError, Failure> {
        match numbers("--pose-error", text)?[..] {
            [shift, degrees] if shift >= 0.0 && (0.0..=180.0).contains(&degrees) => {
                Ok(PoseError { shift: shift * self.units.metres(), turn: degrees.to_radians() })
            }
            _ => Err(Failure::usage(format!(
                "--pose-error {text:?}: LENGTH,DEGREES, both at least 0"
            ))),
        }
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
        if (count == 1 || self.merge) && !is_folder {
            places.take("-o", out)?;
            return Ok(vec![Some(out.clone()); count]);
        }
        let shown = out.display();
        if out.exists() && !out.is_dir() {
            return Err(Failure::usage(format!("-o {shown}: {count} clouds need a folder")));
        }
        let named = if self.merge { &self.clouds[..1] } else { &self.clouds };
        let files: Vec<PathBuf> = named.iter().map(|c| out.join(json_name(c))).collect();
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

fn numbers(option: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    let finite = numbers.filter(|all| all.iter().all(|v: &f64| v.is_finite()));
    finite.ok_or_else(|| Failure::usage(format!("{option} {text:?}: numbers with commas between")))
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
