//! The hidden side of a single view, guessed by symmetry: the seen points mirrored at a plane.
//!
//! Most things have a plane of symmetry that stands on the table and faces the sensor (Bohg, Johnson-Roberson, León,
//! Felip, Gratal, Bergström, Kragic and Morales, "Mind the gap", ICRA 2011). A mirrored point contradicts the view where
//! it lies beside the object's outline or before a seen point; else it agrees with a seen point or is hidden behind one.
//! For each direction of the normal within [`CONE`] of the line of sight, upright where a support is known, the plane is
//! moved as near to the sensor as at most [`LIES`] of the mirrored points contradict; of these planes the one is taken
//! whose mirror image hides at the least depth, over the cosine of its slant: the simplest body that the view allows.
//!
//! It is a guess, never a measurement: nothing says that the object is symmetric, and an oblique view of a box allows
//! planes that are none of its own. So a fit only begins from it.

use super::View;
use super::centred::{Centred, on_grid, spread};
use super::free_space::Picture;
use super::prepare::Normalised;
use super::start::{Frame, quantile, whole_frames};
use crate::cloud::PointCloud;
use crate::shape::Plane;
use crate::{Direction, Point, Vector};

/// Fewer points than this have no mirror image worth the name.
const LEAST_POINTS: usize = 12;
/// Largest angle between the line of sight and the plane's normal, in radians: beyond, the image would be another seen
/// side.
const CONE: f64 = 0.96;
/// Directions of the normal that are tried; half as many where a support leaves one angle.
const DIRECTIONS: usize = 40;
/// Halvings of the interval in which the plane lies.
const HALVINGS: usize = 5;
/// Places along the normal among which the first is looked for.
const STEPS: usize = 12;
/// Points that are mirrored to compare planes.
const TRIED: usize = 160;
/// Share of mirrored points that may contradict the view: noise at the outline.
const LIES: f64 = 0.02;
/// Depth within which a mirrored point agrees with a seen one, as a share of the object's size.
const TOLERANCE: f64 = 0.015;
/// Points that make frames.
const FRAMED: usize = 2000;
/// Cells about a mirrored point in which it is looked for seen ones.
const ABOUT: isize = 2;

/// By what the unseen side of a single view is guessed, for further bodies to begin from. The points that were seen alone
/// decide among all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Completion {
    /// By nothing: hidden depths of a few sizes.
    #[default]
    Nothing,
    /// By the mirror image of the seen points too, see [`mirrored`].
    Mirror,
}

/// A plane of symmetry and what it makes of the seen points.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Mirror {
    /// The plane, in the frame of the points; its normal points away from the sensor.
    pub plane: Plane,
    /// The mirrored points that are hidden behind seen ones, in metres.
    pub points: Vec<Point>,
    /// Share of the mirrored points that contradict nothing that was seen, in [0, 1].
    pub score: f64,
}

