//! Furnished scenes: shelves, a tote, a desk over the floor, a wall; and what must stay an object.

use supersurface::cloud::PointCloud;
use supersurface::fit::FitOptions;
use supersurface::grasp::{Boxed, GraspOptions, Gripper, Refusal, Surroundings, plan};
use supersurface::measure::OrientedBox;
use supersurface::segment::{DropReason, Dropped, SegmentOptions, Segmentation, segment};
use supersurface::separate::separate;
use supersurface::shape::Plane;
use supersurface::{Direction, Point, Pose, Vector};

use crate::pipeline::gripper;
use crate::segment::{Thing, look_by, table};

const SIZE: [usize; 2] = [640, 480];
/// Points of what noise leaves of a side that is hardly seen, at most.
const CRUMB: usize = 200;

/// A level plane so far from the camera, which is pitched down by `pitch`, and a maker of bricks by where they stand on
/// it: the middle of the foot and the size.
fn floor(pitch: f64, away: f64) -> (Thing, impl Fn([f64; 3], [f64; 3]) -> Thing) {
    let pose = Pose::translation(0.0, 0.0, away - 0.8) * table(pitch);
    let normal = Direction::new_normalize(pose * Vector::z());
    let plane = Plane::through(&Point::from(pose.translation.vector), normal);
    let brick = move |[x, y, z]: [f64; 3], size: [f64; 3]| {
        let half = 0.5 * Vector::from(size);
        Thing::Brick(pose * Pose::translation(x, y, z + half.z), half)
    };
    (Thing::Flat(plane), brick)
}

/// A tote of 0.5 x 0.4 x 0.15 m with two boxes in it, one of which touches a side.
fn tote() -> Vec<Thing> {
    let (ground, brick) = floor(0.85, 1.1);
    vec![
        ground,
        brick([0.0, 0.2, 0.0], [0.52, 0.02, 0.15]),
        brick([0.0, -0.2, 0.0], [0.52, 0.02, 0.15]),
        brick([0.25, 0.0, 0.0], [0.02, 0.4, 0.15]),
        brick([-0.25, 0.0, 0.0], [0.02, 0.4, 0.15]),
        brick([-0.1, 0.0, 0.0], [0.08, 0.06, 0.1]),
        brick([0.1, 0.15, 0.0], [0.1, 0.08, 0.12]),
    ]
}

fn found(things: &[Thing], seed: u64) -> (Segmentation, PointCloud, Vec<Option<usize>>) {
    let (cloud, truth) = look_by(SIZE, things, seed);
    (segment(&cloud, &SegmentOptions::default()).unwrap(), cloud, truth)
}

/// The things named are found, each as one object, and nothing else but crumbs.
fn check(found: &Segmentation, truth: &[Option<usize>], things: &[usize]) {
    let owners = found.objects.iter().filter(|points| points.len() > CRUMB).map(|points| {
        let is_of = |k: usize| points.iter().filter(|i| truth[**i as usize] == Some(k)).count();
        let best = things.iter().copied().max_by_key(|k| is_of(*k)).unwrap();
        let size = truth.iter().filter(|t| **t == Some(best)).count();
        let shared = is_of(best) as f64 / (size + points.len() - is_of(best)) as f64;
        assert!(shared > 0.8, "thing {best}: {shared}");
        best
    });
    let mut owners: Vec<usize> = owners.collect();
    owners.sort_unstable();
    assert_eq!(owners, things);
}

fn walls(found: &Segmentation) -> usize {
    found.obstacles().filter(|(piece, _)| piece.reason == DropReason::Wall).count()
}

#[test]
fn a_tote_is_walls_about_its_objects() {
    for seed in 1..4 {
        let (found, _, truth) = found(&tote(), seed);
        check(&found, &truth, &[5, 6]);
        assert!(walls(&found) >= 3 && found.supports.len() == 1);
        for (piece, solid) in found.obstacles() {
            let thin = solid.half_extents().into_iter().fold(f64::MAX, f64::min);
            assert!(thin < 0.03, "{solid:?}");
            let foreign =
                piece.points.iter().filter(|i| matches!(truth[**i as usize], Some(5 | 6)));
            assert!(20 * foreign.count() < piece.points.len());
        }
    }
}

#[test]
fn a_tote_is_the_same_every_time_and_without_its_image() {
    let (cloud, truth) = look_by(SIZE, &tote(), 1);
    let all = |cloud: &PointCloud| {
        let mut found = segment(cloud, &SegmentOptions::default()).unwrap();
        let things = separate(cloud, &mut found, &FitOptions::UNDEFORMED.quick());
        (found, things.len())
    };
    let once = all(&cloud);
    assert_eq!(all(&cloud), once);
    let loose = PointCloud { grid: None, ..cloud };
    check(&segment(&loose, &SegmentOptions::default()).unwrap(), &truth, &[5, 6]);
}

