//! What a run leaves: report, labels, grasps, picture.

use serde_json::Value;

use crate::{run, scratch, text};

fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn the_demo_is_recovered_and_held() {
    let ran = run(&["demo", "--json", "--top", "4"]).ended(0);
    assert!(ran.stderr.is_empty(), "{}", ran.stderr);
    let report = ran.json();
    assert_eq!(report["format"], "supersurface-report");
    assert_eq!(report["version"], 1);
    assert_eq!(report["units"]["quaternion"], "wxyz");
    assert_eq!(report["cloud"]["points"], 640 * 480);
    let normal = numbers(&report["plane"]["normal"]);
    // the demo's camera looks down by 45 degrees
    assert!((normal[1] + 0.5f64.sqrt()).abs() < 0.01, "{normal:?}");
    let objects = report["objects"].as_array().unwrap();
    assert_eq!(objects.len(), 5);
    let rings = objects.iter().filter(|o| o["surface"]["type"] == "supertoroid").count();
    assert_eq!(rings, 1);
    for object in objects {
        assert!(object["residual"].as_f64().unwrap() < 0.002, "{object}");
        assert!(object["inlier_share"].as_f64().unwrap() > 0.9, "{object}");
        let grasps = object["grasps"].as_array().unwrap();
        assert!((1..=4).contains(&grasps.len()), "{object}");
        let scores: Vec<f64> = grasps.iter().map(|g| g["score"].as_f64().unwrap()).collect();
        assert!(scores.is_sorted_by(|a, b| a >= b), "{scores:?}");
        for grasp in grasps {
            let turn = numbers(&grasp["orientation_wxyz"]);
            assert!((turn.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-9);
            assert!(turn[0] >= 0.0);
            let opening = grasp["opening"].as_f64().unwrap();
            assert!((0.0..=0.080).contains(&opening), "{opening}");
            assert!(grasp["contact_width"].as_f64().unwrap() <= opening || grasp["inside"] == true);
            for term in grasp["terms"].as_object().unwrap().values() {
                assert!((0.0..=1.0).contains(&term.as_f64().unwrap()), "{grasp}");
            }
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let without_times = |threads: &str| {
        let mut report = run(&["demo", "--json", "--threads", threads]).ended(0).json();
        report["timing_s"].take();
        report
    };
    assert_eq!(without_times("1"), without_times("5"));
}

#[test]
fn files_hold_what_was_found() {
    let [labels, grasps, picture] = ["demo.npy", "demo.json", "demo.png"].map(scratch);
    run(&[
        "demo",
        "--seed",
        "3",
        "-q",
        "--gripper",
        "suction_cup_30",
        "--labels",
        text(&labels),
        "--grasps",
        text(&grasps),
        "--png",
        text(&picture),
    ])
    .ended(0);
    let bytes = std::fs::read(&labels).unwrap();
    assert!(bytes.starts_with(b"\x93NUMPY"));
    let values: Vec<i32> = bytes[bytes.len() - 4 * 640 * 480..]
        .chunks_exact(4)
        .map(|b| i32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    assert_eq!(values.iter().max(), Some(&5));
    assert!(values.iter().filter(|v| **v == 0).count() > 50_000, "the table");
    let file: Value = serde_json::from_slice(&std::fs::read(&grasps).unwrap()).unwrap();
    assert_eq!(file["format"], "grasps");
    assert_eq!(file["gripper"], "suction_cup_30");
    let list = file["grasps"].as_array().unwrap();
    assert!(!list.is_empty() && list.iter().all(|g| g["type"] == "suction"));
    // the last row of a pose is that of a rigid motion
    assert_eq!(numbers(&list[0]["pose"][3]), [0.0, 0.0, 0.0, 1.0]);
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn the_table_shows_every_object_and_why_some_are_not_held() {
    let shown = run(&["demo", "--top", "1"]).ended(0).stdout;
    assert!(shown.starts_with("table: normal"), "{shown}");
    assert_eq!(shown.matches("superellipsoid").count(), 4, "{shown}");
    assert!(shown.matches(" mm  ").count() >= 5, "{shown}");
    assert!(!shown.contains("-0.000"), "{shown}");
    // a jaw too small for all of them
    let toml = include_str!("../../../supersurface-io/grippers/panda_hand.toml")
        .replace("max_opening = 0.080", "max_opening = 0.012");
    let file = scratch("small.toml");
    std::fs::write(&file, toml).unwrap();
    let shown = run(&["demo", "--gripper", text(&file)]).ended(0).stdout;
    assert!(shown.contains("wider than the jaw"), "{shown}");
    assert!(shown.contains("against 0.012 m"), "{shown}");
}

#[test]
fn the_first_grasps_hold_what_the_scene_is_made_of() {
    // the made scene's own sizes: no opening under the narrowest width of the body it closes on
    let report = run(&["demo", "--json"]).ended(0).json();
    for object in report["objects"].as_array().unwrap() {
        let half = numbers(&object["surface"]["semi_axes"]);
        let narrow = 2.0 * half.iter().copied().fold(f64::INFINITY, f64::min);
        let width = object["grasps"][0]["contact_width"].as_f64().unwrap();
        assert!(width > 0.8 * narrow, "{width} against {narrow}");
    }
}
