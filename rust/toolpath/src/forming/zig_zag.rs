//! Zig-zag (lace): slices of the envelope by parallel vertical planes.

use rayon::prelude::*;
use styluscam_motion::Watch;

use super::extra_rows::extra_rows;
use super::pattern::{share, spread, Pattern, Row};
use super::{stances::stances, steps::StepBounds, untouched::Untouched};
use crate::offset::Slice;
use crate::{fitting, fitting::Course, Pass, PathPoint, PlanError, Surface};

/// Distance between samples where a selected facet could be touched between two positions at which none is, mm.
const FINE: f64 = 0.1;
/// How far beside the middle the pattern lies, as a share of the stepover: no part is drawn so that the tool runs along its
/// walls there, where the margin decides between the floor and the wall's top.
const ASIDE: f64 = 0.0382;
/// Rows at most.
const LIMIT: usize = 100_000;

/// How the rows lie.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// Direction of the rows from +X, counterclockwise, rad.
    pub angle: f64,
    /// Distance between rows in plan, mm.
    pub stepover: f64,
    /// Where they lie closer; none where all are a stepover apart.
    pub closer: Option<StepBounds>,
    /// First spacing of samples along a row, mm; refined where the tolerance asks for it.
    pub spacing: f64,
    /// What is narrower may be missed, mm.
    pub narrow: f64,
}

/// All rows over the selected faces, side by side, each in the direction of `angle`.
///
/// Chords deviate by at most `deviation` mm along the normal. Rows are interrupted where the contact leaves the
/// selected faces. A region that no row touches, for it lies between two of them, gets rows of its own, and so does a level floor
/// where no row lies at its height.
///
/// # Errors
/// Nothing to touch, more rows than a program can hold, `Cancelled`.
pub fn zig_zag(surface: &Surface<'_>, rows: &Rows, deviation: f64, watch: &Watch) -> Result<Vec<Pass>, PlanError> {
    let lines = Lines::over(surface, rows)?.ok_or_else(|| PlanError::NothingReached(String::new()))?;
    let mut planned = lines.planned(surface, deviation, watch)?;
    let untouched = Untouched::by(planned.iter().flat_map(|(_, passes)| passes), surface);
    let extra = extra_rows(&untouched, &planned, &lines.pattern, (rows.spacing, deviation), watch)?;
    if !extra.is_empty() {
        planned.extend(Lines { rows: extra, ..lines }.planned(surface, deviation, watch)?);
        planned.sort_by(|a, b| a.0.across.total_cmp(&b.0.across));
    }
    let numbered = planned
        .into_iter()
        .enumerate()
        .flat_map(|(group, (_, passes))| passes.into_iter().map(move |pass| Pass { group, ..pass }));
    Ok(numbered.collect())
}

/// The envelope over a line in plan.
pub(super) struct SurfaceCourse<'a> {
    pub surface: &'a Surface<'a>,
    /// The row on which the line lies, where it is known.
    pub row: Option<&'a Slice<'a>>,
    /// The triangle that was touched last.
    pub hint: Option<u32>,
    pub watch: &'a Watch,
}

impl Course for SurfaceCourse<'_> {
    fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        // a cancelled row ends at once, whatever is left of it
        if self.watch.is_cancelled() {
            return None;
        }
        let middle = (a.tip + b.tip) * 0.5;
        self.surface.on_row(self.row, middle.x, middle.y, &mut self.hint)
    }

    fn keeps_to(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.keeps_to(self.row, a, b, most)
    }

    fn bend(&self) -> f64 {
        self.surface.bend()
    }

    fn may_rise(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.may_rise(self.row, a, b, most)
    }
}

/// Parallel lines in plan.
struct Lines {
    pattern: Pattern,
    rows: Vec<Row>,
    spacing: f64,
    narrow: f64,
}

