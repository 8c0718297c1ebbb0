//! What a cloud proves empty around one of its objects.
//!
//! The sensor saw each point along a free line of sight, so every point that is not on the object says that
//! the object does not cross the segment from the viewpoint to it. A direction without a reading says nothing by
//! itself; but where such a gap lies between the object's outline and something that was seen farther out (the
//! shadow of a projector, an edge), the object ends at its outline. Only directions next to the object
//! matter; those within two cells of its outline are left out, as depth is not to be trusted there.

use crate::cloud::PointCloud;
use crate::numeric::lanes::{Job, WIDTH, dispatch};
use crate::{Point, Vector};

/// What stands for the number of a reading in cells that have none.
const UNREAD: u32 = u32::MAX;
/// Marks of cells while steps are counted: of the frame around them, outside, and blocked.
const FRAME: u16 = u16::MAX - 2;
const OUTSIDE: u16 = u16::MAX - 1;
const BLOCKED: u16 = u16::MAX;
/// Most free points that are returned.
const MOST: usize = 140;
/// Cells on the longer side of the object's picture.
const CELLS: f64 = 40.0;
/// Cells around the outline in which nothing is trusted.
const MARGIN: isize = 2;
/// Cells around the object's picture that are searched; no whole number, so that its outermost points are not on the edge
/// between two cells, where rounding would choose.
const BORDER: f64 = 14.25;

/// Points of the cloud that were seen beside the object or behind it, for [`super::View::free`], more of them
/// the nearer to its outline; none when the viewpoint is not known or lies within the object.
pub fn free_points(cloud: &PointCloud, object: &[u32]) -> Vec<Point> {
    free_points_of(cloud, object, usize::MAX)
}

/// The same from no more than so many readings on each side of the picture, for a fit that only asks a question.
pub(crate) fn free_points_of(cloud: &PointCloud, object: &[u32], most: usize) -> Vec<Point> {
    let Some((picture, own)) = Picture::of(cloud, object) else { return Vec::new() };
    let blocked = picture.dilated(&picture.mask(&own));
    let mut read = vec![UNREAD; blocked.len()];
    let (width, [u0, u1, v0, v1], step) = match (cloud.grid, bounds(cloud, object)) {
        (Some([width, _]), Some([u0, u1, v0, v1])) => {
            (width, [u0, u1, v0, v1], ((u1 - u0).max(v1 - v0) / most).max(1))
        }
        _ => (cloud.points.len(), [0, cloud.points.len().saturating_sub(1), 0, 0], 1),
    };
    for v in (v0..=v1).step_by(step) {
        let first = v * width + u0;
        let row = cloud.points.get(first..=v * width + u1).unwrap_or_default();
        let mut look = |k: usize, cell: usize| {
            if !blocked[cell] && read[cell] == UNREAD {
                read[cell] = (first + k) as u32;
            }
        };
        dispatch(Cells { picture: &picture, row, step, look: &mut look });
    }
    let steps = picture.steps_outside(&blocked);
    let [nearest, farthest] = depths(&own);
    let reading = |cell: usize| cloud.points.get(read[cell] as usize).copied();
    // by their steps, gaps after readings: both as one number, which is sorted faster
    let all = read.len();
    let key = |cell: usize, k: usize| u64::from(steps[cell]) << 32 | k as u64;
    let seen = (0..all).filter(|c| read[*c] != UNREAD).map(|c| key(c, c));
    let mut found: Vec<u64> = seen.collect();
    found.extend(picture.gaps(&steps, reading, nearest).map(|c| key(c, all + c)));
    found.sort_unstable();
    let point = |key: u64| {
        let k = key as u32 as usize;
        if k < all { reading(k) } else { Some(picture.point(k - all, 3.0 * farthest)) }
    };
    if found.len() <= MOST {
        return found.into_iter().filter_map(point).collect();
    }
    // squares: most of what a body could wrongly grow into lies next to what is seen of it
    let at = |i: usize| i * i * found.len() / (MOST * MOST);
    (0..MOST).filter_map(|i| point(found[at(i)])).collect()
}

