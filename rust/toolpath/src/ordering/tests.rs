use proptest::prelude::*;
use styluscam_geometry::Vector;

use super::*;
use crate::PathPoint;

const AIR: Air = Air { height: 10.0, along: 2.0 };

fn pass(points: &[[f64; 2]], closed: bool, group: usize) -> Pass {
    let tip = |[x, y]: &[f64; 2]| Vector::new(*x, *y, -(group as f64));
    let point = |p: &[f64; 2]| PathPoint { tip: tip(p), normal: Vector::z(), selected: true, triangle: 0 };
    let mut points: Vec<PathPoint> = points.iter().map(point).collect();
    if closed {
        points.extend(points.first().copied());
    }
    Pass { points, closed, group }
}

/// A square loop with lower ground inside.
fn square([x, y]: [f64; 2], half: f64, group: usize) -> Pass {
    pass(&[[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]], true, group)
}

fn short(passes: &[Pass], sense: Sense, freedom: Freedom<'_>) -> Ordered {
    shortly_ordered(passes.to_vec(), (sense, Seam::Nearest), freedom, &AIR, &Watch::default()).unwrap()
}

/// The points of a pass, wherever it begins and whichever way it runs.
fn content(pass: &Pass) -> Vec<String> {
    let points = &pass.points[usize::from(pass.closed)..];
    let mut content: Vec<String> = points.iter().map(|point| format!("{:?}", point.tip)).collect();
    content.sort();
    content
}

fn least_distance(a: &Pass, b: &Pass) -> f64 {
    let of = |p: &PathPoint| b.points.iter().map(|q| (p.tip - q.tip).xy().norm()).fold(f64::INFINITY, f64::min);
    a.points.iter().map(of).fold(f64::INFINITY, f64::min)
}

fn any_passes() -> impl Strategy<Value = Vec<Pass>> {
    let corner = (0..60_i32, 0..60_i32).prop_map(|(x, y)| [f64::from(x), f64::from(y)]);
    let side = (-6..6_i32, -6..6_i32).prop_map(|(x, y)| [f64::from(x), f64::from(y)]);
    let points = (corner, prop::collection::vec(side, 1..6)).prop_map(|(first, sides)| {
        let along = sides.into_iter().scan(first, |at, [x, y]| {
            *at = [at[0] + x, at[1] + y];
            Some(*at)
        });
        std::iter::once(first).chain(along).collect::<Vec<_>>()
    });
    prop::collection::vec((points, any::<bool>(), 0..5_usize), 1..60).prop_map(|mut passes| {
        passes.sort_by_key(|(_, _, group)| *group);
        passes.iter().map(|(points, closed, group)| pass(points, *closed, *group)).collect()
    })
}

fn any_sense() -> impl Strategy<Value = Sense> {
    prop::sample::select(vec![Sense::Forward, Sense::Reversed, Sense::Alternate])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]
    #[test]
    fn all_passes_are_there_and_none_before_what_it_follows(
        passes in any_passes(),
        sense in any_sense(),
        which in 0..4_usize,
        inside_first in any::<bool>(),
    ) {
        let reach = 5.0;
        let freedom = match which {
            0 => Freedom::WithinGroups,
            1 => Freedom::OfAreas { reach, inside_first },
            2 => Freedom::OfRows { sets: &[0, 2], is_reversible: true, reach },
            _ => Freedom::OfRows { sets: &[0, 2], is_reversible: false, reach },
        };
        let ordered = short(&passes, sense, freedom);
        prop_assert_eq!(&ordered, &short(&passes, sense, freedom));
        let sorted = |passes: &[Pass]| {
            let mut all: Vec<_> = passes.iter().map(|pass| (pass.group, pass.closed, content(pass))).collect();
            all.sort();
            all
        };
        prop_assert_eq!(sorted(&passes), sorted(&ordered.passes));
        let [nearest, between] = ordered.between;
        prop_assert!(between <= nearest && (AIR.between(&ordered.passes) - between).abs() < 1e-6);
        let stage = |pass: &Pass| if which < 2 { pass.group } else { usize::from(pass.group >= 2) };
        for (i, first) in ordered.passes.iter().enumerate() {
            for later in &ordered.passes[i + 1..] {
                let is_wrong = stage(later) < stage(first) && (which == 0 || least_distance(first, later) <= reach);
                prop_assert!(!is_wrong, "{first:?} before {later:?}");
            }
        }
        // loops keep their sense, and so do open passes that may not be turned
        let mut given = passes;
        for (number, group) in given.chunk_by_mut(|a, b| a.group == b.group).enumerate() {
            group.iter_mut().filter(|_| sense.turns(number)).for_each(|pass| pass.points.reverse());
        }
        let begins = |pass: &Pass, with: &Pass| {
            let side = [pass.points[0].tip, pass.points[1].tip];
            with.points.windows(2).any(|pair| [pair[0].tip, pair[1].tip] == side)
        };
        for pass in ordered.passes.iter().filter(|pass| pass.closed || which != 2) {
            prop_assert!(given.iter().any(|with| content(with) == content(pass) && begins(pass, with)));
        }
    }
}

