//! Drill: round upright holes of the part, by canned cycles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::{
    Cycle, CycleKind, CycleStart, CycleStep, EventKind, Move, MoveKind, SpindleDirection, MOST_PECKS,
};
use styluscam_verify::{Contact, DrilledHole, Drilling, Passes};

use super::at_holes::{begins, breakthrough, check_solid, check_walls, no_hole, retract_height};
use super::facts::counted;
use super::in_order::in_order;
use super::keys;
use super::{
    About, Areas, Context, Effort, Fact, Fit, LeadForm, LinkHeight, Machining, OperationKind, PassContext, PassSpacing,
    Planned, Serves, Spindle,
};
use crate::cutting::{CuttingWork, Engagement};
use crate::holes::{holes_among, Hole};
use crate::limits::GOUGE;
use crate::numbers::shown;
use crate::{JobError, OperationKeys};

/// Drills, taps or bores the round upright holes among the selected faces, each along its axis from its own top. Machines without the
/// cycle get its moves. Of faces = "all" only holes of the tool's diameter are taken; named faces must all be walls of such holes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drill {
    /// What is done at each hole.
    #[serde(default)]
    #[schemars(extend("x-example" = "{ kind = \"peck\", peck = 3.0 }"))]
    pub cycle: HoleCycle,
    /// How deep blind holes are drilled. Through holes are drilled to their full diameter.
    #[serde(default)]
    pub depth: HoleDepth,
    /// How far the tool's full diameter goes on below through holes, mm.
    #[serde(default = "breakthrough")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub breakthrough: f64,
    /// How far above a hole's top the tool comes down at rapid, mm.
    #[serde(default = "retract_height")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub retract_height: f64,
    /// By how much holes may be wider than the tool, mm: for core holes of threads, holes that are reamed or bored afterwards.
    #[serde(default = "diameter_tolerance")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub diameter_tolerance: f64,
}

/// What is done at a hole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum HoleCycle {
    /// Down at feed, up at rapid.
    Drill {
        /// Wait at the bottom, s.
        #[serde(default)]
        #[schemars(extend("x-unit" = "s", "minimum" = 0.0, "maximum" = 100.0))]
        dwell: f64,
    },
    /// Down in pecks, out of the hole after each.
    Peck {
        /// Depth of a peck, mm.
        #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
        peck: f64,
    },
    /// Down in pecks, a little up after each.
    ChipBreak {
        /// Depth of a peck, mm.
        #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
        peck: f64,
    },
    /// A thread: the spindle turns in step with the feed, and back; left-hand where it turns counterclockwise.
    Tap {
        /// Rise of the thread, mm per revolution: with the spindle's speed it is the feed.
        #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 100.0))]
        pitch: f64,
    },
    /// Down and up at feed.
    Bore {
        /// Wait at the bottom, s.
        #[serde(default)]
        #[schemars(extend("x-unit" = "s", "minimum" = 0.0, "maximum" = 100.0))]
        dwell: f64,
    },
}

impl Default for HoleCycle {
    fn default() -> Self {
        Self::Drill { dwell: 0.0 }
    }
}

impl HoleCycle {
    fn kind(self, direction: SpindleDirection) -> CycleKind {
        match (self, direction) {
            (Self::Drill { .. }, _) => CycleKind::Drill,
            (Self::Peck { .. }, _) => CycleKind::Peck,
            (Self::ChipBreak { .. }, _) => CycleKind::ChipBreak,
            (Self::Tap { .. }, SpindleDirection::Clockwise) => CycleKind::Tap,
            (Self::Tap { .. }, SpindleDirection::Counterclockwise) => CycleKind::LeftTap,
            (Self::Bore { .. }, _) => CycleKind::Bore,
        }
    }

    fn dwell(self) -> f64 {
        match self {
            Self::Drill { dwell } | Self::Bore { dwell } => dwell,
            Self::Peck { .. } | Self::ChipBreak { .. } | Self::Tap { .. } => 0.0,
        }
    }

    fn peck(self) -> Option<f64> {
        match self {
            Self::Peck { peck } | Self::ChipBreak { peck } => Some(peck),
            Self::Drill { .. } | Self::Tap { .. } | Self::Bore { .. } => None,
        }
    }

    fn pitch(self) -> Option<f64> {
        match self {
            Self::Tap { pitch } => Some(pitch),
            Self::Drill { .. } | Self::Peck { .. } | Self::ChipBreak { .. } | Self::Bore { .. } => None,
        }
    }
}

/// How deep blind holes are drilled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HoleDepth {
    /// The tool's tip reaches the floor: of a flat floor its point leaves a cone.
    #[default]
    Tip,
    /// The tool's full diameter reaches the end of the wall: for floors that are modelled as cones.
    FullDiameter,
}

