//! The envelope sampled on a square grid: from it loops are found, not measured.

use styluscam_motion::{Cancelled, Watch};

use crate::{offset::Contact, Surface};

/// Nodes at most: beyond it the cell grows.
const NODES: f64 = 4e6;

/// Contacts of the envelope on a square grid.
pub struct Grid {
    origin: [f64; 2],
    cell: f64,
    columns: usize,
    rows: usize,
    contacts: Vec<Option<Contact>>,
}

impl Grid {
    /// Samples the envelope over the surface's domain, `cell` mm apart or a little less.
    ///
    /// A loop whose inside, or the free ground around it, holds a disc of [`smallest_feature`](Self::smallest_feature)
    /// holds a node, and is found.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn sample(surface: &Surface<'_>, cell: f64, watch: &Watch) -> Result<Option<Self>, Cancelled> {
        let Some((low, high)) = surface.domain() else { return Ok(None) };
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let cell = cell.max((width * height / NODES).sqrt());
        // one ring of nodes outside: there the tool touches nothing that was asked for
        let (columns, rows) = ((width / cell).ceil() as usize + 3, (height / cell).ceil() as usize + 3);
        let origin = [low[0] - cell, low[1] - cell];
        let places: Vec<[f64; 2]> = (0..rows * columns)
            .map(|n| [origin[0] + (n % columns) as f64 * cell, origin[1] + (n / columns) as f64 * cell])
            .collect();
        watch.begin("sampling", places.len());
        let contacts = surface.envelope().contacts(&places, watch)?;
        Ok(Some(Self { origin, cell, columns, rows, contacts }))
    }

    /// Diameter of the largest disc that may hide between nodes, mm.
    #[must_use]
    pub fn smallest_feature(&self) -> f64 {
        self.cell * std::f64::consts::SQRT_2
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    pub(super) fn place(&self, column: usize, row: usize) -> [f64; 2] {
        [self.origin[0] + column as f64 * self.cell, self.origin[1] + row as f64 * self.cell]
    }

    /// Whether the tool's tip must stay above `z` at a node.
    pub(super) fn is_above(&self, column: usize, row: usize, z: f64) -> bool {
        self.contacts[row * self.columns + column].is_some_and(|c| c.tip > z)
    }

    /// Where the level `z` most likely is between two nodes, as a share of the way: on the straight line between their tips.
    pub(super) fn share_at(&self, above: (usize, usize), free: (usize, usize), z: f64) -> f64 {
        let tip = |(column, row): (usize, usize)| self.contacts[row * self.columns + column].map(|c| c.tip);
        match (tip(above), tip(free)) {
            (Some(high), Some(low)) if high > low => ((high - z) / (high - low)).clamp(0.01, 0.99),
            _ => 0.5,
        }
    }

    /// Lowest and highest tip among the nodes whose contact is selected.
    #[must_use]
    pub fn selected_range(&self, surface: &Surface<'_>) -> Option<(f64, f64)> {
        let tips = self.contacts.iter().enumerate().filter_map(|(n, contact)| {
            let [x, y] = self.place(n % self.columns, n / self.columns);
            contact.as_ref().map(|c| surface.path_point(x, y, c)).filter(|p| p.selected).map(|p| p.tip.z)
        });
        tips.fold(None, |range: Option<(f64, f64)>, z| {
            Some(range.map_or((z, z), |(low, high)| (low.min(z), high.max(z))))
        })
    }
}
