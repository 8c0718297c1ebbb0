//! Floor 9: cloud to table to objects to surfaces to grasps, with one options struct and one report.


use crate::cloud::PointCloud;
use crate::fit::{Fit, FitError, FitOptions, View, fit, free_points, outline_points};
use crate::grasp::{Grasp, GraspOptions, Gripper, Refusal, Surroundings, plan};
use crate::segment::{
    SegmentError, SegmentOptions, Segmentation, segment, segment_masks, segment_whole,
};
use crate::separate::{Around, separate};
use crate::{Point, shape::Plane};

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

/// Points of a given object lower than this above the support, in metres, say that it stands there; higher
/// ones may lie on another object.
const STANDING: f64 = 0.015;

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
    progress(Stage::Segment);
    let mut segmentation = match options.objects {
        Objects::Find => segment(cloud, &options.segment)?,
        Objects::Whole => segment_whole(cloud)?,
        Objects::Given => segment_masks(cloud, &options.segment)?,
    };
    let count = segmentation.objects.len();
    progress(Stage::Fit(count));
    let around = Around { cloud, support: segmentation.support };
    let (objects, fits): (Vec<_>, Vec<_>) = match options.objects {
        Objects::Find => {
            let things = separate(cloud, &segmentation, &options.fit);
            things.into_iter().map(|thing| (thing.points, thing.fit)).unzip()
        }
        Objects::Whole | Objects::Given => {
            let fit = |i: usize| fit_object(cloud, &segmentation, &segmentation.objects[i], options);
            let fits = each(count, fit);
            (segmentation.objects.clone(), fits)
        }
    };
    let _ = around;
    segmentation.objects = objects;
    let count = segmentation.objects.len();
    progress(Stage::Grasp(count));
    let around = Surroundings::new(cloud, &segmentation);
    let grasps = each(count, |i| plan(i, fits[i].as_ref().ok(), &around, gripper, &options.grasp));
    let objects =
        fits.into_iter().zip(grasps).map(|(fit, grasps)| Object { fit, grasps }).collect();
    Ok(Report { segmentation, objects })
}

fn fit_object(
    cloud: &PointCloud,
    segmentation: &Segmentation,
    object: &[u32],
    options: &Options,
) -> Result<Fit, FitError> {
    let points: Vec<Point> = object.iter().map(|i| cloud.points[*i as usize]).collect();
    let free = match options.objects {
        Objects::Whole => outline_points(cloud, object),
        Objects::Find | Objects::Given => free_points(cloud, object),
    };
    let standing = segmentation.support.is_some_and(|t| lowest(&t, &points) < STANDING);
    let view = View {
        points: &points,
        viewpoint: cloud.viewpoint,
        support: segmentation.support,
        standing,
        free: &free,
    };
    fit(&view, &options.fit)
}

fn lowest(table: &Plane, points: &[Point]) -> f64 {
    points.iter().map(|p| table.height(p)).fold(f64::INFINITY, f64::min)
}

/// The results of `work` for 0..n in order, on all cores where the feature `parallel` is on.
fn each<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..n).into_par_iter().map(work).collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        (0..n).map(work).collect()
    }
}
