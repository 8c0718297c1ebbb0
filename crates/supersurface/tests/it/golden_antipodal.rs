//! The decision tables and the superellipse's antipodal points against reference values with 50 digits.

use serde_json::Value;
use supersurface::grasp::{Bands, JawRow, Section, Stationary, cup_rows, jaw_rows};
use supersurface::shape::{Superellipsoid, Supertoroid};
use supersurface::surface::Surface;
use supersurface::{Direction, Point, Vector};

use crate::golden_shapes::{golden, numbers};

const RELATIVE: f64 = 1e-11;

fn near(value: f64, truth: &Value, size: f64) -> bool {
    truth.as_f64().is_some_and(|t| (value - t).abs() <= RELATIVE * size)
}

fn near_point(value: &[f64], truth: &Value, size: f64) -> bool {
    let list = truth.as_array().unwrap();
    list.len() == value.len() && value.iter().zip(list).all(|(v, t)| near(*v, t, size))
}

/// `null` stands for an infinite curvature.
fn near_curvature(value: Option<f64>, truth: &Value) -> bool {
    match value {
        Some(k) => near(k, truth, k.abs().max(1e-300)),
        None => truth.is_null(),
    }
}

fn stationary(section: &Section, kind: &str) -> Option<Stationary> {
    match kind {
        "axis_x" => Some(section.first()),
        "axis_y" => Some(section.second()),
        "interior" => section.interior(),
        _ => None,
    }
}

#[test]
fn golden_antipodal_superellipse() {
    let mut cases = 0;
    for case in golden("antipodal")["superellipse"].as_array().unwrap() {
        let [a, b, epsilon] = ["A", "B", "e"].map(|k| case[k].as_f64().unwrap());
        let section = Section { a, b, epsilon };
        for place in case["stationary"].as_array().unwrap() {
            let Some(found) = stationary(&section, place["kind"].as_str().unwrap()) else {
                // a circle: every point is one
                assert!(epsilon == 1.0 && a == b, "{case}");
                continue;
            };
            assert!(near_point(&found.point, &place["p"], found.radius()), "{place} {found:?}");
            assert!(near(2.0 * found.radius(), &place["width"], found.radius()), "{place}");
            if place["normal_defined"] == true {
                assert!(near_curvature(found.curvature, &place["curvature"]), "{place} {found:?}");
            }
            cases += 1;
        }
    }
    assert!(cases >= 90, "{cases} cases");
}

#[test]
fn golden_antipodal_superellipsoid() {
    let mut cases = 0;
    for case in golden("antipodal")["superellipsoid"].as_array().unwrap() {
        let [a1, a2, a3] = numbers::<3>(&case["a"]).unwrap();
        let [e1, e2] = numbers::<2>(&case["e"]).unwrap();
        let cross = Section { a: a1, b: a2, epsilon: e2 };
        for place in case["octant_points"].as_array().unwrap() {
            let kind = place["kind"].as_str().unwrap();
            let p = if kind == "pole" {
                Vector::z() * a3
            } else {
                let (eta, omega) = kind.split_once('_').unwrap();
                let foot = match omega {
                    "x" => cross.first(),
                    "y" => cross.second(),
                    _ => cross.interior().unwrap(),
                };
                let upright = Section { a: foot.radius(), b: a3, epsilon: e1 };
                let [r, z] = match eta {
                    "eta0" => upright.first().point,
                    _ => upright.interior().unwrap().point,
                };
                let d = Vector::new(foot.point[0], foot.point[1], 0.0) / foot.radius();
                d * r + Vector::z() * z
            };
            assert!(near_point(p.as_slice(), &place["p"], p.norm()), "{place} {p}");
            assert!(near_point(p.normalize().as_slice(), &place["n"], 1.0), "{place} {p}");
            assert!(near(2.0 * p.norm(), &place["width"], p.norm()), "{place}");
            cases += 1;
        }
    }
    assert!(cases >= 140, "{cases} cases");
}

/// The row of a table whose first contact is the golden point, up to the mirror images that rows stand for.
fn row<'a>(rows: &'a [JawRow], table: &str, p: &Value, omega: &str) -> &'a JawRow {
    let found = rows.iter().find(|r| {
        let turned = if omega == "any" {
            assert!(r.turning, "{r:?}");
            // the golden set writes a free direction as y
            let q = r.contacts[0].0;
            [0.0, q.x.hypot(q.y).copysign(q.x + q.y), q.z]
        } else {
            r.contacts[0].0.coords.into()
        };
        r.table == table && near_point(&turned, p, r.contacts[0].0.coords.norm())
    });
    found.unwrap_or_else(|| panic!("no row of {table} at {p} among {rows:?}"))
}

fn antipodal(row: &JawRow) {
    let closing = row.closing().unwrap();
    for (point, normal) in &row.contacts {
        assert!(normal.cross(&closing).norm() < 1e-12, "{row:?}");
        assert!(point.coords.iter().all(|v| v.is_finite()));
    }
    assert!(row.contacts[0].1.dot(&row.contacts[1].1) < -1.0 + 1e-12, "{row:?}");
}