/// Finds the cells of every so-many-th point of a row, by its place in it.
struct Cells<'a, F> {
    picture: &'a Picture,
    row: &'a [Point],
    step: usize,
    look: &'a mut F,
}

impl<F: FnMut(usize, usize)> Job for Cells<'_, F> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { picture, row, step, look } = self;
        let Picture { viewpoint: eye, forward, right, down, corner, fineness, .. } = picture;
        let size = [picture.width as f64, picture.height as f64];
        for (k, block) in row.chunks(WIDTH * step).enumerate() {
            // what a short block lacks is in no cell
            let mut at = [[f64::NAN; WIDTH]; 3];
            for (i, p) in block.iter().step_by(step).enumerate() {
                (at[0][i], at[1][i], at[2][i]) = (p.x, p.y, p.z);
            }
            let mut cells = [-1.0; WIDTH];
            for i in 0..WIDTH {
                let [x, y, z] = [at[0][i] - eye.x, at[1][i] - eye.y, at[2][i] - eye.z];
                let depth = x * forward.x + y * forward.y + z * forward.z;
                let inverse = 1.0 / depth;
                let u = (x * right.x + y * right.y + z * right.z) * inverse;
                let v = (x * down.x + y * down.y + z * down.z) * inverse;
                let [u, v] = [(u - corner[0]) * fineness, (v - corner[1]) * fineness];
                let inside =
                    (depth > 0.0) & (u >= 0.0) & (v >= 0.0) & (u < size[0]) & (v < size[1]);
                cells[i] = if inside { v.floor() * size[0] + u.floor() } else { -1.0 };
            }
            for (i, cell) in cells.into_iter().enumerate() {
                if cell >= 0.0 {
                    look((k * WIDTH + i) * step, cell as usize);
                }
            }
        }
    }
}

/// Columns and rows [u0, u1, v0, v1] of an organised cloud around the object, with two fifths of its size to each
/// side, which is a little more than the border of its picture.
fn bounds(cloud: &PointCloud, object: &[u32]) -> Option<[usize; 4]> {
    let [width, height] = cloud.grid?;
    let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
    // of 32 bits, as wider divisions take their time
    let columns = u32::try_from(width).ok().filter(|columns| *columns > 0)?;
    for i in object {
        let at = [i % columns, i / columns];
        for k in 0..2 {
            low[k] = low[k].min(at[k]);
            high[k] = high[k].max(at[k]);
        }
    }
    let [low, high] = [low, high].map(|ends| ends.map(|end| end as usize));
    let side = (high[0].checked_sub(low[0])?).max(high[1].checked_sub(low[1])?) * 2 / 5 + 4;
    let top = |v: usize, size: usize| (v + side).min(size.saturating_sub(1));
    Some([
        low[0].saturating_sub(side),
        top(high[0], width),
        low[1].saturating_sub(side),
        top(high[1], height),
    ])
}

/// Cells outside next to the object, by their steps.
fn ring(steps: &[u16]) -> impl Iterator<Item = usize> {
    (0..steps.len()).filter(|c| (1..=MARGIN as u16).contains(&steps[*c]))
}

/// Points far behind the outline of an object that nothing hides, for [`super::View::free`]: the body does
/// not reach beyond what is seen of it. Cells that the object's own points enclose are left out: a hole in
/// the readings is no hole in the object.
pub fn outline_points(cloud: &PointCloud, object: &[u32]) -> Vec<Point> {
    let Some((picture, own)) = Picture::of(cloud, object) else { return Vec::new() };
    let [_, farthest] = depths(&own);
    let blocked = picture.dilated(&picture.mask(&own));
    let steps = picture.steps_outside(&blocked);
    let ring: Vec<usize> = ring(&steps).collect();
    let kept = ring.len().min(MOST);
    (0..kept).map(|i| picture.point(ring[i * ring.len() / kept], 3.0 * farthest)).collect()
}

