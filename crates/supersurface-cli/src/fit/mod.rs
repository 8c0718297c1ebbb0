//! `supersurface fit`: one surface for each cloud of one object.

mod args;
mod in_order;
mod merged;
mod text;

use std::path::Path;
use std::time::Instant;

use cpu_time::ThreadTime;
use rayon::prelude::*;
use supersurface::cloud::PointCloud;
use supersurface::fit::{Fit, FitError, View, fit};
use supersurface_io::{
    FitHead, ReadOptions, ViewHead, fit_json, fit_json_line, read, shown_name, write_text,
};

pub(crate) use self::args::FitArgs;
use self::args::Known;
use self::in_order::{Done, InOrder};
use self::text::text;
use crate::exit::Failure;
use crate::input::{surrounds, units};
use crate::progress::Progress;
use crate::threads;

/// One object and what came of it.
struct Fitted {
    name: String,
    points: usize,
    /// The clouds that were merged.
    views: Vec<ViewHead>,
    result: Result<Fit, Failure>,
    cpu_seconds: f64,
    seconds: f64,
    warnings: Vec<String>,
}

impl Fitted {
    fn failed(name: String, failure: Failure) -> Self {
        let (views, warnings) = (Vec::new(), Vec::new());
        let [cpu_seconds, seconds] = [0.0; 2];
        Self { name, points: 0, views, result: Err(failure), cpu_seconds, seconds, warnings }
    }
}

/// Fits all clouds; one that fails keeps no other from being fitted.
pub(crate) fn run(args: &FitArgs) -> Result<(), Failure> {
    let known = args.known()?;
    let files = args.files()?;
    let count = args.clouds.len();
    if args.merge {
        return merged::run(args, &known, files[0].as_deref());
    }
    let (pool, fewer) = threads::pool(args.threads)?;
    // one fit is done before a spinner has turned
    let mut progress = Progress::new(args.quiet || count == 1);
    if let Some(warning) = fewer {
        progress.warn(&warning);
    }
    progress.begin("fit", format!("fitting {count} clouds"));
    let all = InOrder::new(&progress, count);
    pool.install(|| {
        // a bridge hands the clouds out in their order, so that results show as early as they can
        args.clouds.iter().zip(&files).enumerate().par_bridge().for_each(|(i, (cloud, file))| {
            let fitted = fitted(i, cloud, args, &known);
            all.add(i, done(fitted, file.as_deref(), args.json, count > 1));
        });
    });
    let failures = all.failures();
    progress.finish();
    let mut failures = failures.into_iter();
    failures.next().map_or(Ok(()), |first| Err(first.and(failures)))
}

/// A cloud in metres and its own frame, and what is odd about it.
fn seen(
    index: usize,
    file: &Path,
    args: &FitArgs,
    known: &Known,
) -> Result<(PointCloud, Vec<String>), Failure> {
    let read = read(file, &ReadOptions::default()).map_err(Failure::input)?;
    let viewpoint = known.viewpoints[index];
    let mut cloud = match args.units.metres() {
        1.0 => read.cloud,
        factor => read.cloud.scaled(factor),
    };
    cloud.viewpoint = viewpoint.filter(|eye| !surrounds(&cloud, eye));
    let mut warnings = read.warnings;
    warnings.extend(units(&cloud, args.units));
    if viewpoint.is_some() && cloud.viewpoint.is_none() {
        let within = "--viewpoint lies within the object, where no sensor stood";
        warnings.push(format!("{within}: it is taken as seen from all around"));
    }
    let left_out = cloud.points.iter().filter(|p| Some(**p) == cloud.viewpoint).count();
    if left_out > 0 {
        let what = "lie at the viewpoint, as sensors write what they did not see";
        warnings.push(format!("{left_out} points {what}: they are left out"));
    }
    Ok((cloud, warnings))
}

/// Reads a cloud and fits it.
fn fitted(index: usize, file: &Path, args: &FitArgs, known: &Known) -> Fitted {
    let name = shown_name(file);
    let (cloud, mut warnings) = match seen(index, file, args, known) {
        Ok(seen) => seen,
        Err(failure) => return Fitted::failed(name, failure),
    };
    warnings.extend(below(&cloud, known));
    let view = view(&cloud, known);
    let (cpu, clock) = (ThreadTime::now(), Instant::now());
    let result = fit(&view, &known.options);
    let (cpu_seconds, seconds) = (cpu.elapsed().as_secs_f64(), clock.elapsed().as_secs_f64());
    let points = cloud.points.len();
    let told = |e| Failure::nothing(format!("{name}: {e}{}", mend(&e, points)));
    let result = result.map_err(told);
    Fitted { name, points, views: Vec::new(), result, cpu_seconds, seconds, warnings }
}

fn view<'a>(cloud: &'a PointCloud, known: &Known) -> View<'a> {
    View {
        viewpoint: cloud.viewpoint,
        support: known.support,
        standing: known.support.is_some(),
        ..View::all_around(&cloud.points)
    }
}

/// What to say of a support that most points lie below.
fn below(cloud: &PointCloud, known: &Known) -> Option<String> {
    let beyond = known.support.is_some_and(|plane| {
        let below = cloud.points.iter().filter(|p| plane.height(p) < 0.0).count();
        2 * below > cloud.points.len()
    });
    let mend = "A,B,C must point towards the object (turn all four signs)";
    beyond.then(|| format!("--plane: most points lie below it; {mend}"))
}

/// What to do about a failure.
fn mend(error: &FitError, points: usize) -> String {
    match error {
        FitError::TooFewPoints { found, .. } if *found < points => {
            format!(" (of {points}; the others are not finite)")
        }
        FitError::TooFewPoints { .. } => "; add views, or thin the cloud out less".to_owned(),
        FitError::OnePoint { .. } => "; were coordinates rounded far from the origin?".to_owned(),
        FitError::Line { .. } => "; were the right columns read as x, y, z?".to_owned(),
        FitError::NoAgreement { .. } => {
            "; if they are of several objects, `supersurface grasp` parts them".to_owned()
        }
        _ => String::new(),
    }
}

/// Writes the JSON of a fit and gives what is to tell.
fn done(fitted: Fitted, file: Option<&Path>, as_json: bool, several: bool) -> Done {
    let head = FitHead {
        source: &fitted.name,
        points: fitted.points,
        views: &fitted.views,
        cpu_seconds: fitted.cpu_seconds,
        seconds: fitted.seconds,
        warnings: &fitted.warnings,
    };
    let result = fitted.result.as_ref().map_err(Failure::message);
    let written = file.map_or(Ok(()), |file| write_text(file, &(fit_json(result, &head) + "\n")));
    let text = match result {
        _ if as_json && several => fit_json_line(result, &head) + "\n",
        _ if as_json => fit_json(result, &head) + "\n",
        Ok(fit) if file.is_none() => text(&fitted.name, fitted.points, fit),
        _ => String::new(),
    };
    let warnings = fitted.warnings.iter().map(|w| format!("{}: {w}", fitted.name)).collect();
    let failures = [fitted.result.err(), written.map_err(Failure::output).err()];
    Done { text, warnings, failures: failures.into_iter().flatten().collect() }
}
