//! Where bodies are before they fall: apart from each other, above what they are to rest on.
//!
//! Each is kept within the ball around it, so that none overlaps another whichever way it is turned. Sizes of bins and
//! shelves follow those of the bodies.

use super::layout::TRIALS;
use super::{Board, Body, Scene, SceneError};
use crate::numeric::random::Stream;
use crate::{Point, Pose, Vector};
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use std::f64::consts::TAU;

/// How bodies lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Each thing alone on its table: one body.
    Single,
    /// Tipped into a bin.
    Pile,
    /// Upright beside each other on a table.
    Packed,
    /// Upright on the boards of a shelf.
    Shelf,
}

/// Free way between what must not touch, relative to the radius of the largest body.
const GAP: f64 = 0.04;
/// Thickness of boards relative to the same.
const BOARD: f64 = 0.2;
/// Boards of a shelf.
const BOARDS: usize = 3;
/// What stands is put down with a tilt of so many radians: what would balance on a tip falls.
const TILT: f64 = 0.02;
/// The ground relative to what stands on it.
const GROUND: f64 = 2.0;

/// A body with the ball around it: its middle in the body's frame and its radius.
struct Ball {
    middle: Vector,
    radius: f64,
}

impl Ball {
    fn around(body: &Body) -> Self {
        let unmoved = Body { pose: Pose::identity(), ..body.clone() };
        let [low, high] = unmoved.bounds();
        Self { middle: nalgebra::center(&low, &high).coords, radius: 0.5 * (high - low).norm() }
    }

    /// The pose that turns the body and puts the ball's middle somewhere.
    fn put(&self, at: Vector, turn: UnitQuaternion<f64>) -> Pose {
        Pose::from_parts(Translation3::from(at - turn * self.middle), turn)
    }
}

/// Puts bodies where they can fall from into a layout, with the boards that belong to it. The same seed gives the same
/// scene; nothing overlaps. Fails for a single layout of several bodies, or where there is no room.
///
/// ```
/// use supersurface::scene::{Body, Layout, arrange};
/// use supersurface::{Pose, shape::Superellipsoid, surface::Surface};
/// let egg = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.02, 0.02], [1.0; 2])?);
/// let eggs = vec![Body::single("egg", egg, Pose::identity())?; 5];
/// let scene = arrange(eggs, Layout::Pile, 7)?;
/// assert_eq!((scene.bodies.len(), scene.boards.len()), (5, 4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn arrange(bodies: Vec<Body>, layout: Layout, seed: u64) -> Result<Scene, SceneError> {
    if layout == Layout::Single && bodies.len() > 1 {
        return Err(SceneError::NotSingle { bodies: bodies.len() });
    }
    let balls: Vec<Ball> = bodies.iter().map(Ball::around).collect();
    let largest = balls.iter().map(|b| b.radius).fold(0.0, f64::max);
    let mut scene = Scene::empty([GROUND * largest; 2]);
    scene.bodies = bodies;
    match layout {
        Layout::Single => dropped(&mut scene, &balls, seed),
        Layout::Pile => tipped(&mut scene, &balls, largest, seed),
        Layout::Packed => packed(&mut scene, &balls, largest, seed)?,
        Layout::Shelf => shelved(&mut scene, &balls, largest, seed),
    }
    Ok(scene)
}

/// Any rotation, each as likely.
fn any_turn(stream: &mut Stream) -> UnitQuaternion<f64> {
    let [w, x, y, z] = [(); 4].map(|()| stream.normal());
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

/// Any turn about the vertical.
fn any_yaw(stream: &mut Stream) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector::z_axis(), stream.between(0.0, TAU))
}

/// From just above the table.
fn dropped(scene: &mut Scene, balls: &[Ball], seed: u64) {
    for (index, (body, ball)) in scene.bodies.iter_mut().zip(balls).enumerate() {
        let mut stream = Stream::new(seed, index as u64);
        body.pose = ball.put(Vector::zeros(), any_turn(&mut stream));
        body.pose.translation.z += GAP * ball.radius - body.bounds()[0].z;
        scene.half_size = [3.0 * GROUND * ball.radius; 2];
    }
}

