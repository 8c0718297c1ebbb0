//! One run of the pipeline and everything that it leaves: table or JSON, labels, grasps, picture.

use supersurface::cloud::PointCloud;
use supersurface::fit::FitOptions;
use supersurface::grasp::Gripper;
use supersurface::pipeline::{self, Objects, Options, Report};
use supersurface::segment::{SegmentError, Segmentation};
use supersurface_io::{ReportHead, failure_json, report_json};

use crate::args::{HowArgs, OutputArgs};
use crate::exit::{Failure, print};
use crate::progress::Progress;
use crate::{show, terminal};

/// A cloud with what is known about it.
pub(crate) struct Source {
    pub(crate) cloud: PointCloud,
    /// `cloud` or `robot`.
    pub(crate) frame: &'static str,
    pub(crate) warnings: Vec<String>,
    pub(crate) objects: Objects,
}

/// One run: how it is done and where its results go.
pub(crate) struct Run<'a> {
    pub(crate) how: &'a HowArgs,
    pub(crate) output: &'a OutputArgs,
    /// Name of the input, for the report.
    pub(crate) name: &'a str,
}

impl Run<'_> {
    /// Gets the cloud from `source`, runs the pipeline and writes what was asked for. A wrong gripper shows
    /// before anything is read; files come before standard output, so that a broken pipe costs none of them.
    pub(crate) fn run(
        &self,
        stage: (&'static str, String),
        source: impl FnOnce() -> Result<Source, Failure>,
    ) -> Result<(), Failure> {
        let gripper = supersurface_io::read_gripper(&self.how.gripper).map_err(Failure::input)?;
        threads(self.how.threads)?;
        let mut progress = Progress::new(self.output.quiet);
        progress.begin(stage.0, stage.1);
        let source = match source() {
            Ok(source) => source,
            Err(failure) => {
                let left = self.leave_nothing(failure.message(), None, &gripper, progress.finish());
                return Err(also(left, failure, &progress));
            }
        };
        for warning in &source.warnings {
            progress.warn(warning);
        }
        let options = Options {
            objects: source.objects,
            fit: FitOptions { family: self.how.model.family() },
            ..Options::default()
        };
        let told = &mut |stage| progress.stage(stage);
        match pipeline::run(&source.cloud, &gripper, &options, told) {
            Ok(report) => self.succeed(&source, &report, &gripper, progress),
            Err(error) => {
                let mend = match error {
                    SegmentError::NoSupport { .. } => {
                        "; if the cloud is one object, pass --segmented"
                    }
                    _ => "",
                };
                let message = format!("{}: {error}{mend}", self.name);
                let times = progress.finish();
                let left = self.leave_nothing(&message, Some(&source), &gripper, times);
                Err(also(left, Failure::nothing(message), &progress))
            }
        }
    }

    fn head<'b>(
        &'b self,
        source: Option<&'b Source>,
        gripper: &'b Gripper,
        timing: &'b [(&'static str, f64)],
    ) -> ReportHead<'b> {
        ReportHead {
            source: self.name,
            frame: source.map_or("cloud", |s| s.frame),
            cloud: source.map(|s| &s.cloud),
            gripper,
            most_grasps: self.output.top,
            timing,
            warnings: source.map_or(&[], |s| &s.warnings),
        }
    }

    fn succeed(
        &self,
        source: &Source,
        report: &Report,
        gripper: &Gripper,
        mut progress: Progress,
    ) -> Result<(), Failure> {
        let cloud = &source.cloud;
        if let Some(path) = &self.output.labels {
            let labels = report.segmentation.labels(&cloud.points);
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
            supersurface_io::write_grasps(
                path,
                &report.objects,
                gripper,
                frame_id(source),
                seconds,
            )
            .map_err(Failure::output)?;
        }
        let text = if self.output.json {
            report_json(report, &self.head(Some(source), gripper, times)) + "\n"
        } else {
            terminal::table(report, self.output.top)
        };
        print(&text)?;
        if report.objects.is_empty() {
            return Err(Failure::nothing(format!("{}: nothing stands on the table", self.name)));
        }
        Ok(())
    }

    /// What a run without results leaves: labels and grasps of nothing, a picture of the cloud, and a report that
    /// says why.
    fn leave_nothing(
        &self,
        message: &str,
        source: Option<&Source>,
        gripper: &Gripper,
        times: &[(&'static str, f64)],
    ) -> Result<(), Failure> {
        if let Some(path) = &self.output.labels {
            let points = source.map_or(&[][..], |s| &s.cloud.points);
            let labels = Segmentation::default().labels(points);
            supersurface_io::write_labels(path, &labels).map_err(Failure::output)?;
        }
        if let Some(path) = &self.output.grasps {
            let seconds = times.iter().map(|t| t.1).sum();
            supersurface_io::write_grasps(
                path,
                &[],
                gripper,
                source.map_or("camera", frame_id),
                seconds,
            )
            .map_err(Failure::output)?;
        }
        if let (Some(path), Some(source)) = (&self.output.png, source) {
            let image = show::picture(&source.cloud, &Report::default(), gripper);
            let size = [image.width, image.height];
            supersurface_io::write_png(path, size, &image.pixels).map_err(Failure::output)?;
        }
        if self.output.json {
            print(&(failure_json(message, &self.head(source, gripper, times)) + "\n"))?;
        }
        Ok(())
    }
}

/// The failure of a run, after what else failed when it was written down.
fn also(left: Result<(), Failure>, failure: Failure, progress: &Progress) -> Failure {
    if let Err(other) = left {
        progress.warn(other.message());
    }
    failure
}

/// The frame of a grasp file: that of the cloud, or the one into which the camera's pose leads.
fn frame_id(source: &Source) -> &'static str {
    if source.frame == "cloud" { "camera" } else { "world" }
}

fn threads(count: Option<u16>) -> Result<(), Failure> {
    let Some(count) = count else { return Ok(()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.into());
    pool.build_global().map_err(Failure::usage)
}
