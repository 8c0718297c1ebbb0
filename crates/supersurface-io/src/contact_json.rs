//! Contact queries as JSON: many pairs of bodies in, one line a pair out; and one contact for programs
//! (`docs/contact.md`).
//!
//! A list of pairs is read so that what is wrong with one of them is told of that one, and the others are not lost:
//! a number that is too large, and the NaN and Infinity that Python writes and JSON does not have, are such faults.

use std::borrow::Cow;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use supersurface::contact::{Contact, Convex};
use supersurface::shape::{Posed, Superellipsoid};
use supersurface::{Point, Pose, Vector};

use crate::error::{Fault, ReadError, printable};
use crate::read::{BOM, load, shown_name};
use crate::shape_json::quaternion;

/// One pair of a list, or what is wrong with it.
#[derive(Debug)]
pub struct ContactCase {
    /// As the file has it, for the line of the answer.
    id: Option<Box<RawValue>>,
    /// A and B, or why they cannot be queried.
    pub bodies: Result<[Posed<Convex>; 2], String>,
}

/// Reads a list of pairs; `-` is standard input.
pub fn read_contact_cases(file: &Path) -> Result<Vec<ContactCase>, ReadError> {
    parse_contact_cases(&shown_name(file), &load(file)?)
}

/// The same from the bytes of a file; the name is for errors.
///
/// ```
/// let text = br#"[{"id": "two balls", "A": {"a": [1, 1, 1], "e": [1, 1], "q": [1, 0, 0, 0], "t": [0, 0, 0]},
///     "B": {"a": [1, 1, -1], "e": [1, 1], "q": [1, 0, 0, 0], "t": [3, 0, 0]}}]"#;
/// let cases = supersurface_io::parse_contact_cases("pairs", text)?;
/// assert_eq!(cases[0].bodies, Err("B: semi-axis a3 is -1: it must be positive and finite".into()));
/// # Ok::<(), supersurface_io::ReadError>(())
/// ```
pub fn parse_contact_cases(name: &str, bytes: &[u8]) -> Result<Vec<ContactCase>, ReadError> {
    let fault = |f| ReadError::malformed(name, "contact cases", f);
    let bytes = bytes.strip_prefix(BOM).unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let place = format!("byte {}", e.valid_up_to());
        fault(Fault::new(place, "is no UTF-8: save the file as UTF-8"))
    })?;
    let text = quoted(text);
    if !text.trim_start().starts_with('[') {
        let needed = r#"a list of pairs is needed: [{"id": ..., "A": ..., "B": ...}, ...]"#;
        return Err(fault(Fault::new("start", needed)));
    }
    let cases: Vec<&RawValue> = serde_json::from_str(&text).map_err(|e| {
        fault(Fault::new(format!("line {}, column {}", e.line(), e.column()), words(&e)))
    })?;
    Ok(cases.into_iter().map(ContactCase::new).collect())
}

/// JSON with NaN and Infinity as texts, which no number is.
fn quoted(text: &str) -> Cow<'_, str> {
    const WORDS: [&str; 3] = ["NaN", "Infinity", "-Infinity"];
    if !WORDS.iter().any(|w| text.contains(w)) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + text.len() / 16);
    let (mut rest, mut in_text, mut escaped) = (text, false, false);
    while let Some(c) = rest.chars().next() {
        if let Some(word) = WORDS.iter().find(|w| !in_text && rest.starts_with(**w)) {
            out.extend(["\"", word, "\""]);
            rest = &rest[word.len()..];
            continue;
        }
        in_text ^= c == '"' && !escaped;
        escaped = in_text && c == '\\' && !escaped;
        out.push(c);
        rest = &rest[c.len_utf8()..];
    }
    Cow::Owned(out)
}

/// What a parser says, without its place.
fn words(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    text.strip_suffix(&place).unwrap_or(&text).to_owned()
}

#[derive(Deserialize)]
struct CaseRow<'a> {
    #[serde(borrow)]
    id: Option<&'a RawValue>,
    #[serde(borrow, rename = "A")]
    a: Option<&'a RawValue>,
    #[serde(borrow, rename = "B")]
    b: Option<&'a RawValue>,
}

/// The `id` of a case in which something else is wrong.
#[derive(Deserialize)]
struct IdRow<'a> {
    #[serde(borrow)]
    id: Option<&'a RawValue>,
}

#[derive(Deserialize)]
struct BodyRow<'a> {
    #[serde(borrow)]
    a: Option<&'a RawValue>,
    #[serde(borrow)]
    e: Option<&'a RawValue>,
    #[serde(borrow)]
    q: Option<&'a RawValue>,
    #[serde(borrow)]
    t: Option<&'a RawValue>,
}