/// A tool as holes see it, mm.
#[derive(Clone, Copy)]
struct DrillShape {
    diameter: f64,
    /// From its tip to its full diameter.
    point: f64,
}

impl DrillShape {
    fn of(body: &styluscam_geometry::ToolBody) -> Self {
        Self { diameter: 2.0 * body.max_radius(), point: body.max_height() }
    }
}

impl Drill {
    pub(super) const ABOUT: About = About {
        purpose: "for round upright holes",
        serves: Serves::Holes,
        starter: |passes| {
            let cycle = match passes.peck {
                Some(peck) => format!("{{ kind = \"peck\", peck = {peck:?} }}"),
                None => "{ kind = \"drill\" }".to_owned(),
            };
            let wider = (passes.wider > 0.0).then(|| {
                format!(
                    "diameter_tolerance = {:?}  # the holes are so much wider: they are reamed or bored\n",
                    passes.wider
                )
            });
            format!("cycle = {cycle}  # or drill, peck, chip-break, tap, bore\n{}", wider.unwrap_or_default())
        },
    };

    /// Whether a hole is as wide as the tool, or wider by no more than the tolerance.
    fn fits(&self, hole: &Hole, shape: DrillShape) -> bool {
        let wider = hole.diameter() - shape.diameter;
        (-2.0 * GOUGE..=self.diameter_tolerance + 2.0 * GOUGE).contains(&wider)
    }

    /// The height that the tip reaches in a hole, mm.
    fn bottom(&self, hole: &Hole, shape: DrillShape) -> f64 {
        let full = hole.bottom - shape.point;
        match (hole.floor, self.depth) {
            (None, _) => full - self.breakthrough,
            (Some(floor), HoleDepth::Tip) => full.max(floor),
            (Some(_), HoleDepth::FullDiameter) => full,
        }
    }

    /// The holes that are drilled, and those of another diameter.
    fn holes(&self, given: &PassContext<'_>) -> (Vec<Hole>, Vec<Hole>) {
        let shape = DrillShape::of(given.body);
        holes_among(given.scene.solid(), given.faces).into_iter().partition(|hole| self.fits(hole, shape))
    }

    /// Named faces that are no wall of an upright hole that the tool fits.
    fn check_named(&self, given: &PassContext<'_>, found: &[Hole], path: &str) -> Result<(), JobError> {
        check_walls(given, found, path)?;
        let shape = DrillShape::of(given.body);
        match found.iter().find(|hole| !self.fits(hole, shape)) {
            Some(hole) => Err(self.misfit(hole, shape, path)),
            None => Ok(()),
        }
    }

    /// That a hole is narrower, or too much wider, than the tool.
    fn misfit(&self, hole: &Hole, shape: DrillShape, path: &str) -> JobError {
        let (name, wide) = (hole.name(), hole.diameter());
        let wider = wide - shape.diameter;
        if wider < 0.0 {
            let message = format!("the hole {name} is {wide:.3} mm wide, {:.3} mm narrower than the tool", -wider);
            return JobError::document("narrow-hole", format!("{path}.tool"), message, "take a narrower tool");
        }
        let message = format!(
            "the hole {name} is {wide:.3} mm wide, {wider:.3} mm wider than the tool: at most diameter_tolerance = {}",
            shown(self.diameter_tolerance)
        );
        let hint = format!("take a tool of {wide:.3} mm, or set diameter_tolerance = {:.3}", wider + 0.001);
        JobError::document("wide-hole", format!("{path}.diameter_tolerance"), message, hint)
    }
}

