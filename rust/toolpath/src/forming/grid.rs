//! The envelope sampled on a square grid, and bounded in its cells: from it loops are found, not measured.

use styluscam_motion::{Cancelled, Watch};

use crate::{
    offset::{Contact, Range},
    Surface,
};

/// How far outside the domain the grid begins, as a share of a cell: no part is drawn so that its walls' offsets run along
/// the grid's lines by that.
const ASIDE: f64 = 0.618;
/// Nodes at most: beyond it the cell grows.
const NODES: f64 = 4e6;

/// Contacts of the envelope on a square grid, and bounds of it between them.
pub struct Grid {
    origin: [f64; 2],
    cell: f64,
    columns: usize,
    rows: usize,
    contacts: Vec<Option<Contact>>,
    ranges: Vec<Range>,
}

impl Grid {
    /// Samples the envelope over the surface's domain, `cell` mm apart or a little less.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn sample(surface: &Surface<'_>, cell: f64, watch: &Watch) -> Result<Option<Self>, Cancelled> {
        let Some((low, high)) = surface.domain() else { return Ok(None) };
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let cell = cell.max((width * height / NODES).sqrt());
        // one ring of nodes outside: there the tool touches nothing that was asked for
        let (columns, rows) = ((width / cell).ceil() as usize + 3, (height / cell).ceil() as usize + 3);
        let origin = low.map(|low| low - ASIDE * cell);
        let mut grid = Self { origin, cell, columns, rows, contacts: Vec::new(), ranges: Vec::new() };
        let places: Vec<[f64; 2]> =
            (0..rows * columns).map(|n| grid.place([(n % columns) as f64, (n / columns) as f64])).collect();
        watch.begin("sampling", 2 * places.len());
        grid.contacts = surface.envelope().contacts(&places, watch)?;
        let boxes: Vec<[[f64; 2]; 2]> = (0..(rows - 1) * (columns - 1))
            .map(|n| {
                let (column, row) = ((n % (columns - 1)) as f64, (n / (columns - 1)) as f64);
                [grid.place([column, row]), grid.place([column + 1.0, row + 1.0])]
            })
            .collect();
        grid.ranges = surface.envelope().ranges(&boxes, watch)?;
        Ok(Some(grid))
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

    /// A place in plan, told in cells: column and row of a node where they are whole.
    pub(super) fn place(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + column * self.cell, self.origin[1] + row * self.cell]
    }

    /// The tip over a node; none where nothing is touched.
    pub(super) fn tip(&self, [column, row]: [usize; 2]) -> Option<f64> {
        self.contacts[row * self.columns + column].map(|contact| contact.tip)
    }

    /// Between which heights the tip lies in the cell that begins at a node.
    pub(super) fn range(&self, [column, row]: [usize; 2]) -> Range {
        self.ranges[row * (self.columns - 1) + column]
    }

    /// Lowest and highest tip among the nodes whose contact is selected.
    #[must_use]
    pub fn selected_range(&self, surface: &Surface<'_>) -> Option<(f64, f64)> {
        let tips = self.contacts.iter().enumerate().filter_map(|(n, contact)| {
            let [x, y] = self.place([(n % self.columns) as f64, (n / self.columns) as f64]);
            contact.as_ref().map(|c| surface.path_point(x, y, c)).filter(|p| p.selected).map(|p| p.tip.z)
        });
        tips.fold(None, |range: Option<(f64, f64)>, z| {
            Some(range.map_or((z, z), |(low, high)| (low.min(z), high.max(z))))
        })
    }
}
