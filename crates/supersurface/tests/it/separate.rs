//! What touches is told apart, what belongs together is put together, and the report says why.

use nalgebra::UnitQuaternion;
use supersurface::cloud::PointCloud;
use supersurface::fit::FitOptions;
use supersurface::segment::{DropReason, SegmentOptions, Segmentation, segment};
use supersurface::separate::{Reason, Thing as Object, separate};
use supersurface::shape::Plane;
use supersurface::{Direction, Point, Pose, Vector};

use crate::segment::{Thing, look_by, table};

const PITCH: f64 = 0.7;

fn brick(x: f64, y: f64, z: f64, half: [f64; 3], turn: f64) -> Thing {
    let pose = table(PITCH) * Pose::new(Vector::new(x, y, z), Vector::z() * turn);
    Thing::Brick(pose, Vector::from(half))
}

/// A cloud of things on a table, and the thing that each of its points shows.
fn seen(things: Vec<Thing>, seed: u64) -> (PointCloud, Vec<Option<usize>>) {
    seen_by([640, 480], things, seed)
}

fn seen_by(size: [usize; 2], things: Vec<Thing>, seed: u64) -> (PointCloud, Vec<Option<usize>>) {
    let table = table(PITCH);
    let normal = Direction::new_normalize(table * Vector::z());
    let mut all = vec![Thing::Flat(Plane::through(&Point::from(table.translation.vector), normal))];
    all.extend(things);
    look_by(size, &all, seed)
}

fn parted(cloud: &PointCloud) -> (Vec<Object>, Segmentation) {
    let mut segmentation = segment(cloud, &SegmentOptions::default()).unwrap();
    let points = |s: &Segmentation| -> usize {
        s.objects.iter().chain(s.dropped.iter().map(|d| &d.points)).map(Vec::len).sum()
    };
    let before = points(&segmentation);
    let objects = separate(cloud, &mut segmentation, &FitOptions::UNDEFORMED.quick());
    assert_eq!(segmentation.objects.len(), objects.len());
    assert_eq!(points(&segmentation), before, "no point is lost");
    (objects, segmentation)
}

/// The share that a thing's best object has in common with it.
fn recovered(objects: &[Object], truth: &[Option<usize>], thing: usize) -> f64 {
    let all = truth.iter().filter(|t| **t == Some(thing)).count();
    let common = |o: &Object| {
        let both = o.points.iter().filter(|i| truth[**i as usize] == Some(thing)).count();
        both as f64 / (all + o.points.len() - both) as f64
    };
    objects.iter().map(common).fold(0.0, f64::max)
}

#[test]
fn a_box_that_is_seen_on_both_sides_of_another_is_one() {
    let far = brick(0.0, 0.07, 0.05, [0.11, 0.03, 0.05], 0.0);
    let near = brick(0.0, 0.0, 0.1, [0.025, 0.025, 0.1], 0.2);
    let (cloud, truth) = seen(vec![far, near], 1);
    let (objects, _) = parted(&cloud);
    assert_eq!(objects.len(), 2);
    assert!((1..3).all(|k| recovered(&objects, &truth, k) > 0.9));
    let reasons: Vec<_> = objects.iter().map(|o| o.joined.clone()).collect();
    let of_both = [Reason::Behind, Reason::Whole];
    assert!(reasons.iter().any(|r| r.iter().any(|r| of_both.contains(r))), "{reasons:?}");
}

#[test]
fn two_boxes_behind_another_stay_two_where_no_body_is_both() {
    let left = brick(-0.09, 0.12, 0.05, [0.04, 0.03, 0.05], 0.0);
    let right = brick(0.09, 0.15, 0.035, [0.04, 0.03, 0.035], 0.6);
    let near = brick(0.0, 0.0, 0.08, [0.06, 0.025, 0.08], 0.0);
    let (cloud, truth) = seen(vec![left, right, near], 2);
    let (objects, _) = parted(&cloud);
    assert_eq!(objects.len(), 3);
    assert!((1..4).all(|k| recovered(&objects, &truth, k) > 0.85));
}

