//! What a job states for an operation, as data: what its moves must do, and how its passes lie.

use std::sync::Arc;

use styluscam_geometry::{ChamferEdge, ChamferSize, NurbsCurve};
use styluscam_motion::SpindleDirection;

use crate::pitch::Pitch;
use crate::region::Region;
use crate::scalar::Scalar;

/// An operation as the job states it.
#[derive(Clone, Debug)]
pub struct ExpectedOperation {
    /// The operation's id, as the text's remarks name it.
    pub id: String,
    /// Index of its tool.
    pub tool: usize,
    /// Feed along the path, mm/min.
    pub cut: f64,
    /// Feed straight down, mm/min.
    pub plunge: f64,
    /// The highest of its feeds but straight down, mm/min, where they depend on what is cut.
    pub highest: Option<f64>,
    /// Feeds along leads into a pass and out of one, mm/min, where it has leads of its own.
    pub leads: Option<[f64; 2]>,
    /// Air that rapids below clearance keep above what stands, mm; none where all cross at clearance.
    pub low_links: Option<f64>,
    /// Whether it is slower at sharp turns and on small arcs, as far as the machine's acceleration asks for it.
    pub slows_at_corners: bool,
    /// Whether its feeds are instead those with which it keeps pace with another program: they are checked with that one.
    pub keeps_pace: bool,
    /// Speed and sense of the spindle; it stands when there are none.
    pub spindle: Option<(f64, SpindleDirection)>,
    /// The most by which its path is to turn at once, rad; none where that is not stated.
    pub max_corner: Option<f64>,
    /// Whether coolant flows.
    pub flood: bool,
    /// What its moves and passes must do.
    pub expectation: Expectation,
}

/// What is expected of an operation's moves and passes. Gouges, collisions and rapids are checked whatever is stated here.
#[derive(Clone, Debug)]
pub struct Expectation {
    /// Whether its lateral feeds must touch.
    pub contact: Contact,
    /// The triangles of the part that it is for, one entry a triangle.
    pub selected: Vec<bool>,
    /// Where its contacts lie beyond that.
    pub region: Region,
    /// Stock that is to stay between the tool and what it touches, across walls in plan and in height, mm.
    pub to_leave: [f64; 2],
    /// Lowest and highest tip that it is to reach, mm.
    pub heights: [f64; 2],
    /// How its passes lie.
    pub passes: Passes,
    /// Whether it forms a sheet, and deeper at once than a step is a punch.
    pub forms: bool,
    /// Layers in which it forms it; none where its passes are in none.
    pub layers: Option<Layers>,
    /// The tabs that its passes leave; none where they leave none.
    pub tabs: Option<TabShape>,
}

/// Tabs that passes leave on each wall that they go round, so that what they cut out is held; mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabShape {
    /// How many there are on each loop; instead of `spacing`.
    pub count: Option<usize>,
    /// How far apart they are at most along the loop; instead of `count`.
    pub spacing: Option<f64>,
    /// What stays of each at least, along the loop.
    pub width: f64,
    /// How high above the lowest loop of its wall.
    pub height: f64,
    /// Rise over run of the tool's path beside them.
    pub slope: f64,
}

/// What lateral feeds owe the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// They must touch it, within the operation's excess (`Limits::excess_of`).
    Touch,
    /// They must only stay clear of it: roughing.
    Clear,
}

/// How passes lie.
#[derive(Clone, Debug)]
pub enum Passes {
    /// In an order that is checked: none may be missing.
    Ordered(OrderedPasses),
    /// In two orders, one set across the other; each is checked by itself.
    Crossed([OrderedPasses; 2]),
    /// In no order that is checked: what they engage, and what they leave of the stock, is.
    Clearing(Clearing),
    /// Along ruled surfaces, touched with the side of a tool that leans: what the moving tool leaves of them is checked.
    Flank(FlankPasses),
    /// Straight down into holes: each is checked.
    Drilling(Drilling),
    /// Down into holes along helices about their axes: each is checked.
    Boring(Boring),
    /// Along edges with a cone: what it makes of each is checked.
    Chamfering(Chamfering),
    /// Along edges, beside them or on them: each is checked on every level.
    Contouring(Contouring),
    /// In no order that is known: what they leave of the faces where the tool can touch is checked.
    Covering {
        /// The most that may be left, mm.
        scallop: f64,
    },
    /// Nothing is known of their order; the report gives the reason.
    Unordered {
        /// Why they are not checked, as half a sentence.
        reason: &'static str,
    },
}

