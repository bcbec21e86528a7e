//! Where closed passes begin so that leads fit.
//!
//! In a corner of a pocket the wall that the pass turns to stands where a lead would be. A loop may begin anywhere else: at the
//! position nearest along it at which the lead in and the lead out both fit, or one of them where no position has room for both.
//! Loops that are joined along the surface move together: the lead in is at the first, the lead out at the last. Derived in
//! docs/concepts/linking.md.

use std::ops::Range;

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use crate::leads::Side;
use crate::seam::{self, Start};
use crate::{Entered, Leading, LinkRules, PathPoint};

/// Positions along a loop that are tried, at most.
const MOST: u32 = 64;
/// Distance between positions, as a share of how far a lead reaches along its pass.
const SPACING: f64 = 0.5;

impl<R: LinkRules<PathPoint>> Leading<'_, R> {
    /// Has loops to which the tool comes through the air begin where leads fit; those after one that was moved begin beside it.
    /// Where a ramp or an open pass is joined to them they stay. Gives the number of loops that begin elsewhere. Passes without
    /// points are dropped.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn begin_where_they_fit(&self, entered: &mut Vec<Entered>, watch: &Watch) -> Result<usize, Cancelled> {
        entered.retain(|entered| !entered.pass.points.is_empty()); // as they are numbered in what stands
        watch.begin("fitting leads", entered.len());
        let (mut moved, mut first, mut beside) = (0, 0, None);
        while first < entered.len() {
            let chain = first..self.chain_end(entered, first);
            watch.advance(chain.len())?;
            first = chain.end;
            let may_begin_anywhere = entered[chain.clone()].iter().all(|entered| entered.pass.closed)
                && entered[chain.start + 1..].iter().take(chain.len()).all(|after| after.ramp.is_empty());
            if !may_begin_anywhere {
                beside = None;
                continue;
            }
            let starts = self.better(entered, chain.clone(), beside);
            moved += starts.as_ref().map_or(0, Vec::len);
            for (entered, start) in entered[chain.clone()].iter_mut().zip(starts.iter().flatten()) {
                seam::begin_on(&mut entered.pass.points, *start);
            }
            beside = starts.and_then(|_| Some(entered[chain].last()?.pass.points.first()?.tip));
        }
        Ok(moved)
    }

    /// The number after the last pass that is joined to one without a link through the air.
    fn chain_end(&self, entered: &[Entered], first: usize) -> usize {
        let is_joined = |after: &usize| {
            let Entered { pass, ramp, .. } = &entered[*after];
            let ends = entered[after - 1].pass.points.last().zip(pass.points.first());
            !ramp.is_empty() || ends.is_some_and(|(from, to)| self.rules.path(from, to).is_some())
        };
        (first + 1..entered.len()).find(|after| !is_joined(after)).unwrap_or(entered.len())
    }

    /// Where the loops of a chain begin so that more leads fit, the first beside a position of the tool, if there is one; none
    /// where they begin well as they are.
    fn better(&self, entered: &[Entered], chain: Range<usize>, beside: Option<Vector>) -> Option<Vec<Start>> {
        let points = &entered[chain.start].pass.points;
        let fit = |start| self.fit(entered, chain.clone(), start);
        let given = beside.and_then(|beside| seam::beside(points, beside)).and_then(&fit);
        let (mut most, mut best) = match given {
            Some((count, starts)) => (count, Some(starts)),
            None => (self.fit_as_given(entered, &chain), None),
        };
        let spacing = SPACING * self.lead.radius * libm::sin(self.lead.angle);
        let from = best.as_ref().and_then(|starts| starts.first()).copied();
        for start in starts(points, from, spacing) {
            if most == 2 {
                break;
            }
            if let Some((count, starts)) = fit(start).filter(|(count, _)| *count > most) {
                (most, best) = (count, Some(starts));
            }
        }
        best
    }

    /// How many leads fit where the first loop of a chain begins at a position, and the others beside it; none where the loops
    /// are no longer joined along the surface.
    fn fit(&self, entered: &[Entered], chain: Range<usize>, start: Start) -> Option<(usize, Vec<Start>)> {
        let mut points = &entered[chain.start].pass.points;
        let (mut at, mut starts) = (start.on(points)?.0, vec![start]);
        let into = self.fits(Side::In, chain.start, (&at, start.leaving(points)?));
        for Entered { pass, .. } in &entered[chain.start + 1..chain.end] {
            points = &pass.points;
            let next = seam::beside(points, at.tip)?;
            let (to, _) = next.on(points)?;
            self.rules.path(&at, &to)?;
            at = to;
            starts.push(next);
        }
        let out = self.fits(Side::Out, chain.end - 1, (&at, starts.last()?.arriving(points)?));
        Some((usize::from(into) + usize::from(out), starts))
    }

    /// How many leads fit where the loops of a chain begin.
    fn fit_as_given(&self, entered: &[Entered], chain: &Range<usize>) -> usize {
        let [first, last] = [chain.start, chain.end - 1].map(|number| &entered[number].pass.points[..]);
        let ([begin, second, ..], [.., before, end]) = (first, last) else { return 2 };
        usize::from(self.fits(Side::In, chain.start, (begin, second.tip - begin.tip)))
            + usize::from(self.fits(Side::Out, chain.end - 1, (end, end.tip - before.tip)))
    }
}

/// Positions evenly along a loop, from those next to one, or to where it begins, on both sides, to the far side.
fn starts(points: &[PathPoint], from: Option<Start>, spacing: f64) -> impl Iterator<Item = Start> {
    let mut lengths = vec![0.0];
    for side in points.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + (side[1].tip - side[0].tip).norm());
    }
    let length = lengths[lengths.len() - 1];
    let count = (length / spacing).floor().clamp(0.0, f64::from(MOST)) as u32;
    let of_side = move |lengths: &[f64], side: usize| lengths.get(side..).and_then(|rest| rest.first_chunk().copied());
    let from = from.and_then(|from| of_side(&lengths, from.side).map(|[a, b]| a + from.share * (b - a)));
    let from = from.unwrap_or(0.0);
    (1..count).filter_map(move |i| {
        // 1, -1, 2, -2 ... of so many steps around
        let steps = f64::from(i.div_ceil(2)) / f64::from(count);
        let round = from / length + if i % 2 == 1 { steps } else { 1.0 - steps };
        let at = length * (round - round.floor());
        let side = lengths.partition_point(|end| *end <= at).clamp(1, lengths.len() - 1) - 1;
        let [a, b] = of_side(&lengths, side)?;
        Some(Start { side, share: ((at - a) / (b - a).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_positions_come_first_and_all_are_on_the_loop() {
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        let point = |[x, y]: [f64; 2]| PathPoint {
            tip: Vector::new(x, y, -1.0),
            normal: Vector::z(),
            selected: true,
            triangle: 0,
        };
        let points: Vec<PathPoint> = corners.map(point).to_vec();
        let tips: Vec<[f64; 2]> = starts(&points, None, 5.0)
            .map(|start| start.on(&points).unwrap().0.tip)
            .map(|tip| [tip.x, tip.y])
            .collect();
        let expected = [[5.0, 0.0], [0.0, 5.0], [10.0, 0.0], [0.0, 10.0], [10.0, 5.0], [5.0, 10.0], [10.0, 10.0]];
        assert_eq!(tips, expected);
        assert_eq!(starts(&points, None, 0.001).count(), MOST as usize - 1);
        assert_eq!(starts(&points, None, 50.0).count(), 0);
    }
}
