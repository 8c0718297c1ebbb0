//! One fit as JSON, for programs: format `supersurface-fit`, version 1 (`docs/fit.md`).
//!
//! Lengths are metres, angles radians, quaternions `wxyz`; the pose is in the frame of the cloud.

use serde::Serialize;
use supersurface::fit::{Covariance, Fit, Stopped};

use crate::surface_row::{PoseRow, SurfaceRow};

/// What the field `format` says.
pub(crate) const FORMAT: &str = "supersurface-fit";

/// What a fit says beside the result.
#[derive(Clone, Copy, Debug)]
pub struct FitHead<'a> {
    /// Name of the cloud.
    pub source: &'a str,
    /// Points that were read.
    pub points: usize,
    /// The clouds that were merged; none for one alone.
    pub views: &'a [ViewHead],
    /// CPU seconds of the fit alone.
    pub cpu_seconds: f64,
    /// Seconds of the fit alone by the clock.
    pub seconds: f64,
    /// What the reader and the unit check have to say.
    pub warnings: &'a [String],
}

/// One of several clouds that were merged.
#[derive(Clone, Debug)]
pub struct ViewHead {
    /// Name of the cloud.
    pub source: String,
    /// Points that were read.
    pub points: usize,
}

/// The JSON text of a fit, or of why there is none, over many lines.
pub fn fit_json(result: Result<&Fit, &str>, head: &FitHead<'_>) -> String {
    // plain structs of numbers and strings: serialisation has nothing to fail on
    serde_json::to_string_pretty(&File::new(result, head)).unwrap_or_default()
}

/// The same in one line, for files of many fits.
pub fn fit_json_line(result: Result<&Fit, &str>, head: &FitHead<'_>) -> String {
    serde_json::to_string(&File::new(result, head)).unwrap_or_default()
}

#[derive(Serialize)]
struct File<'a> {
    format: &'static str,
    version: u32,
    source: &'a str,
    points: usize,
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<&'a str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    views: Vec<ViewRow<'a>>,
    surface: Option<SurfaceRow>,
    #[serde(flatten)]
    quality: Option<QualityRow>,
    warnings: &'a [String],
    cpu_s: f64,
    time_s: f64,
}

impl<'a> File<'a> {
    fn new(result: Result<&Fit, &'a str>, head: &FitHead<'a>) -> Self {
        let fit = result.ok();
        Self {
            format: FORMAT,
            version: 1,
            source: head.source,
            points: head.points,
            status: if fit.is_some() { "ok" } else { "failed" },
            error: result.err(),
            views: head.views.iter().enumerate().map(|(k, v)| ViewRow::new(v, k, fit)).collect(),
            surface: fit.map(|f| SurfaceRow::new(&f.surface)),
            quality: fit.map(QualityRow::new),
            warnings: head.warnings,
            cpu_s: head.cpu_seconds,
            time_s: head.seconds,
        }
    }
}

#[derive(Serialize)]
struct ViewRow<'a> {
    source: &'a str,
    points: usize,
    moved: Option<PoseRow>,
}

impl<'a> ViewRow<'a> {
    fn new(view: &'a ViewHead, index: usize, fit: Option<&Fit>) -> Self {
        let moved = fit.and_then(|f| f.moves.get(index)).map(PoseRow::new);
        Self { source: &view.source, points: view.points, moved }
    }
}

#[derive(Serialize)]
struct QualityRow {
    family: &'static str,
    family_margin: f64,
    residual: f64,
    noise: f64,
    inlier_share: f64,
    iterations: usize,
    stopped: &'static str,
    covariance: Option<CovarianceRow>,
}

#[derive(Serialize)]
struct CovarianceRow {
    parameters: Vec<&'static str>,
    matrix: Vec<Vec<f64>>,
}

impl CovarianceRow {
    fn new(covariance: &Covariance) -> Self {
        let row = |i: usize| covariance.matrix.row(i).iter().copied().collect();
        let matrix = (0..covariance.names.len()).map(row).collect();
        Self { parameters: covariance.names.clone(), matrix }
    }
}

impl QualityRow {
    fn new(fit: &Fit) -> Self {
        Self {
            family: fit.family.name(),
            family_margin: fit.margin,
            residual: fit.residual,
            noise: fit.noise,
            inlier_share: fit.inlier_share(),
            iterations: fit.iterations,
            stopped: match fit.stopped {
                Stopped::Converged => "converged",
                Stopped::Stuck => "stuck",
                Stopped::Rounds => "rounds",
            },
            covariance: fit.covariance.as_ref().map(CovarianceRow::new),
        }
    }
}