/// One above the other into a bin, each as low as the ones before let it.
fn tipped(scene: &mut Scene, balls: &[Ball], largest: f64, seed: u64) {
    // a bin that the bodies' balls would fill to about the largest one's size
    let volume: f64 = balls.iter().map(|b| 8.0 * b.radius.powi(3)).sum();
    let inner = (0.5 * (volume / (2.0 * largest)).sqrt()).max(1.4 * largest);
    let high = 1.5 * largest;
    scene.half_size = [GROUND * inner; 2];
    scene.boards = bin(inner, high, BOARD * largest);
    let mut placed: Vec<(Point, f64)> = Vec::new();
    for (index, (body, ball)) in scene.bodies.iter_mut().zip(balls).enumerate() {
        let mut stream = Stream::new(seed, index as u64);
        let gap = GAP * largest;
        let free = inner - ball.radius - gap;
        let at = [(); 2].map(|()| stream.between(-free, free));
        let lowest = ball.radius + gap;
        let over = |(p, radius): &(Point, f64)| {
            let aside = (p.x - at[0]).hypot(p.y - at[1]);
            let reach = radius + ball.radius + gap;
            p.z + (reach * reach - aside * aside).max(0.0).sqrt()
        };
        let blocks =
            |q: &(Point, f64)| (q.0.x - at[0]).hypot(q.0.y - at[1]) < q.1 + ball.radius + gap;
        let z = placed.iter().filter(|q| blocks(q)).map(over).fold(lowest, f64::max);
        body.pose = ball.put(Vector::new(at[0], at[1], z), any_turn(&mut stream));
        placed.push((Point::new(at[0], at[1], z), ball.radius));
    }
}

/// Four walls around the middle of the table: half of the inner width, height, thickness.
fn bin(inner: f64, high: f64, thick: f64) -> Vec<Board> {
    let half = 0.5 * thick;
    let long = inner + thick;
    [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
        .iter()
        .enumerate()
        .map(|(k, (x, y))| Board {
            name: format!("wall_{}", k + 1),
            half_extents: if *y == 0.0 {
                [half, long, 0.5 * high]
            } else {
                [inner, half, 0.5 * high]
            },
            pose: Pose::translation(x * (inner + half), y * (inner + half), 0.5 * high),
        })
        .collect()
}

/// A circle around an upright body, seen from above.
fn circle(body: &Body) -> ([f64; 2], f64) {
    let [low, high] = body.bounds();
    let middle = nalgebra::center(&low, &high);
    ([middle.x, middle.y], 0.5 * (high.x - low.x).hypot(high.y - low.y))
}

/// Turned about the vertical, and with its lowest point at a height.
fn stood(body: &mut Body, ball: &Ball, [x, y]: [f64; 2], height: f64, stream: &mut Stream) {
    let yaw = any_yaw(stream);
    let (sin, cos) = stream.between(0.0, TAU).sin_cos();
    let tilt = UnitQuaternion::from_scaled_axis(Vector::new(cos, sin, 0.0) * TILT);
    body.pose = ball.put(Vector::new(x, y, 0.0), tilt * yaw);
    body.pose.translation.z += height - body.bounds()[0].z;
}

/// Each as near to the middle as a few tries find room.
fn packed(scene: &mut Scene, balls: &[Ball], largest: f64, seed: u64) -> Result<(), SceneError> {
    let gap = GAP * largest;
    let mut placed: Vec<([f64; 2], f64)> = Vec::new();
    let mut reach = 0.0f64;
    for (index, (body, ball)) in scene.bodies.iter_mut().zip(balls).enumerate() {
        let mut stream = Stream::new(seed, index as u64);
        stood(body, ball, [0.0; 2], 0.2 * gap, &mut stream);
        let (_, radius) = circle(body);
        let free = |at: &[f64; 2]| {
            placed.iter().all(|(p, r)| (p[0] - at[0]).hypot(p[1] - at[1]) > r + radius + gap)
        };
        let far = reach + radius + 2.0 * gap;
        let from_middle = |at: &[f64; 2]| at[0].hypot(at[1]);
        let spots = (0..TRIALS).map(|_| [(); 2].map(|()| stream.between(-far, far)));
        let found =
            spots.filter(free).take(8).min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)));
        let none = || SceneError::NoRoom { name: body.name.clone(), trials: TRIALS };
        let at = if index == 0 { [0.0; 2] } else { found.ok_or_else(none)? };
        let ([x, y], _) = circle(body);
        body.pose.translation.x += at[0] - x;
        body.pose.translation.y += at[1] - y;
        reach = reach.max(from_middle(&at) + radius);
        placed.push((at, radius));
    }
    scene.half_size = [GROUND * reach.max(largest); 2];
    Ok(())
}

