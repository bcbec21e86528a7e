//! Cones and paths on them, from closed forms.
use std::f64::consts::{FRAC_PI_4, TAU};

use styluscam_geometry::{kinds, Bvh, Cutter, Mesh, ProfileDocument, Sheet, Tool, ToolDocument, Vector};
use styluscam_motion::{
    Event, EventKind, Move, MoveKind, OperationRecord, Program, SetupRecord, ToolRecord, ToolReference,
};
use styluscam_verify::{Contact, Expectation, ExpectedOperation, Limits, Passes, Region, Subject};

/// Height at and above which rapids travel.
pub const CLEARANCE: f64 = 10.0;
/// Slope of all cones here.
pub const SLOPE: f64 = FRAC_PI_4;

/// A part and its index.
pub struct Part {
    pub mesh: Mesh,
    pub bvh: Bvh,
}

impl Part {
    pub fn new(vertices: Vec<Vector>, triangles: &[[i64; 3]]) -> Self {
        let mesh = Mesh::new(vertices, triangles, &[]).unwrap();
        let bvh = Bvh::new(&mesh);
        Self { mesh, bvh }
    }

    /// A funnel (`inner`) or a hill of slope 45 degrees: rings of radius `low` at Z `-(high - low)` for the funnel and
    /// 0 for the hill, to `high`. Funnel: facets touch the true cone in their middles. Hill: in their corners.
    pub fn cone(inner: bool, low: f64, high: f64, segments: usize, rings: usize) -> Self {
        let mut vertices = Vec::new();
        for ring in 0..=rings {
            let radius = low + (high - low) * ring as f64 / rings as f64;
            let z = if inner { radius - high } else { low - radius };
            let scale = if inner { 1.0 / (TAU / 2.0 / segments as f64).cos() } else { 1.0 };
            for i in 0..segments {
                let (sin, cos) = (TAU * i as f64 / segments as f64).sin_cos();
                vertices.push(Vector::new(radius * scale * cos, radius * scale * sin, z));
            }
        }
        let at = |ring: usize, i: usize| (ring * segments + i % segments) as i64;
        let mut triangles = Vec::new();
        for ring in 0..rings {
            for i in 0..segments {
                let (a, b, c, d) = (at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        Self::new(vertices, &triangles)
    }

    pub fn subject<'a>(&'a self, tools: &'a [Tool]) -> Subject<'a> {
        Subject {
            mesh: &self.mesh,
            bvh: &self.bvh,
            tools,
            sheet: None,
            stock: None,
            stock_is_stated: false,
            before: None,
            deviation_inward: 0.0,
            deviation_outward: 0.0,
            wcs: "G54",
            unknown_positions: &[],
            axes: None,
            text: None,
            expected: &[],
            obstacles: &[],
            pairing: styluscam_verify::Pairing::Alone,
        }
    }
}

pub fn ball(diameter: f64) -> Tool {
    tool(ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }))
}

pub fn clothoid(diameter: f64) -> Tool {
    tool(ProfileDocument::from(kinds::Clothoid {
        diameter: Some(diameter),
        scale: None,
        end_slope_deg: None,
        tip_flat: 0.0,
    }))
}

pub fn tool(profile: ProfileDocument) -> Tool {
    Tool::new(ToolDocument::of(profile)).unwrap()
}

/// What a job states for its one operation, of all triangles.
pub fn expected(part: &Part, contact: Contact, heights: [f64; 2], passes: Passes) -> [ExpectedOperation; 1] {
    let selected = vec![true; part.mesh.triangles().len()];
    let expectation = Expectation {
        contact,
        selected,
        region: Region::default(),
        to_leave: [0.0; 2],
        heights,
        passes,
        forms: false,
        layers: None,
        tabs: None,
    };
    let id = "walls".to_owned();
    [ExpectedOperation {
        id,
        tool: 0,
        cut: 600.0,
        plunge: 600.0,
        leads: None,
        low_links: None,
        highest: None,
        slows_at_corners: false,
        keeps_pace: false,
        spindle: None,
        max_corner: None,
        flood: false,
        expectation,
    }]
}

pub fn limits() -> Limits {
    Limits::new(CLEARANCE)
}

/// Moves in the making.
pub struct Path {
    pub moves: Vec<Move>,
}

impl Path {
    pub fn new() -> Self {
        Self { moves: Vec::new() }
    }

