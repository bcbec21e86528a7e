//! Roughing of a starter job: the flat tool that clears the stock over the part, and how deep it goes at a time.

use styluscam_geometry::{Mesh, Tool};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::Surface;

use super::drilling::Drilled;
use super::sizes::{self, round, Cutter, Shape};
use super::work::Work;
use crate::body::Body;
use crate::operations::{Serves, StarterPasses};

/// By how much the stock is larger than the part's box, as a share of the part's largest size, and the limits of that, mm: what a saw
/// leaves, and half of it on top.
const ALLOWANCE: f64 = 0.02;
const ALLOWANCES: [f64; 2] = [0.2, 2.0];
const ON_TOP: f64 = 0.5;
/// Nodes along the longer side of the stock in plan at which it is looked at how deep a tool gets.
const NODES: f64 = 48.0;
/// The widest tool is taken that clears this share of what any of them clears.
const ENOUGH: f64 = 0.9;
/// Widest tool, as a share of the stock's smaller side.
const WIDEST: f64 = 0.35;
/// Narrowest tool, as a share of the stock's larger side: narrower ones take hours for its box.
const THINNEST: f64 = 0.04;
/// Narrower tools do not rough, mm: they finish what little there is, and moves of a few micrometres turn by degrees where they are rounded.
const STURDY: f64 = 2.0;
/// A way through the stock at full stepovers is no longer than this, mm, but with the widest tool: that is an hour or two, for in narrow spaces the
/// real way is some ten times as long.
const LONGEST: f64 = 6_000.0;
/// Largest engagement angle, deg.
const ENGAGEMENT_DEG: f64 = 60.0;
/// Depth of a level, as a share of the tool's diameter: at a bounded engagement angle it could be deeper, shanks of long tools bend.
const LEVEL: f64 = 0.5;
/// Levels at most.
const LEVELS: f64 = 20.0;
/// Stock that is left for finishing, as a share of the tool's diameter, and its limits, mm.
const LEFT: f64 = 0.03;
const LEAST_LEFT: f64 = 0.02;
const MOST_LEFT: f64 = 0.3;

/// By how much the stock is larger than the part's box.
#[derive(Clone, Copy, Debug)]
pub struct Allowances {
    /// On each of the four sides, mm.
    pub sides: f64,
    /// On top, mm.
    pub top: f64,
}

impl Allowances {
    /// What a sawn block has.
    pub fn of(mesh: &Mesh) -> Self {
        let (low, high) = mesh.bounds();
        let [least, most] = ALLOWANCES;
        let sides = round((ALLOWANCE * (high - low).max()).clamp(least, most));
        Self { sides, top: ON_TOP * sides }
    }
}

/// A tool's roughing.
struct Cleared {
    cutter: Cutter,
    /// mm^3.
    volume: f64,
    /// What it leaves for finishing, mm.
    leave: f64,
    /// How deep it goes at most, mm.
    depth: f64,
}

impl Cleared {
    /// Depth of a level, mm.
    fn pitch(&self) -> f64 {
        round((LEVEL * self.cutter.diameter).min(self.depth).max(self.depth / LEVELS))
    }

    /// Length of a way through all of it at full stepovers, mm.
    fn way(&self) -> f64 {
        let stepover = 0.5 * self.cutter.diameter * (1.0 - libm::cos(ENGAGEMENT_DEG.to_radians()));
        self.volume / (self.pitch() * stepover)
    }
}

/// The roughing of the stock, but for what is drilled, or why there is none; `faces` are those of the part that are cut so, where
/// they are not all.
///
/// # Errors
/// No tool of a shop gets to any stock that is worth it.
pub fn roughing(
    body: &Body<'_>,
    allowances: Allowances,
    drilled: &[Drilled],
    faces: Option<Vec<u32>>,
) -> Result<Work, String> {
    let mesh = body.mesh();
    let looked = Looked::at(mesh, allowances, drilled);
    let [smaller, larger] = [f64::min, f64::max].map(|of| of(looked.size[0], looked.size[1]));
    let sizes = sizes::between([STURDY.max(THINNEST * larger), WIDEST * smaller]);
    let tried: Vec<Cleared> = sizes.filter_map(|diameter| looked.cleared(mesh, diameter)).collect();
    let most = tried.iter().map(|cleared| cleared.volume).fold(0.0, f64::max);
    let enough = tried.iter().position(|cleared| cleared.volume > 0.0 && cleared.volume >= ENOUGH * most);
    let fitting = enough.and_then(|last| tried.get(..=last)).unwrap_or(&[]);
    let quick = fitting.iter().rposition(|cleared| cleared.volume > 0.0 && cleared.way() <= LONGEST);
    let number = quick.or_else(|| fitting.iter().position(|cleared| cleared.volume > 0.0));
    let Some((number, chosen)) = number.and_then(|number| Some((number, fitting.get(number)?))) else {
        return Err("no roughing: no tool that suits the part's size gets to stock over it".to_owned());
    };
    let Cleared { cutter, leave, .. } = chosen;
    let pitch = chosen.pitch();
    let width = if number + 1 < fitting.len() {
        "narrower ones get to more stock, and would take hours: what it leaves in narrow spaces is cut by finishing"
            .to_owned()
    } else if number == 0 {
        "the widest that suits the part's size".to_owned()
    } else {
        format!("wider ones get to less than {} of the stock that narrower ones get to", sizes::percent(ENOUGH))
    };
    let why = vec![
        format!("the stock is cleared level by level first, with a flat tool of {} mm: {width}", cutter.diameter),
        format!("{leave} mm stay on walls and floors for finishing"),
    ];
    Ok(Work {
        id: "roughing".to_owned(),
        serves: Serves::Stock,
        tool: "rougher".to_owned(),
        cutter: *cutter,
        faces,
        passes: StarterPasses { pitch, ..StarterPasses::default() },
        leave: *leave,
        why,
    })
}

