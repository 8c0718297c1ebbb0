//! What can be drawn: points, lines, boxes, surfaces, a grid on the table, labels and text.

use super::canvas::{Canvas, Corner, SAMPLES};
use super::image::Image;
use super::label::{Label, set};
use super::view::{View, finite};
use super::{Colour, mix, text};
use crate::shape::Plane;
use crate::{Point, Pose, Vector};

/// Largest width or height of a picture, in pixels.
const MAX_SIDE: usize = 4096;
/// Nearest depth that is drawn, as a share of the view's distance.
const NEAR: f64 = 0.02;

/// A picture in the making. Points, directions and sizes are in the frame of the view, in metres;
/// widths and text in pixels. What is not finite or behind the viewer is left out.
#[derive(Clone, Debug)]
pub struct Picture {
    canvas: Canvas,
    pub(super) view: View,
    /// Pixels a unit of x/z, times the samples of a pixel.
    focal: f64,
    labels: Vec<Label>,
    texts: Vec<([f64; 2], String, Colour, f64)>,
}

/// A point in the viewer's frame, in units of the view's distance, with a colour.
type Placed = (Point, [f64; 3]);

impl Picture {
    /// An empty picture of `width` x `height` pixels (1 to 4096; others are brought into range).
    pub fn new(width: usize, height: usize, view: &View) -> Self {
        let (width, height) = (width.clamp(1, MAX_SIDE), height.clamp(1, MAX_SIDE));
        let canvas = Canvas::new(width, height);
        let [x, y] = view.reach;
        let focal = (0.5 * canvas.width as f64 / x).min(0.5 * canvas.height as f64 / y);
        Self { canvas, view: view.clone(), focal, labels: Vec::new(), texts: Vec::new() }
    }

    /// Points in colours by their index, as dots of `size` pixels; without a size one that closes the
    /// gaps between them.
    pub fn points(
        &mut self,
        points: &[Point],
        colour: impl Fn(usize) -> Colour,
        size: Option<f64>,
    ) -> &mut Self {
        let size = size.unwrap_or_else(|| self.spacing(points));
        let radius =
            0.5 * if size.is_finite() { size.clamp(0.5, 50.0) } else { 1.0 } * SAMPLES as f64;
        for (i, p) in points.iter().enumerate() {
            if let Some(corner) = self.corner(p) {
                self.canvas.disc(&corner, radius, colour(i));
            }
        }
        self
    }

    /// A straight line of `width` pixels.
    pub fn line(&mut self, a: &Point, b: &Point, colour: Colour, width: f64) -> &mut Self {
        self.stroke([a, b], colour.map(f64::from), width, u8::MAX, 1.0);
        self
    }

    /// An arrow from `a` to `b` with a head at `b`.
    pub fn arrow(&mut self, a: &Point, b: &Point, colour: Colour, width: f64) -> &mut Self {
        self.line(a, b, colour, width);
        if let (Some(tail), Some(tip)) = (self.corner(a), self.corner(b)) {
            let (dx, dy) = (tip.x - tail.x, tip.y - tail.y);
            let length = dx.hypot(dy);
            let head = 4.0 * width * SAMPLES as f64;
            if length > 0.0 {
                let (ux, uy) = (dx / length * head, dy / length * head);
                let colour = colour.map(f64::from);
                let shift = |along: f64, aside: f64| Corner {
                    x: tip.x + along * ux - aside * uy,
                    y: tip.y + along * uy + aside * ux,
                    inverse: tip.inverse * 1.01,
                    colour,
                };
                let [p, q, r] = [shift(0.0, 0.0), shift(-1.2, 0.55), shift(-1.2, -0.55)];
                self.canvas.triangle([&p, &q, &r], u8::MAX);
            }
        }
        self
    }

