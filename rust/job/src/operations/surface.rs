//! What all operations share whose tool follows the selected faces: the envelope is prepared, the kind traces its passes on it,
//! and they are linked; what becomes of the faces is measured beside.

use styluscam_geometry::{Tool, ToolBody};
use styluscam_motion::{EventKind, Move, SpindleDirection};
use styluscam_post::machine::CommentForm;
use styluscam_toolpath::{
    budget::Budget,
    forming::{ramped, turned, Layer, Ramp, Turn, Turned, Turns},
    offset::{Envelope, Rolling},
    shortly_ordered, Air, AlongSurface, Entered, Freedom, Heights, Links, Ordered, Pass, PlanError, Planes, Rates,
    Seam, Sense, Surface,
};

use super::{budget, corners, facts::counted, fit, links};
use super::{reached, Context, Direction, Edges, End, Fact, OperationKeys, OperationKind, Planned, SurfaceFacts};
use crate::{JobError, Scene};

/// What links along the surface and rows look for, as a share of the distance between the grid's nodes: the tool's rim and its
/// tip meet ridges that are narrower than any feature.
const NARROW: f64 = 0.2;
/// Passes are linked along the surface up to so many steps or stepovers.
const LINKED_ALONG: f64 = 4.0;
/// Area of a face that is worth a word, mm^2: it is shown with one decimal.
const LEAST_AREA: f64 = 0.05;

/// A kind whose tool follows the selected faces.
pub trait FollowsSurface: OperationKind + Sync {
    /// Heights between which the tip stays on the surface, mm: those of the job.
    fn tip_range(&self, task: &Task<'_>) -> [f64; 2] {
        let tolerance = task.context.common.tolerance;
        [task.context.heights.bottom, task.context.heights.top.map_or(f64::INFINITY, |z| z + tolerance)]
    }

    /// How far the part may differ from what its passes are traced on, mm.
    ///
    /// # Errors
    /// It differs by more than the tolerance allows, `Cancelled`.
    fn allowance(&self, _context: &Context<'_>) -> Result<f64, JobError> {
        Ok(0.0)
    }

    /// Distance between neighbouring passes of a tool with its sheet, mm; one that stands for all.
    fn pitch(&self, body: &ToolBody) -> f64;

    /// How far above the lowest allowed height the last pass may lie by the kind's own rule, mm.
    fn lowest_rest(&self, _body: &ToolBody) -> f64 {
        0.0
    }

    /// Whether the material that still stands lies on the right of its passes as they are traced, else on the left.
    fn has_material_on_right(&self) -> bool;

    /// In which direction its passes are followed.
    fn sense(&self, common: &OperationKeys) -> Sense {
        sense(common, self.has_material_on_right())
    }

    /// What of the order of its passes is free.
    fn freedom<'a>(&self, _task: &Task<'_>, _traced: &'a Traced) -> Freedom<'a> {
        Freedom::WithinGroups
    }

    /// Where its loops begin.
    fn seam(&self) -> Seam {
        Seam::Nearest
    }

    /// Height over length of the ramps from level to level; none where the tool goes straight down the wall.
    fn ramp_slope(&self) -> Option<f64> {
        None
    }

    /// Planes on which the sheet stands from layer to layer; none where it is not formed in layers.
    fn planes(&self, _context: &Context<'_>) -> Option<Planes> {
        None
    }

    /// How the tool turns between neighbouring rows; none where it goes straight.
    fn turn(&self) -> Option<Turn> {
        None
    }

    /// Whether short links may go straight over what its passes leave out: its neighbours have cleared what they meet.
    fn links_across(&self) -> bool {
        false
    }

    /// Its passes.
    ///
    /// # Errors
    /// Nothing is reached, `Cancelled`.
    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError>;

    /// Where the tool waits along the moves: behind which, and for how long, s.
    fn waits(&self, _moves: &[Move], _common: &OperationKeys) -> Vec<(usize, f64)> {
        Vec::new()
    }

    /// Its extent for the summary.
    fn words(&self, groups: usize, passes: usize) -> String;

    /// Its figures.
    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact>;

    /// Further figures, of what its passes were planned with.
    fn task_facts(&self, _task: &Task<'_>) -> Vec<Fact> {
        Vec::new()
    }

    /// Its extent for the program's header.
    fn note(&self, groups: usize, passes: usize) -> String;
}

