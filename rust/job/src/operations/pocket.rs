//! Pocket: clears stock level by level, with an engagement angle that stays below a bound.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{rectangle_outline, Stock};
use styluscam_motion::{Arc, Move, MoveKind, Role};
use styluscam_toolpath::forming::{levels, selected_range, with_levels_at, z_levels, Floors, Grid, LevelRange};
use styluscam_toolpath::offset::Envelope;
use styluscam_toolpath::pocket::{
    pocket_path, segments, CentreArea, EntryRule, FeedLaw, Layer, Pocket as Asked, PocketError, PocketPath,
    PocketRunKind, Shape,
};
use styluscam_toolpath::{Heights, Pass, PlanError, Segment, Sense, Surface};
use styluscam_verify::{Clearing, Contact, Passes};

use super::budget;
use super::clears::{Clears, ENGAGEMENT_DEG};
use super::corners;
use super::entry::{Entry, EntryHole};
use super::facts::counted;
use super::keys;
use super::levels::{self, LevelKeys};
use super::repeated::{Repeated, Situation};
use super::step::{Step, StepLimits};
use super::surface::sense;
use super::{
    About, Areas, Context, Effort, Fact, Fit, LeadForm, LinkHeight, Machining, OperationKind, PassContext, PassSpacing,
    Planned, Serves,
};
use crate::cutting::{CuttingWork, Engagement};
use crate::numbers::shown;
use crate::{JobError, OperationKeys};

/// The smallest radius of the centre's path where none is stated, in tool radii.
const MSR: f64 = 0.05;
/// How far the tool's centre may go beyond the stock, in tool diameters: so far that it is free of it there.
const BEYOND: f64 = 2.5;
/// So far within a corner of that lies a position of the area around the stock, mm.
const CORNER: f64 = 1e-3;
/// Positions across an area of which some must touch the selected faces, at least.
const LOOKED: f64 = 24.0;
/// Chords are off the arcs that a machine does not take by no more than this, mm: thinner than the chips that count.
const CHORDS: f64 = 5e-4;

/// Layers thinner than this are none, mm.
const THINNEST: f64 = 1e-3;

/// By how much lower the bound is planned where arcs become chords, rad (2.5 degrees): at their corners the heading is off by half a
/// chord's turn, and rounding to a micrometre turns the chords of small arcs by as much.
const CORNERS: f64 = 2.5 * std::f64::consts::PI / 180.0;
/// The least bound that is planned, rad (10 degrees).
const LEAST: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// Clears the stock over the selected faces, or all of it, level by level, with an engagement angle that stays below a bound all along the path.
/// Stock is that of the set-up, the part's box where it states none, or what the operations before leave of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pocket {
    /// Distance between levels.
    #[schemars(extend("x-example" = "{ height = 2.0 }"))]
    pub step: Step,
    /// Which stock is cleared on each level: that over the selected faces, or all that the tool reaches, around the part too (roughing). Levels
    /// go down to the lowest selected face that the tool reaches; of all stock to z_bottom, where that is stated.
    #[serde(default)]
    pub clears: Clears,
    /// The engagement angle that the path keeps to, degrees: of the arc along which the tool's rim is in the material.
    #[serde(default = "engagement")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 10.0, "maximum" = 90.0))]
    pub engagement_deg: f64,
    /// By how much the angle may become larger, degrees; with the engagement angle 90 at most.
    #[serde(default)]
    #[schemars(extend("x-unit" = "deg", "minimum" = 0.0, "maximum" = 80.0))]
    pub growth_deg: f64,
    /// Smallest radius of the path of the tool's centre, mm: corners stay rounded by it and the tool's radius; a twentieth of the
    /// tool's radius when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub smoothing_radius: Option<f64>,
    /// Whether the stock to leave is taken as well, after the rest of its level: by a pass along the walls and a layer over each level floor,
    /// with the same bound of the engagement angle.
    #[serde(default)]
    pub finish: bool,
    /// How the tool goes down into stock, where it cannot come from an open side.
    #[serde(default)]
    pub entry: Entry,
    /// A hole that is made before, or comes with the stock (`in_stock = true`), at least as deep as the pocket: the tool goes down in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ x = 10.0, y = 8.0, diameter = 6.0 }"))]
    pub entry_hole: Option<EntryHole>,
    /// Whether only what the operations before leave is cleared, such as the corners that a larger tool does not reach; else all of
    /// the stock.
    #[serde(default)]
    pub rest_machining: bool,
    /// Angle of helices and ramps down into the material, degrees.
    #[serde(default = "entry_angle")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 0.1, "maximum" = 30.0))]
    pub entry_angle_deg: f64,
    /// Diameter of helices and length of ramps, of the path of the tool's centre, mm at most; 0.7 tool diameters and 1 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub entry_size: Option<f64>,
    /// Feed along helices and ramps, mm/min; that of plunges when left out. It is lower where they would take more stock in a minute than the
    /// passes do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub entry_feed: Option<f64>,
    /// Feed of links at depth, through what is cleared, mm/min, within the machine's highest; max_feed when left out, or without it the feed of
    /// the passes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub link_feed: Option<f64>,
    /// How far the tool is lifted off the floor on links at depth, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 10.0))]
    pub link_lift: f64,
    /// Highest feed, mm/min: where less than a full stepover is cut, the feed rises up to it, so that as much stock is taken in a
    /// minute. The feed of the passes everywhere when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub max_feed: Option<f64>,
    /// Whether feeds rise no higher than the thickest chip allows: it is nowhere thicker than at a full stepover.
    #[serde(default)]
    pub chip_thinning: bool,
}

