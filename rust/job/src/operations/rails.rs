//! Between which curves a ruled surface is milled: those of faces, of edges, or stated ones.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Mesh, NurbsCurve, Vector};

use super::Context;
use crate::{JobError, Scene};

/// The two curves between whose points of equal parameter the straight lines of a surface run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rails {
    /// Two edges of the part by their names, as FreeCAD shows them: ["Edge3", "Edge7"].
    Edges([String; 2]),
    /// Two curves, in the frame of the part's file.
    Curves([CurveKeys; 2]),
}

/// A B-spline curve, rational or not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveKeys {
    /// Poles, mm.
    #[schemars(length(min = 2), extend("x-unit" = "mm", "minimum" = -100000.0, "maximum" = 100000.0))]
    pub poles: Vec<[f64; 3]>,
    /// Degree; one less than there are poles when left out: a Bezier curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 1, "maximum" = 25))]
    pub degree: Option<usize>,
    /// Knots, as often as they count; evenly spaced between the ends when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1", "minimum" = -1000000.0, "maximum" = 1000000.0))]
    pub knots: Option<Vec<f64>>,
    /// A weight for each pole; 1 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0, "maximum" = 1000000.0))]
    pub weights: Option<Vec<f64>>,
}

/// The side of a surface on which the tool moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FlankSide {
    /// To the left, seen along the rails with the second above the first.
    Left,
    /// To the right.
    Right,
}

/// A ruled surface in work coordinates: the first of its rails is the lower one.
#[derive(Clone, Debug)]
pub(super) struct RuledSurface {
    /// As a person names it: "Face3".
    pub name: String,
    /// The face that it is, if it is one.
    pub face: Option<u32>,
    pub rails: [NurbsCurve; 2],
    pub is_left: bool,
}

impl RuledSurface {
    /// The surfaces between stated rails, or of faces: of a selection by rule, those that are ruled.
    ///
    /// # Errors
    /// Faces that are not ruled, edges that are none, curves that are none; `path` is the operation's.
    pub fn all(
        rails: Option<&Rails>,
        side: Option<FlankSide>,
        (scene, faces, are_named): (&Scene, &[u32], bool),
        path: &str,
    ) -> Result<Vec<Self>, JobError> {
        let Some(rails) = rails else {
            let is_meant = |face: &&u32| are_named || scene.curves.ruled.contains_key(face);
            return faces.iter().filter(is_meant).map(|face| Self::of_face(scene, *face, path)).collect();
        };
        let (name, found) = match rails {
            Rails::Edges(names) => {
                let of_edge = |name: &String| edge(scene, name, &format!("{path}.rails.edges"));
                (names.join(" to "), [of_edge(&names[0])?, of_edge(&names[1])?])
            }
            Rails::Curves(curves) => {
                let at = |i: usize| curves[i].curve(&format!("{path}.rails.curves[{i}]"));
                ("the stated rails".to_owned(), [at(0)?, at(1)?])
            }
        };
        let side = side.ok_or_else(|| {
            let message = "rails do not tell on which side of their surface the tool moves";
            let hint = "set side = \"left\" or \"right\", seen along the rails with the upper one above the lower one";
            JobError::document("missing", format!("{path}.side"), message, hint)
        })?;
        let rails = found.map(|rail| rail.placed(&scene.frame));
        Ok(vec![Self { name, face: None, rails: in_order(alike(rails)), is_left: side == FlankSide::Left }])
    }

    fn of_face(scene: &Scene, face: u32, path: &str) -> Result<Self, JobError> {
        let Some(rails) = scene.curves.ruled.get(&face) else {
            let message = format!(
                "Face{face} is not known to be ruled between two curves: planes, meshes, cones to their apex, surfaces that bend both \
                 ways and faces that are cut out of a ruled one are not"
            );
            let hint = "select ruled faces, or state two edges: rails = { edges = [\"Edge3\", \"Edge7\"] }";
            return Err(JobError::document("not-ruled", format!("{path}.faces"), message, hint));
        };
        let rails = in_order(rails.clone().map(|rail| rail.placed(&scene.frame)));
        let is_left = is_left(&scene.mesh, face, &rails);
        Ok(Self { name: format!("Face{face}"), face: Some(face), rails, is_left })
    }
}

