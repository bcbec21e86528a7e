//! What a kind of operation answers: the interface between the kinds and the rest of the job.

use serde::Serialize;
use styluscam_geometry::ToolBody;
use styluscam_motion::{Cycle, EventKind, Move};
use styluscam_verify::{Contact, Layers, Passes};

use super::{Areas, Context, Direction, Effort, Fact, SurfaceFacts, Tabs};
use crate::cutting::{CuttingWork, Engagement};
use crate::numbers::shown;
use crate::{JobError, OperationKeys, Scene};

/// What an operation's passes are, for a table of cutting data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machining {
    /// The work.
    pub work: CuttingWork,
    /// How the tool is engaged, as far as the operation's keys state that.
    pub engagement: Engagement,
    /// Rise of a thread that is tapped, mm per revolution.
    pub pitch: Option<f64>,
}

/// A kind of operation, with its own keys.
pub trait OperationKind {
    /// Checks its own keys and their relation to the common ones, beyond types and ranges; `path` is the operation's.
    ///
    /// # Errors
    /// Keys that contradict each other.
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError>;

    /// Whether faces = "all" means upright walls too, where material is cut.
    fn cuts_upright_walls(&self) -> bool;

    /// Whether its tool leans: what it owes its faces is measured along them and not from above, and they may face down.
    fn leans(&self) -> bool {
        false
    }

    /// Plans its moves.
    ///
    /// # Errors
    /// Nothing is reached, the tolerance is used up, `Cancelled`.
    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError>;

    /// The feed along its passes, mm/min.
    fn cut_feed(&self, common: &OperationKeys) -> f64 {
        common.feeds.cut
    }

    /// The work that its passes are, and how its tool is engaged, as far as its keys state that.
    fn cutting(&self) -> Machining {
        Machining { work: CuttingWork::FinishMilling, engagement: Engagement::default(), pitch: None }
    }

    /// The feed straight down, mm/min; `rpm` is the spindle's.
    fn plunge_feed(&self, common: &OperationKeys, _rpm: Option<f64>) -> f64 {
        common.feeds.plunge
    }

    /// Whether what it leaves of its faces is asked from above.
    fn owes_faces(&self) -> bool {
        !self.leans()
    }

    /// The highest of its feeds, mm/min, where they depend on what is cut.
    fn highest_feed(&self, _common: &OperationKeys) -> Option<f64> {
        None
    }

    /// Whether it goes on higher up after a part of the sheet is finished.
    fn comes_back_up(&self) -> bool {
        false
    }

    /// Whether its path is for a part that the spindle turns.
    fn turns_part(&self) -> bool {
        false
    }

    /// The tabs that its passes leave.
    fn tabs(&self) -> Option<Tabs> {
        None
    }

    /// What its lateral feeds owe the part.
    fn contact(&self) -> Contact;

    /// Checks that the part has what its passes follow beyond faces, for planning and for the verifier; `path` is the operation's.
    ///
    /// # Errors
    /// It has not.
    fn check_part(&self, _given: &PassContext<'_>, _are_named: bool, _path: &str) -> Result<(), JobError> {
        Ok(())
    }

    /// How its passes lie, for the verifier.
    fn passes(&self, given: &PassContext<'_>) -> Passes;

    /// Whether its passes form a sheet in layers.
    fn forms_in_layers(&self) -> bool {
        false
    }

    /// Layers in which its passes form a sheet, for the verifier; none where they are in none.
    fn layers(&self, _given: &PassContext<'_>) -> Option<Layers> {
        None
    }

    /// How far its passes lie apart, where they lie in step.
    fn spacing(&self) -> Option<PassSpacing>;

    /// What planning it takes, from the areas of its faces; none where nothing is known.
    fn effort(&self, areas: &Areas) -> Option<Effort>;
}

/// What the verifier's expectation of an operation's passes depends on besides its own keys.
#[derive(Clone, Copy)]
pub struct PassContext<'a> {
    /// The part as it lies on the machine.
    pub scene: &'a Scene,
    /// The faces of the operation.
    pub faces: &'a [u32],
    /// How far passes may be off the part on either side, mm.
    pub tolerance: f64,
    /// No pass is missed that holds a disc of this diameter, mm.
    pub smallest_feature: f64,
    /// Height from which levels count: the operation's, or the sheet's (the part's) highest point, work coordinates, mm.
    pub top: f64,
    /// The lowest tip, where the operation states it, work coordinates, mm.
    pub bottom: Option<f64>,
    /// The tool, with the sheet that it touches.
    pub body: &'a ToolBody,
    /// Stock that stays on walls, and under the tool, mm.
    pub to_leave: [f64; 2],
    /// In which direction its passes are run.
    pub direction: Direction,
}

