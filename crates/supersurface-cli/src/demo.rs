//! `supersurface demo`: the whole way on a scene that the command makes itself.

use supersurface::cloud::PointCloud;
use supersurface::scene::{DepthNoise, demo, look};

use crate::args::DemoArgs;
use crate::exit::Failure;
use crate::outputs::{Run, Source};
use crate::progress::Progress;

/// Places supersurfaces on a table, looks at them with a simulated depth camera, and runs the pipeline on
/// what it saw.
pub(crate) fn run(args: &DemoArgs) -> Result<(), Failure> {
    let mut progress = Progress::new(args.output.quiet);
    progress.begin("look", "looking at a scene that was just made".into());
    let made = demo(args.seed).map_err(Failure::input)?;
    let noise = DepthNoise::default();
    let seen = look(&made.scene, &made.camera, &made.camera_pose, &noise, args.seed);
    let mut cloud = PointCloud::from_depth(&seen.depth, &made.camera);
    cloud.world = Some(made.camera_pose);
    let source = Source {
        name: format!("demo scene {}", args.seed),
        cloud,
        frame: "cloud",
        warnings: Vec::new(),
        objects: Default::default(),
    };
    Run { source, how: &args.how, output: &args.output }.run(progress)
}