    /// A box along the axes of `pose` with its edges, `alpha` in [0, 1].
    pub fn boxed(
        &mut self,
        pose: &Pose,
        center: &Point,
        size: &Vector,
        colour: Colour,
        alpha: f64,
    ) -> &mut Self {
        let corner = |x: f64, y: f64, z: f64| {
            pose * (center + size.component_mul(&Vector::new(x, y, z)) * 0.5)
        };
        let alpha = level(alpha);
        let edge = mix(colour, [0; 3], 0.35).map(f64::from);
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let turn = |u: f64, v: f64| {
                    let mut c = [0.0; 3];
                    for (i, value) in [side, u, v].into_iter().enumerate() {
                        c[(axis + i) % 3] = value;
                    }
                    c
                };
                let [x, y, z] = turn(0.0, 0.0);
                let shade = self.shade(colour, &(pose.rotation * Vector::new(x, y, z)), 0.0);
                let face = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| {
                    let [x, y, z] = turn(u, v);
                    corner(x, y, z)
                });
                let [p, q, r, s] = &face;
                for triangle in [[p, q, r], [p, r, s]] {
                    self.triangle(triangle.map(|k| (*k, shade)), alpha);
                }
                for [a, b] in [[p, q], [q, r], [r, s], [s, p]] {
                    self.stroke([a, b], edge, 1.0, alpha, 1.0005);
                }
            }
        }
        self
    }

    /// Lines on a plane at round distances, under and around the points' feet.
    pub fn grid(&mut self, plane: &Plane, around: &[Point], colour: Colour) -> &mut Self {
        let [u, v] = plane.tangents();
        let origin = plane.project(&Point::origin());
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in around.iter().filter(|p| finite(p)) {
            for (axis, d) in [u, v].iter().enumerate() {
                let c = d.dot(&(p - origin));
                low[axis] = low[axis].min(c);
                high[axis] = high[axis].max(c);
            }
        }
        let width = (high[0] - low[0]).max(high[1] - low[1]);
        if !(width > 0.0 && width.is_finite()) {
            return self;
        }
        let step = round_step(width / 8.0);
        let [from, to] = [[-0.5; 2], [0.5; 2]].map(|shift| {
            let bounds = if shift[0] < 0.0 { low } else { high };
            [0, 1].map(|i| (bounds[i] / step + shift[i]).round() as i64)
        });
        let at = |i: i64, j: i64| {
            origin + u.into_inner() * (i as f64 * step) + v.into_inner() * (j as f64 * step)
        };
        let ink = colour.map(f64::from);
        for i in from[0]..=to[0] {
            self.stroke([&at(i, from[1]), &at(i, to[1])], ink, 1.0, 110, 1.0);
        }
        for j in from[1]..=to[1] {
            self.stroke([&at(from[0], j), &at(to[0], j)], ink, 1.0, 110, 1.0);
        }
        self
    }

    /// Words that point at a place in space. Labels move apart so that none covers another.
    pub fn label(&mut self, at: &Point, words: &str, colour: Colour) -> &mut Self {
        if let Some(corner) = self.corner(at) {
            let anchor = [corner.x, corner.y].map(|c| c / SAMPLES as f64);
            self.labels.push(Label { anchor, words: words.to_owned(), colour });
        }
        self
    }

    /// A line of text with the top left of its capitals at (x, y), capitals `size` pixels high.
    pub fn text(&mut self, x: f64, y: f64, words: &str, colour: Colour, size: f64) -> &mut Self {
        self.texts.push(([x, y], words.to_owned(), colour, size));
        self
    }

    /// Where a point appears, in pixels; `None` when it is not finite or behind the viewer.
    pub fn project(&self, p: &Point) -> Option<[f64; 2]> {
        self.corner(p).map(|c| [c.x, c.y].map(|v| v / SAMPLES as f64))
    }

    /// The pixels of all that was drawn, over a light background.
    pub fn finish(&self) -> Image {
        let focal = self.focal / SAMPLES as f64;
        let mut image = self.canvas.finish(focal, |t| mix([252, 253, 254], [222, 227, 233], t));
        let texts = self.texts.iter().map(|([x, y], words, _, size)| {
            [*x, *y, x + text::text_width(words, *size), y + 1.3 * size]
        });
        set(&mut image, &self.labels, texts.collect(), |plate| self.canvas.busy(plate));
        for (at, words, colour, size) in &self.texts {
            text::write(&mut image, *at, words, *colour, *size);
        }
        image
    }

    /// The viewer's frame in units of its distance.
    fn place(&self, p: &Point) -> Point {
        self.view.pose.inverse_transform_point(p) / self.view.distance
    }

    fn on_canvas(&self, (p, colour): &Placed) -> Corner {
        let (middle_x, middle_y) =
            (0.5 * self.canvas.width as f64, 0.5 * self.canvas.height as f64);
        let x = middle_x + self.focal * p.x / p.z;
        Corner { x, y: middle_y + self.focal * p.y / p.z, inverse: 1.0 / p.z, colour: *colour }
    }

    fn corner(&self, p: &Point) -> Option<Corner> {
        let seen = self.place(p);
        (finite(&seen) && seen.z > NEAR).then(|| self.on_canvas(&(seen, [0.0; 3])))
    }

    /// A triangle, cut at the near plane.
    pub(super) fn triangle(&mut self, corners: [Placed; 3], alpha: u8) {
        let corners = corners.map(|(p, colour)| (self.place(&p), colour));
        if !corners.iter().all(|(p, _)| finite(p)) {
            return;
        }
        if corners.iter().all(|(p, _)| p.z > NEAR) {
            let [a, b, c] = corners.map(|k| self.on_canvas(&k));
            return self.canvas.triangle([&a, &b, &c], alpha);
        }
        let mut kept: Vec<Corner> = Vec::new();
        for (i, a) in corners.iter().enumerate() {
            let b = &corners[(i + 1) % 3];
            if a.0.z > NEAR {
                kept.push(self.on_canvas(a));
            }
            if (a.0.z > NEAR) != (b.0.z > NEAR) {
                kept.push(self.on_canvas(&cut(a, b)));
            }
        }
        if let [a, rest @ ..] = &kept[..] {
            for pair in rest.windows(2) {
                if let [b, c] = pair {
                    self.canvas.triangle([a, b, c], alpha);
                }
            }
        }
    }

    /// A line cut at the near plane; `lift` above 1 brings it nearer than what it lies on.
    pub(super) fn stroke(
        &mut self,
        ends: [&Point; 2],
        colour: [f64; 3],
        width: f64,
        alpha: u8,
        lift: f64,
    ) {
        let [mut a, mut b] = ends.map(|p| (self.place(p), colour));
        if !(finite(&a.0) && finite(&b.0)) || a.0.z <= NEAR && b.0.z <= NEAR {
            return;
        }
        if a.0.z <= NEAR {
            a = cut(&a, &b);
        } else if b.0.z <= NEAR {
            b = cut(&a, &b);
        }
        let [a, b] = [a, b].map(|k| {
            let corner = self.on_canvas(&k);
            Corner { inverse: corner.inverse * lift, ..corner }
        });
        let width = if width.is_finite() { width.clamp(0.5, 100.0) } else { 1.0 };
        self.canvas.line(&a, &b, width * SAMPLES as f64, alpha);
    }

    /// A colour under the picture's light, with a highlight of `gloss`.
    pub(super) fn shade(&self, colour: Colour, normal: &Vector, gloss: f64) -> [f64; 3] {
        let n = self.view.pose.rotation.inverse_transform_vector(normal);
        let n = n.try_normalize(1e-12).unwrap_or(-Vector::z());
        // half way between the light and the viewer; the 16th power by squaring
        let half = (light() - Vector::z()).normalize();
        let shine = (0..4).fold(n.dot(&half).max(0.0), |v, _| v * v);
        let diffuse = diffuse(&n);
        colour.map(|c| (f64::from(c) * diffuse + 255.0 * gloss * shine).clamp(0.0, 255.0))
    }

    /// A size of dots in pixels that about closes the gaps of a cloud, from how many of its points
    /// fall into the cells that they occupy.
    fn spacing(&self, points: &[Point]) -> f64 {
        const CELL: f64 = 12.0 * SAMPLES as f64;
        let columns = (self.canvas.width as f64 / CELL).ceil() as usize + 1;
        let rows = (self.canvas.height as f64 / CELL).ceil() as usize + 1;
        let mut cells = vec![false; columns * rows];
        let mut count = 0usize;
        for corner in points.iter().filter_map(|p| self.corner(p)) {
            let (x, y) = (corner.x / CELL, corner.y / CELL);
            if x >= 0.0 && y >= 0.0 && x < columns as f64 && y < rows as f64 {
                count += 1;
                if let Some(cell) = cells.get_mut(y as usize * columns + x as usize) {
                    *cell = true;
                }
            }
        }
        let occupied = cells.iter().filter(|c| **c).count() as f64;
        let spacing = CELL * (occupied / count.max(1) as f64).sqrt() / SAMPLES as f64;
        (1.7 * spacing).clamp(1.5, 6.0)
    }
}