/// The same for points of one object alone.
pub(super) fn outline(points: &[Vector], viewpoint: &Vector) -> Vec<Vector> {
    let points: Vec<Point> = points.iter().map(|p| Point::from(*p)).collect();
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let viewpoint = Some(Point::from(*viewpoint));
    let cloud = PointCloud { points, viewpoint, ..PointCloud::default() };
    outline_points(&cloud, &all).into_iter().map(|p| p.coords).collect()
}

/// The object as the sensor sees it: a pinhole picture towards its middle.
pub(super) struct Picture {
    viewpoint: Point,
    forward: Vector,
    right: Vector,
    down: Vector,
    corner: [f64; 2],
    cell: f64,
    /// Cells a unit of length at depth 1.
    fineness: f64,
    pub(super) width: usize,
    pub(super) height: usize,
}

/// Least and largest depth of places in a picture.
fn depths(own: &[[f64; 3]]) -> [f64; 2] {
    own.iter().fold([f64::INFINITY, 0.0], |[least, most], p| [p[2].min(least), p[2].max(most)])
}

impl Picture {
    /// The picture, and where in it the object's points are: `x/z`, `y/z` and the depth `z`.
    pub(super) fn of(cloud: &PointCloud, object: &[u32]) -> Option<(Self, Vec<[f64; 3]>)> {
        let viewpoint = cloud.viewpoint?;
        let rays = || {
            let points = object.iter().filter_map(|i| cloud.points.get(*i as usize));
            points.map(|p| p - viewpoint).filter(|r| r.iter().all(|v| v.is_finite()))
        };
        let forward = rays().sum::<Vector>().try_normalize(0.0)?;
        let helper = if forward.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
        let right = (helper - forward * forward.dot(&helper)).normalize();
        let down = forward.cross(&right);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut own = Vec::with_capacity(object.len());
        for r in rays() {
            let z = r.dot(&forward);
            if z <= 0.0 {
                return None;
            }
            let inverse = 1.0 / z;
            let at = [r.dot(&right) * inverse, r.dot(&down) * inverse];
            for k in 0..2 {
                low[k] = low[k].min(at[k]);
                high[k] = high[k].max(at[k]);
            }
            own.push([at[0], at[1], z]);
        }
        let cell = (high[0] - low[0]).max(high[1] - low[1]) / CELLS;
        if !(cell > 0.0 && cell.is_finite()) {
            return None;
        }
        let side = |k: usize| ((high[k] - low[k]) / cell + 2.0 * BORDER) as usize + 1;
        let corner = [low[0] - BORDER * cell, low[1] - BORDER * cell];
        let (width, height) = (side(0), side(1));
        Some((
            Self {
                viewpoint,
                forward,
                right,
                down,
                corner,
                cell,
                fineness: 1.0 / cell,
                width,
                height,
            },
            own,
        ))
    }

    #[inline]
    pub(super) fn cell(&self, p: &Point) -> Option<usize> {
        let r = p - self.viewpoint;
        let z = r.dot(&self.forward);
        if z.is_nan() || z <= 0.0 {
            return None;
        }
        let inverse = 1.0 / z;
        self.cell_at([r.dot(&self.right) * inverse, r.dot(&self.down) * inverse])
    }

    #[inline]
    fn cell_at(&self, at: [f64; 2]) -> Option<usize> {
        let [u, v] = [0, 1].map(|k| (at[k] - self.corner[k]) * self.fineness);
        let inside = u >= 0.0 && v >= 0.0 && u < self.width as f64 && v < self.height as f64;
        inside.then(|| v as usize * self.width + u as usize)
    }

    /// The cells that hold points of the object.
    fn mask(&self, own: &[[f64; 3]]) -> Vec<bool> {
        let mut mask = vec![false; self.width * self.height];
        for cell in own.iter().filter_map(|[u, v, _]| self.cell_at([*u, *v])) {
            mask[cell] = true;
        }
        mask
    }

