//! Roughing of a starter job: the flat tool that clears the stock over the part, and how deep it goes at a time.

use super::allowances::Allowances;
use super::cutter::{Cutter, Shape};
use super::drilling::Drilled;
use super::shop::{Shop, WIDEST_IN_ONE_PIECE};
use super::sizes::{self, round};
use super::stock_nodes::StockNodes;
use super::work::Work;
use crate::body::Body;
use crate::operations::{Serves, StarterPasses, ENGAGEMENT_DEG};

/// Nodes along the longer side of the stock in plan at which it is looked at how deep a tool gets.
const NODES: f64 = 48.0;
/// What stands thinner than this along walls does not count, in distances between nodes: how much of it a tool seems to leave depends on where
/// the nodes lie.
const SKIN: f64 = 1.0;
/// A tool that gets wherever a node is, mm.
const NEEDLE: f64 = 0.01;
/// The widest tool is taken that clears this share of what any of them clears.
const ENOUGH: f64 = 0.9;
/// Widest tool, as a share of the stock's smaller side.
pub const WIDEST: f64 = 0.35;
/// Narrowest tool, as a share of the stock's larger side, but for any with inserts: narrower ones take hours for its box.
const THINNEST: f64 = 0.04;
/// Narrower tools do not rough, mm: they finish what little there is, and moves of a few micrometres turn by degrees where they are rounded.
const STURDY: f64 = 2.0;
/// A way through the stock at full stepovers is no longer than this, mm, but with the widest tool: that is an hour or two, for in narrow spaces the
/// real way is some ten times as long.
const LONGEST: f64 = 6_000.0;
/// By how much it may be longer with a narrower tool where finishing would cut too deep through what the first leaves.
const LONGER: f64 = 4.0;
/// Depth of a level, as a share of the tool's diameter: at a bounded engagement angle it could be deeper, shanks of long tools bend.
const LEVEL: f64 = 0.5;
/// A level is no deeper than this, mm, as long as there are not more levels: cutting edges of inserts are not much longer.
const DEEPEST_LEVEL: f64 = 25.0;
const LEVELS: f64 = 20.0;
/// Stock that is left for finishing, as a share of the tool's diameter, and its limits, mm.
const LEFT: f64 = 0.03;
const LEAST_LEFT: f64 = 0.02;
const MOST_LEFT: f64 = 0.3;

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
        round((LEVEL * self.cutter.diameter).min(DEEPEST_LEVEL).min(self.depth).max(self.depth / LEVELS))
    }

    /// The operation; `width`: why the tool is as wide.
    fn work(&self, width: &str, faces: Option<&[u32]>) -> Work {
        let Self { cutter, leave, .. } = *self;
        let inserts = if cutter.diameter > WIDEST_IN_ONE_PIECE { ", one with inserts" } else { "" };
        let why = vec![
            format!(
                "the stock is cleared level by level first, with a flat tool of {} mm{inserts}: {width}",
                cutter.diameter
            ),
            format!("{leave} mm stay on walls and floors for finishing"),
        ];
        Work {
            id: "roughing".to_owned(),
            serves: Serves::Stock,
            tool: "rougher".to_owned(),
            cutter,
            faces: faces.map(<[u32]>::to_vec),
            passes: StarterPasses { pitch: self.pitch(), ..StarterPasses::default() },
            leave,
            why,
        }
    }

    /// Length of a way through all of it at full stepovers, mm.
    fn way(&self) -> f64 {
        let stepover = 0.5 * self.cutter.diameter * (1.0 - libm::cos(ENGAGEMENT_DEG.to_radians()));
        self.volume / (self.pitch() * stepover)
    }
}