#[test]
fn a_pile_is_told_apart() {
    let things = vec![
        brick(-0.06, 0.05, 0.03, [0.07, 0.05, 0.03], 0.1),
        brick(0.065, 0.05, 0.045, [0.05, 0.05, 0.045], 0.1),
        brick(-0.05, 0.05, 0.085, [0.04, 0.03, 0.025], 0.7),
        Thing::Ball(table(PITCH) * Point::new(0.065, 0.045, 0.125), 0.035),
    ];
    let (cloud, truth) = seen(things, 3);
    let (objects, _) = parted(&cloud);
    let found: Vec<f64> = (1..5).map(|k| recovered(&objects, &truth, k)).collect();
    assert!(objects.len() == 4 && found.iter().all(|r| *r > 0.85), "{} {found:?}", objects.len());
}

#[test]
fn the_inside_of_a_cup_beside_a_box_is_the_cups() {
    let cup = Thing::Cup(table(PITCH) * Pose::translation(-0.02, 0.05, 0.0), 0.05, 0.08);
    let near = brick(0.073, 0.05, 0.03, [0.034, 0.05, 0.03], 0.0);
    let (cloud, truth) = seen(vec![cup, near], 4);
    let (objects, _) = parted(&cloud);
    let found: Vec<f64> = (1..3).map(|k| recovered(&objects, &truth, k)).collect();
    assert!(objects.len() == 2 && found.iter().all(|r| *r > 0.85), "{} {found:?}", objects.len());
}

#[test]
fn what_the_border_of_the_image_cuts_off_is_left_out() {
    let cut = brick(0.42, 0.0, 0.05, [0.1, 0.05, 0.05], 0.0);
    let whole = brick(-0.1, 0.0, 0.04, [0.04, 0.03, 0.04], 0.0);
    let (cloud, truth) = seen(vec![cut, whole], 5);
    let (objects, segmentation) = parted(&cloud);
    assert_eq!(objects.len(), 1);
    assert!(recovered(&objects, &truth, 2) > 0.9);
    assert!(segmentation.dropped.iter().any(|d| d.reason == DropReason::CutOff));
}

#[test]
fn what_touches_a_whole_thing_at_the_border_is_kept() {
    let cut = brick(0.4, 0.0, 0.05, [0.1, 0.05, 0.05], 0.0);
    let whole = brick(0.26, 0.0, 0.03, [0.04, 0.04, 0.03], 0.0);
    let (cloud, truth) = seen(vec![cut, whole], 13);
    let (objects, _) = parted(&cloud);
    let shares = [1, 2].map(|k| recovered(&objects, &truth, k));
    assert!(objects.len() == 2 && shares.iter().all(|s| *s > 0.85), "{} {shares:?}", objects.len());
}

#[test]
fn a_box_behind_something_at_its_foot_is_one() {
    let far = brick(0.0, 0.08, 0.025, [0.13, 0.03, 0.025], 0.0);
    // a board on its corner, which stands at the foot of the box and leans away from it
    let lean = UnitQuaternion::from_axis_angle(&Vector::x_axis(), 0.35)
        * UnitQuaternion::from_axis_angle(&Vector::y_axis(), std::f64::consts::FRAC_PI_4);
    let middle = Vector::new(0.0, 0.02, 0.083);
    let board = table(PITCH) * Pose::from_parts(middle.into(), lean);
    let near = Thing::Brick(board, Vector::new(0.06, 0.002, 0.06));
    let (cloud, truth) = seen(vec![far, near], 14);
    let (objects, _) = parted(&cloud);
    let shares = [1, 2].map(|k| recovered(&objects, &truth, k));
    assert!(objects.len() == 2 && shares.iter().all(|s| *s > 0.85), "{} {shares:?}", objects.len());
    let reasons: Vec<_> = objects.iter().map(|o| o.joined.clone()).collect();
    assert!(reasons.concat().contains(&Reason::Behind), "{reasons:?}");
}