    pub fn rapid(mut self, end: [f64; 3]) -> Self {
        self.push(MoveKind::Rapid, end, 0.0);
        self
    }

    pub fn feed(mut self, end: [f64; 3]) -> Self {
        self.push(MoveKind::Feed, end, 600.0);
        self
    }

    /// Lines count from 11.
    fn push(&mut self, kind: MoveKind, end: [f64; 3], feed: f64) {
        let line = self.moves.len() as u32 + 11;
        self.moves.push(Move::new(kind, end, feed).on_line(line));
    }

    /// The program of one tool; at its end the tool is up.
    pub fn program(mut self, tool: &Tool) -> Program {
        if let Some(last) = self.moves.last().filter(|m| m.end.tip[2] < CLEARANCE) {
            let [x, y, _] = last.end.tip;
            self = self.rapid([x, y, CLEARANCE]);
        }
        let record = ToolRecord {
            name: "stylus".to_owned(),
            number: 1,
            length_offset: 1,
            description: tool.description(),
            reference: ToolReference::Tip,
            reference_height: 0.0,
            diameter: tool.diameter(),
        };
        let setup = SetupRecord { wcs: "G54".to_owned(), clearance: CLEARANCE, ..SetupRecord::default() };
        let operations = vec![OperationRecord { id: "walls".to_owned(), kind: "z-level".to_owned(), tool: 0 }];
        Program {
            moves: self.moves,
            events: vec![Event { before: 0, kind: EventKind::ToolChange { tool: 0 } }],
            ..Program::empty(setup, vec![record], operations)
        }
    }
}

/// The tip that touches a cone at a point, with a sheet between, `off` mm off along the normal.
pub fn tip_on_cone(cutter: &Cutter, sheet: Option<&Sheet>, inner: bool, contact: Vector, off: f64) -> [f64; 3] {
    let (r, z) = cutter.point_at(SLOPE);
    let out = Vector::new(contact.x, contact.y, 0.0).normalize();
    let level = if inner { -out } else { out };
    let normal = level * SLOPE.sin() + Vector::z() * SLOPE.cos();
    let normal_part = sheet.map_or(0.0, Sheet::along_normal) + off;
    let vertical_part = sheet.map_or(0.0, Sheet::along_vertical);
    let tip = contact + normal * normal_part + level * r + Vector::z() * (vertical_part - z);
    tip.into()
}

/// Z-levels over the middle of [`Part::cone`]'s cone of the same `low` and `high`: down to each, round it, up again. `off` mm off along the normal.
pub struct Levels<'a> {
    pub tool: &'a Tool,
    pub sheet: Option<Sheet>,
    pub inner: bool,
    pub low: f64,
    pub high: f64,
    pub levels: usize,
    pub points: usize,
    pub off: f64,
}

impl Levels<'_> {
    pub fn path(&self) -> Path {
        let cutter = self.tool.cutter();
        let mut path = Path::new();
        for level in 0..self.levels {
            let share = 0.1 + 0.8 * (level as f64 + 0.5) / self.levels as f64;
            let radius = self.low + (self.high - self.low) * share;
            let z = if self.inner { radius - self.high } else { self.low - radius };
            let tip = |i: usize| {
                let (sin, cos) = (TAU * i as f64 / self.points as f64 + 0.001).sin_cos();
                let contact = Vector::new(radius * cos, radius * sin, z);
                tip_on_cone(&cutter, self.sheet.as_ref(), self.inner, contact, self.off)
            };
            let first = tip(0);
            path = path.rapid([first[0], first[1], CLEARANCE]).feed(first);
            for i in 1..=self.points {
                path = path.feed(tip(i));
            }
            path = path.rapid([first[0], first[1], CLEARANCE]);
        }
        path
    }
}
