//! `supersurface scene`: the same bytes on any number of threads, files that are read back, and what goes wrong.

use std::fs;
use std::path::{Path, PathBuf};

use supersurface_io::read_scene;

use crate::{run, scratch, text};

/// All files under a folder with their bytes, in order.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_owned();
                found.push((name, fs::read(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn a_scene_is_the_same_bytes_on_any_number_of_threads() {
    let mut first = None;
    for threads in ["1", "2", "8"] {
        let folder = scratch(&format!("scene_{threads}"));
        let words =
            ["scene", "random", "-n", "3", "--layout", "packed", "--seed", "5", "--views", "2"];
        let more = ["--formats", "all", "--threads", threads, "-o", text(&folder)];
        let told = run(&[&words[..], &more[..]].concat()).ended(0).stdout;
        assert!(told.contains("at rest after") && told.contains("scene.xml"), "{told}");
        let made = files(&folder);
        let names: Vec<&str> = made.iter().filter_map(|(name, _)| name.to_str()).collect();
        for name in ["scene.json", "scene.usda", "view_001/depth.png", "view_001/cloud.pcd"] {
            assert!(names.contains(&name), "{names:?}");
        }
        let made = first.get_or_insert_with(|| made.clone()).iter().zip(&made);
        for (old, new) in made {
            assert!(old == new, "{} differs on {threads} threads", new.0.display());
        }
        // what is written is read back, and the camera's cloud holds the bodies
        let scene = read_scene(&folder.join("scene.json")).unwrap();
        assert_eq!((scene.scene.bodies.len(), scene.extras.cameras.len()), (3, 2));
        assert!(scene.extras.touches.len() >= 3);
        let cloud = folder.join("view_000/cloud.pcd");
        let found = run(&["segment", text(&cloud), "--json"]).ended(0).json();
        let objects = found["objects"].as_array().map_or(0, Vec::len);
        // two boxes, and a hammer that comes in its parts
        assert!((3..=5).contains(&objects), "{found}");
        let (depth, camera) =
            (folder.join("view_000/depth.png"), folder.join("view_000/camera.json"));
        let words = ["segment", text(&depth), "--camera", text(&camera), "--json"];
        let found = run(&words).ended(0).json();
        let objects = found["objects"].as_array().map_or(0, Vec::len);
        assert!((3..=5).contains(&objects), "{found}");
    }
}

#[test]
fn what_is_wrong_with_a_scene_is_said() {
    let folder = scratch("scene_wrong");
    let output = text(&folder);
    let random = |more: &[&str]| run(&[&["scene", "random", "-o", output], more].concat());
    let told = random(&["--layout", "single", "-n", "2"]).ended(3).stderr;
    assert!(told.contains("one body"), "{told}");
    let told = random(&["--things", "nothing"]).ended(3).stderr;
    assert!(told.contains("household"), "{told}");
    let told = random(&["--deviation", "nan"]).ended(2).stderr;
    assert!(told.contains("--deviation"), "{told}");
    random(&["-n", "0"]).ended(2);
    let things = scratch("scene_wrong_things.toml");
    let kind =
        "[[kind]]\nname = \"x\"\ndensity = 500\nfriction = 0.5\nshape.hammer = { length = -1 }\n";
    fs::write(&things, kind).unwrap();
    let told = random(&["--things", text(&things), "-n", "1"]).ended(3).stderr;
    assert!(told.contains("semi-axis"), "{told}");
    let file = scratch("scene_wrong_file");
    fs::write(&file, "").unwrap();
    run(&["scene", "random", "-o", text(&file)]).ended(5);
}

#[test]
fn grasps_become_sites() {
    let folder = scratch("scene_grasps");
    let words = ["scene", "random", "-n", "3", "--layout", "packed", "--seed", "6", "--quiet"];
    let more = ["--gripper", "panda_hand", "--views", "2", "--formats", "mjcf,usda,glb"];
    run(&[&words[..], &more[..], &["-o", text(&folder)]].concat()).ended(0);
    let read = read_scene(&folder.join("scene.json")).unwrap();
    let sites = &read.extras.sites;
    assert!(sites.iter().filter(|site| site.name.ends_with(" 1")).count() >= 2, "{sites:?}");
    for site in sites {
        let named = |name: &str| site.name.starts_with(&format!("grasp {name} "));
        let body = read.scene.bodies.iter().find(|body| named(&body.name)).unwrap();
        // the tool's origin is between the pads, which hold the body, and comes from above
        let [low, high] = body.bounds();
        let at = site.pose.translation.vector;
        assert!((0..3).all(|k| at[k] > low[k] - 0.02 && at[k] < high[k] + 0.02), "{site:?}");
        assert!((site.pose.rotation * supersurface::Vector::z()).z < 0.1, "{site:?}");
        let id = site.name.replace(' ', "_");
        for file in ["scene.xml", "scene.usda", "scene.glb"] {
            let bytes = fs::read(folder.join(file)).unwrap();
            assert!(String::from_utf8_lossy(&bytes).contains(&format!("\"{id}\"")), "{file} {id}");
        }
    }
    let words = ["scene", "random", "--gripper", "panda_hand", "--views", "0"];
    let told = run(&[&words[..], &["-o", text(&folder)]].concat()).ended(2).stderr;
    assert!(told.contains("--views 1"), "{told}");
}

#[test]
fn a_data_set_that_was_cut_off_is_completed_to_the_same_bytes() {
    let [whole, cut] = ["dataset_whole", "dataset_cut"].map(scratch);
    for folder in [&whole, &cut] {
        let _ = fs::remove_dir_all(folder);
    }
    let make = |folder: &Path, more: &[&str]| {
        let words = ["scene", "dataset", "--scenes", "3", "-n", "2", "--layout", "packed"];
        let how = ["--things", "members", "--seed", "4", "--views", "1", "-o", text(folder)];
        run(&[&words[..], &how[..], more].concat())
    };
    let told = make(&whole, &["--threads", "2"]).ended(0).stdout;
    assert!(told.starts_with("3 scenes made, 0 were there"), "{told}");
    make(&cut, &["--threads", "1"]).ended(0);
    // as if it had been killed: a scene is not whole, another not begun, no list
    fs::rename(cut.join("shard_000/scene_000001"), cut.join("shard_000/.part_000001")).unwrap();
    fs::remove_file(cut.join("shard_000/.part_000001/scene.json")).unwrap();
    fs::remove_dir_all(cut.join("shard_000/scene_000002")).unwrap();
    fs::remove_file(cut.join("manifest.jsonl")).unwrap();
    let told = make(&cut, &["--threads", "8"]).ended(0).stdout;
    assert!(told.starts_with("2 scenes made, 1 were there"), "{told}");
    assert!(files(&whole) == files(&cut));
    let manifest = fs::read_to_string(whole.join("manifest.jsonl")).unwrap();
    assert_eq!(manifest.lines().count(), 3);
    // other arguments do not mix with what is there
    let told = make(&cut, &["--noise", "none"]).ended(2).stderr;
    assert!(told.contains("other arguments"), "{told}");
}

#[test]
fn a_data_set_is_that_of_its_list_whatever_this_is_called() {
    let folder = scratch("dataset_things");
    let _ = fs::remove_dir_all(&folder);
    let list = |name: &str, density: u32| {
        let things = scratch(name);
        let kind = format!(
            "[[kind]]\nname = \"egg\"\ndensity = {density}\nfriction = 0.5\n\
             shape.superellipsoid = {{ semi_axes = [0.03, 0.02, 0.02], exponents = [1, 1] }}\n"
        );
        fs::write(&things, kind).unwrap();
        let words = ["scene", "dataset", "--scenes", "1", "-n", "1", "--views", "0", "-o"];
        run(&[&words[..], &[text(&folder), "--things", text(&things)]].concat())
    };
    list("dataset_eggs.toml", 500).ended(0);
    list("dataset_same.toml", 500).ended(0);
    list("dataset_eggs.toml", 600).ended(2);
}

#[test]
fn what_is_recovered_is_the_same_on_any_number_of_threads() {
    let things = scratch("recover_things.toml");
    let kind = "[[kind]]\nname = \"egg\"\ndensity = 500\nfriction = 0.5\nshape.superellipsoid = { \
                semi_axes = [0.04, 0.03, 0.03], exponents = [0.9, 1] }\n";
    fs::write(&things, kind).unwrap();
    let mut first = None;
    for threads in ["1", "3"] {
        let folder = scratch(&format!("recover_{threads}"));
        let _ = fs::remove_dir_all(&folder);
        let words = ["scene", "recover", "--scenes", "2", "--seed", "7", "--things", text(&things)];
        let more = ["--noise", "none", "--threads", threads, "--json", "-o", text(&folder)];
        let told = run(&[&words[..], &more[..]].concat()).ended(0);
        let report = told.json();
        assert_eq!(report["kinds"][0]["kind"], "egg");
        assert_eq!(report["kinds"][0]["within_2_percent"], 2, "{report}");
        let case = &report["scenes"][1];
        assert!(case["error"].as_f64().is_some_and(|e| e < 0.02) && case["seed"] == 8, "{case}");
        let made = files(&folder);
        let names: Vec<&str> = made.iter().filter_map(|(name, _)| name.to_str()).collect();
        let (truth, result) = ("scene_000008.gt.json", "scene_000008.json");
        assert_eq!(names.len(), 5, "{names:?}");
        assert!(["index.json", truth, result].iter().all(|name| names.contains(name)), "{names:?}");
        let (stdout, files) = first.get_or_insert_with(|| (told.stdout.clone(), made.clone()));
        assert!(*stdout == told.stdout && *files == made);
    }
    let told =
        run(&["scene", "recover", "--scenes", "1", "--seed", "7", "--things", text(&things)]);
    let told = told.ended(0).stdout;
    assert!(told.lines().any(|line| line.starts_with("egg ")), "{told}");
    // nobody can say which of a mug's parts one surface should be
    fs::write(
        &things,
        kind.replace(
            "superellipsoid = { semi_axes = [0.04, 0.03, 0.03], exponents = [0.9, 1]",
            "hammer = { length = 0.2",
        ),
    )
    .unwrap();
    let told =
        run(&["scene", "recover", "--scenes", "1", "--things", text(&things)]).ended(3).stderr;
    assert!(told.contains("several parts"), "{told}");
}