impl ContactCase {
    fn new(value: &RawValue) -> Self {
        let row = match value.get().starts_with('{') {
            true => serde_json::from_str::<CaseRow<'_>>(value.get()).map_err(|e| words(&e)),
            false => Err("is no object with id, A and B".to_owned()),
        };
        let id = match &row {
            Ok(row) => row.id,
            Err(_) => serde_json::from_str::<IdRow<'_>>(value.get()).ok().and_then(|row| row.id),
        };
        // what a line can hold: a list or an object may go over several
        let id = id.filter(|id| !id.get().starts_with(['[', '{']));
        let bodies = row.and_then(|row| {
            id.ok_or("id: is missing, or neither text nor a number")?;
            Ok([body(row.a, "A")?, body(row.b, "B")?])
        });
        Self { id: id.map(ToOwned::to_owned), bodies: bodies.map_err(|e| printable(&e)) }
    }
}

/// A body with its pose; `at` says which.
fn body(value: Option<&RawValue>, at: &str) -> Result<Posed<Convex>, String> {
    let row: BodyRow<'_> = field(value, at)?;
    let place = |name: &str| format!("{at}.{name}");
    let shape = Superellipsoid::new(numbers(row.a, &place("a"))?, numbers(row.e, &place("e"))?);
    let convex = shape.and_then(Convex::new).map_err(|e| format!("{at}: {e}"))?;
    let rotation = quaternion(numbers(row.q, &place("q"))?).map_err(|e| format!("{at}.q: {e}"))?;
    let position = Vector::from(numbers::<3>(row.t, &place("t"))?);
    let pose = Pose::from_parts(position.into(), rotation);
    Posed::new(convex, pose).map_err(|e| format!("{at}: {e}"))
}

/// So many numbers, no more and no fewer.
fn numbers<const N: usize>(value: Option<&RawValue>, at: &str) -> Result<[f64; N], String> {
    let list: Vec<f64> = field(value, at)?;
    let count = list.len();
    list.try_into().map_err(|_| format!("{at}: {count} numbers, {N} needed"))
}

fn field<'a, T: Deserialize<'a>>(value: Option<&'a RawValue>, at: &str) -> Result<T, String> {
    let value = value.ok_or_else(|| format!("{at}: is missing"))?;
    serde_json::from_str(value.get()).map_err(|e| format!("{at}: {}", words(&e)))
}

#[derive(Serialize)]
struct Line<'a> {
    id: Option<&'a RawValue>,
    signed_distance: Option<f64>,
    #[serde(flatten)]
    answer: Option<LineAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ns: Option<f64>,
    status: &'a str,
}

#[derive(Serialize)]
struct LineAnswer {
    normal: [f64; 3],
    p_a: [f64; 3],
    p_b: [f64; 3],
    lo: f64,
    hi: f64,
}

/// The line of a pair: its contact, or why there is none, and the nanoseconds of a query where they were measured.
pub fn contact_line(case: &ContactCase, result: Result<&Contact, &str>, ns: Option<f64>) -> String {
    let contact = result.ok();
    let answer = |c: &Contact| {
        let ([p_a, p_b], [lo, hi]) = (c.witnesses.map(Into::into), c.bounds);
        LineAnswer { normal: c.normal.into_inner().into(), p_a, p_b, lo, hi }
    };
    let line = Line {
        id: case.id.as_deref(),
        signed_distance: contact.map(|c| c.distance),
        answer: contact.map(answer),
        ns,
        status: result.err().unwrap_or("ok"),
    };
    // plain structs of numbers and strings: serialisation has nothing to fail on
    serde_json::to_string(&line).unwrap_or_default()
}

#[derive(Serialize)]
struct File<'a> {
    format: &'static str,
    version: u32,
    sources: [&'a str; 2],
    distance: f64,
    bounds: [f64; 2],
    normal: [f64; 3],
    witnesses: [[f64; 3]; 2],
    common_point: Option<[f64; 3]>,
}

/// The JSON text of one contact, over many lines: format `supersurface-contact`, version 1. The sources are the names of
/// A and B; the common point is in both, where there is one.
pub fn contact_json(contact: &Contact, common: Option<Point>, sources: [&str; 2]) -> String {
    let file = File {
        format: "supersurface-contact",
        version: 1,
        sources,
        distance: contact.distance,
        bounds: contact.bounds,
        normal: contact.normal.into_inner().into(),
        witnesses: contact.witnesses.map(Into::into),
        common_point: common.map(Into::into),
    };
    serde_json::to_string_pretty(&file).unwrap_or_default()
}
