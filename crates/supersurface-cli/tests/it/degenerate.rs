//! Clouds from which nothing can follow: an answer in words, never a panic.

use std::fmt::Write;

use crate::run_on;

fn lines(points: impl Iterator<Item = [f64; 3]>) -> String {
    let mut out = String::from("x y z\n");
    for [x, y, z] in points {
        let _ = writeln!(out, "{x} {y} {z}");
    }
    out
}

/// A table with a box on it, all lengths times `scale`.
fn scene(scale: f64) -> String {
    let table =
        (0..3600).map(|k| [f64::from(k % 60) * 0.01 - 0.3, f64::from(k / 60) * 0.01 - 0.3, 1.0]);
    let lid = (0..400).map(|k| [f64::from(k % 20) * 0.003, f64::from(k / 20) * 0.003, 0.95]);
    lines(table.chain(lid).map(|p| p.map(|v| v * scale)))
}

/// Every way of looking at a cloud ends with a status of its own.
fn ends(name: &str, cloud: &str) {
    for options in [&["grasp", "-", "--json"][..], &["grasp", "-", "--segmented", "--json"]] {
        for model in ["auto", "supertoroid"] {
            let mut arguments = options.to_vec();
            arguments.extend(["--model", model]);
            let ran = run_on(&arguments, cloud.as_bytes());
            assert!(!ran.stderr.contains("panicked"), "{name}: {}", ran.stderr);
            assert!(
                matches!(ran.status, Some(0 | 3 | 4)),
                "{name}: {:?} {}",
                ran.status,
                ran.stderr
            );
            let report = ran.json();
            assert_eq!(report["format"], "supersurface-report", "{name}");
            if ran.status != Some(0) {
                assert!(ran.stderr.contains("error: standard input"), "{name}: {}", ran.stderr);
            }
        }
    }
}

#[test]
fn few_points() {
    for n in [0, 1, 2, 3, 4, 11, 12, 29, 30, 40] {
        let corner = (0..n).map(|k| {
            let t = f64::from(k);
            [0.1 * (1.3 * t).sin(), 0.1 * (2.1 * t).cos(), 1.0 + 0.05 * (0.7 * t).sin()]
        });
        ends(&format!("{n} points"), &lines(corner));
    }
}

#[test]
fn no_extent() {
    ends("one place", &lines((0..500).map(|_| [0.1, 0.2, 0.9])));
    ends("a line", &lines((0..500).map(|k| [0.001 * f64::from(k), 0.0, 1.0])));
    ends(
        "a plane",
        &lines((0..900).map(|k| [0.01 * f64::from(k % 30), 0.01 * f64::from(k / 30), 1.0])),
    );
    ends("two places", &lines((0..500).map(|k| [f64::from(k % 2), 0.0, 1.0])));
    ends("the viewpoint", &lines((0..500).map(|_| [0.0; 3])));
}

#[test]
fn numbers_that_are_none() {
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    ends("all NaN", &lines((0..100).map(|_| [f64::NAN; 3])));
    let mixed = (0..3000).map(|k| {
        let t = f64::from(k);
        let p = [0.3 * (0.37 * t).sin(), 0.3 * (0.91 * t).cos(), 1.0];
        if k % 7 == 0 { [odd[k as usize % 3], p[1], p[2]] } else { p }
    });
    ends("some NaN", &lines(mixed));
    ends("huge", &lines((0..500).map(|k| [1e300 * f64::from(k), -1e308, 1e305])));
    ends("tiny", &lines((0..500).map(|k| [1e-300 * f64::from(k), 1e-310, 1e-305])));
}

#[test]
fn what_is_too_far_is_not_said_to_be_no_number() {
    let far = lines((0..500).map(|k| [1e300 * f64::from(k), -1e308, 1e305]));
    for options in [&["grasp", "-"][..], &["grasp", "-", "--segmented"]] {
        let ran = run_on(options, far.as_bytes()).ended(4);
        assert!(ran.stderr.contains("within 100,000 km; check --units"), "{}", ran.stderr);
        let ran = run_on(options, lines((0..99).map(|_| [f64::NAN; 3])).as_bytes()).ended(4);
        assert!(!ran.stderr.contains("--units"), "{}", ran.stderr);
    }
}

#[test]
fn any_scale() {
    for scale in [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9] {
        ends(&format!("scale {scale}"), &scene(scale));
    }
}
