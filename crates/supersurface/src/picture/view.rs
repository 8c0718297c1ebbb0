//! From where a picture is looked at, and how much of the world it must show.

use crate::{Direction, Point, Pose, Vector};
use nalgebra::UnitQuaternion;

/// A virtual camera. A picture of any shape shows at least what the view reaches.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Pose of the optical frame (x right, y down, z ahead) in the frame of what is drawn.
    pub(super) pose: Pose,
    /// Tangents of the half angles to be shown across and down.
    pub(super) reach: [f64; 2],
    /// Distance to the middle of what is shown, in metres: the unit of depth.
    pub(super) distance: f64,
}

impl View {
    /// The view from about `from` that is filled by `points` (those that are finite), upright along
    /// `up`. When `from` lies among the points it is moved back. Never fails: without points it looks
    /// at the origin.
    pub fn towards(points: &[Point], up: &Vector, from: &Point) -> Self {
        let points: Vec<Point> = points.iter().filter(|p| finite(p)).copied().collect();
        let (centre, radius) = ball(&points);
        let up = direction(up).unwrap_or(Vector::z_axis());
        let back = direction(&(from - centre)).unwrap_or(up);
        let away = (from - centre).norm();
        let distance = if away.is_finite() { away.max(1.6 * radius) } else { 3.0 * radius };
        let eye = centre + back.into_inner() * distance;
        let mut target = centre;
        let mut view = Self { pose: looking(&eye, &target, &up), reach: [0.5; 2], distance };
        // turning the camera to the middle of what it sees changes what is in the middle: repeat
        for _ in 0..4 {
            let [x, y] = view.spans(&points);
            view.reach = [x, y].map(|[low, high]| (0.5 * (high - low)).clamp(0.01, 1.2) * 1.05);
            let middle = Vector::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 1.0) * distance;
            target = view.pose * Point::from(middle);
            view.pose = looking(&eye, &target, &up);
        }
        view
    }

    /// The viewpoint `from` turned about the middle of `points`: by `yaw` radians about `up`
    /// (counterclockwise seen from above) and higher by `rise` radians, at most straight above.
    pub fn turned(points: &[Point], up: &Vector, from: &Point, yaw: f64, rise: f64) -> Point {
        let points: Vec<Point> = points.iter().filter(|p| finite(p)).copied().collect();
        let (centre, _) = ball(&points);
        let up = direction(up).unwrap_or(Vector::z_axis());
        let arm = UnitQuaternion::from_axis_angle(&up, yaw) * (from - centre);
        let side = up.cross(&arm);
        let Some(side) = direction(&side) else { return centre + arm };
        let present = (arm.dot(&up) / arm.norm()).clamp(-1.0, 1.0).asin();
        let rise = rise.min(1.5 - present);
        centre + UnitQuaternion::from_axis_angle(&side, -rise) * arm
    }

    /// Ranges of the image coordinates x/z and y/z of the points, without the outermost in 400.
    fn spans(&self, points: &[Point]) -> [[f64; 2]; 2] {
        let seen = points.iter().map(|p| self.pose.inverse_transform_point(p));
        let (mut xs, mut ys): (Vec<f64>, Vec<f64>) =
            seen.filter(|p| p.z > 1e-3 * self.distance).map(|p| (p.x / p.z, p.y / p.z)).unzip();
        [&mut xs, &mut ys].map(|v| {
            v.sort_by(f64::total_cmp);
            let cut = v.len() / 400;
            match (v.get(cut), v.get(v.len().saturating_sub(1 + cut))) {
                (Some(low), Some(high)) => [*low, *high],
                _ => [-0.5, 0.5],
            }
        })
    }
}

/// Middle of the points' bounding box without their outermost share, and half its diagonal.
fn ball(points: &[Point]) -> (Point, f64) {
    let mut low = Point::origin();
    let mut high = Point::origin();
    for axis in 0..3 {
        let mut v: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        v.sort_by(f64::total_cmp);
        let cut = v.len() / 400;
        low[axis] = v.get(cut).copied().unwrap_or(-0.5);
        high[axis] = v.get(v.len().saturating_sub(1 + cut)).copied().unwrap_or(0.5);
    }
    let radius = 0.5 * (high - low).norm();
    let usable = radius > 1e-12 && radius.is_finite();
    (low + (high - low) * 0.5, if usable { radius } else { 1e-3 })
}

/// The pose of an optical frame at `eye` looking at `target`; any heading when that is along `up`.
fn looking(eye: &Point, target: &Point, up: &Direction) -> Pose {
    let ahead = direction(&(target - eye)).unwrap_or(-*up);
    let side = direction(&ahead.cross(up)).filter(|_| ahead.cross(up).norm() > 1e-6);
    let x = side.unwrap_or_else(|| {
        let helper = if up.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
        Direction::new_normalize(helper - ahead.into_inner() * ahead.dot(&helper))
    });
    let y = ahead.cross(&x);
    let axes = nalgebra::Matrix3::from_columns(&[x.into_inner(), y, ahead.into_inner()]);
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(axes);
    Pose::from_parts(eye.coords.into(), UnitQuaternion::from_rotation_matrix(&rotation))
}

fn direction(v: &Vector) -> Option<Direction> {
    Direction::try_new(*v, 1e-12).filter(|d| d.iter().all(|c| c.is_finite()))
}

pub(super) fn finite(p: &Point) -> bool {
    p.iter().all(|c| c.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_given_fills_the_view() {
        let points = [[-0.3, 0.0, 0.0], [0.3, 0.1, 0.0], [0.0, 0.3, 0.2], [0.0, -0.2, 0.0]];
        let points = points.map(Point::from);
        let view = View::towards(&points, &Vector::z(), &Point::new(0.4, -1.0, 0.8));
        let [x, y] = view.spans(&points);
        for (span, reach) in [(x, view.reach[0]), (y, view.reach[1])] {
            assert!(span[0] >= -reach && span[1] <= reach && span[1] > 0.85 * reach, "{span:?}");
        }
    }

    #[test]
    fn a_higher_viewpoint_keeps_its_distance() {
        let points = [Point::new(-1.0, 0.0, 0.0), Point::new(1.0, 0.0, 0.0)];
        let from = Point::new(0.0, -3.0, 0.0);
        let turned = View::turned(&points, &Vector::z(), &from, 0.0, 0.5);
        assert!((turned.z - 3.0 * 0.5f64.sin()).abs() < 1e-12, "{turned}");
        assert!((turned.coords.norm() - 3.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_and_nonsense_still_give_a_view() {
        let nan = Point::new(f64::NAN, 0.0, 0.0);
        for points in [&[][..], &[nan], &[Point::origin()]] {
            let view = View::towards(points, &Vector::zeros(), &nan);
            assert!(view.pose.translation.vector.iter().all(|c| c.is_finite()));
            assert!(view.reach.iter().all(|r| *r > 0.0 && r.is_finite()));
        }
    }
}
