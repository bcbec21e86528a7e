//! Single triangles and tools of every kind: the drop-cutter neither gouges nor floats, by a truth of another method.
//!
//! Faults are distances, not heights: near a rim or a wall a height has no bound that a rounding would respect.

use std::time::Instant;

use crate::common::body::{Body, Fault};
use crate::common::dice::Dice;
use crate::common::tools::{self, Kind, KINDS};
use crate::common::triangles::{self, SPOTS};
use rayon::prelude::*;
use styluscam_geometry::{Mesh, Tool, Vector};
use styluscam_toolpath::offset::{Envelope, Index};

/// A fault of less than this, mm, is rounding.
const EXACT: f64 = 1e-9;
/// Triangles for each random tool.
const BY_TOOL: usize = 48;

/// The worst of many triangles.
#[derive(Clone, Debug, Default)]
struct Worst {
    depth: f64,
    gap: f64,
    beside: usize,
    touched: usize,
    case: String,
}

impl Worst {
    fn worst(&self) -> f64 {
        self.depth.max(self.gap)
    }

    fn take(&mut self, fault: Fault, is_touched: bool, case: impl Fn() -> String) {
        if fault.worst() > self.worst() {
            self.case = case();
        }
        (self.depth, self.gap) = (self.depth.max(fault.depth), self.gap.max(fault.gap));
        *if is_touched { &mut self.touched } else { &mut self.beside } += 1;
    }

    fn with(self, other: Self) -> Self {
        let (depth, gap) = (self.depth.max(other.depth), self.gap.max(other.gap));
        let (touched, beside) = (self.touched + other.touched, self.beside + other.beside);
        let case = if other.worst() > self.worst() { other.case } else { self.case };
        Self { depth, gap, beside, touched, case }
    }
}

/// Of `count` triangles of a kind; each kind has triangles of its own.
fn worst_of(number: usize, count: usize) -> Worst {
    let first = (number as u64) << 32;
    let seeds = first..first + count.div_ceil(BY_TOOL) as u64;
    let each = seeds.into_par_iter().map(|seed| worst_of_tool(&KINDS[number], seed));
    each.reduce(Worst::default, Worst::with)
}

fn worst_of_tool(kind: &Kind, seed: u64) -> Worst {
    let mut dice = Dice::new(seed);
    let tool = kind.tool(&mut dice);
    let (sheet, margin) = (tools::sheet(&mut dice), tools::margin(&mut dice));
    let body = Body::new(&tool, sheet.as_ref(), margin);
    let mut worst = Worst::default();
    for _ in 0..BY_TOOL / SPOTS.len() {
        // a cutter is slow to make: one serves triangles that it never meets together
        let triangles = SPOTS.map(|spot| triangles::at(spot, &mut dice));
        let numbers = [0, 1, 2, 3].map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let mesh = Mesh::new(triangles.as_flattened().to_vec(), &numbers, &[]).unwrap();
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, sheet.as_ref(), margin);
        for corners in triangles {
            let [x, y] = triangles::position(&mut dice, &corners, body.radius());
            let contact = envelope.contact(x, y);
            let fault = match contact {
                Some(contact) => body.fault(corners, Vector::new(x, y, contact.tip)),
                None => Fault { depth: -body.aside(corners, [x, y]), gap: 0.0 },
            };
            let profile = &tool.document().profile;
            let case = || format!("{profile:?} {sheet:?} {margin:?} {corners:?} {x:?} {y:?} {contact:?}");
            worst.take(fault, contact.is_some(), case);
        }
    }
    worst
}