/// The most modest plane of symmetry that the view allows; `None` without a viewpoint outside the object, or for points
/// that determine no surface.
///
/// ```
/// use supersurface::{Point, fit::{View, mirrored}};
/// // the near half of a ball of radius 5 cm, a metre away
/// let mut seen = Vec::new();
/// for i in 0..40 {
///     for j in 0..40 {
///         let [x, y] = [i, j].map(|k| 0.05 * (f64::from(k) - 19.5) / 20.0);
///         let square = 0.0025 - x * x - y * y;
///         if square > 0.0 {
///             seen.push(Point::new(x, y, 1.0 - square.sqrt()));
///         }
///     }
/// }
/// let view = View { viewpoint: Some(Point::origin()), ..View::all_around(&seen) };
/// let mirror = mirrored(&view).unwrap();
/// // it is as near to the sensor as the view allows: before the ball's middle rather than behind it
/// let height = mirror.plane.height(&Point::new(0.0, 0.0, 1.0));
/// assert!((0.0..0.0125).contains(&height));
/// ```
pub fn mirrored(view: &View<'_>) -> Option<Mirror> {
    let cloud = Centred::new(&view.counted(), LEAST_POINTS).ok()?;
    let placement = cloud.placement;
    let viewpoint = placement.inward(&view.viewpoint?);
    let seen = Seen::of(cloud.points, viewpoint)?;
    let upright = view.support.map(|plane| placement.turned_inward(&plane.normal()));
    let image = |plane: &Guess| seen.image(plane, &seen.some);
    let guesses = normals(&seen, upright).filter_map(|normal| seen.nearest(normal));
    // a plane at a slant shows less that was hidden
    let cost = |g: &Guess| image(g).depth / -g.normal.dot(&viewpoint);
    let best = guesses.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
    let image = seen.image(&best, &seen.all);
    Some(Mirror {
        plane: Plane::through(
            &placement.outward(&(best.normal * best.offset)),
            Direction::new_normalize(placement.axes * best.normal),
        ),
        points: image.hidden.iter().map(|p| placement.outward(p)).collect(),
        score: 1.0 - image.contradicting,
    })
}

/// The frames of the seen points with their mirror image, in the units of a view made ready.
pub(super) fn completed_frames(view: &View<'_>, cloud: &Normalised) -> Vec<Frame> {
    let Some(mirror) = mirrored(view).filter(|m| !m.points.is_empty()) else { return Vec::new() };
    let guessed = mirror.points.iter().map(|p| cloud.placement.inward(p).map(on_grid));
    let points: Vec<Vector> = cloud.points.iter().copied().chain(guessed).collect();
    whole_frames(&spread(&points, FRAMED))
}

/// The plane `normal · x = offset`, in normalised lengths.
#[derive(Clone, Copy)]
struct Guess {
    normal: Vector,
    offset: f64,
}

/// What a plane makes of points.
struct Image {
    /// Share of them that contradicts the view.
    contradicting: f64,
    /// Mean depth of the hidden points behind the seen ones; infinite where none is hidden.
    depth: f64,
    /// Those that lie behind seen points.
    hidden: Vec<Vector>,
}

/// The seen points and the picture of them.
struct Seen {
    viewpoint: Vector,
    picture: Picture,
    /// For each cell the distance from the viewpoint of the seen point that is nearest to it in the picture, where there is
    /// one in the cells about it.
    depths: Vec<Option<f64>>,
    all: Vec<Vector>,
    some: Vec<Vector>,
    tolerance: f64,
}

impl Seen {
    fn of(all: Vec<Vector>, viewpoint: Vector) -> Option<Self> {
        if viewpoint.norm().is_nan() || viewpoint.norm() < 1.8 {
            return None;
        }
        let cloud = PointCloud {
            points: all.iter().map(|p| Point::from(*p)).collect(),
            viewpoint: Some(Point::from(viewpoint)),
            ..PointCloud::default()
        };
        let object: Vec<u32> = (0..all.len() as u32).collect();
        let (picture, _) = Picture::of(&cloud, &object)?;
        let mut depths: Vec<Option<f64>> = vec![None; picture.width * picture.height];
        let mut apart = vec![usize::MAX; depths.len()];
        for p in &all {
            let d = (p - viewpoint).norm();
            let cell = picture.cell(&Point::from(*p));
            for (cell, steps) in cell.into_iter().flat_map(|c| around(&picture, c)) {
                if steps < apart[cell] {
                    (apart[cell], depths[cell]) = (steps, Some(d));
                }
            }
        }
        let some = spread(&all, TRIED);
        let size = 2.0 * all.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let tolerance = TOLERANCE * size;
        Some(Self { viewpoint, picture, depths, all, some, tolerance })
    }

