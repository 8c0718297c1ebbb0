//! Scenes as `supersurface scene random` makes them: drawn, arranged and settled. For each list of things and each layout the
//! CPU milliseconds a scene, the share of scenes in which every body lies still, and the deepest overlap that is left.
//!
//! `cargo bench -p supersurface-physics --bench scenes`; SUPERSURFACE_SCENES says how many of each, SUPERSURFACE_SEED
//! which seed is the first, SUPERSURFACE_TELL=1 names every scene that is slow or moves.

#![allow(clippy::print_stdout)]

#[path = "../tests/it/scenes.rs"]
#[allow(dead_code)]
mod scenes;

use cpu_time::ProcessTime;
use supersurface::scene::{Layout, arrange, draw};
use supersurface_io::read_things;
use supersurface_physics::{SettleOptions, settle_scene};

/// Bodies of a scene that is not a single one.
const BODIES: usize = 10;

fn main() {
    let count = scenes::count("SUPERSURFACE_SCENES", 20);
    let first = scenes::count("SUPERSURFACE_SEED", 1);
    let tell = scenes::count("SUPERSURFACE_TELL", 0) > 0;
    println!(
        "things     layout   CPU ms: middle, 9 of 10, most; at rest; lost; overlap mm, simulated mm"
    );
    for things in ["household", "members"] {
        let recipes = read_things(things).unwrap();
        for layout in [Layout::Single, Layout::Pile, Layout::Packed, Layout::Shelf] {
            let bodies = if layout == Layout::Single { 1 } else { BODIES };
            let (mut times, mut at_rest, mut lost) = (Vec::new(), 0, 0);
            let (mut overlap, mut simulated) = (0.0f64, 0.0f64);
            for seed in first..first + count {
                let start = ProcessTime::now();
                let drawn = draw(&recipes, bodies, seed).unwrap();
                let mut scene = arrange(drawn, layout, seed).unwrap();
                let settled = settle_scene(&mut scene, &SettleOptions::default()).unwrap();
                let time = start.elapsed().as_secs_f64() * 1e3;
                times.push(time);
                at_rest += u64::from(settled.all_at_rest());
                lost += settled.bodies.iter().filter(|b| b.lost).count();
                overlap = overlap.max(settled.overlap);
                simulated = simulated.max(settled.simulated_overlap);
                if tell {
                    let moving: Vec<&str> = scene
                        .bodies
                        .iter()
                        .zip(&settled.bodies)
                        .filter(|(_, rest)| !rest.at_rest)
                        .map(|(body, _)| body.name.as_str())
                        .collect();
                    println!(
                        "  seed {seed}: {time:.0} ms, {:.2} s, moving {moving:?}",
                        settled.time
                    );
                }
            }
            times.sort_by(f64::total_cmp);
            let [middle, most_of, most] = [0.5, 0.9, 1.0]
                .map(|share: f64| times[(share * (times.len() - 1) as f64) as usize]);
            let layout = format!("{layout:?}").to_lowercase();
            let (overlap, simulated) = (overlap * 1e3, simulated * 1e3);
            println!(
                "{things:10} {layout:8} {middle:7.1} {most_of:7.1} {most:7.1}; {at_rest} of {count}; {lost}; {overlap:.4}, {simulated:.4}"
            );
        }
    }
}
