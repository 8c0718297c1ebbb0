//! The kernel over many points: columns in, columns out, a block of points at a time without a branch.

use super::kernel::{
    BENT, Block, DERIVATIVES, DISTANCES, NORMALS, RINGED, TAPERED, TWISTED, evaluate,
};
use super::parameters::{COUNT, Family, POSITION, Parameters, ROTATION, Row};
use crate::Vector;
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Points as columns, padded with far points to a multiple of [`Lane::WIDTH`].
#[derive(Debug, Default)]
pub(super) struct Sample<L = f64> {
    columns: [Column<L>; 3],
    count: usize,
    /// Unit directions in which sensors saw the points, zero for the padding; none where that is not known.
    rays: [Column<L>; 3],
}

/// Where padding stands: far from any body in normalised coordinates.
const PADDING: f64 = 50.0;

impl<L: Lane> Sample<L> {
    pub(super) fn new(points: impl Iterator<Item = Vector>) -> Self {
        let mut sample = Self::default();
        sample.set(points);
        sample
    }

    /// Points and the directions in which they were seen.
    pub(super) fn seen(seen: impl Iterator<Item = (Vector, Vector)>) -> Self {
        let mut sample = Self::default();
        sample.set_seen(seen);
        sample
    }

    /// Takes other points with the directions in which they were seen.
    pub(super) fn set_seen(&mut self, seen: impl Iterator<Item = (Vector, Vector)>) {
        self.columns.iter_mut().chain(&mut self.rays).for_each(Column::clear);
        for (p, ray) in seen {
            for k in 0..3 {
                self.columns[k].push(L::of(p[k]));
                self.rays[k].push(L::of(ray[k]));
            }
        }
        self.pad();
        self.rays.iter_mut().for_each(|ray| ray.resize(self.columns[0].len(), L::of(0.0)));
    }

    /// Takes the points of another sample, each moved along its ray by its way.
    pub(super) fn set_along(&mut self, from: &Self, ways: &[L]) {
        self.count = from.count;
        for ((column, start), ray) in self.columns.iter_mut().zip(&from.columns).zip(&from.rays) {
            column.resize(start.len(), L::of(0.0));
            let moved = start.iter().zip(ray).zip(ways).map(|((x, r), way)| *x + *r * *way);
            column.iter_mut().zip(moved).for_each(|(place, x)| *place = x);
        }
    }

    /// Unit directions in which sensors saw the points; none where that is not known.
    pub(super) const fn rays(&self) -> &[Column<L>; 3] {
        &self.rays
    }

    /// True where these directions are known.
    pub(super) fn has_rays(&self) -> bool {
        !self.rays[0].is_empty()
    }

    /// Such a direction; they must be known.
    pub(super) fn ray(&self, i: usize) -> Vector {
        Vector::from_fn(|k, _| self.rays[k][i].wide())
    }

    /// Takes other points, of which no directions are known.
    pub(super) fn set(&mut self, points: impl Iterator<Item = Vector>) {
        let [x, y, z] = &mut self.columns;
        for column in [&mut *x, y, z] {
            column.clear();
        }
        for p in points {
            x.push(L::of(p.x));
            y.push(L::of(p.y));
            z.push(L::of(p.z));
        }
        self.rays.iter_mut().for_each(Column::clear);
        self.pad();
    }

    fn pad(&mut self) {
        self.count = self.columns[0].len();
        let padded = self.count.next_multiple_of(L::WIDTH);
        self.columns.iter_mut().for_each(|column| column.resize(padded, L::of(PADDING)));
    }

    /// Coordinates, padded.
    pub(super) fn columns(&self) -> [&[L]; 3] {
        self.columns.each_ref().map(|column| &**column)
    }

    /// Number of points without padding.
    pub(super) const fn len(&self) -> usize {
        self.count
    }

    pub(super) fn point(&self, i: usize) -> Vector {
        Vector::from_fn(|k, _| self.columns[k][i].wide())
    }

    pub(super) fn points(&self) -> impl Iterator<Item = Vector> + '_ {
        (0..self.count).map(|i| self.point(i))
    }
}

/// First-order distances and their derivatives, a column a parameter; padded like the sample. Columns of parameters
/// that the family lacks hold nothing of use.
#[derive(Debug, Default)]
pub(super) struct Evaluation<L = f64> {
    pub(super) distances: Column<L>,
    pub(super) rows: [Column<L>; COUNT],
}

impl<L: Lane> Evaluation<L> {
    /// Distances and derivatives of all points of `sample`.
    pub(super) fn fill(&mut self, s: &Parameters, sample: &Sample<L>) {
        self.make_room(sample, |k| s.family.has(k));
        self.run::<DERIVATIVES>(s, sample);
    }

    /// Distances and normals.
    pub(super) fn fill_normals(&mut self, s: &Parameters, sample: &Sample<L>) {
        self.make_room(sample, |k| (POSITION..ROTATION).contains(&k));
        self.run::<NORMALS>(s, sample);
    }