#[test]
fn a_neighbours_noise_changes_nothing_far_away() {
    let things = |turn: f64| {
        vec![
            brick(-0.15, 0.1, 0.04, [0.04, 0.03, 0.04], 0.3),
            brick(0.12, 0.05, 0.03, [0.07, 0.06, 0.03], turn),
            brick(0.12, 0.05, 0.085, [0.03, 0.03, 0.025], 0.2 + turn),
        ]
    };
    let [a, b] = [0.1, 0.5].map(|turn| {
        let (cloud, truth) = seen(things(turn), 6);
        let (objects, _) = parted(&cloud);
        assert_eq!(objects.len(), 3);
        let of_first = |o: &&Object| truth[o.points[o.points.len() / 2] as usize] == Some(1);
        objects.iter().find(of_first).unwrap().points.clone()
    });
    let common = a.iter().filter(|i| b.binary_search(i).is_ok()).count();
    assert!(common as f64 > 0.995 * a.len().max(b.len()) as f64);
}

#[test]
fn boxes_that_touch_at_a_corner_are_two() {
    let turn = std::f64::consts::FRAC_PI_4;
    let mut found = Vec::new();
    for (seed, gap) in [(7, 0.0), (8, 0.001), (9, 0.002)] {
        // the corner of one at the corner of the other
        let left = brick(-0.055, 0.05, 0.03, [0.05, 0.035, 0.03], 0.0);
        let reach = 0.04 * 2f64.sqrt();
        let right = brick(reach - 0.005 + gap, 0.02, 0.03, [0.04, 0.04, 0.03], turn);
        let (cloud, truth) = seen(vec![left, right], seed);
        let (objects, _) = parted(&cloud);
        found.push((objects.len(), [1, 2].map(|k| recovered(&objects, &truth, k))));
    }
    assert!(found.iter().all(|(n, r)| *n == 2 && r.iter().all(|r| *r > 0.85)), "{found:?}");
}

#[test]
fn a_heap_of_few_pixels_is_told_apart() {
    for (seed, size) in [(11, [240, 180]), (12, [200, 150])] {
        let things = vec![
            brick(-0.1, 0.04, 0.05, [0.06, 0.04, 0.05], 0.1),
            brick(0.06, 0.03, 0.03, [0.1, 0.05, 0.03], 0.0),
            brick(0.05, 0.03, 0.09, [0.04, 0.035, 0.03], 0.5),
        ];
        let (cloud, truth) = seen_by(size, things, seed);
        let (objects, _) = parted(&cloud);
        let shares = [1, 2, 3].map(|k| recovered(&objects, &truth, k));
        assert!(
            shares.iter().all(|s| *s > 0.75),
            "{size:?}: {} objects, {shares:?}",
            objects.len()
        );
    }
}

#[test]
fn two_boxes_flush_in_a_corner_are_no_pipe() {
    for (seed, size) in [(0, [640, 480]), (1, [640, 480]), (0, [320, 240]), (1, [320, 240])] {
        // a corner that is open towards the sensor, the tops at one height
        let corner = table(PITCH) * Pose::new(Vector::zeros(), Vector::z() * 0.4);
        let arm = |x: f64, y: f64, half: [f64; 3]| {
            Thing::Brick(corner * Pose::translation(x, y, half[2]), Vector::from(half))
        };
        let things =
            vec![arm(0.05, 0.02, [0.05, 0.02, 0.05]), arm(-0.02, -0.03, [0.02, 0.07, 0.05])];
        let (cloud, truth) = seen_by(size, things, seed);
        let (objects, _) = parted(&cloud);
        let shares = [1, 2].map(|k| recovered(&objects, &truth, k));
        assert!(
            shares.iter().all(|s| *s > 0.75),
            "{size:?}: {} objects, {shares:?}",
            objects.len()
        );
    }
}
