//! Normal equations of weighted residuals: what they add up to, and the damped step that they ask for.

use super::columns::Evaluation;
use super::parameters::{COUNT, Family, Parameters, Row};
use crate::numeric::lanes::{Job, Lane, WIDEST, dispatch, fused};

/// Parameters that may move at once, at most: those of a tapered and bent body.
const FREE: usize = 15;
/// Columns by which a pair of rows is multiplied at once: two values then serve eight products.
const TILE: usize = 4;
/// Sums of a row: its products with the distances and with the columns up to its own, in whole tiles.
const ROW: usize = (FREE + 1).next_multiple_of(TILE);

/// The sums of a row, lane by lane.
pub(super) type Sums<L> = [[L; WIDEST]; ROW];

/// The normal equations that a set of weighted rows adds up to: `½ Σ w r²` and its derivatives.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    /// `Jᵀ W J`, of which only the lower triangle is kept.
    pub(super) matrix: [[f64; COUNT]; COUNT],
    /// `Jᵀ W r`.
    pub(super) gradient: Row,
    pub(super) cost: f64,
}

/// What weighted residuals add up to: the normal equations, or their cost alone.
pub(super) trait Sum {
    /// False where rows are not looked at.
    const ROWS: bool;
    /// Adds `½ w r²`.
    fn add(&mut self, residual: f64, weight: f64, row: &Row);
    /// Adds a cost of some slope along the parameters.
    fn add_slope(&mut self, cost: f64, row: &Row);
}

impl Sum for Normal {
    const ROWS: bool = true;

    #[inline]
    fn add(&mut self, residual: f64, weight: f64, row: &Row) {
        self.cost += 0.5 * weight * residual * residual;
        // most terms speak of few parameters
        for i in (0..COUNT).filter(|i| row[*i] != 0.0) {
            let wi = weight * row[i];
            self.gradient[i] += wi * residual;
            for (entry, value) in self.matrix[i].iter_mut().zip(&row[..=i]) {
                *entry += wi * value;
            }
        }
    }

    fn add_slope(&mut self, cost: f64, row: &Row) {
        self.cost += cost;
        self.gradient.iter_mut().zip(row).for_each(|(sum, slope)| *sum += slope);
    }
}

impl Sum for f64 {
    const ROWS: bool = false;

    #[inline]
    fn add(&mut self, residual: f64, weight: f64, _row: &Row) {
        *self += 0.5 * weight * residual * residual;
    }

    fn add_slope(&mut self, cost: f64, _row: &Row) {
        *self += cost;
    }
}

impl Normal {
    pub(super) const fn zero() -> Self {
        Self { matrix: [[0.0; COUNT]; COUNT], gradient: [0.0; COUNT], cost: 0.0 }
    }

    /// `Jᵀ W J` and `Jᵀ W d` of points, without the cost; `sums` is a buffer.
    pub(super) fn of_points<L: Lane>(
        family: Family,
        evaluation: &Evaluation<L>,
        weights: &[L],
        sums: &mut Vec<Sums<L>>,
    ) -> Self {
        let mut columns: [&[L]; FREE] = [&[]; FREE];
        let mut own = [0; FREE];
        let mut n = 0;
        for i in (0..COUNT).filter(|i| family.has(*i)) {
            (own[n], columns[n]) = (i, &evaluation.rows[i]);
            n += 1;
        }
        let (columns, distances) = (&columns[..n], &evaluation.distances[..]);
        sums.resize(n, [[L::of(0.0); WIDEST]; ROW]);
        let mut totals = [[0.0; ROW]; FREE];
        dispatch(Accumulate { columns, distances, weights, sums, totals: &mut totals });
        let mut normal = Self::zero();
        for ((j, i), row) in own[..n].iter().enumerate().zip(&totals) {
            normal.gradient[*i] = row[0];
            for (k, sum) in own[..=j].iter().zip(&row[1..]) {
                normal.matrix[*i][*k] = *sum;
            }
        }
        normal
    }

    /// By how much a step lowers the cost, if this is as curved as the equations say: `-½ bᵀ s`.
    pub(super) fn promise(&self, step: &Row) -> f64 {
        -0.5 * self.gradient.iter().zip(step).map(|(b, s)| b * s).sum::<f64>()
    }

