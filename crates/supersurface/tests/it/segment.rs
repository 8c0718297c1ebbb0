//! From synthetic scenes to table and objects: planes, boxes and balls seen by rays, with noise.

use supersurface::camera::{Camera, DepthImage};
use supersurface::cloud::PointCloud;
use supersurface::numeric::random::Stream;
use supersurface::segment::{
    NoTable, SegmentError, SegmentOptions, segment, segment_masks, segment_whole,
};
use supersurface::shape::Plane;
use supersurface::{Point, Pose, Vector};

/// Something that a ray meets, in the optical frame of the camera; the distance along the ray.
pub(crate) enum Thing {
    /// A plane n·p + d = 0.
    Flat(Plane),
    Ball(Point, f64),
    /// A box with the given half sides.
    Brick(Pose, Vector),
    /// The lateral wall (inside and outside) of an open cup without thickness: pose (z up), radius
    /// and height.
    Cup(Pose, f64, f64),
}

impl Thing {
    fn hit(&self, ray: &Vector) -> f64 {
        let miss = f64::INFINITY;
        match self {
            Self::Flat(plane) => {
                let t = -plane.offset() / plane.normal().dot(ray);
                if t > 0.0 { t } else { miss }
            }
            Self::Ball(c, r) => {
                let (a, b) = (ray.norm_squared(), ray.dot(&c.coords));
                let d = b * b - a * (c.coords.norm_squared() - r * r);
                if d > 0.0 { (b - d.sqrt()) / a } else { miss }
            }
            Self::Brick(pose, half) => {
                let o = pose.inverse() * Point::origin();
                let d = pose.inverse() * ray;
                let (mut near, mut far) = (0.0f64, miss);
                for k in 0..3 {
                    let (a, b) = ((-half[k] - o[k]) / d[k], (half[k] - o[k]) / d[k]);
                    near = near.max(a.min(b));
                    far = far.min(a.max(b));
                }
                if near < far { near } else { miss }
            }
            Self::Cup(pose, r, h) => {
                let o = pose.inverse() * Point::origin();
                let d = pose.inverse() * ray;
                let a = d.x * d.x + d.y * d.y;
                let b = o.x * d.x + o.y * d.y;
                let q = b * b - a * (o.x * o.x + o.y * o.y - r * r);
                let hits = [(-b - q.sqrt()) / a, (-b + q.sqrt()) / a];
                let on = |t: &f64| (0.0..*h).contains(&(o.z + t * d.z));
                hits.into_iter().find(on).unwrap_or(miss)
            }
        }
    }
}

const SIZE: [usize; 2] = [320, 240];

fn look(things: &[Thing], seed: u64) -> (PointCloud, Vec<Option<usize>>) {
    look_by(SIZE, things, seed)
}

/// What a noisy camera with so many pixels sees, and the thing in each pixel.
pub(crate) fn look_by(
    size: [usize; 2],
    things: &[Thing],
    seed: u64,
) -> (PointCloud, Vec<Option<usize>>) {
    let centre = size.map(|n| 0.5 * (n - 1) as f64);
    let camera = Camera::new(size, [0.906 * size[0] as f64; 2], centre).unwrap();
    let mut random = Stream::new(seed, 0);
    let (mut depth, mut truth) = (Vec::new(), Vec::new());
    for i in 0..size[0] * size[1] {
        let ray = camera.unproject((i % size[0]) as f64, (i / size[0]) as f64);
        let hits = things.iter().map(|t| t.hit(&ray)).enumerate();
        let (k, z) = hits.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        let lost = random.uniform() < 0.01 || !z.is_finite();
        let noisy = z + (0.0005 + 0.0014 * z * z) * random.normal();
        depth.push(if lost { f32::NAN } else { noisy as f32 });
        truth.push((!lost).then_some(k));
    }
    (PointCloud::from_depth(&DepthImage::new(size, depth).unwrap(), &camera), truth)
}

/// Pose of the table: z up on its surface, seen from 0.8 m by a camera pitched down by `pitch`.
pub(crate) fn table(pitch: f64) -> Pose {
    let up = Vector::new(0.0, -pitch.cos(), -pitch.sin());
    let away = Vector::new(0.0, -pitch.sin(), pitch.cos());
    let turn = rotation(&Vector::x(), &away, &up);
    Pose::from_parts(Vector::new(0.0, 0.0, 0.8).into(), turn)
}

fn rotation(x: &Vector, y: &Vector, z: &Vector) -> supersurface::nalgebra::UnitQuaternion<f64> {
    use supersurface::nalgebra::{Matrix3, Rotation3, UnitQuaternion};
    let m = Matrix3::from_columns(&[*x, *y, *z]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(m))
}

