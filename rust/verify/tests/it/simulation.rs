//! The material after a program, against closed forms and brute force.

use crate::common::{ball, limits, Part, Path};
use styluscam_geometry::{Cutter, Tool, Vector};
use styluscam_motion::{Arc, Plane, Program, Watch};
use styluscam_verify::{simulate, Grid, Simulation, Skin};

const SIZE: [f64; 2] = [20.0, 12.0];

/// A part that is of no matter.
fn plate() -> Part {
    let corners = [[0.0, 0.0], [20.0, 0.0], [0.0, 12.0]].map(|[x, y]| Vector::new(x, y, -20.0));
    Part::new(corners.to_vec(), &[[0, 1, 2]])
}

fn simulated(tool: &Tool, program: &Program, spacing: f64) -> Simulation {
    let part = plate();
    let tools = std::slice::from_ref(tool);
    let grid = Grid::over([0.0, 0.0], SIZE, spacing).unwrap();
    simulate(program, &part.subject(tools), &limits(), grid, 0.0, &Watch::default()).unwrap()
}

/// The nodes with their heights.
fn nodes(simulation: &Simulation) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
    let width = simulation.grid.nodes[0];
    simulation.heights.iter().enumerate().map(move |(i, height)| (simulation.grid.at(i % width, i / width), *height))
}

#[test]
fn a_ball_along_a_line_leaves_its_groove() {
    let tool = ball(6.0);
    let program = Path::new().rapid([4.0, 6.0, 10.0]).feed([4.0, 6.0, -1.0]).feed([16.0, 6.0, -1.0]).program(&tool);
    let simulation = simulated(&tool, &program, 0.1);
    for ([x, y], height) in nodes(&simulation) {
        let aside = (x - x.clamp(4.0, 16.0)).hypot(y - 6.0);
        let groove = if aside < 3.0 { 2.0 - (9.0 - aside * aside).sqrt() } else { 0.0 };
        assert!((height - groove.min(0.0)).abs() < 1e-9, "{x} {y}: {height} {groove}");
    }
}

/// Every kind of profile, D6.
const PROFILES: [&str; 15] = [
    r#"{"kind": "ball", "diameter": 6.0}"#,
    r#"{"kind": "ball", "diameter": 6.0, "tip_flat": 0.8}"#,
    r#"{"kind": "flat", "diameter": 6.0}"#,
    r#"{"kind": "clothoid", "diameter": 6.0}"#,
    r#"{"kind": "cycloid", "diameter": 6.0}"#,
    r#"{"kind": "parabola", "apex_radius": 2.0, "diameter": 6.0}"#,
    r#"{"kind": "ellipse", "radial": 3.0, "axial": 4.0}"#,
    r#"{"kind": "power", "coefficient": 0.2, "exponent": 1.4, "diameter": 6.0}"#,
    r#"{"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0}"#,
    r#"{"kind": "barrel", "diameter": 6.0, "radius": 20.0, "tip_radius": 1.0}"#,
    r#"{"kind": "cone", "tip_radius": 0.0, "half_angle_deg": 40.0, "diameter": 6.0}"#,
    r#"{"kind": "tapered-ball", "tip_radius": 1.0, "half_angle_deg": 15.0, "diameter": 6.0}"#,
    r#"{"kind": "v", "tip_diameter": 1.5, "angle_deg": 80.0, "diameter": 6.0}"#,
    r#"{"kind": "points", "points": [[0, 0], [1, 0.1], [2, 0.5], [3, 1.6]], "fit_tolerance": 0.001}"#,
    r#"{"kind": "formula", "z": "r^4 / 60", "diameter": 6.0}"#,
];

fn tool(profile: &str) -> Tool {
    crate::common::tool(serde_json::from_str(profile).unwrap())
}

/// Lines in all directions: level, steep, long, short, straight down, up again.
fn lines(tool: &Tool) -> Program {
    let path = Path::new().rapid([2.2, 2.1, 10.0]).feed([2.2, 2.1, -0.7]).feed([17.0, 3.3, -2.0]);
    let path = path.feed([17.3, 3.5, -1.0]).feed([17.4, 9.1, -1.0]).feed([9.0, 9.1, 0.6]).feed([8.9, 9.0, -3.0]);
    let path = path.feed([5.0, 8.0, -0.3]).feed([4.9, 8.0, 5.0]).rapid([-4.0, 5.0, 5.0]).feed([12.0, 6.1, -2.4]);
    path.program(tool)
}