/// The roughing of the stock, but for what is drilled, and after it the same with narrower tools, which get to more of it, or why there is
/// none; `faces` are those of the part that are cut so, where they are not all.
///
/// # Errors
/// No tool of a shop gets to any stock that is worth it.
pub fn roughing(
    (body, shop): (&Body<'_>, &Shop),
    allowances: Allowances,
    drilled: &[Drilled],
    faces: Option<&[u32]>,
) -> Result<Vec<Work>, String> {
    let nodes = StockNodes::new(body.mesh(), allowances, drilled, NODES);
    let [smaller, larger] = nodes.stock_sides();
    let narrowest = (THINNEST * larger).clamp(STURDY, WIDEST_IN_ONE_PIECE);
    let sizes: Vec<f64> = shop.between([narrowest, WIDEST * smaller], Shape::Flat).collect();
    let most_left = to_leave(sizes.iter().copied().fold(0.0, f64::max));
    let needle =
        Cutter { shape: Shape::Flat, diameter: NEEDLE }.made().ok_or("no roughing: its stock cannot be measured")?;
    let part = nodes.tips(&nodes.envelope(&needle, most_left), 0);
    let tried: Vec<Cleared> = sizes.iter().filter_map(|diameter| cleared((&nodes, &part), *diameter)).collect();
    let most = tried.iter().map(|cleared| cleared.volume).fold(0.0, f64::max);
    let enough = tried.iter().position(|cleared| cleared.volume > 0.0 && cleared.volume >= ENOUGH * most);
    let fitting = enough.and_then(|last| tried.get(..=last)).unwrap_or(&[]);
    let quick = fitting.iter().rposition(|cleared| cleared.volume > 0.0 && cleared.way() <= LONGEST);
    let number = quick.or_else(|| fitting.iter().position(|cleared| cleared.volume > 0.0));
    let Some((number, chosen)) = number.and_then(|number| Some((number, fitting.get(number)?))) else {
        return Err("no roughing: no tool that suits the part's size gets to stock over it".to_owned());
    };
    let passed_over = fitting.last().filter(|_| number + 1 < fitting.len());
    let width = if let Some(narrower) = passed_over {
        format!(
            "one of {} mm would get to {:.1} % more stock, along a path {:.1} times as long, more than {:.0} m at full stepovers: what this one leaves \
             is cut by what follows",
            narrower.cutter.diameter,
            100.0 * (narrower.volume / chosen.volume - 1.0),
            narrower.way() / chosen.way(),
            LONGEST / 1000.0
        )
    } else if number == 0 {
        "the widest that suits the part's size".to_owned()
    } else {
        format!("wider ones get to less than {} of the stock that narrower ones get to", sizes::percent(ENOUGH))
    };
    let narrower = tried.iter().skip(number + 1).filter(|cleared| cleared.way() <= LONGER * LONGEST.max(chosen.way()));
    let widest = chosen.cutter.diameter;
    let gap = format!("what one of {widest} mm leaves in narrow spaces is more than a finishing tool cuts at once");
    let first = std::iter::once(chosen.work(&width, faces));
    Ok(first.chain(narrower.map(|cleared| cleared.work(&gap, faces))).collect())
}

/// What a flat tool clears of the stock over `part`, the part's own height at each node with what any tool leaves there, mm; none for a tool
/// that cannot be made, or that gets to nothing.
fn cleared((nodes, part): (&StockNodes<'_>, &[f64]), diameter: f64) -> Option<Cleared> {
    let cutter = Cutter { shape: Shape::Flat, diameter };
    let leave = to_leave(diameter);
    let tool = cutter.made()?;
    let front = nodes.front(&tool, SKIN);
    let envelope = nodes.envelope(&tool, leave);
    let tips = nodes.tips(&envelope, front.reach());
    let depth = nodes.top - tips.iter().copied().fold(nodes.top, f64::min);
    let volume = nodes.volume(nodes.swept(&tips, &front).zip(part).map(|(swept, part)| swept.max(*part)));
    (depth > leave).then_some(Cleared { cutter, volume, leave, depth })
}

/// What a tool leaves for finishing, mm.
pub fn to_leave(diameter: f64) -> f64 {
    round((LEFT * diameter).clamp(LEAST_LEFT, MOST_LEFT))
}
