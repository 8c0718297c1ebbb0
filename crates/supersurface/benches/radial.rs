//! Nanoseconds a point for the radial distance to a superellipsoid with its eleven derivatives, on one core: the
//! formulas as they are written down, with a power in every term; by weights that share their powers; the library's
//! answer for one point, right for any input; and its columns.
//!
//! `cargo bench -p supersurface --bench radial`

#![allow(clippy::print_stdout, clippy::disallowed_methods)]

use cpu_time::ProcessTime;
use supersurface::numeric::random::Stream;
use supersurface::shape::superellipsoid::{Columns, Jacobians, PARAMETERS};
use supersurface::shape::{Posed, Superellipsoid};
use supersurface::{Point, Pose, Vector};

const POINTS: usize = 1_000_000;
/// Points in a call: all columns stay in the second cache.
const BATCH: usize = 1_000;
const RUNS: usize = 7;

fn main() {
    let mut random = Stream::new(1, 0);
    let mut between = |low: f64, high: f64| random.between(low, high);
    let shape = Superellipsoid::new([0.05, 0.03, 0.08], [0.4, 1.3]).unwrap();
    let pose = Pose::new(Vector::new(0.2, -0.1, 0.7), Vector::new(0.3, 1.0, -0.4));
    let body = Posed::new(shape, pose).unwrap();
    let place = |_| pose * Point::from([0; 3].map(|_| between(-0.1, 0.1)));
    let points: Vec<Point> = (0..POINTS).map(place).collect();
    let column = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
    let columns = [column(0), column(1), column(2)];

    let plain = fastest(|| points.iter().map(|p| sum(&differentiated(&body, p))).sum());
    let weights = fastest(|| points.iter().map(|p| sum(&by_weights(&body, p))).sum());
    let gauge = fastest(|| points.iter().map(|p| sum(&body.radial_jacobian(p))).sum());
    // the written ones have no number where a weight is 0
    for p in points.iter().take(1000) {
        let (r, row) = body.radial_jacobian(p);
        for (other, others) in [differentiated(&body, p), by_weights(&body, p)] {
            assert!((r - other).abs() < 1e-12);
            assert!(
                row.iter()
                    .zip(others)
                    .all(|(a, b)| b.is_nan() || (a - b).abs() < 1e-9 * (1.0 + a.abs()))
            );
        }
    }
    let mut out = Jacobians::default();
    let batched = fastest(|| {
        let mut total = 0.0;
        for at in (0..POINTS).step_by(BATCH) {
            let [x, y, z] = columns.each_ref().map(|c| &c[at..at + BATCH]);
            body.radial_jacobians(&Columns { x, y, z }, &mut out);
            total += out.residuals[0] + out.columns[PARAMETERS - 1][BATCH - 1];
        }
        total
    });
    let line = |what: &str, time: f64| {
        println!("{what:24} {time:6.1} ns a point   {:5.1} times as fast", plain / time);
    };
    line("plain, powf in each term", plain);
    line("by weights, shared powf", weights);
    line("one point, any input", gauge);
    line("columns", batched);
}

fn sum((residual, row): &(f64, [f64; PARAMETERS])) -> f64 {
    residual + row[0] + row[PARAMETERS - 1]
}

/// CPU nanoseconds a point, the best of some runs.
fn fastest(mut work: impl FnMut() -> f64) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let began = ProcessTime::now();
        std::hint::black_box(work());
        best = best.min(began.elapsed().as_secs_f64());
    }
    1e9 * best / POINTS as f64
}

/// Equation 9 and its derivatives as they are written, each term with its own power: the plain version.
fn differentiated(body: &Posed<Superellipsoid>, p: &Point) -> (f64, [f64; PARAMETERS]) {
    let q = body.to_local(p);
    let a = body.shape().semi_axes();
    let [e1, e2] = body.shape().exponents();
    let [x, y, z]: [f64; 3] = std::array::from_fn(|i| (q[i] / a[i]).abs());
    let planar = x.powf(2.0 / e2) + y.powf(2.0 / e2);
    let f = planar.powf(e2 / e1) + z.powf(2.0 / e1);
    let beta = f.powf(-0.5 * e1);
    let length = q.coords.norm();
    let outer = e2 / e1 * planar.powf(e2 / e1 - 1.0);
    let by_ratio = [
        outer * 2.0 / e2 * x.powf(2.0 / e2 - 1.0),
        outer * 2.0 / e2 * y.powf(2.0 / e2 - 1.0),
        2.0 / e1 * z.powf(2.0 / e1 - 1.0),
    ];
    let spread = x.powf(2.0 / e2) * x.ln() + y.powf(2.0 / e2) * y.ln();
    let by_e1 = -planar.powf(e2 / e1) * planar.ln() * e2 / (e1 * e1)
        - z.powf(2.0 / e1) * z.ln() * 2.0 / (e1 * e1);
    let by_e2 = planar.powf(e2 / e1) * planar.ln() / e1 - outer * spread * 2.0 / (e2 * e2);
    // r = |q| (1 - F^(-e1/2))
    let slope = 0.5 * e1 * length * f.powf(-0.5 * e1 - 1.0);
    let by_q = Vector::from_fn(|i, _| {
        q[i] / length * (1.0 - beta) + slope * by_ratio[i] * q[i].signum() / a[i]
    });
    let by_position = -(body.pose().rotation * by_q);
    let by_rotation = by_q.cross(&q.coords);
    let mut row = [0.0; PARAMETERS];
    for (i, ratio) in [x, y, z].into_iter().enumerate() {
        row[i] = -slope * by_ratio[i] * ratio / a[i];
        row[5 + i] = by_position[i];
        row[8 + i] = by_rotation[i];
    }
    row[3] = slope * by_e1 + 0.5 * length * f.powf(-0.5 * e1) * f.ln();
    row[4] = slope * by_e2;
    (length * (1.0 - beta), row)
}

/// The same by the weights of FORMULAS §7.3, which share their powers.
fn by_weights(body: &Posed<Superellipsoid>, p: &Point) -> (f64, [f64; PARAMETERS]) {
    let q = body.to_local(p);
    let [a1, a2, a3] = body.shape().semi_axes();
    let [e1, e2] = body.shape().exponents();
    let (x, y, z) = ((q.x / a1).abs(), (q.y / a2).abs(), (q.z / a3).abs());
    let (fx, fy, fz) = (x.powf(2.0 / e2), y.powf(2.0 / e2), z.powf(2.0 / e1));
    let planar = fx + fy;
    let across = planar.powf(e2 / e1);
    let f = across + fz;
    let beta = f.powf(-0.5 * e1);
    let length = q.coords.norm();
    let scale = length * beta;
    let (w1, w2) = (across / f, fx / planar);
    let shares = [w1 * w2, w1 * (1.0 - w2), 1.0 - w1];
    let by_q: Vector =
        q.coords * ((1.0 - beta) / length) + Vector::from_fn(|i, _| scale * shares[i] / q[i]);
    let entropy = |w: f64| -w * w.ln() - (1.0 - w) * (1.0 - w).ln();
    let by_position = -(body.pose().rotation * by_q);
    let by_rotation = by_q.cross(&q.coords);
    let mut row = [0.0; PARAMETERS];
    for (i, a) in [a1, a2, a3].into_iter().enumerate() {
        row[i] = -scale * shares[i] / a;
        row[5 + i] = by_position[i];
        row[8 + i] = by_rotation[i];
    }
    row[3] = 0.5 * scale * entropy(w1);
    row[4] = 0.5 * scale * w1 * entropy(w2);
    (length - scale, row)
}
