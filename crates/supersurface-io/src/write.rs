//! Writing so that a failure leaves no half file: into a neighbour first, then renamed.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use crate::error::WriteError;

/// Writes `bytes` to a file. What is there and no regular file (a link, a pipe, `/dev/stdout`) is written through,
/// never replaced: a rename would put a plain file in its place.
pub(crate) fn write_bytes(file: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let failed = |e| WriteError::new(file, e);
    if fs::symlink_metadata(file).is_ok_and(|m| !m.is_file()) {
        let mut options = fs::OpenOptions::new();
        let opened = options.write(true).create(true).truncate(true).open(file);
        return opened.and_then(|mut out| out.write_all(bytes)).map_err(failed);
    }
    let Some(name) = file.file_name() else {
        return Err(failed(io::Error::new(io::ErrorKind::InvalidInput, "no file name")));
    };
    let mut beside = name.to_owned();
    beside.push(format!(".{}.part", std::process::id()));
    let beside = file.with_file_name(beside);
    let result = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, file));
    if result.is_err() {
        // the first error is the one to tell
        let _ = fs::remove_file(&beside);
    }
    result.map_err(failed)
}

/// Writes text, as a whole or not at all.
pub fn write_text(file: &Path, text: &str) -> Result<(), WriteError> {
    write_bytes(file, text.as_bytes())
}

/// Writes a picture: `size` is [width, height], `pixels` red, green, blue row by row.
pub fn write_png(file: &Path, size: [usize; 2], pixels: &[u8]) -> Result<(), WriteError> {
    encoded(file, size, png::ColorType::Rgb, png::BitDepth::Eight, pixels)
}

/// Writes an image of one number of 16 bits a pixel.
pub(crate) fn write_grey(file: &Path, size: [usize; 2], pixels: &[u16]) -> Result<(), WriteError> {
    let bytes: Vec<u8> = pixels.iter().flat_map(|v| v.to_be_bytes()).collect();
    encoded(file, size, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
}

fn encoded(
    file: &Path,
    size: [usize; 2],
    colour: png::ColorType,
    depth: png::BitDepth,
    bytes: &[u8],
) -> Result<(), WriteError> {
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, size[0] as u32, size[1] as u32);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        encoder.set_compression(png::Compression::Fast);
        encoder.write_header()?.write_image_data(bytes)?;
        Ok(out)
    };
    let bytes = encode().map_err(|e| WriteError::new(file, io::Error::other(e)))?;
    write_bytes(file, &bytes)
}