    /// Cells next to the outline that have no reading, where going on outwards one comes to a reading behind
    /// `nearest`: there the picture is not cut off, and the object is not hidden by something nearer.
    fn gaps<'a>(
        &'a self,
        steps: &'a [u16],
        reading: impl Fn(usize) -> Option<Point> + Copy + 'a,
        nearest: f64,
    ) -> impl Iterator<Item = usize> + 'a {
        let size = [self.width as f64, self.height as f64];
        let is_gap = move |c: &usize| {
            let from = [(c % self.width) as f64 + 0.5, (c / self.width) as f64 + 0.5];
            let away = [from[0] - 0.5 * size[0], from[1] - 0.5 * size[1]];
            let length = away[0].hypot(away[1]).max(1e-9);
            let met = (1..BORDER as usize).find_map(|k| {
                let [u, v] = [0, 1].map(|i| from[i] + away[i] / length * k as f64);
                let inside = u >= 0.0 && v >= 0.0 && u < size[0] && v < size[1];
                reading(inside.then(|| v as usize * self.width + u as usize)?)
            });
            met.is_some_and(|p| (p - self.viewpoint).dot(&self.forward) > nearest)
        };
        ring(steps).filter(move |c| reading(*c).is_none()).filter(is_gap)
    }

    /// The point at `depth` along the viewing direction in the middle of a cell.
    fn point(&self, cell: usize, depth: f64) -> Point {
        let u = (cell % self.width) as f64 + 0.5;
        let v = (cell / self.width) as f64 + 0.5;
        let x = self.corner[0] + u * self.cell;
        let y = self.corner[1] + v * self.cell;
        self.viewpoint + (self.forward + self.right * x + self.down * y) * depth
    }

    /// How many cells each cell is away from the blocked ones on ways outside; 0 for these and for cells that
    /// they enclose.
    fn steps_outside(&self, blocked: &[bool]) -> Vec<u16> {
        // with a frame of one more cell all around, so that each cell has four neighbours
        let wide = self.width + 2;
        let beside = |c: usize| [c - 1, c + 1, c - wide, c + wide];
        let mut steps = vec![FRAME; wide * (self.height + 2)];
        let mut open = Vec::new();
        for (v, row) in blocked.chunks(self.width).enumerate() {
            for (u, blocked) in row.iter().enumerate() {
                let cell = (v + 1) * wide + u + 1;
                steps[cell] = if *blocked { BLOCKED } else { 0 };
                if u == 0 || u + 1 == self.width || v == 0 || v + 1 == self.height {
                    open.push(cell);
                }
            }
        }
        while let Some(cell) = open.pop() {
            if steps[cell] == 0 {
                steps[cell] = OUTSIDE;
                open.extend(beside(cell).into_iter().filter(|c| steps[*c] == 0));
            }
        }
        let mut edge: Vec<usize> = (0..steps.len()).filter(|c| steps[*c] == BLOCKED).collect();
        for step in 1..FRAME {
            let mut next = Vec::new();
            for cell in edge.into_iter().flat_map(beside) {
                if steps[cell] == OUTSIDE {
                    steps[cell] = step;
                    next.push(cell);
                }
            }
            if next.is_empty() {
                break;
            }
            edge = next;
        }
        let rows = steps.chunks(wide).skip(1).take(self.height);
        let cells = rows.flat_map(|row| &row[1..=self.width]);
        cells.map(|step| if *step < FRAME { *step } else { 0 }).collect()
    }

    /// The mask with `MARGIN` more cells on each side.
    fn dilated(&self, mask: &[bool]) -> Vec<bool> {
        let mut out = vec![false; mask.len()];
        let (w, h) = (self.width as isize, self.height as isize);
        for (i, _) in mask.iter().enumerate().filter(|(_, set)| **set) {
            let (u, v) = (i as isize % w, i as isize / w);
            for y in (v - MARGIN).max(0)..=(v + MARGIN).min(h - 1) {
                for x in (u - MARGIN).max(0)..=(u + MARGIN).min(w - 1) {
                    out[(y * w + x) as usize] = true;
                }
            }
        }
        out
    }
}
