//! Random surfaces about 12 mm wide: bumps, ridges, steps with upright walls, needles, bowls, rubble.

use styluscam_geometry::{Mesh, Vector};

use super::common::dice::Dice;

/// Cells on a side.
const CELLS: usize = 24;
/// Side of a cell, mm.
const PITCH: f64 = 0.5;

/// A kind of surfaces.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    Bumps,
    Ridges,
    /// Ends of a cell's sides that fall together in plan: walls stand upright.
    Steps,
    Needles,
    /// With a plane in slivers from one corner under it, as tessellators make them.
    Bowl,
    /// Random heights, many of them equal.
    Rubble,
    /// Level plates far apart in height, of triangles that share no corners, with gaps between: beside them nothing is.
    Plates,
}

/// All kinds.
pub const SURFACES: [Surface; 7] = [
    Surface::Bumps,
    Surface::Ridges,
    Surface::Steps,
    Surface::Needles,
    Surface::Bowl,
    Surface::Rubble,
    Surface::Plates,
];

/// The middle of every surface in plan.
pub const MIDDLE: f64 = 0.5 * CELLS as f64 * PITCH;

impl Surface {
    pub fn mesh(self, dice: &mut Dice) -> Mesh {
        if matches!(self, Self::Plates) {
            return plates(dice);
        }
        let side = CELLS + 1;
        let (phase, long) = (dice.within(0.0, 6.0), dice.within(0.7, 1.4));
        let corner = |i: usize| self.corner((i % side) as f64, (i / side) as f64, phase, long, dice);
        let mut vertices: Vec<Vector> = (0..side * side).map(corner).collect();
        let mut triangles = Vec::new();
        for row in 0..CELLS {
            for column in 0..CELLS {
                let (i, n) = ((row * side + column) as i64, side as i64);
                triangles.extend([[i, i + 1, i + n + 1], [i, i + n + 1, i + n]]);
            }
        }
        if matches!(self, Self::Bowl) {
            fan(&mut vertices, &mut triangles);
        }
        Mesh::new(vertices, &triangles, &[]).unwrap()
    }

    fn corner(self, column: f64, row: f64, phase: f64, long: f64, dice: &mut Dice) -> Vector {
        let (x, y) = (PITCH * column, PITCH * row);
        let z = match self {
            Self::Bumps => libm::sin(long * x + phase) * libm::cos(1.3 * y),
            Self::Ridges => (2.0 - (libm::fmod(long * x + 0.7 * y + phase, 4.0) - 2.0).abs()).abs(),
            Self::Steps => 1.5 * dice.below(2) as f64,
            Self::Needles if dice.chance(0.05) => dice.within(0.0, 6.0),
            Self::Needles => 0.0,
            Self::Bowl => 0.08 * long * ((x - MIDDLE) * (x - MIDDLE) + (y - MIDDLE) * (y - MIDDLE)),
            Self::Rubble if dice.chance(0.3) => 1.0,
            Self::Rubble | Self::Plates => dice.within(0.0, 4.0),
        };
        if matches!(self, Self::Steps) {
            let inward = PITCH * libm::fmod(column, 2.0) * f64::from(z == 0.0);
            return Vector::new(libm::floor(column / 2.0) + inward, y, z);
        }
        Vector::new(x, y, z)
    }
}

fn fan(vertices: &mut Vec<Vector>, triangles: &mut Vec<[i64; 3]>) {
    let corner = vertices.len() as i64;
    vertices.push(Vector::new(-20.0, -20.0, 1.0));
    for i in 0..80 {
        vertices.push(Vector::new(30.0, -20.0 + 0.6 * i as f64, 1.0));
        if i > 0 {
            triangles.push([corner, corner + i, corner + i + 1]);
        }
    }
}

fn plates(dice: &mut Dice) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for _ in 0..2 + dice.below(8) {
        let [x, y] = [(); 2].map(|()| MIDDLE + dice.within(-2.5, 2.0));
        let [dx, dy] = [(); 2].map(|()| dice.within(0.1, 0.9));
        let z = [0.0, 0.1, 1.0, 3.0, 30.0][dice.below(5)];
        let [p, q, r, s] = [[0.0, 0.0], [dx, 0.0], [dx, dy], [0.0, dy]].map(|[dx, dy]| Vector::new(x + dx, y + dy, z));
        for half in [[p, q, r], [p, r, s]] {
            let first = vertices.len() as i64;
            triangles.push([first, first + 1, first + 2]);
            vertices.extend(half);
        }
    }
    Mesh::new(vertices, &triangles, &[]).unwrap()
}
