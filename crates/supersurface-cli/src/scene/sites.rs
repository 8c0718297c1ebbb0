//! Grasps on what a view of a scene shows, as named frames.

use supersurface::Pose;
use supersurface::camera::Camera;
use supersurface::cloud::PointCloud;
use supersurface::grasp::{Grasp, Gripper};
use supersurface::pipeline::{Objects, Options, run};
use supersurface::scene::{Look, Scene};
use supersurface_io::Site;

/// Most grasps of a body.
const MOST: usize = 3;

/// Grasps of the bodies of a scene, in the world.
pub(super) struct Grasps<'a> {
    gripper: &'a Gripper,
    /// Of each body, with their scores.
    found: Vec<Vec<(f64, Pose)>>,
}

impl<'a> Grasps<'a> {
    pub(super) fn new(gripper: &'a Gripper, scene: &Scene) -> Self {
        Self { gripper, found: vec![Vec::new(); scene.bodies.len()] }
    }

    /// Adds those that a view shows: what `supersurface grasp` finds in its depth image with its labels as masks.
    pub(super) fn add(&mut self, seen: &Look, camera: &Camera, pose: &Pose) {
        let mut cloud = PointCloud::from_depth(&seen.depth, camera);
        cloud.labels.clone_from(&seen.labels);
        let options = Options { objects: Objects::Given, ..Options::default() };
        // an empty view has none
        let Ok(report) = run(&cloud, self.gripper, &options, &mut |_| ()) else { return };
        for (points, object) in report.segmentation.objects.iter().zip(&report.objects) {
            let label = points.first().and_then(|i| seen.labels.get(*i as usize));
            let body = label.and_then(|label| (*label as usize).checked_sub(1));
            let (Some(body), Ok(grasps)) =
                (body.and_then(|k| self.found.get_mut(k)), &object.grasps)
            else {
                continue;
            };
            body.extend(grasps.iter().map(|grasp: &Grasp| (grasp.score, pose * grasp.pose)));
        }
    }

    /// The best of each body, `grasp BODY 1` and on.
    pub(super) fn sites(mut self, scene: &Scene) -> Vec<Site> {
        let mut sites = Vec::new();
        for (body, found) in scene.bodies.iter().zip(&mut self.found) {
            // equal scores stay in the order of the views
            found.sort_by(|a, b| b.0.total_cmp(&a.0));
            for ((_, pose), number) in found.iter().take(MOST).zip(1..) {
                sites.push(Site { name: format!("grasp {} {number}", body.name), pose: *pose });
            }
        }
        sites
    }
}
