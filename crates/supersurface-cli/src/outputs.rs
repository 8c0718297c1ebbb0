//! One run of the pipeline and everything that it leaves: table or JSON, labels, grasps, picture.

use std::path::Path;

use supersurface::cloud::PointCloud;
use supersurface::fit::FitOptions;
use supersurface::grasp::Gripper;
use supersurface::pipeline::{self, Objects, Options, Report};
use supersurface::segment::SegmentError;
use supersurface_io::{
    BUILT_IN_GRIPPERS, ReportHead, failure_json, report_json, write_grasps, write_labels, write_png,
};

use crate::args::{FitHowArgs, HowArgs, OutputArgs, PlainOutputArgs};
use crate::exit::{Failure, print};
use crate::places::Places;
use crate::progress::Progress;
use crate::{show, terminal, threads};

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
    pub(crate) fit: &'a FitHowArgs,
    pub(crate) output: &'a PlainOutputArgs,
    /// What is planned beside the objects, if anything.
    pub(crate) grasping: Option<Grasping<'a>>,
    /// Name of the input, for the report.
    pub(crate) name: &'a str,
    /// Files that are read, beside the gripper.
    pub(crate) inputs: &'a [&'a Path],
}

/// For what gripper grasps are planned, how many are printed, and where they are written.
pub(crate) struct Grasping<'a> {
    gripper: &'a str,
    top: usize,
    file: Option<&'a Path>,
}

impl<'a> Grasping<'a> {
    pub(crate) fn of(how: &'a HowArgs, output: &'a OutputArgs) -> Self {
        Self { gripper: &how.gripper, top: output.top, file: output.grasps.as_deref() }
    }
}