impl Pocket {
    pub(super) const ABOUT: About = About {
        purpose: "for clearing stock with a bounded engagement angle",
        serves: Serves::Stock,
        starter: |passes| {
            format!(
                "clears = \"stock\"           # all that the tool reaches, or \"faces\": what is over these alone\n\
                 step = {{ height = {:?} }}    # distance between levels\nengagement_deg = {:?}      # largest engagement \
                 angle\n",
                passes.pitch, ENGAGEMENT_DEG
            )
        },
    };

    /// The largest angle, rad.
    fn angle(&self) -> f64 {
        (self.engagement_deg + self.growth_deg).to_radians()
    }

    /// What stays on walls and under the tool, and what the last pass along walls and the last layer over floors take, mm, of the stock to leave.
    fn left_and_finished(&self, to_leave: [f64; 2]) -> [[f64; 2]; 2] {
        if self.finish {
            [[0.0; 2], to_leave]
        } else {
            [to_leave, [0.0; 2]]
        }
    }

    fn smoothing(&self, radius: f64) -> f64 {
        self.smoothing_radius.unwrap_or(MSR * radius)
    }

    /// Feeds that contradict each other.
    fn check_feeds(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let conflict = |key: &str, message: String, hint: &str| {
            Err(JobError::document("conflict", format!("{path}.{key}"), message, hint))
        };
        match self.max_feed {
            Some(highest) if highest < common.feeds.cut => {
                let message = format!("max_feed is {highest} mm/min, and feeds.cut is {} mm/min", common.feeds.cut);
                conflict("max_feed", message, "raise max_feed, or lower feeds.cut")
            }
            None if self.chip_thinning => {
                let message = "chip_thinning limits by how much feeds rise, and without max_feed none does".to_owned();
                conflict("chip_thinning", message, "set max_feed, mm/min, or remove chip_thinning")
            }
            _ => Ok(()),
        }
    }

    /// How feeds follow what a tool of a radius (mm) cuts.
    fn feed_law(&self, context: &Context<'_>, radius: f64) -> FeedLaw {
        let limits = &context.machine.limits;
        let cut = context.common.feeds.cut;
        FeedLaw {
            cut,
            highest: self.max_feed.map_or(cut, |highest| highest.min(limits.max_feed.unwrap_or(highest)).max(cut)),
            angle: self.angle(),
            radius,
            spare: 0.0,
            chip_thinning: self.chip_thinning,
            acceleration: limits.acceleration,
        }
    }

    /// The feed of links, mm/min.
    fn feed_of_links(&self, context: &Context<'_>) -> f64 {
        let (common, limits) = (context.common, &context.machine.limits);
        let most = limits.max_feed.unwrap_or(f64::INFINITY);
        self.link_feed.or(self.max_feed).unwrap_or(common.feeds.cut).min(most)
    }

    fn entry_slope(&self) -> f64 {
        libm::tan(self.entry_angle_deg.to_radians())
    }
}

