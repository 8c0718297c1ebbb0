//! From a cloud to a report: what touches is told apart by what explains it, and results do not depend on how.

use supersurface::cloud::PointCloud;
use supersurface::grasp::{Gripper, Jaw, Kind};
use supersurface::pipeline::{Options, Report, run};
use supersurface::scene::{DepthNoise, demo, look as look_at};
use supersurface::shape::Plane;
use supersurface::surface::Surface;
use supersurface::{Direction, Point, Pose, Vector};

use crate::segment::{Thing, look_by, table};

/// Things on a table, as a noisy camera half a metre above it sees them.
fn seen(things: Vec<Thing>, seed: u64) -> Report {
    let table = table(0.8);
    let normal = Direction::new_normalize(table * Vector::z());
    let mut all = vec![Thing::Flat(Plane::through(&Point::from(table.translation.vector), normal))];
    all.extend(things);
    run(&look_by([640, 480], &all, seed).0, &gripper(), &Options::default(), &mut |_| ()).unwrap()
}

pub(crate) fn gripper() -> Gripper {
    let jaw = Jaw {
        max_opening: 0.08,
        min_opening: 0.0,
        clearance: 0.004,
        pad_length: 0.018,
        pad_width: 0.018,
        finger_thickness: 0.02,
        tip_beyond_tcp: 0.009,
        finger_depth: 0.045,
        force: 40.0,
        mu: 0.5,
        torsion_mu: 0.005,
        tip_arc: Vec::new(),
        outer_width_closed: None,
        outside_mu: 0.3,
        finger: Vec::new(),
    };
    Gripper {
        name: "jaw".into(),
        kind: Kind::Jaw(jaw),
        body: Vec::new(),
        approach_distance: 0.1,
        lift_distance: 0.2,
        mount: Pose::identity(),
        mount_frame: String::new(),
    }
}

fn brick(x: f64, y: f64, z: f64, half: [f64; 3], turn: f64) -> Thing {
    let pose = table(0.8) * Pose::new(Vector::new(x, y, z), Vector::z() * turn);
    Thing::Brick(pose, Vector::from(half))
}

#[test]
fn two_stacked_boxes_are_two_objects_with_their_sizes() {
    let lower = [0.09, 0.06, 0.03];
    let upper = [0.05, 0.04, 0.035];
    let report =
        seen(vec![brick(0.0, 0.0, 0.03, lower, 0.4), brick(0.01, 0.01, 0.095, upper, -0.3)], 1);
    assert_eq!(report.objects.len(), 2, "{:?}", report.segmentation.objects.len());
    let mut widest: Vec<f64> = report
        .objects
        .iter()
        .map(|o| {
            let axes = o.fit.as_ref().unwrap().surface.shape().half_extents();
            axes.into_iter().fold(0.0, f64::max)
        })
        .collect();
    widest.sort_by(f64::total_cmp);
    assert!((widest[0] - 0.05).abs() < 0.006 && (widest[1] - 0.09).abs() < 0.008, "{widest:?}");
}

#[test]
fn a_box_that_leans_on_a_ball_is_another_object() {
    let centre = table(0.8) * Point::new(0.055, 0.0, 0.05);
    let report =
        seen(vec![Thing::Ball(centre, 0.05), brick(-0.03, 0.0, 0.03, [0.034, 0.05, 0.03], 0.0)], 2);
    assert_eq!(report.objects.len(), 2);
}

#[test]
fn one_box_and_one_cup_stay_whole() {
    let cup = Thing::Cup(table(0.8) * Pose::translation(0.12, 0.0, 0.0), 0.045, 0.09);
    let report = seen(vec![brick(-0.08, 0.0, 0.04, [0.06, 0.04, 0.04], 0.5), cup], 3);
    assert_eq!(report.objects.len(), 2);
}

#[test]
fn the_made_scene_is_understood_whatever_its_seed() {
    for seed in [1, 2, 3, 11, 18, 32, 33, 37] {
        let made = demo(seed).unwrap();
        let seen =
            look_at(&made.scene, &made.camera, &made.camera_pose, &DepthNoise::default(), seed);
        let cloud = PointCloud::from_depth(&seen.depth, &made.camera);
        let report = run(&cloud, &gripper(), &Options::default(), &mut |_| ()).unwrap();
        let fits: Vec<_> = report.objects.iter().map(|o| o.fit.as_ref().unwrap()).collect();
        assert_eq!(fits.len(), 5, "seed {seed}");
        let rings = fits.iter().filter(|f| matches!(f.surface.shape(), Surface::Supertoroid(_)));
        assert_eq!(rings.count(), 1, "seed {seed}");
        let well = fits.iter().all(|f| f.residual < 1e-3 && f.inlier_share() > 0.95);
        assert!(well, "seed {seed}");
    }
}