impl Run<'_> {
    /// Gets the cloud from `source`, runs the pipeline and writes what was asked for. A wrong gripper shows
    /// before anything is read; files come before standard output, so that a broken pipe costs none of them.
    pub(crate) fn run(
        &self,
        stage: (&'static str, String),
        source: impl FnOnce() -> Result<Source, Failure> + Send,
    ) -> Result<(), Failure> {
        self.check_files()?;
        let gripper = self.grasping.as_ref().map(|g| supersurface_io::read_gripper(g.gripper));
        let gripper = gripper.transpose().map_err(Failure::input)?;
        let mut progress = Progress::new(self.output.quiet);
        let (pool, fewer) = threads::pool(self.fit.threads)?;
        if let Some(warning) = fewer {
            progress.warn(&warning);
        }
        progress.begin(stage.0, stage.1);
        pool.install(|| self.go(source, gripper.as_ref(), progress))
    }

    /// No output may replace another one or what is read.
    fn check_files(&self) -> Result<(), Failure> {
        let built_in = |gripper: &str| BUILT_IN_GRIPPERS.iter().any(|(name, _)| *name == gripper);
        let gripper = self.grasping.as_ref().map(|g| g.gripper).filter(|g| !built_in(g));
        let gripper = gripper.map(Path::new);
        let mut places = Places::read(self.inputs.iter().copied().chain(gripper));
        let PlainOutputArgs { labels, png, .. } = self.output;
        let grasps = self.grasping.as_ref().and_then(|g| g.file);
        let files =
            [("--labels", labels.as_deref()), ("--grasps", grasps), ("--png", png.as_deref())];
        for (option, file) in files {
            if let Some(file) = file {
                places.take(option, file)?;
            }
        }
        Ok(())
    }

    fn go(
        &self,
        source: impl FnOnce() -> Result<Source, Failure>,
        gripper: Option<&Gripper>,
        mut progress: Progress,
    ) -> Result<(), Failure> {
        let source = match source() {
            Ok(source) => source,
            Err(failure) => {
                let left = self.leave(Err(failure.message()), None, gripper, progress);
                return Err(failure.and(left));
            }
        };
        for warning in &source.warnings {
            progress.warn(warning);
        }
        let options = Options {
            objects: source.objects,
            fit: self.fit.model.family().map_or(FitOptions::UNDEFORMED, FitOptions::only).quick(),
            ..Options::default()
        };
        let told = &mut |stage| progress.stage(stage);
        let found = match gripper {
            Some(gripper) => pipeline::run(&source.cloud, gripper, &options, told),
            None => pipeline::find(&source.cloud, &options, told),
        };
        let found = found.map_err(|error| self.no_result(&error, &source.cloud));
        let result = found.as_ref().map_err(String::as_str);
        let mut left = self.leave(result, Some(&source), gripper, progress).into_iter();
        match result {
            Err(message) => Err(Failure::nothing(message).and(left)),
            Ok(report) if report.objects.is_empty() => {
                let message = format!("{}: nothing stands on the table", self.name);
                Err(Failure::nothing(message).and(left))
            }
            Ok(_) => left.next().map_or(Ok(()), |first| Err(first.and(left))),
        }
    }

    /// Grasps an object that are printed.
    fn top(&self) -> usize {
        self.grasping.as_ref().map_or(0, |g| g.top)
    }

    /// Why the pipeline gave nothing, and the mend.
    fn no_result(&self, error: &SegmentError, cloud: &PointCloud) -> String {
        let mend = match error {
            SegmentError::NoSupport { .. } => "; if the cloud is one object, pass --segmented",
            SegmentError::NoFinitePoints { .. } if cloud.finite_count() > 0 => "; check --units",
            _ => "",
        };
        format!("{}: {error}{mend}", self.name)
    }

    fn head<'b>(
        &'b self,
        source: Option<&'b Source>,
        gripper: Option<&'b Gripper>,
        timing: &'b [(&'static str, f64)],
    ) -> ReportHead<'b> {
        ReportHead {
            source: self.name,
            frame: source.map_or("cloud", |s| s.frame),
            cloud: source.map(|s| &s.cloud),
            gripper,
            most_grasps: self.top(),
            timing,
            warnings: source.map_or(&[], |s| &s.warnings),
        }
    }

    /// Leaves everything that was asked for, whatever of it fails, and gives the failures. A run without a result
    /// leaves labels and grasps of nothing, a picture of the cloud, and a report that says why.
    fn leave(
        &self,
        result: Result<&Report, &str>,
        source: Option<&Source>,
        gripper: Option<&Gripper>,
        mut progress: Progress,
    ) -> Vec<Failure> {
        let nothing = Report::default();
        let report = result.unwrap_or(&nothing);
        let mut left = Vec::new();
        if let Some(path) = &self.output.labels {
            let points = source.map_or(&[][..], |s| &s.cloud.points);
            left.push(write_labels(path, &report.segmentation.labels(points)));
        }
        if let (Some(path), Some(source)) = (&self.output.png, source) {
            progress.begin("draw", "drawing".into());
            let image = show::picture(&source.cloud, report, gripper);
            left.push(write_png(path, [image.width, image.height], &image.pixels));
        }
        let times = progress.finish();
        let file = self.grasping.as_ref().and_then(|g| g.file);
        if let (Some(path), Some(gripper)) = (file, gripper) {
            let planning = times.iter().filter(|(name, _)| *name != "draw" && *name != "look");
            let seconds = planning.map(|(_, s)| s).sum();
            let frame = source.map_or("camera", frame_id);
            left.push(write_grasps(path, &report.objects, gripper, frame, seconds));
        }
        let head = self.head(source, gripper, times);
        let text = match result {
            Ok(report) if self.output.json => report_json(report, &head) + "\n",
            Err(message) if self.output.json => failure_json(message, &head) + "\n",
            Ok(report) => terminal::table(report, self.top()),
            Err(_) => String::new(),
        };
        let left = left.into_iter().map(|written| written.map_err(Failure::output));
        left.chain([print(&text)]).filter_map(Result::err).collect()
    }
}

/// The frame of a grasp file: that of the cloud, or the one into which the camera's pose leads.
fn frame_id(source: &Source) -> &'static str {
    if source.frame == "cloud" { "camera" } else { "world" }
}
