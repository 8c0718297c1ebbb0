//! The software renderer.

use supersurface::nalgebra::{Translation3, UnitQuaternion};
use supersurface::picture::{Image, Picture, View};
use supersurface::shape::{Plane, Posed, Superellipsoid, Supertoroid};
use supersurface::surface::Surface;
use supersurface::{Point, Pose, Vector};

const RED: [u8; 3] = [220, 0, 0];
const BLUE: [u8; 3] = [0, 0, 220];

/// Looks down at a square of 1 m around the origin.
fn view() -> View {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let corners = corners.map(|(x, y)| Point::new(x, y, 0.0));
    View::towards(&corners, &Vector::z(), &Point::new(0.0, -0.01, 3.0))
}

fn ball(radius: f64, at: Vector) -> Posed<Surface> {
    let shape = Surface::Superellipsoid(Superellipsoid::new([radius; 3], [1.0; 2]).unwrap());
    let pose = Pose::from_parts(Translation3::from(at), UnitQuaternion::identity());
    Posed::new(shape, pose).unwrap()
}

fn count(image: &Image, colour: impl Fn(&[u8]) -> bool) -> usize {
    image.pixels.chunks(3).filter(|p| colour(p)).count()
}

fn reddish(p: &[u8]) -> bool {
    p[0] > 120 && p[2] < 60
}

fn bluish(p: &[u8]) -> bool {
    p[2] > 120 && p[0] < 60
}

#[test]
fn a_red_point_is_red_and_in_its_place() {
    let mut picture = Picture::new(200, 200, &view());
    let at = Point::new(0.2, 0.1, 0.0);
    picture.points(&[at], |_| RED, Some(6.0));
    let [x, y] = picture.project(&at).unwrap();
    assert!(x > 100.0 && y < 100.0, "right and up");
    let image = picture.finish();
    assert_eq!(image.pixel(x as usize, y as usize), Some(RED));
    assert!((20..40).contains(&count(&image, reddish)));
}

#[test]
fn the_nearer_hides_the_farther() {
    for order in [[0, 1], [1, 0]] {
        let mut picture = Picture::new(200, 200, &view());
        for i in order {
            let (height, colour) = [(0.5, RED), (0.0, BLUE)][i];
            picture.points(&[Point::new(0.0, 0.0, height)], |_| colour, Some(9.0));
        }
        let image = picture.finish();
        assert!(count(&image, reddish) > 40 && count(&image, bluish) < 12);
    }
}

#[test]
fn a_veil_lets_the_cloud_through_and_an_opaque_surface_does_not() {
    let inside = [Point::new(0.08, 0.03, 0.0)];
    let centre = |alpha: f64| {
        let mut picture = Picture::new(200, 200, &view());
        picture.points(&inside, |_| RED, Some(9.0)).surface(
            &ball(0.3, Vector::zeros()),
            BLUE,
            alpha,
        );
        let [x, y] = picture.project(&inside[0]).unwrap();
        picture.finish().pixel(x as usize, y as usize).unwrap()
    };
    assert!(centre(1.0)[0] < 90);
    assert!(centre(0.3)[0] > 100 && centre(0.3)[2] > 40);
}

#[test]
fn every_kind_of_thing_leaves_ink() {
    let empty = Picture::new(160, 120, &view()).finish();
    let things: [fn(&mut Picture); 7] = [
        |p| _ = p.line(&Point::new(-0.4, 0.0, 0.0), &Point::new(0.4, 0.1, 0.0), RED, 2.0),
        |p| _ = p.arrow(&Point::new(-0.4, 0.0, 0.0), &Point::new(0.4, 0.1, 0.0), RED, 2.0),
        |p| {
            let size = Vector::new(0.3, 0.2, 0.1);
            p.boxed(&Pose::identity(), &Point::origin(), &size, RED, 1.0);
        },
        |p| {
            let ring = Supertoroid::new([0.1; 3], 2.5, [1.0; 2]).unwrap();
            let ring = Posed::new(Surface::Supertoroid(ring), Pose::identity()).unwrap();
            p.surface(&ring, RED, 0.9);
        },
        |p| {
            let plane = Plane::through(&Point::origin(), Vector::z_axis());
            p.grid(&plane, &[Point::new(-0.4, -0.4, 0.0), Point::new(0.4, 0.4, 0.0)], RED);
        },
        |p| _ = p.label(&Point::origin(), "label 1.5 %", RED),
        |p| _ = p.text(10.0, 10.0, "Text", RED, 12.0),
    ];
    for (i, draw) in things.iter().enumerate() {
        let mut picture = Picture::new(160, 120, &view());
        draw(&mut picture);
        let image = picture.finish();
        let changed = image.pixels.iter().zip(&empty.pixels).filter(|(a, b)| a != b).count();
        assert!(changed > 100, "thing {i}: {changed}");
    }
}

#[test]
fn nothing_and_nonsense_make_a_picture() {
    let bad = Point::new(f64::NAN, 0.0, f64::INFINITY);
    let far = Point::new(1e200, -1e300, 1e250);
    for points in [&[][..], &[bad; 3], &[far; 2], &[Point::origin()]] {
        for from in [bad, far, Point::origin()] {
            let view = View::towards(points, &Vector::z(), &from);
            let mut picture = Picture::new(0, 40, &view);
            picture.points(points, |_| RED, None).line(&bad, &far, RED, f64::NAN);
            picture.line(&Point::origin(), &far, RED, 3.0).arrow(&far, &bad, RED, 3.0);
            picture.boxed(&Pose::identity(), &far, &far.coords, RED, 0.5);
            picture.surface(&ball(1e-9, Vector::zeros()), RED, f64::NAN);
            picture.surface(&ball(1e9, Vector::x()), RED, 0.5);
            picture.grid(&Plane::through(&Point::origin(), Vector::z_axis()), points, RED);
            picture.label(&bad, "bad", RED).label(&far, "", RED).text(
                f64::NAN,
                1e300,
                "",
                RED,
                0.0,
            );
            assert_eq!(picture.finish().pixels.len(), 3 * 40);
        }
    }
}

#[test]
fn things_behind_the_viewer_are_not_drawn() {
    let empty = Picture::new(160, 120, &view()).finish();
    let mut picture = Picture::new(160, 120, &view());
    picture.surface(&ball(0.3, Vector::new(0.0, 0.0, 6.0)), RED, 1.0);
    picture.points(&[Point::new(0.0, 0.0, 5.0)], |_| RED, None);
    picture.label(&Point::new(0.0, 0.0, 5.0), "behind", RED);
    assert_eq!(picture.finish(), empty);
}

#[test]
fn scale_does_not_matter() {
    let draw = |scale: f64| {
        let points: Vec<Point> = (0..50)
            .map(|i| Point::new((f64::from(i) * 0.7).sin(), f64::from(i) * 0.02, 0.1) * scale)
            .collect();
        let view = View::towards(&points, &Vector::z(), &(Point::new(1.0, -3.0, 2.0) * scale));
        let mut picture = Picture::new(100, 80, &view);
        picture.points(&points, |_| RED, Some(3.0));
        count(&picture.finish(), reddish)
    };
    let one = draw(1.0);
    assert!(one > 100);
    for scale in [1e-6, 1e6] {
        assert!(draw(scale).abs_diff(one) < 20, "{scale}: {} against {one}", draw(scale));
    }
}