impl CurveKeys {
    fn curve(&self, path: &str) -> Result<NurbsCurve, JobError> {
        let degree = self.degree.unwrap_or(self.poles.len().saturating_sub(1));
        let knots = self.knots.clone().unwrap_or_else(|| clamped(self.poles.len(), degree));
        if let Some(weights) = self.weights.as_ref().filter(|weights| weights.len() != self.poles.len()) {
            let message = format!("{} weights for {} poles", weights.len(), self.poles.len());
            return Err(JobError::document("conflict", format!("{path}.weights"), message, "give one for each pole"));
        }
        let weight = |i: usize| self.weights.as_ref().and_then(|weights| weights.get(i)).copied().unwrap_or(1.0);
        let poles: Vec<[f64; 4]> =
            self.poles.iter().enumerate().map(|(i, [x, y, z])| [*x, *y, *z, weight(i)]).collect();
        NurbsCurve::new(degree, knots, &poles).map_err(JobError::geometry(path))
    }
}

/// Knots that are evenly spaced between the ends.
fn clamped(poles: usize, degree: usize) -> Vec<f64> {
    let spans = poles.saturating_sub(degree).max(1);
    let inner = (1..spans).map(|i| i as f64 / spans as f64);
    let ends = |value: f64| std::iter::repeat_n(value, degree + 1);
    ends(0.0).chain(inner).chain(ends(1.0)).collect()
}

/// The curve of a named edge, in the frame of the part's file; `path` is that of the name.
///
/// # Errors
/// "unknown".
pub(super) fn edge(scene: &Scene, name: &str, path: &str) -> Result<NurbsCurve, JobError> {
    let number = name.strip_prefix("Edge").unwrap_or(name).parse::<usize>().ok();
    let found = number.and_then(|number| scene.curves.edges.get(number.checked_sub(1)?)).and_then(Option::clone);
    found.ok_or_else(|| {
        let message = match scene.curves.edges.len() {
            0 => format!("{name:?} names an edge, and this part has none: it is a mesh, or its shape was changed"),
            count => format!("the part has no edge {name:?} with a curve: it has Edge1 to Edge{count}"),
        };
        JobError::document("unknown", path, message, "name edges as FreeCAD shows them")
    })
}

/// The curves of the edges that an operation at `path` names in `edge_names`.
pub(super) fn edges(scene: &Scene, names: &[String], path: &str) -> Result<Vec<NurbsCurve>, JobError> {
    if names.is_empty() {
        let hint = "name edges: edge_names = [\"Edge3\"], or remove edge_names: then those of the faces are taken";
        return Err(JobError::document("missing", format!("{path}.edge_names"), "no edge is named", hint));
    }
    let curve = |(i, name): (usize, &String)| edge(scene, name, &format!("{path}.edge_names[{i}]"));
    names.iter().enumerate().map(curve).collect()
}

fn ends(rail: &NurbsCurve) -> [Vector; 2] {
    rail.domain().map(|at| rail.at(at).point)
}

/// Both rails in one direction: edges run as their CAD system made them.
fn alike([first, second]: [NurbsCurve; 2]) -> [NurbsCurve; 2] {
    let ([a, b], [c, d]) = (ends(&first), ends(&second));
    if (c - a).norm() + (d - b).norm() > (d - a).norm() + (c - b).norm() {
        let second = second.reversed();
        return [first, second];
    }
    [first, second]
}

/// The lower rail first: there the tool's tip is.
fn in_order([first, second]: [NurbsCurve; 2]) -> [NurbsCurve; 2] {
    let height = |rail: &NurbsCurve| {
        let [from, to] = rail.domain();
        (0..=8).map(|i| rail.at(from + (to - from) * f64::from(i) / 8.0).point.z).sum::<f64>()
    };
    if height(&second) < height(&first) {
        return [second, first];
    }
    [first, second]
}

/// Whether the outside of a face is on the left of its rails.
fn is_left(mesh: &Mesh, face: u32, rails: &[NurbsCurve; 2]) -> bool {
    let [a, b] = [0, 1].map(|i| {
        let [from, to] = rails[i].domain();
        rails[i].at(0.5 * (from + to))
    });
    let middle = (a.point + b.point) * 0.5;
    let normal = (b.point - a.point).cross(&(a.first + b.first));
    let of_face = (0..mesh.triangles().len()).filter(|triangle| mesh.faces()[*triangle] == face);
    let apart = |triangle: &usize| (mesh.corners(*triangle).iter().sum::<Vector>() / 3.0 - middle).norm_squared();
    let nearest = of_face.min_by(|a, b| apart(a).total_cmp(&apart(b)));
    nearest.is_some_and(|triangle| mesh.normal(triangle).dot(&normal) > 0.0)
}

impl Context<'_> {
    /// The ruled surfaces of the operation.
    pub(super) fn ruled_surfaces(
        &self,
        rails: Option<&Rails>,
        side: Option<FlankSide>,
    ) -> Result<Vec<RuledSurface>, JobError> {
        RuledSurface::all(rails, side, (self.scene, &self.faces, self.are_faces_named), &self.path)
    }
}