#[test]
fn the_boards_of_a_shelf_are_supports() {
    let (ground, brick) = floor(0.6, 1.5);
    let things = [
        ground,
        brick([0.0, 0.0, 0.25], [0.5, 0.3, 0.02]),
        brick([0.0, 0.0, 0.55], [0.5, 0.3, 0.02]),
        brick([0.0, 0.16, 0.0], [0.54, 0.02, 0.8]),
        brick([0.26, 0.0, 0.0], [0.02, 0.3, 0.8]),
        brick([-0.26, 0.0, 0.0], [0.02, 0.3, 0.8]),
        brick([-0.1, 0.0, 0.27], [0.08, 0.08, 0.12]),
        brick([0.12, 0.02, 0.57], [0.08, 0.08, 0.12]),
    ];
    let (found, cloud, truth) = found(&things, 1);
    assert_eq!(found.supports.len(), 3);
    let ground = found.support().unwrap();
    let mut heights: Vec<f64> =
        found.supports.iter().skip(1).map(|s| ground.height(&s.corners()[0])).collect();
    heights.sort_by(f64::total_cmp);
    assert!((heights[0] - 0.27).abs() < 0.01 && (heights[1] - 0.57).abs() < 0.01, "{heights:?}");
    for (k, height) in [(6, 0.27), (7, 0.57)] {
        let is_most = |points: &&Vec<u32>| {
            let own = points.iter().filter(|i| truth[**i as usize] == Some(k)).count();
            10 * own > 9 * points.len()
        };
        let at = found.objects.iter().position(|points| is_most(&points)).unwrap();
        let on = &found.supports[found.stands_on[at]];
        assert!((ground.height(&on.corners()[0]) - height).abs() < 0.01);
        let foot = found.objects[at].iter().map(|i| on.plane.height(&cloud.points[*i as usize]));
        assert!(foot.fold(f64::MAX, f64::min) > 0.0);
    }
    assert!(walls(&found) >= 1);
}

#[test]
fn a_desk_and_the_floor_have_their_own_objects() {
    let brick = floor(0.9, 0.9).1;
    let things = [
        brick([0.2, 0.1, -0.03], [1.0, 0.6, 0.03]),
        brick([0.1, 0.1, 0.0], [0.1, 0.08, 0.12]),
        brick([-0.55, 0.1, -0.7], [0.2, 0.2, 0.25]),
        brick([0.0, 0.0, -0.71], [4.0, 4.0, 0.01]),
    ];
    let (found, _, truth) = found(&things, 1);
    check(&found, &truth, &[1, 2]);
    assert_eq!(found.supports.len(), 2);
    let height = |k: usize| found.support().unwrap().height(&found.supports[k].corners()[0]);
    assert!((height(1).abs() - 0.7).abs() < 0.01, "{}", height(1));
    assert_ne!(found.stands_on[0], found.stands_on[1]);
}

#[test]
fn a_wall_behind_a_table_is_in_the_way() {
    let (ground, brick) = floor(0.6, 1.0);
    let things = [
        ground,
        brick([0.0, 0.5, 0.0], [3.0, 0.1, 2.0]),
        brick([0.0, 0.0, 0.0], [0.08, 0.06, 0.1]),
        brick([0.15, 0.42, 0.0], [0.1, 0.05, 0.12]),
    ];
    let (found, _, truth) = found(&things, 2);
    check(&found, &truth, &[2, 3]);
    assert_eq!(walls(&found), 1);
    let labels = found.labels(&look_by(SIZE, &things, 2).0.points);
    let of_wall = |k: i32| {
        let own = labels.iter().zip(&truth).filter(|(l, t)| **l == k && **t == Some(1));
        own.count()
    };
    assert!(of_wall(-1) > 9 * of_wall(1).max(of_wall(2)));
}

#[test]
fn large_boxes_stay_objects() {
    let (ground, brick) = floor(1.0, 1.2);
    let things = [
        ground,
        brick([-0.3, 0.0, 0.0], [0.45, 0.4, 0.3]),
        brick([0.35, 0.1, 0.0], [0.42, 0.42, 0.25]),
    ];
    let (found, _, truth) = found(&things, 3);
    check(&found, &truth, &[1, 2]);
    assert!(found.supports.len() == 1 && found.dropped.iter().all(|d| d.bounds.is_none()));
    // a box across two others is no board
    let (ground, brick) = floor(0.7, 0.9);
    let things = [
        ground,
        brick([-0.1, 0.0, 0.0], [0.08, 0.2, 0.2]),
        brick([0.1, 0.0, 0.0], [0.08, 0.2, 0.2]),
        brick([0.0, 0.0, 0.2], [0.35, 0.25, 0.08]),
    ];
    let found = self::found(&things, 3).0;
    assert!(found.supports.len() == 1 && found.obstacles().next().is_none());
}

#[test]
fn a_box_in_the_way_blocks_grasps() {
    let (ground, brick) = floor(0.8, 0.8);
    let (mut found, cloud, _) = found(&[ground, brick([0.0, 0.0, 0.0], [0.05, 0.05, 0.08])], 4);
    let hand = Boxed {
        center: Point::new(0.0, 0.0, -0.08),
        size: Vector::new(0.2, 0.06, 0.1),
        pad: false,
    };
    let gripper = Gripper { body: vec![hand], ..gripper() };
    let planned = |found: &Segmentation| {
        plan(0, None, &Surroundings::new(&cloud, found), &gripper, &GraspOptions::default())
    };
    assert!(!planned(&found).unwrap().is_empty());
    // a lid over the object, which no reading shows
    let up = found.support().unwrap().normal();
    let top = found.objects[0].iter().map(|i| cloud.points[*i as usize]);
    let centre = top.clone().map(|p| p.coords).sum::<Vector>() / top.count() as f64;
    let pose = Pose::from_parts((centre + up.into_inner() * 0.12).into(), table(0.8).rotation);
    found.dropped.push(Dropped {
        points: Vec::new(),
        reason: DropReason::TooLarge,
        bounds: Some(OrientedBox::new(pose, [0.3, 0.3, 0.03]).unwrap()),
    });
    match planned(&found) {
        Err(Refusal::Blocked { solid, .. }) => assert!(solid > 0),
        Err(other) => panic!("{other}"),
        Ok(grasps) => {
            let from_above =
                |g: &supersurface::grasp::Grasp| (g.pose * Vector::z()).dot(&up) < -0.9;
            assert!(!grasps.iter().any(from_above), "{} grasps", grasps.len());
        }
    }
}
