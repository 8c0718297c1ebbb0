//! A view made ready: centred, thinned, with all that is known beside the points and frames to begin in.

use super::centred::{Centred, spread};
use super::columns::Sample;
use super::free_space::outline;
use super::pieces::pieces;
use super::start::{Frame, frames, quantile};
use super::terms::{Sight, Support, Terms};
use super::{Effort, FitError, View};
use crate::{Point, Vector};

/// Fewer points than this determine no surface.
const LEAST_POINTS: usize = 12;
/// Points that sort out the starts of single views, that rank starts, that refine the best of them, and that decide
/// (for both efforts).
const SKETCH: usize = 60;
const COARSE: usize = 160;
const MIDDLE: [usize; 2] = [240, 400];
const FINE: [usize; 2] = [600, 2000];
/// Share of the points from which a piece is as good as all.
const WHOLE: f64 = 0.97;
/// How far before a seen point nothing is, in normalised lengths.
const BEFORE: f64 = 0.15;
/// A piece stands on the support when the gap below it is less than this share of its size.
const HOVERING: f64 = 0.8;
/// The support is known no better than this share of the cloud's size.
const SUPPORT_TOLERANCE: f64 = 0.01;

/// The view with zero mean and unit root mean square.
pub(super) struct Normalised {
    pub(super) centre: Vector,
    pub(super) scale: f64,
    pub(super) sketch: Sample,
    pub(super) coarse: Sample,
    pub(super) middle: Sample,
    pub(super) fine: Sample,
    pub(super) points: Vec<Vector>,
    pub(super) frames: Vec<Frame>,
    pub(super) terms: Terms,
    pub(super) effort: Effort,
    /// Points that count.
    pub(super) total: usize,
}

impl Normalised {
    pub(super) fn new(view: &View<'_>, effort: Effort) -> Result<Self, FitError> {
        // where a sensor saw nothing it may have written its own place
        let cloud = Centred::new(view.points, LEAST_POINTS, view.viewpoint)?;
        let (centre, scale) = (cloud.centre, cloud.scale);
        let inward = |p: &Point| cloud.inward(p);
        let fine = spread(&cloud.points, FINE[effort as usize]);
        let sides = box_sides(&fine);
        let support = view.support.map(|plane| {
            let normal = plane.normal().into_inner();
            let offset = (normal.dot(&centre) + plane.offset()) / scale;
            let mut heights: Vec<f64> = fine.iter().map(|p| normal.dot(p) + offset).collect();
            // a piece that hovers higher than it is large is not the top of something that stands there
            let standing = view.standing && quantile(&mut heights, 0.02) < HOVERING * sides.max();
            let highest = quantile(&mut heights, 0.995);
            let above = view.viewpoint.is_some_and(|p| plane.height(&p) / scale > highest);
            let top = above.then_some(highest);
            Support { normal, offset, standing, top, tolerance: SUPPORT_TOLERANCE }
        });
        let tallest = support.filter(|s| s.standing).and_then(|s| s.top).unwrap_or(0.0);
        let outside = view.viewpoint.as_ref().map(inward).filter(|p| p.norm() > 1.8);
        let volume = sides.iter().map(|s| s.max(0.1)).product();
        let sight = if outside.is_some() { Sight::OneSide } else { Sight::AllAround { volume } };
        // on a single view stray points and what lies beside the object lead starts astray
        let parts = match (sight, effort) {
            (Sight::OneSide, Effort::Thorough) => Some(pieces(&fine)),
            _ => None,
        };
        let piece = parts.as_ref().map_or(&[][..], |p| &p.largest);
        let parted =
            piece.len() < (WHOLE * fine.len() as f64) as usize && piece.len() > LEAST_POINTS;
        let start: &[Vector] = if parted { piece } else { &fine };
        let free = match (&parts, outside) {
            (Some(parts), Some(viewpoint)) if view.free.is_empty() => {
                outline(&parts.coherent, &viewpoint)
            }
            _ => view.free.iter().map(inward).collect(),
        };
        let seen = if parted { box_sides(start) } else { sides };
        let reach = 0.55 * seen.max().max(tallest);
        let before = outside.map_or(Vec::new(), |viewpoint| {
            let nearer = |p: &Vector| p - (p - viewpoint).normalize() * BEFORE;
            start.iter().map(nearer).collect()
        });
        let terms = Terms { support, viewpoint: outside, free, before, sight, reach };
        Ok(Self {
            centre,
            scale,
            sketch: sample(&cloud.points, SKETCH),
            coarse: sample(start, COARSE),
            middle: sample(&cloud.points, MIDDLE[effort as usize]),
            fine: Sample::new(fine.iter().copied()),
            frames: frames(start, &terms),
            points: fine,
            terms,
            effort,
            total: cloud.points.len(),
        })
    }
}

fn sample(points: &[Vector], count: usize) -> Sample {
    Sample::new(spread(points, count).into_iter())
}

/// Sides of the points' box along their principal axes.
fn box_sides(points: &[Vector]) -> Vector {
    let scatter: nalgebra::Matrix3<f64> = points.iter().map(|p| p * p.transpose()).sum();
    let axes = nalgebra::SymmetricEigen::new(scatter).eigenvectors;
    Vector::from_fn(|k, _| {
        let along = || points.iter().map(|p| p.dot(&axes.column(k)));
        let low = along().fold(f64::INFINITY, f64::min);
        along().fold(f64::NEG_INFINITY, f64::max) - low
    })
}
