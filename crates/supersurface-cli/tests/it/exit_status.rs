//! The exit status and what standard error says with it.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::{command, finished, run, run_on, scratch, text};

#[test]
fn wrong_use_is_2() {
    run(&[]).ended(2);
    run(&["grasp"]).ended(2);
    run(&["demo", "--threads", "0"]).ended(2);
    run(&["grasp", "x.png", "--intrinsics", "500,500,320", "--depth-scale", "1000"]).ended(2);
    run(&["grasp", "x.pcd", "--camera-pose", "0,0,0,2,0,0,0"]).ended(3);
    let file = scratch("pose.xyz");
    std::fs::write(&file, "0 0 1\n1 0 1\n").unwrap();
    let ran = run(&["grasp", text(&file), "--camera-pose", "0,0,0,2,0,0,0"]).ended(2);
    assert!(ran.stderr.contains("quaternion"), "{}", ran.stderr);
    let ran = run(&["grasp", text(&file), "--viewpoint", "0,0"]).ended(2);
    assert!(ran.stderr.contains("--viewpoint"), "{}", ran.stderr);
}

#[test]
fn unreadable_input_is_3_and_named() {
    let ran = run(&["grasp", "no_such_cloud.pcd", "--json"]).ended(3);
    assert!(ran.stderr.contains("no_such_cloud.pcd"));
    let report = ran.json();
    assert!(report["plane"].is_null() && report["cloud"].is_null());
    assert!(report["message"].as_str().unwrap().contains("no_such_cloud.pcd"));
    let ran = run(&["demo", "--gripper", "no_such_gripper"]).ended(3);
    assert!(ran.stderr.contains("panda_hand"), "built-in grippers are offered: {}", ran.stderr);
    let ran = run_on(&["grasp", "-"], b"").ended(3);
    assert!(ran.stderr.contains("standard input"), "{}", ran.stderr);
}

#[test]
fn no_table_is_4_with_a_report_whose_plane_is_null() {
    // a ball in the air
    let mut cloud = String::new();
    for i in 0..60 {
        for j in 0..60 {
            let (s, c) = (f64::from(i) * 0.05).sin_cos();
            let (t, u) = (f64::from(j) * 0.1).sin_cos();
            cloud += &format!("{} {} {}\n", 0.1 * s * u, 0.1 * s * t, 1.0 + 0.1 * c);
        }
    }
    let [labels, grasps] = ["ball.npy", "ball.json"].map(scratch);
    let options = ["grasp", "-", "--json", "--labels", text(&labels), "--grasps", text(&grasps)];
    let ran = run_on(&options, cloud.as_bytes()).ended(4);
    let report = ran.json();
    assert!(report["plane"].is_null() && report["objects"].as_array().unwrap().is_empty());
    assert!(report["message"].as_str().unwrap().contains("--segmented"), "{report}");
    assert!(labels.exists() && grasps.exists(), "programs find what they asked for");
    run_on(&["grasp", "-", "--segmented"], cloud.as_bytes()).ended(0);
}

#[test]
fn a_bare_table_is_4_with_its_plane_as_the_report_document_says() {
    let table: String = (0..3600)
        .map(|k| format!("{} {} 1\n", 0.01 * f64::from(k % 60), 0.01 * f64::from(k / 60)))
        .collect();
    let ran =
        run_on(&["grasp", "-", "--json", "--viewpoint", "0.3,0.3,0"], table.as_bytes()).ended(4);
    let report = ran.json();
    assert!(
        report["plane"]["normal"].is_array() && report["objects"].as_array().unwrap().is_empty()
    );
    assert_eq!(report["message"], "nothing stands on the table");
    let document = include_str!("../../../../docs/report.md");
    assert!(document.contains("its `plane` is the table"));
}

#[test]
fn output_that_cannot_be_written_is_5_and_named() {
    for option in ["--png", "--labels", "--grasps"] {
        let ran = run(&["demo", option, "/no_such_folder/file"]).ended(5);
        assert!(ran.stderr.contains("/no_such_folder/file"), "{}", ran.stderr);
    }
}