impl Lines {
    /// Rows over the surface's domain, the pattern centred on it but for [`ASIDE`].
    fn over(surface: &Surface<'_>, rows: &Rows) -> Result<Option<Self>, PlanError> {
        let Some((low, high)) = surface.domain() else { return Ok(None) };
        let Rows { stepover, spacing, narrow, .. } = *rows;
        let (sin, cos) = libm::sincos(rows.angle);
        let (along, across) = ([cos, sin], [-sin, cos]);
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let range = |axis: [f64; 2]| {
            let positions = corners.map(|c| c[0] * axis[0] + c[1] * axis[1]);
            [
                positions.iter().copied().fold(f64::INFINITY, f64::min),
                positions.iter().copied().fold(-f64::INFINITY, f64::max),
            ]
        };
        let [left, right] = range(across);
        let count = ((right - left) / stepover).floor() as usize + 1;
        if count > LIMIT {
            return Err(PlanError::TooMany { what: "stepover", value: stepover, count, limit: LIMIT });
        }
        let range = range(along);
        let positions: Vec<f64> = match &rows.closer {
            None => spread([left, right], count, stepover).map(|across| across + ASIDE * stepover).collect(),
            Some(bounds) => bounds.upwards(left, right).take(LIMIT).collect(),
        };
        let lines = positions.into_iter().map(|across| Row { across, range }).collect();
        let pattern = Pattern { along, across, stepover };
        Ok(Some(Self { rows: lines, pattern, spacing, narrow }))
    }

    /// Each row with its passes.
    fn planned(
        &self,
        surface: &Surface<'_>,
        deviation: f64,
        watch: &Watch,
    ) -> Result<Vec<(Row, Vec<Pass>)>, PlanError> {
        let facets = self.facets(surface);
        watch.begin("rows", self.rows.len());
        let across = self.rows.iter().map(|row| row.across).collect();
        let slices = surface.slices([self.pattern.along, self.pattern.across], across, watch)?;
        let of_block = |block: usize| {
            let rows = slices.rows(block);
            let of_row = |((row, facets), slice): ((&Row, &Vec<[f64; 2]>), &Option<Slice<'_>>)| {
                let passes = self.slice((surface, slice.as_ref()), row, facets, deviation, watch);
                watch.advance(1)?;
                Ok((*row, passes))
            };
            let rows = self.rows[rows.clone()].par_iter().zip(&facets[rows]);
            rows.zip(&slices.of_block(block)).map(of_row).collect::<Result<Vec<_>, PlanError>>()
        };
        let blocks = (0..slices.blocks()).into_par_iter().map(of_block).collect::<Result<Vec<_>, _>>()?;
        Ok(blocks.into_iter().flatten().collect())
    }

    /// The passes of a row; when `watch` is cancelled, some of them.
    fn slice(
        &self,
        (surface, slice): (&Surface<'_>, Option<&Slice<'_>>),
        row: &Row,
        facets: &[[f64; 2]],
        deviation: f64,
        watch: &Watch,
    ) -> Vec<Pass> {
        let mut course = SurfaceCourse { surface, row: slice, hint: None, watch };
        let plain = |a: &PathPoint, b: &PathPoint| {
            let most = fitting::PROVEN * deviation;
            !watch.is_cancelled() && fitting::may_keep_to(a, b, most) && surface.keeps_to_selected(slice, a, b, most)
        };
        let met = self.met((surface, slice), row, facets, plain, &mut course.hint);
        let mut passes = Vec::new();
        let stretches = met.into_iter().flat_map(|exact| surface.stretches(exact, false, |a, b| course.between(a, b)));
        for (exact, _) in stretches.collect::<Vec<_>>() {
            for run in fitting::selected_runs(&exact, false, |a, b| course.between(a, b)) {
                let runs = fitting::densified(&run, deviation, self.narrow, &mut course);
                let pass = |run| Pass { points: surface.thinned(run, deviation), closed: false, group: 0 };
                passes.extend(runs.iter().map(|run| pass(run)));
            }
        }
        passes
    }

