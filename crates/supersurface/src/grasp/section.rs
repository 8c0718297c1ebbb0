//! The points of a superellipse whose normals run through its centre: where two opposite fingers can close.
//!
//! `|u/A|^(2/ε) + |v/B|^(2/ε) = 1`. Its width in a direction is stationary at the two vertices, and, unless
//! `ε = 1`, at one point of each quadrant: `tan ω* = (A/B)^(1/(ε-1))` (FORMULAS §8, in the place of the paper's
//! equations (42) and (43)). For `ε < 1` the vertices are the narrow places and `ω*` the corner; for `ε > 1`
//! it is the other way round.

/// A superellipse by its semi-axes and its exponent, all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Semi-axis `A` along u.
    pub a: f64,
    /// Semi-axis `B` along v.
    pub b: f64,
    /// Exponent `ε`.
    pub epsilon: f64,
}

/// An antipodal point in the first quadrant: its mirror image through the centre faces it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stationary {
    /// `[u, v]`; the unit normal is this over its length.
    pub point: [f64; 2],
    /// Curvature there; `None` where it is infinite.
    pub curvature: Option<f64>,
}

impl Stationary {
    /// Distance from the centre: half the width there.
    pub fn radius(&self) -> f64 {
        self.point[0].hypot(self.point[1])
    }
}

impl Section {
    /// The vertex `(A, 0)`.
    ///
    /// ```
    /// use supersurface::grasp::Section;
    /// let rounded_box = Section { a: 0.03, b: 0.05, epsilon: 0.2 };
    /// assert_eq!(rounded_box.first().curvature, Some(0.0));
    /// let diamond = Section { a: 0.03, b: 0.05, epsilon: 1.5 };
    /// assert!(diamond.first().curvature.is_none());
    /// assert!(diamond.interior().unwrap().radius() < 0.03);
    /// ```
    pub fn first(&self) -> Stationary {
        Stationary { point: [self.a, 0.0], curvature: vertex(self.epsilon, self.a, self.b) }
    }

    /// The vertex `(0, B)`.
    pub fn second(&self) -> Stationary {
        Stationary { point: [0.0, self.b], curvature: vertex(self.epsilon, self.b, self.a) }
    }

    /// The point at `ω*`; `None` for `ε = 1`, where there is none or every point is one.
    pub fn interior(&self) -> Option<Stationary> {
        if self.epsilon == 1.0 {
            return None;
        }
        let tau = (self.a / self.b).ln() / (self.epsilon - 1.0);
        // ln cos and ln sin of ω*, without overflow for any τ
        let log_cos = if tau > 0.0 {
            -tau - 0.5 * (-2.0 * tau).exp().ln_1p()
        } else {
            -0.5 * (2.0 * tau).exp().ln_1p()
        };
        Some(self.at(log_cos, log_cos + tau))
    }

    /// The point of the angle parameter 45 degrees.
    pub fn middle(&self) -> Stationary {
        let log = -0.5 * std::f64::consts::LN_2;
        self.at(log, log)
    }

    /// `κ = (2/ε - 1) (cos ω sin ω)^(2-2ε) / (A² B²) / (cos^(4-2ε) ω / A² + sin^(4-2ε) ω / B²)^(3/2)`
    /// (FORMULAS §6).
    fn at(&self, log_cos: f64, log_sin: f64) -> Stationary {
        let Self { a, b, epsilon } = *self;
        let point = [a * (epsilon * log_cos).exp(), b * (epsilon * log_sin).exp()];
        let normal = [((2.0 - epsilon) * log_cos).exp() / a, ((2.0 - epsilon) * log_sin).exp() / b];
        let bend = ((2.0 - 2.0 * epsilon) * (log_cos + log_sin)).exp() / (a * b * a * b);
        let slope = normal[0].hypot(normal[1]);
        let curvature = (2.0 / epsilon - 1.0) * bend / (slope * slope * slope);
        Stationary { point, curvature: curvature.is_finite().then_some(curvature) }
    }
}

/// Curvature at the end of the semi-axis `own`.
fn vertex(epsilon: f64, own: f64, other: f64) -> Option<f64> {
    if epsilon < 1.0 {
        Some(0.0)
    } else if epsilon == 1.0 {
        Some(own / (other * other))
    } else {
        None
    }
}