    /// What a plane makes of some points.
    fn image(&self, plane: &Guess, points: &[Vector]) -> Image {
        let (mut against, mut depth, mut hidden) = (0usize, 0.0, Vec::new());
        for p in points {
            let q = p - plane.normal * (2.0 * (plane.normal.dot(p) - plane.offset));
            let d = (q - self.viewpoint).norm();
            let seen = self.picture.cell(&Point::from(q)).and_then(|c| self.depths[c]);
            match seen.map(|seen| d - seen) {
                Some(behind) if behind > self.tolerance => {
                    depth += behind;
                    hidden.push(q);
                }
                Some(behind) if behind > -self.tolerance => {}
                _ => against += 1,
            }
        }
        let n = points.len().max(1) as f64;
        let depth = if hidden.is_empty() { f64::INFINITY } else { depth / hidden.len() as f64 };
        Image { contradicting: against as f64 / n, depth, hidden }
    }

    /// The plane with this normal that is as near to the sensor as the view allows; `None` where none is.
    fn nearest(&self, normal: Vector) -> Option<Guess> {
        let mut along: Vec<f64> = self.some.iter().map(|p| p.dot(&normal)).collect();
        let allowed = |offset: f64| {
            let plane = Guess { normal, offset };
            (self.image(&plane, &self.some).contradicting < LIES).then_some(plane)
        };
        let mut low = quantile(&mut along, 0.0);
        let mut high = 2.0 * quantile(&mut along, 1.0) - low;
        let step = (high - low) / STEPS as f64;
        let first = (0..=STEPS).find(|k| allowed(low + step * *k as f64).is_some())?;
        high = low + step * first as f64;
        low = high - step;
        let mut found = allowed(high);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match allowed(middle) {
                Some(plane) => (found, high) = (Some(plane), middle),
                None => low = middle,
            }
        }
        found
    }
}

/// The cells about a cell, and the squares of how far they are away in cells.
fn around(picture: &Picture, cell: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
    let [w, h] = [picture.width as isize, picture.height as isize];
    let [u, v] = [cell as isize % w, cell as isize / w];
    let range = |at: isize, size: isize| (at - ABOUT).max(0)..=(at + ABOUT).min(size - 1);
    let at = move |x: isize, y: isize| {
        let square = (x - u) * (x - u) + (y - v) * (y - v);
        ((y * w + x) as usize, square as usize)
    };
    range(v, h).flat_map(move |y| range(u, w).map(move |x| at(x, y)))
}