/// In which direction passes are followed that have the standing material on their right, or on their left, as they are traced.
pub fn sense(common: &OperationKeys, material_on_right: bool) -> Sense {
    let is_climb = match common.direction {
        Direction::Alternate => return Sense::Alternate,
        Direction::Same => return Sense::Forward,
        Direction::Climb => true,
        Direction::Conventional => false,
    };
    // climb milling: the edges of a tool that turns clockwise, seen from above, move forwards on its left, so the material
    // stands on its right
    let is_clockwise = common.spindle.direction() != Some(SpindleDirection::Counterclockwise);
    if (is_climb == is_clockwise) == material_on_right {
        Sense::Forward
    } else {
        Sense::Reversed
    }
}

/// Traced passes.
#[derive(Clone, Debug)]
pub struct Traced {
    /// In the order in which they were found.
    pub passes: Vec<Pass>,
    /// Smallest disc that a loop must hold to be sure of being found, mm.
    pub smallest_feature: f64,
    /// Of rows: the numbers of the first groups of all sets, each of which covers the faces.
    pub sets: Vec<usize>,
    /// Layers of them, in their order: of each the height of its plane, mm, and how many of the passes are its own. The passes
    /// after these are in none.
    pub layers: Vec<(f64, usize)>,
}

impl Traced {
    /// Passes that are in no layers.
    pub fn new(passes: Vec<Pass>, smallest_feature: f64) -> Self {
        Self { passes, smallest_feature, layers: Vec::new(), sets: Vec::new() }
    }

    /// Passes in layers, and others after them.
    pub fn in_layers(layers: Vec<Layer>, after: Vec<Pass>, smallest_feature: f64) -> Self {
        let counts = layers.iter().map(|layer| (layer.floor, layer.passes.len())).collect();
        let passes = layers.into_iter().flat_map(|layer| layer.passes).chain(after).collect();
        Self { passes, smallest_feature, layers: counts, sets: Vec::new() }
    }

    /// Takes the passes layer by layer, each with the height of its plane; those after them with none, which is minus infinity.
    fn take_by_layer(&mut self) -> Vec<(f64, Vec<Pass>)> {
        let mut rest = std::mem::take(&mut self.passes).into_iter();
        let mut layers: Vec<(f64, Vec<Pass>)> =
            self.layers.iter().map(|(floor, count)| (*floor, rest.by_ref().take(*count).collect())).collect();
        layers.push((f64::NEG_INFINITY, rest.collect()));
        layers.retain(|(_, passes)| !passes.is_empty());
        layers
    }
}

/// What passes are traced with.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The operation.
    pub context: &'a Context<'a>,
    /// What is left of the tolerance.
    pub budget: Budget,
    /// The tool, with the sheet that it touches.
    pub body: &'a ToolBody,
    /// How far the part may differ from what the passes are traced on, mm.
    pub allowance: f64,
    /// Feed along the passes, mm/min.
    pub cut: f64,
}

impl Task<'_> {
    /// What is narrower may be passed over, mm.
    pub fn narrow(&self) -> f64 {
        NARROW * self.context.node_spacing()
    }

    /// A hint for a plan that reaches nothing.
    pub fn why_nothing(&self) -> String {
        let (low, high) = self.context.scene.mesh.bounds();
        let size = high - low;
        format!(
            " (part {:.3} x {:.3} x {:.3} mm): check its units, the tool's size and the selection{}",
            size.x,
            size.y,
            size.z,
            self.context.region.hint()
        )
    }

    /// Neighbouring passes are linked along the surface.
    fn along<'s>(&self, surface: &'s Surface<'s>, planes: Option<Planes>, pitch: f64) -> AlongSurface<'s> {
        AlongSurface {
            surface,
            planes,
            longest: LINKED_ALONG * pitch,
            deviation: self.budget.deviation,
            narrow: self.narrow(),
            corner: self.context.common.corner(),
            feed: self.cut,
        }
    }

    fn links(&self) -> Links {
        let (scene, common) = (self.context.scene, self.context.common);
        Links {
            heights: Heights { clearance: scene.clearance, retract: scene.retract },
            rates: Rates { cut: self.cut, plunge: common.feeds.plunge },
            operation: self.context.operation,
        }
    }
}

/// What there is to say of passes, which linking gives up.
struct Found {
    groups: usize,
    passes: usize,
    /// The lowest tip, mm.
    lowest: f64,
    facts: Vec<Fact>,
}