    /// Exact points of a row, in runs, as the tool meets something or nothing: from the first position at which it does to
    /// the last.
    fn met(
        &self,
        (surface, slice): (&Surface<'_>, Option<&Slice<'_>>),
        row: &Row,
        facets: &[[f64; 2]],
        plain: impl Fn(&PathPoint, &PathPoint) -> bool,
        hint: &mut Option<u32>,
    ) -> Vec<Vec<PathPoint>> {
        let Pattern { along, across, .. } = self.pattern;
        let mut at = |s: f64| {
            let [x, y] = [0, 1].map(|axis| s * along[axis] + row.across * across[axis]);
            surface.on_row(slice, x, y, hint)
        };
        let mut runs = Vec::new();
        let mut run = Vec::new();
        let mut before: Option<f64> = None;
        for (s, point) in self.sampled(row.range, facets, plain, &mut at) {
            match (point, before) {
                (Some(point), Some(before)) if run.is_empty() => {
                    run.extend(outermost(s, before, &mut at));
                    run.push(point);
                }
                (Some(point), _) => run.push(point),
                (None, Some(before)) if !run.is_empty() => {
                    run.extend(outermost(before, s, &mut at));
                    runs.push(std::mem::take(&mut run));
                }
                (None, _) => {}
            }
            before = Some(s);
        }
        runs.push(run);
        runs
    }

    /// Positions along a row and what the tool meets there: the farther apart, the longer nothing changes.
    ///
    /// `plain` decides of two points whether all between them is selected and on a straight line with them.
    fn sampled(
        &self,
        [first, last]: [f64; 2],
        facets: &[[f64; 2]],
        plain: impl Fn(&PathPoint, &PathPoint) -> bool,
        at: &mut impl FnMut(f64) -> Option<PathPoint>,
    ) -> Vec<(f64, Option<PathPoint>)> {
        let samples = ((last - first) / self.spacing).ceil().max(1.0) as usize;
        let gap = (last - first) / samples as f64;
        let mut facing = vec![false; samples];
        for [from, to] in facets {
            let [from, to] = [from, to].map(|s| (((s - first) / gap).max(0.0) as usize).min(samples - 1));
            facing[from..=to].fill(true);
        }
        let selected = |point: Option<PathPoint>| point.is_some_and(|p| p.selected);
        let is_plain = |a: Option<PathPoint>, b: Option<PathPoint>| a.zip(b).is_some_and(|(a, b)| plain(&a, &b));
        let mut before = at(first);
        let mut sampled = vec![(first, before)];
        let (mut i, mut step) = (0, 1);
        while i < samples {
            step = step.min(samples - i);
            let start = first + i as f64 * gap;
            let end = start + step as f64 * gap;
            let point = at(end);
            let goes_on = is_plain(before, point);
            if step > 1 && !goes_on {
                step /= 2;
                continue;
            }
            if facing[i] && !selected(before) && !selected(point) {
                let fine = (gap / FINE).ceil() as usize;
                let between = (1..fine).map(|j| start + gap * j as f64 / fine as f64);
                sampled.extend(between.map(|s| (s, at(s))));
            }
            sampled.push((end, point));
            before = point;
            i += step;
            step = if goes_on { 2 * step } else { 1 };
        }
        sampled
    }

    /// By row, from where to where along it the tool could touch selected facets, but for what keeps it from there.
    fn facets(&self, surface: &Surface<'_>) -> Vec<Vec<[f64; 2]>> {
        let mut found = vec![Vec::new(); self.rows.len()];
        for stances in stances(surface) {
            let plan = stances.map(|tip| {
                let on = |axis: [f64; 2]| tip.x * axis[0] + tip.y * axis[1];
                [on(self.pattern.along), on(self.pattern.across)]
            });
            let [low, high] = [f64::min, f64::max].map(|of| plan.map(|p| p[1]).into_iter().reduce(of).unwrap_or(0.0));
            let first = self.rows.partition_point(|row| row.across < low);
            let rows = self.rows.iter().zip(&mut found).skip(first).take_while(|(row, _)| row.across <= high);
            rows.for_each(|(row, found)| found.extend(share(&plan, row.across)));
        }
        found
    }
}

/// The last position at which the tool meets something, between one where it does and one where it does not.
fn outermost(touching: f64, free: f64, at: &mut impl FnMut(f64) -> Option<PathPoint>) -> Option<PathPoint> {
    let (mut touching, mut free) = (touching, free);
    let mut found = None;
    while (free - touching).abs() > fitting::BORDER {
        let middle = 0.5 * (touching + free);
        match at(middle) {
            Some(point) => (touching, found) = (middle, Some(point)),
            None => free = middle,
        }
    }
    found
}