    /// The damped step `-(H + λ diag H)⁻¹ b` over the parameters that may move; `None` when the matrix is not
    /// positive definite.
    pub(super) fn step(&self, s: &Parameters, damping: f64) -> Option<Row> {
        let mut free = [0; FREE];
        let mut n = 0;
        for i in (0..COUNT).filter(|i| s.family.has(*i) && !s.is_held(*i, self.gradient[*i])) {
            free[n] = i;
            n += 1;
        }
        let mut rows = [[0.0; FREE + 1]; FREE];
        for (j, i) in free[..n].iter().enumerate() {
            for (k, other) in free[..n].iter().enumerate() {
                rows[j][k] = self.matrix[*i.max(other)][*i.min(other)];
            }
            rows[j][j] += damping * rows[j][j] + 1e-3;
            rows[j][FREE] = -self.gradient[*i];
        }
        let mut regular = false;
        dispatch(Solve { rows: &mut rows, n, regular: &mut regular });
        let mut step = [0.0; COUNT];
        for (i, row) in free[..n].iter().zip(&rows) {
            step[*i] = row[FREE];
        }
        regular.then_some(step)
    }
}

/// Sums of products over points, lane by lane: those of each column with the distances and with the columns up to its own.
struct Accumulate<'a, L> {
    columns: &'a [&'a [L]],
    distances: &'a [L],
    weights: &'a [L],
    sums: &'a mut [Sums<L>],
    totals: &'a mut [[f64; ROW]; FREE],
}

impl<L: Lane> Job for Accumulate<'_, L> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let last = self.columns.len() - 1;
        for (pair, rows) in self.sums.chunks_mut(2).enumerate() {
            // past the end any column stands in
            let own = [2 * pair, 2 * pair + 1].map(|j| self.columns[j.min(last)]);
            for t in 0..(2 * pair + 2).min(self.columns.len()) / TILE + 1 {
                let other = |k: usize| match t * TILE + k {
                    0 => self.distances,
                    k => self.columns[(k - 1).min(last)],
                };
                let tile = [other(0), other(1), other(2), other(3)];
                let found = products::<FUSED, L>(self.weights, own, tile);
                for (row, found) in rows.iter_mut().zip(found) {
                    for (sum, found) in row[t * TILE..(t + 1) * TILE].iter_mut().zip(found) {
                        *sum = found;
                    }
                }
            }
        }
        for (j, (row, totals)) in self.sums.iter().zip(self.totals).enumerate() {
            for (sum, total) in row[..j + 2].iter().zip(totals) {
                *total = lane_sum(sum);
            }
        }
    }
}

/// `Σ w a b` of two columns `a` and some `b`, lane by lane.
#[inline(always)]
fn products<const FUSED: bool, L: Lane>(
    weights: &[L],
    own: [&[L]; 2],
    tile: [&[L]; TILE],
) -> [[[L; WIDEST]; TILE]; 2] {
    let mut found = [[[L::of(0.0); WIDEST]; TILE]; 2];
    let rows = own[0].chunks_exact(L::WIDTH).zip(own[1].chunks_exact(L::WIDTH));
    let pairs = tile[0].chunks_exact(L::WIDTH).zip(tile[1].chunks_exact(L::WIDTH));
    let others = tile[2].chunks_exact(L::WIDTH).zip(tile[3].chunks_exact(L::WIDTH));
    let blocks = weights.chunks_exact(L::WIDTH).zip(rows).zip(pairs.zip(others));
    for ((w, (a0, a1)), ((b0, b1), (b2, b3))) in blocks {
        for i in 0..L::WIDTH {
            let (first, second) = (w[i] * a0[i], w[i] * a1[i]);
            found[0][0][i] = first.times_plus::<FUSED>(b0[i], found[0][0][i]);
            found[0][1][i] = first.times_plus::<FUSED>(b1[i], found[0][1][i]);
            found[0][2][i] = first.times_plus::<FUSED>(b2[i], found[0][2][i]);
            found[0][3][i] = first.times_plus::<FUSED>(b3[i], found[0][3][i]);
            found[1][0][i] = second.times_plus::<FUSED>(b0[i], found[1][0][i]);
            found[1][1][i] = second.times_plus::<FUSED>(b1[i], found[1][1][i]);
            found[1][2][i] = second.times_plus::<FUSED>(b2[i], found[1][2][i]);
            found[1][3][i] = second.times_plus::<FUSED>(b3[i], found[1][3][i]);
        }
    }
    found
}

