//! A function of one variable as polynomials: what a drop-cutter asks a cutter most often.
//!
//! A cell whose polynomial does not follow the function to rounding (at a kink, or beside a vertical tangent) has none:
//! there the function itself is asked.

/// Cells.
const CELLS: usize = 256;
/// Coefficients of a polynomial: one line of a processor's cache.
const TERMS: usize = 8;
/// How far a polynomial may be from the function, as a share of the function's size.
pub const ROUNDING: f64 = 2e-15;

/// Where in a cell a polynomial is compared with the function, in u: between its nodes.
const CHECKED: [f64; 4] = [-1.0, -0.38, 0.19, 1.0];

/// A function from 0 to some end by polynomials in u, which runs from -1 to 1 in each cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    cells_per_unit: f64,
    cells: Vec<Option<[f64; TERMS]>>,
}

impl Piecewise {
    /// Follows `exact` from 0 to `end`; `size` is what rounding is a share of.
    pub fn of(end: f64, size: f64, exact: impl Fn(f64) -> f64) -> Self {
        let width = end / CELLS as f64;
        let nodes = chebyshev_nodes();
        let cell = |cell: usize| {
            let at = |u: f64| exact((cell as f64 + 0.5 + 0.5 * u) * width);
            let polynomial = through(&nodes, &nodes.map(at));
            let follows = |u: f64| (evaluated(&polynomial, u) - at(u)).abs() <= ROUNDING * size;
            CHECKED.into_iter().all(follows).then_some(polynomial)
        };
        Self { cells_per_unit: 1.0 / width, cells: (0..CELLS).map(cell).collect() }
    }

    /// The value at `x`; none where only the function knows.
    #[inline]
    pub fn value_at(&self, x: f64) -> Option<f64> {
        let (polynomial, u) = self.polynomial(x)?;
        Some(evaluated(polynomial, u))
    }

    /// The value and its first two derivatives at `x`; none where only the function knows.
    #[inline]
    pub fn at(&self, x: f64) -> Option<[f64; 3]> {
        let (polynomial, u) = self.polynomial(x)?;
        let (mut value, mut first, mut second) = (0.0, 0.0, 0.0);
        for coefficient in polynomial.iter().rev() {
            second = second * u + first;
            first = first * u + value;
            value = value * u + coefficient;
        }
        let per_unit = 2.0 * self.cells_per_unit;
        Some([value, first * per_unit, 2.0 * second * per_unit * per_unit])
    }

    #[inline]
    fn polynomial(&self, x: f64) -> Option<(&[f64; TERMS], f64)> {
        let x = x * self.cells_per_unit;
        let cell = x as usize;
        let polynomial = self.cells.get(cell)?.as_ref()?;
        Some((polynomial, 2.0 * (x - cell as f64) - 1.0))
    }
}

#[inline]
fn evaluated(polynomial: &[f64; TERMS], u: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |value, coefficient| value * u + coefficient)
}

fn chebyshev_nodes() -> [f64; TERMS] {
    std::array::from_fn(|i| -libm::cos(std::f64::consts::PI * (i as f64 + 0.5) / TERMS as f64))
}

/// Coefficients of the polynomial through values at nodes: divided differences, then multiplied out.
fn through(nodes: &[f64; TERMS], values: &[f64; TERMS]) -> [f64; TERMS] {
    let mut differences = *values;
    for order in 1..TERMS {
        for i in (order..TERMS).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - order]);
        }
    }
    let mut polynomial = [0.0; TERMS];
    for i in (0..TERMS).rev() {
        for k in (1..TERMS).rev() {
            polynomial[k] = polynomial[k - 1] - nodes[i] * polynomial[k];
        }
        polynomial[0] = differences[i] - nodes[i] * polynomial[0];
    }
    polynomial
}

#[cfg(test)]
mod tests {
    use crate::profile::samples::any_profile;
    use crate::Cutter;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn polynomials_are_the_profile(profile in any_profile(), ball in prop_oneof![Just(0.0), 0.0..3.0_f64], share in 0.0..1.0_f64) {
            let cutter = Cutter::new(&profile, ball);
            let radius = share * cutter.max_radius();
            let exact = cutter.height_at_radius(radius);
            prop_assert!((cutter.quick_height_at_radius(radius) - exact).abs() <= 1e-14 * (cutter.max_radius() + cutter.max_height()));
        }
    }
}
