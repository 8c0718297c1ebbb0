//! The header of a PCD file.

use crate::bytes::Scalar;
use crate::error::Fault;
use crate::read::BOM;

/// A column of the file.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    pub(super) count: usize,
    /// Bytes before it in a row; values before it in a line.
    pub(super) offset: usize,
    pub(super) column: usize,
}

impl Field {
    pub(super) const fn bytes(&self) -> usize {
        self.scalar.size() * self.count
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Binary,
    Compressed,
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) fields: Vec<Field>,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) points: usize,
    pub(super) viewpoint: [f64; 7],
    pub(super) encoding: Encoding,
    /// Bytes and values of a row.
    pub(super) row: usize,
    pub(super) columns: usize,
    /// Lines of the header.
    pub(super) lines: usize,
}

/// A header has few lines; more means that this is no PCD file.
const MOST_LINES: usize = 200;
/// Most bytes of a line of the header.
const MOST_LINE: usize = 1 << 20;
/// Most bytes or values of a row.
const MOST_ROW: usize = 1 << 20;

impl Header {
    /// The header and the bytes after its DATA line.
    pub(super) fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), Fault> {
        let mut rest = bytes.strip_prefix(BOM).unwrap_or(bytes);
        let mut raw = Raw::default();
        for number in 1..=MOST_LINES {
            if rest.is_empty() {
                break;
            }
            let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
            let line = String::from_utf8_lossy(&rest[..end.min(MOST_LINE)]).into_owned();
            if end > MOST_LINE && !line.starts_with('#') {
                let problem = format!(
                    "the header has a line of {end} bytes, over {MOST_LINE}: is this a PCD file?"
                );
                return Err(Fault::line(number, problem));
            }
            rest = rest.get(end + 1..).unwrap_or(&[]);
            if raw.take(number, line.trim())? {
                return Ok((raw.finish(number)?, rest));
            }
        }
        Err(Fault::new(
            "header",
            "there is no DATA line: the header is cut off, or this is no PCD file",
        ))
    }
}

/// The header's entries as they come.
#[derive(Default)]
struct Raw {
    fields: Vec<String>,
    sizes: Vec<usize>,
    types: Vec<char>,
    counts: Vec<usize>,
    width: Option<usize>,
    height: Option<usize>,
    points: Option<usize>,
    viewpoint: Option<[f64; 7]>,
    encoding: Option<Encoding>,
}

impl Raw {
    /// Takes one line; true when it was the DATA line.
    fn take(&mut self, number: usize, line: &str) -> Result<bool, Fault> {
        let mut words = line.split_whitespace();
        let Some(key) = words.next().filter(|k| !k.starts_with('#')) else { return Ok(false) };
        let whole = |w: &str| {
            w.parse::<usize>().map_err(|_| {
                Fault::line(number, format!("{key} has {w:?}: an invalid or negative number"))
            })
        };
        let single = |words: &mut dyn Iterator<Item = &str>| {
            whole(words.next().ok_or_else(|| Fault::line(number, format!("{key} has no value")))?)
        };
        match key {
            "VERSION" => {}
            "FIELDS" | "COLUMNS" => self.fields = words.map(str::to_owned).collect(),
            "SIZE" => self.sizes = words.map(whole).collect::<Result<_, _>>()?,
            "TYPE" => self.types = words.filter_map(|w| w.chars().next()).collect(),
            "COUNT" => self.counts = words.map(whole).collect::<Result<_, _>>()?,
            "WIDTH" => self.width = Some(single(&mut words)?),
            "HEIGHT" => self.height = Some(single(&mut words)?),
            "POINTS" => self.points = Some(single(&mut words)?),
            "VIEWPOINT" => {
                let numbers: Option<Vec<f64>> = words.map(|w| w.parse().ok()).collect();
                let viewpoint = numbers.and_then(|n| n.try_into().ok()).ok_or_else(|| {
                    let mend = "seven numbers x y z qw qx qy qz are needed; 0 0 0 1 0 0 0 where the pose is unknown";
                    Fault::line(number, format!("{}: {mend}", line.trim()))
                })?;
                self.viewpoint = Some(viewpoint);
            }
            "DATA" => {
                self.encoding = Some(match words.next() {
                    Some("ascii") => Encoding::Ascii,
                    Some("binary") => Encoding::Binary,
                    Some("binary_compressed") => Encoding::Compressed,
                    other => {
                        let what = other.unwrap_or("nothing");
                        let known =
                            "ascii, binary or binary_compressed is needed, on a line of its own";
                        return Err(Fault::line(number, format!("DATA is {what:?}: {known}")));
                    }
                });
                return Ok(true);
            }
            other => {
                let text: String = other.chars().take(40).collect();
                return Err(Fault::line(number, format!("header has an unknown entry {text:?}")));
            }
        }
        Ok(false)
    }

