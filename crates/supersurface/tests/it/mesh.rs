//! Meshes of all closed parametric shapes: closed, outward, within their tolerance of the surface at random points,
//! with the volume of the solid.

use supersurface::combine::{Alpha, CombinedSolid};
use supersurface::deform::{Bend, Cavity, Deformed, ShearBend, Taper, Twist};
use supersurface::measure::ClosestFinder;
use supersurface::mesh::{MarchOptions, Mesh, Resolution, march, tessellate};
use supersurface::numeric::random::Stream;
use supersurface::shape::{
    ExtendedSuperellipsoid, Implicit, Parametric, SeparableSuperquadric, Supercone, Supercylinder,
    Superellipsoid, Superformula, Supershape, Supertoroid,
};
use supersurface::{Point, Vector};

/// Random points of each mesh.
const POINTS: usize = if cfg!(debug_assertions) { 1_000 } else { 10_000 };
const EXPONENTS: [f64; 6] = [0.1, 0.3, 1.0, 1.5, 1.9, 2.5];
const AXES: [[f64; 3]; 4] =
    [[1.0, 1.0, 1.0], [1.0, 0.7, 0.01], [0.01, 0.01, 1.0], [0.05, 1.0, 0.3]];

/// All pairs of exponents, with their number.
fn pairs() -> impl Iterator<Item = (usize, [f64; 2])> {
    EXPONENTS.into_iter().flat_map(|e1| EXPONENTS.map(|e2| [e1, e2])).enumerate()
}

/// Unit vectors spread over the sphere.
fn directions() -> Vec<Vector> {
    let turn = |i: u32| {
        let z = (f64::from(i) + 0.5) / 1000.0 - 1.0;
        let (sin, cos) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector::new(r * cos, r * sin, z)
    };
    (0..2000).map(turn).collect()
}

/// An upper bound of the distance of a point from the surface, in `reach`es: the length of a step along the normal,
/// or else into any direction, that changes sides; infinite when there is none.
fn steps_to(shape: &dyn Implicit, p: &Point, n: &Vector, reach: f64, all: &[Vector]) -> f64 {
    let inside = shape.contains(p);
    let crosses = |d: &Vector, k: f64| shape.contains(&(p + d * (k * reach))) != inside;
    let along = [1e-3, 0.1, 0.5, 1.0].into_iter().find(|k| crosses(n, *k) || crosses(&-n, *k));
    let lengths = [0.5, 0.7, 0.8, 0.9, 1.0, 1.5, 2.0, 3.0, 4.0];
    let anywhere = || lengths.into_iter().find(|k| all.iter().any(|d| crosses(d, *k)));
    along.or_else(anywhere).unwrap_or(f64::INFINITY)
}

/// What a mesh has to be.
struct Expected {
    volume: f64,
    euler: i64,
}

impl Expected {
    fn new(volume: f64, euler: i64) -> Self {
        Self { volume, euler }
    }
}

/// `exact` may know distances from the surface.
fn check(
    shape: &(impl Parametric + Implicit),
    expected: &Expected,
    name: &str,
    exact: impl Fn(&Point) -> Option<f64>,
) {
    let found = tessellate(shape, None).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mesh = &found.mesh;
    is_closed(mesh, expected, name);
    assert!(found.distance <= found.tolerance, "{name}");
    let (mut stream, sampler, all) = (Stream::new(4, 0), mesh.sampler(), directions());
    let (mut worst, mut outward) = (0.0f64, 0);
    for _ in 0..POINTS {
        let (p, n) = sampler.sample_at(std::array::from_fn(|_| stream.uniform())).unwrap();
        let exact = exact(&p).map(|d| d.abs() / found.tolerance);
        worst = worst.max(exact.unwrap_or_else(|| steps_to(shape, &p, &n, found.tolerance, &all)));
        outward += usize::from(shape.gradient(&p).dot(&n) >= 0.0);
    }
    assert!(worst <= 1.0, "{name}: {worst} tolerances from the surface");
    assert!(outward > POINTS - POINTS / 200, "{name}: {outward} of {POINTS} outwards");
}

fn is_closed(mesh: &Mesh, expected: &Expected, name: &str) {
    assert!(mesh.is_watertight(), "{name}");
    assert_eq!(mesh.euler_characteristic(), expected.euler, "{name}");
    let off = mesh.volume() / expected.volume - 1.0;
    assert!(off.abs() < 1e-3, "{name}: volume off by {off}");
}

