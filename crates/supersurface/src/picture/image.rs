//! The finished picture: RGB bytes.

use super::Colour;
use super::text;

/// Pixels, three bytes each (red, green, blue), row by row from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `3 * width * height` bytes.
    pub pixels: Vec<u8>,
}

impl Image {
    /// An image of one colour.
    pub fn filled(width: usize, height: usize, colour: Colour) -> Self {
        Self { width, height, pixels: colour.repeat(width * height) }
    }

    /// The colour of a pixel; `None` outside.
    pub fn pixel(&self, x: usize, y: usize) -> Option<Colour> {
        let at = 3 * (y * self.width + x);
        let bytes = self.pixels.get(at..at + 3).filter(|_| x < self.width)?;
        bytes.try_into().ok()
    }

    /// Both images side by side, with a white line of `gap` pixels between them; the lower one is
    /// filled up with white.
    pub fn beside(&self, other: &Self, gap: usize) -> Self {
        let height = self.height.max(other.height);
        let mut whole = Self::filled(self.width + gap + other.width, height, [255; 3]);
        whole.paste(self, 0, 0);
        whole.paste(other, self.width + gap, 0);
        whole
    }

    /// Draws another image over this one with its top left corner at (x, y); what hangs over is cut.
    pub fn paste(&mut self, other: &Self, x: usize, y: usize) {
        let columns = other.width.min(self.width.saturating_sub(x));
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let from = 3 * row * other.width;
            let to = 3 * ((y + row) * self.width + x);
            let source = other.pixels.get(from..from + 3 * columns);
            let target = self.pixels.get_mut(to..to + 3 * columns);
            if let (Some(source), Some(target)) = (source, target) {
                target.copy_from_slice(source);
            }
        }
    }

    /// Writes a line of text with the top left of its capitals at (x, y) pixels; `size` is the height
    /// of a capital in pixels.
    pub fn text(&mut self, x: f64, y: f64, words: &str, colour: Colour, size: f64) {
        text::write(self, [x, y], words, colour, size);
    }

    /// Fills a rectangle, `alpha` in [0, 1] over what is there.
    pub fn fill(
        &mut self,
        [x, y]: [f64; 2],
        [width, height]: [f64; 2],
        colour: Colour,
        alpha: f64,
    ) {
        let clip = |v: f64, most: usize| v.round().clamp(0.0, most as f64) as usize;
        for row in clip(y, self.height)..clip(y + height, self.height) {
            for column in clip(x, self.width)..clip(x + width, self.width) {
                self.blend(column, row, colour, alpha);
            }
        }
    }

    /// Mixes a colour into a pixel; nothing outside.
    #[inline]
    pub(super) fn blend(&mut self, x: usize, y: usize, colour: Colour, alpha: f64) {
        if x >= self.width {
            return;
        }
        let at = 3 * (y * self.width + x);
        if let Some(bytes) = self.pixels.get_mut(at..at + 3) {
            for (byte, c) in bytes.iter_mut().zip(colour) {
                let old = f64::from(*byte);
                *byte = (old + (f64::from(c) - old) * alpha).round() as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_stand_side_by_side() {
        let whole = Image::filled(2, 2, [1, 2, 3]).beside(&Image::filled(3, 1, [9, 9, 9]), 1);
        assert_eq!([whole.width, whole.height], [6, 2]);
        assert_eq!(whole.pixel(1, 1), Some([1, 2, 3]));
        assert_eq!(whole.pixel(2, 0), Some([255; 3]));
        assert_eq!(whole.pixel(5, 0), Some([9; 3]));
        assert_eq!(whole.pixel(5, 1), Some([255; 3]));
        assert_eq!(whole.pixel(6, 0), None);
    }
}
