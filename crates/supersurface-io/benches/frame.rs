//! CPU time of a 640 x 480 frame from points to grasps on one core, and the stages' shares: the made scene,
//! and the organised real scenes of that size where `SUPERSURFACE_SHARED` names their folder. Reading is left out.
//!
//! `cargo bench -p supersurface-io --bench frame`

#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use supersurface::cloud::PointCloud;
use supersurface::grasp::Gripper;
use supersurface::pipeline::{Options, run};
use supersurface::scene::{DepthNoise, demo, look};

/// Runs of which the fastest counts.
const RUNS: usize = 5;
/// The most that a frame of so many objects may take, in milliseconds.
const BAR: f64 = 200.0;
const OBJECTS: usize = 6;
/// The most that the objects with their surfaces may take, in the median and at worst.
const FOUND: [f64; 2] = [60.0, 300.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gripper = supersurface_io::read_gripper("panda_hand")?;
    let mut frames = vec![("demo".to_owned(), made()?)];
    frames.extend(real());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!("{:<36} {:>7}  {:>8}  {:>23}", "", "objects", "CPU ms", "segment / fit / grasp %");
    let mut slowest = 0.0f64;
    let mut found = Vec::new();
    for (name, cloud) in &frames {
        let Some(frame) = pool.install(|| fastest(cloud, &gripper)) else {
            println!("{name:<36} no table");
            continue;
        };
        let share = |k: usize| 100.0 * frame.stages[k] / frame.total();
        println!(
            "{name:<36} {:>7}  {:>8.1}  {:>11.0} / {:>3.0} / {:>3.0}",
            frame.objects,
            frame.total(),
            share(0),
            share(1),
            share(2)
        );
        found.push(frame.stages[0] + frame.stages[1]);
        if frame.objects <= OBJECTS {
            slowest = slowest.max(frame.total());
        }
    }
    found.sort_by(f64::total_cmp);
    println!(
        "objects and surfaces: median {:.1} ms against {:.0} ms, slowest {:.1} ms against {:.0} ms",
        found[found.len() / 2],
        FOUND[0],
        found[found.len() - 1],
        FOUND[1]
    );
    println!(
        "slowest of up to {OBJECTS} objects {slowest:.1} ms against {BAR:.0} ms, best of {RUNS} runs each"
    );
    Ok(())
}

/// CPU milliseconds of the three stages.
struct Frame {
    stages: [f64; 3],
    objects: usize,
}

impl Frame {
    fn total(&self) -> f64 {
        self.stages.iter().sum()
    }
}

fn fastest(cloud: &PointCloud, gripper: &Gripper) -> Option<Frame> {
    let frames = (0..RUNS).map(|_| timed(cloud, gripper)).collect::<Option<Vec<_>>>()?;
    frames.into_iter().min_by(|a, b| a.total().total_cmp(&b.total()))
}

fn timed(cloud: &PointCloud, gripper: &Gripper) -> Option<Frame> {
    let mut starts = Vec::with_capacity(4);
    let began = ProcessTime::now();
    let now = || 1e3 * began.elapsed().as_secs_f64();
    let report = run(cloud, gripper, &Options::default(), &mut |_| starts.push(now())).ok()?;
    starts.push(now());
    let stages = std::array::from_fn(|k| starts[k + 1] - starts[k]);
    Some(Frame { stages, objects: report.objects.len() })
}

fn made() -> Result<PointCloud, Box<dyn std::error::Error>> {
    let made = demo(1)?;
    let seen = look(&made.scene, &made.camera, &made.camera_pose, &DepthNoise::default(), 1);
    Ok(PointCloud::from_depth(&seen.depth, &made.camera))
}

fn real() -> Vec<(String, PointCloud)> {
    let Some(shared) = std::env::var_os("SUPERSURFACE_SHARED") else { return Vec::new() };
    let folders = ["data/real", "data/touching"].map(|f| std::path::Path::new(&shared).join(f));
    let read = |folder| std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = folders.into_iter().flat_map(read).collect();
    files.sort_by_key(std::fs::DirEntry::file_name);
    let frame = |entry: std::fs::DirEntry| {
        let cloud = supersurface_io::read(&entry.path(), &Default::default()).ok()?.cloud;
        let name = entry.file_name().to_string_lossy().into_owned();
        (cloud.grid == Some([640, 480])).then_some((name, cloud))
    };
    files.into_iter().filter_map(frame).collect()
}
