//! Rows of numbers as text.

use super::header::{Field, Header};
use super::{Rows, Wanted};
use crate::bytes::Scalar;
use crate::error::Fault;
use crate::text::number;

pub(super) fn read(
    header: &Header,
    body: &[u8],
    wanted: &Wanted,
    rows: &mut Rows,
    warnings: &mut Vec<String>,
) -> Result<(), Fault> {
    let mut extra = 0usize;
    let mut values: Vec<&str> = Vec::with_capacity(header.columns.min(1 << 12));
    for (i, line) in body.split(|b| *b == b'\n').enumerate() {
        let place = header.lines + i + 1;
        let Ok(line) = std::str::from_utf8(line) else {
            return Err(Fault::line(place, "is no text: is the file binary?"));
        };
        let line = line.trim_matches(|c: char| c.is_whitespace() || c == '\0');
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if rows.points.len() == header.points {
            extra += 1;
            continue;
        }
        values.clear();
        values.extend(line.split_whitespace());
        if values.len() < header.columns {
            let problem = format!(
                "{} values in a row, {} expected from FIELDS and COUNT",
                values.len(),
                header.columns
            );
            return Err(Fault::line(place, problem));
        }
        let at = |i: usize| -> Result<f64, Fault> {
            let word =
                header.fields.get(i).and_then(|f| values.get(f.column)).copied().unwrap_or("");
            number(word).ok_or_else(|| {
                let word: String = word.chars().take(40).collect();
                Fault::line(place, format!("cannot parse {word:?} as a number"))
            })
        };
        let [x, y, z] = wanted.position;
        let colour = wanted
            .colour
            .map(|c| header.fields.get(c).map_or(0, |f| bits(f, at(c).unwrap_or(0.0))));
        let instance = wanted.label.map(at).transpose()?;
        rows.push([at(x)?, at(y)?, at(z)?], colour, instance);
    }
    if rows.points.len() < header.points {
        let problem = format!(
            "{} points expected, {} rows found: truncated?",
            header.points,
            rows.points.len()
        );
        return Err(Fault::new("data", problem));
    }
    if extra > 0 {
        warnings.push(format!(
            "{extra} rows after the {} promised points were left out",
            header.points
        ));
    }
    Ok(())
}

/// Colour bits: of a float they are its own bits, of an integer its value.
fn bits(field: &Field, value: f64) -> u32 {
    match field.scalar {
        Scalar::F32 | Scalar::F64 => (value as f32).to_bits(),
        _ => value as i64 as u32,
    }
}
