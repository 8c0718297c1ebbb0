//! Samples with depth: triangles, lines and discs in, pixels out.
//!
//! There are 2 x 2 samples a pixel, in two layers. The opaque layer keeps the nearest colour; the
//! veil keeps the nearest translucent colour and lies over the opaque one where it is nearer. Dots are
//! lit by their own depths when the picture is finished, and noise of a percent of the depth
//! does not bring a dot before a veil: a cloud shows evenly through the surface fitted to it.

use super::image::Image;
use super::relief::relief;
use super::{Colour, mix};

/// Samples along each side of a pixel.
pub(super) const SAMPLES: usize = 2;

/// Relative error of depth that is taken for noise of a cloud.
const DOT_NOISE: f32 = 0.008;

/// A corner on the canvas: position in samples and the inverse of depth, which is linear on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) inverse: f64,
    /// Red, green, blue, 0 to 255.
    pub(super) colour: [f64; 3],
}

/// The nearest opaque thing at a sample; inverse depth 0 for none.
#[derive(Clone, Copy, Debug)]
struct Opaque {
    inverse: f32,
    colour: Colour,
    dot: bool,
}

/// The two layers.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    opaque: Vec<Opaque>,
    veil: Vec<(f32, Colour, u8)>,
}

impl Canvas {
    /// For a picture of so many pixels.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let (width, height) = (width * SAMPLES, height * SAMPLES);
        // depths are kept inverse: 0 is infinitely far
        Self {
            width,
            height,
            opaque: vec![Opaque { inverse: 0.0, colour: [0; 3], dot: false }; width * height],
            veil: vec![(0.0, [0; 3], 0); width * height],
        }
    }

    /// Samples from `low` to `high`, cut to the canvas.
    #[inline]
    fn span(low: f64, high: f64, most: usize) -> std::ops::Range<usize> {
        let clip = |v: f64| v.clamp(0.0, most as f64) as usize;
        clip((low - 0.5).ceil())..clip((high + 0.5).floor())
    }

    #[inline]
    fn put(&mut self, at: usize, inverse: f32, colour: Colour, alpha: u8) {
        if alpha == u8::MAX {
            self.cover(at, Opaque { inverse, colour, dot: false });
        } else if let Some(sample) = self.veil.get_mut(at)
            && inverse > sample.0
        {
            *sample = (inverse, colour, alpha);
        }
    }

    #[inline]
    fn cover(&mut self, at: usize, thing: Opaque) {
        if let Some(sample) = self.opaque.get_mut(at)
            && thing.inverse > sample.inverse
        {
            *sample = thing;
        }
    }

    /// A round dot of `radius` samples.
    pub(super) fn disc(&mut self, centre: &Corner, radius: f64, colour: Colour) {
        let Corner { x, y, inverse, .. } = *centre;
        let dot = Opaque { inverse: inverse as f32, colour, dot: true };
        let columns = Self::span(x - radius, x + radius, self.width);
        for row in Self::span(y - radius, y + radius, self.height) {
            let dy = row as f64 + 0.5 - y;
            for column in columns.clone() {
                let dx = column as f64 + 0.5 - x;
                if dx * dx + dy * dy <= radius * radius {
                    self.cover(row * self.width + column, dot);
                }
            }
        }
    }

    /// A filled triangle with colours and inverse depths interpolated.
    pub(super) fn triangle(&mut self, [a, b, c]: [&Corner; 3], alpha: u8) {
        let double = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if double == 0.0 || !double.is_finite() {
            return;
        }
        let columns = Self::span(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), self.width);
        for row in Self::span(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), self.height) {
            let y = row as f64 + 0.5;
            for column in columns.clone() {
                let x = column as f64 + 0.5;
                let v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / double;
                let w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / double;
                let u = 1.0 - v - w;
                // neighbours both take samples on their common side: no gaps
                if u < -1e-9 || v < -1e-9 || w < -1e-9 {
                    continue;
                }
                let blend = |i: fn(&Corner) -> f64| u * i(a) + v * i(b) + w * i(c);
                let colour =
                    [blend(|k| k.colour[0]), blend(|k| k.colour[1]), blend(|k| k.colour[2])];
                let inverse = blend(|k| k.inverse) as f32;
                self.put(row * self.width + column, inverse, colour.map(|v| v as u8), alpha);
            }
        }
    }

    /// A line of `width` samples with round ends left out.
    pub(super) fn line(&mut self, a: &Corner, b: &Corner, width: f64, alpha: u8) {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let length = dx.hypot(dy);
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let (sx, sy) = (-dy / length * 0.5 * width, dx / length * 0.5 * width);
        let shift = |k: &Corner, sign: f64| Corner { x: k.x + sign * sx, y: k.y + sign * sy, ..*k };
        let corners = [shift(a, 1.0), shift(b, 1.0), shift(b, -1.0), shift(a, -1.0)];
        let [p, q, r, s] = &corners;
        self.triangle([p, q, r], alpha);
        self.triangle([p, r, s], alpha);
    }

    /// The picture over a background that depends on the row in [0, 1]; `focal` in pixels.
    pub(super) fn finish(&self, focal: f64, background: impl Fn(f64) -> Colour) -> Image {
        let (width, height) = (self.width / SAMPLES, self.height / SAMPLES);
        let light = relief(&self.dots(width, height), width, focal);
        let mut pixels = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            let behind = background((y as f64 + 0.5) / height as f64);
            for x in 0..width {
                let light = light.get(y * width + x).copied().unwrap_or(1.0);
                let mut sum = [0u32; 3];
                for i in 0..SAMPLES * SAMPLES {
                    let (column, row) = (x * SAMPLES + i % SAMPLES, y * SAMPLES + i / SAMPLES);
                    let colour = self.sample(column, row, light, behind);
                    for (s, c) in sum.iter_mut().zip(colour) {
                        *s += u32::from(c);
                    }
                }
                let n = (SAMPLES * SAMPLES) as u32;
                pixels.extend(sum.map(|s| ((s + n / 2) / n) as u8));
            }
        }
        Image { width, height, pixels }
    }

    /// Share of a rectangle (left, top, right, bottom in pixels) on which something other than dots was
    /// drawn.
    pub(super) fn busy(&self, [left, top, right, bottom]: &[f64; 4]) -> f64 {
        let scale = SAMPLES as f64;
        let (mut busy, mut count) = (0usize, 0usize);
        for row in Self::span(top * scale, bottom * scale, self.height).step_by(SAMPLES) {
            for column in Self::span(left * scale, right * scale, self.width).step_by(SAMPLES) {
                let at = row * self.width + column;
                let veiled = self.veil.get(at).is_some_and(|v| v.0 > 0.0);
                let drawn = self.opaque.get(at).is_some_and(|o| o.inverse > 0.0 && !o.dot);
                busy += usize::from(veiled || drawn);
                count += 1;
            }
        }
        busy as f64 / count.max(1) as f64
    }

    /// Inverse depth of the nearest dot in each pixel, 0 where there is none.
    fn dots(&self, width: usize, height: usize) -> Vec<f32> {
        let mut dots = vec![0.0f32; width * height];
        for (i, sample) in self.opaque.iter().enumerate().filter(|(_, s)| s.dot) {
            let (x, y) = (i % self.width / SAMPLES, i / self.width / SAMPLES);
            if let Some(dot) = dots.get_mut(y * width + x) {
                *dot = dot.max(sample.inverse);
            }
        }
        dots
    }

    /// One sample: the opaque layer with its edges darkened, and the veil over it.
    fn sample(&self, column: usize, row: usize, light: f32, behind: Colour) -> Colour {
        let at = row * self.width + column;
        let Some((opaque, veil)) = self.opaque.get(at).zip(self.veil.get(at)) else {
            return behind;
        };
        let below = if opaque.inverse > 0.0 {
            let light = if opaque.dot { light } else { 1.0 };
            let light = light * self.outline(column, row, opaque.inverse);
            opaque.colour.map(|c| (f32::from(c) * light) as u8)
        } else {
            behind
        };
        let tolerance = if opaque.dot { 1.0 - DOT_NOISE } else { 1.0 };
        if veil.0 > opaque.inverse * tolerance {
            mix(below, veil.1, f64::from(veil.2) / 255.0)
        } else {
            below
        }
    }

    /// Darkness beside what is much nearer (eye-dome lighting, Boucheny 2009): brightness in (0, 1]
    /// that sets things off from what lies behind them.
    fn outline(&self, column: usize, row: usize, inverse: f32) -> f32 {
        const REACH: usize = 3;
        let mut nearer = 0.0f32;
        for (dx, dy) in [(0, 1), (2, 1), (1, 0), (1, 2)] {
            let (x, y) = (column + dx * REACH, row + dy * REACH);
            if x < REACH || y < REACH || x >= self.width + REACH {
                continue;
            }
            let at = (y - REACH) * self.width + (x - REACH);
            if let Some(other) = self.opaque.get(at) {
                nearer += (other.inverse / inverse - 1.0 - DOT_NOISE).clamp(0.0, 0.03);
            }
        }
        1.0 / (1.0 + 20.0 * nearer)
    }
}
