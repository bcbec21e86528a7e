//! Chamfer: sharp edges between level faces and walls, by the cone of a tool; a small one deburrs.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{chamfered, check_chamfers, ChamferEdge, ChamferSize, NurbsCurve, ToolBody, Vector};
use styluscam_motion::{Move, Role, SpindleDirection};
use styluscam_toolpath::chamfer::{followed, stretches, Edge, Stretch};
use styluscam_toolpath::offset::Index;
use styluscam_verify::{ChamferedEdge, Chamfering, Contact, Passes};

use super::budget;
use super::facts::{self, counted};
use super::in_order::in_order;
use super::keys;
use super::rails;
use super::room::Room;
use super::{
    About, Areas, Context, Direction, Effort, Fact, Fit, LeadForm, LinkHeight, OperationKind, PassContext, PassSpacing,
    Planned, Serves,
};
use crate::level_edges::{has_curve, level_edges, EdgeChain, EdgePiece, MOST_LEAN};
use crate::limits::GOUGE;
use crate::{JobError, OperationKeys, Scene};

/// Cones have more than this angle from the axis and from the level, rad.
const LEAST_TURN: f64 = 0.02;
/// By how much a wall is steeper than the cone at least, rad.
const STEEPER: f64 = 0.05;
/// Rise over run of ramps down onto an edge: 10 degrees.
const ENTRY: f64 = 0.176;
/// Air between cone and edge where the tool has come straight down, mm.
const AIR: f64 = 0.2;
/// Chords about corners go so far out at most, mm.
const CHORDS: f64 = 0.002;
/// Walls that lean out by less are upright, rad.
const UPRIGHT: f64 = 1e-6;
/// Heights that differ by less are the same, mm.
const SAME: f64 = 1e-5;
/// Positions of an edge are looked at so far apart at most, mm.
const APART: f64 = 0.4;

/// Chamfers the sharp edges between the level ones of the selected faces and the walls that go down from them, with the cone of a tool:
/// the chamfer has its angle. The model has the edges sharp. What the tool cannot reach without entering what is beside it is left, and
/// listed. All directions but conventional are climb.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chamfer {
    /// Width of the chamfer, mm, measured level; some tenths deburr.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 100.0, "x-example" = "0.5"))]
    pub width: f64,
    /// How far the lower end of the tool's cone is below the chamfer, mm: so its side cuts, and not its tip.
    #[serde(default = "tip_offset")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub tip_offset: f64,
    /// The edges by their names, as FreeCAD shows them: ["Edge3", "Edge7"]; all edges of the selected level faces when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub edge_names: Option<Vec<String>>,
}

/// What is chamfered, and how the tool stands to it.
struct Work {
    chains: Vec<EdgeChain>,
    size: ChamferSize,
    /// How far the tip is below the edges, mm.
    tip_below: f64,
    /// How far the axis is beside them, mm.
    beside: f64,
}

impl Work {
    fn pieces(&self) -> impl Iterator<Item = &EdgePiece> {
        self.chains.iter().flat_map(|chain| &chain.pieces)
    }

    fn edges(&self) -> Vec<ChamferEdge> {
        self.pieces().map(|piece| piece.edge).collect()
    }

    /// The depth of the deepest chamfer, mm.
    fn depth(&self) -> f64 {
        deepest(&self.chains, self.size)
    }
}

fn deepest(chains: &[EdgeChain], size: ChamferSize) -> f64 {
    chains.iter().flat_map(|chain| &chain.pieces).map(|piece| size.depth(piece.edge.lean)).fold(0.0, f64::max)
}

/// A tool's cone.
#[derive(Clone, Copy)]
struct Cone {
    /// From the axis, rad.
    half_angle: f64,
    /// Radius and height over the tip of its lower end and of its upper one, mm.
    ends: [(f64, f64); 2],
}

