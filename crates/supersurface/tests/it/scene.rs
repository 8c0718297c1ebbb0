//! The demonstration scene and the simulated depth camera.

use supersurface::Point;
use supersurface::cloud::PointCloud;
use supersurface::measure::first_hit;
use supersurface::scene::{DepthNoise, demo, look};
use supersurface::shape::{Implicit, Ray};

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
