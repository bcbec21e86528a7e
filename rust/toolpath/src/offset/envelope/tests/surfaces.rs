//! Random surfaces about 12 mm wide: bumps, ridges, steps with upright walls, needles, bowls, rubble.

use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument, Vector};

use super::common::dice::Dice;

/// Cells on a side.
const CELLS: usize = 24;
/// Side of a cell, mm.
const PITCH: f64 = 0.5;

/// Cells on a side of a plane, of 1 mm.
const PLANE: usize = 7;

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
        let (phase, long) = (dice.within(0.0, 6.0), dice.within(0.7, 1.4));
        let mut vertices = grid(CELLS, |column, row| self.corner(column, row, phase, long, dice));
        let mut triangles = cells(CELLS);
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

/// Corners of a square of cells, row by row, by their column and row.
fn grid(cells: usize, mut corner: impl FnMut(f64, f64) -> Vector) -> Vec<Vector> {
    let side = cells + 1;
    (0..side * side).map(|i| corner((i % side) as f64, (i / side) as f64)).collect()
}

/// Two triangles for each cell of a [`grid`].
fn cells(cells: usize) -> Vec<[i64; 3]> {
    let (cells, n) = (cells as i64, cells as i64 + 1);
    let corners = (0..cells).flat_map(|row| (0..cells).map(move |column| row * n + column));
    corners.flat_map(|i| [[i, i + 1, i + n + 1], [i, i + n + 1, i + n]]).collect()
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

/// A tool, and a plane of many triangles that is as steep as its straight part: rounding of the corners, or more than that, tilts each
/// triangle its own way, and the tool touches each somewhere else.
pub fn plane_and_tool(dice: &mut Dice) -> (Mesh, Tool) {
    let angle_deg = dice.within(30.0, 150.0);
    let (diameter, tip_flat) = (1.5, 0.0);
    let (profile, steep) = match dice.below(5) {
        0 => (ProfileDocument::from(kinds::Flat { diameter, tip_flat }), 0.0),
        1 => (ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.4 }), 0.0),
        2 => (ProfileDocument::from(kinds::Power { diameter, coefficient: 2.0, exponent: 6.0, tip_flat }), 0.0),
        _ => {
            let cone = kinds::V { tip_diameter: 0.2, angle_deg, diameter, tip_flat };
            (ProfileDocument::from(cone), 1.0 / libm::tan(0.5 * angle_deg.to_radians()))
        }
    };
    let tilt = [0.0, 1e-15, 1e-12, 1e-9, 1e-6][dice.below(5)];
    let (sin, cos) = libm::sincos(dice.within(0.0, 6.3));
    let vertices = grid(PLANE, |column, row| {
        let [x, y] = [column, row].map(|at| MIDDLE - 0.5 * PLANE as f64 + at + dice.within(-0.3, 0.3));
        Vector::new(x, y, 3.524_880_774_456_98 + steep * (cos * x + sin * y) + tilt * dice.within(-1.0, 1.0))
    });
    (Mesh::new(vertices, &cells(PLANE), &[]).unwrap(), Tool::new(ToolDocument::of(profile)).unwrap())
}