impl Cone {
    /// The longest of a tool.
    fn of(body: &ToolBody) -> Option<Self> {
        let is_cone = |slope: f64| slope > LEAST_TURN && slope < std::f64::consts::FRAC_PI_2 - LEAST_TURN;
        let cones = body.straights().iter().filter(|straight| is_cone(straight.slope));
        let longest = cones.max_by(|a, b| (a.outer.0 - a.inner.0).total_cmp(&(b.outer.0 - b.inner.0)))?;
        let half_angle = std::f64::consts::FRAC_PI_2 - longest.slope;
        Some(Self { half_angle, ends: [longest.inner, longest.outer] })
    }

    /// Radius at a height over the tip, mm.
    fn radius_at(&self, height: f64) -> f64 {
        let (radius, foot) = self.ends[0];
        radius + (height - foot) * libm::tan(self.half_angle)
    }
}

impl Chamfer {
    pub(super) const ABOUT: About = About {
        purpose: "for sharp edges of level faces, with a V tool",
        serves: Serves::OnRequest,
        starter: |_| "width = 0.5               # of the chamfer, measured level\n".to_owned(),
    };

    fn size(&self, cone: Cone) -> ChamferSize {
        ChamferSize { width: self.width, half_angle: cone.half_angle }
    }

    fn curves(&self, scene: &Scene, path: &str) -> Result<Option<Vec<NurbsCurve>>, JobError> {
        self.edge_names.as_ref().map(|names| rails::edges(scene, names, path)).transpose()
    }

    /// What is chamfered of the faces; `path` is the operation's.
    fn work(&self, given: &PassContext<'_>, path: &str) -> Result<Work, JobError> {
        let cone = Cone::of(given.body).ok_or_else(|| {
            let message = "the tool has no cone: a chamfer is cut by the straight slope of its profile";
            let hint = "take a tool of kind \"v\", \"cone\" or \"tapered-ball\"";
            JobError::document("no-cone", format!("{path}.tool"), message, hint)
        })?;
        let size = self.size(cone);
        let curves = self.curves(given.scene, path)?;
        let chains = level_edges(given.scene, given.faces, curves.as_deref(), cone.half_angle - STEEPER);
        self.check_found(given, &chains, curves.as_deref(), (cone, path))?;
        let depth = deepest(&chains, size);
        let ([(_, foot), (_, rim)], tip) = (cone.ends, self.tip_offset);
        let tip_below = foot + tip + depth;
        if tip_below > rim + SAME {
            let most = (rim - foot - tip).max(0.0) * self.width / depth;
            let message = format!(
                "the chamfer and tip_offset take {:.3} mm of the height of the tool's cone, which has {:.3} mm",
                depth + tip,
                rim - foot
            );
            let hint = format!("lower width to {most:.3}, lower tip_offset, or take a wider tool");
            return Err(JobError::document("narrow-tool", format!("{path}.width"), message, hint));
        }
        let beside = cone.radius_at(tip_below) - self.width;
        Ok(Work { chains, size, tip_below, beside })
    }

    /// Refuses faces without edges, and named edges that are none.
    fn check_found(
        &self,
        given: &PassContext<'_>,
        chains: &[EdgeChain],
        curves: Option<&[NurbsCurve]>,
        (cone, path): (Cone, &str),
    ) -> Result<(), JobError> {
        let scene = given.scene;
        let steeper = || level_edges(scene, given.faces, curves, MOST_LEAN);
        let flat = |name: &str, key: &str| {
            let message = format!(
                "the wall under {name} leans so far that a cone of {:.1} degrees from its axis makes no chamfer there",
                cone.half_angle.to_degrees()
            );
            JobError::document("flat-wall", format!("{path}.{key}"), message, "take a tool with a wider angle")
        };
        for (i, (curve, name)) in curves.unwrap_or_default().iter().zip(self.edge_names.iter().flatten()).enumerate() {
            if has_curve(scene, chains, curve) {
                continue;
            }
            let key = format!("edge_names[{i}]");
            if has_curve(scene, &steeper(), curve) {
                return Err(flat(name, &key));
            }
            let message =
                format!("{name} is no sharp edge between one of the level faces and a wall that goes down from it");
            let hint = "name such edges only, and select the level face beside them, or faces = \"all\"";
            return Err(JobError::document("no-edge", format!("{path}.{key}"), message, hint));
        }
        if !chains.is_empty() {
            return Ok(());
        }
        if !steeper().is_empty() {
            return Err(flat("every edge", "tool"));
        }
        let message = "none of the faces is level and has a sharp edge from which a wall goes down";
        Err(JobError::document("no-edge", format!("{path}.faces"), message, "select level faces beside sharp edges"))
    }
}

