//! The report as JSON, for programs: format `supersurface-report`, version 1.
//!
//! Lengths are metres, angles radians, quaternions `wxyz`; every pose is in the frame that `frame` names.
//! `docs/report.md` lists all fields. Fields may be added within a version; none changes its meaning.

use serde::Serialize;
use supersurface::cloud::PointCloud;
use supersurface::grasp::{Grasp, Gripper, Kind};
use supersurface::measure::OrientedBox;
use supersurface::pipeline::{Object, Report};
use supersurface::segment::{Dropped, Segmentation, Support};

use crate::surface_row::{PoseRow, SurfaceRow};

/// What a report says beside the results.
#[derive(Clone, Copy, Debug)]
pub struct ReportHead<'a> {
    /// Name of the input.
    pub source: &'a str,
    /// `cloud`, or `robot` when the camera's pose was given.
    pub frame: &'a str,
    /// What was read, in that frame; `None` where nothing could be.
    pub cloud: Option<&'a PointCloud>,
    /// The gripper for which grasps were planned; `None` where none were.
    pub gripper: Option<&'a Gripper>,
    /// Most grasps an object that are written.
    pub most_grasps: usize,
    /// Seconds of each stage by name.
    pub timing: &'a [(&'static str, f64)],
    /// What the reader and the unit check have to say.
    pub warnings: &'a [String],
}

/// The JSON text of a report.
pub fn report_json(report: &Report, head: &ReportHead<'_>) -> String {
    let objects = report.objects.iter().zip(&report.segmentation.objects).enumerate();
    let objects = objects
        .map(|(i, (o, points))| {
            let on = report.segmentation.stands_on.get(i).map(|k| k + 1);
            object(i + 1, o, on, points.len(), head)
        })
        .collect();
    let message = report.objects.is_empty().then(|| "nothing stands on the table".to_owned());
    text(&File {
        message,
        plane: plane(&report.segmentation),
        supports: report.segmentation.supports.iter().map(SupportRow::new).collect(),
        objects,
        obstacles: obstacles(&report.segmentation),
        dropped: dropped(&report.segmentation),
        ..File::head(head)
    })
}

/// The JSON text of a run that read no cloud or found no support or usable points: `plane` is null and `message` says why.
pub fn failure_json(message: &str, head: &ReportHead<'_>) -> String {
    text(&File { message: Some(message.to_owned()), ..File::head(head) })
}

fn text(file: &File<'_>) -> String {
    // plain structs of numbers and strings: serialisation has nothing to fail on
    serde_json::to_string_pretty(file).unwrap_or_default()
}

#[derive(Serialize)]
struct File<'a> {
    format: &'static str,
    version: u32,
    units: Units,
    source: &'a str,
    frame: Frame<'a>,
    cloud: Option<CloudRow>,
    message: Option<String>,
    plane: Option<PlaneRow>,
    supports: Vec<SupportRow>,
    gripper: Option<&'a str>,
    objects: Vec<ObjectRow>,
    obstacles: Vec<ObstacleRow>,
    dropped: Vec<DroppedRow>,
    timing_s: std::collections::BTreeMap<&'static str, f64>,
    warnings: &'a [String],
}

impl<'a> File<'a> {
    fn head(head: &ReportHead<'a>) -> Self {
        Self {
            format: "supersurface-report",
            version: 1,
            units: Units { length: "m", angle: "rad", quaternion: "wxyz" },
            source: head.source,
            frame: Frame {
                id: head.frame,
                world_pose: head.cloud.and_then(|c| c.world.as_ref()).map(PoseRow::new),
            },
            cloud: head.cloud.map(CloudRow::new),
            message: None,
            plane: None,
            supports: Vec::new(),
            gripper: head.gripper.map(|g| &g.name[..]),
            objects: Vec::new(),
            obstacles: Vec::new(),
            dropped: Vec::new(),
            timing_s: head.timing.iter().copied().collect(),
            warnings: head.warnings,
        }
    }
}

#[derive(Serialize)]
struct Units {
    length: &'static str,
    angle: &'static str,
    quaternion: &'static str,
}

#[derive(Serialize)]
struct Frame<'a> {
    id: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    world_pose: Option<PoseRow>,
}

#[derive(Serialize)]
struct CloudRow {
    points: usize,
    finite: usize,
    grid: Option<[usize; 2]>,
}

