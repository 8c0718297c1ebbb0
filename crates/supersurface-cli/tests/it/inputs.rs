//! One scene by every door: standard input, text, units, frames, depth images, given objects.

use std::fmt::Write;
use std::path::PathBuf;

use serde_json::Value;
use supersurface::cloud::PointCloud;
use supersurface::scene::{DepthNoise, Look, demo, look};

use crate::{run, run_on, scratch, text};

fn seen() -> (PointCloud, Look) {
    let made = demo(1).unwrap();
    let seen = look(&made.scene, &made.camera, &made.camera_pose, &DepthNoise::default(), 1);
    (PointCloud::from_depth(&seen.depth, &made.camera), seen)
}

/// The cloud as text, without its missing readings, in units of `unit` metres.
fn xyz(cloud: &PointCloud, unit: f64) -> String {
    let mut out = String::new();
    for p in cloud.points.iter().filter(|p| p.x.is_finite()) {
        let _ = writeln!(out, "{} {} {}", p.x / unit, p.y / unit, p.z / unit);
    }
    out
}

fn position(object: &Value) -> Vec<f64> {
    let list = object["surface"]["position"].as_array().unwrap();
    list.iter().map(|v| v.as_f64().unwrap()).collect()
}

/// Every object of one report has one of the other within `tolerance` metres.
fn same_objects(a: &Value, b: &Value, tolerance: f64) {
    let (a, b) = (a["objects"].as_array().unwrap(), b["objects"].as_array().unwrap());
    assert_eq!(a.len(), b.len());
    for object in a {
        let p = position(object);
        let near = |o: &Value| {
            position(o).iter().zip(&p).map(|(u, v)| (u - v) * (u - v)).sum::<f64>().sqrt()
        };
        let least = b.iter().map(near).fold(f64::INFINITY, f64::min);
        assert!(least < tolerance, "{object} is {least} m from all others");
    }
}

#[test]
fn standard_input_and_a_file_without_pixels() {
    let cloud = xyz(&seen().0, 1.0);
    let file = scratch("demo.xyz");
    std::fs::write(&file, &cloud).unwrap();
    let piped = run_on(&["grasp", "-", "--json"], cloud.as_bytes()).ended(0).json();
    let read = run(&["grasp", text(&file), "--json"]).ended(0).json();
    assert_eq!(piped["objects"], read["objects"]);
    assert_eq!(piped["source"], "standard input");
    // the organised cloud is searched in another way, and finds the same
    same_objects(&run(&["demo", "--json"]).ended(0).json(), &read, 0.004);
}

#[test]
fn objects_alone_are_those_that_are_held() {
    let cloud = xyz(&seen().0, 1.0);
    let [labels, picture] = ["alone.npy", "alone.png"].map(scratch);
    let to = ["--labels", text(&labels), "--png", text(&picture)];
    let alone = run_on(&[&["segment", "-", "--json"], &to[..]].concat(), cloud.as_bytes());
    let alone = alone.ended(0).json();
    let held = run_on(&["grasp", "-", "--json"], cloud.as_bytes()).ended(0).json();
    assert!(alone["gripper"].is_null() && held["gripper"] == "panda_hand");
    let objects = alone["objects"].as_array().unwrap();
    assert_eq!(objects.len(), held["objects"].as_array().unwrap().len());
    for (a, b) in objects.iter().zip(held["objects"].as_array().unwrap()) {
        assert_eq!((&a["surface"], &a["points"]), (&b["surface"], &b["points"]));
        assert!(a["grasps"].as_array().unwrap().is_empty() && a["refusal"].is_null());
    }
    assert!(labels.exists() && picture.exists());
    run_on(&["segment", "-"], b"").ended(3);
    let twice = ["segment", "-", "--labels", text(&labels), "--png", text(&labels)];
    run(&twice).ended(2);
}

#[test]
fn millimetres_are_noticed_and_read() {
    let cloud = xyz(&seen().0, 1e-3);
    let ran = run_on(&["grasp", "-", "--json"], cloud.as_bytes());
    assert!(ran.stderr.contains("this looks like millimetres: pass --units mm"), "{}", ran.stderr);
    assert!(ran.json()["warnings"][0].as_str().unwrap().contains("--units mm"));
    let ran = run_on(&["grasp", "-", "--json", "--units", "mm"], cloud.as_bytes()).ended(0);
    assert!(ran.stderr.is_empty(), "{}", ran.stderr);
    same_objects(&run(&["demo", "--json"]).ended(0).json(), &ran.json(), 0.004);
}

#[test]
fn centimetres_are_noticed_and_a_viewpoint_is_considered_before() {
    let cloud = xyz(&seen().0, 1e-2);
    let ran = run_on(&["grasp", "-", "--json"], cloud.as_bytes());
    assert!(ran.stderr.contains("this looks like centimetres: pass --units cm"), "{}", ran.stderr);
    let ran = run_on(&["grasp", "-", "--json", "--units", "cm"], cloud.as_bytes()).ended(0);
    assert!(ran.stderr.is_empty(), "{}", ran.stderr);
    // a frame whose origin is far away, with the sensor beside the table
    let mut far = String::new();
    for p in seen().0.points.iter().filter(|p| p.x.is_finite()) {
        let _ = writeln!(far, "{} {} {}", p.x + 500.0, p.y, p.z);
    }
    let ran = run_on(&["grasp", "-", "--json", "--viewpoint", "500,0,0"], far.as_bytes()).ended(0);
    assert!(ran.stderr.is_empty(), "{}", ran.stderr);
}

