//! Crowded scenes, real and made, and made shelves, every point labelled: how many objects are found as they are.

use std::collections::BTreeMap;

use supersurface::camera::Camera;
use supersurface::cloud::PointCloud;
use supersurface::fit::FitOptions;
use supersurface::nalgebra::UnitQuaternion;
use supersurface::numeric::random::Stream;
use supersurface::scene::{
    Body, Crowd, DepthNoise, Layout, arrange, crowded, draw, facing, household, look, turntable,
    visibility,
};
use supersurface::segment::{SegmentOptions, segment};
use supersurface::separate::separate;
use supersurface::{Point, Vector};
use supersurface_io::{ReadOptions, read, read_things};

/// Labels from here on are parts of objects, ten an object; lesser ones are the table and the background.
const FIRST: u32 = 20;
/// Share in common from which an object is found.
const FOUND: f64 = 0.75;
/// Share of itself that an object of a made scene shows, to count.
const SHOWN: f64 = 0.3;
/// Half of the camera's lesser field of view, in radians, with a margin.
const HALF_VIEW: f64 = 0.42;

/// Objects found, found in a piece that is mostly another's, and all of those that count.
fn counted(
    cloud: &PointCloud,
    object_of: impl Fn(usize) -> Option<u32>,
    counts: impl Fn(u32) -> bool,
) -> [usize; 3] {
    let mut segmentation = segment(cloud, &SegmentOptions::default()).unwrap();
    let objects = separate(cloud, &mut segmentation, &FitOptions::UNDEFORMED.quick());
    let mut sizes = BTreeMap::<u32, usize>::new();
    for i in (0..cloud.points.len()).filter(|i| cloud.points[*i].z.is_finite()) {
        if let Some(object) = object_of(i).filter(|o| counts(*o)) {
            *sizes.entry(object).or_default() += 1;
        }
    }
    let mut out = [0, 0, sizes.len()];
    for (object, size) in sizes {
        let common = |points: &[u32]| {
            points.iter().filter(|i| object_of(**i as usize) == Some(object)).count()
        };
        let Some(most) = objects.iter().max_by_key(|o| common(&o.points)) else { continue };
        let both = common(&most.points);
        let share = both as f64 / (size + most.points.len() - both) as f64;
        let of_any = most.points.iter().filter(|i| object_of(**i as usize).is_some()).count();
        let foreign = of_any - both;
        out[0] += usize::from(share >= FOUND);
        out[1] += usize::from(share < FOUND && 4 * foreign > both && 4 * both > size);
    }
    out
}

/// The same of a file whose points are labelled.
fn counted_in(file: &std::path::Path) -> [usize; 3] {
    let given = ReadOptions { instances: Some("label".into()), ..ReadOptions::default() };
    let mut cloud = read(file, &given).unwrap().cloud;
    let labels = std::mem::take(&mut cloud.labels);
    counted(&cloud, |i| (labels[i] >= FIRST).then_some(labels[i] / 10), |_| true)
}

#[test]
fn objects_that_touch_are_found() {
    let Some(shared) = crate::shared() else { return };
    let (mut sum, mut scenes) = ([0; 3], 0);
    for folder in ["data/touching", "data/real"] {
        let entries = std::fs::read_dir(shared.join(folder)).unwrap().map(|e| e.unwrap().path());
        let named = |p: &std::path::PathBuf| {
            let name = p.file_name().unwrap().to_string_lossy().into_owned();
            name.starts_with("mosd_") && name.ends_with(".pcd")
        };
        for file in entries.filter(named) {
            let counts = counted_in(&file);
            sum = [0, 1, 2].map(|k| sum[k] + counts[k]);
            scenes += 1;
        }
    }
    assert_eq!((scenes, sum[2]), (18, 84));
    assert!(sum[0] >= 81 && sum[1] == 0, "{} found, {} merged", sum[0], sum[1]);
}

fn realsense() -> Camera {
    Camera::new([640, 480], [502.0, 502.0], [319.5, 239.5]).unwrap()
}

/// A table with 4 to 10 things that touch, as a RealSense sees it from 0.6 to 1 m away: packed for even seeds, else piled.
fn crowd(seed: u64) -> (PointCloud, Vec<u32>, Vec<f64>) {
    let mut stream = Stream::new(seed, 99);
    let layout = if seed.is_multiple_of(2) { Crowd::Packed } else { Crowd::Pile };
    let things = household(4 + stream.index(7), seed).unwrap();
    let scene = crowded(&things, layout, [0.6, 0.6], seed).unwrap();
    let camera = realsense();
    let target = Point::new(0.0, 0.0, 0.03);
    let turn = UnitQuaternion::from_euler_angles(
        0.0,
        -stream.between(0.6, 1.1),
        stream.between(0.0, std::f64::consts::TAU),
    );
    let reach = |body: &Body| {
        let half = body.solids()[0].shape().half_extents();
        let at = body.pose.translation.vector - target.coords;
        at.norm() + half.iter().map(|h| h * h).sum::<f64>().sqrt()
    };
    let reach = scene.bodies.iter().map(reach).fold(0.0, f64::max);
    let away = stream.between(0.6, 0.8).max(reach / HALF_VIEW.sin());
    let pose = facing(&(target + turn * (away * Vector::x())), &target);
    let seen = look(&scene, &camera, &pose, &DepthNoise::realsense(), seed);
    let shown = visibility(&scene, &camera, &pose);
    (PointCloud::from_depth(&seen.depth, &camera), seen.labels, shown)
}

#[test]
#[allow(clippy::print_stdout)]
fn made_crowds_are_told_apart() {
    let mut sum = [0; 3];
    for seed in 2000..2060 {
        let (cloud, labels, shown) = crowd(seed);
        let object_of = |i: usize| (labels[i] > 0).then_some(labels[i]);
        let counts = |o: u32| shown[o as usize - 1] >= SHOWN;
        let counts = counted(&cloud, object_of, counts);
        sum = [0, 1, 2].map(|k| sum[k] + counts[k]);
    }
    println!("{} of {} found, {} merged", sum[0], sum[2], sum[1]);
    assert!(sum[2] > 300 && 100 * sum[0] >= 90 * sum[2], "{sum:?}");
}

/// Things on the boards of a shelf as a RealSense sees them: the objects found, found in a piece that is mostly
/// another's, and all that show enough of themselves.
fn on_a_shelf(seed: u64) -> [usize; 3] {
    let things = draw(&read_things("household").unwrap(), 8, seed).unwrap();
    let scene = arrange(things, Layout::Shelf, seed).unwrap();
    let camera = realsense();
    let pose = turntable(&scene, &camera, 1)[0];
    let seen = look(&scene, &camera, &pose, &DepthNoise::realsense(), seed);
    let shown = visibility(&scene, &camera, &pose);
    let object_of = |i: usize| (seen.labels[i] > 0).then_some(seen.labels[i]);
    let cloud = PointCloud::from_depth(&seen.depth, &camera);
    counted(&cloud, object_of, |o| shown[o as usize - 1] >= SHOWN)
}

#[test]
#[allow(clippy::print_stdout)]
fn things_on_made_shelves_are_found() {
    let counts = (3000..3010).map(on_a_shelf);
    let sum = counts.fold([0; 3], |sum, counts| [0, 1, 2].map(|k| sum[k] + counts[k]));
    println!("{} of {} found, {} merged", sum[0], sum[2], sum[1]);
    assert!(sum[2] > 50 && 100 * sum[0] >= 60 * sum[2], "{sum:?}");
}