impl CloudRow {
    fn new(cloud: &PointCloud) -> Self {
        Self { points: cloud.points.len(), finite: cloud.finite_count(), grid: cloud.grid }
    }
}

#[derive(Serialize)]
struct PlaneRow {
    normal: [f64; 3],
    offset: f64,
    noise: f64,
}

fn plane(segmentation: &Segmentation) -> Option<PlaneRow> {
    segmentation.supports.first().map(PlaneRow::new)
}

impl PlaneRow {
    fn new(support: &Support) -> Self {
        Self {
            normal: support.plane.normal().into_inner().into(),
            offset: support.plane.offset(),
            noise: support.noise,
        }
    }
}

#[derive(Serialize)]
struct SupportRow {
    #[serde(flatten)]
    plane: PlaneRow,
    corners: Vec<[f64; 3]>,
}

impl SupportRow {
    fn new(support: &Support) -> Self {
        let corners = support.corners().iter().map(|p| p.coords.into()).collect();
        Self { plane: PlaneRow::new(support), corners }
    }
}

#[derive(Serialize)]
struct ObstacleRow {
    #[serde(flatten)]
    pose: PoseRow,
    size: [f64; 3],
    points: usize,
    reason: String,
}

fn obstacles(segmentation: &Segmentation) -> Vec<ObstacleRow> {
    let row = |(piece, solid): (&Dropped, &OrientedBox)| ObstacleRow {
        pose: PoseRow::new(solid.pose()),
        size: solid.half_extents().map(|h| 2.0 * h),
        points: piece.points.len(),
        reason: piece.reason.to_string(),
    };
    segmentation.obstacles().map(row).collect()
}

#[derive(Serialize)]
struct ObjectRow {
    id: usize,
    points: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    support: Option<usize>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    joined: Vec<String>,
    surface: Option<SurfaceRow>,
    #[serde(flatten)]
    quality: Option<QualityRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    grasps: Vec<GraspRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<String>,
}

#[derive(Serialize)]
struct QualityRow {
    residual: f64,
    noise: f64,
    inlier_share: f64,
    family_margin: f64,
}

fn object(
    id: usize,
    object: &Object,
    support: Option<usize>,
    points: usize,
    head: &ReportHead<'_>,
) -> ObjectRow {
    let fit = object.fit.as_ref();
    let surface = fit.ok().map(|f| SurfaceRow::new(&f.surface));
    let quality = fit.ok().map(|f| QualityRow {
        residual: f.residual,
        noise: f.noise,
        inlier_share: f.inlier_share(),
        family_margin: f.margin,
    });
    let grasps = object.grasps.iter().flatten().take(head.most_grasps);
    let row = |g: &Grasp| head.gripper.map(|gripper| GraspRow::new(g, kind(gripper)));
    ObjectRow {
        id,
        points,
        support,
        joined: object.joined.iter().map(ToString::to_string).collect(),
        surface,
        quality,
        error: fit.err().map(ToString::to_string),
        grasps: grasps.filter_map(row).collect(),
        refusal: object.grasps.as_ref().err().map(ToString::to_string),
    }
}

fn kind(gripper: &Gripper) -> &'static str {
    match gripper.kind {
        Kind::Jaw(_) => "parallel",
        Kind::Suction(_) => "suction",
    }
}

#[derive(Serialize)]
struct GraspRow {
    r#type: &'static str,
    #[serde(flatten)]
    pose: PoseRow,
    opening: f64,
    contact_width: f64,
    inside: bool,
    score: f64,
    terms: std::collections::BTreeMap<&'static str, f64>,
    source: &'static str,
}

impl GraspRow {
    fn new(grasp: &Grasp, kind: &'static str) -> Self {
        Self {
            r#type: kind,
            pose: PoseRow::new(&grasp.pose),
            opening: grasp.opening,
            contact_width: grasp.contact_width,
            inside: grasp.inside,
            score: grasp.score,
            terms: grasp.terms.iter().copied().collect(),
            source: grasp.source,
        }
    }
}

#[derive(Serialize)]
struct DroppedRow {
    points: usize,
    reason: String,
}

fn dropped(segmentation: &Segmentation) -> Vec<DroppedRow> {
    let row = |d: &Dropped| DroppedRow { points: d.points.len(), reason: d.reason.to_string() };
    segmentation.dropped.iter().map(row).collect()
}
