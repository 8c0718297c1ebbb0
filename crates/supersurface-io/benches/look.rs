//! CPU time on one core of a 640 x 480 depth frame of ten things that stand on a table, drawn from the built-in lists.
//!
//! `cargo bench -p supersurface-io --bench look`

#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use supersurface::camera::Camera;
use supersurface::scene::{DepthNoise, Layout, arrange, draw, look, turntable, visibility};

const SCENES: u64 = 12;
const THINGS: usize = 10;
/// Runs of which the fastest counts.
const RUNS: usize = 3;
/// The most that a frame may take, in milliseconds.
const BAR: f64 = 50.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let camera = Camera::new([640, 480], [615.0; 2], [319.5, 239.5])?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!("{:<14} {:>8} {:>8} {:>8}   CPU ms: median, slowest", "", "exact", "noisy", "shares");
    let mut slowest = 0.0f64;
    for list in ["household", "members"] {
        let things = supersurface_io::read_things(list)?;
        let mut times = [(); 3].map(|()| Vec::new());
        for seed in 0..SCENES {
            let scene = arrange(draw(&things, THINGS, seed)?, Layout::Packed, seed)?;
            let views = turntable(&scene, &camera, 1);
            let Some(pose) = views.first() else { continue };
            let image = |noise: DepthNoise| {
                fastest(&pool, || {
                    look(&scene, &camera, pose, &noise, seed);
                })
            };
            times[0].push(image(DepthNoise::none()));
            times[1].push(image(DepthNoise::realsense()));
            times[2].push(fastest(&pool, || {
                visibility(&scene, &camera, pose);
            }));
        }
        let [exact, noisy, shares] = times.map(|mut t| {
            t.sort_by(f64::total_cmp);
            [t[t.len() / 2], t[t.len() - 1]]
        });
        println!("{list:<14} {:>8.1} {:>8.1} {:>8.1}", exact[0], noisy[0], shares[0]);
        println!("{:<14} {:>8.1} {:>8.1} {:>8.1}", "", exact[1], noisy[1], shares[1]);
        slowest = slowest.max(noisy[1]);
    }
    println!("slowest noisy frame {slowest:.1} ms against {BAR:.0} ms, best of {RUNS} runs each");
    Ok(())
}

/// CPU milliseconds.
fn fastest(pool: &rayon::ThreadPool, work: impl Fn() + Sync) -> f64 {
    let timed = |_| {
        let began = ProcessTime::now();
        pool.install(&work);
        1e3 * began.elapsed().as_secs_f64()
    };
    (0..RUNS).map(timed).fold(f64::INFINITY, f64::min)
}
