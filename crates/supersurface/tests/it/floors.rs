//! Imports point down the floors of the house: reads each module's `use crate::` lines.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules of the library with their floors; modules of one floor do not know each other.
const FLOORS: &[(&str, u32)] = &[
    ("numeric", 1),
    ("shape", 2),
    ("measure", 3),
    ("camera", 3),
    ("deform", 4),
    ("surface", 5),
    ("combine", 6),
    ("mesh", 6),
    ("cloud", 6),
    ("segment", 7),
    ("fit", 7),
    ("contact", 7),
    ("grasp", 8),
    ("scene", 8),
    ("separate", 8),
    ("pipeline", 9),
    ("picture", 9),
];

fn floor(module: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            into.push(path);
        }
    }
}

/// The module names after each `crate::`, also inside one level of braces.
fn imported(text: &str) -> Vec<String> {
    let code: String =
        text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut found = Vec::new();
    for tail in code.split("crate::").skip(1) {
        let word = |s: &str| s.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        if let Some(group) = tail.strip_prefix('{') {
            let mut depth = 0;
            let mut item = String::new();
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => found.push(word(std::mem::take(&mut item).trim())),
                    _ if depth == 0 => item.push(c),
                    _ => {}
                }
            }
            found.push(word(item.trim()));
        } else {
            found.push(word(tail));
        }
    }
    found
}

#[test]
fn imports_point_down_the_floors() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let mut checked = 0;
    for file in files {
        let inside = file.strip_prefix(&root).unwrap();
        let module = inside.components().next().unwrap().as_os_str().to_string_lossy();
        let module = module.trim_end_matches(".rs").to_owned();
        if module == "lib" {
            continue;
        }
        let own = floor(&module).unwrap_or_else(|| panic!("{module} stands on no floor"));
        for other in imported(&fs::read_to_string(&file).unwrap()) {
            let Some(below) = floor(&other).filter(|_| other != module) else { continue };
            checked += 1;
            assert!(
                below < own,
                "{} (floor {own}) imports {other} (floor {below})",
                inside.display()
            );
        }
    }
    assert!(checked > 20, "only {checked} imports were seen");
}
