//! Contour: along named edges, beside them or on them, level by level.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_toolpath::contouring::Beside;
use styluscam_verify::{Contact, ContourLevel, ContourLine, ContourPiece, ContourSide, Contouring, Passes};

use super::contour_work::{EdgeSide, Level, Rule, Work};
use super::step::{Step, StepLimits};
use super::{
    contour_passes, keys, rails, About, Areas, Context, Direction, Effort, Machining, OperationKind, PassContext,
    PassSpacing, Planned, Serves, Tabs,
};
use crate::cutting::{CuttingWork, Engagement};
use crate::edge_lines::{lines_of_edges, lines_of_faces, EdgeLine};
use crate::numbers::shown;
use crate::{JobError, OperationKeys};

/// Levels that are nearer to the last are none, mm.
const THINNEST: f64 = 1e-3;
/// Levels at most: a step that asks for more is a mistake.
const MOST_LEVELS: usize = 10_000;

/// Mills along level edges of the part, beside them or on them, level by level down the walls at them. The tool stands so that its
/// silhouette touches the upright plane through the edge; where it would enter the part elsewhere the path ends, and what is left is listed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contour {
    /// Distance between levels.
    #[schemars(extend("x-example" = "{ height = 2.0 }"))]
    pub step: Step,
    /// On which side of the edges the tool is: of those that close outside, inside or on; of others left, right or on, seen from the first
    /// named one on.
    pub edge_side: EdgeSide,
    /// The edges by their names, as FreeCAD shows them: ["Edge3", "Edge7"]; joined end to end. When left out those of the selected level
    /// faces with an upright wall on that side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub edge_names: Option<Vec<String>>,
    /// Whether the stock to leave is taken as well: by one more pass at full depth, after the levels.
    #[serde(default)]
    pub finish: bool,
    /// Angle at which the tool goes down into the material along the edges, degrees: round those that close, else to and fro.
    #[serde(default = "entry_angle")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 0.1, "maximum" = 30.0))]
    pub entry_angle_deg: f64,
    /// Whether the tool goes straight down to each level instead, into the material too.
    #[serde(default)]
    pub plunge: bool,
    /// Tabs that hold what is cut out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ count = 4, width = 5.0, height = 1.5 }"))]
    pub tabs: Option<Tabs>,
}

impl Contour {
    pub(super) const ABOUT: About = About {
        purpose: "for walls along named edges, and grooves on them",
        serves: Serves::OnRequest,
        starter: |passes| {
            format!(
                "step = {{ height = {:?} }}    # distance between levels\nedge_side = \"outside\"     # of the edges: outside, \
                 inside, left, right or on\n",
                passes.pitch
            )
        },
    };

    /// Height over length of ramps; none where the tool goes straight down.
    fn slope(&self) -> Option<f64> {
        (!self.plunge).then(|| libm::tan(self.entry_angle_deg.to_radians()))
    }

    fn lines(&self, given: &PassContext<'_>, path: &str) -> Result<Vec<EdgeLine>, JobError> {
        let scene = given.scene;
        let Some(names) = &self.edge_names else {
            let outside = match self.edge_side {
                EdgeSide::Outside => Some(true),
                EdgeSide::Inside => Some(false),
                EdgeSide::Left | EdgeSide::Right | EdgeSide::On => None,
            };
            let found = lines_of_faces(scene, given.faces, outside);
            if found.is_empty() {
                let message = "none of the faces is level and has an edge with an upright wall on that side";
                let hint = "name the edges: edge_names = [\"Edge3\"], or select level faces beside walls that go down";
                return Err(JobError::document("no-edge", format!("{path}.faces"), message, hint));
            }
            return Ok(found);
        };
        lines_of_edges(scene, (names, &rails::edges(scene, names, path)?), path)
    }

    /// What is milled; `path` is the operation's.
    fn work(&self, given: &PassContext<'_>, path: &str) -> Result<Vec<Work>, JobError> {
        let lines = self.lines(given, path)?;
        if let Some(line) = lines.iter().find(|line| !self.edge_side.fits(line.closed)) {
            let (kind, words) = match line.closed {
                true => ("close", "\"outside\", \"inside\" or \"on\""),
                false => ("do not close", "\"left\", \"right\" or \"on\", seen from the first named edge on"),
            };
            let message = format!("edge_side = \"{}\", and the edges {kind}: {}", self.edge_side.word(), line.name());
            let hint = format!("set edge_side to {words}");
            return Err(JobError::document("wrong-side", format!("{path}.edge_side"), message, hint));
        }
        lines.into_iter().map(|line| self.levels_of(line, given, path)).collect()
    }

    /// A line with its levels.
    fn levels_of(&self, line: EdgeLine, given: &PassContext<'_>, path: &str) -> Result<Work, JobError> {
        let foot = if self.edge_side == EdgeSide::On { Some(line.height()) } else { line.foot() };
        let Some(bottom) = given.bottom.or(foot) else {
            let message = format!("the walls at {} do not end at one height, or there are none", line.name());
            let hint = "state how deep the tool goes: z_bottom, mm in work coordinates";
            return Err(JobError::document("missing", format!("{path}.z_bottom"), message, hint));
        };
        let [radial, axial] = given.to_leave;
        let last = bottom + axial;
        if last > given.top {
            let message = format!(
                "the lowest level, at Z{}, is above the height at which the operation begins, Z{}, at {}",
                shown(last),
                shown(given.top),
                line.name()
            );
            let hint = "lower z_bottom, or raise z_top";
            return Err(JobError::document("conflict", format!("{path}.z_bottom"), message, hint));
        }
        let heights = self.heights([given.top, last], path)?;
        let mut levels: Vec<Level> = heights.into_iter().map(|tip| Level { tip, left: radial }).collect();
        if self.finish {
            levels.push(Level { tip: bottom, left: 0.0 });
        }
        Ok(Work { line, levels, begins: given.top })
    }

