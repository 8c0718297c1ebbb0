//! Which pieces are objects? Joins what one thing was broken into, and leaves out what is none.
//!
//! An occlusion, a thin wall or a dark patch breaks a thing into pieces. Two are joined when the
//! smaller one is near and stands (in the support plane) within the other's outline, as the inside of a
//! cup within its rim, or when it is small beside the other and hangs in the air, as a handle. What is
//! left must be large enough, rise over the noise, and stand on the part of the support that was seen.

use crate::Point;
use crate::cloud::VoxelGrid;
use crate::segment::footprint::{Ground, Outline};
use crate::segment::table::Support;
use crate::segment::{DropReason, Dropped, SegmentOptions};

/// A piece of the cloud above the support.
#[derive(Clone, Debug)]
struct Piece {
    points: Vec<u32>,
    /// Heights of its lowest and highest points over the support, without the last 2 %, in metres.
    bottom: f64,
    top: f64,
    outline: Outline,
    /// Some of its points, one in a cube of `GRAIN`.
    sample: Vec<Point>,
    low: Point,
    high: Point,
}

/// Distance between the points by which gaps are measured, in metres.
const GRAIN: f64 = 0.006;

impl Piece {
    fn new(points: Vec<u32>, cloud: &[Point], support: &Support, ground: &Ground) -> Self {
        let step = (points.len() / 3000).max(1);
        let some = points.iter().copied().step_by(step);
        let sample: Vec<Point> = VoxelGrid::new(cloud, some, GRAIN)
            .map(|g| g.representatives().filter_map(|i| cloud.get(i as usize)).copied().collect())
            .unwrap_or_default();
        let mut heights: Vec<f64> = points
            .iter()
            .step_by(step)
            .filter_map(|i| cloud.get(*i as usize))
            .map(|p| support.plane.height(p))
            .collect();
        let mut quantile = |q: f64| {
            let at = (q * heights.len() as f64) as usize;
            let at = at.min(heights.len().saturating_sub(1));
            if heights.is_empty() {
                0.0
            } else {
                *heights.select_nth_unstable_by(at, f64::total_cmp).1
            }
        };
        let (bottom, top) = (quantile(0.02), quantile(0.98));
        let outline = Outline::around(&mut sample.iter().map(|p| ground.spot(p)).collect());
        let first = sample.first().copied().unwrap_or(Point::origin());
        let low = sample.iter().fold(first, |a, b| a.inf(b));
        let high = sample.iter().fold(first, |a, b| a.sup(b));
        Self { points, bottom, top, outline, sample, low, high }
    }

    fn size(&self) -> f64 {
        (self.high - self.low).norm()
    }

    /// Smallest distance to another piece, or infinity when it is over `most`.
    fn gap(&self, other: &Self, most: f64) -> f64 {
        let apart = (0..3)
            .any(|k| self.low[k] > other.high[k] + most || other.low[k] > self.high[k] + most);
        if apart {
            return f64::INFINITY;
        }
        let mut least = most * most;
        let mut found = false;
        for p in &self.sample {
            for q in &other.sample {
                let d = (p - q).norm_squared();
                if d < least {
                    (least, found) = (d, true);
                }
            }
        }
        if found { least.sqrt() } else { f64::INFINITY }
    }
}

/// The objects among `pieces`, in the order of their first points, and what is none.
pub(crate) fn gather(
    cloud: &[Point],
    pieces: Vec<Vec<u32>>,
    support: &Support,
    options: &SegmentOptions,
) -> (Vec<Vec<u32>>, Vec<Dropped>) {
    let ground = Ground::of(&support.plane);
    let mut pieces: Vec<Piece> =
        pieces.into_iter().map(|p| Piece::new(p, cloud, support, &ground)).collect();
    join(&mut pieces, cloud, support, &ground);
    let (mut objects, mut dropped) = (Vec::new(), Vec::new());
    for piece in pieces {
        match fault(&piece, support, &ground, options) {
            None => objects.push(piece.points),
            Some(reason) => dropped.push(Dropped { points: piece.points, reason }),
        }
    }
    objects.sort_unstable_by_key(|o| o.first().copied());
    (objects, dropped)
}

/// Joins pieces of one thing until none belongs to another, the smallest first.
fn join(pieces: &mut Vec<Piece>, cloud: &[Point], support: &Support, ground: &Ground) {
    pieces.sort_by_key(|p| (p.points.len(), p.points.first().copied()));
    let mut k = 0;
    while k < pieces.len() {
        let small = &pieces[k];
        let owner = (k + 1..pieces.len())
            .filter_map(|j| belongs(small, &pieces[j], support).map(|gap| (gap, j)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match owner {
            Some((_, j)) => {
                let mut points = pieces[j].points.clone();
                points.extend(&pieces[k].points);
                points.sort_unstable();
                pieces[j] = Piece::new(points, cloud, support, ground);
                pieces.remove(k);
            }
            None => k += 1,
        }
    }
}

/// The gap between two pieces of one thing; `None` when they are two things.
fn belongs(small: &Piece, large: &Piece, _support: &Support) -> Option<f64> {
    let within = small.outline.common(&large.outline).area() / small.outline.area().max(1e-9);
    let slight = small.points.len() * 5 < large.points.len();
    let hangs = small.bottom > 0.015 + 0.1 * large.top;
    let reach = if within > 0.5 {
        0.5 * large.size()
    } else if slight && hangs {
        0.03
    } else if slight {
        0.012
    } else {
        return None;
    };
    let gap = small.gap(large, reach);
    gap.is_finite().then_some(gap)
}

/// Why a piece is no object; `None` when it is one.
fn fault(
    piece: &Piece,
    support: &Support,
    ground: &Ground,
    options: &SegmentOptions,
) -> Option<DropReason> {
    if piece.points.len() < options.least_points || piece.size() < options.least_size {
        return Some(DropReason::Speck);
    }
    if piece.size() > options.largest_size {
        return Some(DropReason::TooLarge);
    }
    let standing =
        piece.sample.iter().filter(|p| support.outline.depth(&ground.spot(p)) > 0.01).count();
    if standing * 2 < piece.sample.len() {
        return Some(DropReason::OffSupport);
    }
    None
}