/// The stock over a part, at nodes.
struct Looked<'a> {
    /// The part's triangles for tools from above.
    index: Index,
    /// Lower left corner of the stock, its top and the part's foot, mm.
    corner: [f64; 2],
    top: f64,
    foot: f64,
    /// Of the stock in plan, mm.
    size: [f64; 2],
    /// Between nodes, mm.
    apart: f64,
    counts: [usize; 2],
    /// What is drilled.
    holes: &'a [Drilled],
    /// Nodes in holes that are drilled.
    drilled: Vec<bool>,
}

impl<'a> Looked<'a> {
    fn at(mesh: &Mesh, allowances: Allowances, holes: &'a [Drilled]) -> Self {
        let (low, high) = mesh.bounds();
        let size = [high.x - low.x, high.y - low.y].map(|length| length + 2.0 * allowances.sides);
        let apart = size[0].max(size[1]) / NODES;
        let mut looked = Self {
            index: Index::new(mesh),
            corner: [low.x - allowances.sides, low.y - allowances.sides],
            top: high.z + allowances.top,
            foot: low.z,
            size,
            apart,
            counts: size.map(|length| (length / apart).ceil().max(1.0) as usize),
            holes,
            drilled: Vec::new(),
        };
        looked.drilled = looked.nodes(0).map(|at| holes.iter().any(|holes| holes.holds(at))).collect();
        looked
    }

    /// The sum of the depths down to some floors, one at each node, as a volume, mm^3; what is drilled does not count.
    fn volume(&self, floors: impl Iterator<Item = f64>) -> f64 {
        let counted = floors.zip(&self.drilled).filter(|(_, is_drilled)| !**is_drilled);
        let each = self.size[0] * self.size[1] / (self.counts[0] * self.counts[1]) as f64;
        each * counted.map(|(floor, _)| (self.top - floor).max(0.0)).sum::<f64>()
    }

    /// Positions by number, mm, and so many nodes beyond the stock's sides.
    fn nodes(&self, beyond: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let [columns, rows] = self.counts.map(|count| count + 2 * beyond);
        let at = move |i: usize, axis: usize| {
            let apart = self.size[axis] / self.counts[axis] as f64;
            self.corner[axis] + (i as f64 - beyond as f64 + 0.5) * apart
        };
        (0..rows).flat_map(move |row| (0..columns).map(move |column| [at(column, 0), at(row, 1)]))
    }

    /// What a flat tool clears; none for one that cannot be made, or that gets to nothing.
    fn cleared(&self, mesh: &Mesh, diameter: f64) -> Option<Cleared> {
        let cutter = Cutter { shape: Shape::Flat, diameter };
        let leave = round((LEFT * diameter).clamp(LEAST_LEFT, MOST_LEFT));
        let reach = (0.5 * diameter / self.apart) as usize;
        let tips = self.tips(mesh, &cutter.made()?, (leave, reach));
        let depth = self.top - tips.iter().copied().fold(self.top, f64::min);
        let volume = self.volume(self.swept(&tips, reach));
        (depth > leave).then_some(Cleared { cutter, volume, leave, depth })
    }

    /// How deep a tool's tip gets at each node and at some beyond the stock's sides, mm; in holes that are drilled it stays above.
    fn tips(&self, mesh: &Mesh, tool: &Tool, (leave, beyond): (f64, usize)) -> Vec<f64> {
        let envelope = Envelope::new(mesh, &self.index, tool, None, leave);
        let surface = Surface::whole(&envelope);
        let mut hint = None;
        let mut tip = |[x, y]: [f64; 2]| surface.at(x, y, &mut hint).map_or(self.foot, |at| at.tip.z.max(self.foot));
        let is_drilled = |at: [f64; 2]| self.holes.iter().any(|holes| holes.holds(at));
        self.nodes(beyond).map(|at| if is_drilled(at) { self.top } else { tip(at) }).collect()
    }

    /// The floor that a flat tool leaves at each node: the lowest tip within its radius, mm.
    fn swept<'f>(&'f self, tips: &'f [f64], reach: usize) -> impl Iterator<Item = f64> + 'f {
        let [columns, rows] = self.counts;
        let across = columns + 2 * reach;
        let lowest = move |(row, column): (usize, usize)| {
            let within = |(r, c): &(usize, usize)| r.abs_diff(reach).pow(2) + c.abs_diff(reach).pow(2) <= reach * reach;
            let around = (0..=2 * reach).flat_map(|r| (0..=2 * reach).map(move |c| (r, c))).filter(within);
            let tips = around.filter_map(|(r, c)| tips.get((row + r) * across + column + c));
            tips.copied().fold(f64::INFINITY, f64::min)
        };
        (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column))).map(lowest)
    }
}