#[test]
fn what_the_nearest_leaves_behind_is_put_where_it_costs_least() {
    // along X the nearest is always to the right; the one at -3 is left for the end
    let first = pass(&[[0.0, 0.0], [0.0, 0.1]], false, 0);
    let others = [4.0, 8.0, 12.0, 16.0, 20.0, -5.0].map(|x| pass(&[[x, 0.0], [x, 0.1], [x + 0.1, 0.1]], true, 1));
    let passes: Vec<Pass> = std::iter::once(first).chain(others).collect();
    let order = short(&passes, Sense::Forward, Freedom::WithinGroups);
    let starts: Vec<f64> = order.passes.iter().map(|pass| pass.points[0].tip.x.round()).collect();
    assert_eq!(starts, [0.0, -5.0, 4.0, 8.0, 12.0, 16.0, 20.0]);
    assert!((order.between[0] - order.between[1] - 15.0).abs() < 0.5, "{:?}", order.between);
}

#[test]
fn an_area_is_done_from_the_top_down_before_the_next() {
    let areas = [[0.0, 0.0], [40.0, 0.0], [80.0, 0.0]];
    let passes: Vec<Pass> = (0..6).flat_map(|group| areas.map(|at| square(at, 10.0 - group as f64, group))).collect();
    let by_level = short(&passes, Sense::Forward, Freedom::WithinGroups);
    let by_area = short(&passes, Sense::Forward, Freedom::OfAreas { reach: 6.0, inside_first: true });
    assert!(by_level.passes.windows(2).all(|pair| pair[0].group <= pair[1].group));
    let groups: Vec<usize> = by_area.passes.iter().map(|pass| pass.group).collect();
    assert_eq!(groups, [0, 1, 2, 3, 4, 5].repeat(3));
    assert!(by_area.between[1] < 0.25 * by_level.between[1], "{:?} {:?}", by_area.between, by_level.between);
}

#[test]
fn pits_in_a_pit_come_after_it_and_what_is_inside_a_loop_before_the_loop_below() {
    // a wide pit, in its floor two pits and a boss, all of them farther from its wall than the reach
    let pits = [[-25.0, 0.0], [25.0, 0.0]];
    let turned = |mut pass: Pass| {
        pass.points.reverse();
        pass
    };
    let boss = |group: usize| turned(square([0.0, 0.0], 3.0 + group as f64, group));
    let passes: Vec<Pass> = (0..8)
        .flat_map(|group| {
            let wide = (group < 4).then(|| square([0.0, 0.0], 60.0 - group as f64, group));
            let deep = pits.iter().filter(move |_| group >= 4).map(move |at| square(*at, 12.0 - group as f64, group));
            wide.into_iter().chain((1..4).contains(&group).then(|| boss(group))).chain(deep)
        })
        .collect();
    let is_boss = |pass: &Pass| pass.points[0].tip.x.abs() < 10.0;
    let is_wide = |pass: &Pass| pass.points.iter().any(|point| point.tip.x.abs() > 50.0);
    for inside_first in [false, true] {
        let order = short(&passes, Sense::Forward, Freedom::OfAreas { reach: 6.0, inside_first }).passes;
        let last_wide = order.iter().rposition(is_wide).unwrap();
        let first_deep = order.iter().position(|pass| !is_wide(pass) && !is_boss(pass)).unwrap();
        assert!(last_wide < first_deep);
        let deep: Vec<f64> =
            order[first_deep..].iter().filter(|pass| !is_boss(pass)).map(|p| p.points[0].tip.x.signum()).collect();
        assert_eq!(deep.windows(2).filter(|pair| (pair[0] - pair[1]).abs() > 0.0).count(), 1, "{deep:?}");
        // the boss' loop of level 1 hangs inside of the wide loop of level 2
        let first_boss = order.iter().position(is_boss).unwrap();
        assert_eq!(first_boss < last_wide, inside_first);
    }
}

#[test]
fn rows_of_several_areas_are_done_area_by_area() {
    let row = |group: usize, x: f64| {
        let mut row = pass(&[[x, group as f64], [x + 10.0, group as f64]], false, group);
        row.points.iter_mut().for_each(|point| point.tip.z = 0.0);
        row
    };
    let rows: Vec<Pass> = (0..20).flat_map(|group| [row(group, 0.0), row(group, 100.0), row(group, 50.0)]).collect();
    let freedom = |is_reversible| Freedom::OfRows { sets: &[0], is_reversible, reach: 1.5 };
    let both = short(&rows, Sense::Alternate, freedom(true));
    // three areas, 19 turns of 1 mm in each, two links up and down by 10 mm: an even number of rows ends where it began
    assert!(both.between[1] < 3.0 * 19.0 + 2.0 * (51.0 + 20.0), "{:?}", both.between);
    let one_way = short(&rows, Sense::Forward, freedom(false));
    assert!(one_way.passes.iter().all(|pass| pass.points[1].tip.x > pass.points[0].tip.x));
    assert!(one_way.between[1] < 0.7 * one_way.between[0], "{:?}", one_way.between);
}

#[test]
fn the_work_on_many_passes_is_bounded() {
    let at = |i: usize| [7.3 * ((i * 7919) % 211) as f64, 5.1 * ((i * 104_729) % 197) as f64];
    let passes: Vec<Pass> = (0..6000).map(|i| square(at(i), 1.0, i / 3000)).collect();
    let began = std::time::Instant::now();
    for freedom in [Freedom::WithinGroups, Freedom::OfAreas { reach: 3.0, inside_first: true }] {
        let ordered = short(&passes, Sense::Forward, freedom);
        // up and down by 10 mm each time; the rest is what an order decides
        let lifts = 2.0 * AIR.height * passes.len() as f64;
        let [nearest, between] = ordered.between.map(|between| between - lifts);
        assert!(between < 0.98 * nearest, "{:?}", ordered.between);
    }
    // some seconds of work, and machines are busy
    assert!(began.elapsed().as_secs_f64() < 60.0, "{:?}", began.elapsed());
}
