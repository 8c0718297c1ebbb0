//! Floor 9: pixels on the CPU. Knows surfaces, points, lines, boxes and text; no files and no
//! pipeline.
//!
//! A [`View`] says from where one looks; a [`Picture`] collects what is drawn and
//! [`finish`](Picture::finish)es to an [`Image`] of RGB bytes. Opaque things (points, lines, solid
//! boxes) hide each other by depth; of translucent ones (surfaces with `alpha < 1`) the nearest at a
//! pixel lies over them like a veil, so that a cloud and the surface fitted to it are both seen.
//!
//! ```
//! use supersurface::{Point, Vector, picture::{Picture, View}};
//! let cloud = [Point::new(0.0, 0.0, 0.0), Point::new(0.1, 0.0, 0.0), Point::new(0.0, 0.1, 0.0)];
//! let view = View::towards(&cloud, &Vector::z(), &Point::new(0.0, -0.5, 0.5));
//! let mut picture = Picture::new(320, 200, &view);
//! picture.points(&cloud, |_| [200, 40, 40], Some(4.0));
//! picture.label(&cloud[0], "corner 0.00", [200, 40, 40]);
//! let image = picture.finish();
//! assert_eq!(image.pixels.len(), 3 * 320 * 200);
//! ```

mod canvas;
mod draw;
mod font;
mod gripper;
mod image;
mod label;
mod relief;
mod solids;
mod tessellate;
mod text;
mod view;

pub use draw::Picture;
pub use image::Image;
pub use text::text_width;
pub use view::View;

/// Red, green and blue, 0 to 255.
pub type Colour = [u8; 3];

/// Colours that are told apart easily, for the objects of a scene in turn.
pub const PALETTE: [Colour; 8] = [
    [31, 119, 200],
    [240, 128, 30],
    [44, 160, 80],
    [205, 60, 75],
    [140, 95, 195],
    [20, 165, 175],
    [214, 95, 165],
    [150, 130, 40],
];

/// `a` and `b` mixed, with the share `t` in [0, 1] of `b`.
pub fn mix(a: Colour, b: Colour, t: f64) -> Colour {
    let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
    let [ar, ag, ab] = a.map(f64::from);
    let [br, bg, bb] = b.map(f64::from);
    [ar + (br - ar) * t, ag + (bg - ag) * t, ab + (bb - ab) * t].map(|v| v.round() as u8)
}