    /// Distances alone.
    pub(super) fn fill_distances(&mut self, s: &Parameters, sample: &Sample<L>) {
        self.make_room(sample, |_| false);
        self.run::<DISTANCES>(s, sample);
    }

    fn make_room(&mut self, sample: &Sample<L>, needs: impl Fn(usize) -> bool) {
        let padded = sample.columns[0].len();
        self.distances.resize(padded, L::of(0.0));
        for (_, row) in self.rows.iter_mut().enumerate().filter(|(k, _)| needs(*k)) {
            row.resize(padded, L::of(0.0));
        }
    }

    fn run<const WHAT: u8>(&mut self, s: &Parameters, sample: &Sample<L>) {
        const TAPERED_BENT: u8 = TAPERED | BENT;
        let out = self;
        match s.family {
            Family::Superellipsoid => dispatch(Fill::<0, WHAT, L> { s, sample, out }),
            Family::Supertoroid => dispatch(Fill::<RINGED, WHAT, L> { s, sample, out }),
            Family::Tapered => dispatch(Fill::<TAPERED, WHAT, L> { s, sample, out }),
            Family::Bent => dispatch(Fill::<BENT, WHAT, L> { s, sample, out }),
            Family::Twisted => dispatch(Fill::<TWISTED, WHAT, L> { s, sample, out }),
            Family::TaperedBent => dispatch(Fill::<TAPERED_BENT, WHAT, L> { s, sample, out }),
        }
    }

    /// The direction in which the distance of a point grows fastest: the outward normal but for what the surface's
    /// curvature turns it on the way to the point.
    pub(super) fn outwards(&self, i: usize) -> Vector {
        -Vector::from_fn(|k, _| self.rows[POSITION + k][i].wide())
    }

    /// The derivatives at one point.
    pub(super) fn row(&self, s: &Parameters, i: usize) -> Row {
        std::array::from_fn(|k| if s.family.has(k) { self.rows[k][i].wide() } else { 0.0 })
    }
}

/// First-order distances of points in normalised coordinates.
pub(super) fn distances(s: &Parameters, points: impl Iterator<Item = Vector>) -> Vec<f64> {
    let sample = Sample::<f64>::new(points);
    let mut evaluation = Evaluation::default();
    evaluation.fill_distances(s, &sample);
    evaluation.distances[..sample.len()].to_vec()
}

struct Fill<'a, const PARTS: u8, const WHAT: u8, L> {
    s: &'a Parameters,
    sample: &'a Sample<L>,
    out: &'a mut Evaluation<L>,
}

