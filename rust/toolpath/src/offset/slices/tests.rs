//! Rows against all triangles, one by one.

use styluscam_geometry::{Mesh, Tool, Vector};
use styluscam_motion::Watch;

use super::super::envelope::tests::common::dice::Dice;
use super::super::envelope::tests::common::tools::{Kind, KINDS};
use super::super::envelope::tests::surfaces::{plane_and_tool, Surface, MIDDLE, SURFACES};
use super::super::search::Keeping;
use super::super::{Envelope, Index};
use super::Slice;

/// Rows at random over a surface, some of them along its corners, and positions on them; each row that is no search is asked.
fn on_rows(
    surface: Surface,
    kind: &Kind,
    seed: u64,
    ask: impl FnMut(&Envelope<'_>, &Slice<'_>, [[f64; 2]; 2], f64),
) -> [usize; 2] {
    let mut dice = Dice::new(seed);
    let (mesh, tool) = (surface.mesh(&mut dice), kind.tool(&mut dice));
    on_rows_of(&mesh, &tool, &mut dice, ask)
}

/// The same of a mesh and a tool.
fn on_rows_of(
    mesh: &Mesh,
    tool: &Tool,
    dice: &mut Dice,
    mut ask: impl FnMut(&Envelope<'_>, &Slice<'_>, [[f64; 2]; 2], f64),
) -> [usize; 2] {
    let index = Index::new(mesh);
    let envelope = Envelope::new(mesh, &index, tool, None, 0.0);
    let (sin, cos) = if dice.chance(0.4) { (0.0, 1.0) } else { libm::sincos(dice.within(0.0, 6.3)) };
    let directions = [[cos, sin], [-sin, cos]];
    let middle = MIDDLE * (cos - sin);
    let mut rows: Vec<f64> = (0..12)
        .map(|_| {
            let row = middle + dice.within(-7.0, 7.0);
            if dice.chance(0.5) {
                0.5 * libm::round(2.0 * row)
            } else {
                row
            }
        })
        .collect();
    rows.sort_by(f64::total_cmp);
    let slices = envelope.slices(directions, rows.clone(), None, &Watch::default()).unwrap();
    let mut asked = [0; 2];
    for block in 0..slices.blocks() {
        for (row, slice) in slices.rows(block).zip(slices.of_block(block)) {
            asked[0] += 1;
            if let Some(slice) = slice {
                asked[1] += 1;
                ask(&envelope, &slice, directions, rows[row]);
            }
        }
    }
    asked
}

fn highest_alone(envelope: &Envelope<'_>, position: [f64; 2]) -> f64 {
    let triangles = envelope.mesh().triangles().len() as u32;
    (0..triangles).map(|triangle| envelope.tip_alone(triangle, position)).fold(f64::NEG_INFINITY, f64::max)
}

/// A position on a row, often over a corner.
fn position(dice: &mut Dice, [along, across]: [[f64; 2]; 2], row: f64) -> [f64; 2] {
    let s = MIDDLE * (along[0] + along[1]) + dice.within(-8.0, 8.0);
    let s = if dice.chance(0.3) { 0.5 * libm::round(2.0 * s) } else { s };
    [0, 1].map(|axis| s * along[axis] + row * across[axis])
}

/// Asks positions on rows over surfaces and tools by number; rows in all, and those asked.
fn compare(seeds: std::ops::Range<usize>, each: usize) -> [usize; 2] {
    let mut asked = [0; 2];
    for seed in seeds {
        let (surface, kind) = (SURFACES[seed % SURFACES.len()], &KINDS[seed % KINDS.len()]);
        let mut dice = Dice::new(seed as u64 + 1000);
        let counts = on_rows(surface, kind, seed as u64, |envelope, slice, directions, row| {
            for _ in 0..each {
                let position = position(&mut dice, directions, row);
                let (found, truth) = (slice.found(position).0, highest_alone(envelope, position));
                let is_same = if truth.is_finite() { (found.tip - truth).abs() < 1e-11 } else { !found.is_something() };
                assert!(is_same, "{surface:?} {} seed {seed} at {position:?}: {} {truth}", kind.name, found.tip);
            }
        });
        asked = [0, 1].map(|i| asked[i] + counts[i]);
    }
    asked
}

#[test]
fn rows_find_what_all_triangles_say() {
    let [rows, asked] = compare(0..70, 3);
    assert!(2 * asked > rows, "{asked} of {rows}");
}

#[test]
#[ignore = "takes minutes: make test-long"]
fn rows_find_what_all_triangles_say_of_every_surface_and_kind() {
    compare(1000..1000 + 5 * SURFACES.len() * KINDS.len(), 12);
}

/// Planes that are level for a flat end, or as steep as a cone, but for rounding.
#[test]
fn rows_lose_nothing_between_triangles_of_a_plane() {
    let mut asked = [0; 2];
    for seed in 0..120 {
        let mut dice = Dice::new(seed);
        let (mesh, tool) = plane_and_tool(&mut dice);
        let mut places = Dice::new(seed + 1000);
        let rows = on_rows_of(&mesh, &tool, &mut dice, |envelope, slice, directions, row| {
            for _ in 0..20 {
                let position = position(&mut places, directions, row);
                let (found, truth) = (slice.found(position).0, highest_alone(envelope, position));
                let is_same = if truth.is_finite() { (found.tip - truth).abs() < 1e-11 } else { !found.is_something() };
                assert!(is_same, "{:?} seed {seed} at {position:?}: {} {truth}", tool.document().profile, found.tip);
            }
        });
        asked = [0, 1].map(|i| asked[i] + rows[i]);
    }
    assert!(2 * asked[1] > asked[0], "{asked:?}");
}

#[test]
fn what_is_proven_to_stay_under_a_chord_does() {
    let [mut under, mut over] = [0; 2];
    for seed in 0..70 {
        let (surface, kind) = (SURFACES[seed % SURFACES.len()], &KINDS[seed % KINDS.len()]);
        let mut dice = Dice::new(seed as u64 + 2000);
        on_rows(surface, kind, seed as u64, |envelope, slice, directions, row| {
            let from = position(&mut dice, directions, row);
            let length = dice.scale(0.01, 1.0) * if dice.chance(0.5) { -1.0 } else { 1.0 };
            let at = |share: f64| [0, 1].map(|axis| from[axis] + share * length * directions[0][axis]);
            let tip = |share| slice.found(at(share)).0.tip;
            if tip(0.0).min(tip(1.0)) == f64::NEG_INFINITY {
                return;
            }
            let most = dice.scale(1e-4, 1e-1);
            let [a, b] = [0.0, 1.0].map(|share| Vector::new(at(share)[0], at(share)[1], tip(share)));
            let most_over = (1..40).map(|i| f64::from(i) / 40.0).map(|share| tip(share) - a.z - share * (b.z - a.z));
            let most_over = most_over.fold(f64::NEG_INFINITY, f64::max);
            match envelope.keeps_under_on_row(slice, [a, b], |_| most) {
                Keeping::Under => {
                    under += 1;
                    assert!(most_over <= most + 1e-9, "{surface:?} {} seed {seed} at {from:?}: {most_over}", kind.name);
                }
                // what is not over where it was looked at is hardly less
                _ => over += usize::from(most_over < 0.5 * most),
            }
        });
    }
    assert!(under > 100 && 20 * over < under, "{under} {over}");
}
