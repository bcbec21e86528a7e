//! Coordinate systems: where the program's zero stands in the machine, and how it is turned.

/// A coordinate system of the machine, G54 to G59.3.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct System {
    /// Its zero in machine coordinates, mm.
    pub(super) origin: [f64; 3],
    /// How it is turned about Z, degrees.
    pub(super) turn_deg: f64,
}

/// How many there are.
pub(super) const SYSTEMS: usize = 9;

/// The code of a coordinate system, in tenths: G54 to G59, G59.1 to G59.3.
pub(super) fn system_code(index: usize) -> u32 {
    let index = index as u32;
    if index < 6 {
        540 + 10 * index
    } else {
        585 + index
    }
}

/// What lies between the program's coordinates and the position of the tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Offsets {
    /// As they are stored, G54 first; one that is in force takes a change when it is called again.
    pub(super) stored: [System; SYSTEMS],
    /// The index of the one in force.
    pub(super) index: usize,
    /// As it was when it was called.
    pub(super) system: System,
    /// G92's and G52's, mm, within the system.
    pub(super) local: [f64; 3],
    /// From the tip to the machine's point, mm.
    pub(super) tool: [f64; 3],
}

impl Offsets {
    /// The tip's position in space, in the machine's coordinates less the tool's length, mm.
    pub(super) fn in_space(&self, position: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = add(position, self.local);
        let [x, y] = turned([x, y], self.system.turn_deg);
        add([x, y, z], self.system.origin)
    }

    /// The program's coordinates of a position of the tip.
    pub(super) fn of_space(&self, position: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = less(position, self.system.origin);
        let [x, y] = turned([x, y], -self.system.turn_deg);
        less([x, y, z], self.local)
    }

    /// Where the machine stands when the tip is at a position in program coordinates, mm.
    pub(super) fn in_machine(&self, position: [f64; 3]) -> [f64; 3] {
        add(self.in_space(position), self.tool)
    }

    /// The program's coordinates of the tip where the machine stands.
    pub(super) fn of_machine(&self, position: [f64; 3]) -> [f64; 3] {
        self.of_space(less(position, self.tool))
    }

    /// Takes a system into force as it is stored.
    pub(super) fn call(&mut self, index: usize) {
        self.index = index;
        self.system = self.stored.get(index).copied().unwrap_or_default();
    }

    /// Where the zero of a system has to be that a machine position has these coordinates in it, and else those it has.
    pub(super) fn origin_for(&self, machine: [f64; 3], words: [Option<f64>; 3], index: usize) -> [f64; 3] {
        let system = self.stored.get(index).copied().unwrap_or_default();
        let there = Self { system, ..*self };
        let coordinates = there.of_machine(machine);
        let coordinates = [0, 1, 2].map(|axis| words[axis].unwrap_or(coordinates[axis]));
        let [x, y, z] = add(coordinates, self.local);
        let [x, y] = turned([x, y], system.turn_deg);
        less(less(machine, self.tool), [x, y, z])
    }
}

/// A point turned about zero.
pub(super) fn turned([x, y]: [f64; 2], degrees: f64) -> [f64; 2] {
    if degrees == 0.0 {
        return [x, y];
    }
    let (sin, cos) = libm::sincos(degrees.to_radians());
    [x * cos - y * sin, x * sin + y * cos]
}

pub(super) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        less(a, b).iter().all(|gap| gap.abs() < 1e-12)
    }

    #[test]
    fn there_and_back() {
        let offsets = Offsets {
            system: System { origin: [1.0, 2.0, 3.0], turn_deg: 90.0 },
            local: [10.0, 0.0, 0.0],
            tool: [0.0, 0.0, 4.0],
            ..Offsets::default()
        };
        assert!(near(offsets.in_space([1.0, 0.0, 0.0]), [1.0, 13.0, 3.0]));
        assert!(near(offsets.in_machine([1.0, 0.0, 0.0]), [1.0, 13.0, 7.0]));
        assert!(near(offsets.of_machine([1.0, 13.0, 7.0]), [1.0, 0.0, 0.0]));
    }

    #[test]
    fn a_zero_is_set_by_the_coordinates_that_the_position_gets() {
        // LinuxCNC 2.9.4: G10 L2 P1 X1 Y2 R30, G92 to [10, 0], at X1 Y0, then G10 L20 P1 X3 Y3
        let mut offsets = Offsets { local: [10.0, 0.0, 0.0], ..Offsets::default() };
        offsets.stored[0] = System { origin: [1.0, 2.0, 0.0], turn_deg: 30.0 };
        offsets.call(0);
        let machine = offsets.in_machine([1.0, 0.0, 5.0]);
        let [x, y, z] = offsets.origin_for(machine, [Some(3.0), Some(3.0), None], 0);
        assert!((x - 0.7679).abs() < 5e-5 && (y + 1.5981).abs() < 5e-5 && z == 0.0, "{x} {y} {z}");
    }
}
