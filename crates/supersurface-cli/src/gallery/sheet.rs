//! A figure is a sheet of small pictures in rows, each with a line of text under it.

use supersurface::mesh::Mesh;
use supersurface::picture::{Colour, Image, Picture, View};
use supersurface::shape::Implicit;
use supersurface::surface::Solid;
use supersurface::{Point, Pose, Vector};

pub(super) const WIDTH: usize = 300;
pub(super) const HEIGHT: usize = 240;
/// Towards the viewer.
pub(super) const VIEW: Vector = Vector::new(0.9, -1.5, 1.1);
const CAPTION: usize = 26;
const TITLE: usize = 44;
pub(super) const INK: Colour = [28, 30, 34];
pub(super) const BLUE: Colour = [70, 130, 190];
pub(super) const ORANGE: Colour = [235, 130, 45];
pub(super) const GREEN: Colour = [60, 150, 90];
pub(super) const RED: Colour = [200, 50, 60];

/// Small pictures in the making.
pub(super) struct Sheet {
    title: String,
    columns: usize,
    cells: Vec<(String, Image)>,
}

impl Sheet {
    pub(super) fn new(title: &str, columns: usize) -> Self {
        Self { title: title.to_owned(), columns, cells: Vec::new() }
    }

    /// The next picture: what `draw` draws into a view that the points fill.
    pub(super) fn cell(
        &mut self,
        caption: impl Into<String>,
        around: &[Point],
        draw: impl FnOnce(&mut Picture),
    ) {
        self.seen_from(VIEW, caption, around, draw);
    }

    /// The same, seen from another side.
    pub(super) fn seen_from(
        &mut self,
        side: Vector,
        caption: impl Into<String>,
        around: &[Point],
        draw: impl FnOnce(&mut Picture),
    ) {
        let middle = around.iter().map(|p| p.coords).sum::<Vector>() / around.len().max(1) as f64;
        let reach = around.iter().map(|p| (p.coords - middle).norm()).fold(0.0, f64::max);
        let from = Point::from(middle + side.normalize() * (4.0 * reach));
        let mut picture = Picture::new(WIDTH, HEIGHT, &View::towards(around, &Vector::z(), &from));
        draw(&mut picture);
        self.cells.push((caption.into(), picture.finish()));
    }

    /// A solid alone.
    pub(super) fn solid(&mut self, caption: impl Into<String>, solid: &Solid, colour: Colour) {
        let around = box_corners(solid);
        self.cell(caption, &around, |picture| {
            picture.solid(solid, &Pose::identity(), colour, 1.0);
        });
    }

    /// A mesh alone.
    pub(super) fn mesh(&mut self, caption: impl Into<String>, mesh: &Mesh, colour: Colour) {
        let first = mesh.vertices().first().copied().unwrap_or_default();
        let spans = |[low, high]: [Point; 2], v: &Point| [low.inf(v), high.sup(v)];
        let reach = mesh.vertices().iter().fold([first; 2], spans);
        self.cell(caption, &corners(reach), |picture| {
            picture.mesh(mesh, colour, 1.0);
        });
    }

    /// The whole sheet.
    pub(super) fn finish(self) -> Image {
        let rows = self.cells.len().div_ceil(self.columns);
        let (across, down) = (WIDTH + 8, HEIGHT + CAPTION + 8);
        let mut image = Image::filled(across * self.columns + 8, TITLE + down * rows, [255; 3]);
        image.text(12.0, 14.0, &self.title, INK, 15.0);
        for (i, (caption, cell)) in self.cells.iter().enumerate() {
            let (x, y) = (8 + across * (i % self.columns), TITLE + down * (i / self.columns));
            image.paste(cell, x, y);
            image.text(x as f64 + 6.0, (y + HEIGHT + 7) as f64, caption, INK, 11.0);
        }
        image
    }
}

/// Corners of the box around a solid.
pub(super) fn box_corners(solid: &impl Implicit) -> Vec<Point> {
    corners(solid.bounds())
}

fn corners([low, high]: [Point; 2]) -> Vec<Point> {
    let corner = |k: usize| {
        Point::from(Vector::from_fn(|i, _| if k >> i & 1 == 0 { low[i] } else { high[i] }))
    };
    (0..8).map(corner).collect()
}