/// A table with a box, a ball and a cup on it.
fn scene(pitch: f64) -> (Plane, Vec<Thing>) {
    let table = table(pitch);
    let at = |x: f64, y: f64, z: f64| table * Pose::translation(x, y, z);
    let normal = supersurface::Direction::new_normalize(table * Vector::z());
    let plane = Plane::through(&Point::from(table.translation.vector), normal);
    let ball = at(0.0, 0.03, 0.035).translation.vector;
    let things = vec![
        Thing::Flat(plane),
        Thing::Brick(at(-0.14, 0.0, 0.05), Vector::new(0.03, 0.04, 0.05)),
        Thing::Ball(Point::from(ball), 0.035),
        Thing::Cup(at(0.15, 0.02, 0.0), 0.045, 0.09),
    ];
    (plane, things)
}

/// Every thing but the first is found as one object, and nothing else.
fn check(cloud: &PointCloud, truth: &[Option<usize>], things: usize) {
    let found = segment(cloud, &SegmentOptions::default()).unwrap();
    let labels = found.labels(&cloud.points);
    assert_eq!(found.objects.len(), things - 1);
    for k in 1..things {
        let best = (1..things as i32).map(|l| {
            let both = |f: fn(bool, bool) -> bool| {
                let same = labels.iter().zip(truth).filter(|(a, b)| f(**a == l, **b == Some(k)));
                same.count() as f64
            };
            both(|a, b| a && b) / both(|a, b| a || b)
        });
        assert!(best.fold(0.0, f64::max) > 0.85, "thing {k}");
    }
}

#[test]
fn objects_on_a_table_are_found_from_all_heights() {
    for pitch in [0.4, 0.7, 1.1] {
        let (plane, things) = scene(pitch);
        let (cloud, truth) = look(&things, 1);
        let found = segment(&cloud, &SegmentOptions::default()).unwrap();
        let support = found.support().unwrap();
        assert!(support.normal().dot(&plane.normal()) > 1f64.to_radians().cos());
        assert!((support.offset() - plane.offset()).abs() < 0.002);
        check(&cloud, &truth, things.len());
    }
}

#[test]
fn a_table_is_found_from_straight_above() {
    for pitch in [1.4, 1.5, std::f64::consts::FRAC_PI_2] {
        let things = &scene(pitch).1[..3];
        let (cloud, truth) = look(things, 1);
        check(&cloud, &truth, 3);
        check(&PointCloud { grid: None, ..cloud }, &truth, 3);
    }
}

#[test]
fn the_frame_and_the_organisation_do_not_matter() {
    let (_, things) = scene(0.7);
    let (cloud, truth) = look(&things, 2);
    let turn = Pose::new(Vector::new(0.3, -1.0, 2.0), Vector::new(0.4, 1.3, -0.6));
    check(&cloud.clone().moved(&turn), &truth, things.len());
    check(&PointCloud { grid: None, ..cloud.clone() }.moved(&turn), &truth, things.len());
    // Shuffled, and without the points that were lost.
    let mut random = Stream::new(2, 1);
    let finite = (0..cloud.points.len()).filter(|i| cloud.is_finite(*i));
    let mut order: Vec<usize> = finite.collect();
    for k in (1..order.len()).rev() {
        order.swap(k, random.index(k + 1));
    }
    let shuffled = PointCloud {
        points: order.iter().map(|i| cloud.points[*i]).collect(),
        grid: None,
        ..cloud.clone()
    };
    let truth: Vec<Option<usize>> = order.iter().map(|i| truth[*i]).collect();
    check(&shuffled, &truth, things.len());
    // Seen from nowhere: in space the far inside of a cup is not known to belong to it.
    let (cloud, truth) = look(&things[..3], 3);
    let middle = Pose::translation(0.0, 0.0, -0.75);
    let nowhere = PointCloud { grid: None, viewpoint: None, ..cloud }.moved(&middle);
    check(&nowhere, &truth, 3);
}

#[test]
fn results_are_the_same_every_time() {
    let (cloud, _) = look(&scene(0.7).1, 4);
    let run = || segment(&cloud, &SegmentOptions::default());
    assert_eq!(run(), run());
}

#[test]
fn a_wall_is_no_table() {
    let wall = |distance: f64| Plane::new(Vector::new(0.1, 0.05, -1.0), distance).unwrap();
    for distance in [1.6, 2.5, 5.0] {
        let ball = Thing::Ball(Point::new(0.0, 0.0, 0.8 * distance), 0.1);
        let (cloud, _) = look(&[Thing::Flat(wall(distance)), ball], 5);
        let error = segment(&cloud, &SegmentOptions::default()).unwrap_err();
        let is_wall = matches!(error, SegmentError::NoSupport { why: NoTable::Wall { .. } });
        assert!(is_wall, "{error}");
        assert!(error.to_string().contains("wall"));
    }
    // A wall beside the camera, and a floor that is too far.
    let side = Plane::new(Vector::new(1.0, 0.0, -0.1), 0.6).unwrap();
    assert!(segment(&look(&[Thing::Flat(side)], 6).0, &SegmentOptions::default()).is_err());
    let floor = Plane::new(Vector::new(0.0, -0.6, -0.8), 4.5).unwrap();
    let error = segment(&look(&[Thing::Flat(floor)], 7).0, &SegmentOptions::default());
    let far = matches!(error, Err(SegmentError::NoSupport { why: NoTable::Far { .. } }));
    assert!(far, "{error:?}");
}