/// Directions within the cone about the line of sight; horizontal ones where it is known what is up.
fn normals(seen: &Seen, upright: Option<Vector>) -> impl Iterator<Item = Vector> {
    const GOLDEN: f64 = 2.399_963_229_728_653;
    let ahead = (-seen.viewpoint).normalize();
    let level = upright.and_then(|up| (ahead - up * up.dot(&ahead)).try_normalize(1e-6));
    let helper = if ahead.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
    let (count, ahead, right) = match (level, upright) {
        (Some(level), Some(up)) => (DIRECTIONS / 2, level, up.cross(&level)),
        _ => (DIRECTIONS, ahead, helper.cross(&ahead).normalize()),
    };
    let down = ahead.cross(&right);
    (0..count).map(move |k| {
        let share = k as f64 / (count - 1) as f64;
        if level.is_some() {
            let (sin, cos) = (CONE * (2.0 * share - 1.0)).sin_cos();
            return ahead * cos + right * sin;
        }
        let cos = 1.0 - share * (1.0 - CONE.cos());
        let (s, c) = (GOLDEN * k as f64).sin_cos();
        ahead * cos + (right * c + down * s) * (1.0 - cos * cos).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points at even steps `u`, `v` in [0, 1].
    fn grid(n: i32, point: impl Fn(f64, f64) -> Point) -> Vec<Point> {
        let share = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        (0..n * n).map(|k| point(share(k / n), share(k % n))).collect()
    }

    /// Front and top of a box of 10 x 6 x 8 cm that stands on z = 0 with its middle over the origin.
    fn open_box() -> Vec<Point> {
        let mut points = grid(25, |u, v| Point::new(0.1 * u - 0.05, -0.03, 0.08 * v));
        points.extend(grid(25, |u, v| Point::new(0.1 * u - 0.05, 0.06 * v - 0.03, 0.08)));
        points
    }

    fn view(points: &[Point]) -> View<'_> {
        View {
            viewpoint: Some(Point::new(0.0, -0.6, 0.5)),
            support: Plane::new(Vector::z(), 0.0).ok(),
            standing: true,
            ..View::all_around(points)
        }
    }

    #[test]
    fn the_back_of_a_box_is_its_front_mirrored() {
        let seen = open_box();
        let mirror = mirrored(&view(&seen)).unwrap();
        let normal = mirror.plane.normal();
        assert!(normal.z.abs() < 1e-9 && normal.y > 0.98, "{normal:?}");
        assert!(mirror.plane.height(&Point::origin()).abs() < 0.006, "{:?}", mirror.plane);
        let back: Vec<&Point> = mirror.points.iter().filter(|p| p.z < 0.07).collect();
        assert!(back.len() > 450 && back.iter().all(|p| (p.y - 0.03).abs() < 0.02));
        assert!(mirror.score > 0.95 && mirror.score <= 1.0);
    }

    #[test]
    fn half_a_can_becomes_whole() {
        let from = |angle: f64| [0.04 * angle.cos(), 0.04 * angle.sin()];
        let mut seen = grid(40, |u, v| {
            let [x, y] = from(std::f64::consts::PI * (1.0 + u));
            Point::new(x, y, 0.12 * v)
        });
        seen.extend(grid(25, |u, v| {
            let [x, y] = from(std::f64::consts::TAU * u).map(|c| c * v.sqrt());
            Point::new(x, y, 0.12)
        }));
        let mirror = mirrored(&view(&seen)).unwrap();
        assert!(mirror.points.len() > 800);
        let radius = |p: &Point| p.x.hypot(p.y);
        assert!(mirror.points.iter().all(|p| (radius(p) - 0.04).abs() < 0.012 || p.z > 0.11));
        // it depends on no unit and no place
        let moved = |p: &Point| Point::from(1e3 * p.coords) + Vector::new(5e3, -2e3, 1e3);
        let far: Vec<Point> = seen.iter().map(moved).collect();
        let there = View {
            viewpoint: view(&seen).viewpoint.as_ref().map(moved),
            support: Plane::new(Vector::z(), -1e3).ok(),
            ..view(&far)
        };
        let other = mirrored(&there).unwrap();
        let off = other.plane.height(&moved(&Point::origin())) / 1e3;
        assert!((off - mirror.plane.height(&Point::origin())).abs() < 1e-3);
    }

    #[test]
    fn without_a_sensor_outside_there_is_no_hidden_side() {
        let seen = open_box();
        assert!(mirrored(&View::all_around(&seen)).is_none());
        let within = View { viewpoint: Some(Point::new(0.0, 0.0, 0.04)), ..view(&seen) };
        assert!(mirrored(&within).is_none());
        assert!(mirrored(&view(&seen[..5])).is_none());
        let lost = View { viewpoint: Some(Point::new(f64::NAN, 0.0, 0.0)), ..view(&seen) };
        assert!(mirrored(&lost).is_none());
    }

    #[test]
    fn a_fit_that_begins_from_the_image_counts_what_was_seen() {
        use crate::fit::{Family, FitOptions, fit};
        let seen = open_box();
        let options =
            FitOptions { complete: Completion::Mirror, ..FitOptions::only(Family::Superellipsoid) };
        let found = fit(&view(&seen), &options).unwrap();
        assert_eq!(found.inliers.len(), seen.len());
        assert!(found.residual < 1e-3 && found.inlier_share() > 0.9);
    }
}
