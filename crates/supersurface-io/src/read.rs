//! The door: any file to a cloud, its format recognised by its content.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use supersurface::Point;
use supersurface::cloud::PointCloud;

use crate::camera_json::DepthCamera;
use crate::error::{Fault, ReadError};
use crate::{depth_png, pcd, ply, text};

/// Most bytes of a file that are read.
const LIMIT: u64 = 2 << 30;

/// How to read.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// The field whose numbers are taken as instance labels.
    pub instances: Option<String>,
    /// The camera of a depth image.
    pub camera: Option<DepthCamera>,
}

/// A cloud and what its reader noticed.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Read {
    /// The cloud, in the file's own frame and units.
    pub cloud: PointCloud,
    /// What was odd but did no harm.
    pub warnings: Vec<String>,
}

/// Reads a cloud or depth image from a file; `-` is standard input.
///
/// The viewpoint of the cloud is the origin of its frame, where the sensor of such files stands.
pub fn read(file: &Path, options: &ReadOptions) -> Result<Read, ReadError> {
    let bytes = load(file)?;
    parse(&shown_name(file), &bytes, options)
}

/// An input's name as it stands in messages and reports: `-` is "standard input".
pub fn shown_name(file: &Path) -> String {
    if file == Path::new("-") { "standard input".to_owned() } else { file.display().to_string() }
}

/// The bytes of a file or of standard input.
pub(crate) fn load(file: &Path) -> Result<Vec<u8>, ReadError> {
    let name = || shown_name(file);
    let io = |source| ReadError::io(file, source);
    let mut bytes = Vec::new();
    let read = if file == Path::new("-") {
        std::io::stdin().lock().take(LIMIT + 1).read_to_end(&mut bytes)
    } else {
        let opened = File::open(file).map_err(io)?;
        let length = opened.metadata().map_err(io)?.len();
        if length > LIMIT {
            return Err(ReadError::TooLarge { file: name(), limit: LIMIT });
        }
        bytes
            .try_reserve_exact(length as usize)
            .map_err(|_| ReadError::NoMemory { file: name(), bytes: length })?;
        opened.take(LIMIT + 1).read_to_end(&mut bytes)
    };
    read.map_err(io)?;
    if bytes.len() as u64 > LIMIT {
        return Err(ReadError::TooLarge { file: name(), limit: LIMIT });
    }
    Ok(bytes)
}

/// The same for bytes that are in memory already; `name` stands in errors, and its extension helps where the
/// content says nothing.
pub fn parse(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Read, ReadError> {
    let format = Format::of(name, bytes);
    let malformed = |fault| ReadError::malformed(name, format.name(), fault);
    let mut read = match format {
        Format::Pcd => pcd::parse(bytes, options).map_err(malformed)?,
        Format::Ply => ply::parse(bytes, options).map_err(malformed)?,
        Format::Text => text::parse(bytes, options).map_err(malformed)?,
        Format::DepthPng => depth_png::parse(bytes, options).map_err(malformed)?,
        Format::Other(format) => {
            let mend = "convert the cloud to PCD, PLY or text (x y z a line)";
            return Err(ReadError::Unsupported { file: name.to_owned(), format, mend });
        }
    };
    if options.camera.is_some() && format != Format::DepthPng {
        read.warnings.push("the camera is for depth images: it was not used".to_owned());
    }
    read.cloud.viewpoint = Some(Point::origin());
    Ok(read)
}

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Pcd,
    Ply,
    Text,
    DepthPng,
    /// Recognised, and not read.
    Other(&'static str),
}

/// Byte order mark that some editors put before text.
pub(crate) const BOM: &[u8] = b"\xEF\xBB\xBF";

impl Format {
    fn of(name: &str, bytes: &[u8]) -> Self {
        const MAGIC: &[(&[u8], Format)] = &[
            (b"\x89PNG", Format::DepthPng),
            (b"ply\n", Format::Ply),
            (b"ply\r", Format::Ply),
            (b"# .PCD", Format::Pcd),
            (b"#.PCD", Format::Pcd),
            (b"VERSION", Format::Pcd),
            (b"FIELDS", Format::Pcd),
            (b"COLUMNS", Format::Pcd),
            (b"LASF", Format::Other("LAS")),
            (b"\x1f\x8b", Format::Other("gzip (.gz): unpack it first")),
            (b"ASTM-E57", Format::Other("E57")),
            (b"PK\x03\x04", Format::Other("zip: unpack it first")),
            (b"\x28\xb5\x2f\xfd", Format::Other("zstd: unpack it first")),
            (b"\x89HDF", Format::Other("HDF5")),
            (b"\x93NUMPY", Format::Other("NumPy")),
            (b"OFF", Format::Other("OFF mesh")),
            (b"solid ", Format::Other("STL mesh")),
            (b"\xff\xd8\xff", Format::Other("JPEG: depth must be a 16-bit PNG")),
        ];
        let body = bytes.strip_prefix(BOM).unwrap_or(bytes);
        if let Some((_, format)) = MAGIC.iter().find(|(magic, _)| body.starts_with(magic)) {
            return *format;
        }
        let extension = Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or("");
        match extension.to_ascii_lowercase().as_str() {
            "pcd" => Self::Pcd,
            "ply" => Self::Ply,
            "png" => Self::DepthPng,
            "las" | "laz" => Self::Other("LAS"),
            "e57" => Self::Other("E57"),
            "gz" => Self::Other("gzip (.gz): unpack it first"),
            "off" => Self::Other("OFF mesh"),
            "stl" => Self::Other("STL mesh"),
            "obj" => Self::Other("OBJ mesh"),
            _ => Self::Text,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Pcd => "PCD",
            Self::Ply => "PLY",
            Self::Text => "text",
            Self::DepthPng => "depth PNG",
            Self::Other(name) => name,
        }
    }
}

/// The fault of a label field that the file does not have.
pub(crate) fn no_field<'a>(wanted: &str, known: impl Iterator<Item = &'a str>) -> Fault {
    let known: Vec<&str> = known.collect();
    Fault::new(
        format!("field {wanted}"),
        format!("the file has no such field; it has {}", known.join(", ")),
    )
}

/// A label as a number of an instance; what is no number of one is background.
pub(crate) fn label(value: f64) -> u32 {
    let whole = value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0;
    if whole { value as u32 } else { 0 }
}
