//! Small pockets, and what is refused.

use std::f64::consts::PI;

use proptest::prelude::*;
use styluscam_geometry::PlanePiece;
use styluscam_motion::Watch;

use super::bound::Bound;
use super::check::{bounded, worst};
use super::material::Material;
use super::polygons::{sides, Kernel, Point, Polygons};
use super::window::joined;
use super::{pocket_path, EntryForm, EntryRule, Pocket, PocketError, PocketPath, PocketRun, PocketRunKind, Shape};

fn rectangle(x: f64, y: f64) -> Vec<[f64; 3]> {
    vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]]
}

fn pocket(boundary: &[[f64; 3]]) -> Pocket<'_> {
    Pocket {
        leave: 0.0,
        finish: 0.0,
        shape: Shape::Walls { boundary, islands: &[], open_edges: &[], stock: None },
        radius: 2.5,
        angle: PI / 3.0,
        smoothing: 0.125,
        climb: true,
        cleared: &[],
        two_way: false,
        entry: EntryRule::default(),
        stepovers: false,
    }
}

fn planned(pocket: &Pocket<'_>) -> PocketPath {
    pocket_path(pocket, &Watch::default()).unwrap()
}

#[test]
fn offsets_are_what_they_are_for_squares_and_discs() {
    let kernel = Kernel::new(100.0);
    let square = kernel.even_odd(&[vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]]);
    let area = |distance: f64| kernel.offset(&square, distance, 1e-4).area();
    assert!((area(2.0) - (100.0 + 4.0 * 20.0 + 4.0 * PI)).abs() < 1e-3, "{}", area(2.0));
    assert!((area(-2.0) - 36.0).abs() < 1e-5 && area(-5.1) == 0.0);
    let hole = kernel.difference(&square, &Polygons::disc([5.0, 5.0], 2.0, 1e-4));
    assert!((kernel.offset(&hole, -1.0, 1e-4).area() - (64.0 - 9.0 * PI)).abs() < 3e-3);
    assert!((kernel.offset(&hole, 2.5, 1e-4).area() - (100.0 + 100.0 + 6.25 * PI)).abs() < 2e-3);
    let line = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]];
    let swept = kernel.sweep(&line, 1.0, 1e-5).area();
    // two strips, a half disc at each end, a quarter disc outside the corner, a square less than both strips inside
    assert!((swept - (20.0 + 10.0 + PI + PI / 4.0 - 1.0)).abs() < 1e-3, "{swept}");
}

/// A plate with rooms in it: round ones that run into each other, two with a channel between them, one with islands around a court.
fn rooms(kernel: &Kernel) -> Polygons {
    let disc = |x: f64, y: f64, radius: f64| Polygons::disc([x, y], radius, 1e-4);
    let bar = |x: f64, y: f64, a: f64, b: f64| Polygons {
        contours: vec![vec![[x - a, y - b], [x + a, y - b], [x + a, y + b], [x - a, y + b]]],
    };
    let cut = [
        disc(-40.0, 0.0, 10.0),
        disc(-32.0, 3.0, 3.5),
        disc(-46.0, -8.0, 5.0),
        bar(-10.0, 0.0, 5.0, 8.0),
        bar(3.0, 1.0, 12.0, 1.5),
        disc(15.0, 0.0, 7.0),
        disc(45.0, 0.0, 14.0),
    ];
    let mut area = bar(0.0, 0.0, 70.0, 30.0);
    for room in &cut {
        area = kernel.difference(&area, room);
    }
    let islands = (0..6).map(|i| f64::from(i) * PI / 3.0).map(|a| disc(45.0 + 8.0 * a.cos(), 8.0 * a.sin(), 2.0));
    islands.fold(area, |area, island| kernel.union(&area, &island))
}

#[test]
fn folds_cut_short_leave_the_area_that_folds_filled_do() {
    let kernel = Kernel::new(150.0);
    let area = rooms(&kernel);
    let contours: Vec<&[[f64; 2]]> = area.contours.iter().map(Vec::as_slice).collect();
    let mut cut_short = 0;
    for distance in [0.5, 1.4, 2.0, 3.0, 4.5, 6.0, 8.0, -0.7, -1.5, -3.0, -8.0] {
        let folded = kernel.offset_folded(&contours, distance, 1e-4).area();
        let Some(unfolded) = kernel.offset_unfolded(&contours, distance, 1e-4) else { continue };
        assert!((unfolded.area() - folded).abs() < 5e-3, "{distance}: {} {folded}", unfolded.area());
        cut_short += 1;
    }
    assert!(cut_short >= 9, "{cut_short}");
}