#[test]
fn outputs_that_would_replace_each_other_or_an_input_are_2() {
    let [cloud, new, toml] = ["same.xyz", "same.out", "same.toml"].map(scratch);
    std::fs::write(&cloud, "1 1 1\n").unwrap();
    std::fs::write(&toml, "name = 1\n").unwrap();
    let round = new.parent().unwrap().join(".").join("same.out");
    for arguments in [
        &["demo", "--labels", text(&new), "--grasps", text(&round)][..],
        &["demo", "--grasps", text(&new), "--png", text(&new)],
        &["demo", "--gripper", text(&toml), "--png", text(&toml)],
        &["grasp", text(&cloud), "--labels", text(&cloud)],
        &["grasp", "-", "--mask", text(&cloud), "--png", text(&cloud)],
        &["grasp", "-", "--camera", text(&cloud), "--grasps", text(&cloud)],
    ] {
        let ran = run(arguments).ended(2);
        assert!(ran.stderr.contains("same.") && ran.stderr.contains("another output"));
        assert!(ran.stdout.is_empty() && !new.exists());
    }
    assert_eq!(std::fs::read(&cloud).unwrap(), b"1 1 1\n");
    #[cfg(unix)]
    run(&["demo", "--labels", "/dev/null", "--grasps", "/dev/null"]).ended(0);
}

#[test]
fn an_output_that_fails_costs_no_other() {
    let [grasps, picture, empty] = ["kept.json", "kept.png", "empty.xyz"].map(scratch);
    let outputs = ["--labels", "/no_such_folder/l", "--grasps", text(&grasps), "--json"];
    let picture = ["--png", text(&picture)];
    let ran = run(&[&["demo"], &outputs[..], &picture[..]].concat()).ended(5);
    assert_eq!(ran.json()["objects"].as_array().unwrap().len(), 5);
    assert!(grasps.exists() && Path::new(picture[1]).exists());
    let ran =
        run(&["demo", "--labels", "/no_such_folder/l", "--png", "/no_such_folder/p"]).ended(5);
    assert_eq!(ran.stderr.matches("error: /no_such_folder/").count(), 2, "{}", ran.stderr);
    // a run without a result keeps its status and its report
    std::fs::write(&empty, "1 1 1\n").unwrap();
    let ran = run(&[&["grasp", text(&empty)], &outputs[..]].concat()).ended(4);
    assert!(ran.stderr.contains("/no_such_folder/l") && ran.json()["message"].is_string());
    let ran = run(&[&["grasp", "no_such_cloud.pcd"], &outputs[..]].concat()).ended(3);
    assert!(ran.stderr.contains("/no_such_folder/l") && ran.json()["message"].is_string());
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut command = command(&["demo"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[cfg(unix)]
#[test]
fn a_full_standard_error_costs_no_status() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut command = command(&["grasp", "no_such_cloud.pcd"]);
    assert_eq!(command.stderr(full).status().unwrap().code(), Some(3));
}

#[cfg(target_os = "linux")]
#[test]
fn more_threads_than_the_system_carries_are_fewer_with_a_warning() {
    for absurd in ["0", "-1", "two", "99999999", "99999999999999999999999"] {
        let mut command = command(&["demo", "-q"]);
        finished(command.env("RAYON_NUM_THREADS", absurd)).ended(0);
    }
    for line in ["\"$0\" demo --threads 64", "RAYON_NUM_THREADS=64 \"$0\" demo"] {
        let script = format!("ulimit -v 500000; {line}");
        let binary = env!("CARGO_BIN_EXE_supersurface");
        let ran = finished(Command::new("sh").args(["-c", &script, binary])).ended(0);
        assert!(ran.stderr.contains("instead of 64") && ran.stderr.contains("--threads"));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_memory_does_not_hold_is_3_and_said_so() {
    let file = scratch("sparse.xyz");
    std::fs::File::create(&file).unwrap().set_len(1 << 30).unwrap();
    let script = "ulimit -v 500000; exec \"$0\" grasp \"$1\"";
    let binary = env!("CARGO_BIN_EXE_supersurface");
    let ran = finished(Command::new("sh").args(["-c", script, binary, text(&file)])).ended(3);
    std::fs::remove_file(&file).unwrap();
    assert!(ran.stderr.contains("1073741824 bytes do not fit into memory"), "{}", ran.stderr);
}
