//! Microseconds a point for the exact Euclidean distance, on one core, against a search from every node of a 12 x 12
//! grid; and the points for which a brute force (a fine grid, its best valleys refined) finds something nearer.
//!
//! `cargo bench -p supersurface --bench closest`

#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use supersurface::measure::ClosestFinder;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Superellipsoid, Supertoroid};
use supersurface::{Point, Vector};

const BODIES: usize = 1_000;
/// Points of each body, every other one inside.
const POINTS: usize = 100;
/// Of them the slow search is timed on some.
const TIMED: usize = 10;
const STARTS: usize = 12;
const FINE: usize = 128;

fn main() {
    let mut random = Stream::new(5, 0);
    let mut tally = [Tally::default(); 2];
    for body in 0..BODIES {
        let ratio = |random: &mut Stream| random.between(0.0, 100f64.ln()).exp() * 0.01;
        let axes = [0; 3].map(|_| ratio(&mut random));
        let exponents = [0; 2].map(|_| random.between(0.1, 1.95));
        let ring = random.between(1.0, 6.0);
        let ellipsoid = Superellipsoid::new(axes, exponents).unwrap();
        let toroid = Supertoroid::new(axes, ring, exponents).unwrap();
        let powers = exponents.map(|e| 2.0 / e);
        let sheet = |ring: f64, side: f64| Sheet { axes, powers, ring, side };
        match body % 2 {
            0 => {
                let finder = || ClosestFinder::superellipsoid(&ellipsoid);
                tally[0].add(&ellipsoid, finder, &[sheet(0.0, 1.0)], &mut random);
            }
            _ => {
                let finder = || ClosestFinder::supertoroid(&toroid);
                tally[1].add(&toroid, finder, &[sheet(ring, 1.0), sheet(ring, -1.0)], &mut random);
            }
        }
    }
    for (name, t) in ["superellipsoids", "supertoroids"].iter().zip(tally) {
        let each = 1e6 / t.points as f64;
        println!(
            "{name:15} {:6.2} µs a point   multistart {:7.2} µs, {:5.1} times as long   {} of {} farther than brute force",
            t.ours * each,
            t.multistart * each,
            t.multistart / t.ours,
            t.failures,
            t.points
        );
    }
}

#[derive(Clone, Copy, Default)]
struct Tally {
    points: usize,
    ours: f64,
    multistart: f64,
    failures: usize,
}

impl Tally {
    fn add(
        &mut self,
        shape: &impl Implicit,
        finder: impl Fn() -> ClosestFinder,
        sheets: &[Sheet],
        random: &mut Stream,
    ) {
        let points: Vec<Point> = (0..POINTS).map(|k| around(shape, k % 2 == 0, random)).collect();
        let began = ProcessTime::now();
        let finder = finder();
        let ours: Vec<f64> =
            points.iter().map(|p| finder.find(p).map_or(f64::NAN, |c| c.distance.abs())).collect();
        self.ours += began.elapsed().as_secs_f64();

        let began = ProcessTime::now();
        let places = |p: &Point| {
            let starts = sheets.iter().flat_map(|s| nodes(STARTS).map(move |place| (s, place)));
            starts.map(|(s, place)| s.descend(place, &p.coords.abs())).fold(f64::INFINITY, f64::min)
        };
        let multistart: Vec<f64> = points.iter().take(TIMED).map(places).collect();
        self.multistart += began.elapsed().as_secs_f64() * (POINTS / TIMED) as f64;
        let multistart = multistart.into_iter().chain(std::iter::repeat(f64::INFINITY));

        let grids: Vec<Vec<Vector>> =
            sheets.iter().map(|s| nodes(FINE).map(|place| s.point(place)).collect()).collect();
        for ((p, ours), other) in points.iter().zip(ours).zip(multistart) {
            let p = p.coords.abs();
            let brute = sheets
                .iter()
                .zip(&grids)
                .flat_map(|(sheet, grid)| valleys(grid, &p).map(move |place| (sheet, place)))
                .map(|(sheet, place)| sheet.descend(place, &p))
                .fold(other, f64::min);
            let [low, high] = shape.bounds();
            let accepted = brute + 1e-11 * (high - low).amax();
            if ours.is_nan() || ours > accepted {
                self.failures += 1;
                if std::env::var_os("SHOW").is_some() {
                    println!("{:?} {p:?}: {ours} {brute}", sheets[0]);
                }
            }
        }
        self.points += POINTS;
    }
}

/// A point inside, or not far outside.
fn around(shape: &impl Implicit, inside: bool, random: &mut Stream) -> Point {
    let [low, high] = shape.bounds();
    let reach = if inside { 1.0 } else { 1.8 };
    loop {
        let p = Vector::from_fn(|k, _| reach * random.between(low[k], high[k]));
        if (shape.gauge(&p.into()) < 1.0) == inside {
            return p.into();
        }
    }
}

/// Logarithmic places in the middle of the cells of an even grid of the scaled octant's angles.
fn nodes(count: usize) -> impl Iterator<Item = [f64; 2]> {
    let at =
        move |k: usize| ((k as f64 + 0.5) / count as f64 * std::f64::consts::FRAC_PI_2).tan().ln();
    (0..count * count).map(move |k| [at(k % count), at(k / count)])
}