/// Where the light comes from in the viewer's frame: the upper left behind the viewer.
fn light() -> Vector {
    Vector::new(-0.42, -0.58, -0.70).normalize()
}

/// Brightness of a surface with a unit normal in the viewer's frame.
pub(super) fn diffuse(normal: &Vector) -> f64 {
    0.54 + 0.50 * normal.dot(&light()).max(0.0) + 0.10 * (-normal.z).max(0.0)
}

/// The point of a segment on the near plane.
fn cut(a: &Placed, b: &Placed) -> Placed {
    let t = (NEAR - a.0.z) / (b.0.z - a.0.z);
    let mut point = a.0 + (b.0 - a.0) * t;
    point.z = NEAR;
    let mut colour = a.1;
    for (c, end) in colour.iter_mut().zip(b.1) {
        *c += (end - *c) * t;
    }
    (point, colour)
}

/// The next of 1, 2, 5 times a power of ten.
fn round_step(width: f64) -> f64 {
    let unit = 10f64.powi(width.log10().floor() as i32);
    [1.0, 2.0, 5.0].iter().map(|m| m * unit).find(|s| *s >= width).unwrap_or(10.0 * unit)
}

/// An opacity as a level, 255 for opaque.
pub(super) fn level(alpha: f64) -> u8 {
    (alpha.clamp(0.0, 1.0) * 255.0).round() as u8
}
