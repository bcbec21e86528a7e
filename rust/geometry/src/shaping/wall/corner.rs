//! The section of a wall that ends in a level plane, with an arc between them.

/// A wall that rises by a constant angle to a level plane, which an arc joins to it.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Rise of the wall per length in plan.
    slope: f64,
    /// Height of the plane, mm.
    top: f64,
    /// Radius of the arc, mm; 0 for none.
    radius: f64,
    /// Wall angle, rad.
    angle: f64,
    /// From where wall and plane would meet to where the arc ends on the plane, mm.
    tangent: f64,
}

impl Corner {
    pub fn new(angle: f64, top: f64, radius: f64) -> Self {
        Self { slope: libm::tan(angle), top, radius, angle, tangent: radius * libm::tan(0.5 * angle) }
    }

    /// Least height that the arc takes below the plane, mm: r (1 - cos a).
    pub fn least(angle: f64, radius: f64) -> f64 {
        radius * (1.0 - libm::cos(angle))
    }

    /// How much higher the wall alone would be where the arc ends on the plane, mm.
    pub fn beyond(angle: f64, radius: f64) -> f64 {
        radius * libm::tan(0.5 * angle) * libm::tan(angle)
    }

    pub fn slope(&self) -> f64 {
        self.slope
    }

    pub fn top(&self) -> f64 {
        self.top
    }

    /// Height where the wall goes over into the arc, mm.
    pub fn begins(&self) -> f64 {
        self.top - Self::least(self.angle, self.radius)
    }

    /// The section's height where the wall alone would be `wall` high, mm.
    pub fn height(&self, wall: f64) -> f64 {
        let x = (wall - self.top) / self.slope;
        if wall <= self.begins() {
            wall
        } else if x >= self.tangent {
            self.top
        } else {
            let left = self.tangent - x;
            self.top - self.radius + (self.radius * self.radius - left * left).max(0.0).sqrt()
        }
    }

    /// The section's rise per length in plan there.
    pub fn rise(&self, wall: f64) -> f64 {
        let x = (wall - self.top) / self.slope;
        if wall <= self.begins() {
            self.slope
        } else if x >= self.tangent {
            0.0
        } else {
            let left = self.tangent - x;
            left / (self.radius * self.radius - left * left).max(f64::MIN_POSITIVE).sqrt()
        }
    }

    /// Heights of the wall alone at which the section has corners when its arc is followed within `tolerance`, mm: where the arc
    /// begins, on it, and where the plane is reached.
    pub fn levels(&self, tolerance: f64) -> Vec<f64> {
        if self.radius <= 0.0 {
            return vec![self.top];
        }
        let step = (8.0 * tolerance / self.radius).sqrt();
        let count = (self.angle / step).ceil().max(1.0) as u32;
        let level = |i: u32| {
            let angle = self.angle * (1.0 - f64::from(i) / f64::from(count));
            self.top + self.slope * (self.tangent - self.radius * libm::sin(angle))
        };
        (0..=count).map(level).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_joins_wall_and_plane_without_a_crease() {
        let angle = 1.0_f64;
        let corner = Corner::new(angle, 10.0, 4.0);
        let levels = corner.levels(0.001);
        let (first, last) = (levels[0], levels[levels.len() - 1]);
        assert!(
            (first - corner.begins()).abs() < 1e-12 && (first - (10.0 - 4.0 * (1.0 - libm::cos(angle)))).abs() < 1e-12
        );
        assert!((corner.height(last) - 10.0).abs() < 1e-12);
        assert!((corner.rise(first + 1e-9) - libm::tan(angle)).abs() < 1e-6 && corner.rise(last - 1e-9) < 1e-6);
        for pair in levels.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let chord = 0.5 * (corner.height(pair[0]) + corner.height(pair[1]));
            let off = corner.height(middle) - chord;
            assert!((0.0..=0.0011 / libm::cos(angle)).contains(&off), "{off}");
        }
    }
}
