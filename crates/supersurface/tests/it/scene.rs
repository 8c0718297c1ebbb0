//! The demonstration scene and the simulated depth camera.

use supersurface::camera::Camera;
use supersurface::cloud::PointCloud;
use supersurface::measure::first_hit;
use supersurface::scene::{
    DepthNoise, Layout, Likeness, Look, Recipe, arrange, demo, draw, look, turntable, visibility,
};
use supersurface::shape::{Implicit, Ray};
use supersurface::{Direction, Point};

#[test]
fn the_demo_is_deterministic_and_shows_every_body() {
    for seed in 0..6 {
        let d = demo(seed).unwrap();
        assert_eq!(d, demo(seed).unwrap());
        let seen = look(&d.scene, &d.camera, &d.camera_pose, &DepthNoise::default(), seed);
        if seed == 0 {
            let again = look(&d.scene, &d.camera, &d.camera_pose, &DepthNoise::default(), seed);
            assert_eq!(seen.labels, again.labels);
            let bits = |l: &supersurface::scene::Look| -> Vec<u32> {
                l.depth.depth().iter().map(|z| z.to_bits()).collect()
            };
            assert_eq!(bits(&seen), bits(&again));
        }
        for label in 1..=d.scene.bodies.len() as u32 {
            let pixels = seen.labels.iter().filter(|l| **l == label).count();
            assert!(pixels > 1200, "seed {seed}: body {label} has {pixels} pixels");
            // alone, it has hardly more: nothing hides it
            let mut alone = d.scene.clone();
            alone.bodies = vec![d.scene.bodies[label as usize - 1].clone()];
            let all = look(&alone, &d.camera, &d.camera_pose, &DepthNoise::default(), seed);
            let all = all.labels.iter().filter(|l| **l == 1).count();
            assert!(pixels as f64 > 0.95 * all as f64, "seed {seed}: {label}: {pixels} of {all}");
        }
        let read = seen.depth.depth().iter().filter(|z| z.is_finite()).count();
        assert!(read as f64 > 0.8 * 640.0 * 480.0, "seed {seed}: {read} readings");
    }
}

#[test]
fn a_frame_over_another_is_as_if_it_were_the_first() {
    let bits = |l: &Look| -> Vec<u32> { l.depth.depth().iter().map(|z| z.to_bits()).collect() };
    let [one, two] = [1, 2].map(|seed| demo(seed).unwrap());
    let small = Camera::new([90, 70], [80.0, 80.0], [44.5, 34.5]).unwrap();
    let noise = [DepthNoise::realsense(), DepthNoise::none()];
    let mut seen = Look::blank(&small);
    for (k, (d, camera)) in
        [(&one, &small), (&two, &two.camera), (&one, &one.camera), (&two, &small)]
            .iter()
            .enumerate()
    {
        for noise in &noise {
            let fresh = look(&d.scene, camera, &d.camera_pose, noise, k as u64);
            seen.again(&d.scene, camera, &d.camera_pose, noise, k as u64);
            assert_eq!(bits(&seen), bits(&fresh));
            assert!(seen.labels == fresh.labels && seen.seen == fresh.seen);
            assert!(seen.normals == fresh.normals);
        }
    }
}

#[test]
fn without_noise_a_depth_is_the_distance_of_the_hit() {
    let d = demo(3).unwrap();
    let seen = look(&d.scene, &d.camera, &d.camera_pose, &DepthNoise::none(), 3);
    for (body, label) in d.scene.bodies.iter().zip(1..) {
        // the middle of what is seen of the body
        let pixels = (0..640 * 480).filter(|i| seen.labels[*i] == label);
        let i = pixels.min_by_key(|i| {
            let centre = Point::from(body.pose.translation.vector);
            let [u, v] = d.camera.project(&d.camera_pose.inverse_transform_point(&centre)).unwrap();
            ((i % 640) as i64 - u as i64).abs() + ((i / 640) as i64 - v as i64).abs()
        });
        let i = i.unwrap();
        let along = d.camera.direction((i % 640) as f64, (i / 640) as f64);
        let ray = Ray {
            origin: Point::from(d.camera_pose.translation.vector),
            direction: d.camera_pose * along,
        };
        let hit = first_hit(&body.solids()[0], &ray, 2.0).unwrap();
        let depth = f64::from(seen.depth.depth()[i]);
        assert!((depth - hit.distance * along.z).abs() < 1e-6, "{}", body.name);
    }
}