#[test]
fn superellipsoids() {
    for (i, e) in pairs() {
        let shape = Superellipsoid::new(AXES[(i + i / 6) % 4], e).unwrap();
        let finder = ClosestFinder::superellipsoid(&shape);
        // exact for exponents under 2
        let exact = |p: &Point| finder.find(p).filter(|_| e.iter().all(|e| *e < 2.0));
        let expected = Expected::new(shape.volume(), 2);
        check(&shape, &expected, &format!("{shape:?}"), |p| exact(p).map(|c| c.distance));
    }
}

#[test]
fn supertoroids() {
    for (i, e) in pairs() {
        let ring = [3.0, 1.5, 1.0, 20.0][i % 4];
        let shape = Supertoroid::new(AXES[(i + i / 6) % 4], ring, e).unwrap();
        let finder = ClosestFinder::supertoroid(&shape);
        let exact = |p: &Point| finder.find(p).filter(|_| e.iter().all(|e| *e < 2.0));
        let expected = Expected::new(shape.volume(), 0);
        check(&shape, &expected, &format!("{shape:?}"), |p| exact(p).map(|c| c.distance));
    }
}

#[test]
fn separable_superquadrics_and_supershapes() {
    for powers in [[20.0, 20.0, 2.0], [2.0, 2.0, 8.0], [1.0, 3.0, 20.0], [0.8, 2.0, 1.2]] {
        let shape = SeparableSuperquadric::new([0.1, 0.05, 0.04], powers).unwrap();
        let expected = Expected::new(shape.volume(), 2);
        check(&shape, &expected, &format!("{shape:?}"), |_| None);
    }
    let round = Superformula::new(4.0, [2.0; 3], [1.0, 0.5]).unwrap();
    for (m, n) in [(6.0, [1.5, 1.7, 1.7]), (4.0, [12.0; 3]), (5.0, [0.8, 1.7, 1.7])] {
        let longitude = Superformula::new(m, n, [0.5, 0.5]).unwrap();
        let shape = Supershape::new(longitude, round).unwrap();
        let expected = Expected::new(shape.volume(), 2);
        check(&shape, &expected, &format!("{shape:?}"), |_| None);
    }
}

#[test]
fn cylinders_and_cones() {
    for (i, e) in [0.1, 0.5, 1.0, 1.9, 2.5].into_iter().enumerate() {
        let tin = Supercylinder::new(AXES[i % 4], e).unwrap();
        check(&tin, &Expected::new(tin.volume(), 2), &format!("{tin:?}"), |_| None);
        let cone = Supercone::new(AXES[(i + 1) % 4], e).unwrap();
        check(&cone, &Expected::new(cone.volume(), 2), &format!("{cone:?}"), |_| None);
    }
}

#[test]
fn extended_superellipsoids() {
    // with constant exponents they are superellipsoids
    for e in [[0.1, 1.0], [1.0, 0.4], [2.5, 1.7]] {
        let a = [0.03, 0.05, 0.1];
        let shape = ExtendedSuperellipsoid::new(a, &e[..1], &e[1..]).unwrap();
        let mesh = tessellate(&shape, None).unwrap().mesh;
        let same = Superellipsoid::new(a, e).unwrap();
        is_closed(&mesh, &Expected::new(same.volume(), 2), &format!("{e:?}"));
    }
    // others are compared with their finer mesh
    let vase =
        ExtendedSuperellipsoid::new([0.05, 0.05, 0.1], &[0.2, 0.9, 1.0], &[1.0, 0.3, 1.0, 1.0]);
    let vase = vase.unwrap();
    let found = tessellate(&vase, None).unwrap();
    let fine = tessellate(&vase, Some(0.1 * found.tolerance)).unwrap().mesh;
    is_closed(&found.mesh, &Expected::new(fine.volume(), 2), "vase");
}