impl OperationKind for Pocket {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        StepLimits::default().check(&self.step, path)?;
        if matches!(self.step, Step::Scallop(_)) {
            let message = "levels of a pocket are no scallops: other operations finish its walls".to_owned();
            let hint = "set step = { height = 2.0 }, mm";
            return Err(JobError::document("conflict", format!("{path}.step.scallop"), message, hint));
        }
        let sum = self.engagement_deg + self.growth_deg;
        if sum > 90.0 {
            let message = format!("engagement_deg and growth_deg come to {sum} degrees, and at most 90 are held");
            return Err(JobError::document("conflict", format!("{path}.growth_deg"), message, "lower either"));
        }
        if self.finish && !common.leaves_stock() {
            let message = "finish takes the stock to leave, and there is none";
            let hint = "set radial_stock_to_leave, axial_stock_to_leave or both, mm, or remove finish";
            return Err(JobError::document("conflict", format!("{path}.finish"), message, hint));
        }
        self.check_feeds(common, path)?;
        let refused = [
            ("boundary", common.boundary.is_some()),
            ("check_faces", common.check_faces.is_some()),
            ("max_corner_deg", common.max_corner_deg.is_some()),
            ("edges", common.edges.is_some()),
            ("lead", common.lead != LeadForm::None),
            ("links", common.links != LinkHeight::Clearance),
        ];
        keys::refuse(&refused, path, |key| {
            let message =
                format!("a pocket does not follow {key}: its path is bounded by walls, stock and the engagement angle");
            (message, format!("remove {key}; which faces are cleared is stated by faces"))
        })
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        let Some(stock) = &context.scene.stock else {
            let message = "a pocket is cut from stock, and this job forms a sheet";
            return Err(JobError::document("conflict", context.path.clone(), message, "remove setup.sheet"));
        };
        if context.region.check.is_some() {
            let message = "part.check_faces are not kept away from by a pocket";
            return Err(JobError::document("conflict", context.path.clone(), message, "remove part.check_faces"));
        }
        let tolerance = context.common.tolerance;
        let budget = budget::of(tolerance, context.scene, context.machine).map_err(|error| context.error(error))?;
        let envelope = Envelope::new(&context.scene.mesh, &context.scene.index, context.tool, None, budget.margin);
        let selected = context.scene.facing_up(&context.faces);
        let surface = Surface::new(&envelope, &selected);
        let layers = self.layers(context, &surface, budget.deviation).map_err(|error| context.error(error))?;
        if let Some(hole) = self.entry_hole {
            let least = (self.angle() - CORNERS).max(LEAST);
            hole.check(context, self.smoothing(0.5 * context.tool.diameter()), least)?;
        }
        if self.rest_machining && context.before.is_empty() {
            let message = "no operation comes before this one that leaves anything";
            let hint = "put an operation with a larger tool before it, or remove rest_machining";
            return Err(JobError::document("conflict", format!("{}.rest_machining", context.path), message, hint));
        }
        let mut cleared = Cleared::default();
        for (layer, outlines) in &layers {
            let before = cleared.areas;
            self.clear(context, (&surface, stock, *layer), outlines, &mut cleared)?;
            cleared.levels += usize::from(cleared.areas > before);
        }
        if cleared.moves.is_empty() {
            let words = match self.rest_machining {
                true => " where the operations before leave stock: check their tools, the faces, z_top and z_bottom",
                false => " where stock is left: check the faces, z_top, z_bottom and the tool's size",
            };
            return Err(context.error(PlanError::NothingReached(words.to_owned())));
        }
        if let (Some(hole), 0) = (self.entry_hole, cleared.holes) {
            let message = format!("the hole at X{} Y{} lies in no area that is cleared", shown(hole.x), shown(hole.y));
            let hint = "correct its position, in work coordinates, or remove entry_hole";
            return Err(JobError::document("conflict", format!("{}.entry_hole", context.path), message, hint));
        }
        let levels = cleared.levels;
        let mut facts = cleared.facts();
        if context.common.slow_corners {
            let (moves, slow) = corners::slowed_down(context, &cleared.moves)?;
            cleared.moves = moves;
            facts.push(slow);
        }
        Ok(Planned {
            events: Vec::new(),
            cycles: Vec::new(),
            words: format!("{} on {}", counted(cleared.areas, "area", "areas"), counted(levels, "level", "levels")),
            note: format!("{levels} levels, {} areas", cleared.areas),
            facts,
            surface: None,
            moves: cleared.moves,
        })
    }

    fn cutting(&self) -> Machining {
        let angle_deg = Some(self.engagement_deg + self.growth_deg);
        let engagement = Engagement { angle_deg, ..Engagement::default() };
        Machining { work: CuttingWork::RoughMilling, engagement, pitch: None }
    }

    /// Of what cuts.
    fn highest_feed(&self, common: &OperationKeys) -> Option<f64> {
        Some(self.max_feed.unwrap_or(0.0).max(common.feeds.cut).max(self.entry_feed.unwrap_or(0.0)))
    }

    fn contact(&self) -> Contact {
        Contact::Clear
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let [left, finished] = self.left_and_finished(given.to_leave);
        Passes::Clearing(Clearing {
            angle: self.angle(),
            smoothing: self.smoothing(given.body.max_radius()),
            entry_slope: self.entry_slope(),
            entry_feed: self.entry_feed,
            link_feed: self.link_feed.or(self.max_feed).unwrap_or(0.0),
            top: given.top,
            pitch: self.step.pitch(StepLimits::default(), given.top, given.body),
            left,
            tolerance: given.tolerance,
            hole: self.entry_hole.map(EntryHole::cleared),
            rest: self.rest_machining,
            all: self.clears.is_all(),
            lowest: given.bottom.filter(|_| self.clears.is_all()),
            last_layer: Some(finished[1]).filter(|taken| *taken > 0.0).unwrap_or(f64::INFINITY),
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // what its levels leave is cleared by a floor or finished: no scallops
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None // it is the stock that counts, and not the faces
    }
}

/// Where the material's top and the tip are on a level, mm.
type Depth = [f64; 2];
/// Closed outlines, points (x, y, bulge), mm.
type Outlines = Vec<Vec<[f64; 3]>>;

impl Pocket {
    /// The layers from the top down, each with the outlines between which the tool's centre may be.
    fn layers(
        &self,
        context: &Context<'_>,
        surface: &Surface<'_>,
        deviation: f64,
    ) -> Result<Vec<(Depth, Outlines)>, PlanError> {
        let (watch, scene) = (context.watch, context.scene);
        let nothing = || PlanError::NothingReached(String::new());
        let whole = Surface::whole(surface.envelope());
        let grid = Grid::sample(&whole, context.node_spacing(), watch)?.ok_or_else(nothing)?;
        let resolution = context.machine.resolution_mm();
        let (touched, _) = selected_range(surface, &grid, resolution, watch)?.ok_or_else(nothing)?;
        let stated = context.common.z_bottom.filter(|_| self.clears.is_all());
        // the part with what stays under the tool is the part, raised
        let [[_, raised], [_, finished]] = self.left_and_finished(context.common.stock_to_leave());
        let top = context.heights.top.unwrap_or(scene.top) - raised;
        let bottom = context.heights.bottom - raised;
        // beside the part, and where it is open below, nothing is to stay
        let reachable = stated.unwrap_or(touched) - if self.clears.is_all() { raised } else { 0.0 };
        let body = context.tool.body(None);
        let keys = LevelKeys { step: &self.step, limits: StepLimits::default(), at_flats: true, of_turns: false };
        let steps = levels::steps_of(&keys, (top, &body), deviation, surface, watch)?;
        let range = LevelRange { top, bottom, reachable, steps, resolution };
        let floors = Floors::of(surface.envelope());
        let heights = levels(&range, &floors)?;
        let heights = with_levels_at(&heights, &floors.bands(), &range, &floors).unwrap_or(heights);
        let heights = heights.into_iter().filter(|z| *z >= reachable).collect();
        let lowest = with_last_layers(heights, top, finished, &floors.bands());
        let passes = z_levels(&whole, &grid, &lowest, deviation, watch)?;
        let mut above = top;
        let layers = lowest.iter().enumerate().map(|(group, z)| {
            let depth = [std::mem::replace(&mut above, *z), *z].map(|z| z + raised);
            let loops = passes.iter().filter(|pass| pass.group == group && pass.closed);
            let flat = |pass: &Pass| pass.points.iter().skip(1).map(|point| [point.tip.x, point.tip.y, 0.0]).collect();
            (depth, loops.map(flat).collect())
        });
        Ok(layers.collect())
    }

    /// Whether an area that holds the hole begins in it; refused where it holds it and does not.
    fn begins_in_hole(&self, context: &Context<'_>, area: &CentreArea, path: &PocketPath) -> Result<bool, JobError> {
        let Some(hole) = self.entry_hole.filter(|hole| area.holds([hole.x, hole.y])) else { return Ok(false) };
        if path.runs.first().is_some_and(|run| run.kind == PocketRunKind::Entry) {
            let why = "the tool cannot begin in the hole: it is too near to a wall";
            return Err(hole.error(context, why));
        }
        Ok(true)
    }

    /// Clears the areas of a level, or those of them that are over selected faces.
    fn clear(
        &self,
        context: &Context<'_>,
        (surface, stock, [top, floor]): (&Surface<'_>, &Stock, Depth),
        outlines: &[Vec<[f64; 3]>],
        cleared: &mut Cleared,
    ) -> Result<(), JobError> {
        let Context { common, machine, tool, reference_height, operation, watch, .. } = *context;
        let radius = tool.cutter().at_height(top - floor).0;
        let ([left, finished], direction) = (self.left_and_finished(common.stock_to_leave()), sense(common, true));
        let between = stock.outlines_between([top, floor]);
        if between.is_empty() {
            return Ok(());
        }
        let in_stock = |hole: &EntryHole| CentreArea::parted(&between).iter().any(|area| area.holds([hole.x, hole.y]));
        let hole = self.entry_hole.filter(in_stock).map(EntryHole::outline);
        let (air, beyond) = box_around(stock, BEYOND * tool.diameter());
        let stock: Vec<Vec<[f64; 3]>> = between.iter().cloned().chain(hole).collect();
        let all: Vec<Vec<[f64; 3]>> = outlines.iter().cloned().chain([air]).collect();
        // in programs that lean arcs become lines, and their chords turn the heading
        let arcs = common.fit == Fit::Arcs && machine.arc.is_some() && machine.rotary.is_none();
        let before = context.before.cleared([top, floor], self.rest_machining);
        let is_cleared = |area: &&CentreArea| self.clears.is_all() || is_over_selected(surface, area, floor, radius);
        let mut planned = Repeated::default();
        for area in CentreArea::parted(&all).iter().filter(is_cleared) {
            let asked = Asked {
                shape: Shape::Centres { outlines: &area.outlines, stock: &stock, in_air: area.holds(beyond) },
                radius,
                angle: if arcs { self.angle() } else { (self.angle() - CORNERS).max(LEAST) },
                smoothing: self.smoothing(0.5 * tool.diameter()),
                leave: left[0],
                finish: finished[0],
                cleared: &before,
                climb: direction != Sense::Reversed,
                two_way: direction == Sense::Alternate,
                entry: EntryRule { form: self.entry.form(), size: self.entry_size },
                stepovers: true,
            };
            let now = Situation { outlines: &area.outlines, stock: &stock, radius };
            let known = cleared.before.path(now).filter(|_| before.is_empty());
            let path = match known.map_or_else(|| pocket_path(&asked, watch), Ok) {
                Ok(path) => path,
                Err(PocketError::TooSmall { .. }) => {
                    cleared.narrow += 1;
                    continue;
                }
                Err(PocketError::Empty) => continue, // an area beside the stock, or one that is open above
                Err(error) => return Err(self.refused(context, floor, &error)),
            };
            planned.keep(now, &path);
            cleared.holes += usize::from(self.begins_in_hole(context, area, &path)?);
            let takes = |ends: [[f64; 3]; 2], arc: &Arc| {
                arcs && machine.arc.as_ref().is_some_and(|rules| rules.planes.contains(&arc.plane))
                    && machine.posts_arc(ends, arc, reference_height)
            };
            let feeds = FeedLaw { spare: if arcs { 0.0 } else { CORNERS }, ..self.feed_law(context, radius) };
            let layer = self.layer(context, [top, floor], feeds, &takes);
            cleared.areas += 1;
            cleared.goal += path.goal;
            cleared.moves.extend(segments(&path, &layer).iter().map(|segment: &Segment| segment.to_move(operation)));
        }
        cleared.before = planned;
        Ok(())
    }

    /// How the tool moves in a layer.
    fn layer<'a>(
        &self,
        context: &Context<'_>,
        [top, floor]: Depth,
        feeds: FeedLaw,
        takes: &'a dyn Fn([[f64; 3]; 2], &Arc) -> bool,
    ) -> Layer<'a> {
        let Context { scene, common, machine, .. } = *context;
        Layer {
            top,
            floor,
            heights: Heights { clearance: scene.clearance, retract: scene.retract },
            plunge: common.feeds.plunge,
            entry_feed: self.entry_feed.unwrap_or(common.feeds.plunge),
            entry_slope: self.entry_slope(),
            feeds,
            link_feed: self.feed_of_links(context),
            rapid_rate: machine.limits.rapid_rate,
            kept: self.left_and_finished(common.stock_to_leave())[0][0],
            link_lift: self.link_lift,
            deviation: CHORDS,
            takes,
        }
    }

    /// That an area of the level `floor` is not planned.
    fn refused(&self, context: &Context<'_>, floor: f64, error: &PocketError) -> JobError {
        let at = format!("{}.{}", context.path, error.key());
        match error {
            PocketError::Cancelled => JobError::Cancelled,
            PocketError::NoEntry { .. } => {
                let message = format!("at Z{}: {error}", shown(floor));
                let other = if self.entry == Entry::Auto { "" } else { "set entry = \"auto\", " };
                let size = self.entry_size.map_or("", |_| "lower entry_size, ");
                JobError::document(error.code(), at, message, format!("{other}{size}or drill an entry_hole there"))
            }
            _ => JobError::document(error.code(), at, error.to_string(), "correct it"),
        }
    }
}