/// In rows on the boards of a shelf with a back and two sides.
fn shelved(scene: &mut Scene, balls: &[Ball], largest: f64, seed: u64) {
    let (gap, thick) = (GAP * largest, BOARD * largest);
    let mut rows = [0f64; BOARDS];
    let mut places = Vec::new();
    let (mut deep, mut high) = (0.0f64, 0.0f64);
    for (index, (body, ball)) in scene.bodies.iter_mut().zip(balls).enumerate() {
        let mut stream = Stream::new(seed, index as u64);
        stood(body, ball, [0.0; 2], 0.0, &mut stream);
        let (_, radius) = circle(body);
        // the row that is shortest so far
        let row = (0..BOARDS).min_by(|a, b| rows[*a].total_cmp(&rows[*b])).unwrap_or(0);
        places.push((row, rows[row] + radius + gap, stream.between(-0.3, 0.3) * radius));
        rows[row] += 2.0 * (radius + gap);
        deep = deep.max(1.3 * radius + gap);
        high = high.max(body.bounds()[1].z);
    }
    let wide = 0.5 * rows.iter().copied().fold(0.0, f64::max) + gap;
    let pitch = 1.3 * high + thick;
    let level = |row: usize| row as f64 * pitch + thick;
    for (body, (row, x, y)) in scene.bodies.iter_mut().zip(places) {
        let ([at_x, at_y], _) = circle(body);
        let middle = x - 0.5 * rows[row];
        let by = Vector::new(middle - at_x, y - at_y, level(row) + 0.2 * gap);
        body.pose.translation.vector += by;
    }
    let whole = 0.5 * pitch * BOARDS as f64;
    let board = |name: String, half_extents, at: [f64; 3]| Board {
        name,
        half_extents,
        pose: Pose::translation(at[0], at[1], at[2]),
    };
    let half = 0.5 * thick;
    scene.boards = (0..BOARDS)
        .map(|k| board(format!("board_{}", k + 1), [wide, deep, half], [0.0, 0.0, level(k) - half]))
        .collect();
    scene.boards.extend([
        board("back".into(), [wide + thick, half, whole], [0.0, deep + half, whole]),
        board("side_1".into(), [half, deep, whole], [-wide - half, 0.0, whole]),
        board("side_2".into(), [half, deep, whole], [wide + half, 0.0, whole]),
    ]);
    scene.half_size = [GROUND * (wide + thick), GROUND * (deep + thick)];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Likeness, Recipe, draw};

    fn recipes() -> [Recipe; 2] {
        let recipe = |name: &str, likeness| Recipe {
            name: name.into(),
            weight: 1.0,
            likeness,
            density: [300.0, 900.0],
            friction: [0.4, 0.8],
        };
        [
            recipe(
                "mug",
                Likeness::Mug { radius: [0.03, 0.05], height: [0.08, 0.1], wall: [0.003, 0.004] },
            ),
            recipe("hammer", Likeness::Hammer { length: [0.2, 0.3] }),
        ]
    }

    #[test]
    fn nothing_overlaps_before_it_falls() {
        for (seed, layout) in [(1, Layout::Pile), (2, Layout::Packed), (3, Layout::Shelf)] {
            let scene = arrange(draw(&recipes(), 12, seed).unwrap(), layout, seed).unwrap();
            for (i, body) in scene.bodies.iter().enumerate() {
                let [low, high] = body.bounds();
                assert!(low.z > 0.0 && high.z.is_finite());
                for board in &scene.boards {
                    let half = Vector::from(board.half_extents);
                    let at = Point::from(board.pose.translation.vector);
                    let apart =
                        (0..3).any(|k| low[k] > at[k] + half[k] || high[k] < at[k] - half[k]);
                    assert!(apart, "{layout:?} {} {}", body.name, board.name);
                }
                for other in &scene.bodies[..i] {
                    let [a, b] = [body, other].map(Ball::around);
                    let middle = |ball: &Ball, body: &Body| body.pose * Point::from(ball.middle);
                    let between = middle(&a, body) - middle(&b, other);
                    let over = other.bounds();
                    let boxes = (0..3).any(|k| low[k] > over[1][k] || high[k] < over[0][k]);
                    let circles = circle(body).1 + circle(other).1 < between.xy().norm();
                    let balls = a.radius + b.radius < between.norm();
                    assert!(boxes || circles || balls, "{layout:?} {} {}", body.name, other.name);
                }
            }
        }
    }

    #[test]
    fn a_single_layout_takes_one_body() {
        let error = arrange(draw(&recipes(), 2, 1).unwrap(), Layout::Single, 1).unwrap_err();
        assert!(error.to_string().contains("one body"), "{error}");
        assert!(arrange(Vec::new(), Layout::Pile, 1).unwrap().bodies.is_empty());
    }
}
