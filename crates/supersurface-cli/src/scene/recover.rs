//! `supersurface scene recover`: the loop from a thing to its depth image and back to the thing.
//!
//! Each scene is that of `scene random -n 1 --layout single` with its seed, seen from a place of its own. What the
//! pipeline makes of the depth image is compared with what was put there.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use supersurface::camera::Camera;
use supersurface::cloud::PointCloud;
use supersurface::fit::Agreement;
use supersurface::numeric::random::Stream;
use supersurface::pipeline::{self, Options, Report};
use supersurface::scene::{DepthNoise, Layout, Look, Recipe, Scene, facing, look};
use supersurface::shape::Posed;
use supersurface::surface::Surface;
use supersurface::{Pose, Vector};
use supersurface_io::write_view;

use super::args::RecoverArgs;
use super::make::{depth_camera, folder, recipes, settled};
use super::recovered::{Row, files, json, text};
use crate::exit::{Failure, print};
use crate::progress::Progress;
use crate::threads;

/// How far the camera is from the middle of the thing, in metres, and how far it looks down, in radians.
const AWAY: [f64; 2] = [0.4, 1.0];
const DOWN: [f64; 2] = [0.5, 1.2];
/// The camera's stream of random numbers, beside those of the things.
const CAMERA: u64 = 1 << 32;

pub(super) fn run(args: &RecoverArgs) -> Result<(), Failure> {
    let mut progress = Progress::new(args.quiet);
    let (pool, fewer) = threads::pool(args.threads)?;
    if let Some(warning) = fewer {
        progress.warn(&warning);
    }
    let things = recipes(&args.things, &args.noise)?;
    if let Some(output) = &args.output {
        folder(output)?;
    }
    let recovery = Recovery {
        things: &things,
        camera: depth_camera()?,
        noise: args.noise.model(),
        output: args.output.as_deref(),
    };
    progress.begin("recover", format!("recovering {} scenes", args.scenes));
    let done = AtomicUsize::new(0);
    let rows: Result<Vec<Row>, Failure> = pool.install(|| {
        let seeds = (0..args.scenes).into_par_iter().map(|k| args.seed.wrapping_add(k.into()));
        let rows = seeds.map(|seed| {
            let row = recovery.row(seed)?;
            let before = done.fetch_add(1, Ordering::Relaxed);
            progress.say(format!("recovered {} of {} scenes", before + 1, args.scenes));
            Ok(row)
        });
        rows.collect()
    });
    let rows = rows?;
    if let Some(output) = &args.output {
        files(output, &rows)?;
    }
    progress.finish();
    print(&if args.json { json(args.seed, &rows) } else { text(&rows) })
}

/// How scenes are made and seen.
struct Recovery<'a> {
    things: &'a [Recipe],
    camera: Camera,
    noise: DepthNoise,
    output: Option<&'a Path>,
}

impl Recovery<'_> {
    fn row(&self, seed: u64) -> Result<Row, Failure> {
        let (scene, _) = settled(self.things, 1, Layout::Single, seed)?;
        let pose = self.place(&scene, seed);
        let seen = look(&scene, &self.camera, &pose, &self.noise, seed);
        let truth = truth(&scene, &pose)?;
        let points = seen.labels.iter().filter(|label| **label > 0).count();
        let cloud = PointCloud::from_depth(&seen.depth, &self.camera);
        let report = pipeline::find(&cloud, &Options::default(), &mut |_| ());
        let found = match &report {
            Ok(report) => only(report),
            Err(error) => Err(error.to_string()),
        };
        let found = found.and_then(|surface| {
            let agreement = Agreement::of(&surface, &truth).map_err(|e| e.to_string())?;
            Ok((surface, agreement))
        });
        let kind = scene.bodies.first().map_or("", |body| &body.name);
        let kind = kind.strip_suffix("_1").unwrap_or(kind).to_owned();
        let row = Row { seed, kind, points, truth, found };
        if !row.is_within(0.05) {
            self.keep(&row.id(), &seen, &pose)?;
        }
        Ok(row)
    }

    /// Where the camera stands: so far away that it sees the whole thing.
    fn place(&self, scene: &Scene, seed: u64) -> Pose {
        let mut stream = Stream::new(seed, CAMERA);
        let mut between = |[low, high]: [f64; 2]| stream.between(low, high);
        let (away, down) = (between(AWAY), between(DOWN));
        let around = between([0.0, std::f64::consts::TAU]);
        let [low, high] = scene.bodies.first().map_or_else(Default::default, |b| b.bounds());
        let middle = supersurface::nalgebra::center(&low, &high);
        let ([w, h], [fx, fy]) = (self.camera.size(), self.camera.focal());
        let narrowest = (0.5 * w as f64 / fx).min(0.5 * h as f64 / fy).atan();
        let away = away.max(0.5 * (high - low).norm() / narrowest.sin());
        let (sin, cos) = around.sin_cos();
        let way = Vector::new(down.cos() * cos, down.cos() * sin, down.sin());
        facing(&(middle + away * way), &middle)
    }

    /// Leaves what was seen of a scene that was missed.
    fn keep(&self, id: &str, seen: &Look, pose: &Pose) -> Result<(), Failure> {
        let Some(output) = self.output else { return Ok(()) };
        let place = output.join(id);
        folder(&place)?;
        write_view(&place, seen, &self.camera, pose).map_err(Failure::output)
    }
}

/// The thing as it is, in the camera's optical frame.
fn truth(scene: &Scene, camera: &Pose) -> Result<Posed<Surface>, Failure> {
    let solids = scene.bodies.first().map(|body| body.solids());
    match solids.as_deref() {
        Some([solid]) => Ok(solid.moved(&camera.inverse())),
        _ => {
            let name = scene.bodies.first().map_or("nothing", |body| &body.name);
            Err(Failure::input(format!(
                "{name} has several parts: --things takes kinds of one part, as those of members"
            )))
        }
    }
}

/// The surface where there is one object, or why there is none.
fn only(report: &Report) -> Result<Posed<Surface>, String> {
    match &report.objects[..] {
        [] => Err("no object".to_owned()),
        [object] => match &object.fit {
            Ok(fit) => Ok(fit.surface),
            Err(error) => Err(error.to_string()),
        },
        objects => Err(format!("{} objects", objects.len())),
    }
}