#[test]
fn points_lie_on_what_their_labels_say() {
    let d = demo(1).unwrap();
    let seen = look(&d.scene, &d.camera, &d.camera_pose, &DepthNoise::default(), 1);
    let cloud = PointCloud::from_depth(&seen.depth, &d.camera).moved(&d.camera_pose);
    let mut errors: Vec<f64> = Vec::new();
    for (p, label) in cloud.points.iter().zip(&seen.labels).filter(|(p, _)| p.x.is_finite()) {
        errors.push(match label {
            0 => d.scene.support.height(p).abs(),
            k => d.scene.bodies[*k as usize - 1].solids()[0].first_order_distance(p).abs(),
        });
    }
    errors.sort_by(f64::total_cmp);
    let (median, most) = (errors[errors.len() / 2], errors[errors.len() * 98 / 100]);
    assert!(median > 1e-4 && median < 1.5e-3 && most < 5e-3, "median {median}, 98 % {most}");
}

/// Mugs, bowls, bottles, hammers and bananas.
fn recipes() -> Vec<Recipe> {
    let range = |v: f64| [0.9 * v, 1.1 * v];
    let likenesses = [
        Likeness::Mug { radius: range(0.04), height: range(0.1), wall: range(0.004) },
        Likeness::Bowl { radius: range(0.07), depth: range(0.5) },
        Likeness::Bottle { radius: range(0.035), height: range(0.2) },
        Likeness::Hammer { length: range(0.25) },
        Likeness::Superellipsoid {
            semi_axes: [range(0.016), range(0.016), range(0.09)],
            exponents: [range(0.7), range(1.0)],
            taper: [0.0; 2],
            twist: [0.0; 2],
            bend: range(1.1),
        },
    ];
    let recipe = |likeness| Recipe {
        name: "thing".into(),
        weight: 1.0,
        likeness,
        density: range(500.0),
        friction: range(0.5),
    };
    likenesses.into_iter().map(recipe).collect()
}

/// Every ray of whole images, through lenses that distort, against each solid alone.
#[test]
fn pixels_see_the_nearest_of_what_their_rays_meet() {
    let [width, height] = [75, 61];
    let camera = Camera::new([width, height], [70.0; 2], [37.3, 29.6])
        .and_then(|c| c.with_distortion([-0.1, 0.02, 0.003, -0.002, 0.0, 0.0, 0.0, 0.0]))
        .unwrap();
    for seed in 0..6 {
        let bodies = draw(&recipes(), 6, seed).unwrap();
        let layout = if seed % 2 == 0 { Layout::Pile } else { Layout::Packed };
        let mut scene = arrange(bodies, layout, seed).unwrap();
        scene.boards.clear();
        let pose = turntable(&scene, &camera, 3)[seed as usize % 3];
        let seen = look(&scene, &camera, &pose, &DepthNoise::none(), seed);
        let mut alone = vec![0.0; scene.bodies.len()];
        for i in 0..width * height {
            let along = camera.unproject((i % width) as f64, (i / width) as f64);
            let origin = Point::from(pose.translation.vector);
            let direction = pose * Direction::new_normalize(along);
            let ray = Ray { origin, direction };
            let t = -origin.z / direction.z;
            let foot = ray.at(t);
            let on = t > 0.0 && (0..2).all(|k| foot[k].abs() <= scene.half_size[k]);
            let (mut nearest, mut label) = (if on { t } else { f64::INFINITY }, 0);
            for (k, body) in scene.bodies.iter().enumerate() {
                let solids = body.solids();
                let hits = solids.iter().filter_map(|solid| first_hit(solid, &ray, 10.0));
                let first = hits.map(|hit| hit.distance).fold(f64::INFINITY, f64::min);
                alone[k] += f64::from(u8::from(first.is_finite()));
                if first < nearest {
                    (nearest, label) = (first, k as u32 + 1);
                }
            }
            let depth = f64::from(seen.depth.depth()[i]) * along.norm();
            assert_eq!(depth.is_nan(), nearest.is_infinite(), "seed {seed}, pixel {i}");
            assert!(depth.is_nan() || (depth - nearest).abs() < 1e-6, "seed {seed}, pixel {i}");
            assert_eq!(seen.seen[i], label, "seed {seed}, pixel {i}");
        }
        for (k, share) in visibility(&scene, &camera, &pose).into_iter().enumerate() {
            let shown = seen.seen.iter().filter(|label| **label == k as u32 + 1).count();
            assert!((share - shown as f64 / f64::max(alone[k], 1.0)).abs() < 1e-12, "{k}");
        }
    }
}
