//! Upright boxes of the plane: what has changed, and how far around it something new can be.

use super::contours::Point;

/// Low and high corner of an upright box.
pub type Window = [Point; 2];

/// A box larger by `by` on all sides, mm.
pub fn wider([low, high]: Window, by: f64) -> Window {
    [low.map(|x| x - by), high.map(|x| x + by)]
}

/// Whether two boxes have a point in common.
pub fn meets([low, high]: &Window, [from, to]: &Window) -> bool {
    (0..2).all(|i| low[i] <= to[i] && from[i] <= high[i])
}

/// What two boxes have in common; None where that is nothing.
pub fn common([low, high]: Window, [from, to]: Window) -> Option<Window> {
    let common = [[0, 1].map(|i| low[i].max(from[i])), [0, 1].map(|i| high[i].min(to[i]))];
    (0..2).all(|i| common[0][i] <= common[1][i]).then_some(common)
}

/// The smallest box around two.
pub fn around([low, high]: Window, [from, to]: Window) -> Window {
    [[0, 1].map(|i| low[i].min(from[i])), [0, 1].map(|i| high[i].max(to[i]))]
}

/// Boxes of which no two meet, around boxes: those that meet are joined. In the order of their low corners.
pub fn joined(boxes: impl IntoIterator<Item = Window>) -> Vec<Window> {
    let mut found: Vec<Window> = Vec::new();
    for mut one in boxes {
        while let Some(place) = found.iter().position(|other| meets(&one, other)) {
            one = around(one, found.swap_remove(place));
        }
        found.push(one);
    }
    found.sort_by(|[a, _], [b, _]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    found
}

/// mm^2.
pub fn area([low, high]: &Window) -> f64 {
    (high[0] - low[0]) * (high[1] - low[1])
}

/// What of a contour lies in a box; None where that is nothing. It may run to and fro along the box's sides (I. Sutherland, G. Hodgman, 1974).
pub fn clipped(contour: &[Point], [low, high]: Window) -> Option<Vec<Point>> {
    let sides = [(0, 1.0, low[0]), (0, -1.0, -high[0]), (1, 1.0, low[1]), (1, -1.0, -high[1])];
    let cut = sides.iter().fold(contour.to_vec(), |kept, side| half(&kept, *side));
    (cut.len() > 2).then_some(cut)
}

/// What of a contour has a coordinate, times a sign, no lower than a limit.
fn half(contour: &[Point], (axis, sign, limit): (usize, f64, f64)) -> Vec<Point> {
    let above = |p: &Point| sign * p[axis] - limit;
    if contour.iter().all(|p| above(p) >= 0.0) {
        return contour.to_vec();
    }
    let mut kept = Vec::with_capacity(contour.len());
    let Some(mut before) = contour.last() else { return kept };
    for point in contour {
        let (was, is) = (above(before), above(point));
        if (was < 0.0) != (is < 0.0) {
            let share = was / (was - is);
            let mut crossing = [0, 1].map(|i| before[i] + share * (point[i] - before[i]));
            crossing[axis] = sign * limit;
            kept.push(crossing);
        }
        if is >= 0.0 {
            kept.push(*point);
        }
        before = point;
    }
    kept
}
