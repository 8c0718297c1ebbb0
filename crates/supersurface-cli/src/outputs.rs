//! One run of the pipeline and everything that it leaves: table or JSON, labels, grasps, picture.

use supersurface::cloud::PointCloud;
use supersurface::fit::FitOptions;
use supersurface::grasp::Gripper;
use supersurface::pipeline::{self, Objects, Options, Report};
use supersurface::segment::SegmentError;
use supersurface_io::{ReportHead, failure_json, report_json};

use crate::args::{HowArgs, OutputArgs};
use crate::exit::{Failure, print};
use crate::progress::Progress;
use crate::{show, terminal};

/// A cloud with what is known about it.
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) cloud: PointCloud,
    /// `cloud` or `robot`.
    pub(crate) frame: &'static str,
    pub(crate) warnings: Vec<String>,
    pub(crate) objects: Objects,
}

/// One run.
pub(crate) struct Run<'a> {
    pub(crate) source: Source,
    pub(crate) how: &'a HowArgs,
    pub(crate) output: &'a OutputArgs,
}

impl Run<'_> {
    /// Runs the pipeline and writes what was asked for. Files come before standard output, so that a broken
    /// pipe costs none of them.
    pub(crate) fn run(&self, mut progress: Progress) -> Result<(), Failure> {
        for warning in &self.source.warnings {
            progress.warn(warning);
        }
        let gripper = supersurface_io::read_gripper(&self.how.gripper).map_err(Failure::input)?;
        threads(self.how.threads)?;
        let options = Options {
            objects: self.source.objects,
            fit: FitOptions { family: self.how.model.family() },
            ..Options::default()
        };
        let cloud = &self.source.cloud;
        let result = pipeline::run(cloud, &gripper, &options, &mut |stage| progress.stage(stage));
        match result {
            Ok(report) => self.succeed(&report, &gripper, progress),
            Err(error) => self.fail(&error, &gripper, &mut progress),
        }
    }

    fn head<'b>(
        &'b self,
        gripper: &'b Gripper,
        timing: &'b [(&'static str, f64)],
    ) -> ReportHead<'b> {
        ReportHead {
            source: &self.source.name,
            frame: self.source.frame,
            world: self.source.cloud.world.as_ref(),
            gripper,
            most_grasps: self.output.top,
            timing,
            warnings: &self.source.warnings,
        }
    }

    fn succeed(
        &self,
        report: &Report,
        gripper: &Gripper,
        mut progress: Progress,
    ) -> Result<(), Failure> {
        let cloud = &self.source.cloud;
        if let Some(path) = &self.output.labels {
            let labels = report.segmentation.labels(cloud.points.len());
            supersurface_io::write_labels(path, &labels).map_err(Failure::output)?;
        }
        if let Some(path) = &self.output.png {
            progress.begin("draw", "drawing".into());
            let image = show::picture(cloud, report, gripper);
            let size = [image.width, image.height];
            supersurface_io::write_png(path, size, &image.pixels).map_err(Failure::output)?;
        }
        let times = progress.finish();
        if let Some(path) = &self.output.grasps {
            let planning = times.iter().filter(|(name, _)| *name != "draw" && *name != "look");
            let seconds = planning.map(|(_, s)| s).sum();
            supersurface_io::write_grasps(path, report, gripper, seconds)
                .map_err(Failure::output)?;
        }
        let text = if self.output.json {
            report_json(report, &self.head(gripper, times)) + "\n"
        } else {
            terminal::table(report, self.output.top)
        };
        print(&text)?;
        if report.objects.is_empty() {
            return Err(Failure::nothing("nothing stands on the table"));
        }
        Ok(())
    }

    fn fail(
        &self,
        error: &SegmentError,
        gripper: &Gripper,
        progress: &mut Progress,
    ) -> Result<(), Failure> {
        let message = format!("{}: {error}", self.source.name);
        let times = progress.finish();
        if let Some(path) = &self.output.labels {
            let none = vec![0; self.source.cloud.points.len()];
            supersurface_io::write_labels(path, &none).map_err(Failure::output)?;
        }
        if self.output.json {
            print(&(failure_json(&message, &self.head(gripper, times)) + "\n"))?;
        }
        Err(match error {
            SegmentError::NoSupport { .. } => Failure::nothing(message),
            _ => Failure::input(message),
        })
    }
}

fn threads(count: Option<usize>) -> Result<(), Failure> {
    let Some(count) = count else { return Ok(()) };
    if count == 0 {
        return Err(Failure::usage("--threads must be at least 1"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count);
    pool.build_global().map_err(Failure::usage)
}