impl<const PARTS: u8, const WHAT: u8, L: Lane> Job for Fill<'_, PARTS, WHAT, L> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, z] = &self.sample.columns;
        let blocks = x.chunks_exact(L::WIDTH).zip(y.chunks_exact(L::WIDTH));
        let blocks = blocks.zip(z.chunks_exact(L::WIDTH)).enumerate();
        let mut block = Block::new();
        for (b, ((x, y), z)) in blocks {
            evaluate::<FUSED, PARTS, WHAT, L>(self.s, [x, y, z], &mut block);
            let at = b * L::WIDTH..(b + 1) * L::WIDTH;
            self.out.distances[at.clone()].copy_from_slice(&block.distance[..L::WIDTH]);
            let wanted = |k: usize| match WHAT {
                DISTANCES => false,
                NORMALS => (POSITION..ROTATION).contains(&k),
                _ => self.s.family.has(k),
            };
            for (k, (column, values)) in self.out.rows.iter_mut().zip(&block.rows).enumerate() {
                if wanted(k) {
                    column[at.clone()].copy_from_slice(&values[..L::WIDTH]);
                }
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::Point;
    use crate::fit::centred::Placement;
    use crate::fit::pull_back::unbend;
    use crate::numeric::random::Stream;
    use crate::shape::Implicit;
    use nalgebra::Rotation3;

    /// A body with parameters from everywhere.
    pub(in crate::fit) fn some_body(family: Family, random: &mut Stream) -> Parameters {
        let mut s = Parameters {
            log_axes: std::array::from_fn(|_| random.between(-0.8, 0.3)),
            ring: random.between(1.3, 4.0),
            exponents: std::array::from_fn(|_| random.between(0.25, 1.8)),
            position: Vector::from_fn(|_, _| random.between(-0.2, 0.2)),
            rotation: Rotation3::new(Vector::from_fn(|_, _| random.normal())),
            taper: std::array::from_fn(|_| random.between(-0.7, 0.7)),
            twist: random.between(-0.3, 0.3),
            ..Parameters::ball(family)
        };
        let reach = s.log_axes.iter().map(|a| a.exp()).fold(0.0, f64::max);
        s.bend = std::array::from_fn(|_| random.between(-0.4, 0.4) / reach);
        s
    }

    /// False for points that no taper reaches: they are far outside and have no say.
    fn is_reached(s: &Parameters, x: &Vector) -> bool {
        let q = s.rotation.inverse_transform_vector(&(x - s.position)).into();
        let z =
            if s.family.is_bent() { unbend::<false, f64>(&q, &s.bend).0.point[2] } else { q[2] };
        let factor = |k: &f64| 1.0 + k * z / s.log_axes[2].exp();
        !s.family.is_tapered() || s.taper.iter().all(|k| factor(k) > 0.11)
    }

    #[test]
    fn distances_are_those_of_the_shapes() {
        let mut random = Stream::new(5, 0);
        let mut seen = 0;
        for case in 0..600 {
            let s = some_body(Family::ALL[case % 6], &mut random);
            let Ok(surface) = s.surface(&Placement::identity()) else { continue };
            let points = (0..21).map(|_| Vector::from_fn(|_, _| random.between(-1.5, 1.5)));
            let sample = Sample::<f64>::new(points);
            let mut all = Evaluation::default();
            all.fill_distances(&s, &sample);
            for (x, d) in sample.points().zip(&all.distances) {
                let expected = surface.first_order_distance(&Point::from(x));
                if d.abs() < 1.0 && is_reached(&s, &x) {
                    seen += 1;
                    assert!((d - expected).abs() < 1e-9, "case {case}: {d} is not {expected}");
                }
            }
        }
        assert!(seen > 5000, "{seen}");
    }

    /// Where a ring's section has no thickness, or a bend's centre lies, rounding decides.
    #[test]
    fn single_precision_says_the_same() {
        let mut random = Stream::new(6, 0);
        let (mut seen, mut off) = (0, 0);
        for case in 0..600 {
            let s = some_body(Family::ALL[case % 6], &mut random);
            let points: Vec<Vector> =
                (0..32).map(|_| Vector::from_fn(|_, _| random.between(-1.5, 1.5))).collect();
            let (mut wide, mut narrow) =
                (Evaluation::<f64>::default(), Evaluation::<f32>::default());
            wide.fill(&s, &Sample::new(points.iter().copied()));
            narrow.fill(&s, &Sample::new(points.iter().copied()));
            for i in
                (0..32).filter(|i| wide.distances[*i].abs() < 0.7 && is_reached(&s, &points[*i]))
            {
                let row = wide.row(&s, i).into_iter().zip(narrow.row(&s, i));
                let apart = row.map(|(a, b)| (a - b).abs() / (1.0 + a.abs())).fold(0.0, f64::max);
                let apart = apart.max((wide.distances[i] - f64::from(narrow.distances[i])).abs());
                assert!(apart.is_finite());
                seen += 1;
                off += usize::from(apart > 1e-4);
            }
        }
        assert!(seen > 5000 && off * 200 < seen, "{off} of {seen}");
    }

    /// Centres, symmetry planes and places far outside are numbers too.
    #[test]
    fn every_place_has_a_finite_row() {
        fn check<L: Lane>(s: &Parameters, places: &[Vector]) {
            let mut all = Evaluation::<L>::default();
            all.fill(s, &Sample::new(places.iter().copied()));
            for (i, place) in places.iter().enumerate() {
                let sound = all.row(s, i).iter().all(|v| v.is_finite());
                assert!(sound && all.distances[i].wide().is_finite(), "{s:?} at {place}");
            }
        }
        let mut random = Stream::new(7, 0);
        for case in 0..600 {
            let mut s = some_body(Family::ALL[case % 6], &mut random);
            if case % 2 == 0 {
                s.exponents =
                    std::array::from_fn(|_| if random.uniform() < 0.5 { 0.05 } else { 1.99 });
            }
            let axes = [1e-9, 0.5, 50.0].map(|r| Vector::from_fn(|_, _| r * random.normal()));
            let along = |k: usize| s.position + s.rotation * Vector::ith(k, random.normal());
            let mut places: Vec<Vector> = axes.into_iter().chain([s.position]).collect();
            places.extend((0..3).map(along));
            check::<f64>(&s, &places);
            check::<f32>(&s, &places);
        }
    }

    #[test]
    fn the_derivative_is_complete() {
        let mut random = Stream::new(3, 0);
        let mut seen = 0;
        for case in 0..1200 {
            let s = some_body(Family::ALL[case % 6], &mut random);
            let sample = Sample::<f64>::new(
                (0..8).map(|_| Vector::from_fn(|_, _| random.between(-2.0, 2.0))),
            );
            let mut at = Evaluation::default();
            at.fill(&s, &sample);
            let (h, mut sides) = (1e-6, [Evaluation::default(), Evaluation::default()]);
            for k in (0..COUNT).filter(|k| s.family.has(*k)) {
                for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                    let mut step = [0.0; COUNT];
                    step[k] = sign * h;
                    side.fill_distances(&s.stepped(&step), &sample);
                }
                for i in (0..8)
                    .filter(|i| at.distances[*i].abs() < 0.7 && is_reached(&s, &sample.point(*i)))
                {
                    let numeric = (sides[0].distances[i] - sides[1].distances[i]) / (2.0 * h);
                    let analytic = at.rows[k][i];
                    let error = (numeric - analytic).abs() / (1.0 + analytic.abs());
                    assert!(error < 2e-4, "case {case} parameter {k}: {numeric} not {analytic}");
                    seen += 1;
                }
            }
        }
        assert!(seen > 20_000, "{seen}");
    }
}