/// The lowest that a tool comes on a line over a position, by samples and then by thirds.
fn lowest(cutter: &Cutter, from: [f64; 3], to: [f64; 3], position: [f64; 2]) -> f64 {
    let height = |share: f64| {
        let tip = [0, 1, 2].map(|k| from[k] + share * (to[k] - from[k]));
        let distance = (tip[0] - position[0]).hypot(tip[1] - position[1]);
        let beyond = distance - cutter.max_radius();
        // nearer is better as long as it does not come
        tip[2]
            + if beyond > 1e-12 { 1e6 + distance } else { cutter.height_at_radius(distance.min(cutter.max_radius())) }
    };
    let count = 400;
    let at = |i: usize| i as f64 / count as f64;
    let best = (0..=count).min_by(|a, b| height(at(*a)).total_cmp(&height(at(*b)))).unwrap();
    let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(count)));
    let mut found = height(at(best));
    for _ in 0..120 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        found = found.min(height(a)).min(height(b));
        if height(a) > height(b) {
            low = a;
        } else {
            high = b;
        }
    }
    found
}

#[test]
fn every_profile_cuts_as_it_does_by_brute_force() {
    for profile in PROFILES {
        let tool = tool(profile);
        let program = lines(&tool);
        let cutter = tool.cutter();
        let simulation = simulated(&tool, &program, 0.5);
        let mut cut = 0;
        for (position, height) in nodes(&simulation) {
            let ends = program.segments().filter_map(|(start, step)| Some((start?, step.end.tip)));
            let expected = ends.map(|(from, to)| lowest(&cutter, from, to, position)).fold(0.0, f64::min);
            cut += usize::from(expected < 0.0);
            assert!((height - expected).abs() < 1e-6, "{profile} at {position:?}: {height} {expected}");
        }
        assert!(cut > 300, "{profile}: {cut}");
    }
}

/// Arcs in a plane, as a helix, upright, and with ends that are not quite as far from the centre.
fn arcs(tool: &Tool) -> Program {
    // off the grid: no node lies on a rim, where rounding decides
    let off = |[x, y, z]: [f64; 3]| [x + 0.0137, y + 0.0071, z];
    let mut path = Path::new().rapid(off([5.0, 6.0, 10.0])).feed(off([5.0, 6.0, -0.5]));
    for (end, centre, plane, clockwise) in [
        ([11.0, 6.0, -0.5], [8.0, 6.0, 0.0], Plane::Xy, true),
        ([8.0, 3.0, -1.6], [8.0, 6.0, 0.0], Plane::Xy, false),
        ([14.0, 3.0, -1.6], [11.0, 3.0, 0.4], Plane::Zx, true),
        ([14.0, 9.0, -1.6], [14.0, 6.0, -5.6], Plane::Yz, false),
        ([14.0, 9.0, -2.0], [15.0, 9.0005, 0.0], Plane::Xy, false),
    ] {
        path = path.feed(off(end));
        path.moves.last_mut().unwrap().arc = Some(Arc { centre: off(centre), plane, clockwise, turns: 0 });
    }
    path.program(tool)
}

/// The same program with every arc in chords.
fn chorded(program: &Program, count: usize) -> Program {
    let mut chorded = Program { moves: Vec::new(), ..program.clone() };
    for (start, step) in program.segments() {
        let path = start.and_then(|start| step.path(start));
        let chord = |i: usize| {
            let end = path.filter(|_| i < count).map_or(step.end.tip, |path| path.at(i as f64 / count as f64));
            step.to(end).arc(None)
        };
        chorded.moves.extend((1..=path.map_or(1, |_| count)).map(chord));
    }
    chorded
}

#[test]
fn arcs_cut_as_ten_thousand_chords_do() {
    for profile in PROFILES {
        let tool = tool(profile);
        let program = arcs(&tool);
        let found = simulated(&tool, &program, 0.5);
        let expected = simulated(&tool, &chorded(&program, 10_000), 0.5);
        let off = |i: usize| (found.heights[i] - expected.heights[i]).abs();
        let worst = (0..found.heights.len()).max_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap();
        let position = nodes(&found).nth(worst).unwrap();
        assert!(off(worst) < 1e-6, "{profile} at {position:?}: off by {}", off(worst));
    }
}

