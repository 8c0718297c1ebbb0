//! The figures as a table and as JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::measure::{Figures, RegimeResult};
use crate::options::Options;

/// The table, with what it needs to be understood.
pub fn table(options: &Options, results: &[RegimeResult]) -> String {
    let mut text = format!(
        "{} pairs a regime, shapes {}, seed {}. Microseconds: medians of cold and warm queries of one pair again and\n\
         again, mean of one pass over all pairs. Errors relative to size.\n\n\
         {:9}  {:12} {:>7} {:>7} {:>9}  {:>10} {:>7}  {:>8} {:>8} {:>8}  {:>7} {:>7}  {:>6} {:>6} {:>6}\n",
        options.pairs,
        options.shapes.name(),
        options.seed,
        "regime",
        "",
        "cold us",
        "/ ours",
        "warm/cold",
        "stream us",
        "/ ours",
        "err50",
        "err99",
        "largest",
        "1e-9 %",
        "warm %",
        "sign %",
        "none %",
        "bnds %",
    );
    for result in results {
        let ours = &result.figures[0];
        for (k, figures) in result.figures.iter().enumerate() {
            let regime = if k == 0 { result.regime.name() } else { "" };
            writeln!(text, "{regime:9}  {}", row(figures, ours)).expect("strings take all");
        }
    }
    text += &notes(options, results);
    text
}

fn row(figures: &Figures, ours: &Figures) -> String {
    let [median, high, largest] = figures.errors.map(error);
    format!(
        "{:12} {:7.2} {:7.1} {:9.2}  {:10.2} {:7.1}  {median:>8} {high:>8} {largest:>8}  {:>7} {:>7}  {:>6} {:>6} {:>6}",
        figures.name,
        figures.cold,
        figures.cold / ours.cold,
        figures.warm / figures.cold,
        figures.streaming,
        figures.streaming / ours.streaming,
        percent(Some(figures.right)),
        percent(Some(figures.right_warm)),
        percent(Some(figures.wrong_sign)),
        percent(Some(figures.unanswered)),
        percent(figures.bounds_wrong),
    )
}

/// What the columns mean, and what to be wary of in this run.
fn notes(options: &Options, results: &[RegimeResult]) -> String {
    let mut text = String::from(
        "\n1e-9, warm: cold and warm answers within 1e-9 of size. sign: wrong sign. none: no answer. bnds: bounds \
         that leave\nout the trusted value. A dash: not known.\n",
    );
    let sum = |count: fn(&RegimeResult) -> usize| results.iter().map(count).sum::<usize>();
    let (known, wide, disputed) = (sum(|r| r.known), sum(|r| r.wide), sum(|r| r.disputed));
    let all = results.len() * options.pairs;
    if known < all {
        text += &format!("{} of {all} pairs have no trusted value.\n", all - known);
    } else if wide > 0 {
        text += &format!("{wide} of {all} trusted values have bounds wider than asked for.\n");
    }
    if disputed > 0 {
        text += &format!("FAULT: {disputed} certified bounds contradict the construction.\n");
    }
    if options.pairs < 1000 {
        text += "Streaming needs 1000 pairs or more to mean anything.\n";
    }
    text
}

fn error(value: f64) -> String {
    if value.is_nan() { "-".into() } else { format!("{value:.0e}") }
}

fn percent(value: Option<f64>) -> String {
    value.filter(|v| !v.is_nan()).map_or("-".into(), |v| format!("{v:.2}"))
}

/// The same figures for programs. What is not known is null.
pub fn json(options: &Options, results: &[RegimeResult]) -> Value {
    let rows: Vec<_> = results.iter().flat_map(|r| r.figures.iter().map(move |f| (r, f))).collect();
    json!({
        "seed": options.seed,
        "pairs_per_regime": options.pairs,
        "shapes": options.shapes.name(),
        "trusted": results.iter().map(|r| json!({
            "regime": r.regime.name(),
            "known": r.known,
            "bounds_wider_than_asked": r.wide,
            "bounds_against_construction": r.disputed,
        })).collect::<Vec<_>>(),
        "rows": rows.iter().map(|(r, f)| json!({
            "regime": r.regime.name(),
            "library": f.name,
            "cold_us": f.cold,
            "warm_us": f.warm,
            "streaming_us": f.streaming,
            "error_median": f.errors[0],
            "error_99": f.errors[1],
            "error_largest": f.errors[2],
            "within_1e-9_percent": f.right,
            "warm_within_1e-9_percent": f.right_warm,
            "wrong_sign_percent": f.wrong_sign,
            "unanswered_percent": f.unanswered,
            "bounds_wrong_percent": f.bounds_wrong,
        })).collect::<Vec<_>>(),
    })
}