fn prove(count: usize) {
    let mut faults = Vec::new();
    println!("{:<24}{:>9}{:>9}{:>10}{:>10}{:>8}", "profile", "touched", "beside", "gouges", "floats", "s");
    for (number, kind) in KINDS.iter().enumerate() {
        let begun = Instant::now();
        let worst = worst_of(number, count);
        println!(
            "{:<24}{:>9}{:>9}{:>10.1e}{:>10.1e}{:>8.1}",
            kind.name,
            worst.touched,
            worst.beside,
            worst.depth,
            worst.gap,
            begun.elapsed().as_secs_f64()
        );
        if worst.worst() > EXACT {
            faults.push(worst.case);
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn no_single_triangle_is_gouged_or_floated_over() {
    prove(500);
}

#[test]
#[ignore = "takes half an hour: make test-long"]
fn no_triangle_of_a_hundred_thousand_of_every_kind_is_gouged_or_floated_over() {
    prove(100_000);
}

/// A tool over one triangle.
fn fault_of(profile: &serde_json::Value, corners: [[f64; 3]; 3], position: [f64; 2]) -> Fault {
    fault_with(profile, 0.0, corners, position)
}

/// The same with a margin.
fn fault_with(profile: &serde_json::Value, margin: f64, corners: [[f64; 3]; 3], [x, y]: [f64; 2]) -> Fault {
    let tool = Tool::new(serde_json::from_value(serde_json::json!({ "profile": profile })).unwrap()).unwrap();
    let corners = corners.map(Vector::from);
    let mesh = Mesh::new(corners.to_vec(), &[[0, 1, 2]], &[]).unwrap();
    let index = Index::new(&mesh);
    let contact = Envelope::new(&mesh, &index, &tool, None, margin).contact(x, y).unwrap();
    Body::new(&tool, None, margin).fault(corners, Vector::new(x, y, contact.tip))
}

#[test]
fn a_corner_at_the_very_rim_is_touched() {
    // 9e-16 mm beside the disc; the edges from it meet the rim 9e-16 mm beyond their ends
    let corners = [
        [0.00040669930447080366, -0.00047675871309451365, 0.0007382488944960773],
        [-0.0009306848326122401, -0.00020282613065832937, -6.062942883619074e-5],
        [0.0008618933541432739, -0.000803354458558952, 0.0001699825563945397],
    ];
    let flat = serde_json::json!({"kind": "flat", "diameter": 15.015298584828404});
    let fault = fault_of(&flat, corners, [-4.117746003240465, 6.2769125247716655]);
    assert!(fault.worst() < EXACT, "{fault:?}");
}

#[test]
fn a_sliver_is_met_where_its_plane_is() {
    // 14 mm long, 1e-8 mm wide
    let corners = [
        [6.247476970541966, -0.11377158403764562, 4.481087811684759],
        [-2.9400433285259857, -3.358965559082532, -6.111262315607094],
        [1.2370024099251657, -1.8835594395391906, -1.2955199229568626],
    ];
    let cone = serde_json::json!({
        "kind": "cone", "tip_radius": 0.0, "half_angle_deg": 13.544726463889553, "diameter": 18.67483636157873
    });
    let fault = fault_of(&cone, corners, [1.2228162462737415, -1.8885702431451408]);
    assert!(fault.worst() < EXACT, "{fault:?}");
}

#[test]
fn a_level_edge_under_the_tip_is_touched() {
    // the polynomials of the profile have a height of -1e-16 mm or so there
    let corners = [
        [-127.00852500987257, 116.0113666798301, 32.99147499012743],
        [-160.0, 127.00852500987257, 32.99147499012743],
        [-192.99147499012741, 149.00284166995752, 21.99431666008495],
    ];
    let parabola = serde_json::json!({"kind": "formula", "z": "r^2 / 2.7619112715119494", "diameter": 5.4340858727381});
    let fault = fault_of(&parabola, corners, [-136.25131565526738, 119.0922968949617]);
    assert!(fault.worst() < EXACT, "{fault:?}");
}

#[test]
fn an_edge_is_followed_over_a_jump_of_the_curvature() {
    let corners = [
        [-160.56266257850487, 161.43768412992756, -15.745592131838308],
        [-159.67496647624762, 159.7457455478534, -16.334268510819065],
        [-159.77499717122114, 159.93640290433729, -16.501427393644903],
    ];
    // a rim, rounded by the margin: Newton's steps went to and fro over the position where it begins
    let power = serde_json::json!({
        "kind": "power", "coefficient": 0.6970275174040432, "exponent": 1.585863994886944,
        "diameter": 1.9497845308707356, "tip_flat": 0.11065991130244025
    });
    let fault = fault_with(&power, 0.13754083052385643, corners, [-161.22235310428664, 160.57476198742808]);
    assert!(fault.worst() < EXACT, "{fault:?}");
}

#[test]
fn three_corners_in_a_line_are_no_plane() {
    // by rounding they have an area, and a normal of no meaning
    let corners = [
        [160.28898037389237, 160.14449018694617, 0.4334705608385481],
        [160.43347056083854, 160.28898037389237, 0.1444901869461827],
        [160.57796074778474, 160.43347056083854, -0.1444901869461827],
    ];
    let bull_nose = serde_json::json!({
        "kind": "bull-nose", "diameter": 5.708463452156437, "corner_radius": 0.03264504582062722,
        "tip_flat": 0.219130309208372
    });
    let fault = fault_of(&bull_nose, corners, [160.49631444691488, 160.35182425996868]);
    assert!(fault.worst() < EXACT, "{fault:?}");
}

#[test]
fn an_edge_that_begins_under_a_sharp_tip_is_followed_upwards() {
    // at the tip the edge's height bends so much that a step of Newton's seems to gain nothing
    let corners = [
        [-160.3473604025708, -162.0706582382985, 37.207655517868886],
        [-158.825806778312, -158.84101656808966, 36.740736165704185],
        [-159.29989981225333, -159.8473239328521, 38.19161641671745],
    ];
    let cone = serde_json::json!({
        "kind": "cone", "tip_radius": 0.0, "half_angle_deg": 69.49973971788627, "diameter": 3.3030790880935013
    });
    let fault = fault_of(&cone, corners, [-160.3473604025708, -162.0706582382985]);
    assert!(fault.worst() < EXACT, "{fault:?}");
}
