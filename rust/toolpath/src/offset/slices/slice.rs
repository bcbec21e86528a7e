//! All that a part asks of the tool over a row: pieces, each a facet, an edge or a corner on a stretch of the row.

use super::super::contact::{Best, Chord, Contacts, Feature};
use super::super::search::Keeping;
use super::frame::{dot, Frame};
use super::sorted::Sorted;

/// Pieces looked at for a position, on average, from which on a search for each position is quicker.
const CROWDED: usize = 32;
/// Two heights that differ by no more are one, as a share of the part's size.
const SAME: f64 = 1e-12;

/// A part of a triangle on a stretch of a row.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// From and to along the row, mm.
    pub share: [f64; 2],
    /// Height of the tip with the cutter on the triangle's plane at the beginning, and its rise along the row: no tip on this part is
    /// higher. Infinite for walls.
    pub plane: [f64; 2],
    pub triangle: u32,
    pub feature: Feature,
    /// Whether all triangles that meet there are selected, on no border.
    pub is_selected: bool,
}

impl Piece {
    #[inline]
    fn on_plane(&self, s: f64) -> f64 {
        self.plane[0] + self.plane[1] * (s - self.share[0])
    }
}

/// All that a part asks of the tool over a row.
pub struct Slice<'a> {
    contacts: &'a Contacts<'a>,
    frame: Frame,
    /// Facets first.
    pieces: Vec<Piece>,
    /// Where the first cell begins, and cells for each mm.
    first: f64,
    rate: f64,
    /// Numbers of the pieces in each cell.
    cells: Sorted<u32>,
    /// Heights that differ by less are the same, mm.
    same: f64,
}

impl<'a> Slice<'a> {
    /// The slice of these pieces; none where so many lie over one another that a search is quicker.
    pub fn of(contacts: &'a Contacts<'a>, frame: Frame, pieces: Vec<Piece>, reach: f64) -> Option<Self> {
        let (mut sorted, others): (Vec<Piece>, Vec<Piece>) =
            pieces.into_iter().partition(|piece| piece.feature == Feature::Facet);
        sorted.extend(others);
        let pieces = sorted;
        let first = pieces.iter().map(|piece| piece.share[0]).fold(f64::INFINITY, f64::min);
        let last = pieces.iter().map(|piece| piece.share[1]).fold(f64::NEG_INFINITY, f64::max);
        let count = pieces.len();
        let rate = if last > first { count as f64 / (last - first) } else { 0.0 };
        let mut slice = Self { contacts, frame, pieces, first, rate, cells: Sorted::default(), same: SAME * reach };
        let cells = slice.pieces.iter().map(|piece| piece.share.map(|s| slice.cell(s) as u32));
        let cells: Vec<(u32, [u32; 2])> = (0..).zip(cells).collect();
        let total: usize = cells.iter().map(|(_, [from, to])| (to - from) as usize + 1).sum();
        if total > CROWDED * count {
            return None;
        }
        slice.cells = Sorted::of(cells.iter(), count);
        Some(slice)
    }

    /// The cell of a position, the first or the last one beyond them.
    #[inline]
    fn cell(&self, s: f64) -> usize {
        (((s - self.first) * self.rate).max(0.0) as usize).min(self.pieces.len().saturating_sub(1))
    }

    fn members(&self, cell: usize) -> &[u32] {
        if self.pieces.is_empty() {
            return &[];
        }
        self.cells.at(cell)
    }

    /// The highest contact of the cutter over a position of the row, and whether all triangles that meet there are selected, on no border.
    pub fn found(&self, position: [f64; 2]) -> (Best, bool) {
        let s = dot(self.frame.along, position);
        let members = self.members(self.cell(s)).iter().map(|member| &self.pieces[*member as usize]);
        let mut covering = members.filter(|piece| piece.share[0] <= s && s <= piece.share[1]);
        let (mut highest, mut facet, mut other) = (f64::NEG_INFINITY, None, None);
        for piece in covering.by_ref() {
            if piece.feature != Feature::Facet {
                other = Some(piece);
                break;
            }
            let height = piece.on_plane(s);
            if height > highest {
                (highest, facet) = (height, Some(piece));
            }
        }
        let (mut found, mut is_selected) = (Best::NOTHING, false);
        for piece in facet.into_iter().chain(other).chain(covering) {
            if piece.on_plane(s) >= found.tip - self.same {
                let before = found.triangle;
                let tip = found.tip;
                self.contacts.touch_feature(piece.triangle, piece.feature, position, &mut found);
                if found.triangle != before || found.tip > tip {
                    is_selected = piece.is_selected;
                }
            }
        }
        (found, is_selected)
    }

    /// Whether the tips stay within some height of a chord of tips on the row, along all of it: `most` (mm) gives it for what is
    /// selected and what is not.
    pub fn keeps_under(&self, chord: &Chord, most: impl Fn(bool) -> f64) -> Keeping {
        let end = chord.at(1.0);
        let [from, to] = [chord.from, end.0].map(|position| dot(self.frame.along, position));
        let (low, high) = (from.min(to), from.max(to));
        let length = to - from;
        let rate = if length == 0.0 { 0.0 } else { 1.0 / length };
        let [first, last] = [low, high].map(|s| self.cell(s));
        for cell in first..=last {
            for member in self.members(cell) {
                let piece = &self.pieces[*member as usize];
                if cell > first && self.cell(piece.share[0]) < cell {
                    continue; // it was in the cell before
                }
                let part = [piece.share[0].max(low), piece.share[1].min(high)];
                if part[0] > part[1] {
                    continue;
                }
                let most = most(piece.is_selected);
                let shares = part.map(|s| ((s - from) * rate).clamp(0.0, 1.0));
                let over = |i: usize| piece.on_plane(part[i]) - (chord.tip + shares[i] * chord.rise);
                if over(0) <= most && over(1) <= most {
                    continue;
                }
                let shares = if shares[0] <= shares[1] { shares } else { [shares[1], shares[0]] };
                let part = chord.part(shares[0], shares[1]);
                if piece.feature == Feature::Facet
                    || !self.contacts.feature_stays_under(piece.triangle, piece.feature, &part, most)
                {
                    return Keeping::Over;
                }
            }
        }
        Keeping::Under
    }
}