    /// The heights of levels between two heights, from the top down: the last is at the lower one.
    fn heights(&self, [top, last]: [f64; 2], path: &str) -> Result<Vec<f64>, JobError> {
        let mut heights = Vec::new();
        let mut at = top;
        let listed = match &self.step {
            Step::List(steps) => steps.clone(),
            Step::Height(step) | Step::Scallop(step) => vec![*step],
        };
        let mut steps = listed.iter().chain(std::iter::repeat(listed.last().unwrap_or(&f64::INFINITY)));
        loop {
            at -= steps.next().copied().unwrap_or(f64::INFINITY);
            if at <= last + THINNEST {
                heights.push(last);
                return Ok(heights);
            }
            heights.push(at);
            if heights.len() > MOST_LEVELS {
                let message = format!("the step makes more than {MOST_LEVELS} levels");
                return Err(JobError::document("out-of-range", format!("{path}.step"), message, "raise step.height"));
            }
        }
    }
}

impl OperationKind for Contour {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        StepLimits::default().check(&self.step, path)?;
        if matches!(self.step, Step::Scallop(_)) {
            let message = "levels along edges are no scallops";
            let hint = "set step = { height = 2.0 }, mm";
            return Err(JobError::document("conflict", format!("{path}.step.scallop"), message, hint));
        }
        if self.finish && common.radial_stock_to_leave <= 0.0 {
            let message = "finish takes the stock to leave on walls, and there is none";
            let hint = "set radial_stock_to_leave, mm, or remove finish";
            return Err(JobError::document("conflict", format!("{path}.finish"), message, hint));
        }
        if self.edge_side == EdgeSide::On && common.radial_stock_to_leave > 0.0 {
            let message = "a tool on the edges leaves no stock beside them";
            let hint = "remove radial_stock_to_leave, or set edge_side";
            return Err(JobError::document("conflict", format!("{path}.radial_stock_to_leave"), message, hint));
        }
        let refused = [
            ("boundary", common.boundary.is_some()),
            ("check_faces", common.check_faces.is_some()),
            ("max_corner_deg", common.max_corner_deg.is_some()),
            ("edges", common.edges.is_some()),
        ];
        keys::refuse(&refused, path, |key| {
            let message =
                format!("a contour does not follow {key}: it goes along edges until something else is in its path");
            (message, format!("remove {key}; which edges are followed is stated by edge_names"))
        })?;
        self.tabs.map_or(Ok(()), |tabs| tabs.check(path))
    }

    fn cutting(&self) -> Machining {
        let engagement = Engagement { depth: self.step.even(), ..Engagement::default() };
        Machining { work: CuttingWork::RoughMilling, engagement, pitch: None }
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn owes_faces(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        let body = context.tool.body(None);
        let works = self.work(&PassContext::of(context, &body), &context.path)?;
        let rule = Rule { side: self.edge_side, slope: self.slope(), tabs: self.tabs };
        contour_passes::planned(rule, &works, context)
    }

    fn tabs(&self) -> Option<Tabs> {
        self.tabs
    }

    fn contact(&self) -> Contact {
        Contact::Clear // ramps need not touch: the verifier looks at the edges one by one
    }

    fn check_part(&self, given: &PassContext<'_>, _are_named: bool, path: &str) -> Result<(), JobError> {
        if given.scene.sheet.is_some() {
            let message = "contours are milled, and this job forms a sheet";
            return Err(JobError::document("conflict", path, message, "remove setup.sheet"));
        }
        self.work(given, path).map(drop)
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let Ok(work) = self.work(given, "") else {
            return Passes::Unordered { reason: "the part has no edges that are followed" };
        };
        let side = match self.edge_side.beside() {
            Some(Beside::Left) => ContourSide::Left,
            Some(Beside::Right) => ContourSide::Right,
            None => ContourSide::On,
        };
        let line = |work: &Work| ContourLine {
            pieces: work
                .line
                .pieces
                .iter()
                .map(|piece| ContourPiece { name: piece.name.clone(), ends: piece.ends.map(|end| [end.x, end.y]) })
                .collect(),
            plane_top: work.plane_top(),
            begins: work.begins,
            levels: work.levels.iter().map(|level| ContourLevel { tip: level.tip, left: level.left }).collect(),
        };
        Passes::Contouring(Contouring {
            lines: work.iter().map(line).collect(),
            side,
            is_climb: match given.direction {
                Direction::Climb => Some(true),
                Direction::Conventional => Some(false),
                Direction::Alternate | Direction::Same => None,
            },
            entry_slope: self.slope(),
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // edges lie where the part has them
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None
    }
}

fn entry_angle() -> f64 {
    3.0
}