/// The distance to an area's sides and whether a point lies in it, side by side.
fn by_all_sides(area: &Polygons, [x, y]: [f64; 2]) -> (f64, bool) {
    let (mut nearest, mut inside) = (f64::INFINITY, false);
    for (a, b) in area.contours.iter().flat_map(|contour| sides(contour)) {
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
        let share = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
        nearest = nearest.min(libm::hypot(v[0] - share * u[0], v[1] - share * u[1]));
        inside ^= (a[1] > y) != (b[1] > y) && v[0] < (y - a[1]) / u[1] * u[0];
    }
    (nearest, inside)
}

#[test]
fn the_cells_find_what_all_sides_tell() {
    let kernel = Kernel::new(100.0);
    let triangle = kernel.even_odd(&[vec![[0.0, 0.0], [31.0, 7.0], [4.0, 23.0]]]);
    let discs: Vec<_> =
        [[8.0, 8.0], [19.0, 9.0], [30.0, 20.0]].iter().map(|at| Polygons::disc(*at, 3.0, 1e-3)).collect();
    let area = kernel.difference(&triangle, &discs[0]);
    let area = kernel.union(&kernel.difference(&area, &discs[1]), &discs[2]);
    let material = Material::new(area.clone());
    for i in 0..60 {
        for j in 0..60 {
            let point = [f64::from(i) * 0.83 - 8.0, f64::from(j) * 0.71 - 9.0];
            let (distance, inside) = by_all_sides(&area, point);
            assert!((material.distance(point) - distance).abs() < 1e-9 && material.holds(point) == inside, "{point:?}");
            // no side comes through the circle that is not found
            let mut found: Vec<(Point, Point)> = Vec::new();
            material.crossed(point, 2.0, &mut |a, b| found.push((a, b)));
            let reach = |p: Point| libm::hypot(p[0] - point[0], p[1] - point[1]);
            for (a, b) in area.contours.iter().flat_map(|contour| sides(contour)) {
                let nearest = by_all_sides(&Polygons { contours: vec![vec![a, b]] }, point).0;
                let comes_through = nearest < 2.0 && reach(a).max(reach(b)) >= 2.0;
                assert!(!comes_through || found.contains(&(a, b)), "{point:?}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn the_largest_circle_past_a_point_keeps_its_distance_from_it() {
    let bound = Bound::new(2.5, PI / 3.0);
    let point = [2.0, -1.0];
    let rho = bound.widest([4.0, 1.0]).unwrap();
    assert!((libm::hypot(4.0, 1.0 - rho) - bound.keep(rho)).abs() < 1e-9, "{rho}");
    // under the tool, and behind the right of the bound: there is no largest
    assert!(bound.widest(point).is_none() && bound.widest([4.0, -3.0]).is_none());
}

#[test]
fn the_engagement_beside_a_straight_edge_and_in_a_corner_is_what_it_is() {
    let kernel = Kernel::new(100.0);
    let edge = kernel.even_odd(&[vec![[-50.0, -50.0], [50.0, -50.0], [50.0, 0.0], [-50.0, 0.0]]]);
    let material = Material::new(edge);
    // to +X with the material on the right, the tool 1.25 deep: acos(1 - 1.25 / 2.5)
    let angle = |path: &[[f64; 3]]| worst(path, &material, 2.5).to_degrees();
    assert!((angle(&[[-20.0, 1.25, 0.0], [20.0, 1.25, 0.0]]) - 60.0).abs() < 0.05);
    // straight down into it the tool is half engaged on both sides, and its own way is cleared
    assert!((angle(&[[0.0, 2.5, 0.0], [0.0, -20.0, 0.0]]) - 180.0).abs() < 0.1);
    assert!(angle(&[[-20.0, 2.6, 0.0], [20.0, 2.6, 0.0]]) == 0.0);
    let whole = vec![[-20.0, 1.25, 0.0], [0.0, 1.25, 0.0], [5.0, -3.0, 0.0]];
    let kept = bounded(whole.clone(), &material, 2.5, 60.3_f64.to_radians());
    assert!(kept.len() == 2 && (kept[1][0] + 0.3).abs() < 0.11, "{kept:?}");
    assert_eq!(bounded(whole.clone(), &material, 2.5, PI), whole);
}

#[test]
fn chips_of_a_micrometre_at_the_tool_s_side_count_whether_they_are_there_or_not() {
    let kernel = Kernel::new(100.0);
    // a pass to +X along Y 0 before which material lies from 1.25 right of it to all but `gap` of the tool's radius
    let angle = |gap: f64| {
        let strip = [[10.0, gap - 2.5], [50.0, gap - 2.5], [50.0, -1.25], [10.0, -1.25]];
        worst(&[[0.0, 0.0, 0.0], [20.0, 0.0, 0.0]], &Material::new(kernel.even_odd(&[strip.to_vec()])), 2.5)
    };
    let from = |gap: f64| libm::acos(1.0 - gap / 2.5);
    assert!((angle(1e-3) - PI / 3.0).abs() < 1e-3, "{} deg", angle(1e-3).to_degrees());
    assert!((angle(0.01) - (PI / 3.0 - from(0.01))).abs() < 1e-3, "{} deg", angle(0.01).to_degrees());
}

#[test]
fn a_square_is_cleared() {
    let boundary = rectangle(15.0, 15.0);
    let path = planned(&pocket(&boundary));
    assert!(path.left < 0.01, "{} left", path.left);
    let kinds = |kind| path.runs.iter().filter(|run| run.kind == kind).count();
    assert_eq!(kinds(PocketRunKind::Entry), 1);
    assert!(kinds(PocketRunKind::Cut) > 10);
}

#[test]
fn what_is_no_pocket_is_refused_by_name() {
    let square = rectangle(15.0, 15.0);
    let refused = |pocket: &Pocket<'_>| pocket_path(pocket, &Watch::default()).unwrap_err();
    assert_eq!(refused(&Pocket { radius: 16.0, smoothing: 0.8, ..pocket(&square) }).code(), "tool-too-large");
    assert_eq!(refused(&Pocket { angle: 2.0, ..pocket(&square) }).key(), "engagement_deg");
    let beyond = Shape::Walls { boundary: &square, islands: &[], open_edges: &[4], stock: None };
    assert_eq!(refused(&Pocket { shape: beyond, ..pocket(&square) }), PocketError::Edge { edge: 4, count: 4 });
    assert_eq!(refused(&pocket(&square[..2])), PocketError::Outline { key: "boundary".to_owned(), count: 2 });
    let line = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [20.0, 0.0, 0.0]];
    assert_eq!(refused(&pocket(&line)).code(), "outline");
    let watch = Watch::default();
    watch.cancel();
    assert_eq!(pocket_path(&pocket(&square), &watch), Err(PocketError::Cancelled));
}

/// The least distance of a path's positions from outlines, mm.
fn clearance(path: &PocketPath, outlines: &[Vec<[f64; 3]>]) -> f64 {
    let walls: Vec<PlanePiece> = outlines.iter().flat_map(|outline| PlanePiece::outline(outline)).collect();
    let runs = path.runs.iter().filter(|run| run.kind != PocketRunKind::Rapid);
    let pieces: Vec<PlanePiece> = runs.flat_map(|run| PlanePiece::path(&run.points)).collect();
    let positions = pieces.iter().flat_map(|piece| {
        let parts = libm::ceil(piece.length() / 0.1).max(1.0) as usize;
        (0..=parts).map(move |part| piece.at(part as f64 / parts as f64))
    });
    let nearest = |at: [f64; 2]| walls.iter().map(|wall| wall.distance(at)).fold(f64::INFINITY, f64::min);
    positions.map(nearest).fold(f64::INFINITY, f64::min)
}

#[test]
fn discs_beside_a_fold_of_the_walls_keep_away_from_them() {
    let corners = [(12.856066657098744, -9.618112969339235, -0.6245532496547137), (-13.52724089974169, 0.0, 0.0)];
    let boundary = [&corners[..], &[(0.0, 2.599146025324414, -0.23546762401011428)]].concat();
    let boundary: Vec<[f64; 3]> = boundary.into_iter().map(|(x, y, bulge)| [x, y, bulge]).collect();
    let islands = [vec![
        [2.381833969828182, 3.355909843776143, 0.0],
        [0.0, -1.294386305051976, 0.2726450146323642],
        [0.0, -1.1403286020844798, 0.3846526564443272],
    ]];
    let shape = Shape::Walls { boundary: &boundary, islands: &islands, open_edges: &[], stock: None };
    let path = planned(&Pocket { shape, angle: 1.3, radius: 2.0, smoothing: 0.1, ..pocket(&boundary) });
    let found = clearance(&path, &[vec![boundary.clone()], islands.to_vec()].concat());
    assert!(found > 2.0 - 1e-6 && path.left < 1e-3 * path.goal, "{found}, {} left", path.left);
}

#[test]
fn a_hole_that_has_grown_together_with_one_between_cut_folds_stays() {
    let corners = [
        [-6.832841480849949, 11.30786594418163, -0.2869979686628666],
        [0.0, 3.0551085142342704, 0.0],
        [0.0, 0.0, -0.6406135186353994],
        [9.07878690107123, 3.3646150475471988, -0.3963511895018633],
        [-3.283516513529114, 0.08787314784348702, -0.05891050963462311],
    ];
    let path = planned(&Pocket { angle: 1.3, radius: 2.0, smoothing: 0.1, ..pocket(&corners) });
    assert!(path.left < 1e-3 * path.goal, "{} of {} left", path.left, path.goal);
}

#[test]
fn what_no_way_leads_to_beside_cleared_ground_is_entered() {
    let bare = [
        [-6.832841480849949, 11.30786594418163, -0.2869979686628666],
        [0.0, 3.0551085142342704, 0.0],
        [0.0, 5.693368464419466, 0.0],
        [9.07878690107123, 3.3646150475471988, -0.3963511895018633],
        [-3.283516513529114, 0.08787314784348702, -0.05891050963462311],
    ];
    let round =
        [[0.0, 11.277646738904597, 0.0], [-9.039112217188464, 0.0, 0.7622617260899865], [12.461748112500118, 0.0, 0.0]];
    let island = [
        [-4.16700233403756, 2.3135354639173227, 0.20147522758971792],
        [0.0, 2.0757390315193045, 0.0],
        [-4.617794577912672, 0.0, 0.0],
    ];
    for (boundary, islands) in [(&bare[..], vec![]), (&round[..], vec![island.to_vec()])] {
        let shape = Shape::Walls { boundary, islands: &islands, open_edges: &[], stock: None };
        let path = planned(&Pocket { shape, angle: 1.3, radius: 2.0, smoothing: 0.1, ..pocket(boundary) });
        assert!(path.left < 1e-3 * path.goal, "{} of {} left", path.left, path.goal);
    }
}

/// The length of the runs of a kind, mm.
fn length(path: &PocketPath, kind: PocketRunKind) -> f64 {
    let runs = path.runs.iter().filter(|run| run.kind == kind);
    runs.flat_map(|run| PlanePiece::path(&run.points)).map(|piece| piece.length()).sum()
}

#[test]
fn passes_in_a_slot_begin_where_they_cut() {
    let slot = rectangle(25.0, 2.75);
    let path = planned(&pocket(&slot));
    let ratio = length(&path, PocketRunKind::Cut) * 2.5 * (1.0 - (PI / 3.0).cos()) / path.goal;
    assert!(ratio < 1.8, "{ratio}");
    // the two ends are finished one after the other: no more than a chord for each half circle
    assert!(length(&path, PocketRunKind::Link) < 0.8 * length(&path, PocketRunKind::Cut));
}

#[test]
fn a_cut_that_begins_where_the_last_one_ended_needs_no_link() {
    let square = rectangle(15.0, 15.0);
    let runs = planned(&pocket(&square)).runs;
    let ends = |run: &PocketRun| [run.points[0], run.points[run.points.len() - 1]].map(|[x, y, _]| [x, y]);
    let mut joined = 0;
    for pair in runs.windows(2) {
        let [[_, end], [start, _]] = [ends(&pair[0]), ends(&pair[1])];
        let gap = libm::hypot(start[0] - end[0], start[1] - end[1]);
        assert!(gap == 0.0 || pair[1].kind == PocketRunKind::Rapid || pair[0].kind == PocketRunKind::Rapid, "{gap}");
        joined += usize::from(pair[0].kind == PocketRunKind::Cut && pair[1].kind == PocketRunKind::Cut);
    }
    assert!(joined > 0);
    for run in runs.iter().filter(|run| run.kind == PocketRunKind::Link) {
        let [start, end] = ends(run);
        assert!(libm::hypot(start[0] - end[0], start[1] - end[1]) > 2e-3);
    }
}

fn reversed_outline(outline: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let from = |i: usize| outline[(outline.len() + i) % outline.len()];
    let points = (0..outline.len()).rev().map(|i| [from(i + 1)[0], from(i + 1)[1], -from(i)[2]]);
    points.collect()
}

#[test]
fn around_the_corner_of_two_open_edges_the_tool_goes_through_the_air() {
    let boundary = rectangle(12.0, 12.0);
    let shape = Shape::Walls { boundary: &boundary, islands: &[], open_edges: &[1, 2], stock: None };
    let path = planned(&Pocket { shape, ..pocket(&boundary) });
    assert!(path.runs.iter().all(|run| matches!(run.kind, PocketRunKind::Cut | PocketRunKind::Link)));
    let ratio = length(&path, PocketRunKind::Cut) * 2.5 * (1.0 - (PI / 3.0).cos()) / path.goal;
    assert!(path.left < 1e-3 * path.goal && ratio < 1.65, "{ratio}");
}

#[test]
fn through_an_open_arc_the_tool_comes_from_outside_whichever_way_the_outline_goes() {
    let arc = [[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 12.0, 0.5], [0.0, 12.0, 0.0]];
    for boundary in [arc.to_vec(), reversed_outline(&arc)] {
        let open = boundary.iter().position(|[_, _, bulge]| *bulge != 0.0).unwrap();
        let shape = Shape::Walls { boundary: &boundary, islands: &[], open_edges: &[open], stock: None };
        let path = planned(&Pocket { shape, ..pocket(&boundary) });
        assert!(path.runs.iter().all(|run| run.kind != PocketRunKind::Entry));
        assert!(path.left < 1e-3 * path.goal);
    }
}

#[test]
fn beyond_an_open_edge_walls_are_kept_from_too() {
    // the bottom of a notch is open, its sides are not
    let corners =
        [[0.0, 0.0], [15.0, 0.0], [15.0, 5.0], [25.0, 5.0], [25.0, 0.0], [40.0, 0.0], [40.0, 24.0], [0.0, 24.0]];
    let boundary = corners.map(|[x, y]| [x, y, 0.0]);
    let shape = Shape::Walls { boundary: &boundary, islands: &[], open_edges: &[2], stock: None };
    let path = planned(&Pocket { shape, ..pocket(&boundary) });
    let side = |x: f64| vec![[x, 0.0, 0.0], [x, 5.0, 0.0], [x, 5.0, 0.0]];
    let found = clearance(&path, &[side(15.0), side(25.0)]);
    assert!(found > 2.5 - 1e-6, "{found}");
}

#[test]
fn arcs_onto_a_ring_beside_a_wall_do_not_stand_out_over_it() {
    let boundary = [
        [-7.515394385574786, 11.316161132740515, 0.0],
        [5.338499863976063, 0.0, 0.06359988221175333],
        [-8.772199350875304, -12.25393146873933, -0.6736987563272961],
        [2.013471370307892, -13.56864526373168, 0.4780400580856911],
        [10.305533834729074, 7.983195083764914, 0.2718847381485851],
        [9.710846811154095, -13.681769961294753, 0.3173685106641846],
    ];
    let path = planned(&Pocket { angle: 1.3, radius: 2.0, smoothing: 0.1, ..pocket(&boundary) });
    let found = clearance(&path, &[boundary.to_vec()]);
    assert!(found > 2.0 - 1e-6, "{found}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    // outlines at random, most of which cross themselves, with arcs of any sense and an island anywhere
    #[test]
    fn nothing_is_cut_into_walls_whatever_they_are(
        corners in prop::collection::vec((-14.0..14.0_f64, -14.0..14.0_f64, -0.8..0.8_f64), 3..8),
        island in prop::collection::vec((-6.0..6.0_f64, -6.0..6.0_f64, -0.5..0.5_f64), 3..5),
        with_island in any::<bool>(),
    ) {
        let outline = |corners: Vec<(f64, f64, f64)>| corners.into_iter().map(|(x, y, bulge)| [x, y, bulge]).collect();
        let boundary: Vec<[f64; 3]> = outline(corners);
        let islands: Vec<Vec<[f64; 3]>> = if with_island { vec![outline(island)] } else { Vec::new() };
        let shape = Shape::Walls { boundary: &boundary, islands: &islands, open_edges: &[], stock: None };
        let asked = Pocket { shape, angle: 1.3, radius: 2.0, smoothing: 0.1, ..pocket(&boundary) };
        match pocket_path(&asked, &Watch::default()) {
            Ok(path) => {
                prop_assert!(path.left < 1e-3 * path.goal, "{} of {} left", path.left, path.goal);
                let found = clearance(&path, &[vec![boundary.clone()], islands.clone()].concat());
                prop_assert!(found > 2.0 - 1e-6, "{found}");
            }
            Err(error) => prop_assert_eq!(error.code(), "tool-too-large"),
        }
    }
}

/// How the tool goes down into a pocket: the length and the height of what the entry's path spans.
fn entered(boundary: &[[f64; 3]], entry: EntryRule) -> Option<[f64; 2]> {
    let path = pocket_path(&Pocket { entry, ..pocket(boundary) }, &Watch::default()).ok()?;
    let run = path.runs.iter().find(|run| run.kind == PocketRunKind::Entry)?;
    let corners = PlanePiece::path(&run.points).iter().map(PlanePiece::bounds).collect::<Vec<_>>();
    Some([0, 1].map(|i| {
        let low = corners.iter().map(|[low, _]| low[i]).fold(f64::INFINITY, f64::min);
        corners.iter().map(|[_, high]| high[i]).fold(f64::NEG_INFINITY, f64::max) - low
    }))
}

#[test]
fn ramps_lie_along_slots_and_helices_where_there_is_room() {
    let (slot, square) = (rectangle(12.0, 3.0), rectangle(12.0, 12.0));
    let asked = |form, size| EntryRule { form, size };
    // 0.5 mm of room on either side: two ways 0.375 mm off the line, and 5 mm long
    let along = entered(&slot, asked(EntryForm::Auto, None)).unwrap();
    assert!((along[0] - 5.0 - 0.75).abs() < 0.3 && (along[1] - 0.75).abs() < 0.02, "{along:?}");
    let round = entered(&slot, asked(EntryForm::Helix, None)).unwrap();
    assert!(round.iter().all(|size| (size - 1.0).abs() < 0.06), "{round:?}");
    let wide = entered(&square, asked(EntryForm::Auto, None)).unwrap();
    assert!(wide.iter().all(|size| (size - 3.5).abs() < 1e-6), "{wide:?}");
    let small = entered(&square, asked(EntryForm::Helix, Some(2.0))).unwrap();
    assert!(small.iter().all(|size| (size - 2.0).abs() < 1e-6), "{small:?}");
    let ramp = entered(&square, asked(EntryForm::Ramp, Some(8.0))).unwrap();
    assert!((libm::hypot(ramp[0], ramp[1]) - 8.0).abs() < 1.2, "{ramp:?}");
}

#[test]
fn where_no_ramp_fits_it_is_refused_by_place_on_both_hands() {
    // a hole in which only a short line fits
    let hole = [[3.1, 10.0, 1.0], [-3.1 + 0.4, 10.0, 1.0]];
    let entry = EntryRule { form: EntryForm::Ramp, size: None };
    for climb in [true, false] {
        let asked = Pocket { entry, climb, ..pocket(&hole) };
        let refused = pocket_path(&asked, &Watch::default()).unwrap_err();
        let PocketError::NoEntry { at: [x, y], .. } = refused else { panic!("{refused:?}") };
        assert!((x - 0.2).abs() < 0.1 && (y - 10.0).abs() < 0.1 && refused.code() == "no-entry", "{refused}");
    }
    assert!(entered(&hole, EntryRule { form: EntryForm::Auto, size: None }).is_some());
}

#[test]
fn stepovers_are_measured_as_straight_passes_take_them() {
    let square = rectangle(12.0, 12.0);
    let path = planned(&Pocket { stepovers: true, ..pocket(&square) });
    let cuts = path.runs.iter().filter(|run| run.kind == PocketRunKind::Cut);
    let widths: Vec<f64> = cuts.flat_map(|run| run.stepovers.iter().map(|stepover| stepover.width)).collect();
    let widest = widths.iter().copied().fold(0.0, f64::max);
    // r (1 - cos 60), a third of a degree more at most
    assert!(widest <= 2.5 * (1.0 - libm::cos(PI / 3.0 + 0.006)) && widest > 1.2, "{widest}");
    let all = planned(&pocket(&square));
    assert!(all.runs.iter().all(|run| run.stepovers.is_empty()) && widths.iter().all(|width| *width >= 0.0));
}

#[test]
fn what_lies_in_a_window_is_what_an_intersection_with_it_leaves() {
    let kernel = Kernel::new(100.0);
    let comb: Vec<Point> =
        vec![[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [25.0, 20.0], [25.0, 4.0], [15.0, 4.0], [15.0, 20.0], [0.0, 18.0]];
    let area = kernel.difference(&Polygons { contours: vec![comb] }, &Polygons::disc([7.0, 9.0], 4.0, 1e-3));
    for [low, high] in [[[5.0, 3.0], [27.0, 12.0]], [[-5.0, -3.0], [40.0, 30.0]], [[17.0, 6.0], [24.0, 12.0]]] {
        let window = Polygons { contours: vec![vec![low, [high[0], low[1]], high, [low[0], high[1]]]] };
        let (clipped, expected) = (kernel.clipped(&area, [low, high]), kernel.intersection(&area, &window));
        let off = kernel.difference(&clipped, &expected).area() + kernel.difference(&expected, &clipped).area();
        assert!(off < 1e-5, "{off}");
    }
}

#[test]
fn boxes_that_meet_are_joined_until_none_do() {
    let boxes =
        [[[0.0, 0.0], [1.0, 1.0]], [[5.0, 0.0], [6.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]], [[0.5, 0.5], [2.5, 0.7]]];
    assert_eq!(joined(boxes), vec![[[0.0, 0.0], [3.0, 1.0]], [[5.0, 0.0], [6.0, 1.0]]]);
}

#[test]
fn around_a_block_the_front_comes_in_from_the_air() {
    let block = rectangle(20.0, 12.0);
    let shape = Shape::Walls { boundary: &block, islands: &[], open_edges: &[0, 1, 2, 3], stock: None };
    let path = planned(&Pocket { shape, radius: 3.0, ..pocket(&block) });
    let entries = path.runs.iter().filter(|run| run.kind == PocketRunKind::Entry);
    assert_eq!(entries.count(), 0);
    assert!(path.left < 1e-3 * path.goal, "{} of {} mm^2", path.left, path.goal);
}

#[test]
fn around_a_block_in_air_passes_are_as_wide_as_straight_ones_may_be() {
    let (block, air) = ([rectangle(20.0, 15.0)], [rectangle(32.5, 27.5)]);
    let cut = |in_air: bool| {
        let shape = Shape::Centres { outlines: &air, stock: &block, in_air };
        let path = planned(&Pocket { shape, ..pocket(&air[0]) });
        assert!(path.left < 1e-3 * path.goal, "{} of {} mm^2 are left", path.left, path.goal);
        length(&path, PocketRunKind::Cut)
    };
    // passes that are a full stepover apart, and once around
    let least = 4.0 * 20.0 * 15.0 / 1.25;
    let [wide, narrow] = [true, false].map(cut);
    assert!(wide < 1.35 * least, "{wide} mm, and {least} mm would do");
    assert!(narrow > 1.15 * wide, "between walls where the air is: {narrow} mm, else {wide} mm");
}
