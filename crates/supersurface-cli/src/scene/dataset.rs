//! `supersurface scene dataset`: many scenes, which a run that was cut off does not lose.
//!
//! A scene is made beside its place and moved there once it is whole, so that what has its name is complete. The next run
//! makes what is missing; as a scene depends on its seed alone, the bytes are those of one run.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};
use supersurface_io::write_text;

use super::args::{DatasetArgs, formats};
use super::make::{Given, Made, folder, given, make};
use crate::exit::{Failure, print};
use crate::progress::Progress;
use crate::threads;

/// Scenes in a folder of them.
const SHARD: u32 = 1000;
/// What a scene that is not whole is called before its number.
const PART: &str = ".part_";

pub(super) fn run(args: &DatasetArgs) -> Result<(), Failure> {
    let mut progress = Progress::new(args.quiet);
    let (pool, fewer) = threads::pool(args.threads)?;
    if let Some(warning) = fewer {
        progress.warn(&warning);
    }
    let given = given(&args.make)?;
    folder(&args.output)?;
    same_data_set(args, &given)?;
    let missing: Vec<u32> = (0..args.scenes).filter(|k| !place(args, *k).exists()).collect();
    let count = missing.len();
    progress.begin("make", format!("making {count} scenes"));
    let done = AtomicUsize::new(0);
    let failed: Vec<Failure> = pool.install(|| {
        let made = missing.par_iter().map(|k| {
            let result = one(args, &given, *k);
            let before = done.fetch_add(1, Ordering::Relaxed);
            progress.say(format!("made {} of {count} scenes", before + 1));
            result
        });
        made.filter_map(Result::err).collect()
    });
    let mut failed = failed.into_iter();
    if let Some(first) = failed.next() {
        return Err(first.and(failed));
    }
    progress.begin("list", "writing manifest.jsonl".to_owned());
    let rows: Result<String, Failure> = (0..args.scenes)
        .map(|k| {
            let file = place(args, k).join(ROW);
            fs::read_to_string(&file)
                .map_err(|e| Failure::output(format!("{}: {e}", file.display())))
        })
        .collect();
    let manifest = args.output.join("manifest.jsonl");
    write_text(&manifest, &rows?).map_err(Failure::output)?;
    progress.finish();
    let kept = args.scenes as usize - count;
    print(&format!("{count} scenes made, {kept} were there\n{}\n", manifest.display()))
}

/// The file of a scene's row of the manifest.
const ROW: &str = "row.json";

fn shard(k: u32) -> String {
    format!("shard_{:03}", k / SHARD)
}

fn place(args: &DatasetArgs, k: u32) -> PathBuf {
    args.output.join(shard(k)).join(format!("scene_{k:06}"))
}

/// Fails where the folder holds scenes that were made otherwise: what decides is the content of files, not their names.
fn same_data_set(args: &DatasetArgs, given: &Given) -> Result<(), Failure> {
    let file = args.output.join("dataset.json");
    let make = &args.make;
    let things: Vec<String> = given.things.iter().map(|kind| format!("{kind:?}")).collect();
    let told = format!(
        "{:#}\n",
        json!({
            "format": "supersurface-dataset", "version": 1, "seed": args.seed, "count": make.count,
            "layout": format!("{:?}", make.layout.layout()), "formats": format!("{:?}", formats(&make.formats)),
            "views": make.views, "noise": format!("{:?}", make.noise.model()), "things": things,
            "gripper": given.gripper.as_ref().map(|gripper| format!("{gripper:?}")),
        })
    );
    match fs::read_to_string(&file) {
        Ok(before) if before == told => Ok(()),
        Ok(_) => Err(Failure::usage(format!(
            "{}: the folder holds a data set of other arguments or lists; take another folder",
            args.output.display()
        ))),
        Err(_) => write_text(&file, &told).map_err(Failure::output),
    }
}

/// Makes a scene beside its place, then moves it there.
fn one(args: &DatasetArgs, given: &Given, k: u32) -> Result<(), Failure> {
    let whole = place(args, k);
    let part = args.output.join(shard(k)).join(format!("{PART}{k:06}"));
    let wrong = |path: &Path, e| Failure::output(format!("{}: {e}", path.display()));
    if part.exists() {
        fs::remove_dir_all(&part).map_err(|e| wrong(&part, e))?;
    }
    folder(&part)?;
    let seed = args.seed.wrapping_add(k.into());
    let made = make(&args.make, given, seed, &part, |_, _| ())?;
    let name = format!("{}/scene_{k:06}", shard(k));
    write_text(&part.join(ROW), &format!("{}\n", row(&name, seed, &made)))
        .map_err(Failure::output)?;
    fs::rename(&part, &whole).map_err(|e| wrong(&whole, e))
}

fn row(name: &str, seed: u64, made: &Made) -> Value {
    let bodies: Vec<&str> = made.scene.bodies.iter().map(|b| b.name.as_str()).collect();
    json!({
        "scene": name, "seed": seed, "bodies": bodies, "seen": made.shares, "overlap": made.settled.overlap,
        "at_rest": made.settled.all_at_rest(), "warnings": made.warnings,
    })
}
