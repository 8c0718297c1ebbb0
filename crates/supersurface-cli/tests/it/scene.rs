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
        assert!((3..=4).contains(&objects), "{found}");
        let (depth, camera) =
            (folder.join("view_000/depth.png"), folder.join("view_000/camera.json"));
        let words = ["segment", text(&depth), "--camera", text(&camera), "--json"];
        let found = run(&words).ended(0).json();
        let objects = found["objects"].as_array().map_or(0, Vec::len);
        assert!((3..=4).contains(&objects), "{found}");
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