/// Sum of a block, by halves.
#[inline(always)]
fn lane_sum<L: Lane>(lanes: &[L; WIDEST]) -> f64 {
    let mut sums = *lanes;
    let mut half = L::WIDTH / 2;
    while half > 0 {
        for i in 0..half {
            let other = sums[i + half];
            sums[i] += other;
        }
        half /= 2;
    }
    sums[0].wide()
}

/// Elimination in a positive definite system of `n` rows; the right side is in the last column, where the result is left.
struct Solve<'a> {
    rows: &'a mut [[f64; FREE + 1]; FREE],
    n: usize,
    regular: &'a mut bool,
}

impl Job for Solve<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let n = self.n.min(FREE);
        let mut inverses = [0.0; FREE];
        for k in 0..n {
            let pivot = self.rows[k];
            if !(pivot[k] > 0.0 && pivot[k].is_finite()) {
                return;
            }
            inverses[k] = 1.0 / pivot[k];
            for row in &mut self.rows[k + 1..n] {
                let factor = -row[k] * inverses[k];
                for i in 0..FREE + 1 {
                    row[i] = fused::<FUSED>(factor, pivot[i], row[i]);
                }
            }
        }
        for k in (0..n).rev() {
            let x = self.rows[k][FREE] * inverses[k];
            self.rows[k][FREE] = x;
            for row in &mut self.rows[..k] {
                row[FREE] -= row[k] * x;
            }
        }
        *self.regular = true;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::Vector;
    use crate::fit::columns::Sample;
    use crate::fit::columns::tests::some_body;
    use crate::numeric::random::Stream;

    fn check_sums<L: Lane>(s: &Parameters, points: &[Vector], error: f64) {
        let mut at = Evaluation::<L>::default();
        at.fill(s, &Sample::new(points.iter().copied()));
        let weights: Vec<L> = (0..at.distances.len())
            .map(|i| L::of(if i < points.len() { 0.5 + (i % 7) as f64 } else { 0.0 }))
            .collect();
        let found = Normal::of_points(s.family, &at, &weights, &mut Vec::new());
        let mut known = Normal::zero();
        for (i, weight) in weights.iter().enumerate().take(points.len()) {
            known.add(at.distances[i].wide(), weight.wide(), &at.row(s, i));
        }
        let scale = (0..COUNT).map(|i| known.matrix[i][i]).fold(1.0, f64::max);
        for i in 0..COUNT {
            assert!((found.gradient[i] - known.gradient[i]).abs() < error * scale);
            for j in 0..=i {
                let (found, known) = (found.matrix[i][j], known.matrix[i][j]);
                assert!((found - known).abs() < error * scale, "{i} {j}: {found} {known}");
            }
        }
    }

    #[test]
    fn sums_are_those_of_single_points() {
        let mut random = Stream::new(21, 0);
        for case in 0..60 {
            let s = some_body(Family::ALL[case % 6], &mut random);
            let points: Vec<Vector> = (0..1 + 7 * case)
                .map(|_| s.position + Vector::from_fn(|_, _| random.between(-1.0, 1.0)))
                .collect();
            check_sums::<f64>(&s, &points, 1e-12);
            check_sums::<f32>(&s, &points, 1e-4);
        }
    }

    #[test]
    fn a_step_solves_the_equations() {
        let mut random = Stream::new(22, 0);
        for case in 0..120 {
            let s = some_body(Family::ALL[case % 6], &mut random);
            let mut normal = Normal::zero();
            for _ in 0..40 {
                let row =
                    std::array::from_fn(|k| if s.family.has(k) { random.normal() } else { 0.0 });
                normal.add(random.normal(), random.uniform(), &row);
            }
            let step = normal.step(&s, 0.01).unwrap();
            let free: Vec<usize> = (0..COUNT)
                .filter(|i| s.family.has(*i) && !s.is_held(*i, normal.gradient[*i]))
                .collect();
            let matrix = DMatrix::from_fn(free.len(), free.len(), |j, k| {
                let (i, other) = (free[j].max(free[k]), free[j].min(free[k]));
                let entry = normal.matrix[i][other];
                if j == k { 1.01 * entry + 1e-3 } else { entry }
            });
            let right = DVector::from_fn(free.len(), |j, _| -normal.gradient[free[j]]);
            let known = matrix.cholesky().unwrap().solve(&right);
            for (j, i) in free.iter().enumerate() {
                assert!((step[*i] - known[j]).abs() < 1e-9 * known.amax().max(1.0), "{case}");
            }
            normal.matrix[0][0] = -1.0;
            assert!(normal.step(&s, 0.01).is_none());
        }
    }
}
