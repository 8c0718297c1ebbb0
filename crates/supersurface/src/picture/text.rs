//! Writes text into an image with a round pen.

use super::font::{CAPITAL, SPACING, glyph};
use super::image::Image;
use super::{Colour, mix};

/// Sizes of capitals that are drawn, in pixels.
const SIZES: [f64; 2] = [3.0, 400.0];

/// Width in pixels of a line of text whose capitals are `size` pixels high.
pub fn text_width(words: &str, size: f64) -> f64 {
    let grid: f64 = words.chars().map(|c| extent(c) + SPACING).sum();
    (grid - SPACING).max(0.0) * size / CAPITAL
}

/// Writes a line of text, top left of its capitals at (x, y), with a halo of the opposite lightness
/// so that it can be read on anything.
pub(super) fn write(image: &mut Image, [x, y]: [f64; 2], words: &str, colour: Colour, size: f64) {
    if !(x.is_finite() && y.is_finite() && size.is_finite()) {
        return;
    }
    let size = size.clamp(SIZES[0], SIZES[1]);
    let pen = (0.065 * size).max(0.55);
    let halo = pen + (0.12 * size).clamp(0.8, 4.0);
    let [r, g, b] = colour.map(f64::from);
    let light = 0.3 * r + 0.59 * g + 0.11 * b > 150.0;
    let around = mix(colour, if light { [0; 3] } else { [255; 3] }, 0.92);
    for (radius, ink, alpha) in [(halo, around, 0.75), (pen, colour, 1.0)] {
        let mut left = x;
        for c in words.chars() {
            stamp(image, [left, y], c, size / CAPITAL, radius, ink, alpha);
            left += (extent(c) + SPACING) * size / CAPITAL;
        }
    }
}

/// One character: the coverage of a pixel is that of the nearest stroke.
fn stamp(
    image: &mut Image,
    [left, top]: [f64; 2],
    c: char,
    scale: f64,
    radius: f64,
    ink: Colour,
    alpha: f64,
) {
    let segments: Vec<[[f64; 2]; 2]> = strokes(c)
        .flat_map(|stroke| {
            let points: Vec<[f64; 2]> =
                stroke.map(|[px, py]| [left + px * scale, top + py * scale]).collect();
            points.windows(2).filter_map(|w| <[[f64; 2]; 2]>::try_from(w).ok()).collect::<Vec<_>>()
        })
        .collect();
    let reach = radius + 1.0;
    let span = |from: f64, to: f64, most: usize| {
        let clip = |v: f64| v.clamp(0.0, most as f64) as usize;
        clip((from - reach).floor())..clip((to + reach).ceil())
    };
    for row in span(top, top + 11.0 * scale, image.height) {
        for column in span(left, left + extent(c) * scale, image.width) {
            // pixel centres at half coordinates
            let at = [column as f64 + 0.5, row as f64 + 0.5];
            let nearest = segments.iter().map(|s| distance(at, s)).fold(f64::INFINITY, f64::min);
            let cover = (radius + 0.5 - nearest).clamp(0.0, 1.0);
            if cover > 0.0 {
                image.blend(column, row, ink, alpha * cover);
            }
        }
    }
}

/// Points of each stroke on the grid.
fn strokes(c: char) -> impl Iterator<Item = impl Iterator<Item = [f64; 2]>> {
    glyph(c).split('|').map(|stroke| stroke.split(' ').filter_map(point))
}

fn point(code: &str) -> Option<[f64; 2]> {
    let mut digits = code.chars().map(|d| d.to_digit(16));
    Some([f64::from(digits.next()??), f64::from(digits.next()??)])
}

/// Width of a character on the grid.
fn extent(c: char) -> f64 {
    let widest = strokes(c).flatten().map(|p| p[0]).fold(0.0, f64::max);
    if c == ' ' { 2.0 } else { widest }
}

fn distance([x, y]: [f64; 2], [[ax, ay], [bx, by]]: &[[f64; 2]; 2]) -> f64 {
    let (dx, dy) = (bx - ax, by - ay);
    let length = dx * dx + dy * dy;
    let t = if length > 0.0 { ((x - ax) * dx + (y - ay) * dy) / length } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    (x - ax - t * dx).hypot(y - ay - t * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_leaves_ink_and_stays_inside() {
        let mut image = Image::filled(60, 20, [255; 3]);
        write(&mut image, [4.0, 4.0], "Ag 1", [0; 3], 10.0);
        assert!(image.pixels.iter().filter(|b| **b < 60).count() > 60);
        let untouched = image.clone();
        for at in [[f64::NAN, 0.0], [1e9, 0.0], [-1e9, -1e9], [5.0, f64::INFINITY]] {
            write(&mut image, at, "far away", [0; 3], 10.0);
        }
        assert_eq!(image, untouched);
    }

    #[test]
    fn width_grows_with_the_words() {
        assert_eq!(text_width("", 8.0), 0.0);
        assert!(text_width("box", 8.0) < text_width("boxes", 8.0));
        assert_eq!(text_width("box", 16.0), 2.0 * text_width("box", 8.0));
    }
}