impl OperationKind for Drill {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let refused = [
            ("boundary", common.boundary.is_some()),
            ("check_faces", common.check_faces.is_some()),
            ("max_corner_deg", common.max_corner_deg.is_some()),
            ("edges", common.edges.is_some()),
            ("lead", common.lead != LeadForm::None),
            ("links", common.links != LinkHeight::Clearance),
            ("z_bottom", common.z_bottom.is_some()),
            ("fit", common.fit != Fit::Lines),
            ("slow_corners", common.slow_corners),
            ("radial_stock_to_leave", common.radial_stock_to_leave > 0.0),
            ("axial_stock_to_leave", common.axial_stock_to_leave > 0.0),
        ];
        keys::refuse(&refused, path, |key| {
            let message = format!("drilling does not follow {key}: it goes down the axes of holes, to their depth");
            (message, format!("remove {key}"))
        })
    }

    fn cutting(&self) -> Machining {
        let pitch = self.cycle.pitch();
        let work = if pitch.is_some() { CuttingWork::Tapping } else { CuttingWork::Drilling };
        Machining { work, engagement: Engagement::default(), pitch }
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn owes_faces(&self) -> bool {
        false
    }

    fn plunge_feed(&self, common: &OperationKeys, rpm: Option<f64>) -> f64 {
        self.cycle.pitch().zip(rpm).map_or(common.feeds.plunge, |(pitch, rpm)| pitch * rpm)
    }

    fn cut_feed(&self, common: &OperationKeys) -> f64 {
        self.plunge_feed(common, common.spindle.rpm())
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        check_solid(context)?;
        let body = context.tool.body(None);
        let given = PassContext::of(context, &body);
        let (holes, others) = self.holes(&given);
        let skipped = others.len();
        let (holes, across) = in_order(context, &holes, |hole| hole.at)?;
        let mut drilled = self.drilled(context, &given, &holes)?;
        let through = holes.iter().filter(|hole| hole.floor.is_none()).count();
        drilled.facts.push(Fact::length("across", across, "across from hole to hole"));
        let skipped = (skipped > 0).then(|| {
            let words = format!("{} of another diameter left out", counted(skipped, "hole", "holes"));
            Fact { fact: "other_holes", value: skipped as f64, unit: "", words }
        });
        drilled.facts.extend(skipped);
        Ok(Planned {
            words: format!("{}, {through} of them through", counted(holes.len(), "hole", "holes")),
            note: counted(holes.len(), "hole", "holes"),
            ..drilled
        })
    }

    fn contact(&self) -> Contact {
        Contact::Clear
    }

    fn check_part(&self, given: &PassContext<'_>, are_named: bool, path: &str) -> Result<(), JobError> {
        let found = holes_among(given.scene.solid(), given.faces);
        let shape = DrillShape::of(given.body);
        if are_named {
            self.check_named(given, &found, path)?;
        }
        let fitting: Vec<&Hole> = found.iter().filter(|hole| self.fits(hole, shape)).collect();
        if fitting.is_empty() {
            let wider = |hole: &&Hole| (hole.diameter() - shape.diameter).abs();
            return Err(match found.iter().min_by(|a, b| wider(a).total_cmp(&wider(b))) {
                Some(hole) => self.misfit(hole, shape, path),
                None => no_hole(path),
            });
        }
        for hole in fitting {
            let entered = hole.floor.map_or(0.0, |floor| floor - self.bottom(hole, shape));
            if entered > GOUGE {
                let message = format!(
                    "the hole {} has a floor that the tool's point would enter by {entered:.3} mm before its full diameter is at the \
                     end of the wall",
                    hole.name()
                );
                let hint =
                    "set depth = \"tip\", model the floor as the cone of the tool's point, or take a flatter tool";
                return Err(JobError::document("flat-floor", format!("{path}.depth"), message, hint));
            }
        }
        Ok(())
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let shape = DrillShape::of(given.body);
        let drilled = |hole: &Hole| DrilledHole {
            name: hole.name(),
            at: hole.at,
            radius: hole.radius,
            chord: hole.chord,
            top: begins(hole, given),
            bottom: self.bottom(hole, shape),
        };
        Passes::Drilling(Drilling {
            holes: self.holes(given).0.iter().map(drilled).collect(),
            peck: self.cycle.peck().unwrap_or(f64::INFINITY),
            clears: matches!(self.cycle, HoleCycle::Peck { .. }),
            dwell: self.cycle.dwell(),
            rises_at_feed: matches!(self.cycle, HoleCycle::Tap { .. } | HoleCycle::Bore { .. }),
            is_tapping: self.cycle.pitch().is_some(),
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // holes lie where the part has them
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None // a few moves for each hole
    }
}

impl Drill {
    /// Speed and direction of the spindle. Taps without are refused here, not in `check`: a job that leaves the spindle out has it
    /// from its material.
    fn spindle(&self, context: &Context<'_>) -> Result<Option<(f64, SpindleDirection)>, JobError> {
        match context.common.spindle {
            Spindle::Fixed { rpm, direction } => Ok(Some((rpm, direction))),
            Spindle::Off | Spindle::Free | Spindle::Rolling if self.cycle.pitch().is_some() => {
                let message = "a tap's feed is its pitch times the spindle's speed, and the spindle is not driven";
                let hint = "set spindle = { mode = \"fixed\", rpm = 300.0 }";
                Err(JobError::document("conflict", format!("{}.spindle", context.path), message, hint))
            }
            Spindle::Off | Spindle::Free | Spindle::Rolling => Ok(None),
        }
    }

    /// The moves of holes in their order, with their cycles.
    fn drilled(&self, context: &Context<'_>, given: &PassContext<'_>, holes: &[Hole]) -> Result<Planned, JobError> {
        let (common, shape) = (context.common, DrillShape::of(given.body));
        let spindle = self.spindle(context)?;
        let kind = self.cycle.kind(spindle.map_or(SpindleDirection::Clockwise, |(_, direction)| direction));
        let (mut moves, mut cycles) = (Vec::new(), Vec::new());
        let mut events: Vec<(usize, EventKind)> = Vec::new();
        let clearance = context.scene.clearance;
        let mut depth = 0.0;
        for hole in holes {
            let [x, y] = hole.at;
            let begins = begins(hole, given).max(context.heights.top.unwrap_or(hole.top));
            let cycle = Cycle {
                first: moves.len(),
                count: 0,
                kind,
                at: hole.at,
                retract: (begins + self.retract_height).min(clearance),
                bottom: self.bottom(hole, shape),
                leave: clearance,
                feed: self.plunge_feed(common, spindle.map(|(rpm, _)| rpm)),
                dwell: self.cycle.dwell(),
                peck: self.cycle.peck().unwrap_or(0.0),
            };
            if kind.is_tapping() && !context.machine.takes_cycle(&cycle) {
                let message = format!("{} has no cycle that taps ({kind:?})", context.machine.name);
                let hint = "take a machine that taps, or drill the holes and cut the threads by hand";
                return Err(JobError::document("no-tapping", format!("{}.cycle", context.path), message, hint));
            }
            let from = moves.last().map_or([x, y, clearance], |last: &Move| last.end.tip);
            if moves.is_empty() {
                moves.push(Move::rapid(from).of_operation(context.operation));
            }
            let cycle = Cycle { first: moves.len(), ..cycle };
            let steps = cycle.steps(&CycleStart { position: from, spindle }).ok_or_else(|| {
                let message = format!("the hole {} takes more than {MOST_PECKS} pecks", hole.name());
                JobError::document("out-of-range", format!("{}.cycle.peck", context.path), message, "raise peck")
            })?;
            for step in steps {
                match step {
                    CycleStep::Move(MoveKind::Rapid, tip) => {
                        moves.push(Move::rapid(tip).of_operation(context.operation));
                    }
                    CycleStep::Move(MoveKind::Feed, tip) => {
                        moves.push(Move::feed(tip, cycle.feed).of_operation(context.operation));
                    }
                    CycleStep::Event(kind) => events.push((moves.len() - 1, kind)),
                }
            }
            depth += begins - cycle.bottom;
            cycles.push(Cycle { count: moves.len() - cycle.first, ..cycle });
        }
        let facts = vec![
            Fact::count(holes.len(), "hole", "holes"),
            Fact::length("drilled", depth, "drilled, all holes together"),
        ];
        Ok(Planned { moves, events, cycles, words: String::new(), note: String::new(), facts, surface: None })
    }
}

fn diameter_tolerance() -> f64 {
    0.01
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // sums of the holes' short numbers are exact
mod tests {
    use super::*;

    const SHAPE: DrillShape = DrillShape { diameter: 5.0, point: 1.5 };

    fn hole(floor: Option<f64>) -> Hole {
        Hole { faces: vec![7], at: [0.0; 2], radius: 2.5, top: 12.0, bottom: 4.0, floor, floor_top: floor, chord: 0.0 }
    }

    fn drill(depth: HoleDepth) -> Drill {
        Drill { cycle: HoleCycle::default(), depth, breakthrough: 0.5, retract_height: 1.0, diameter_tolerance: 0.1 }
    }

    #[test]
    fn the_point_goes_through_and_stops_at_floors() {
        for depth in [HoleDepth::Tip, HoleDepth::FullDiameter] {
            assert_eq!(drill(depth).bottom(&hole(None), SHAPE), 2.0);
            assert_eq!(drill(depth).bottom(&hole(Some(2.5)), SHAPE), 2.5, "the cone of its own point");
        }
        assert_eq!(drill(HoleDepth::Tip).bottom(&hole(Some(4.0)), SHAPE), 4.0);
        assert_eq!(drill(HoleDepth::FullDiameter).bottom(&hole(Some(4.0)), SHAPE), 2.5);
        assert_eq!(
            drill(HoleDepth::Tip).bottom(&hole(Some(1.0)), SHAPE),
            2.5,
            "its shoulder meets a steeper cone first"
        );
    }

    #[test]
    fn holes_fit_from_the_tools_diameter_to_the_tolerance_beyond_it() {
        let fits = |diameter: f64| drill(HoleDepth::Tip).fits(&Hole { radius: 0.5 * diameter, ..hole(None) }, SHAPE);
        assert!(fits(4.999) && fits(5.0) && fits(5.1));
        assert!(!fits(4.99) && !fits(5.11));
    }

    #[test]
    fn a_taps_feed_is_its_pitch_times_the_speed() {
        let tap = Drill { cycle: HoleCycle::Tap { pitch: 0.8 }, ..drill(HoleDepth::Tip) };
        let common = crate::from_toml(&crate::tests::setup::levels()).unwrap().operations.remove(0).common;
        assert_eq!(tap.plunge_feed(&common, Some(500.0)), 400.0);
        assert_eq!(drill(HoleDepth::Tip).plunge_feed(&common, Some(500.0)), common.feeds.plunge);
    }
}