    fn finish(self, lines: usize) -> Result<Header, Fault> {
        let n = self.fields.len();
        if n == 0 {
            return Err(Fault::new("header", "FIELDS is missing: x, y, z (xyz) must be named"));
        }
        for (what, found) in [("SIZE", self.sizes.len()), ("TYPE", self.types.len())] {
            if found != n {
                let problem = format!("FIELDS names {n} but {what} has {found}: a mismatch");
                return Err(Fault::new(what, problem));
            }
        }
        let counts = if self.counts.is_empty() { vec![1; n] } else { self.counts };
        if counts.len() != n {
            let problem = format!("FIELDS names {n} but COUNT has {}: a mismatch", counts.len());
            return Err(Fault::new("COUNT", problem));
        }
        let (mut fields, mut row, mut columns) = (Vec::with_capacity(n), 0usize, 0usize);
        for (((name, size), kind), count) in
            self.fields.into_iter().zip(self.sizes).zip(self.types).zip(counts)
        {
            let scalar = scalar(kind, size).ok_or_else(|| {
                Fault::new("TYPE", format!("field {name} has TYPE {kind} with SIZE {size}"))
            })?;
            if count == 0 || count > MOST_ROW || row > MOST_ROW {
                let problem =
                    format!("field {name} has COUNT {count}: 1 to {MOST_ROW} are possible");
                return Err(Fault::new("COUNT", problem));
            }
            fields.push(Field { name, scalar, count, offset: row, column: columns });
            row += scalar.size() * count;
            columns += count;
        }
        let height = self.height.unwrap_or(1);
        let width = match (self.width, self.points) {
            (Some(w), _) => w,
            (None, Some(p)) => p,
            (None, None) => return Err(Fault::new("header", "neither WIDTH nor POINTS is given")),
        };
        let cells = width.checked_mul(height);
        let points = self.points.or(cells);
        let (Some(points), true) = (points, cells == points) else {
            let given = self.points.unwrap_or_default();
            let problem =
                format!("POINTS is {given} but WIDTH x HEIGHT is {width} x {height}: a mismatch");
            return Err(Fault::new("header", problem));
        };
        let viewpoint = self.viewpoint.unwrap_or([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        let encoding = self.encoding.unwrap_or(Encoding::Ascii);
        Ok(Header { fields, width, height, points, viewpoint, encoding, row, columns, lines })
    }
}

const fn scalar(kind: char, size: usize) -> Option<Scalar> {
    Some(match (kind, size) {
        ('F', 4) => Scalar::F32,
        ('F', 8) => Scalar::F64,
        ('I', 1) => Scalar::I8,
        ('I', 2) => Scalar::I16,
        ('I', 4) => Scalar::I32,
        ('I', 8) => Scalar::I64,
        ('U', 1) => Scalar::U8,
        ('U', 2) => Scalar::U16,
        ('U', 4) => Scalar::U32,
        ('U', 8) => Scalar::U64,
        _ => return None,
    })
}