/// The three best places of a fine grid that are nearer than their neighbours.
fn valleys(grid: &[Vector], p: &Vector) -> impl Iterator<Item = [f64; 2]> + use<> {
    let squared: Vec<f64> = grid.iter().map(|q| (q - p).norm_squared()).collect();
    let least = |k: &usize| {
        let (i, j) = (k / FINE, k % FINE);
        let around = [
            (i > 0).then(|| k - FINE),
            (i + 1 < FINE).then(|| k + FINE),
            (j > 0).then(|| k - 1),
            (j + 1 < FINE).then(|| k + 1),
        ];
        around.iter().flatten().all(|other| squared[*k] <= squared[*other])
    };
    let mut found: Vec<usize> = (0..squared.len()).filter(least).collect();
    found.sort_by(|a, b| squared[*a].total_cmp(&squared[*b]));
    found.truncate(3);
    let places: Vec<[f64; 2]> = nodes(FINE).collect();
    found.into_iter().map(move |k| places[k])
}

/// An octant of a superellipsoid, or of the outer or inner half of a toroid.
#[derive(Clone, Copy, Debug)]
struct Sheet {
    axes: [f64; 3],
    powers: [f64; 2],
    ring: f64,
    side: f64,
}

/// Both coordinates of a quarter of the unit superellipse with two derivatives by the logarithm of their ratio.
fn quarter(t: f64, p: f64) -> [[f64; 3]; 2] {
    let s = (-p * t.abs()).exp();
    let large = (-s.ln_1p() / p).exp();
    let small = large * (-t.abs()).exp();
    let (x, y) = if t > 0.0 { (small, large) } else { (large, small) };
    let major = 1.0 / (1.0 + s);
    let (wx, wy) = if t > 0.0 { (s * major, major) } else { (major, s * major) };
    [[x, -x * wy, x * wy * (wy - p * wx)], [y, y * wx, y * wx * (wx - p * wy)]]
}

impl Sheet {
    fn point(&self, [t, u]: [f64; 2]) -> Vector {
        let [[x, ..], [y, ..]] = quarter(t, self.powers[1]);
        let [[c, ..], [s, ..]] = quarter(u, self.powers[0]);
        let r = self.ring + self.side * c;
        Vector::new(r * x, r * y, s).component_mul(&Vector::from(self.axes))
    }

    /// The distance that a damped Newton's method reaches from a place.
    fn descend(&self, mut place: [f64; 2], p: &Vector) -> f64 {
        let (mut now, mut g, mut h) = self.derivatives(place, p);
        let mut damping = 0.0;
        for _ in 0..100 {
            // positive definite by the magnitudes of the eigenvalues
            let (mean, half) = (0.5 * (h[0] + h[2]), 0.5 * (h[0] - h[2]));
            let radius = half.hypot(h[1]).max(1e-300);
            let angle = 0.5 * h[1].atan2(half);
            let (c, s) = (angle.cos(), angle.sin());
            let weak = |v: f64| 1.0 / (v.abs().max(1e-9 * (mean.abs() + radius)) + damping);
            let along = (c * g[0] + s * g[1]) * weak(mean + radius);
            let across = (c * g[1] - s * g[0]) * weak(mean - radius);
            let step = [s * across - c * along, -s * along - c * across];
            let longest = step[0].abs().max(step[1].abs());
            let cut = if longest > 3.0 { 3.0 / longest } else { 1.0 };
            if longest.is_nan() || longest <= 1e-12 {
                break;
            }
            let next = [place[0] + cut * step[0], place[1] + cut * step[1]];
            let (trial, gradient, hessian) = self.derivatives(next, p);
            if trial <= now {
                let gain = now - trial;
                (place, now, g, h) = (next, trial, gradient, hessian);
                damping *= 0.1;
                if gain <= 1e-16 * now || next.iter().all(|v| v.abs() > 40.0) {
                    break;
                }
            } else {
                damping = (8.0 * damping).max(1e-3 * (h[0].abs() + h[2].abs()));
                if damping > 1e9 * (h[0].abs() + h[2].abs()) {
                    break;
                }
            }
        }
        now.sqrt()
    }

    /// The squared distance with half its first and second derivatives.
    fn derivatives(&self, [t, u]: [f64; 2], p: &Vector) -> (f64, [f64; 2], [f64; 3]) {
        let [x, y] = quarter(t, self.powers[1]);
        let [c, s] = quarter(u, self.powers[0]);
        let (r, dr, ddr) = (self.ring + self.side * c[0], self.side * c[1], self.side * c[2]);
        let scaled =
            |x: f64, y: f64, z: f64| Vector::new(x, y, z).component_mul(&Vector::from(self.axes));
        let e = scaled(r * x[0], r * y[0], s[0]) - p;
        let (by_t, by_u) = (scaled(r * x[1], r * y[1], 0.0), scaled(dr * x[0], dr * y[0], s[1]));
        let tt = by_t.norm_squared() + e.dot(&scaled(r * x[2], r * y[2], 0.0));
        let tu = by_t.dot(&by_u) + e.dot(&scaled(dr * x[1], dr * y[1], 0.0));
        let uu = by_u.norm_squared() + e.dot(&scaled(ddr * x[0], ddr * y[0], s[2]));
        (e.norm_squared(), [e.dot(&by_t), e.dot(&by_u)], [tt, tu, uu])
    }
}
