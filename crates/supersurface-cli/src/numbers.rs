//! Numbers for people.

/// Five significant digits.
pub(crate) fn short(v: f64) -> String {
    match v.abs() {
        0.0 => "0".into(),
        1e-3..1e5 => {
            // 9.99996 is shown as 10.000
            let digits = 4 - (v.abs() * (1.0 + 5e-6)).log10().floor() as i32;
            format!("{v:.*}", digits.max(0) as usize)
        }
        _ => format!("{v:.4e}"),
    }
}

/// So many decimals, zero without a sign.
pub(crate) fn fixed(v: f64, decimals: usize) -> String {
    let shown = format!("{v:.decimals$}");
    let is_zero = shown.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
    shown.strip_prefix('-').filter(|_| is_zero).map_or(shown.clone(), str::to_owned)
}
