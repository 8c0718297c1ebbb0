//! The command line: what can be said, and the help that explains it.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use supersurface::fit::Family;

use crate::contact::ContactArgs;
use crate::fit::FitArgs;
use crate::gallery::GalleryArgs;
use crate::scene::SceneArgs;
use crate::shape::{InfoArgs, MeshArgs, SampleArgs};
use crate::threads::MOST;

/// Recovers the objects of a depth camera's cloud as superellipsoids and supertoroids, and plans grasps.
///
/// Exit status: 0 done, 2 wrong use, 3 unreadable input, 4 nothing found (no table, nothing on it, no
/// surface), 5 output failed.
#[derive(Debug, Parser)]
#[command(name = "supersurface", version, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Objects and grasps of a cloud or depth image.
    Grasp(Box<GraspArgs>),
    /// The same without grasps: the table, the objects, which points they have.
    Segment(Box<SegmentArgs>),
    /// The same on a table scene that the command makes itself.
    Demo(DemoArgs),
    /// The surface of each cloud of one object.
    Fit(Box<FitArgs>),
    /// How far apart two convex bodies are, or how deep in each other.
    Contact(ContactArgs),
    /// Makes scenes for simulators and for training.
    Scene(SceneArgs),
    /// Draws the figures that explain the family.
    Gallery(GalleryArgs),
    /// What a shape is: size, volume, mass.
    Info(InfoArgs),
    /// A watertight triangle mesh of a shape.
    Mesh(MeshArgs),
    /// Points on a shape, as a scanner might give them.
    Sample(SampleArgs),
}

/// What to read and how to read it.
#[derive(Debug, Args)]
pub(crate) struct InputArgs {
    /// Cloud (.pcd, .ply, .xyz, .csv) or 16-bit depth image (.png); - reads standard input.
    pub(crate) input: PathBuf,
    /// Intrinsics of a depth image: a JSON file with width, height, fx, fy, cx, cy, depth_scale
    /// (units a metre), optionally the distortion D.
    #[arg(long, value_name = "FILE", conflicts_with = "intrinsics")]
    pub(crate) camera: Option<PathBuf>,
    /// Intrinsics of a depth image in pixels, instead of --camera.
    #[arg(
        long,
        value_name = "FX,FY,CX,CY",
        value_delimiter = ',',
        num_args = 1,
        requires = "depth_scale"
    )]
    pub(crate) intrinsics: Option<Vec<f64>>,
    /// Units of the depth image a metre: 1000 for millimetres.
    #[arg(long, value_name = "UNITS")]
    pub(crate) depth_scale: Option<f64>,
    /// Lens distortion k1,k2,p1,p2,k3,k4,k5,k6 (at most 8; the last may be left out), with --intrinsics.
    #[arg(
        long,
        value_name = "D",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true,
        requires = "intrinsics"
    )]
    pub(crate) distortion: Option<Vec<f64>>,
    /// Unit of the cloud's coordinates.
    #[arg(long, value_enum, default_value_t = Units::M)]
    pub(crate) units: Units,
    /// Pose of the cloud's frame in the robot's frame: X,Y,Z,QW,QX,QY,QZ (metres, unit quaternion) or
    /// the 16 numbers of a matrix, row by row. All results are then in the robot's frame.
    #[arg(
        long,
        value_name = "POSE",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true
    )]
    pub(crate) camera_pose: Option<Vec<f64>>,
    /// Where the sensor stood, in the cloud's frame and metres; `none` for an object seen from all around
    /// (the table is then still looked for as if from the origin). The default is the origin of the cloud's
    /// frame.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(crate) viewpoint: Option<String>,
    /// The cloud is one object already: look for no table.
    #[arg(long, conflicts_with_all = ["instances", "mask"])]
    pub(crate) segmented: bool,
    /// Use this field of the cloud as a given segmentation: 0 is background, each other value an object.
    #[arg(long, value_name = "FIELD", conflicts_with = "mask")]
    pub(crate) instances: Option<String>,
    /// Use this image (8 or 16 bits, as large as the cloud) as a given segmentation.
    #[arg(long, value_name = "FILE")]
    pub(crate) mask: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct GraspArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    pub(crate) how: HowArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct SegmentArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    pub(crate) fit: FitHowArgs,
    #[command(flatten)]
    pub(crate) output: PlainOutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Which scene is made.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) how: HowArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

/// How to fit and to grasp.
#[derive(Debug, Args)]
pub(crate) struct HowArgs {
    /// Gripper: a TOML file, or panda_hand, robotiq_2f85, suction_cup_30.
    #[arg(long, value_name = "NAME|FILE", default_value = "panda_hand")]
    pub(crate) gripper: String,
    #[command(flatten)]
    pub(crate) fit: FitHowArgs,
}

/// How to fit.
#[derive(Debug, Args)]
pub(crate) struct FitHowArgs {
    /// Family of surfaces.
    #[arg(long, value_enum, default_value_t = Model::Auto)]
    pub(crate) model: Model,
    /// Number of threads; results do not depend on it. Fewer are used where the system starts no more.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    pub(crate) threads: Option<u16>,
}

/// Where results go. Everything but results goes to standard error.
#[derive(Debug, Args)]
pub(crate) struct PlainOutputArgs {
    /// Print the report as JSON (fields: docs/report.md) instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
    /// Write the object of each point as an int32 .npy: 0 background, -1 unassigned, k object k.
    #[arg(long, value_name = "FILE")]
    pub(crate) labels: Option<PathBuf>,
    /// Draw the cloud, the surfaces and the best grasps, if there are any.
    #[arg(long, value_name = "FILE")]
    pub(crate) png: Option<PathBuf>,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// The same with grasps.
#[derive(Debug, Args)]
pub(crate) struct OutputArgs {
    #[command(flatten)]
    pub(crate) plain: PlainOutputArgs,
    /// Grasps an object that are printed.
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub(crate) top: usize,
    /// Write the grasps of all objects, up to 20 of each, as JSON, best first.
    #[arg(long, value_name = "FILE")]
    pub(crate) grasps: Option<PathBuf>,
}

/// Units of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Units {
    /// Metres.
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
    /// Tenths of millimetres.
    #[value(name = "0.1mm")]
    TenthMm,
    /// Micrometres.
    Um,
    /// Kilometres.
    Km,
}

impl Units {
    /// Metres a unit.
    pub(crate) const fn metres(self) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 1e-2,
            Self::Mm => 1e-3,
            Self::TenthMm => 1e-4,
            Self::Um => 1e-6,
            Self::Km => 1e3,
        }
    }
}

/// Families of which grasp tables know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Model {
    /// Chosen by evidence.
    Auto,
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid,
    /// Ring, roll, rim.
    Supertoroid,
}

impl Model {
    pub(crate) const fn family(self) -> Option<Family> {
        match self {
            Self::Auto => None,
            Self::Superellipsoid => Some(Family::Superellipsoid),
            Self::Supertoroid => Some(Family::Supertoroid),
        }
    }
}
