//! Floor 9: cloud to table to objects to surfaces to grasps, with one options struct and one report.

use crate::cloud::PointCloud;
use crate::fit::{Fit, FitError, FitOptions};
use crate::grasp::{Grasp, GraspOptions, Gripper, Refusal, Surroundings, plan};
use crate::segment::{
    SegmentError, SegmentOptions, Segmentation, segment, segment_masks, segment_whole,
};
use crate::separate::{Around, Reason, Thing, each, separate};

/// Where the objects come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objects {
    /// Found: what stands on the dominant plane.
    #[default]
    Find,
    /// The whole cloud is one object.
    Whole,
    /// Given by the cloud's labels.
    Given,
}

/// How to run the pipeline.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where the objects come from.
    pub objects: Objects,
    /// How to segment.
    pub segment: SegmentOptions,
    /// How to fit.
    pub fit: FitOptions,
    /// How to plan grasps.
    pub grasp: GraspOptions,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            objects: Objects::default(),
            segment: SegmentOptions::default(),
            fit: FitOptions::UNDEFORMED.quick(),
            grasp: GraspOptions::default(),
        }
    }
}

/// One object; one that fails is a row of the report, never its end.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Object {
    /// What it is, or why its points give no surface.
    pub fit: Result<Fit, FitError>,
    /// Why its pieces between concave edges were put together; none where it has one piece or was given.
    pub joined: Vec<Reason>,
    /// How to hold it, best first, or why it cannot be held.
    pub grasps: Result<Vec<Grasp>, Refusal>,
}

/// What was found in a cloud.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Report {
    /// The table and the points of each object.
    pub segmentation: Segmentation,
    /// One entry an object, in the order of the segmentation.
    pub objects: Vec<Object>,
}

/// The stages of a run, as they are announced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Looking for the table and the objects.
    Segment,
    /// Fitting so many objects.
    Fit(usize),
    /// Planning grasps for so many objects.
    Grasp(usize),
}

/// Runs all stages; `progress` is told when one begins.
///
/// Without a table where one is needed this is an error: the objects of a cloud without support are not
/// guessed.
pub fn run(
    cloud: &PointCloud,
    gripper: &Gripper,
    options: &Options,
    progress: &mut dyn FnMut(Stage),
) -> Result<Report, SegmentError> {
    let mut report = find(cloud, options, progress)?;
    progress(Stage::Grasp(report.objects.len()));
    let supports = report.segmentation.supports.len().max(1);
    let around = each(supports, |k| Surroundings::over(cloud, &report.segmentation, k));
    let grasps = each(report.objects.len(), |i| {
        let k = report.segmentation.stands_on.get(i).copied().unwrap_or(0);
        plan(i, report.objects[i].fit.as_ref().ok(), &around[k], gripper, &options.grasp)
    });
    report.objects.iter_mut().zip(grasps).for_each(|(object, grasps)| object.grasps = grasps);
    Ok(report)
}

/// The same without grasps.
pub fn find(
    cloud: &PointCloud,
    options: &Options,
    progress: &mut dyn FnMut(Stage),
) -> Result<Report, SegmentError> {
    progress(Stage::Segment);
    let mut segmentation = match options.objects {
        Objects::Find => segment(cloud, &options.segment)?,
        Objects::Whole => segment_whole(cloud)?,
        Objects::Given => segment_masks(cloud, &options.segment)?,
    };
    progress(Stage::Fit(segmentation.objects.len()));
    let main = segmentation.supports.first();
    let (support, noise) = (main.map(|s| s.plane), main.map_or(0.0, |s| s.noise));
    let around = Around { cloud, support, noise };
    let given = |points: &Vec<u32>| {
        let fit = match options.objects {
            Objects::Whole => around.fit_alone(points, &options.fit),
            Objects::Find | Objects::Given => around.fit(points, &options.fit),
        };
        Thing::given(points.clone(), fit)
    };
    let things = match options.objects {
        Objects::Find => separate(cloud, &mut segmentation, &options.fit),
        Objects::Whole | Objects::Given => {
            each(segmentation.objects.len(), |i| given(&segmentation.objects[i]))
        }
    };
    let object =
        |thing: Thing| Object { fit: thing.fit, joined: thing.joined, grasps: Ok(Vec::new()) };
    Ok(Report { segmentation, objects: things.into_iter().map(object).collect() })
}
