//! Labels as a NumPy file: int32, one dimension, format version 1.0.

use std::path::Path;

use crate::error::WriteError;
use crate::write::write_bytes;

/// Writes one label a point, in file order.
pub fn write_labels(file: &Path, labels: &[i32]) -> Result<(), WriteError> {
    let mut header =
        format!("{{'descr': '<i4', 'fortran_order': False, 'shape': ({},), }}", labels.len());
    // magic, version, length and header together are a multiple of 64 bytes and end in a newline
    let padding = 63 - (10 + header.len()) % 64;
    header.push_str(&" ".repeat(padding));
    header.push('\n');
    let mut bytes = Vec::with_capacity(10 + header.len() + 4 * labels.len());
    bytes.extend_from_slice(b"\x93NUMPY\x01\x00");
    bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    bytes.extend(labels.iter().flat_map(|l| l.to_le_bytes()));
    write_bytes(file, &bytes)
}