/// How passes clear stock: in layers between level passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearing {
    /// The largest engagement angle, but on entries, rad.
    pub angle: f64,
    /// The smallest radius of the path of the tool's centre, mm: corners and necks that need a smaller one stay.
    pub smoothing: f64,
    /// Height over length of the ways into the material, at most.
    pub entry_slope: f64,
    /// Their highest feed where one is stated, mm/min; else they are no faster than the faster of passes and plunges.
    pub entry_feed: Option<f64>,
    /// The highest feed of what cuts nothing, mm/min; 0 where it is that of what cuts.
    pub link_feed: f64,
    /// Height of the stock, mm.
    pub top: f64,
    /// The distance between levels.
    pub pitch: Pitch,
    /// What is to stay on walls, across them in plan, and on what lies under the tool, mm.
    pub left: [f64; 2],
    /// How far the path may be off the part, mm: levels lie so much higher at most, and walls are kept away from.
    pub tolerance: f64,
    /// A hole in which the tool goes down.
    pub hole: Option<ClearedHole>,
    /// Whether what the operations before it sweep is no stock any more.
    pub rest: bool,
    /// Whether all stock that the tool reaches is to be cleared, and not only that over the selected triangles.
    pub all: bool,
    /// The height to which it is to be cleared, where one is stated, mm.
    pub lowest: Option<f64>,
    /// The most that the last layer over a floor is to take, mm; infinite where it is a layer like the others.
    pub last_layer: f64,
}

/// How passes mill ruled surfaces.
#[derive(Clone, Debug)]
pub struct FlankPasses {
    /// The surfaces.
    pub faces: Vec<FlankFace>,
    /// Stock that is to stay on them, mm along their normals.
    pub left: f64,
    /// How high up from the first curve, mm along the straight lines, the tool is not to come.
    pub foot: f64,
    /// Most that may be entered, or left beyond that, mm.
    pub max_error: f64,
}

/// A ruled surface: straight lines between points of equal parameter of two curves, work coordinates, mm.
#[derive(Clone, Debug)]
pub struct FlankFace {
    /// As a person names it.
    pub name: String,
    /// The part's face that it is, if it is one.
    pub face: Option<u32>,
    /// The curves; the tool's tip is at the first.
    pub rails: [NurbsCurve; 2],
    /// Whether the outside is to the left, seen along the rails with the second above the first.
    pub is_left: bool,
}

/// A hole in which an operation begins that clears stock, work coordinates, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearedHole {
    /// Its axis in plan.
    pub at: [f64; 2],
    /// Its radius.
    pub radius: f64,
    /// Whether the stock comes with it: else what is cut before has to make it.
    pub is_in_stock: bool,
}

/// How holes are drilled.
#[derive(Clone, Debug, PartialEq)]
pub struct Drilling {
    /// The holes, in any order.
    pub holes: Vec<DrilledHole>,
    /// The deepest that the tool goes at once, mm; infinite where it goes down in one.
    pub peck: f64,
    /// Whether it comes out of the hole after each peck.
    pub clears: bool,
    /// Wait at the bottom, s.
    pub dwell: f64,
    /// Whether it comes up at a feed, as taps and boring tools do.
    pub rises_at_feed: bool,
    /// Whether the spindle turns back on the way up.
    pub is_tapping: bool,
}

/// How holes are bored by a tool narrower than they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Boring {
    /// The holes, in any order.
    pub holes: Vec<DrilledHole>,
    /// Fall of the tip in a turn at most, mm.
    pub pitch: f64,
    /// Stock that is to stay on their walls, mm.
    pub left: f64,
    /// Whether the tool meets the material from its uncut side: on the right of a tool that turns clockwise.
    pub is_climb: bool,
    /// Whether the operation's feed is that of the tool's rim on the wall, and not of its axis.
    pub feed_at_rim: bool,
}

/// How edges are chamfered.
#[derive(Clone, Debug, PartialEq)]
pub struct Chamfering {
    /// The edges, in straight pieces.
    pub edges: Vec<ChamferedEdge>,
    /// What is to be made of them.
    pub size: ChamferSize,
    /// How far the tool's tip is below an edge that it chamfers, mm.
    pub tip_below: f64,
    /// How far its axis is beside it, mm.
    pub beside: f64,
}

/// A straight piece of an edge that is chamfered.
#[derive(Clone, Debug, PartialEq)]
pub struct ChamferedEdge {
    /// As a person names it: what it lies between.
    pub name: String,
    /// Its place.
    pub edge: ChamferEdge,
}

/// How passes go along edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Contouring {
    /// The edges, joined end to end.
    pub lines: Vec<ContourLine>,
    /// On which side of them the tool is.
    pub side: ContourSide,
    /// Whether the tool meets the material from its uncut side (on the right of a tool that turns clockwise), or the other way round; none
    /// where either is good.
    pub is_climb: Option<bool>,
    /// Height over length of ramps into the material at most; none where it may go straight down.
    pub entry_slope: Option<f64>,
}

/// The side of edges on which a tool is, seen along them; those that close go counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContourSide {
    /// On their left.
    Left,
    /// On their right.
    Right,
    /// On them: the tip goes along them.
    On,
}

/// Edges that follow each other, work coordinates, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourLine {
    /// In straight pieces.
    pub pieces: Vec<ContourPiece>,
    /// The highest point of the upright plane through them that the tool touches.
    pub plane_top: f64,
    /// Height from which on there is material.
    pub begins: f64,
    /// The levels on which they are followed.
    pub levels: Vec<ContourLevel>,
}