/// Plans an operation whose tool follows the selected faces.
///
/// # Errors
/// The tolerance is used up, nothing is reached, `Cancelled`.
pub fn plan(kind: &impl FollowsSurface, context: &Context<'_>) -> Result<Planned, JobError> {
    let (scene, tool, watch) = (context.scene, context.tool, context.watch);
    let tolerance = context.common.tolerance;
    let selected = scene.facing_up(&context.faces);
    let allowance = kind.allowance(context)?;
    // it takes from both sides
    let left = budget::of(tolerance - 2.0 * allowance, scene, context.machine);
    let budget = left.map_err(|error| context.error(error))?;
    let budget = Budget { margin: budget.margin + allowance, ..budget };
    watch.begin("preparing", 1);
    let envelope = Envelope::new(&scene.mesh, &scene.index, tool, scene.sheet.as_ref(), budget.margin);
    let body = tool.body(scene.sheet.as_ref());
    let task = Task { context, budget, body: &body, allowance, cut: kind.cut_feed(context.common) };
    let surface = Surface::new(&envelope, &selected).between_heights(kind.tip_range(&task));
    let surface = surface.rolling(rolling(context));
    let region =
        context.region.planned((tool, scene.sheet.as_ref()), scene.inward, &budget, budget::rounding(context.machine));
    let region = region.ready();
    let surface = surface.within(&region);
    let surface = fit::witnessed(surface, context);
    let path = || {
        let traced = kind.trace(&task, &surface).map_err(|error| context.error(error))?;
        let groups = count_groups(&traced.passes);
        let facts = kind.facts(groups, &traced);
        let lowest = traced.passes.iter().flat_map(|pass| &pass.points).map(|point| point.tip.z);
        let found = Found { groups, passes: traced.passes.len(), lowest: lowest.fold(f64::INFINITY, f64::min), facts };
        let (moves, fitted) = linked(kind, &task, &surface, traced)?;
        Ok::<_, JobError>((found, moves, fitted))
    };
    let beside = watch.beside();
    let reach = || {
        let offset = reached::offset_of(scene, tool, &envelope, &context.faces, tolerance, &beside)?;
        let bridges = reached::bridges_of(scene, tool, &envelope, &offset, tolerance, &beside)?;
        Ok::<_, JobError>((offset, bridges))
    };
    // each has stretches in which one thread works alone
    let (path, reach) = rayon::join(path, reach);
    let ((found, moves, fitted), (offset, bridges)) = (path?, reach?);
    let Found { groups, passes, lowest, facts: of_passes } = found;
    let facts = SurfaceFacts {
        wall_angle_max_deg: scene.steepest(&selected).to_degrees(),
        ends: ends(&task, kind.lowest_rest(&body), tool, lowest, &selected),
        reached: reached::reached(scene, &offset, &bridges),
        reached_coarsely: offset.is_coarse.then_some(offset.fine),
        bridged: reached::bridged(&bridges),
        undercut: undercut(scene, &context.faces),
        faces: context.faces.clone(),
    };
    let wait = |(behind, seconds)| (behind, EventKind::Dwell { seconds });
    Ok(Planned {
        events: kind.waits(&moves, context.common).into_iter().map(wait).collect(),
        cycles: Vec::new(),
        words: kind.words(groups, passes),
        note: kind.note(groups, passes),
        facts: of_passes.into_iter().chain(kind.task_facts(&task)).chain(fitted).collect(),
        surface: Some(facts),
        moves,
    })
}

/// How far over the edges of its faces an operation's passes go.
fn rolling(context: &Context<'_>) -> Rolling {
    match (context.common.edges, context.scene.sheet) {
        (Some(Edges::Roll), _) => Rolling::Over,
        (Some(Edges::Stop), _) | (None, None) => Rolling::Stop,
        (None, Some(_)) => Rolling::FromAbove,
    }
}

/// The moves along the passes, in their order, and what there is to say of their fit.
fn linked(
    kind: &impl FollowsSurface,
    task: &Task<'_>,
    surface: &Surface<'_>,
    mut traced: Traced,
) -> Result<(Vec<Move>, Vec<Fact>), JobError> {
    let context = task.context;
    let deviation = task.budget.deviation;
    let along = task.along(surface, kind.planes(context), kind.pitch(task.body));
    let tabs = kind.tabs().map(|tabs| tabs.planned(context, &traced.passes)).transpose()?;
    let (mut entered, mut turns, mut between) = (Vec::with_capacity(traced.passes.len()), None, [0.0; 2]);
    for (number, (floor, passes)) in traced.take_by_layer().into_iter().enumerate() {
        let layer = (number, passes);
        let followed = entered_at(kind, (task, &traced), &surface.above(floor), &along, layer)?;
        entered.extend(followed.entered);
        turns = Turned::sum(turns, followed.turns);
        between = [0, 1].map(|i| between[i] + followed.between[i]);
    }
    let mut facts = turns.map_or_else(Vec::new, turn_facts);
    let (moves, linked) =
        links::linked(context, (entered, kind.seam(), deviation), (along, kind.links_across()), &task.links())?;
    facts.extend(order_fact(between).into_iter().chain(linked));
    facts.extend(tabs.as_ref().map(|tabs| tabs.fact()));
    let moves = match &tabs {
        Some(tabs) => tabs.lifted(context, &moves),
        None => moves,
    };
    if !context.common.slow_corners {
        return Ok((moves, facts));
    }
    let (moves, slow) = corners::slowed_down(context, &moves)?;
    facts.push(slow);
    Ok((moves, facts))
}

