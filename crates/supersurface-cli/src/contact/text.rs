//! A contact for people.

use std::fmt::Write;

use supersurface::Point;
use supersurface::contact::{Contact, Sliced};
use supersurface::shape::Implicit;

use crate::numbers::{fixed, short};

/// Distances below this share of the bodies' size are none.
const TOUCHING: f64 = 1e-9;

/// Lengths in millimetres, or in metres for bodies of a metre and more.
pub(super) struct Lengths {
    size: f64,
    unit: &'static str,
    /// Of these in a metre.
    units: f64,
}

impl Lengths {
    /// As suits two bodies, whose size is the mean of their largest half widths.
    pub(super) fn of(bodies: &[Sliced; 2]) -> Self {
        let largest = |body: &Sliced| {
            let [low, high] = body.solid().shape().bounds();
            0.5 * (high - low).amax()
        };
        let size = 0.5 * largest(&bodies[0]) + 0.5 * largest(&bodies[1]);
        let (unit, units) = if size < 1.0 { ("mm", 1e3) } else { ("m", 1.0) };
        Self { size, unit, units }
    }

    /// What a signed distance says.
    pub(super) fn told(&self, distance: f64) -> String {
        let length = format!("{} {}", short(self.units * distance.abs()), self.unit);
        match distance {
            d if d.abs() <= TOUCHING * self.size => "touching".into(),
            d if d < 0.0 => format!("overlapping by {length}"),
            _ => format!("apart by {length}"),
        }
    }

    /// A place, to the fifth digit of the bodies' size.
    fn place(&self, p: &Point) -> String {
        let size = self.units * self.size;
        let shown = p.iter().map(|v| match (1e-6..1e9).contains(&size) {
            true => fixed(self.units * v, (4.0 - size.log10().floor()).max(0.0) as usize),
            false => short(self.units * v),
        });
        format!("({}) {}", shown.collect::<Vec<_>>().join(", "), self.unit)
    }
}

/// The text of a contact.
pub(super) fn text([a, b]: [&str; 2], bodies: &[Sliced; 2], contact: &Contact) -> String {
    let lengths = Lengths::of(bodies);
    let mut out = format!("{}\n", lengths.told(contact.distance));
    let mut line = |what: &str, value: String| {
        // writing to a string does not fail
        let _ = writeln!(out, "  {what:<18} {value}");
    };
    let ([low, high], unit) = (contact.bounds.map(|v| lengths.units * v), lengths.unit);
    let width = format!("{:.1e} {unit} wide", high - low);
    line("bounds", format!("{} to {} {unit} ({width})", short(low), short(high)));
    let normal: Vec<String> = contact.normal.iter().map(|v| fixed(*v, 5)).collect();
    line("normal", format!("({}), from A to B", normal.join(", ")));
    let [on_a, on_b] = &contact.witnesses;
    line("point of A", format!("{}, {a}", lengths.place(on_a)));
    line("point of B", format!("{}, {b}", lengths.place(on_b)));
    out
}
