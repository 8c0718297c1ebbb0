//! Points as text: x y z a line, separated by spaces, tabs, commas or semicolons; CSV with or without a line of
//! names; comments with # or //.

use supersurface::Point;
use supersurface::cloud::PointCloud;

use crate::error::Fault;
use crate::read::{BOM, Read, ReadOptions, label, no_field};

/// A number as programs write it, with the many spellings of what is none.
pub(crate) fn number(word: &str) -> Option<f64> {
    if let Ok(value) = word.parse::<f64>() {
        return Some(value);
    }
    let word = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
    let missing = word.starts_with("nan") || word.starts_with("1.#");
    missing.then_some(f64::NAN)
}

/// Columns by what they hold.
struct Columns {
    position: [usize; 3],
    colour: Option<[usize; 3]>,
    label: Option<usize>,
    least: usize,
}

pub(crate) fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Read, Fault> {
    let bytes = bytes.strip_prefix(BOM).unwrap_or(bytes);
    let mut cloud = PointCloud::default();
    let mut columns: Option<Columns> = None;
    let mut warnings = Vec::new();
    let mut values: Vec<&str> = Vec::new();
    let mut true_colours = true;
    for (i, line) in bytes.split(|b| *b == b'\n').enumerate() {
        let place = i + 1;
        let Ok(line) = std::str::from_utf8(line) else {
            return Err(Fault::line(
                place,
                "is no text (not UTF-8): is the file binary, or of a format whose extension is missing?",
            ));
        };
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') || line.starts_with("//") {
            continue;
        }
        values.clear();
        split(line, &mut values);
        if columns.is_none() {
            let first = values.first().copied().unwrap_or("");
            if number(first).is_none() && values.iter().all(|w| number(w).is_none()) {
                columns = Some(named(place, &values, options)?);
                continue;
            }
            if let (1, Ok(count)) = (values.len(), first.parse::<u64>())
                && cloud.points.is_empty()
                && place == 1
            {
                warnings.push(format!("line 1 was taken as a number of points: {count}"));
                continue;
            }
            columns = Some(unnamed(values.len(), options)?);
        }
        let Some(c) = &columns else { continue };
        if values.len() < c.least {
            let problem =
                format!("{} values, at least {} columns (x y z) expected", values.len(), c.least);
            return Err(Fault::line(place, problem));
        }
        let at = |k: usize| -> Result<f64, Fault> {
            let word = values.get(k).copied().unwrap_or("");
            number(word).ok_or_else(|| {
                let word: String = word.chars().take(40).collect();
                let problem =
                    format!("cannot parse {word:?} as a number; decimal commas are not read");
                Fault::line(place, problem)
            })
        };
        let [x, y, z] = c.position;
        cloud.points.push(Point::new(at(x)?, at(y)?, at(z)?));
        if let Some(colour) = c.colour {
            let channel =
                |k: usize| at(k).ok().filter(|v| (0.0..=255.0).contains(v) && v.fract() == 0.0);
            let found = colour.map(|k| channel(k).map(|v| v as u8));
            true_colours &= found.iter().all(Option::is_some);
            cloud.colours.push(found.map(Option::unwrap_or_default));
        }
        if let Some(k) = c.label {
            cloud.labels.push(label(at(k)?));
        }
    }
    if cloud.points.is_empty() {
        return Err(Fault::new("content", "the file is empty: there are no points in it"));
    }
    // the fourth to sixth number of a line may also be a normal
    if !true_colours || cloud.colours.iter().all(|c| c.iter().all(|v| *v <= 1)) {
        cloud.colours.clear();
    }
    Ok(Read { cloud, warnings })
}

/// Words of a line; a comma or semicolon anywhere makes it the separator.
fn split<'a>(line: &'a str, into: &mut Vec<&'a str>) {
    if let Some(separator) = [';', ','].into_iter().find(|s| line.contains(*s)) {
        into.extend(line.split(separator).map(str::trim));
        while into.last().is_some_and(|w| w.is_empty()) {
            into.pop();
        }
    } else {
        into.extend(line.split_whitespace());
    }
}

fn named(place: usize, names: &[&str], options: &ReadOptions) -> Result<Columns, Fault> {
    let clean: Vec<String> =
        names.iter().map(|n| n.trim_matches(['"', '\'', ' ']).to_ascii_lowercase()).collect();
    let find = |wanted: &[&str]| clean.iter().position(|n| wanted.contains(&n.as_str()));
    let need = |wanted: &str| {
        find(&[wanted]).ok_or_else(|| {
            Fault::line(place, format!("no column {wanted} among the names {}", names.join(" ")))
        })
    };
    let position = [need("x")?, need("y")?, need("z")?];
    let colour = match (find(&["r", "red"]), find(&["g", "green"]), find(&["b", "blue"])) {
        (Some(r), Some(g), Some(b)) => Some([r, g, b]),
        _ => None,
    };
    let label = match &options.instances {
        Some(wanted) => Some(
            find(&[wanted.to_ascii_lowercase().as_str()])
                .ok_or_else(|| no_field(wanted, names.iter().copied()))?,
        ),
        None => None,
    };
    let most = position.iter().chain(label.iter()).copied().max().unwrap_or(2);
    Ok(Columns { position, colour, label, least: most + 1 })
}

fn unnamed(count: usize, options: &ReadOptions) -> Result<Columns, Fault> {
    if let Some(wanted) = &options.instances {
        return Err(no_field(wanted, ["columns without names"].into_iter()));
    }
    Ok(Columns {
        position: [0, 1, 2],
        colour: (count >= 6).then_some([3, 4, 5]),
        label: None,
        least: 3,
    })
}
