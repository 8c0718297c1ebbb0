//! One scene: things drawn by lot, at rest, seen by a camera, as files in a folder.

use std::fs;
use std::path::{Path, PathBuf};

use supersurface::camera::Camera;
use supersurface::grasp::Gripper;
use supersurface::scene::{Layout, Look, Recipe, Scene, arrange, draw, turntable, visibility};
use supersurface_io::{
    SceneCamera, SceneExtras, read_gripper, read_things, write_scene, write_view,
};
use supersurface_physics::{SettleOptions, Settled, settle_scene};

use super::args::{MakeArgs, NoiseArgs, formats};
use super::sites::Grasps;
use super::touches::touches;
use crate::exit::Failure;

/// Pixels and focal length of the depth camera.
const SIZE: [usize; 2] = [640, 480];
const FOCAL: f64 = 615.0;

/// What was made.
pub(super) struct Made {
    pub(super) scene: Scene,
    pub(super) settled: Settled,
    /// The share of each body that any view shows of it.
    pub(super) shares: Vec<f64>,
    pub(super) files: Vec<PathBuf>,
    pub(super) warnings: Vec<String>,
}

/// What things are drawn from, once the other arguments are right.
pub(super) fn recipes(things: &str, noise: &NoiseArgs) -> Result<Vec<Recipe>, Failure> {
    if !(noise.deviation >= 0.0 && noise.deviation.is_finite()) {
        let given = noise.deviation;
        return Err(Failure::usage(format!(
            "--deviation {given}: must be finite and not negative"
        )));
    }
    read_things(things).map_err(Failure::input)
}

/// What files say that the arguments name.
pub(super) struct Given {
    pub(super) things: Vec<Recipe>,
    pub(super) gripper: Option<Gripper>,
}

/// Reads the files that the arguments name, once the others are right.
pub(super) fn given(args: &MakeArgs) -> Result<Given, Failure> {
    let things = recipes(&args.things, &args.noise)?;
    if args.gripper.is_some() && args.views == 0 {
        let problem = "--gripper plans on what a view shows, and there is none: --views 1 or more";
        return Err(Failure::usage(problem.to_owned()));
    }
    let gripper = args.gripper.as_deref().map(read_gripper).transpose().map_err(Failure::input)?;
    Ok(Given { things, gripper })
}

/// Makes a folder where it is missing.
pub(super) fn folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|e| Failure::output(format!("{}: {e}", path.display())))
}

/// Things drawn by lot where they came to rest.
pub(super) fn settled(
    things: &[Recipe],
    count: u16,
    layout: Layout,
    seed: u64,
) -> Result<(Scene, Settled), Failure> {
    let bodies = draw(things, count.into(), seed).map_err(Failure::input)?;
    let mut scene = arrange(bodies, layout, seed).map_err(Failure::input)?;
    let settled = settle_scene(&mut scene, &SettleOptions::default()).map_err(Failure::input)?;
    Ok((scene, settled))
}

/// The camera that looks.
pub(super) fn depth_camera() -> Result<Camera, Failure> {
    let middle = SIZE.map(|n| 0.5 * (n as f64 - 1.0));
    Camera::new(SIZE, [FOCAL; 2], middle).map_err(Failure::input)
}

/// Makes the scene of a seed in a folder; `say` is told what is being done.
pub(super) fn make(
    args: &MakeArgs,
    given: &Given,
    seed: u64,
    output: &Path,
    mut say: impl FnMut(&'static str, String),
) -> Result<Made, Failure> {
    say("settle", format!("letting {} bodies fall", args.count));
    let (mut scene, settled) = settled(&given.things, args.count, args.layout.layout(), seed)?;
    let mut warnings = Vec::new();
    for (body, rest) in scene.bodies.iter().zip(&settled.bodies) {
        if rest.lost {
            warnings.push(format!("{} fell off: it is left out", body.name));
        } else if !rest.at_rest {
            warnings.push(format!("{} still moves", body.name));
        }
    }
    let mut kept = settled.bodies.iter();
    scene.bodies.retain(|_| kept.next().is_none_or(|rest| !rest.lost));
    let camera = depth_camera()?;
    let noise = args.noise.model();
    let (mut cameras, mut shares) = (Vec::new(), vec![0f64; scene.bodies.len()]);
    let mut grasps = given.gripper.as_ref().map(|gripper| Grasps::new(gripper, &scene));
    let mut seen = Look::blank(&camera);
    for (k, pose) in turntable(&scene, &camera, args.views.into()).into_iter().enumerate() {
        let name = format!("view_{k:03}");
        say("look", format!("looking: view {} of {}", k + 1, args.views));
        seen.again(&scene, &camera, &pose, &noise, seed.wrapping_add(k as u64));
        let place = output.join(&name);
        folder(&place)?;
        write_view(&place, &seen, &camera, &pose).map_err(Failure::output)?;
        if let Some(grasps) = &mut grasps {
            grasps.add(&seen, &camera, &pose);
        }
        let shown = visibility(&scene, &camera, &pose);
        shares.iter_mut().zip(shown).for_each(|(most, share)| *most = most.max(share));
        cameras.push(SceneCamera { name, camera: camera.clone(), pose });
    }
    say("write", format!("writing {}", output.display()));
    let sites = grasps.map_or_else(Vec::new, |grasps| grasps.sites(&scene));
    let extras = SceneExtras { cameras, sites, touches: touches(&scene) };
    let files =
        write_scene(output, &scene, &extras, &formats(&args.formats)).map_err(Failure::output)?;
    Ok(Made { scene, settled, shares, files, warnings })
}
