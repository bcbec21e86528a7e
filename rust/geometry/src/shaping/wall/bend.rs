//! The section of a wall at the edge from which it rises: an arc from the part's own slope there to the wall's.

/// A wall that leaves an edge by one angle and turns to another one in an arc; with a radius of 0 it has the second all along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Angle at the edge, rad, below a right angle.
    pub from: f64,
    /// Wall angle, rad.
    pub to: f64,
    /// Radius of the arc, mm.
    pub radius: f64,
}

impl Bend {
    /// How long the arc is in plan, mm: r |sin a - sin b|.
    pub fn length(&self) -> f64 {
        self.until(self.to)
    }

    /// How high the arc is, mm: r |cos a - cos b|.
    pub fn climb(&self) -> f64 {
        self.radius * (libm::cos(self.from) - libm::cos(self.to)).abs()
    }

    /// From the edge to where the section has an angle of its arc, in plan, mm.
    fn until(&self, angle: f64) -> f64 {
        self.radius * (libm::sin(angle) - libm::sin(self.from)).abs()
    }

    /// Height above the edge at a distance from it in plan, mm.
    pub fn height(&self, distance: f64) -> f64 {
        let beyond = distance - self.length();
        if beyond >= 0.0 {
            return self.climb() + beyond * libm::tan(self.to);
        }
        let sine = self.sine(distance);
        self.radius * (libm::cos(self.from) - (1.0 - sine * sine).max(0.0).sqrt()).abs()
    }

    /// Rise per length in plan there.
    pub fn rise(&self, distance: f64) -> f64 {
        if distance >= self.length() {
            return libm::tan(self.to);
        }
        let sine = self.sine(distance);
        sine / (1.0 - sine * sine).max(f64::MIN_POSITIVE).sqrt()
    }

    /// The sine of the section's angle on its arc.
    fn sine(&self, distance: f64) -> f64 {
        let turn = if self.to >= self.from { distance } else { -distance };
        libm::sin(self.from) + turn / self.radius
    }

    /// Distances from the edge at which the arc has corners when `count` chords follow it, mm; at least `least` apart.
    pub fn corners(&self, count: u32, least: f64) -> impl Iterator<Item = f64> + '_ {
        (1..=count).map(move |i| {
            let share = f64::from(i) / f64::from(count);
            self.until(self.from + share * (self.to - self.from)).max(f64::from(i) * least)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_joins_both_slopes_without_a_crease() {
        for (from, to) in [(0.2, 0.9), (1.2, 0.7), (0.0, 1.0), (1.5, 0.3)] {
            let bend = Bend { from, to, radius: 4.0 };
            let end = bend.length();
            assert!(bend.height(0.0).abs() < 1e-12 && (bend.rise(0.0) - libm::tan(from)).abs() < 1e-9);
            assert!((bend.height(end - 1e-9) - bend.climb()).abs() < 1e-7);
            assert!((bend.rise(end - 1e-9) - libm::tan(to)).abs() < 1e-6);
            assert!((bend.height(end + 2.0) - bend.climb() - 2.0 * libm::tan(to)).abs() < 1e-12);
            for i in 1..100 {
                let at = 0.01 * end * f64::from(i);
                let slope = (bend.height(at + 1e-6) - bend.height(at - 1e-6)) / 2e-6;
                assert!((slope - bend.rise(at)).abs() < 1e-4 * (1.0 + slope), "{from} {to} {at}");
            }
        }
        let plain = Bend { from: 0.5, to: 0.5, radius: 0.0 };
        assert!((plain.height(3.0) - 3.0 * libm::tan(0.5)).abs() < 1e-12 && plain.length() <= 0.0);
    }
}
