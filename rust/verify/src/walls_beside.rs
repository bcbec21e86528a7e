//! The walls that a tool was pushed out of: it slides along them to a point, since a pull into them would be undone by the next
//! push (the projected gradient of J. B. Rosen, SIAM J. Appl. Math. 8, 1960, with two active constraints).

use styluscam_geometry::Vector;

/// Pushed normals nearer to each other than this, a cosine, are of one wall.
const SAME_WALL: f64 = 0.9;

/// After so many pulls without a push a wall is forgotten: walls bend, and the tool may have left it. Of 2, 3 and 5, measured on
/// the cap R60 with a ball, 5 took the fewest steps, and what was left was less than without walls.
const REMEMBERED: u32 = 5;

/// A wall.
#[derive(Clone, Copy)]
struct Wall {
    /// Out of it.
    normal: Vector,
    /// Pulls since it pushed the tool out.
    pulls: u32,
}

/// The last two walls, the later one first.
#[derive(Default)]
pub(crate) struct Walls([Option<Wall>; 2]);

impl Walls {
    /// A wall pushed the tool out along its normal.
    pub(crate) fn push(&mut self, normal: Vector) {
        let [last, before] = self.0;
        let is_same = last.is_some_and(|last| last.normal.dot(&normal) > SAME_WALL);
        self.0 = [Some(Wall { normal, pulls: 0 }), if is_same { before } else { last }];
    }

    /// The tool was pulled.
    pub(crate) fn pulled(&mut self) {
        let older = self.0.map(|wall| wall.map(|wall| Wall { pulls: wall.pulls + 1, ..wall }));
        self.0 = older.map(|wall| wall.filter(|wall| wall.pulls < REMEMBERED));
    }

    /// What of a pull does not lead into the walls.
    pub(crate) fn along(&self, pull: Vector) -> Vector {
        let into = |step: Vector, wall: Option<Wall>| wall.map(|wall| wall.normal).filter(|n| step.dot(n) < 0.0);
        let Some(first) = into(pull, self.0[0]) else { return into(pull, self.0[1]).map_or(pull, |n| slid(pull, n)) };
        let step = slid(pull, first);
        let Some(second) = into(step, self.0[1]) else { return step };
        let edge = first.cross(&second).try_normalize(1e-6);
        edge.map_or(Vector::zeros(), |edge| edge * edge.dot(&pull))
    }
}

/// A step without its part against a normal.
fn slid(step: Vector, normal: Vector) -> Vector {
    step - normal * step.dot(&normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pull_slides_along_one_wall_and_along_the_edge_of_two() {
        let mut walls = Walls::default();
        let pull = Vector::new(-1.0, 2.0, -3.0);
        assert_eq!(walls.along(pull), pull);
        walls.push(Vector::z());
        assert_eq!(walls.along(pull), Vector::new(-1.0, 2.0, 0.0));
        walls.push(Vector::x());
        assert_eq!(walls.along(pull), Vector::new(0.0, 2.0, 0.0));
        assert_eq!(walls.along(-pull), Vector::new(1.0, 0.0 - 2.0, 3.0));
        for _ in 0..REMEMBERED {
            walls.pulled();
        }
        assert_eq!(walls.along(pull), pull);
    }

    #[test]
    fn a_wall_that_bends_stays_one() {
        let mut walls = Walls::default();
        walls.push(Vector::x());
        walls.push(Vector::z());
        walls.push(Vector::new(0.1, 0.0, 1.0).normalize());
        assert!(walls.0[1].is_some_and(|wall| wall.normal == Vector::x()));
    }
}