#[test]
fn a_camera_pose_moves_every_result() {
    let cloud = xyz(&seen().0, 1.0);
    let file = scratch("moved.xyz");
    std::fs::write(&file, &cloud).unwrap();
    let plain = run(&["grasp", text(&file), "--json"]).ended(0).json();
    // half a turn about x and one metre up: (x, y, z) becomes (x, -y, 1 - z)
    let ways = ["0,0,1,0,1,0,0", "1,0,0,0,0,-1,0,0,0,0,-1,1,0,0,0,1"];
    for pose in ways {
        let moved = run(&["grasp", text(&file), "--json", "--camera-pose", pose]).ended(0).json();
        assert_eq!(moved["frame"]["id"], "robot");
        let mut back = plain.clone();
        for object in back["objects"].as_array_mut().unwrap() {
            let p = position(object);
            object["surface"]["position"] = vec![p[0], -p[1], 1.0 - p[2]].into();
        }
        same_objects(&back, &moved, 0.003);
        let (n, m) = (&plain["plane"]["normal"], &moved["plane"]["normal"]);
        assert!((n[1].as_f64().unwrap() + m[1].as_f64().unwrap()).abs() < 1e-3);
    }
}

/// A 16-bit PNG in `tests`' own folder.
fn png(name: &str, size: [usize; 2], values: impl Iterator<Item = u16>) -> PathBuf {
    let file = scratch(name);
    let out = std::fs::File::create(&file).unwrap();
    let mut encoder = png::Encoder::new(out, size[0] as u32, size[1] as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let bytes: Vec<u8> = values.flat_map(u16::to_be_bytes).collect();
    encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
    file
}

#[test]
fn a_depth_image_with_flags_or_a_camera_file() {
    let (_, seen) = seen();
    let depth = seen.depth.depth().iter().map(|d| (1e4 * f64::from(*d)).round() as u16);
    let image = png("depth.png", [640, 480], depth);
    let flags = ["--intrinsics", "615,615,319.5,239.5", "--depth-scale", "10000"];
    let mut arguments = vec!["grasp", text(&image), "--json"];
    arguments.extend(flags);
    let by_flags = run(&arguments).ended(0).json();
    same_objects(&run(&["demo", "--json"]).ended(0).json(), &by_flags, 0.003);
    let camera = scratch("camera.json");
    let json = r#"{"width": 640, "height": 480, "fx": 615, "fy": 615, "cx": 319.5, "cy": 239.5,
                   "depth_scale": 10000, "D": [0, 0, 0, 0, 0]}"#;
    std::fs::write(&camera, json).unwrap();
    let by_file =
        run(&["grasp", text(&image), "--json", "--camera", text(&camera)]).ended(0).json();
    assert_eq!(by_flags["objects"], by_file["objects"]);
    let ran = run(&["grasp", text(&image)]).ended(3);
    assert!(
        ran.stderr.contains("--camera") && ran.stderr.contains("--intrinsics"),
        "{}",
        ran.stderr
    );
}

#[test]
fn given_objects_are_taken_and_labels_are_not_taken_unasked() {
    let (cloud, seen) = seen();
    let depth = seen.depth.depth().iter().map(|d| (1e4 * f64::from(*d)).round() as u16);
    let image = png("masked.png", [640, 480], depth);
    let only = |l: u32| if l == 3 { 7 } else { 0 };
    let mask = png("mask.png", [640, 480], seen.labels.iter().map(|l| only(*l) as u16));
    let flags = ["--intrinsics", "615,615,319.5,239.5", "--depth-scale", "10000"];
    let mut arguments = vec!["grasp", text(&image), "--json", "--mask", text(&mask)];
    arguments.extend(flags);
    let masked = run(&arguments).ended(0).json();
    let objects = masked["objects"].as_array().unwrap();
    assert_eq!(objects.len(), 1);
    assert_eq!(objects[0]["surface"]["type"], "supertoroid");

    let mut ply = String::from("ply\nformat ascii 1.0\n");
    let rows: Vec<(usize, &supersurface::Point)> =
        cloud.points.iter().enumerate().filter(|(_, p)| p.x.is_finite()).collect();
    let _ = writeln!(ply, "element vertex {}", rows.len());
    ply += "property float x\nproperty float y\nproperty float z\nproperty int thing\nend_header\n";
    for (i, p) in rows {
        let _ = writeln!(ply, "{} {} {} {}", p.x, p.y, p.z, only(seen.labels[i]));
    }
    let asked = run_on(&["grasp", "-", "--json", "--instances", "thing"], ply.as_bytes());
    assert_eq!(asked.ended(0).json()["objects"].as_array().unwrap().len(), 1);
    let unasked = run_on(&["grasp", "-", "--json"], ply.as_bytes()).ended(0).json();
    assert_eq!(unasked["objects"].as_array().unwrap().len(), 5);
    let wrong = run_on(&["grasp", "-", "--instances", "nothing"], ply.as_bytes()).ended(3);
    assert!(wrong.stderr.contains("thing"), "the fields are named: {}", wrong.stderr);
}

#[test]
fn an_object_around_the_origin_is_taken_as_seen_from_all_around() {
    let mut cloud = String::new();
    for i in 0..60 {
        let (s, c) = (f64::from(i) * std::f64::consts::TAU / 60.0).sin_cos();
        for k in 0..30 {
            let _ = writeln!(cloud, "{} {} {}", 0.03 * c, 0.03 * s, 0.004 * f64::from(k) - 0.058);
        }
    }
    let ran = run_on(&["grasp", "-", "--segmented", "--json"], cloud.as_bytes()).ended(0);
    assert!(ran.stderr.contains("within the object"), "{}", ran.stderr);
    assert!(!ran.json()["objects"][0]["grasps"].as_array().unwrap().is_empty());
}
