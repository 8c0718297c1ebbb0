//! Which pieces are objects? Joins what one thing was broken into, and leaves out what is none.
//!
//! An occlusion, a thin wall or a dark patch breaks a thing into pieces. Two are joined when
//! - the smaller is a crumb beside the larger and near, or within its outline in the support plane;
//! - their outlines overlap and the gap is slight for their size: things that stand side by side have
//!   outlines apart;
//! - one is hollow, rises as high, and the other is in front of it: the two sides of a cup;
//! - both rise as high, lie in one line, and a third hides what is between: a box behind a can.
//!
//! What is left must be large enough, and stand on the part of the support that was seen.

use crate::Point;
use crate::segment::class::Margins;
use crate::segment::footprint::Ground;
use crate::segment::image::Image;
use crate::segment::piece::Piece;
use crate::segment::sight::Sight;
use crate::segment::table::Support;
use crate::segment::{DropReason, Dropped, SegmentOptions};

/// Share of an object that is over what was seen of its support, at least.
const STANDING: f64 = 1.0 / 3.0;
/// Top of a thing, in margins, up to which it may be the support's own unevenness.
const FLAT: f64 = 1.5;
/// Share of curved rows from which a piece is an inside, and from which it is nothing else besides.
const HOLLOW: f64 = 0.5;
const ALL_HOLLOW: f64 = 0.78;
/// Pieces that are looked at, the largest first: more are noise.
const MOST: usize = 300;
/// Size under which, and height of the foot over which, nothing hangs in the air, in metres: larger and
/// lower things may have a foot that was not seen.
const SMALL: f64 = 0.1;
const HIGH: f64 = 0.15;
/// Part of a thing's height that may be hidden over what carries it, in metres.
const FOOT: f64 = 0.04;

/// The objects among `pieces`, in the order of their first points, and what is none.
pub(crate) fn gather(
    cloud: &[Point],
    mut pieces: Vec<Vec<u32>>,
    support: &Support,
    sight: &Sight,
    mut image: Option<Image<'_>>,
    options: &SegmentOptions,
) -> (Vec<Vec<u32>>, Vec<Dropped>) {
    let ground = Ground::of(&support.plane);
    let (mut kept, mut dropped) = (Vec::new(), Vec::new());
    pieces.sort_by_key(|p| (std::cmp::Reverse(p.len()), p.first().copied()));
    let noise = pieces.split_off(pieces.len().min(MOST));
    let drop = |points, reason| Dropped::new(cloud, points, reason, &support.plane);
    dropped.extend(noise.into_iter().map(|points| drop(points, DropReason::Speck)));
    for points in pieces {
        let piece = Piece::new(points, cloud, &support.plane, &ground);
        let reason = misplaced(&piece, support, options);
        kept.push((piece, reason));
    }
    // The smallest first, so that crumbs find their thing before things find each other.
    kept.reverse();
    let (kept, faults): (Vec<Piece>, Vec<Option<DropReason>>) = kept.into_iter().unzip();
    let mut pieces: Vec<Option<Piece>> = kept.into_iter().map(Some).collect();
    if let Some(image) = &mut image {
        for (k, piece) in pieces.iter().enumerate() {
            piece.iter().for_each(|p| image.own(&p.points, k));
        }
        for piece in pieces.iter_mut().flatten() {
            piece.hollow = image.hollow(&piece.points);
        }
    }
    for k in 0..pieces.len() {
        let Some(piece) = pieces[k].take() else { continue };
        let part_of = owner(k, &piece, &pieces, &faults, image.as_ref(), support, &ground);
        let Some((j, other)) = part_of.and_then(|j| Some((j, pieces[j].take()?))) else {
            pieces[k] = Some(piece);
            continue;
        };
        let mut points = other.points;
        points.extend(piece.points);
        points.sort_unstable();
        let mut whole = Piece::new(points, cloud, &support.plane, &ground);
        if let Some(image) = &mut image {
            image.own(&whole.points, j);
            whole.hollow = image.hollow(&whole.points);
        }
        pieces[j] = Some(whole);
    }
    let mut objects = Vec::new();
    let carried = |piece: &Piece| pieces.iter().flatten().any(|other| carries(other, piece));
    let carried: Vec<bool> =
        pieces.iter().map(|piece| piece.as_ref().is_some_and(carried)).collect();
    for ((piece, fault), carried) in pieces.into_iter().zip(faults).zip(carried) {
        let Some(piece) = piece else { continue };
        match fault.or_else(|| slight(&piece, support, sight, image.as_ref(), carried, options)) {
            None => {
                let mut points = piece.points;
                image.iter_mut().for_each(|image| image.grow(&mut points));
                objects.push(points);
            }
            Some(reason) => dropped.push(drop(piece.points, reason)),
        }
    }
    objects.sort_unstable_by_key(|o| o.first().copied());
    (objects, dropped)
}

