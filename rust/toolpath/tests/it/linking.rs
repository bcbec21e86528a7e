//! Links between passes: over clearance, along the surface, at depth; and the moves that they make.

use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument, Vector};
use styluscam_motion::{Cancelled, Move, Watch};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::{
    join, link, ordered, AlongSurface, AtDepth, Entered, Heights, LinkRules, Links, OverClearance, Pass, PathPoint,
    Rates, Run, Seam, Segment, Sense, Surface,
};

const RATES: Rates = Rates { cut: 1000.0, plunge: 200.0 };
const LINKS: Links = Links { heights: Heights { clearance: 30.0, retract: 15.0 }, rates: RATES, operation: 3 };
/// A ramp of 1 in 2: so far over it, in height, the tip of a ball of 3 mm radius stands: 3 (1 / cos - 1).
const OVER: f64 = 3.0 * (1.118_033_988_749_895 - 1.0);

/// A ramp z = x / 2 over 20 by 20 mm, in three strips; the middle one, from X8.5 to X9.5, is selected or not.
fn on_ramp<T>(middle: bool, act: impl Fn(&Surface<'_>) -> T) -> T {
    let columns = [0.0, 8.5, 9.5, 20.0];
    let vertices: Vec<Vector> = [0.0, 20.0].iter().flat_map(|y| columns.map(|x| Vector::new(x, *y, 0.5 * x))).collect();
    let triangles: Vec<[i64; 3]> = (0..3).flat_map(|i| [[i, i + 1, i + 5], [i, i + 5, i + 4]]).collect();
    let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
    let ball = ProfileDocument::from(kinds::Ball { diameter: 6.0, radius: None, tip_flat: 0.0 });
    let (index, tool) = (Index::new(&mesh), Tool::new(ToolDocument::of(ball)).unwrap());
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
    let selected = [true, true, middle, middle, true, true];
    act(&Surface::new(&envelope, &selected))
}

/// Two rows along Y, at X6 and X9 in plan: there the ball touches 1.34 mm farther up.
fn rows(surface: &Surface<'_>) -> Vec<Pass> {
    let point = |x, y| surface.at(x, y, &mut None).unwrap();
    let row = |group, x| Pass { points: vec![point(x, 4.0), point(x, 16.0)], closed: false, group };
    vec![row(0, 6.0), row(1, 9.0)]
}

fn along<'a>(surface: &'a Surface<'a>, longest: f64) -> AlongSurface<'a> {
    AlongSurface {
        surface,
        planes: None,
        longest,
        deviation: 0.002,
        narrow: f64::INFINITY,
        corner: f64::INFINITY,
        feed: RATES.cut,
    }
}

/// Compares moves, with 1e-9 mm for arithmetic.
fn assert_moves(found: &[Move], expected: &[Move]) {
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (a, b) in found.iter().zip(expected) {
        assert_eq!(a.to(b.end.tip), *b);
        let apart = (Vector::from(a.end.tip) - Vector::from(b.end.tip)).norm();
        assert!(apart < 1e-9, "{a:?} instead of {b:?}");
    }
}

fn tip(x: f64, y: f64) -> [f64; 3] {
    [x, y, 0.5 * x + OVER]
}

fn down_to(x: f64, y: f64) -> [Move; 3] {
    [Move::rapid([x, y, 30.0]), Move::rapid([x, y, 15.0]), Move::feed(tip(x, y), 200.0)]
}

fn in_operation(moves: &[Move]) -> Vec<Move> {
    moves.iter().map(|step| step.of_operation(3)).collect()
}

/// The moves of two rows, the second one turned round, with a link over clearance.
fn over() -> Vec<Move> {
    let second = down_to(9.0, 16.0);
    let first = down_to(6.0, 4.0);
    let cut = |x, y| Move::feed(tip(x, y), 1000.0);
    let (up, end) = (Move::rapid([6.0, 16.0, 30.0]), Move::rapid([9.0, 4.0, 30.0]));
    in_operation(&[&first[..], &[cut(6.0, 16.0), up], &second[..], &[cut(9.0, 4.0), end]].concat())
}

fn linked(surface: &Surface<'_>, rules: &impl LinkRules<PathPoint>) -> Vec<Move> {
    let watch = Watch::default();
    let passes = ordered(rows(surface), Sense::Alternate, Seam::Nearest, &watch).unwrap();
    let entered: Vec<Entered> = passes.into_iter().map(Entered::from).collect();
    link(entered, rules, &LINKS, &watch).unwrap()
}

#[test]
fn a_short_link_follows_the_surface() {
    let found = on_ramp(true, |surface| linked(surface, &along(surface, 3.5)));
    let cut = |x, y| Move::feed(tip(x, y), 1000.0);
    let cuts = [cut(6.0, 16.0), cut(9.0, 16.0), cut(9.0, 4.0), Move::rapid([9.0, 4.0, 30.0])];
    assert_moves(&found, &in_operation(&[&down_to(6.0, 4.0)[..], &cuts[..]].concat()));
}

/// The link, if any, across a slot 8 mm wide between two points of its top, 10 mm apart, where 12 mm are allowed.
fn across_slot(depth: f64) -> Option<Vec<Segment>> {
    let profile = [[0.0, 0.0], [8.0, 0.0], [8.0, -depth], [16.0, -depth], [16.0, 0.0], [24.0, 0.0]];
    let at = |y| profile.map(|[x, z]| Vector::new(x, y, z));
    let vertices: Vec<Vector> = [0.0, 20.0].into_iter().flat_map(at).collect();
    let triangles: Vec<[i64; 3]> = (0..5).flat_map(|i| [[i, i + 1, i + 7], [i, i + 7, i + 6]]).collect();
    let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
    let ball = ProfileDocument::from(kinds::Ball { diameter: 6.0, radius: None, tip_flat: 0.0 });
    let (index, tool) = (Index::new(&mesh), Tool::new(ToolDocument::of(ball)).unwrap());
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
    let selected = [true; 10];
    let surface = Surface::new(&envelope, &selected);
    let [from, to] = [7.0, 17.0].map(|x| surface.at(x, 10.0, &mut None).unwrap());
    along(&surface, 12.0).path(&from, &to)
}

#[test]
fn a_link_goes_no_farther_down_beside_its_ends_than_it_may_be_long() {
    let lowest = |link: Vec<Segment>| link.iter().map(|segment| segment.end.z).fold(0.0, f64::min);
    assert!((across_slot(5.0).map(lowest).unwrap() + 5.0).abs() < 1e-9);
    assert!(across_slot(13.0).is_none());
}

#[test]
fn a_long_link_goes_over_clearance() {
    assert_moves(&on_ramp(true, |surface| linked(surface, &along(surface, 2.5))), &over());
}

#[test]
fn a_link_over_faces_that_are_not_selected_goes_over_clearance() {
    assert_moves(&on_ramp(false, |surface| linked(surface, &along(surface, 3.5))), &over());
}

#[test]
fn without_rules_every_link_goes_over_clearance() {
    assert_moves(&on_ramp(true, |surface| linked(surface, &OverClearance)), &over());
}

/// Runs without contacts, as a pocket has them: an arc each, 5 mm apart.
fn arcs(z: f64) -> Vec<Run<Vector>> {
    let run = |x: f64, z: f64| {
        let (from, to) = (Vector::new(x, 0.0, z), Vector::new(x + 2.0, 0.0, z));
        Run { from, to, segments: vec![Segment::arc(from, to, 1.0, 800.0).unwrap()] }
    };
    vec![run(0.0, -1.0), run(7.0, z)]
}

#[test]
fn a_link_at_depth_goes_straight_over_cleared_ground_of_one_height() {
    let rules = |longest, cleared| AtDepth { longest, same_height: 1e-9, is_cleared: move |_, _| cleared, feed: 900.0 };
    let count = |z, longest, cleared| join(arcs(z), &rules(longest, cleared), &LINKS, &Watch::default()).unwrap().len();
    let joined = join(arcs(-1.0), &rules(5.5, true), &LINKS, &Watch::default()).unwrap();
    assert_eq!(joined[4], Segment::line(Vector::new(7.0, 0.0, -1.0), 900.0));
    // down in three, two arcs, up; a link of one, or up and down again
    assert_eq!(count(-1.0, 5.5, true), 7);
    for (z, longest, cleared) in [(-1.0, 4.5, true), (-1.0, 5.5, false), (-1.1, 5.5, true)] {
        assert_eq!(count(z, longest, cleared), 10, "{z} {longest} {cleared}");
    }
}

#[test]
fn it_can_be_cancelled() {
    let watch = Watch::default();
    watch.cancel();
    assert_eq!(join(arcs(-1.0), &OverClearance, &LINKS, &watch), Err(Cancelled));
}