/// What was planned so far.
#[derive(Default)]
struct Cleared {
    moves: Vec<Move>,
    /// The paths of the level before.
    before: Repeated,
    /// Levels on which something was cleared.
    levels: usize,
    areas: usize,
    /// Areas that begin in the hole.
    holes: usize,
    /// Areas that the tool does not fit into.
    narrow: usize,
    /// mm^2, level by level.
    goal: f64,
}

impl Cleared {
    fn facts(&self) -> Vec<Fact> {
        let mut lengths = [0.0; 2];
        for pair in self.moves.windows(2) {
            let [before, step] = pair else { continue };
            let is_cut = step.kind == MoveKind::Feed && step.role == Some(Role::Cut);
            if let Some(length) = lengths.get_mut(usize::from(is_cut)) {
                *length += step.length(before.end.tip);
            }
        }
        let [air, cut] = lengths;
        let narrow = (self.narrow > 0).then(|| {
            let words = format!("{} too narrow for the tool", counted(self.narrow, "area is", "areas are"));
            Fact { fact: "narrow_areas", value: self.narrow as f64, unit: "", words }
        });
        let area = format!("{:.1} mm^2 to be cleared, all levels together", self.goal);
        [
            Fact::count(self.levels, "level", "levels"),
            Fact::count(self.areas, "area", "areas"),
            Fact { fact: "to_be_cleared", value: self.goal, unit: "mm^2", words: area },
            Fact::length("cut", cut, "cutting"),
            Fact::length("not_cutting", air, "entering, linking and through the air"),
        ]
        .into_iter()
        .chain(narrow)
        .collect()
    }
}

