//! PLY: ascii, binary little and big endian, with any further properties and elements.

use supersurface::Point;
use supersurface::cloud::PointCloud;

use crate::bytes::Scalar;
use crate::error::Fault;
use crate::read::{BOM, Read, ReadOptions, label, no_field};
use crate::text::number;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

#[derive(Clone, Debug)]
struct Property {
    name: String,
    scalar: Scalar,
    /// Type of the length, for lists.
    list: Option<Scalar>,
}

#[derive(Clone, Debug)]
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    lines: usize,
}

const MOST_LINES: usize = 2000;

pub(crate) fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Read, Fault> {
    let (header, body) = parse_header(bytes.strip_prefix(BOM).unwrap_or(bytes))?;
    let Some(at) = header.elements.iter().position(|e| e.name == "vertex") else {
        return Err(Fault::new("header", "there is no element vertex: the file has no points"));
    };
    let (before, vertex) = (&header.elements[..at], &header.elements[at]);
    let columns = Columns::of(vertex, options)?;
    // a point has at least a byte: never more room than the body can fill
    let mut cloud = PointCloud::default();
    if vertex.count > body.len() {
        let problem =
            format!("{} vertices expected from {} bytes: truncated", vertex.count, body.len());
        return Err(Fault::new("element vertex", problem));
    }
    let mut source: Box<dyn Source> = match header.encoding {
        Encoding::Ascii => Box::new(AsciiSource { body, line: header.lines }),
        Encoding::Little => Box::new(BinarySource { body, big_endian: false }),
        Encoding::Big => Box::new(BinarySource { body, big_endian: true }),
    };
    let mut values = Vec::new();
    // an element without properties has empty rows, however many of them are promised
    for element in before.iter().filter(|e| !e.properties.is_empty()) {
        for i in 0..element.count {
            source.row(element, i, &mut values)?;
        }
    }
    for i in 0..vertex.count {
        source.row(vertex, i, &mut values)?;
        columns.take(&values, &mut cloud);
    }
    Ok(Read { cloud, warnings: Vec::new() })
}

fn parse_header(bytes: &[u8]) -> Result<(Header, &[u8]), Fault> {
    let mut rest = bytes;
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    for line_number in 1..=MOST_LINES {
        if rest.is_empty() {
            break;
        }
        let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        let line = String::from_utf8_lossy(&rest[..end.min(4096)]).into_owned();
        rest = rest.get(end + 1..).unwrap_or(&[]);
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["ply"] | ["comment" | "obj_info", ..] | [] => {}
            ["format", kind, ..] => {
                encoding = Some(match *kind {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    other => {
                        return Err(Fault::line(line_number, format!("unknown format {other:?}")));
                    }
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| {
                    Fault::line(
                        line_number,
                        format!("element {name} has an invalid count {count:?}"),
                    )
                })?;
                elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
            }
            ["property", tail @ ..] => {
                let property = property(tail).ok_or_else(|| {
                    let text: String = line.trim().chars().take(60).collect();
                    Fault::line(line_number, format!("unknown type in {text:?}"))
                })?;
                let Some(element) = elements.last_mut() else {
                    return Err(Fault::line(line_number, "a property before any element"));
                };
                element.properties.push(property);
            }
            ["end_header"] => {
                let Some(encoding) = encoding else {
                    return Err(Fault::new("header", "there is no format line"));
                };
                return Ok((Header { encoding, elements, lines: line_number }, rest));
            }
            _ => {
                let text: String = line.trim().chars().take(60).collect();
                let problem = format!("unexpected {text:?}: is end_header missing?");
                return Err(Fault::line(line_number, problem));
            }
        }
    }
    Err(Fault::new("header", "there is no end_header: the file is cut off, or no PLY"))
}

fn property(words: &[&str]) -> Option<Property> {
    match words {
        ["list", length, item, name] => Some(Property {
            name: (*name).to_owned(),
            scalar: scalar(item)?,
            list: Some(scalar(length).filter(|s| !matches!(s, Scalar::F32 | Scalar::F64))?),
        }),
        [kind, name] => {
            Some(Property { name: (*name).to_owned(), scalar: scalar(kind)?, list: None })
        }
        _ => None,
    }
}

fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => return None,
    })
}

/// Which values of a vertex are read. Values of lists are not kept, so each property has one.
struct Columns {
    position: [usize; 3],
    colour: Option<[usize; 3]>,
    /// Colours are shares of one.
    unit_colour: bool,
    label: Option<usize>,
}

