//! What `supersurface scene` can be told.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use supersurface::scene::{DepthNoise, Layout};
use supersurface_io::SceneFormat;

use crate::threads::MOST;

#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    #[command(subcommand)]
    pub(super) command: SceneCommand,
}

#[derive(Debug, Subcommand)]
pub(super) enum SceneCommand {
    /// Draws things, lets them fall until they lie still, looks at them and writes all of it.
    Random(RandomArgs),
    /// Many such scenes for training. What a run that was cut off left is kept and completed by the next.
    Dataset(DatasetArgs),
    /// Closes the loop: makes single things, looks at them, finds and fits them, and says how many come back as they are.
    Recover(RecoverArgs),
}

#[derive(Debug, Args)]
pub(super) struct RandomArgs {
    #[command(flatten)]
    pub(super) make: MakeArgs,
    /// The same seed gives the same files.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Folder for the scene; it is made where it is missing.
    #[arg(long, short, value_name = "FOLDER")]
    pub(super) output: PathBuf,
    /// Number of threads; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    pub(super) threads: Option<u16>,
    /// Print scene.json instead of a table.
    #[arg(long)]
    pub(super) json: bool,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

#[derive(Debug, Args)]
pub(super) struct DatasetArgs {
    #[command(flatten)]
    pub(super) make: MakeArgs,
    /// Number of scenes.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) scenes: u32,
    /// Seed of the first scene; the others follow.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Folder for the scenes, a new one or one of the same data set.
    #[arg(long, short, value_name = "FOLDER")]
    pub(super) output: PathBuf,
    /// Number of threads; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    pub(super) threads: Option<u16>,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

#[derive(Debug, Args)]
pub(super) struct RecoverArgs {
    /// Number of scenes, each of one thing.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) scenes: u32,
    /// Seed of the first scene; the others follow.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// What is drawn: a TOML file (docs/scene.md), or members. Things have one part each.
    #[arg(long, value_name = "NAME|FILE", default_value = "members")]
    pub(super) things: String,
    #[command(flatten)]
    pub(super) noise: NoiseArgs,
    /// Folder for the truth and the result of each scene, and for views of those that were missed.
    #[arg(long, short, value_name = "FOLDER")]
    pub(super) output: Option<PathBuf>,
    /// Number of threads; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    pub(super) threads: Option<u16>,
    /// Print the report as JSON (fields: docs/scene.md) instead of a table.
    #[arg(long)]
    pub(super) json: bool,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// How a scene is made.
#[derive(Debug, Args)]
pub(super) struct MakeArgs {
    /// Number of bodies.
    #[arg(long, short = 'n', value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(super) count: u16,
    /// How they lie; single takes one body (-n 1).
    #[arg(long, value_enum, default_value_t = How::Pile)]
    pub(super) layout: How,
    /// What is drawn: a TOML file (docs/scene.md), or household, members.
    #[arg(long, value_name = "NAME|FILE", default_value = "household")]
    pub(super) things: String,
    /// What the scene is written as, beside our own JSON: all, or some of mjcf, urdf, sdf, usda, glb, obj, stl, ply.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    pub(super) formats: Vec<Format>,
    /// Views of the scene, evenly around it; each is a folder of images, a cloud and a camera.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(0..=360))]
    pub(super) views: u16,
    #[command(flatten)]
    pub(super) noise: NoiseArgs,
    /// Plan grasps of this gripper on what the views show, and write the best of each body as sites: a built-in one or a
    /// TOML file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) gripper: Option<String>,
}

/// How the depth camera errs.
#[derive(Debug, Args)]
pub(super) struct NoiseArgs {
    /// How the depth camera errs.
    #[arg(long, value_enum, default_value_t = Noise::Realsense)]
    pub(super) noise: Noise,
    /// Standard deviation of --noise gaussian, in metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.001)]
    pub(super) deviation: f64,
}

impl NoiseArgs {
    pub(super) fn model(&self) -> DepthNoise {
        match self.noise {
            Noise::None => DepthNoise::none(),
            Noise::Gaussian => DepthNoise::gaussian(self.deviation),
            Noise::KinectV1 => DepthNoise::kinect_v1(),
            Noise::AzureKinect => DepthNoise::azure_kinect(),
            Noise::Realsense => DepthNoise::realsense(),
        }
    }
}

/// How bodies lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum How {
    /// One body alone on a table.
    Single,
    /// Tipped into a bin.
    Pile,
    /// Upright beside each other on a table.
    Packed,
    /// Upright on the boards of a shelf.
    Shelf,
}

impl How {
    pub(super) const fn layout(self) -> Layout {
        match self {
            Self::Single => Layout::Single,
            Self::Pile => Layout::Pile,
            Self::Packed => Layout::Packed,
            Self::Shelf => Layout::Shelf,
        }
    }
}

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Every kind.
    All,
    /// MuJoCo.
    Mjcf,
    /// ROS, PyBullet, Drake.
    Urdf,
    /// Gazebo.
    Sdf,
    /// `OpenUSD`, Isaac Sim.
    Usda,
    /// glTF, for viewers.
    Glb,
    /// A mesh of each part.
    Obj,
    /// The same as binary STL.
    Stl,
    /// The same as binary PLY.
    Ply,
}

/// The kinds of files that were asked for; our own JSON is always one.
pub(super) fn formats(asked: &[Format]) -> Vec<SceneFormat> {
    if asked.contains(&Format::All) {
        return SceneFormat::ALL.to_vec();
    }
    let mut formats = vec![SceneFormat::Json];
    formats.extend(asked.iter().filter_map(|format| {
        Some(match format {
            Format::All => return None,
            Format::Mjcf => SceneFormat::Mjcf,
            Format::Urdf => SceneFormat::Urdf,
            Format::Sdf => SceneFormat::Sdf,
            Format::Usda => SceneFormat::Usda,
            Format::Glb => SceneFormat::Glb,
            Format::Obj => SceneFormat::Obj,
            Format::Stl => SceneFormat::Stl,
            Format::Ply => SceneFormat::Ply,
        })
    }));
    formats
}

/// Depth cameras.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Noise {
    /// Exact depths.
    None,
    /// Normal errors of --deviation.
    Gaussian,
    /// Kinect of 2010: structured light.
    KinectV1,
    /// Azure Kinect: time of flight.
    AzureKinect,
    /// RealSense D415: stereo.
    Realsense,
}
