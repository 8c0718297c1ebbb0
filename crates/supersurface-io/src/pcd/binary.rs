//! Rows of bytes, and their compressed form, which stores a column after the other.

use super::header::{Field, Header};
use super::{Rows, Wanted, lzf};
use crate::bytes::Scalar;
use crate::error::Fault;

pub(super) fn read(
    header: &Header,
    body: &[u8],
    wanted: &Wanted,
    rows: &mut Rows,
) -> Result<(), Fault> {
    let needed = size(header)?;
    if body.len() < needed {
        let problem = format!("{needed} bytes expected, {} found: truncated", body.len());
        return Err(Fault::new("data", problem));
    }
    take(header, wanted, rows, |field, point| {
        body.get(point * header.row + field.offset..).unwrap_or(&[])
    });
    Ok(())
}

pub(super) fn read_compressed(
    header: &Header,
    body: &[u8],
    wanted: &Wanted,
    rows: &mut Rows,
) -> Result<(), Fault> {
    let needed = size(header)?;
    if needed == 0 {
        return Ok(());
    }
    let length = |at: usize| Scalar::U32.get(body.get(at..)?, false).map(|v| v as usize);
    let (Some(packed), Some(unpacked)) = (length(0), length(4)) else {
        return Err(Fault::new(
            "data",
            "the two lengths before the compressed bytes are truncated",
        ));
    };
    let Some(input) = body.get(8..).and_then(|b| b.get(..packed)) else {
        let found = body.len().saturating_sub(8);
        let problem = format!("{packed} compressed bytes expected, {found} found: truncated");
        return Err(Fault::new("data", problem));
    };
    if unpacked != needed {
        let problem =
            format!("uncompressed size is {unpacked} bytes, {needed} expected from the header");
        return Err(Fault::new("data", problem));
    }
    let columns = lzf::decompress(input, unpacked).ok_or_else(|| {
        Fault::new("data", "the compressed bytes are corrupt: LZF cannot decompress them")
    })?;
    take(header, wanted, rows, |field, point| {
        columns.get(field.offset * header.points + point * field.bytes()..).unwrap_or(&[])
    });
    Ok(())
}

/// Bytes of all rows.
fn size(header: &Header) -> Result<usize, Fault> {
    header.row.checked_mul(header.points).filter(|n| *n < isize::MAX as usize).ok_or_else(|| {
        Fault::new("POINTS", format!("{} points are too many: their size overflows", header.points))
    })
}

/// Takes every point; `at` gives the bytes of a field.
fn take<'a>(
    header: &Header,
    wanted: &Wanted,
    rows: &mut Rows,
    at: impl Fn(&Field, usize) -> &'a [u8],
) {
    let value = |i: usize, point: usize| {
        let field = header.fields.get(i)?;
        field.scalar.get(at(field, point), false)
    };
    let bits = |i: usize, point: usize| {
        let field = header.fields.get(i)?;
        let head = at(field, point).get(..4).filter(|_| field.scalar.size() == 4)?;
        head.try_into().map(u32::from_le_bytes).ok()
    };
    for point in 0..header.points {
        let position = wanted.position.map(|i| value(i, point).unwrap_or(f64::NAN));
        let colour = wanted.colour.map(|i| bits(i, point).unwrap_or(0));
        let instance = wanted.label.map(|i| value(i, point).unwrap_or(0.0));
        rows.push(position, colour, instance);
    }
}