#[test]
fn the_order_of_the_moves_changes_nothing() {
    let tool = tool(PROFILES[3]);
    let mut program = lines(&tool);
    let found = simulated(&tool, &program, 0.3);
    program.moves.reverse();
    let turned = simulated(&tool, &program, 0.3);
    for (a, b) in found.heights.iter().zip(&turned.heights) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let tool = tool(PROFILES[8]);
    let program = lines(&tool);
    let with = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| simulated(&tool, &program, 0.05))
    };
    let [one, two] = [1, 2].map(with);
    assert!(one.heights.iter().zip(&two.heights).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn it_stops_when_asked() {
    let tool = ball(6.0);
    let program = lines(&tool);
    let part = plate();
    let watch = Watch::default();
    watch.cancel();
    let grid = Grid::over([0.0, 0.0], SIZE, 0.1).unwrap();
    let stopped = simulate(&program, &part.subject(std::slice::from_ref(&tool)), &limits(), grid, 0.0, &watch);
    assert!(stopped.is_err());
}

#[test]
fn spacings_that_make_no_grid_are_refused() {
    for spacing in [0.0, -1.0, f64::NAN, 1e-4] {
        assert!(Grid::over([0.0, 0.0], SIZE, spacing).is_err(), "{spacing}");
    }
    assert_eq!(Grid::over([0.0, 0.0], SIZE, 1e3).unwrap().nodes, [2, 2]);
}

/// Passes on a wall of some slope that comes down along X, 1 mm apart along it, and what they leave over it, mm.
fn scallop(profile: &str, wall_deg: f64, up_the_wall: bool) -> f64 {
    let tool = tool(profile);
    let (sin, cos) = wall_deg.to_radians().sin_cos();
    let (radius, height) = tool.point_at(wall_deg.to_radians());
    // the tip that touches the wall z = -x tan at a position along it
    let tip = |down: f64, y: f64| [down * cos + radius, y, -down * sin - height];
    let mut path = Path::new();
    for pass in -8..14 {
        let pass = f64::from(pass);
        let [from, to] = if up_the_wall { [[-30.0, pass], [30.0, pass]] } else { [[pass, -30.0], [pass, 30.0]] };
        let (from, to) = (tip(from[0], from[1]), tip(to[0], to[1]));
        path = path.rapid([from[0], from[1], 90.0]).rapid(from).feed(to).rapid([to[0], to[1], 90.0]);
    }
    let size = if up_the_wall { [0.04, 3.0] } else { [3.0, 0.04] };
    let part = plate();
    let tools = std::slice::from_ref(&tool);
    let grid = Grid::over([0.0, 0.0], size, 0.001).unwrap();
    let program = path.program(&tool);
    let found = simulate(&program, &part.subject(tools), &limits(), grid, 50.0, &Watch::default()).unwrap();
    let over: Vec<f64> = nodes(&found).map(|([x, _], height)| height * cos + x * sin).collect();
    let least = over.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(least.abs() < 1e-5, "{profile} {wall_deg}: {least}");
    over.into_iter().fold(0.0, f64::max)
}

#[test]
fn scallops_are_those_of_the_tables() {
    let ball = r#"{"kind": "ball", "diameter": 10.0}"#;
    let parabola = r#"{"kind": "parabola", "apex_radius": 8.0, "diameter": 60.0}"#;
    let ellipse = r#"{"kind": "ellipse", "radial": 6.0, "axial": 4.0}"#;
    let power = r#"{"kind": "power", "coefficient": 0.016666666666666666, "exponent": 3.0, "diameter": 24.0}"#;
    // passes along the levels, then straight up the wall; micrometres by wall angle
    for (profile, up_the_wall, expected) in [
        (ball, false, [25.063, 25.063, 25.063]),
        (parabola, false, [12.965, 5.524, 1.953]),
        (ellipse, false, [17.078, 28.852, 37.584]),
        (power, false, [27.866, 19.747, 9.194]),
        (parabola, true, [14.683, 11.049, 7.813]),
        (power, true, [15.914, 19.795, 18.409]),
    ] {
        for (wall_deg, expected) in [20.0, 45.0, 60.0].into_iter().zip(expected) {
            let found = scallop(profile, wall_deg, up_the_wall) * 1e3;
            assert!((found - expected).abs() < 0.01 * expected, "{profile} {wall_deg}: {found} {expected}");
        }
    }
}

/// How often each side of the triangles is passed in the direction of its lower end to the higher, less the other direction.
fn open_sides(skin: &Skin) -> usize {
    let mut passed = std::collections::HashMap::new();
    for [a, b, c] in &skin.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *passed.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
        }
    }
    passed.values().filter(|count| **count != 0).count()
}

