//! `supersurface demo`: the whole way on a scene that the command makes itself.

use supersurface::cloud::PointCloud;
use supersurface::pipeline::Objects;
use supersurface::scene::{DepthNoise, demo, look};

use crate::args::DemoArgs;
use crate::exit::Failure;
use crate::outputs::{Grasping, Run, Source};

/// Places supersurfaces on a table, looks at them with a simulated depth camera, and runs the pipeline on
/// what it saw.
pub(crate) fn run(args: &DemoArgs) -> Result<(), Failure> {
    let name = format!("demo scene {}", args.seed);
    let stage = ("look", "looking at a scene that was just made".into());
    let grasping = Some(Grasping::of(&args.how, &args.output));
    let (fit, output) = (&args.how.fit, &args.output.plain);
    Run { fit, output, grasping, name: &name, inputs: &[] }.run(stage, || source(args.seed))
}

fn source(seed: u64) -> Result<Source, Failure> {
    let made = demo(seed).map_err(Failure::input)?;
    let seen = look(&made.scene, &made.camera, &made.camera_pose, &DepthNoise::default(), seed);
    let mut cloud = PointCloud::from_depth(&seen.depth, &made.camera);
    cloud.world = Some(made.camera_pose);
    Ok(Source { cloud, frame: "cloud", warnings: Vec::new(), objects: Objects::Find })
}
