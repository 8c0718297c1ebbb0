//! LZF, the compression of PCD: runs of literal bytes and references to what was written before.
//!
//! A control byte under 32 is followed by that many and one literal bytes. Otherwise its upper three bits are
//! a length (7: the next byte adds to it) and its lower five with one more byte a distance back.

/// Exactly `size` bytes; `None` when the input does not give them.
pub(super) fn decompress(input: &[u8], size: usize) -> Option<Vec<u8>> {
    // no input byte gives more than 264/3 bytes: a greater promise is a lie
    if size / 100 > input.len() {
        return None;
    }
    let mut out = crate::bytes::room::<u8>(size)?;
    let mut rest = input;
    while let Some((control, tail)) = rest.split_first() {
        let control = usize::from(*control);
        rest = tail;
        if control < 32 {
            let (run, tail) = rest.split_at_checked(control + 1)?;
            if out.len() + run.len() > size {
                return None;
            }
            out.extend_from_slice(run);
            rest = tail;
            continue;
        }
        let mut length = control >> 5;
        if length == 7 {
            let (more, tail) = rest.split_first()?;
            length += usize::from(*more);
            rest = tail;
        }
        let (low, tail) = rest.split_first()?;
        rest = tail;
        let back = ((control & 31) << 8) + usize::from(*low) + 1;
        let from = out.len().checked_sub(back)?;
        if out.len() + length + 2 > size {
            return None;
        }
        // the copy may run into what it writes
        for i in from..from + length + 2 {
            out.push(*out.get(i)?);
        }
    }
    (out.len() == size).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_overlapping_references() {
        // "ab", then 6 bytes from 2 back
        let packed = [1, b'a', b'b', 4 << 5, 1];
        assert_eq!(decompress(&packed, 8).as_deref(), Some(&b"abababab"[..]));
        assert_eq!(decompress(&packed, 9), None);
        assert_eq!(decompress(&[4 << 5, 1], 6), None);
        assert_eq!(decompress(&[], 1 << 40), None);
    }
}
