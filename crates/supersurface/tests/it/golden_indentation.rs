//! Meshes in superellipsoids against reference values with 50 digits.

use serde_json::Value;
use supersurface::contact::{
    Application, Foundation, FoundationOptions, Indented, Twist, VertexForce,
};
use supersurface::mesh::Mesh;
use supersurface::nalgebra::{Quaternion, UnitQuaternion};
use supersurface::shape::{Implicit, Posed, Superellipsoid};
use supersurface::{Point, Pose, Vector};

use crate::golden_shapes::{close, close_vector, golden, numbers, point};

fn solid(case: &Value) -> Posed<Superellipsoid> {
    let axes = numbers(&case["a"]).unwrap();
    let shape = Superellipsoid::new(axes, numbers(&case["e"]).unwrap()).unwrap();
    let [w, x, y, z] = numbers(&case["quat_wxyz"]).unwrap();
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    let [tx, ty, tz] = numbers(&case["t"]).unwrap();
    Posed::new(shape, Pose::from_parts(Vector::new(tx, ty, tz).into(), turn)).unwrap()
}

fn close_all(name: &str, values: &[f64], truth: &Value, tolerance: f64) {
    let truth = truth.as_array().unwrap();
    assert_eq!(values.len(), truth.len());
    for (v, t) in values.iter().zip(truth) {
        close(name, *v, t, tolerance);
    }
}

fn check_vertex(solid: &Posed<Superellipsoid>, found: &VertexForce, x: &Point, truth: &Value) {
    let size = solid.shape().semi_axes().into_iter().fold(0.0, f64::max);
    let g = solid.gauge(x);
    close("g", g, &truth["g"], 1e-14);
    let inside = &found.indentation;
    let foot = solid.to_local(&inside.foot).coords;
    close_all("p_s", foot.as_slice(), &truth["p_s_local"], 1e-11 * size);
    assert_eq!(Some(inside.foot), solid.foot(x));
    close_all("n", inside.normal.as_slice(), &truth["n_world"], 1e-12);
    close("depth", inside.depth, &truth["depth"], 1e-11 * size);
    let vector = *inside.normal * inside.depth;
    close_all("I_p", vector.as_slice(), &truth["I_p_world"], 1e-11 * size);
    close("area", found.area, &truth["area"], 1e-12 * found.area);
    close_vector("force", &found.force, &truth["force_on_mesh"], 1e-10);
}

#[test]
fn golden_indentation() {
    let data = golden("indentation");
    let triangles = data["triangles"].as_array().unwrap();
    let triangles: Vec<[u32; 3]> =
        triangles.iter().map(|t| numbers::<3>(t).unwrap().map(|i| i as u32)).collect();
    let (mut cases, mut vertices) = (0, 0);
    for case in data["cases"].as_array().unwrap() {
        let solid = solid(case);
        let points: Vec<Point> = case["vertices"].as_array().unwrap().iter().map(point).collect();
        let mesh = Mesh::new(points.clone(), triangles.clone()).unwrap();
        let foundation = Foundation::new(&mesh).unwrap();
        let truths = case["contacts"].as_array().unwrap();
        for (application, name) in [
            (Application::Vertex, "wrench_on_mesh_stiff_mesh"),
            (Application::Surface, "wrench_on_mesh_stiff_sq"),
        ] {
            let options = FoundationOptions {
                stiffness: case["stiffness_Pa_per_m"].as_f64().unwrap(),
                application,
                ..FoundationOptions::default()
            };
            let (still, rest) = (Pose::identity(), Twist::default());
            let forces = foundation.forces(&still, &solid, &rest, &options).unwrap();
            assert_eq!(forces.len(), truths.len());
            for (found, truth) in forces.iter().zip(truths) {
                assert_eq!(u64::from(found.vertex), truth["vertex"].as_u64().unwrap());
                check_vertex(&solid, found, &points[found.vertex as usize], truth);
                vertices += 1;
            }
            let found = foundation.press(&still, &solid, &rest, &options).unwrap();
            assert_eq!(found.vertices, truths.len());
            let wrench = found.on_mesh.moved_to(&Point::origin());
            let truth = numbers::<6>(&case[name]).unwrap();
            let values = [wrench.force, wrench.moment].map(|v| [v.x, v.y, v.z]).concat();
            let largest = |part: &[f64]| part.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            for (part, v) in values.iter().enumerate() {
                let scale = largest(if part < 3 { &truth[..3] } else { &truth[3..] });
                assert!((v - truth[part]).abs() <= 1e-10 * scale, "{name}: {v} {}", truth[part]);
            }
        }
        cases += 1;
    }
    assert!(cases >= 8 && vertices >= 70, "{cases} cases, {vertices} vertices");
}
