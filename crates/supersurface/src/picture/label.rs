//! Labels: words on a plate with a leader line to what they name, set so that none covers another.

use super::image::Image;
use super::text::{text_width, write};
use super::{Colour, mix};

/// Words that name a place of the picture, in pixels.
#[derive(Clone, Debug)]
pub(super) struct Label {
    pub(super) anchor: [f64; 2],
    pub(super) words: String,
    pub(super) colour: Colour,
}

/// Left, top, right, bottom.
pub(super) type Plate = [f64; 4];

/// Draws all labels that lie inside the image, off the plates that are taken and, where it can be, off
/// what is busy (a share of a plate in [0, 1]).
pub(super) fn set(
    image: &mut Image,
    labels: &[Label],
    mut taken: Vec<Plate>,
    busy: impl Fn(&Plate) -> f64,
) {
    let others = taken.len();
    let (width, height) = (image.width as f64, image.height as f64);
    let size = (height / 55.0).clamp(8.0, 22.0).round();
    let inside = |[x, y]: [f64; 2]| x >= 0.0 && y >= 0.0 && x < width && y < height;
    let labels: Vec<&Label> = labels.iter().filter(|l| inside(l.anchor)).collect();
    for label in &labels {
        let plate = place(label, size, [width, height], &taken, &busy);
        taken.push(plate);
        leader(image, label, &plate, size);
    }
    for (label, [left, top, right, bottom]) in labels.iter().zip(taken.iter().skip(others)) {
        let (at, extent) = ([*left, *top], [right - left, bottom - top]);
        image.fill(at, extent, mix(label.colour, [255; 3], 0.92), 0.88);
        image.fill(at, [0.35 * size, extent[1]], label.colour, 1.0);
        let ink = mix(label.colour, [20, 22, 26], 0.75);
        write(image, [left + 0.9 * size, top + 0.55 * size], &label.words, ink, size);
    }
}

/// The place near the anchor, in eight directions and four distances, that covers no other plate and
/// least of what is drawn.
fn place(
    label: &Label,
    size: f64,
    [width, height]: [f64; 2],
    taken: &[Plate],
    busy: impl Fn(&Plate) -> f64,
) -> Plate {
    let [x, y] = label.anchor;
    let (w, h) = (text_width(&label.words, size) + 1.6 * size, 2.2 * size);
    let mut best = (f64::INFINITY, [0.0; 4]);
    for ring in 0..4 {
        let away = size * (1.8 + 1.6 * f64::from(ring));
        for (dx, dy) in [(0, -1), (1, -1), (-1, -1), (1, 0), (-1, 0), (0, 1), (1, 1), (-1, 1)] {
            let (dx, dy) = (f64::from(dx), f64::from(dy));
            let left = x - 0.5 * w + dx * (away + 0.5 * w);
            let top = y - 0.5 * h + dy * (away + 0.5 * h);
            let left = left.min(width - w - 4.0).max(4.0).round();
            let top = top.min(height - h - 4.0).max(4.0).round();
            let plate = [left, top, left + w, top + h];
            let over = taken.iter().filter(|other| touch(&plate, other)).count() as f64;
            let hidden = touch(&plate, &[x, y, x, y]) as u8;
            let below = if dy > 0.0 { 0.25 } else { 0.0 };
            let cost = 10.0 * over
                + 5.0 * f64::from(hidden)
                + 3.0 * busy(&plate)
                + 0.2 * f64::from(ring)
                + below;
            if cost < best.0 {
                best = (cost, plate);
            }
        }
    }
    best.1
}

/// True when two plates come nearer than 3 pixels.
fn touch(a: &Plate, b: &Plate) -> bool {
    a[0] <= b[2] + 3.0 && b[0] <= a[2] + 3.0 && a[1] <= b[3] + 3.0 && b[1] <= a[3] + 3.0
}

/// The line from the plate to the anchor, and a dot there.
fn leader(image: &mut Image, label: &Label, [left, top, right, bottom]: &Plate, size: f64) {
    let [x, y] = label.anchor;
    let from = [x.clamp(*left, *right), y.clamp(*top, *bottom)];
    let (dx, dy) = (x - from[0], y - from[1]);
    let length = dx.hypot(dy);
    let ink = mix(label.colour, [0; 3], 0.3);
    let (dot, pen) = (0.28 * size, 0.07 * size);
    let reach = dot + 1.0;
    let range = |a: f64, b: f64, most: usize| {
        let clip = |v: f64| v.clamp(0.0, most as f64) as usize;
        clip((a.min(b) - reach).floor())..clip((a.max(b) + reach).ceil())
    };
    for row in range(from[1], y, image.height) {
        for column in range(from[0], x, image.width) {
            let (px, py) = (column as f64 + 0.5 - from[0], row as f64 + 0.5 - from[1]);
            let t = if length > 0.0 { (px * dx + py * dy) / (length * length) } else { 0.0 };
            let t = t.clamp(0.0, 1.0);
            let line = pen.max(0.6) - (px - t * dx).hypot(py - t * dy);
            let end = dot - (px - dx).hypot(py - dy);
            let cover = (line.max(end) + 0.5).clamp(0.0, 1.0);
            image.blend(column, row, ink, cover);
        }
    }
}