impl<'a> PassContext<'a> {
    /// As an operation is planned, with its tool's body.
    pub(super) fn of(context: &'a Context<'_>, body: &'a ToolBody) -> Self {
        Self {
            scene: context.scene,
            faces: &context.faces,
            tolerance: context.common.tolerance,
            smallest_feature: context.common.smallest_feature,
            top: context.heights.top.unwrap_or(context.scene.top),
            bottom: context.common.z_bottom,
            body,
            to_leave: context.common.stock_to_leave(),
            direction: context.common.direction,
        }
    }
}

/// What is known of a kind without its keys.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// What it is for, in a few words that follow its name: "for walls".
    pub purpose: &'static str,
    /// What a starter job takes it for.
    pub serves: Serves,
    /// Its own keys as lines of a starter job, each with its comment.
    pub starter: fn(StarterPasses) -> String,
}

/// What a starter job takes a kind for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Serves {
    /// Walls of solids, and sheets.
    Walls,
    /// Floors and gentle slopes of solids.
    Floors,
    /// Stock over solids, before they are finished.
    Stock,
    /// Round upright holes.
    Holes,
    /// Nothing: it is there for who asks for it.
    OnRequest,
}

/// How a starter job's passes lie.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StarterPasses {
    /// Distance between passes, mm.
    pub pitch: f64,
    /// Direction of straight passes from X, degrees.
    pub angle_deg: f64,
    /// Depth of a peck of holes that are too deep for one, mm.
    pub peck: Option<f64>,
    /// By how much holes are wider than the tool, mm.
    pub wider: f64,
}

/// A planned operation.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Its moves.
    pub moves: Vec<Move>,
    /// What happens behind moves: their numbers, ascending, and what.
    pub events: Vec<(usize, EventKind)>,
    /// Its holes by canned cycles; `first` counts its own moves.
    pub cycles: Vec<Cycle>,
    /// Its extent for the summary: "30 loops on 12 levels".
    pub words: String,
    /// Its extent for the program's header: "12 levels, 30 passes".
    pub note: String,
    /// Its figures.
    pub facts: Vec<Fact>,
    /// What becomes of the faces, where it follows faces.
    pub surface: Option<SurfaceFacts>,
}

/// The distance between neighbouring passes, and in what.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "in", rename_all = "kebab-case")]
pub enum PassSpacing {
    /// In height.
    Height {
        /// mm.
        pitch: f64,
    },
    /// In plan, across straight rows.
    Across {
        /// mm.
        pitch: f64,
        /// Direction of the rows from X, degrees.
        direction_deg: f64,
    },
}

impl PassSpacing {
    /// The same with its words: "levels 0.5 mm apart".
    #[must_use]
    pub fn described(&self) -> impl Serialize {
        #[derive(Serialize)]
        struct Described {
            #[serde(flatten)]
            spacing: PassSpacing,
            words: String,
        }
        let words = match *self {
            Self::Height { pitch } => format!("levels {} mm apart", shown(pitch)),
            Self::Across { pitch, direction_deg } => {
                format!("rows {} mm apart at {} deg", shown(pitch), shown(direction_deg))
            }
        };
        Described { spacing: *self, words }
    }
}