/// Height of the skin at every node that it covers, by its triangles.
fn worst_of_skin(simulation: &Simulation, skin: &Skin) -> f64 {
    let grid = &simulation.grid;
    let mut worst: f64 = 0.0;
    let mut covered = vec![false; grid.count()];
    for triangle in &skin.triangles {
        let [a, b, c] = triangle.map(|corner| skin.vertices[corner as usize]);
        let (ab, ac) = (b - a, c - a);
        let area = ab.x * ac.y - ab.y * ac.x;
        assert!(area > 0.0);
        for (index, (position, height)) in nodes(simulation).enumerate() {
            let (dx, dy) = (position[0] - a.x, position[1] - a.y);
            let (s, t) = ((dx * ac.y - dy * ac.x) / area, (ab.x * dy - ab.y * dx) / area);
            if s >= -1e-9 && t >= -1e-9 && s + t <= 1.0 + 1e-9 {
                covered[index] = true;
                worst = worst.max((a.z + s * ab.z + t * ac.z - height).abs());
            }
        }
    }
    assert!(covered.iter().all(|covered| *covered));
    worst
}

#[test]
fn triangles_are_few_without_gaps_and_keep_to_the_nodes() {
    let tool = ball(6.0);
    let program = Path::new().rapid([4.0, 6.0, 10.0]).feed([4.0, 6.0, -1.0]).feed([9.0, 7.0, -0.4]).program(&tool);
    let simulation = simulated(&tool, &program, 0.25);
    let all = 2 * (simulation.grid.nodes[0] - 1) * (simulation.grid.nodes[1] - 1);
    let mut last = all;
    for tolerance in [0.02, 0.05, 0.2] {
        let skin = simulation.skin(tolerance, None);
        let worst = worst_of_skin(&simulation, &skin);
        assert!(worst <= tolerance * (1.0 + 1e-6) && worst > 0.1 * tolerance, "{tolerance}: {worst}");
        assert!(skin.triangles.len() < last, "{tolerance}: {}", skin.triangles.len());
        last = skin.triangles.len();
    }
    assert!(last < all / 10, "{last} of {all}");
    let body = simulation.skin(1e-3, Some(-5.0));
    assert_eq!(open_sides(&body), 0);
    assert!(open_sides(&simulation.skin(1e-3, None)) > 0);
    let volume: f64 = body
        .triangles
        .iter()
        .map(|t| t.map(|i| body.vertices[i as usize]))
        .map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0)
        .sum();
    assert!(volume > 0.9 * 5.0 * SIZE[0] * SIZE[1] && volume < 5.0 * SIZE[0] * SIZE[1], "{volume}");
}

#[test]
fn distances_to_the_part_are_what_is_left_and_what_is_taken() {
    let tool = ball(6.0);
    let (high, low) = (Vector::new(0.0, 0.0, -1.0), Vector::new(0.0, 0.0, -3.0));
    // a roof: up to the ridge at Y 6, down again; it ends at X 15
    let (front, back, along) = (Vector::new(0.0, 0.0, 0.0), Vector::new(0.0, 12.0, 0.0), Vector::new(15.0, 0.0, 0.0));
    let ridge = Vector::new(0.0, 6.0, 0.0) + high;
    let corners = vec![front + low, front + low + along, ridge, ridge + along, back + low, back + low + along];
    let part = Part::new(corners, &[[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]]);
    let program = Path::new().rapid([4.0, 6.0, 10.0]).feed([4.0, 6.0, -1.5]).program(&tool);
    let grid = Grid::over([0.0, 0.0], SIZE, 0.25).unwrap();
    let watch = Watch::default();
    let simulation =
        simulate(&program, &part.subject(std::slice::from_ref(&tool)), &limits(), grid, 0.0, &watch).unwrap();
    let distances = simulation.distances(&part.mesh, &part.bvh, &watch).unwrap();
    let cos = 6.0 / 40.0_f64.sqrt();
    for (([x, y], height), found) in nodes(&simulation).zip(distances) {
        let under = -1.0 - (y - 6.0).abs() / 3.0;
        let gap = height - under;
        if x <= 15.0 && gap.abs() < 0.2 && (y - 6.0).abs() > 1.0 && (y - 6.0).abs() < 5.0 {
            assert!((found - gap * cos).abs() < 1e-9, "{x} {y}: {found} {gap}");
        }
        let by_roof = (x > 15.0 && (y - 6.0).abs() < 1e-9).then(|| (x - 15.0).hypot(height + 1.0));
        let expected = by_roof.filter(|_| height > -1.0);
        assert!(expected.is_none_or(|expected| (found - expected).abs() < 1e-9), "{x} {y}: {found} {expected:?}");
        assert!(found.abs() <= gap.abs() + 1e-9 || x > 15.0);
        assert_eq!(found < 0.0, gap < 0.0 && x <= 15.0, "{x} {y}: {found} {gap}");
    }
}
