//! Kinds of things: the built-in lists make bodies, and wrong files are told what is wrong.

use std::fs;

use supersurface::scene::{Layout, arrange, draw};
use supersurface_io::{BUILT_IN_THINGS, read_things};

#[test]
fn every_built_in_kind_makes_bodies() {
    for (name, _) in BUILT_IN_THINGS {
        let kinds = read_things(name).unwrap();
        for kind in &kinds {
            let bodies = draw(std::slice::from_ref(kind), 20, 5).unwrap();
            for body in &bodies {
                let mass = body.mass().mass;
                assert!((0.005..10.0).contains(&mass), "{name}: {} of {mass} kg", body.name);
            }
        }
        let scene = arrange(draw(&kinds, 10, 1).unwrap(), Layout::Pile, 1).unwrap();
        assert_eq!(scene.bodies.len(), 10);
    }
}

#[test]
fn what_is_wrong_with_a_list_is_said() {
    let file = std::env::temp_dir().join(format!("things_{}.toml", std::process::id()));
    let kind = |shape: &str| {
        format!("[[kind]]\nname = \"x\"\ndensity = 500\nfriction = [0.3, 0.5]\n{shape}\n")
    };
    for (text, said) in [
        ("", "has no [[kind]]"),
        ("[[kind]]\nname = 3\n", "line 2"),
        (&kind("shape.teapot = {}"), "unknown variant `teapot`"),
        (&kind("shape.bowl = { radius = [2, 1], depth = 0.5 }"), "the smaller number comes first"),
        (&kind("shape.bowl = { radius = nan, depth = 0.5 }"), "radius is [NaN, NaN]"),
        (&kind("colour = 3"), "unknown field `colour`"),
    ] {
        fs::write(&file, text).unwrap();
        let told = read_things(file.to_str().unwrap()).unwrap_err().to_string();
        assert!(told.contains(said), "{text}: {told}");
    }
    fs::remove_file(&file).unwrap();
    assert!(read_things("nothing").unwrap_err().to_string().contains("household"));
    // out of range only when it is drawn
    fs::write(&file, kind("shape.bowl = { radius = -1, depth = 0.5 }")).unwrap();
    let kinds = read_things(file.to_str().unwrap()).unwrap();
    assert!(draw(&kinds, 1, 1).is_err());
    fs::remove_file(&file).unwrap();
}
