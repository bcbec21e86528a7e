//! The envelope sampled on a square grid: from it loops are found, not measured.

use styluscam_motion::{Cancelled, Watch};

use crate::{lattice::Node, offset::Contact, Lattice, Surface};

/// How far outside the domain the grid begins, as a share of a cell: no part is drawn so that its walls' offsets run along
/// the grid's lines by that.
const ASIDE: f64 = 0.618;
/// Nodes at most: beyond it the cell grows.
const NODES: f64 = 4e6;

/// Contacts of the envelope at the nodes of a lattice.
pub struct Grid {
    lattice: Lattice,
    contacts: Vec<Option<Contact>>,
}

impl Grid {
    /// Samples the envelope over the surface's domain, `cell` mm apart or a little less.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn sample(surface: &Surface<'_>, cell: f64, watch: &Watch) -> Result<Option<Self>, Cancelled> {
        let Some((low, high)) = surface.domain() else { return Ok(None) };
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let cell = cell.max((width * height / NODES).sqrt());
        // one ring of nodes outside: there the tool touches nothing that was asked for
        let (columns, rows) = ((width / cell).ceil() as usize + 2, (height / cell).ceil() as usize + 2);
        let lattice = Lattice { origin: low.map(|low| low - ASIDE * cell), cell, columns, rows };
        let positions: Vec<[f64; 2]> = lattice.nodes().map(|node| lattice.point(node.map(|i| i as f64))).collect();
        watch.begin("sampling", positions.len());
        let contacts = surface.envelope().contacts(&positions, watch)?;
        Ok(Some(Self { lattice, contacts }))
    }

    /// Diameter of the largest disc that may hide between nodes, mm.
    #[must_use]
    pub fn smallest_feature(&self) -> f64 {
        self.lattice.cell * std::f64::consts::SQRT_2
    }

    /// Distance between nodes, mm.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.lattice.cell
    }

    pub(super) fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The contacts over all nodes, row by row; none where nothing is touched.
    pub(super) fn contacts(&self) -> &[Option<Contact>] {
        &self.contacts
    }

    /// The tip over a node; none where nothing is touched.
    pub(super) fn tip(&self, node: Node) -> Option<f64> {
        self.contacts[self.lattice.node_number(node)].map(|contact| contact.tip)
    }

    /// The contacts over the corners of a cell.
    pub(super) fn corner_contacts(&self, cell: Node) -> [Option<&Contact>; 4] {
        self.lattice.corner_numbers(cell).map(|number| self.contacts[number].as_ref())
    }

    /// The tips over all nodes, row by row.
    pub(super) fn tips(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        self.contacts.iter().map(|contact| contact.map(|contact| contact.tip))
    }

    /// Lowest and highest tip among the nodes whose contact is selected.
    pub(super) fn selected_range(&self, surface: &Surface<'_>) -> Option<(f64, f64)> {
        let tips = self.lattice.nodes().zip(&self.contacts).filter_map(|(node, contact)| {
            let [x, y] = self.lattice.point(node.map(|i| i as f64));
            contact.as_ref().map(|c| surface.path_point(x, y, c)).filter(|p| p.selected).map(|p| p.tip.z)
        });
        tips.fold(None, |range: Option<(f64, f64)>, z| {
            Some(range.map_or((z, z), |(low, high)| (low.min(z), high.max(z))))
        })
    }
}