#[test]
fn golden_antipodal_supertoroid_tables() {
    let (mut cells, mut checked) = (0, 0);
    for case in golden("antipodal")["supertoroid_tables"].as_array().unwrap() {
        let [a1, a2, a3, ring] = numbers::<4>(&case["a"]).unwrap();
        let exponents = numbers::<2>(&case["e"]).unwrap();
        let toroid = Supertoroid::new([a1, a2, a3], ring, exponents).unwrap();
        let surface = Surface::Supertoroid(toroid);
        let jaw = jaw_rows(&surface, &Bands::EXACT);
        let cup = cup_rows(&surface, &Bands::EXACT);
        jaw.iter().for_each(antipodal);
        for truth in case["rows"].as_array().unwrap() {
            let omega = truth["omega"].as_str().unwrap();
            let half = truth["a_w"].as_f64().unwrap();
            for (field, tables) in
                [("T1_T2_external", &["T1", "T2"][..]), ("T3_internal", &["T3"][..])]
            {
                let t = &truth[field];
                for table in tables {
                    let r = row(&jaw, table, &t["p"], omega);
                    assert!(near(r.width(), &t["width"], r.width()));
                    assert!(near_curvature(r.curvatures[0], &t["k_omega"]), "{t} {r:?}");
                    assert!(near_curvature(r.curvatures[1], &t["k_eta"]), "{t} {r:?}");
                    checked += 1;
                }
            }
            let t = &truth["T4a_radial_pinch"];
            let r = row(&jaw, "T4a", &t["p_out"], omega);
            assert!(near(r.width(), &t["width"], half));
            let t = &truth["T4b_axial_pinch"];
            if t["usable"] == true {
                let r = row(&jaw, "T4b", &t["p_top"], omega);
                assert!(near(r.width(), &t["width"], half));
                assert!(near_curvature(r.curvatures[1], &t["k_eta"]), "{t} {r:?}");
            } else {
                assert!(jaw.iter().all(|r| r.table != "T4b"));
            }
            let t = &truth["T4c_diagonal_pinch"];
            if t.is_null() {
                assert!(jaw.iter().all(|r| r.table != "T4c"));
            } else {
                let r = row(&jaw, "T4c", &t["p_a"], omega);
                assert!(near(r.width(), &t["width"], r.width()));
                assert!(near_curvature(r.curvatures[1], &t["k_eta"]), "{t} {r:?}");
            }
            let on = |p: &Point, n: &Direction, t: &Value| {
                let turned = |v: &Vector| {
                    if omega == "any" { [0.0, v.x + v.y, v.z] } else { [v.x, v.y, v.z] }
                };
                near_point(&turned(&p.coords), &t["p"], p.coords.norm())
                    && near_point(&turned(&n.into_inner()), &t["n"], 1.0)
            };
            let t = &truth["T5_suction_z"];
            let r = cup
                .iter()
                .find(|r| r.table == "T5" && on(&r.contact, &r.normal, t))
                .unwrap_or_else(|| panic!("no T5 at {t}"));
            assert!(near_curvature(r.sections[0].curvature(), &t["k_tube"]), "{t} {r:?}");
            let t = &truth["T6_suction_xy"];
            let r = cup.iter().find(|r| r.table == "T6" && on(&r.contact, &r.normal, t));
            if t.is_null() {
                assert!(cup.iter().all(|r| r.table != "T6"));
            } else {
                let r = r.unwrap_or_else(|| panic!("no T6 at {t}"));
                assert!(near_curvature(r.sections[0].curvature(), &t["k_omega"]), "{t} {r:?}");
                assert!(near_curvature(r.sections[1].curvature(), &t["k_eta"]), "{t} {r:?}");
            }
            checked += 5;
        }
        cells += 1;
    }
    assert!(cells == 18 && checked >= 100, "{cells} cells, {checked} rows");
}

#[test]
fn rows_of_both_neighbours_are_given_near_a_border() {
    let tables = |exponents: [f64; 2], bands: &Bands| {
        let body = Superellipsoid::new([0.05, 0.03, 0.04], exponents).unwrap();
        let mut names: Vec<&str> =
            jaw_rows(&Surface::Superellipsoid(body), bands).iter().map(|r| r.table).collect();
        names.sort_unstable();
        names.dedup();
        names
    };
    assert_eq!(tables([0.5, 0.5], &Bands::default()), ["P1", "P2", "P3"]);
    assert_eq!(tables([1.05, 0.5], &Bands::EXACT), ["P1", "P2", "P4"]);
    assert_eq!(tables([1.05, 0.5], &Bands::default()), ["P1", "P2", "P3", "P4"]);
    assert_eq!(tables([1.5, 1.5], &Bands::default()), ["P1", "P2", "P4"]);
    assert!(tables([2.0, 0.5], &Bands::default()).is_empty());
}
