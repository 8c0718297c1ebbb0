//! Several views of one object, and one surface for all.

use std::path::Path;
use std::time::Instant;

use cpu_time::ThreadTime;
use supersurface::fit::{PoseError, View, fit_views};
use supersurface_io::{ViewHead, shown_name};

use super::args::{FitArgs, Known};
use super::{Fitted, below, done, mend, seen, view};
use crate::exit::Failure;
use crate::progress::Progress;

/// Fits one surface to all clouds; each must be readable.
pub(super) fn run(args: &FitArgs, known: &Known, file: Option<&Path>) -> Result<(), Failure> {
    let mut progress = Progress::new(args.quiet);
    progress.begin("fit", format!("merging {} views", args.clouds.len()));
    let done = done(merged(args, known), file, args.json, false);
    for warning in &done.warnings {
        progress.warn(warning);
    }
    let printed = if done.text.is_empty() { Ok(()) } else { progress.print(&done.text) };
    progress.finish();
    let mut failures = printed.err().into_iter().chain(done.failures);
    failures.next().map_or(Ok(()), |first| Err(first.and(failures)))
}

fn merged(args: &FitArgs, known: &Known) -> Fitted {
    let names: Vec<String> = args.clouds.iter().map(|c| shown_name(c)).collect();
    let name = names.join(", ");
    let (mut clouds, mut warnings) = (Vec::new(), Vec::new());
    for (i, file) in args.clouds.iter().enumerate() {
        match seen(i, file, args, known) {
            Ok((cloud, of_it)) => {
                warnings.extend(of_it.into_iter().map(|w| format!("{}: {w}", names[i])));
                clouds.push(match known.poses.get(i) {
                    Some(pose) => cloud.moved(pose),
                    None => cloud,
                });
            }
            Err(failure) => return Fitted::failed(name, failure),
        }
    }
    warnings.extend(clouds.first().and_then(|cloud| below(cloud, known)));
    let views: Vec<View<'_>> = clouds.iter().map(|cloud| view(cloud, known)).collect();
    // the first view holds the frame
    let errors: Vec<PoseError> =
        (0..views.len()).map(|i| if i == 0 { PoseError::NONE } else { known.pose_error }).collect();
    let (cpu, clock) = (ThreadTime::now(), Instant::now());
    let result = fit_views(&views, &errors, &known.options);
    let (cpu_seconds, seconds) = (cpu.elapsed().as_secs_f64(), clock.elapsed().as_secs_f64());
    let heads: Vec<ViewHead> = names
        .into_iter()
        .zip(&clouds)
        .map(|(source, cloud)| ViewHead { source, points: cloud.points.len() })
        .collect();
    let points = heads.iter().map(|v| v.points).sum();
    let result = result.map_err(|e| Failure::nothing(format!("{name}: {e}{}", mend(&e, points))));
    Fitted { name, points, views: heads, result, cpu_seconds, seconds, warnings }
}