/// Passes in their order.
struct Followed {
    /// With what leads to each.
    entered: Vec<Entered>,
    /// How many turns there are, if any are asked for.
    turns: Option<Turned>,
    /// What the tool travels between them, mm: with the nearest next, and so.
    between: [f64; 2],
}

/// The passes of a layer, by its number, in their order.
fn entered_at(
    kind: &impl FollowsSurface,
    (task, traced): (&Task<'_>, &Traced),
    surface: &Surface<'_>,
    along: &AlongSurface<'_>,
    (number, mut passes): (usize, Vec<Pass>),
) -> Result<Followed, JobError> {
    let (context, watch) = (task.context, task.context.watch);
    let sense = kind.sense(context.common);
    let deviation = task.budget.deviation;
    if number % 2 == 1 && sense == Sense::Alternate {
        // every other layer begins where the layer before ends
        backwards(&mut passes);
    }
    let freedom = kind.freedom(task, traced);
    let air = Air { height: links::crossing_height(context), along: along.longest };
    let Ordered { passes, between } = shortly_ordered(passes, (sense, kind.seam()), freedom, &air, watch)?;
    let (entered, turns) = match (kind.ramp_slope(), kind.turn()) {
        (Some(slope), _) => {
            let ramp = Ramp { slope, sense, deviation, longest: context.node_spacing() };
            (ramped(surface, passes, &ramp, watch)?, None)
        }
        (None, Some(turn)) => {
            let may_leave = context.machine.comment.form != CommentForm::None; // a remark states that they are links
            let rule = Turns { turn, longest: along.longest, deviation, narrow: along.narrow, may_leave };
            let (entered, counts) = turned(surface, passes, &rule, watch)?;
            (entered, Some(counts))
        }
        (None, None) => (passes.into_iter().map(Entered::from).collect(), None),
    };
    Ok(Followed { entered, turns, between })
}

/// Puts rows from the last to the first.
fn backwards(passes: &mut [Pass]) {
    passes.reverse();
    passes.chunk_by_mut(|a, b| a.group == b.group).for_each(<[Pass]>::reverse);
}

/// By how much another order than the nearest pass next shortens what the tool travels between passes, if it does.
fn order_fact([nearest, between]: [f64; 2]) -> Option<Fact> {
    let words = format!("{between:.1} mm between passes, in this order; {nearest:.1} mm with the nearest pass next");
    (between < nearest).then_some(Fact { fact: "between_passes", value: between, unit: "mm", words })
}

/// How many turns are as asked for, and between how many rows there is none.
fn turn_facts(counts: Turned) -> Vec<Fact> {
    let Turned { turns, free, straight, apart } = counts;
    let off = if free > 0 { format!(", {free} of them off the faces") } else { String::new() };
    let pairs = |count| counted(count, "pair of rows", "pairs of rows");
    let fact = |fact, count: usize, words| Fact { fact, value: count as f64, unit: "", words };
    vec![
        fact("turns", turns, counted(turns, "turn", "turns") + &off),
        fact("straight_turns", straight, format!("{} linked straight, where no turn fits", pairs(straight))),
        fact("ends_apart", apart, format!("{} with ends too far apart for a turn", pairs(apart))),
    ]
}

/// The end that the heights are to an operation whose tool is at `lowest` mm at least, if it would go on below.
fn ends(task: &Task<'_>, lowest_rest: f64, tool: &Tool, lowest: f64, selected: &[bool]) -> Option<End> {
    let (scene, common) = (task.context.scene, task.context.common);
    let stopped = lowest - task.context.heights.bottom <= lowest_rest;
    let untouched = task.context.heights.untouched(scene, tool, selected, common.tolerance).filter(|_| stopped)?;
    Some(End { z: lowest, at_foot: common.z_bottom.is_none(), untouched })
}

/// Faces of which a part faces down, with its area.
fn undercut(scene: &Scene, faces: &[u32]) -> Vec<(u32, f64)> {
    let area = |face: &u32| scene.views.get(face).map(|view| view.down).filter(|area| *area >= LEAST_AREA);
    faces.iter().filter_map(|face| Some((*face, area(face)?))).collect()
}

/// Levels or rows: those of layers are the same in each.
fn count_groups(passes: &[Pass]) -> usize {
    let mut groups: Vec<usize> = passes.iter().map(|p| p.group).collect();
    groups.sort_unstable();
    groups.dedup();
    groups.len()
}
