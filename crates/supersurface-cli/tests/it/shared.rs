//! Real scenes and broken files of the shared folder; nothing is done without it.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::{finished, run, shared, text};

fn json(file: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap()
}

#[test]
fn broken_files_end_in_words_with_little_memory() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/odd");
    for (name, case) in json(&folder.join("expected.json"))["files"].as_object().unwrap() {
        let file = folder.join(name);
        let began = Instant::now();
        let script = "ulimit -v 500000; exec \"$0\" grasp \"$1\" --json";
        let binary = env!("CARGO_BIN_EXE_supersurface");
        let ran = finished(Command::new("sh").args(["-c", script, binary, text(&file)]));
        let took = began.elapsed();
        let wanted: &[i32] = match case["expect"].as_str().unwrap() {
            "ok" if name.ends_with(".las") => &[3],
            "ok" => &[0, 4],
            "error" => &[3],
            _ => &[0, 3, 4],
        };
        let status = ran.status.unwrap_or(-1);
        assert!(wanted.contains(&status), "{name}: {status} {}", ran.stderr);
        assert!(status == 0 || ran.stderr.contains(name.as_str()), "{name}: {}", ran.stderr);
        assert!(took < Duration::from_secs(1), "{name} took {took:?}");
        let report = ran.json();
        for (field, said) in [("points", &case["points"]), ("finite", &case["finite"])] {
            if case["expect"] == "ok" && !name.ends_with(".las") && said.is_u64() {
                assert_eq!(&report["cloud"][field], said, "{name}: {field}");
            }
        }
    }
}

#[test]
fn real_scenes_keep_their_tables_and_counts() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/real");
    let (mut tables, mut bare, mut right, mut counted) = (0, 0, 0, 0);
    for (name, truth) in json(&folder.join("ground_truth.json"))["scenes"].as_object().unwrap() {
        let path = folder.join(name);
        let mut arguments = vec!["grasp", "--json", "-q"];
        let (depth, camera) = (path.join("depth.png"), path.join("camera.json"));
        if path.is_dir() {
            arguments.extend([text(&depth), "--camera", text(&camera)]);
        } else {
            arguments.push(text(&path));
        }
        let kind = truth["plane_kind"].as_str().unwrap_or_default();
        if ["none", "already"].iter().any(|k| kind.starts_with(k)) {
            continue;
        }
        let report = run(&arguments).json();
        let has_table = ["table", "floor", "tote", "desk"].iter().any(|k| kind.contains(k));
        let plane = &report["plane"];
        if !has_table {
            assert!(plane.is_null(), "{name}: {plane}");
            bare += 1;
            continue;
        }
        let part = |k: usize| plane["normal"][k].as_f64().unwrap_or(0.0);
        let cosine: f64 = (0..3).map(|k| part(k) * truth["plane"][k].as_f64().unwrap()).sum();
        assert!(cosine > 3f64.to_radians().cos(), "{name}: {plane}");
        tables += 1;
        let named = |k: usize| truth["accept_clusters"][k].as_u64();
        let exact = truth["n_objects"].as_u64().filter(|_| truth["objects"].is_array());
        if let Some(least) = named(0).or(exact) {
            let most = named(1).or(exact).unwrap_or(least);
            let found = report["objects"].as_array().unwrap().len() as u64;
            counted += 1;
            right += usize::from((least..=most).contains(&found));
        }
    }
    assert!(tables >= 16 && bare >= 3, "{tables} tables, {bare} scenes without one");
    assert!(counted >= 13 && right == counted, "{right} of {counted} counts");
}

#[test]
fn real_rings_are_toroids_and_real_packages_are_not() {
    let Some(shared) = shared() else { return };
    let family = |file: &str| {
        let path = shared.join(file);
        let report = run(&["grasp", text(&path), "--segmented", "--json"]).ended(0).json();
        report["objects"][0]["surface"]["type"].as_str().unwrap().to_owned()
    };
    for ring in ["roll", "bearing", "gear"] {
        assert_eq!(family(&format!("data/fit_real/ply/tor_{ring}.ply")), "supertoroid", "{ring}");
    }
    for solid in ["milk_object", "krylon"] {
        assert_eq!(family(&format!("data/real/{solid}.pcd")), "superellipsoid", "{solid}");
    }
}

#[test]
fn verified_contacts_are_met_and_bounded() {
    let Some(shared) = shared() else { return };
    let file = shared.join("data/contact/cases.json");
    let words = ["contact", "--cases", text(&file), "-o", "-", "--repeat", "0"];
    let told = run(&words).ended(0).stdout;
    let cases = json(&file);
    let cases = cases.as_array().unwrap();
    assert_eq!(told.lines().count(), cases.len());
    for (case, line) in cases.iter().zip(told.lines()) {
        let line: Value = serde_json::from_str(line).unwrap();
        assert!(line["id"] == case["id"] && line["status"] == "ok", "{line}");
        let [size, low, high, truth] = [
            &case["scale"],
            &case["truth"]["lo"],
            &case["truth"]["hi"],
            &case["truth"]["signed_distance"],
        ]
        .map(|v| v.as_f64().unwrap());
        let [distance, lo, hi] = ["signed_distance", "lo", "hi"].map(|k| line[k].as_f64().unwrap());
        let near = 1e-9 * size;
        assert!(low - near <= distance && distance <= high + near, "{line}");
        assert!(distance * truth > 0.0 || truth.abs() <= near, "{line}");
        assert!(lo <= distance && distance <= hi, "{line}");
        assert!(lo <= high + 1e-13 * size && hi >= low - 1e-13 * size, "{line}");
    }
}