/// The piece that piece number `k` is part of: the nearest of those that it belongs to.
fn owner(
    k: usize,
    piece: &Piece,
    pieces: &[Option<Piece>],
    faults: &[Option<DropReason>],
    image: Option<&Image<'_>>,
    support: &Support,
    ground: &Ground,
) -> Option<usize> {
    let up = support.plane.normal();
    let hangs = piece.aloft() && image.is_some_and(|i| i.hangs(&piece.points, &up));
    let cup = |inner: &Piece, outer: usize| {
        let front = || image?.before(&inner.points, inner.hollow > ALL_HOLLOW);
        inner.hollow > HOLLOW && front() == Some(outer)
    };
    let joint = |j: usize, other: &Piece| {
        // The gap comes last: it costs most.
        let cups = || {
            let cup = level(piece, other) && (cup(piece, j) || cup(other, k));
            let most = 0.4 * piece.size().max(other.size());
            if cup { piece.gap(other, most.min(0.3)) } else { None }
        };
        let ends = || {
            let hidden = in_line(piece, other, ground)
                && image.is_some_and(|i| i.hidden_between(&piece.points, &other.points));
            if hidden { piece.gap(other, 0.15) } else { None }
        };
        entwined(piece, other).or_else(cups).or_else(ends)
    };
    let mut best: Option<(f64, usize)> = None;
    for (j, other) in pieces.iter().enumerate() {
        let Some(other) = other else { continue };
        // Crumbs of furniture go with it; nothing else does.
        let apart = faults[k].is_some() || faults[j].is_some();
        let gap = crumb(piece, other, hangs).or_else(|| if apart { None } else { joint(j, other) });
        if let Some(gap) = gap
            && best.is_none_or(|b| gap < b.0)
        {
            best = Some((gap, j));
        }
    }
    best.map(|b| b.1)
}

/// Gap of a crumb: within the other's outline, or hanging, it may be wide.
fn crumb(piece: &Piece, other: &Piece, hangs: bool) -> Option<f64> {
    if piece.points.len() * 5 > other.points.len() {
        return None;
    }
    let near = piece.gap(other, 0.04)?;
    let high = piece.bottom > 0.015 + 0.1 * other.top;
    let tiny = piece.points.len() * 25 < other.points.len();
    (near < 0.012
        || tiny && near < 0.025
        || near < 0.03 && (high || hangs)
        || piece.within(other) > 0.35)
        .then_some(near)
}

/// Gap of two pieces whose outlines overlap, when it is slight for their size.
fn entwined(piece: &Piece, other: &Piece) -> Option<f64> {
    let gap = piece.gap(other, 0.05 * piece.size().min(other.size()))?;
    (piece.within(other).max(other.within(piece)) > 0.1).then_some(gap)
}

/// Whether two pieces are as high, as the two sides of a cup are.
fn level(piece: &Piece, other: &Piece) -> bool {
    (piece.top - other.top).abs() < 0.01 + 0.1 * piece.top.max(other.top)
}

/// Whether two pieces may be the ends of one thing: as high, and as wide across the line between.
fn in_line(piece: &Piece, other: &Piece, ground: &Ground) -> bool {
    if (piece.top - other.top).abs() > 0.008 {
        return false;
    }
    let middle = |p: &Piece| {
        let n = p.sample.len().max(1) as f64;
        let feet = p.sample.iter().map(|q| ground.spot(q));
        let sum = feet.fold([0.0; 2], |s, f| [s[0] + f[0], s[1] + f[1]]);
        [sum[0] / n, sum[1] / n]
    };
    let (a, b) = (middle(piece), middle(other));
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy).max(1e-9);
    let across = |p: &Piece| {
        p.sample.iter().map(|q| ground.spot(q)).fold([f64::MAX, f64::MIN], |r, f| {
            let y = ((f[1] - a[1]) * dx - (f[0] - a[0]) * dy) / length;
            [r[0].min(y), r[1].max(y)]
        })
    };
    let (s, t) = (across(piece), across(other));
    let slack = 0.015 + 0.1 * (s[1] - s[0]).max(t[1] - t[0]);
    (s[0] - t[0]).abs() < slack && (s[1] - t[1]).abs() < slack
}

/// Whether a piece may stand on another: that reaches as high as its foot, and lies under it.
fn carries(lower: &Piece, upper: &Piece) -> bool {
    lower.bottom < upper.bottom
        && lower.top > upper.bottom - FOOT
        && lower.top < upper.top
        && upper.within(lower) > 0.1
}

/// Why a piece cannot be an object, by its place and size; `None` when it can.
fn misplaced(piece: &Piece, support: &Support, options: &SegmentOptions) -> Option<DropReason> {
    if piece.size() > options.largest_size {
        return Some(DropReason::TooLarge);
    }
    (support.share_over(piece.sample.iter()) < STANDING).then_some(DropReason::OffSupport)
}

/// Why a whole thing is none; `None` when it is one.
fn slight(
    piece: &Piece,
    support: &Support,
    sight: &Sight,
    image: Option<&Image<'_>>,
    carried: bool,
    options: &SegmentOptions,
) -> Option<DropReason> {
    if piece.points.len() < options.least_points || piece.size() < options.least_size {
        return Some(DropReason::Speck);
    }
    let middle = piece.sample.get(piece.sample.len() / 2);
    if middle.is_some_and(|p| piece.top < FLAT * Margins::of(support, sight, options).at(p)) {
        return Some(DropReason::Flat);
    }
    let aloft = piece.aloft() && (piece.size() < SMALL || piece.bottom > HIGH) && !carried;
    let up = support.plane.normal();
    let hangs = aloft && image.is_some_and(|i| i.hangs(&piece.points, &up));
    hangs.then_some(DropReason::Hanging)
}
