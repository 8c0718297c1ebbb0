//! Floor 8: things that touch, told apart; pieces of one thing, put together.
//!
//! What stands on a support comes as clumps. Each is cut at its concave edges, and the pieces are joined again where
//! there is a reason and one surface explains them about as well as their own do:
//!
//! - *whole*: the clump is one body, and its pieces are due to noise or a shallow dent;
//! - *behind*: something nearer hides what is between them;
//! - *hollow*: one is the inside of the other, seen through its mouth;
//! - *bit*: nothing carries it, as a handle or a spout.
//!
//! That a surface explains two pieces that meet at a concave edge is no reason: two boxes of the same footprint, one on
//! the other, are explained by one box.

mod bodies;
mod view;

pub use bodies::Around;

use crate::cloud::{PointCloud, Sets};
use crate::fit::{Family, Fit, FitError, FitOptions};
use crate::segment::{Segmentation, convex_pieces};
use view::View;

/// Points with their surface.
pub type Fitted = (Vec<u32>, Result<Fit, FitError>);

/// Share of a clump's points under which a piece is a sliver, and the points of the least piece.
const SLIVER: f64 = 0.02;
const LEAST: usize = 150;

const QUICK: FitOptions = FitOptions::only(Family::Superellipsoid).quick();

struct Piece {
    points: Vec<u32>,
    clump: usize,
    fit: Option<Fit>,
    own: f64,
    low: f64,
}

fn env(name: &str, default: f64) -> f64 {
    std::env::var(name).map_or(default, |x| x.parse().unwrap())
}

