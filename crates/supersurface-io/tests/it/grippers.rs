//! Grippers from files: the built-in ones, and what is said about broken ones.

use supersurface::grasp::Kind;
use supersurface_io::{BUILT_IN_GRIPPERS, read_gripper};

#[test]
fn built_in_grippers_are_valid() {
    for (name, _) in BUILT_IN_GRIPPERS {
        let gripper = read_gripper(name).unwrap();
        assert_eq!(gripper.name, name);
        match &gripper.kind {
            Kind::Jaw(jaw) => assert!(jaw.max_opening > 0.07 && jaw.finger.iter().any(|f| f.pad)),
            Kind::Suction(cup) => assert!((cup.max_tilt - 12f64.to_radians()).abs() < 1e-12),
        }
    }
}

#[test]
fn an_unknown_name_lists_the_known() {
    let error = read_gripper("gripper9000").unwrap_err().to_string();
    assert!(error.contains("gripper9000") && error.contains("robotiq_2f85"), "{error}");
}

#[test]
fn a_broken_file_names_file_and_field() {
    let text = BUILT_IN_GRIPPERS[0].1;
    let folder = std::env::temp_dir().join(format!("supersurface-gripper-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (cup, jaw) = (BUILT_IN_GRIPPERS[2].1, text);
    for (text, from, to, field) in [
        (jaw, "max_opening = 0.080", "max_opening = -1.0", "max_opening"),
        (jaw, "mu = 0.5\n", "mu = nan\n", "mu"),
        (cup, "[[1.0, 0.0, 0.0", "[[2.0, 0.0, 0.0", "T_tcp_mount"),
        (jaw, "[-1.0, 0.0, 0.0, 0.0]", "[-2.0, 0.0, 0.0, 0.0]", "T_tcp_mount"),
        (jaw, "clearance = 0.005", "", "clearance"),
        (jaw, "clearance = 0.005", "clearance = 5.0", "clearance"),
        (jaw, "kind = \"parallel\"", "kind = \"magnet\"", "kind"),
        (jaw, "approach_axis = \"+z\"", "approach_axis = \"-z\"", "approach_axis"),
        (jaw, "closing_axis = \"+x\"", "closing_axis = \"+y\"", "closing_axis"),
        (jaw, "name = \"panda_hand\"", "name = \"\\u001b[31m\"", "name"),
        (jaw, "name = \"panda_hand\"", "name = \"\"", "name"),
        (jaw, "outside_mu", "outside_nu", "outside_nu"),
        (jaw, "mount_frame", "mount_farme", "mount_farme"),
        (jaw, "[motion]", "[motion]\nway = 1", "way"),
        (jaw, "pad = true", "pads = true", "pads"),
        (jaw, "[motion]", "[colour]\nred = 1\n[motion]", "colour"),
        (jaw, "kind = \"parallel\"", "kind = \"suction\"", "kind"),
        (
            cup,
            "[[body]]",
            "[[finger]]\ncenter = [0.0, 0.0, 0.0]\nsize = [0.1, 0.1, 0.1]\n[[body]]",
            "kind",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        let file = folder.join("hand.toml");
        std::fs::write(&file, text.replacen(from, to, 1)).unwrap();
        let error = read_gripper(&file.display().to_string()).unwrap_err().to_string();
        assert!(error.contains(field) && error.contains("hand.toml"), "{error}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
