//! What passes would leave, measured: by how much the metric of [`Spacing`](super::stations::Spacing) is wrong where the face or
//! the tool change within a step.
//!
//! Around each node the two passes are looked at that have it in their midst: the tool stands on both, and its distances from what
//! it touches at the node are the ridge between them, whatever the curvatures.

use std::f64::consts::FRAC_PI_2;

use rayon::prelude::*;
use styluscam_geometry::{Cutter, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::net::Net;
use super::stations::Station;
use crate::Surface;

/// Passes are looked at so far from a node, passes.
const HALF: f64 = 0.5;
/// Where the metric makes it so much farther to them, a crease lies between, which has a pass of its own.
const NEAR: f64 = 0.8;
/// Slope of the field at least: elsewhere fronts meet.
const ONE_FRONT: f64 = 0.93;
/// The least and the largest factor.
const FACTORS: [f64; 2] = [1.0, 1.6];
/// Times that each node takes the mean of those around it: facets make single ones uncertain.
const SMOOTHED: usize = 3;
/// Of the slope at which the tool is nearest to a point it is looked within this on both sides, rad.
const SLOPES: f64 = 0.7;
/// Steps of the golden section: 0.7 rad to a thousandth.
const STEPS: usize = 16;

/// For each node the factor by which passes should lie closer there than the field has them, to leave ridges of `height`, mm; 1
/// where that is not known.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub fn factors(
    net: &Net,
    surface: &Surface<'_>,
    values: &[f64],
    height: f64,
    watch: &Watch,
) -> Result<Vec<f64>, Cancelled> {
    let step =
        |node: usize| net.stations[node].and_then(|_| net.step(values, node)).filter(|(_, slope)| *slope >= ONE_FRONT);
    let steps: Vec<(usize, [f64; 2])> =
        (0..net.stations.len()).into_par_iter().filter_map(|node| Some((node, step(node)?.0))).collect();
    let beside = |(node, step): &(usize, [f64; 2])| {
        let at = net.position(*node);
        [-HALF, HALF].map(|share| [0, 1].map(|i| at[i] + share * step[i]))
    };
    let positions: Vec<[f64; 2]> = steps.par_iter().flat_map_iter(beside).collect();
    watch.begin("ridges", positions.len());
    let contacts = surface.envelope().contacts(&positions, watch)?;
    let tip_above = surface.envelope().tip_on(0.0);
    let factor = |node: usize, at: &[[f64; 2]], contacts: &[Option<_>]| {
        let here = net.stations[node]?;
        let passes = at.iter().zip(contacts).filter_map(|(at, contact)| Station::of(surface, *at, contact.as_ref()?));
        let passes = passes.filter(|pass| net.spacing.between(&here, pass) <= NEAR);
        let left = passes.map(|pass| {
            let point = here.contact - pass.tip + Vector::new(0.0, 0.0, tip_above);
            distance(surface.envelope().cutter(), point, here.normal).max(0.0).sqrt()
        });
        let (sum, count) = left.fold((0.0, 0), |(sum, count), root| (sum + root, count + 1));
        // of a parabola the root grows evenly: the mean is that in the midst, wherever the node is
        (count > 0).then(|| (node, (sum / f64::from(count) / height.sqrt()).clamp(FACTORS[0], FACTORS[1])))
    };
    let sides = positions.par_chunks(2).zip(contacts.par_chunks(2));
    let found = steps.par_iter().zip(sides).filter_map(|((node, _), (at, contacts))| factor(*node, at, contacts));
    let mut factors = vec![None; net.stations.len()];
    for (node, factor) in found.collect::<Vec<_>>() {
        factors[node] = Some(factor);
    }
    Ok(smoothed(net, factors))
}

/// Each factor as the mean of those around it; 1 where there is none.
fn smoothed(net: &Net, mut factors: Vec<Option<f64>>) -> Vec<f64> {
    let width = net.lattice.columns + 1;
    for _ in 0..SMOOTHED {
        let mean = |node: usize| {
            let own = factors[node]?;
            let around = [node.checked_sub(1), node.checked_sub(width), node.checked_add(1), node.checked_add(width)];
            let around = around.into_iter().flatten().filter_map(|other| factors.get(other).copied().flatten());
            let (sum, count) = around.fold((own, 1), |(sum, count), other| (sum + other, count + 1));
            Some(sum / f64::from(count))
        };
        factors = (0..factors.len()).into_par_iter().map(mean).collect();
    }
    factors.into_iter().map(|factor| factor.unwrap_or(1.0)).collect()
}

/// Distance of a point outside of a cutter from it, mm; `normal` is about the direction in which it lies from what is touched.
fn distance(cutter: &Cutter, point: Vector, normal: Vector) -> f64 {
    let radius = libm::hypot(point.x, point.y);
    let slope = libm::atan2(libm::hypot(normal.x, normal.y), normal.z);
    let over = |slope: f64| cutter.gap(radius, point.z, slope);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = ((slope - SLOPES).max(0.0), (slope + SLOPES).min(FRAC_PI_2));
    let mut inner = [high - golden * (high - low), low + golden * (high - low)];
    let mut found = inner.map(over);
    for _ in 0..STEPS {
        if found[0] >= found[1] {
            high = inner[1];
            inner = [high - golden * (high - low), inner[0]];
            found = [over(inner[0]), found[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + golden * (high - low)];
            found = [found[1], over(inner[1])];
        }
    }
    found[0].max(found[1])
}

#[cfg(test)]
mod tests {
    use styluscam_geometry::{kinds, Tool, ToolDocument};

    use super::*;

    #[test]
    fn the_distance_from_a_ball_is_that_from_its_centre() {
        let ball = kinds::Ball { diameter: 6.0, radius: None, tip_flat: 0.0 };
        let cutter = Tool::new(ToolDocument::of(ball.into())).unwrap().cutter();
        for point in [Vector::new(1.0, 0.4, -0.1), Vector::new(0.2, 0.0, -0.02), Vector::new(-2.5, 1.0, 0.9)] {
            let normal = Vector::new(-point.x, -point.y, 3.0 - point.z).normalize();
            let expected = (point - Vector::new(0.0, 0.0, 3.0)).norm() - 3.0;
            assert!((distance(&cutter, point, normal) - expected).abs() < 1e-6, "{point}");
        }
    }
}
