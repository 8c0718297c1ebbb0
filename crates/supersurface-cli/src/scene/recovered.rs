//! How many things came back as they are: as a table, as JSON, and as files for other scorers.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};
use supersurface::fit::Agreement;
use supersurface::shape::Posed;
use supersurface::surface::Surface;
use supersurface_io::{surface_json, write_text};

use crate::exit::Failure;

/// Overlap from which a surface that is near is the right one.
const OVERLAP: f64 = 0.9;

/// One scene.
pub(super) struct Row {
    pub(super) seed: u64,
    /// What the list of things calls it.
    pub(super) kind: String,
    /// Pixels of the depth image that show it.
    pub(super) points: usize,
    /// The thing in the camera's optical frame.
    pub(super) truth: Posed<Surface>,
    /// What was found and how well it agrees, or why nothing was.
    pub(super) found: Result<(Posed<Surface>, Agreement), String>,
}

impl Row {
    pub(super) fn id(&self) -> String {
        format!("scene_{:06}", self.seed)
    }

    /// The longest extent of the thing along its own axes, in metres.
    fn size(&self) -> f64 {
        2.0 * self.truth.shape().half_extents().into_iter().fold(0.0, f64::max)
    }

    /// Mean distance of the surfaces relative to the thing's size; infinite where nothing was found.
    fn error(&self) -> f64 {
        self.found.as_ref().map_or(f64::INFINITY, |(_, found)| found.distance / self.size())
    }

    fn overlap(&self) -> f64 {
        self.found.as_ref().map_or(0.0, |(_, found)| found.overlap)
    }

    pub(super) fn is_within(&self, share: f64) -> bool {
        self.error() < share
    }

    fn is_strict(&self) -> bool {
        self.is_within(0.02) && self.overlap() >= OVERLAP
    }
}

/// What scenes of one kind come to.
struct Sum {
    scenes: usize,
    found: usize,
    within_2: usize,
    within_5: usize,
    strict: usize,
    /// Median error; infinite where half was not found.
    median: f64,
    overlap: f64,
}

impl Sum {
    fn of(rows: &[&Row]) -> Self {
        let count = |holds: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| holds(row)).count();
        let median = |of: &dyn Fn(&Row) -> f64| {
            let mut all: Vec<f64> = rows.iter().map(|row| of(row)).collect();
            all.sort_by(f64::total_cmp);
            let middle = all.len() / 2;
            let high = all.get(middle).copied().unwrap_or(f64::NAN);
            let low = if all.len().is_multiple_of(2) { middle.saturating_sub(1) } else { middle };
            0.5 * (high + all.get(low).copied().unwrap_or(f64::NAN))
        };
        Self {
            scenes: rows.len(),
            found: count(&|row| row.found.is_ok()),
            within_2: count(&|row| row.is_within(0.02)),
            within_5: count(&|row| row.is_within(0.05)),
            strict: count(&Row::is_strict),
            median: median(&Row::error),
            overlap: median(&Row::overlap),
        }
    }
}

/// A sum for each kind, in the order of their names, and one for all.
fn sums(rows: &[Row]) -> Vec<(&str, Sum)> {
    let mut kinds: Vec<&str> = rows.iter().map(|row| &row.kind[..]).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let of = |kind: &str| rows.iter().filter(|row| row.kind == kind).collect::<Vec<_>>();
    let mut sums: Vec<(&str, Sum)> = kinds.iter().map(|kind| (*kind, Sum::of(&of(kind)))).collect();
    sums.push(("all", Sum::of(&rows.iter().collect::<Vec<_>>())));
    sums
}

/// A row a kind, then the scenes that were missed.
pub(super) fn text(rows: &[Row]) -> String {
    let mut out = format!(
        "{:<18} {:>6} {:>8} {:>7} {:>7} {:>7} {:>8} {:>8}\n",
        "kind", "scenes", "found", "2 %", "5 %", "strict", "error", "overlap"
    );
    // writing to a string does not fail
    for (kind, sum) in sums(rows) {
        let share = |n: usize| format!("{:.1} %", 100.0 * n as f64 / sum.scenes as f64);
        let [found, two, five, strict] =
            [sum.found, sum.within_2, sum.within_5, sum.strict].map(share);
        let (error, overlap) = (100.0 * sum.median, sum.overlap);
        let _ = writeln!(
            out,
            "{kind:<18} {:>6} {found:>8} {two:>7} {five:>7} {strict:>7} {error:>6.2} % {overlap:>8.3}",
            sum.scenes
        );
    }
    let missed: Vec<&Row> = rows.iter().filter(|row| !row.is_within(0.05)).collect();
    if !missed.is_empty() {
        out.push_str("\nmissed by 5 %\n");
    }
    for row in missed {
        let why = match &row.found {
            Ok(_) => format!("{:.1} % off, overlap {:.3}", 100.0 * row.error(), row.overlap()),
            Err(why) => why.clone(),
        };
        let _ = writeln!(out, "seed {:<8} {:<18} {why}", row.seed, row.kind);
    }
    out
}

/// The report for programs.
pub(super) fn json(seed: u64, rows: &[Row]) -> String {
    let finite = |v: f64| if v.is_finite() { json!(v) } else { Value::Null };
    let kinds: Vec<Value> = sums(rows)
        .into_iter()
        .map(|(kind, sum)| {
            json!({
                "kind": kind, "scenes": sum.scenes, "found": sum.found, "within_2_percent": sum.within_2,
                "within_5_percent": sum.within_5, "strict": sum.strict, "median_error": finite(sum.median),
                "median_overlap": sum.overlap,
            })
        })
        .collect();
    let scenes: Vec<Value> = rows
        .iter()
        .map(|row| {
            let found = row.found.as_ref();
            json!({
                "seed": row.seed, "kind": row.kind, "points": row.points, "size": row.size(),
                "truth": surface_json(&row.truth), "found": found.ok().map(|f| surface_json(&f.0)),
                "error": finite(row.error()), "overlap": row.overlap(), "problem": found.err(),
            })
        })
        .collect();
    let report = json!({
        "format": "supersurface-recovery", "version": 1, "seed": seed, "kinds": kinds, "scenes": scenes,
    });
    format!("{report:#}\n")
}

/// The truth and the result of each scene as the scorer of fits reads them.
pub(super) fn files(folder: &Path, rows: &[Row]) -> Result<(), Failure> {
    let write = |name: &str, value: &Value| {
        write_text(&folder.join(name), &format!("{value:#}\n")).map_err(Failure::output)
    };
    let mut cases = Vec::new();
    for row in rows {
        let (id, class) = (row.id(), class(row.truth.shape()));
        let (truth, result) = (format!("{id}.gt.json"), format!("{id}.json"));
        let primitive = surface_json(&row.truth);
        write(
            &truth,
            &json!({
                "id": id, "cls": class, "n": row.points, "size": row.size(), "primitive": primitive,
            }),
        )?;
        let result_of = match &row.found {
            Ok((surface, _)) => json!({ "status": "ok", "surface": surface_json(surface) }),
            Err(why) => json!({ "status": "failed", "error": why }),
        };
        write(&result, &result_of)?;
        cases.push(json!({ "id": id, "cls": class, "gt": truth, "n": row.points }));
    }
    write("index.json", &json!({ "cases": cases }))
}

/// What the benchmark of fits calls views of such a shape.
const fn class(shape: &Surface) -> &'static str {
    match shape {
        Surface::Superellipsoid(_) => "d_view_depth",
        Surface::Supertoroid(_) => "e_tor_view_depth",
        Surface::Tapered(_) => "f_taper_view",
        _ => "f_view",
    }
}