#[test]
fn a_wall_behind_the_table_is_left_out() {
    let (plane, mut things) = scene(0.6);
    things.truncate(3);
    // Square to the table, half a metre behind the middle.
    let away = table(0.6) * Vector::y();
    let behind = table(0.6) * Point::new(0.0, 0.5, 0.0);
    let wall = Plane::through(&behind, supersurface::Direction::new_normalize(-away));
    things.push(Thing::Flat(wall));
    let (cloud, _) = look(&things, 8);
    let found = segment(&cloud, &SegmentOptions::default()).unwrap();
    assert!(found.support().unwrap().normal().dot(&plane.normal()) > 0.999);
    assert_eq!(found.objects.len(), 2);
    assert!(!found.dropped.is_empty());
}

#[test]
fn given_segmentations_are_taken() {
    let (mut cloud, truth) = look(&scene(0.7).1, 9);
    assert_eq!(segment_masks(&cloud, &SegmentOptions::default()), Err(SegmentError::NoLabels));
    cloud.labels = truth.iter().map(|k| 10 * k.unwrap_or(0) as u32).collect();
    let found = segment_masks(&cloud, &SegmentOptions::default()).unwrap();
    assert!(found.support().is_some());
    assert_eq!(found.objects.len(), 3);
    for (k, object) in found.objects.iter().enumerate() {
        assert!(object.iter().all(|i| truth[*i as usize] == Some(k + 1)));
    }
    // Without anything but the objects there is no support, and no error.
    for (p, k) in cloud.points.iter_mut().zip(&truth) {
        if *k == Some(0) {
            *p = Point::new(f64::NAN, f64::NAN, f64::NAN);
        }
    }
    assert_eq!(segment_masks(&cloud, &SegmentOptions::default()).unwrap().support(), None);
    let whole = segment_whole(&cloud).unwrap();
    assert_eq!(whole.objects.len(), 1);
    assert_eq!(whole.objects[0].len(), cloud.finite_count());
    assert_eq!(whole.support(), None);
}

#[test]
fn degenerate_clouds_are_errors() {
    let run = |points: Vec<Point>| {
        let cloud =
            PointCloud { viewpoint: Some(Point::origin()), ..PointCloud::from_points(points) };
        segment(&cloud, &SegmentOptions::default())
    };
    assert_eq!(run(vec![]), Err(SegmentError::EmptyCloud));
    let nan = Point::new(f64::NAN, 0.0, 0.0);
    assert_eq!(run(vec![nan; 9]), Err(SegmentError::NoFinitePoints { points: 9 }));
    assert!(matches!(
        run(vec![Point::new(0.0, 0.0, 1.0); 3]),
        Err(SegmentError::TooFewPoints { found: 3, .. })
    ));
    let no_support =
        |points: Vec<Point>| matches!(run(points), Err(SegmentError::NoSupport { .. }));
    assert!(no_support(vec![Point::new(0.1, 0.2, 1.0); 5000]));
    assert!(no_support((0..5000).map(|i| Point::new(1e-4 * f64::from(i), 0.0, 1.0)).collect()));
    assert!(no_support(vec![Point::origin(); 500]));
}

#[test]
fn absurd_sizes_neither_panic_nor_hang() {
    let (cloud, _) = look(&scene(0.7).1, 10);
    for scale in [1e-300, 1e-9, 1e-3, 1e3, 1e6, 1e9, 1e300] {
        for grid in [cloud.grid, None] {
            let cloud = PointCloud { grid, ..cloud.clone().scaled(scale) };
            let _ = segment(&cloud, &SegmentOptions::default());
        }
    }
    // A grid that does not fit the points is not believed.
    for grid in [[0, 0], [7, 3], [usize::MAX, 2], [1, SIZE[0] * SIZE[1]]] {
        let cloud = PointCloud { grid: Some(grid), ..cloud.clone() };
        let _ = segment(&cloud, &SegmentOptions::default());
    }
    // A few absurd points among good ones change nothing.
    let mut spoilt = cloud.clone();
    for (k, p) in spoilt.points.iter_mut().step_by(5001).enumerate() {
        *p = Point::new(1e300, -1e300, 10f64.powi(20 * k as i32));
    }
    assert_eq!(segment(&spoilt, &SegmentOptions::default()).unwrap().objects.len(), 3);
}

#[test]
fn noise_takes_no_longer_than_a_scene() {
    // A table under thousands of crumbs.
    let mut random = Stream::new(11, 0);
    let (mut cloud, _) = look(&scene(0.9).1[..1], 11);
    for row in (0..SIZE[1]).step_by(8) {
        for column in (0..SIZE[0]).step_by(8) {
            let lift = random.between(0.7, 0.95);
            for k in 0..36 {
                let i = (row + k / 6) * SIZE[0] + column + k % 6;
                cloud.points[i] *= lift;
            }
        }
    }
    for grid in [cloud.grid, None] {
        let _ = segment(&PointCloud { grid, ..cloud.clone() }, &SegmentOptions::default());
    }
}