impl Columns {
    fn of(vertex: &Element, options: &ReadOptions) -> Result<Self, Fault> {
        let find =
            |name: &str| vertex.properties.iter().position(|p| p.name == name && p.list.is_none());
        let need = |name: &str| {
            let problem = || format!("the vertex element has no property {name}");
            find(name).ok_or_else(|| Fault::new("header", problem()))
        };
        let triple = |prefix: &str, names: [&str; 3]| {
            let [r, g, b] = names.map(|n| find(&format!("{prefix}{n}")));
            Some([r?, g?, b?])
        };
        let full = ["red", "green", "blue"];
        let colour = triple("", full)
            .or_else(|| triple("diffuse_", full))
            .or_else(|| triple("", ["r", "g", "b"]));
        let float = |k: usize| matches!(vertex.properties[k].scalar, Scalar::F32 | Scalar::F64);
        let label = options.instances.as_deref().map(|wanted| {
            find(wanted)
                .ok_or_else(|| no_field(wanted, vertex.properties.iter().map(|p| p.name.as_str())))
        });
        Ok(Self {
            position: [need("x")?, need("y")?, need("z")?],
            unit_colour: colour.is_some_and(|[r, ..]| float(r)),
            colour,
            label: label.transpose()?,
        })
    }

    fn take(&self, values: &[f64], cloud: &mut PointCloud) {
        let at = |i: usize| values.get(i).copied().unwrap_or(f64::NAN);
        let [x, y, z] = self.position;
        cloud.points.push(Point::new(at(x), at(y), at(z)));
        if let Some(colour) = self.colour {
            let scale = if self.unit_colour { 255.0 } else { 1.0 };
            cloud.colours.push(colour.map(|k| (at(k) * scale).clamp(0.0, 255.0) as u8));
        }
        if let Some(k) = self.label {
            cloud.labels.push(label(at(k)));
        }
    }
}

/// Rows of an element, one after the other: a value for each property (0 for lists, which are skipped).
trait Source {
    fn row(&mut self, element: &Element, index: usize, values: &mut Vec<f64>) -> Result<(), Fault>;
}

struct AsciiSource<'a> {
    body: &'a [u8],
    line: usize,
}

impl Source for AsciiSource<'_> {
    fn row(&mut self, element: &Element, index: usize, values: &mut Vec<f64>) -> Result<(), Fault> {
        let line = loop {
            if self.body.is_empty() {
                let (count, name) = (element.count, &element.name);
                let problem = format!("{count} rows of {name} expected, {index} found: truncated");
                return Err(Fault::line(self.line + 1, problem));
            }
            let end = self.body.iter().position(|b| *b == b'\n').unwrap_or(self.body.len());
            let (line, rest) = self.body.split_at(end);
            self.body = rest.get(1..).unwrap_or(&[]);
            self.line += 1;
            if !line.trim_ascii().is_empty() {
                break line;
            }
        };
        let text = std::str::from_utf8(line)
            .map_err(|_| Fault::line(self.line, "is no text: is the file binary?"))?;
        let mut words = text.split_whitespace();
        let mut next = |what: &str| {
            let short = || Fault::line(self.line, format!("no value for property {what}"));
            let word = words.next().ok_or_else(short)?;
            number(word).ok_or_else(|| {
                let word: String = word.chars().take(40).collect();
                Fault::line(self.line, format!("cannot parse {word:?} as a number"))
            })
        };
        values.clear();
        for property in &element.properties {
            let value = next(&property.name)?;
            if property.list.is_some() {
                for _ in 0..value as usize {
                    next(&property.name)?;
                }
            }
            values.push(if property.list.is_some() { 0.0 } else { value });
        }
        Ok(())
    }
}

struct BinarySource<'a> {
    body: &'a [u8],
    big_endian: bool,
}

impl BinarySource<'_> {
    fn take(&mut self, scalar: Scalar) -> Option<f64> {
        let value = scalar.get(self.body, self.big_endian)?;
        self.body = self.body.get(scalar.size()..)?;
        Some(value)
    }

    fn values(&mut self, element: &Element, values: &mut Vec<f64>) -> Option<()> {
        values.clear();
        for property in &element.properties {
            match property.list {
                None => values.push(self.take(property.scalar)?),
                Some(length) => {
                    let count = self.take(length)? as usize;
                    self.body = self.body.get(count.checked_mul(property.scalar.size())?..)?;
                    values.push(0.0);
                }
            }
        }
        Some(())
    }
}

impl Source for BinarySource<'_> {
    fn row(&mut self, element: &Element, index: usize, values: &mut Vec<f64>) -> Result<(), Fault> {
        self.values(element, values).ok_or_else(|| {
            let problem = format!(
                "{} expected, the bytes end within number {}: truncated",
                element.count,
                index + 1
            );
            Fault::new(format!("element {}", element.name), problem)
        })
    }
}