impl OperationKind for Chamfer {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let refused = [
            ("boundary", common.boundary.is_some()),
            ("check_faces", common.check_faces.is_some()),
            ("max_corner_deg", common.max_corner_deg.is_some()),
            ("edges", common.edges.is_some()),
            ("lead", common.lead != LeadForm::None),
            ("links", common.links != LinkHeight::Clearance),
            ("z_top", common.z_top.is_some()),
            ("z_bottom", common.z_bottom.is_some()),
            ("fit", common.fit != Fit::Lines),
            ("slow_corners", common.slow_corners),
            ("radial_stock_to_leave", common.radial_stock_to_leave > 0.0),
            ("axial_stock_to_leave", common.axial_stock_to_leave > 0.0),
        ];
        keys::refuse(&refused, path, |key| {
            let message =
                format!("chamfering does not follow {key}: it goes along edges, at a depth that follows from width");
            (message, format!("remove {key}"))
        })
    }

    fn cuts_upright_walls(&self) -> bool {
        false
    }

    fn owes_faces(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        let body = context.tool.body(None);
        let given = PassContext::of(context, &body);
        let work = self.work(&given, &context.path)?;
        let margin = margin(context)?;
        let shape = chamfered(&context.scene.mesh, &work.edges(), work.size)
            .map_err(JobError::geometry(format!("{}.width", context.path)))?;
        let index = Index::new(&shape);
        let room = Room::new(context, (&shape, &index), margin);
        let beside = work.beside + margin / libm::cos(work.size.half_angle);
        let is_climb = given.direction != Direction::Conventional;
        let is_back = context.common.spindle.direction() == Some(SpindleDirection::Counterclockwise);
        let (mut found, mut missed) = (Vec::new(), BTreeMap::new());
        for chain in &work.chains {
            let Some(top) = chain.pieces.first().map(|piece| piece.edge.ends[0].z) else { continue };
            let tip = top - work.tip_below;
            let is_free = |[x, y]: [f64; 2]| room.is_free([x, y, tip]);
            missed_of(chain, beside, is_free, &mut missed);
            let edge = edge_of(chain, is_climb == is_back);
            let all = stretches(&edge, beside, CHORDS.min(context.common.tolerance * 0.4), is_free, context.watch)?;
            found.extend(all.into_iter().map(|stretch| (stretch, tip)));
        }
        if found.is_empty() {
            let message = "the tool can go along none of the edges without entering what is beside them";
            let hint = "lower tip_offset or width, or take a tool with a narrower tip";
            return Err(JobError::document("no-room", format!("{}.tool", context.path), message, hint));
        }
        moved(context, &work, &found, &missed)
    }

    fn contact(&self) -> Contact {
        Contact::Clear // of the part as it is to be made: the verifier looks at the edges one by one
    }

    fn check_part(&self, given: &PassContext<'_>, _are_named: bool, path: &str) -> Result<(), JobError> {
        if given.scene.sheet.is_some() {
            let message = "edges of solids are chamfered, and this job forms a sheet";
            return Err(JobError::document("conflict", path, message, "remove setup.sheet"));
        }
        let work = self.work(given, path)?;
        check_chamfers(&work.edges(), work.size).map_err(JobError::geometry(format!("{path}.width")))
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let Ok(work) = self.work(given, "") else {
            return Passes::Unordered { reason: "the part has no edges that this tool chamfers" };
        };
        let edge = |piece: &EdgePiece| ChamferedEdge { name: piece.name(), edge: piece.edge };
        Passes::Chamfering(Chamfering {
            edges: work.pieces().map(edge).collect(),
            size: work.size,
            tip_below: work.tip_below,
            beside: work.beside,
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // edges lie where the part has them
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None
    }
}

/// How far the path keeps out of the part for what its triangles and rounding take, mm.
fn margin(context: &Context<'_>) -> Result<f64, JobError> {
    budget::of(context.common.tolerance, context.scene, context.machine).map_err(|error| context.error(error))?;
    Ok(context.scene.inward + (budget::rounding(context.machine) - 0.9 * GOUGE).max(0.0))
}

/// A chain as the tool goes along it: in the direction of its pieces, with the level face on the left, or back.
fn edge_of(chain: &EdgeChain, ahead: bool) -> Edge {
    let plan = |point: Vector| [point.x, point.y];
    let mut corners: Vec<[f64; 2]> = chain.pieces.iter().map(|piece| plan(piece.edge.ends[0])).collect();
    if !chain.closed {
        corners.extend(chain.pieces.last().map(|piece| plan(piece.edge.ends[1])));
    }
    if !ahead {
        corners.reverse();
    }
    Edge {
        corners,
        closed: chain.closed,
        left: !ahead,
        rounds: chain.pieces.iter().all(|piece| piece.edge.lean <= UPRIGHT),
    }
}

/// Adds the length of each edge at which the tool is not free, by its name.
fn missed_of(chain: &EdgeChain, beside: f64, is_free: impl Fn([f64; 2]) -> bool, missed: &mut BTreeMap<String, f64>) {
    for piece in &chain.pieces {
        let (edge, length) = (&piece.edge, piece.edge.length());
        let count = (length / APART).ceil().max(4.0);
        let at = |i: usize| {
            let point = edge.ends[0] + edge.along() * (length * (i as f64 + 0.5) / count) - beside * edge.inward;
            [point.x, point.y]
        };
        let stopped = (0..count as usize).filter(|i| !is_free(at(*i))).count();
        if stopped > 0 {
            *missed.entry(piece.name()).or_insert(0.0) += length * stopped as f64 / count;
        }
    }
}

/// The moves along stretches, each with its height, mm.
fn moved(
    context: &Context<'_>,
    work: &Work,
    found: &[(Stretch, f64)],
    missed: &BTreeMap<String, f64>,
) -> Result<Planned, JobError> {
    let begin = |(stretch, _): &(Stretch, f64)| stretch.points.first().copied().unwrap_or_default();
    let (found, across) = in_order(context, found, begin)?;
    let (scene, feeds) = (context.scene, &context.common.feeds);
    let rise = work.depth() + AIR;
    let mut moves = Vec::new();
    for (stretch, tip) in &found {
        let [down, along, up] = followed(stretch, *tip, [rise, rise / ENTRY]);
        let (Some(first), Some(last)) = (down.first().copied(), up.last().copied()) else { continue };
        let over = |height: f64| [first.x, first.y, height];
        moves.extend([scene.clearance, scene.retract.max(first.z)].map(|height| Move::rapid(over(height))));
        if first.z < scene.retract {
            moves.push(Move::feed(first.into(), feeds.plunge));
        }
        let way = |points: Vec<Vector>, role: Role| {
            points.into_iter().skip(1).map(move |point| Move::feed(point.into(), feeds.cut).role(role))
        };
        moves.extend(way(down, Role::Ramp).chain(way(along, Role::Cut)).chain(way(up, Role::Ramp)));
        moves.push(Move::rapid([last.x, last.y, scene.clearance]));
    }
    let length: f64 = found.iter().map(|(stretch, _)| stretch.length()).sum();
    let mut facts = vec![
        Fact::count(found.len(), "pass", "passes"),
        Fact::length("chamfered", length, "along edges"),
        Fact::length("chamfer_depth", work.depth(), "deep"),
    ];
    if across > 0.0 {
        facts.push(Fact::length("across", across, "across from edge to edge"));
    }
    facts.extend(facts::not_reached(missed));
    let words = counted(found.len(), "pass", "passes") + " along " + &counted(work.chains.len(), "edge", "edges");
    Ok(Planned {
        moves: moves.into_iter().map(|step| step.of_operation(context.operation)).collect(),
        events: Vec::new(),
        cycles: Vec::new(),
        note: words.clone(),
        words,
        facts,
        surface: None,
    })
}

fn tip_offset() -> f64 {
    0.5
}
