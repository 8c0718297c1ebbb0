//! The pairs as a file, for peers that are not written in Rust: one JSON object a line.
//!
//! Semi-axes `a`, exponents `e`, quaternion `q` (w, x, y, z; body to world) and centre `t` of A and B; the
//! `regime`, the `size`, and the trusted signed `distance` (null where it is not known). Metres.

use std::io::{BufWriter, Result, Write};

use serde_json::{Value, json};
use supersurface::shape::{Posed, Superellipsoid};

use crate::pairs::Pair;
use crate::trusted::Trusted;

/// Adds the pairs to a file.
pub fn write(file: impl Write, pairs: &[Pair], trusted: &[Trusted]) -> Result<()> {
    let mut file = BufWriter::new(file);
    for (pair, truth) in pairs.iter().zip(trusted) {
        let line = json!({
            "regime": pair.regime.name(),
            "A": body(&pair.a),
            "B": body(&pair.b),
            "size": pair.size,
            "distance": truth.distance,
        });
        writeln!(file, "{line}")?;
    }
    file.flush()
}

fn body(posed: &Posed<Superellipsoid>) -> Value {
    let (t, q) = (posed.pose().translation, posed.pose().rotation);
    json!({
        "a": posed.shape().semi_axes(),
        "e": posed.shape().exponents(),
        "q": [q.w, q.i, q.j, q.k],
        "t": [t.x, t.y, t.z],
    })
}