#[test]
fn deformed_solids() {
    for e in [[0.1, 0.1], [0.1, 1.0], [0.2, 0.3], [1.0, 1.0], [0.5, 1.6], [1.8, 0.3], [2.5, 1.0]] {
        let shape = Superellipsoid::new([0.1, 0.2, 0.6], e).unwrap();
        let expected = Expected::new(shape.volume(), 2);
        let tapered = Deformed::new(shape, Taper::new([0.6, -0.4], 0.6).unwrap()).unwrap();
        let same = Expected::new(tapered.volume(), 2);
        check(&tapered, &same, &format!("tapered {e:?}"), |_| None);
        let twisted = Deformed::new(shape, Twist::new(0.4, 0.6).unwrap()).unwrap();
        check(&twisted, &expected, &format!("twisted {e:?}"), |_| None);
        let bent = Deformed::new(shape, Bend::new(2.5, 0.5).unwrap()).unwrap();
        check(&bent, &expected, &format!("bent {e:?}"), |_| None);
        let sheared = Deformed::new(shape, ShearBend::new(0.4).unwrap()).unwrap();
        check(&sheared, &expected, &format!("sheared {e:?}"), |_| None);
    }
    let ring = Supertoroid::new([0.1, 0.1, 0.05], 4.0, [0.6, 1.0]).unwrap();
    let bent = Deformed::new(ring, Bend::new(1.5, 0.5).unwrap()).unwrap();
    check(&bent, &Expected::new(ring.volume(), 0), "bent ring", |_| None);
}

#[test]
fn bowls() {
    for e in [[0.1, 1.0], [0.2, 1.0], [0.4, 0.3], [1.0, 1.0]] {
        let shape = Superellipsoid::new([0.1, 0.1, 0.05], e).unwrap();
        let bowl = Deformed::new(shape, Cavity::new(1.5, &shape).unwrap()).unwrap();
        // the volume has no closed form: a finer mesh has it
        let fine = tessellate(&bowl, Some(1e-5)).unwrap().mesh;
        check(&bowl, &Expected::new(fine.volume(), 2), &format!("bowl {e:?}"), |_| None);
    }
}

#[test]
fn combined_solids_are_marched() {
    let ball = Superellipsoid::new([0.05; 3], [1.0; 2]).unwrap();
    let bar = Superellipsoid::new([0.02, 0.02, 0.1], [0.1; 2]).unwrap();
    let handle = Supertoroid::new([0.01; 3], 2.5, [0.5, 1.0]).unwrap();
    let mug = Superellipsoid::new([0.03, 0.03, 0.05], [0.1, 1.0]).unwrap();
    let inside = Superellipsoid::new([0.026, 0.026, 0.045], [0.1, 1.0]).unwrap();
    let bead = || CombinedSolid::new(ball).difference(CombinedSolid::new(bar), Alpha::SMOOTH);
    let chain = bead().union(CombinedSolid::new(handle), Alpha::SMOOTH);
    let shell = CombinedSolid::new(mug).difference(CombinedSolid::new(inside), Alpha::SMOOTH);
    for (name, solid, euler) in [("bead", bead(), 0), ("chain", chain, 0), ("shell", shell, 4)] {
        let [coarse, fine] = [40, 64].map(|n| {
            let options = MarchOptions { resolution: Resolution::Count(n), ..Default::default() };
            march(&solid, &options).unwrap()
        });
        for mesh in [&coarse, &fine] {
            assert!(mesh.is_watertight(), "{name}");
            assert_eq!(mesh.euler_characteristic(), euler, "{name}");
            let off = mesh.vertices().iter().map(|p| (solid.gauge(p) - 1.0).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-9, "{name}: {off}");
        }
        assert!((coarse.volume() / fine.volume() - 1.0).abs() < 0.01, "{name}");
    }
}

#[test]
fn the_default_is_affordable() {
    for (a, e, most) in [
        ([1.0; 3], [0.1, 0.1], 6_000),
        ([1.0; 3], [1.0, 1.0], 10_000),
        ([1.0; 3], [2.5, 2.5], 20_000),
        ([0.01, 0.01, 1.0], [1.0, 1.0], 17_000),
        ([1.0, 1.0, 0.01], [0.1, 0.1], 10_000),
        ([1.0, 0.1, 0.01], [2.5, 2.5], 35_000),
        // the worst: a thin disc with a sharp round edge
        ([1.0, 1.0, 0.01], [1.0, 1.0], 60_000),
    ] {
        let shape = Superellipsoid::new(a, e).unwrap();
        let count = tessellate(&shape, None).unwrap().mesh.vertices().len();
        assert!(count <= most, "{shape:?}: {count} vertices");
    }
}