/// The heights of levels from the top down, with one more over each on a floor from which the last layer is as thick as it may be.
fn with_last_layers(mut heights: Vec<f64>, top: f64, thickness: f64, floors: &[(f64, f64)]) -> Vec<f64> {
    if thickness > 0.0 {
        let is_on_floor = |z: f64| floors.iter().any(|(low, high)| (*low..=*high).contains(&z));
        let over = heights.iter().copied().filter(|z| is_on_floor(*z)).map(|z| z + thickness);
        let is_free = |level: &f64| {
            let near = |z: &f64| *z < level + THINNEST && *z > level - thickness + THINNEST;
            *level < top - THINNEST && !heights.iter().any(near)
        };
        let more: Vec<f64> = over.filter(is_free).collect();
        heights.extend(more);
        heights.sort_by(|a, b| b.total_cmp(a));
    }
    heights
}

/// The outline of the stock's box in plan, `by` mm larger on all sides, and a position in its corner.
fn box_around(stock: &Stock, by: f64) -> (Vec<[f64; 3]>, [f64; 2]) {
    let (low, high) = stock.bounds();
    let corner = [low.x - by, low.y - by];
    (rectangle_outline(corner, [high.x + by, high.y + by]), corner.map(|x| x + CORNER))
}

/// Whether a tool that is lowered in an area touches selected faces there.
fn is_over_selected(surface: &Surface<'_>, area: &CentreArea, floor: f64, radius: f64) -> bool {
    let Some([low, high]) = area.bounds() else { return false };
    let size = [high[0] - low[0], high[1] - low[1]];
    let apart = (0.5 * radius).min(size[0].min(size[1]) / LOOKED).max(1e-3);
    let [columns, rows] = size.map(|length| (length / apart) as usize);
    let mut hint = None;
    (0..=rows).any(|row| {
        (0..=columns).any(|column| {
            let at = [low[0] + (column as f64 + 0.5) * apart, low[1] + (row as f64 + 0.5) * apart];
            area.holds(at)
                && surface.at(at[0], at[1], &mut hint).is_some_and(|point| point.selected && point.tip.z <= floor)
        })
    })
}

fn engagement() -> f64 {
    ENGAGEMENT_DEG
}

fn entry_angle() -> f64 {
    3.0
}