/// A straight piece of an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourPiece {
    /// The edge as a person names it.
    pub name: String,
    /// Its ends in plan.
    pub ends: [[f64; 2]; 2],
}

/// A level on which an edge is followed, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourLevel {
    /// Height of the tip.
    pub tip: f64,
    /// Stock that stays on the wall.
    pub left: f64,
}

/// A hole that the tool goes down into, work coordinates, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct DrilledHole {
    /// As a person names it.
    pub name: String,
    /// Its axis in plan.
    pub at: [f64; 2],
    /// Its radius.
    pub radius: f64,
    /// How far its wall's triangles, which are chords, lie inside of the circle at most.
    pub chord: f64,
    /// Where its wall begins, or the stock over it.
    pub top: f64,
    /// The height that the tip reaches.
    pub bottom: f64,
}

/// Layers in which passes that are not themselves one below the other press a sheet down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Height of the tip on the sheet before the first one, mm.
    pub top: f64,
    /// From one plane to the next, mm, and the most that a pass may press the sheet below where it stands.
    pub increment: f64,
}

impl Layers {
    /// How far a tip is from the nearest plane, mm.
    pub(crate) fn off_plane(&self, height: f64) -> f64 {
        let number = ((self.top - height) / self.increment).round().max(1.0);
        (self.top - number * self.increment - height).abs()
    }
}

/// Passes that lie some distance apart.
#[derive(Clone, Debug)]
pub struct OrderedPasses {
    /// What is equal along a pass, and differs by a step from the next.
    pub scalar: Arc<dyn Scalar>,
    /// The distance between neighbouring passes, in the scalar.
    pub pitch: Pitch,
    /// Whether the scalar moves on by a step a turn (a spiral), instead of from pass to pass.
    pub continuous: bool,
    /// Passes may be missing where the tool can touch no farther than this along and across them, mm.
    pub smallest_feature: f64,
}

impl OrderedPasses {
    /// The largest distance in the scalar, mm, from a pass at a position of the tip to the next. A turn that moves on lies
    /// between two steps: its own and the one before.
    pub(crate) fn step_at(&self, tip: [f64; 3]) -> f64 {
        let value = self.scalar.value(tip.into());
        let step = self.pitch.at(value);
        if self.continuous {
            self.pitch.between(value, value + step)
        } else {
            step
        }
    }
}

impl Expectation {
    /// Its passes, where their order is known; of two sets the first.
    pub(crate) fn ordered(&self) -> Option<&OrderedPasses> {
        self.sets().first()
    }

    /// The sets of its passes whose order is known.
    pub(crate) fn sets(&self) -> &[OrderedPasses] {
        match &self.passes {
            Passes::Ordered(passes) => std::slice::from_ref(passes),
            Passes::Crossed(sets) => sets,
            Passes::Clearing(_)
            | Passes::Flank(_)
            | Passes::Drilling(_)
            | Passes::Boring(_)
            | Passes::Chamfering(_)
            | Passes::Contouring(_)
            | Passes::Covering { .. }
            | Passes::Unordered { .. } => &[],
        }
    }

    /// Its passes, where each lies below the one before it.
    pub(crate) fn descending(&self) -> Option<&OrderedPasses> {
        self.ordered().filter(|passes| passes.scalar.descends())
    }

    /// Whether it is for a triangle.
    pub(crate) fn selects(&self, triangle: usize) -> bool {
        self.selected.get(triangle) == Some(&true)
    }

    /// How it clears stock, where it does.
    pub(crate) fn clearing(&self) -> Option<&Clearing> {
        let Passes::Clearing(clearing) = &self.passes else { return None };
        Some(clearing)
    }

    /// The ruled surfaces that it mills, where it does.
    pub(crate) fn flank(&self) -> Option<&FlankPasses> {
        let Passes::Flank(passes) = &self.passes else { return None };
        Some(passes)
    }

    /// How it drills, where it does.
    pub(crate) fn drilling(&self) -> Option<&Drilling> {
        let Passes::Drilling(drilling) = &self.passes else { return None };
        Some(drilling)
    }

    /// How it bores, where it does.
    pub(crate) fn boring(&self) -> Option<&Boring> {
        let Passes::Boring(boring) = &self.passes else { return None };
        Some(boring)
    }

    /// How it chamfers edges, where it does.
    pub(crate) fn chamfering(&self) -> Option<&Chamfering> {
        let Passes::Chamfering(chamfering) = &self.passes else { return None };
        Some(chamfering)
    }

    /// How it goes along edges, where it does.
    pub(crate) fn contouring(&self) -> Option<&Contouring> {
        let Passes::Contouring(contouring) = &self.passes else { return None };
        Some(contouring)
    }

    /// The triangles that it is for.
    pub(crate) fn triangles(&self) -> Vec<usize> {
        (0..self.selected.len()).filter(|triangle| self.selected[*triangle]).collect()
    }

    /// Whether a tip at this height, mm, is to be reached.
    pub(crate) fn reaches(&self, height: f64) -> bool {
        let [lowest, highest] = self.heights;
        (lowest..=highest).contains(&height)
    }
}