/// The objects of a scene with their surfaces, in the order of their first points.
pub fn separate(
    cloud: &PointCloud,
    segmentation: &Segmentation,
    options: &FitOptions,
) -> Vec<Fitted> {
    let debug = std::env::var("SEPDBG").is_ok();
    let around = Around { cloud, support: segmentation.support };
    let clumps = each(segmentation.objects.len(), |k| clump(&around, &segmentation.objects[k], options));
    let mut done: Vec<Fitted> = Vec::new();
    let mut pieces: Vec<Piece> = Vec::new();
    for (k, clump) in clumps.into_iter().enumerate() {
        match clump {
            Clump::Whole(points, fit) => {
                let own = fit.as_ref().map_or(f64::INFINITY, |f| around.typical(&points, f));
                let low = lowest(&around, &points);
                pieces.push(Piece { points, clump: k, fit: fit.ok(), own, low });
            }
            Clump::Parts(parts) => {
                for (points, fit) in parts {
                    let own = fit.as_ref().map_or(f64::INFINITY, |f| around.typical(&points, f));
                    let low = lowest(&around, &points);
                    pieces.push(Piece { points, clump: k, fit: fit.ok(), own, low });
                }
            }
        }
    }
    if debug {
        for (k, p) in pieces.iter().enumerate() {
            let some: Vec<u32> = p.points.iter().step_by(p.points.len().div_ceil(40).max(1)).copied().collect();
            eprintln!("PIECE {k} clump {} n {} low {:.3} own {:.4} some {some:?}", p.clump, p.points.len(), p.low, p.own);
        }
    }
    let all: Vec<&[u32]> = pieces.iter().map(|p| &p.points[..]).collect();
    let mut sets = Sets::new(pieces.len());
    if let Some(view) = View::new(cloud, &all) {
        let borders = view.borders();
        let outlines: Vec<Vec<u32>> = pieces.iter().map(|p| view.outline(&p.points)).collect();
        let mut pairs = Vec::new();
        for a in 0..pieces.len() {
            for b in a + 1..pieces.len() {
                pairs.push([a, b]);
            }
        }
        let joints = each(pairs.len(), |k| {
            let [a, b] = pairs[k];
            let border = borders.get(&[a, b]).copied().unwrap_or_default();
            let (p, q) = (&pieces[a], &pieces[b]);
            let union = || {
                let mut points = [&p.points[..], &q.points[..]].concat();
                points.sort_unstable();
                points
            };
            let mut found: Option<(f64, &'static str)> = None;
            let mut offer = |score: f64, why| {
                if found.is_none_or(|f| score < f.0) {
                    found = Some((score, why));
                }
            };
            let worth = |fit: &Fit| {
                let ratio = |piece: &Piece| {
                    let q = around.typical(&piece.points, fit);
                    if q > env("WORST", 0.003) { f64::INFINITY } else { q / (env("RATIO", 1.8) * piece.own).max(env("SLIGHT", 0.0023)) }
                };
                ratio(p).max(ratio(q))
            };
            if border.touching <= 15 && view.hides_between(&outlines[a], &outlines[b]) {
                if let Ok(fit) = around.fit(&union(), &QUICK) {
                    let (score, against) = (worth(&fit), view.contradicted(&fit, [&p.points, &q.points]));
                    if debug {
                        eprintln!("behind {a} {b} clumps {} {} n {} {} score {score:.2} against {against:.2}", p.clump, q.clump, p.points.len(), q.points.len());
                    }
                    if score + 2.0 * against < 0.9 && score < 0.7 {
                        offer(score, "behind");
                    }
                }
            }
            if border.beside >= 50 && border.touching * 4 < border.beside {
                if let Ok(fit) = around.fit_hollow(&union(), &QUICK) {
                    let score = worth(&fit);
                    let (f, g) = (view.facing(&fit, &p.points), view.facing(&fit, &q.points));
                    if debug {
                        eprintln!("hollow {a} {b} n {} {} border {border:?} score {score:.2} facing {f:.2} {g:.2}", p.points.len(), q.points.len());
                    }
                    if score < 0.6 && f.max(g) >= 0.8 && f.min(g) <= 0.2 {
                        offer(score, "hollow");
                    }
                }
            }
            let (small, large) = (p.points.len().min(q.points.len()), p.points.len().max(q.points.len()));
            if border.touching > 15 && 10 * small < 3 * large {
                let score = around.fit(&union(), &QUICK).map_or(9.0, |fit| worth(&fit));
                if score < 0.6 { offer(score, "dent"); }
                if debug {
                eprintln!("touch {a} {b} clumps {} {} n {} {} low {:.3} {:.3} border {border:?} score {score:.2} own {:.4} {:.4}", p.clump, q.clump, p.points.len(), q.points.len(), p.low, q.low, p.own, q.own);
                }
            }
            found
        });
        let mut ranked: Vec<(f64, [usize; 2], &str)> = joints.into_iter().zip(&pairs).filter_map(|(j, pair)| j.map(|(s, w)| (s, *pair, w))).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (score, [a, b], why) in ranked {
            if debug {
                eprintln!("JOIN {why} {a} {b} score {score:.2}");
            }
            sets.join(a, b);
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); pieces.len()];
    for k in 0..pieces.len() {
        groups[sets.root(k)].push(k);
    }
    groups.retain(|g| !g.is_empty());
    let objects = each(groups.len(), |k| {
        let mut points: Vec<u32> = groups[k].iter().flat_map(|p| pieces[*p].points.iter().copied()).collect();
        points.sort_unstable();
        let fit = around.fit(&points, options);
        (points, fit)
    });
    done.extend(objects);
    done.sort_by_key(|(points, _)| points.first().copied());
    done
}

fn lowest(around: &Around<'_>, points: &[u32]) -> f64 {
    let Some(support) = around.support else { return 0.0 };
    let mut heights: Vec<f64> = points.iter().map(|i| support.height(&around.cloud.points[*i as usize])).collect();
    let k = heights.len() / 50;
    *heights.select_nth_unstable_by(k, f64::total_cmp).1
}

enum Clump {
    Whole(Vec<u32>, Result<Fit, FitError>),
    Parts(Vec<Fitted>),
}

/// A clump as one body, where its pieces are explained by it, or in its pieces.
fn clump(around: &Around<'_>, points: &[u32], options: &FitOptions) -> Clump {
    let pieces = convex_pieces(around.cloud, points);
    let least = LEAST.max((SLIVER * points.len() as f64) as usize);
    let (large, small): (Vec<_>, Vec<_>) = pieces.into_iter().partition(|p| p.len() >= least);
    let whole = || (points.to_vec(), around.fit(points, options));
    if large.len() < 2 {
        let (points, fit) = whole();
        return Clump::Whole(points, fit);
    }
    let (points, fit) = whole();
    let mut parts: Vec<Fitted> = large.into_iter().map(|p| { let f = around.fit(&p, &QUICK); (p, f) }).collect();
    if let Ok(fit) = &fit {
        let explained = parts.iter().all(|(p, f)| {
            let own = f.as_ref().map_or(f64::INFINITY, |f| around.typical(p, f));
            around.typical(p, fit) < (env("WRATIO", 1.3) * own).max(env("WSLIGHT", 0.0012))
        });
        if explained {
            return Clump::Whole(points, Ok(fit.clone()));
        }
    }
    for sliver in small {
        let distance = |p: &Fitted| p.1.as_ref().map_or(f64::INFINITY, |f| around.typical(&sliver, f));
        let nearest = parts.iter().map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, d)) = nearest && d < 0.006 {
            parts[k].0.extend(sliver);
            parts[k].0.sort_unstable();
        }
    }
    Clump::Parts(parts)
}

/// The results of `work` for 0..n in order, on all cores where the feature `parallel` is on.
pub(crate) fn each<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..n).into_par_iter().map(work).collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        (0..n).map(work).collect()
    }
}
