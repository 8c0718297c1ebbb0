//! `supersurface scene random`: things drawn by lot, at rest, seen by a camera, as files.

use std::fs;
use std::path::Path;

use supersurface::camera::Camera;
use supersurface::scene::{Scene, arrange, draw, look, turntable, visibility};
use supersurface_io::{SceneCamera, SceneExtras, read_things, write_scene, write_view};
use supersurface_physics::{SettleOptions, settle_scene};

use super::args::{RandomArgs, formats};
use super::text::text;
use super::touches::touches;
use crate::exit::{Failure, print};
use crate::progress::Progress;
use crate::threads;

/// Pixels and focal length of the depth camera.
const SIZE: [usize; 2] = [640, 480];
const FOCAL: f64 = 615.0;

pub(super) fn run(args: &RandomArgs) -> Result<(), Failure> {
    if !(args.deviation >= 0.0 && args.deviation.is_finite()) {
        let given = args.deviation;
        return Err(Failure::usage(format!(
            "--deviation {given}: must be finite and not negative"
        )));
    }
    let mut progress = Progress::new(args.quiet);
    let (pool, fewer) = threads::pool(args.threads)?;
    if let Some(warning) = fewer {
        progress.warn(&warning);
    }
    let things = read_things(&args.things).map_err(Failure::input)?;
    // before the long work, so that a folder that cannot be made is known at once
    folder(&args.output)?;
    progress.begin("draw", format!("drawing {} bodies", args.count));
    let bodies = draw(&things, args.count.into(), args.seed).map_err(Failure::input)?;
    let mut scene = arrange(bodies, args.layout.layout(), args.seed).map_err(Failure::input)?;
    progress.begin("settle", "letting them fall".to_owned());
    let settled = settle_scene(&mut scene, &SettleOptions::default()).map_err(Failure::input)?;
    for (body, rest) in scene.bodies.iter().zip(&settled.bodies) {
        if rest.lost {
            progress.warn(&format!("{} fell off: it is left out", body.name));
        } else if !rest.at_rest {
            progress.warn(&format!("{} still moves", body.name));
        }
    }
    let mut kept = settled.bodies.iter();
    scene.bodies.retain(|_| kept.next().is_none_or(|rest| !rest.lost));
    let middle = [SIZE[0], SIZE[1]].map(|n| 0.5 * (n as f64 - 1.0));
    let camera = Camera::new(SIZE, [FOCAL; 2], middle).map_err(Failure::input)?;
    let seen = pool.install(|| views(args, &scene, &camera, &mut progress))?;
    progress.begin("write", format!("writing {}", args.output.display()));
    let extras =
        SceneExtras { cameras: seen.cameras, touches: touches(&scene), ..SceneExtras::default() };
    let files = write_scene(&args.output, &scene, &extras, &formats(&args.formats))
        .map_err(Failure::output)?;
    progress.finish();
    if args.json {
        let file = args.output.join("scene.json");
        let told = fs::read_to_string(&file);
        return print(&told.map_err(|e| Failure::output(format!("{}: {e}", file.display())))?);
    }
    print(&text(&scene, &settled, &seen.shares, &files))
}

fn folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|e| Failure::output(format!("{}: {e}", path.display())))
}

/// The cameras, and the share of each body that any of them sees of it.
struct Views {
    cameras: Vec<SceneCamera>,
    shares: Vec<f64>,
}

/// Looks at the scene from all around and writes what was seen.
fn views(
    args: &RandomArgs,
    scene: &Scene,
    camera: &Camera,
    progress: &mut Progress,
) -> Result<Views, Failure> {
    let noise = args.noise.model(args.deviation);
    let mut views = Views { cameras: Vec::new(), shares: vec![0.0; scene.bodies.len()] };
    for (k, pose) in turntable(scene, camera, args.views.into()).into_iter().enumerate() {
        let name = format!("view_{k:03}");
        progress.begin("look", format!("looking: view {} of {}", k + 1, args.views));
        let seen = look(scene, camera, &pose, &noise, args.seed.wrapping_add(k as u64));
        let place = args.output.join(&name);
        folder(&place)?;
        write_view(&place, &seen, camera, &pose).map_err(Failure::output)?;
        let shown = visibility(scene, camera, &pose);
        views.shares.iter_mut().zip(shown).for_each(|(most, share)| *most = most.max(share));
        views.cameras.push(SceneCamera { name, camera: camera.clone(), pose });
    }
    Ok(views)
}
