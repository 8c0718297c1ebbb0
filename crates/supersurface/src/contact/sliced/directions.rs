//! Cells of directions: squares on the faces of a cube, seen from its centre.

use crate::Vector;

/// Cells of the first level along an edge of the cube.
const FIRST: usize = 3;

/// A square on a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    face: usize,
    middle: [f64; 2],
    half: f64,
}

impl Cell {
    /// Cells that cover the cube.
    pub(super) fn all() -> Vec<Self> {
        let half = 1.0 / FIRST as f64;
        let place = |k: usize| (2 * (k % FIRST) + 1) as f64 * half - 1.0;
        let cell = |k: usize| Self {
            face: k / (FIRST * FIRST),
            middle: [place(k / FIRST), place(k)],
            half,
        };
        (0..6 * FIRST * FIRST).map(cell).collect()
    }

    pub(super) fn quarters(&self) -> [Self; 4] {
        let half = 0.5 * self.half;
        [(-half, -half), (-half, half), (half, -half), (half, half)].map(|(x, y)| {
            let middle = [self.middle[0] + x, self.middle[1] + y];
            Self { middle, half, ..*self }
        })
    }

    /// The unit direction of its middle.
    pub(super) fn way(&self) -> Vector {
        self.direction(self.middle)
    }

    /// The largest distance of its unit directions from that of its middle: that of a corner.
    pub(super) fn spread(&self) -> f64 {
        let ([x, y], h) = (self.middle, self.half);
        let corners = [[x - h, y - h], [x - h, y + h], [x + h, y - h], [x + h, y + h]];
        let way = self.way();
        corners.map(|c| (self.direction(c) - way).norm()).into_iter().fold(0.0, f64::max)
    }

    fn direction(&self, [x, y]: [f64; 2]) -> Vector {
        let mut along = [0.0; 3];
        along[self.face % 3] = if self.face < 3 { 1.0 } else { -1.0 };
        along[(self.face + 1) % 3] = x;
        along[(self.face + 2) % 3] = y;
        Vector::from(along).normalize()
    }
}
