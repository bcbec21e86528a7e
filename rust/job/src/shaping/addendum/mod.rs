//! The addendum: what of the blank is formed around a part that has no flange, from its edge to the plane in which it is clamped.
//!
//! Derivation: docs/concepts/addendum.md.

mod opening;
mod section;

use std::sync::Arc;

use styluscam_geometry::{walled, Bvh, Frame, Vector, WallEnd, WallFault, WallShape, Walled};
use styluscam_verify::Support;

use crate::faces;
use crate::operations::Fact;
use crate::part::Undone;
use crate::{plates, JobDocument, JobError, Opening, Part, Scene, Shaped};

pub use section::{AddendumEnd, AddendumKind, AddendumSection};

const SECTION: &str = "part.addendum";
/// The name of the wall's face.
const WALL: &str = "Addendum";
/// The name of the face of the level blank around it.
const BLANK: &str = "Blank";

/// Checks what the schema cannot state of the section.
///
/// # Errors
/// A process that forms nothing, springback beside it.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    let Some(section) = &job.part.addendum else {
        if job.output.trim.is_empty() {
            return Ok(());
        }
        let message =
            "output.trim names a file for the curve along which an addendum is cut off, and the part has none";
        return Err(JobError::document(
            "conflict",
            "output.trim",
            message,
            "add [part.addendum], or remove output.trim",
        ));
    };
    let process = &job.process.process;
    if !process.as_kind().forms() {
        let message = format!("process.kind = {:?} cuts, and what is cut needs no addendum", process.name());
        return Err(JobError::document("conflict", SECTION, message, "remove [part.addendum]"));
    }
    if job.part.springback.is_some() {
        let message = "springback is compensated on parts without an addendum only";
        let hint = "remove [part.springback] or [part.addendum]; or model the addendum as a part of the part";
        return Err(JobError::document("conflict", SECTION, message, hint));
    }
    if section.end == AddendumEnd::Opening && section.height.is_some() {
        let message = "the height of an addendum that ends at the opening follows from that, and one is stated";
        let hint = "remove height, or end = \"opening\"";
        return Err(JobError::document("conflict", format!("{SECTION}.height"), message, hint));
    }
    if section.kind == AddendumKind::Blended && section.corner_radius <= 0.0 {
        let message = "kind = \"blended\" joins wall and part by an arc, and corner_radius is 0";
        let hint = "state a radius of the tool's at least, or take kind = \"wall\"";
        return Err(JobError::document("conflict", format!("{SECTION}.corner_radius"), message, hint));
    }
    Ok(())
}

/// The part with its addendum.
pub fn extended(job: &JobDocument, section: &AddendumSection, part: &Part) -> Result<Part, JobError> {
    let frame = job.setup.turn();
    let placed = part.mesh.placed(&frame);
    let rims = faces::rims(&placed);
    let keep: Vec<bool> = (0..rims.len()).map(|t| !rims[t] && !placed.looks_down(t)).collect();
    let shape = WallShape {
        angle: section.wall_angle_deg.to_radians(),
        radius: section.corner_radius,
        blended: section.kind == AddendumKind::Blended,
        end: match (section.end, section.height) {
            (AddendumEnd::Opening, _) => WallEnd::Within(opening::outline(job, &placed, &keep)?),
            (AddendumEnd::Height, Some(height)) => WallEnd::Height(height),
            (AddendumEnd::Height, None) => WallEnd::Least,
        },
        margin: section.flange_width,
        tolerance: job.part.tolerance,
        goes_down: goes_down(job),
    };
    let back = frame.inverse();
    let walled = walled(&placed, &keep, &shape).map_err(|fault| refused(job, section, &fault, &back))?;
    let facts = facts(section, &walled);
    let mesh = walled.mesh.placed(&back);
    let trim = walled.edges.iter().map(|edge| edge.iter().map(|point| back.point(*point)).collect()).collect();
    let shaped = Shaped {
        target: mesh.clone(),
        facts,
        linear: 0.0,
        undone: Undone::Addendum { bvh: Bvh::new(&mesh).into(), first: walled.wall },
        names: vec![(walled.wall, WALL), (walled.blank, BLANK)],
        trim,
    };
    // the addendum is what its triangles are: it is cut off, and no model states it
    Ok(Part { mesh, inward: part.inward, outward: part.outward, shaped: Some(shaped), curves: Arc::default() })
}

/// Whether the blank lies below the part, as a sheet over a male die ends.
fn goes_down(job: &JobDocument) -> bool {
    match job.process.process.as_kind().support() {
        Support::Rim => false,
        Support::DieAndFrame | Support::Mandrel => true,
    }
}

/// Why there is no addendum, and what to do.
fn refused(job: &JobDocument, section: &AddendumSection, fault: &WallFault, back: &Frame) -> JobError {
    let at = |key: &str| format!("{SECTION}.{key}");
    let side = if goes_down(job) { "below" } else { "above" };
    match fault {
        WallFault::NoEdge => {
            let message = "the part has no closed outer edge of faces that face up, from which an addendum could rise";
            JobError::document(
                "no-edge",
                SECTION,
                message,
                "turn the part with setup.up, or close the gaps of its edge",
            )
        }
        WallFault::Flange => {
            let message = "the part's edge lies in a level flange already: it is clamped there, and needs no addendum";
            JobError::document("not-needed", SECTION, message, "remove [part.addendum], or state its height")
        }
        WallFault::Steep { at: point } => steep(back.point(*point), section.wall_angle_deg),
        WallFault::Falls { at: point } => falling(back.point(*point), side),
        WallFault::Outside { beyond } => outside(*beyond),
        WallFault::Beyond { .. } | WallFault::Arc { .. } if section.end == AddendumEnd::Opening => {
            narrow(fault, section.corner_radius)
        }
        WallFault::Beyond { beyond } => {
            let message = format!(
                "the part reaches {beyond:.3} mm {} the blank's plane",
                if goes_down(job) { "under" } else { "over" }
            );
            let hint = format!(
                "set {SECTION}.height to {:.3} at least, or leave it out",
                section.height.unwrap_or(0.0) + beyond
            );
            JobError::document("beyond-blank", at("height"), message, hint)
        }
        WallFault::Arc { least, height } => {
            let message = format!(
                "arcs of corner_radius = {} take {least:.3} mm of height, and the blank's plane lies {height:.3} mm {side} \
                 the part's edge",
                section.corner_radius
            );
            let hint = "raise height, or leave it out; or take a smaller corner_radius";
            JobError::document("no-height", at("height"), message, hint)
        }
        WallFault::Crossed => {
            let message = "the part's outer edge crosses itself as seen from above";
            JobError::document(
                "edge-crosses",
                SECTION,
                message,
                "turn the part with setup.up so that it does not overhang",
            )
        }
        WallFault::TooFine { tolerance } => {
            let message = format!("an addendum within part.tolerance = {tolerance} mm takes too many triangles");
            JobError::document("too-fine", SECTION, message, "raise part.tolerance")
        }
        WallFault::Mesh(error) => JobError::Geometry { error: error.clone(), location: SECTION.to_owned() },
    }
}

/// An edge that no wall of an angle in degrees meets at a point of the part's file.
fn steep(point: Vector, wall_angle_deg: f64) -> JobError {
    let message = format!(
        "the part's edge climbs more steeply than wall_angle_deg = {wall_angle_deg} at X{:.3} Y{:.3} Z{:.3} of its file: no wall of \
         that angle meets it there",
        point.x, point.y, point.z
    );
    let hint = "choose a steeper wall, or turn the part";
    JobError::document("steep-edge", format!("{SECTION}.wall_angle_deg"), message, hint)
}

/// A part that falls outwards at its edge, at a point of its file; the blank's plane lies on that `side` of it.
fn falling(point: Vector, side: &str) -> JobError {
    let other = if side == "below" { "above" } else { "below" };
    let message = format!(
        "the part falls outwards at its edge, at X{:.3} Y{:.3} Z{:.3} of its file: a wall that leaves it by its own slope would go \
         {other} it from there",
        point.x, point.y, point.z
    );
    let hint = "take kind = \"wall\", which may leave the edge with a crease; or turn the part with setup.up";
    JobError::document("falling-edge", format!("{SECTION}.kind"), message, hint)
}

/// A part that is too large for the opening at which its addendum is to end.
fn outside(beyond: f64) -> JobError {
    let message = format!("the part reaches {beyond:.3} mm into the margin inside the backing plate's opening");
    let hint = "state a wider setup.fixture.backing.opening, or where it is, setup.fixture.center";
    JobError::document("beyond-opening", format!("{SECTION}.end"), message, hint)
}

/// An opening that leaves the addendum too little height, as the fault states.
fn narrow(fault: &WallFault, corner_radius: f64) -> JobError {
    let code = if matches!(fault, WallFault::Beyond { .. }) { "beyond-blank" } else { "no-height" };
    let message = format!("{fault}, where a wall with arcs of corner_radius = {corner_radius} ends at the opening");
    let hint = "take a steeper wall_angle_deg, a smaller corner_radius or a wider opening";
    JobError::document(code, format!("{SECTION}.end"), message, hint)
}

/// What the addendum amounts to.
fn facts(section: &AddendumSection, walled: &Walled) -> Vec<Fact> {
    let of_edge = walled.edges.iter().flatten().map(|point| (walled.plane - point.z).abs());
    let height = of_edge.fold(0.0, f64::max);
    let Walled { wall, blank, extent: [low, high], .. } = walled;
    let [x, y] = [0, 1].map(|axis| high[axis] - low[axis]);
    let words = format!(
        "addendum: a wall of {} degrees{}, Face{wall} ({WALL}), up to {height:.3} mm high, in a level blank, Face{blank} ({BLANK})",
        section.wall_angle_deg,
        match section.kind {
            AddendumKind::Wall => "",
            AddendumKind::Blended => ", blended into the part",
        }
    );
    let size = |fact, value| Fact {
        fact,
        value,
        unit: "mm",
        words: format!("blank {x:.1} x {y:.1} mm, with {} mm around the wall", section.flange_width),
    };
    let length: f64 = walled.edges.iter().map(|edge| length(edge)).sum();
    let [area, plan] = areas(walled);
    let stretch = Fact {
        fact: "area_stretch",
        value: area / plan,
        unit: "",
        words: format!(
            "part and addendum have {:.3} times the area of the blank that they are formed from",
            area / plan
        ),
    };
    let blank_y = Fact { words: format!("blank's width along Y {y:.1} mm"), ..size("blank_y", y) };
    vec![
        Fact { fact: "addendum", value: height, unit: "mm", words },
        size("blank_x", x),
        blank_y,
        Fact {
            fact: "trim_length",
            value: length,
            unit: "mm",
            words: format!("trim curve {length:.1} mm long, the part's edge"),
        },
        stretch,
    ]
}

fn length(edge: &[Vector]) -> f64 {
    let next = edge.iter().cycle().skip(1);
    edge.iter().zip(next).map(|(a, b)| (b - a).norm()).sum()
}

/// Area of the part's upper side with the wall, and in plan, mm^2.
fn areas(Walled { mesh, formed, .. }: &Walled) -> [f64; 2] {
    let formed = (0..formed.len()).filter(|triangle| formed[*triangle]);
    formed.fold([0.0; 2], |[area, plan], triangle| {
        [area + mesh.area(triangle), plan + mesh.area(triangle) * mesh.normal(triangle).z.max(0.0)]
    })
}

/// Refuses an addendum whose wall does not end within the plates' openings.
///
/// # Errors
/// By how much it reaches beyond, and what to do.
pub fn fits(job: &JobDocument, scene: &Scene) -> Result<(), JobError> {
    let (Some(_), Some(fixture), None) = (job.part.addendum, scene.fixture, scene.opposite) else { return Ok(()) };
    let Some((wall, _)) = scene.views.iter().find(|(_, view)| view.name == Some(WALL)) else { return Ok(()) };
    let corners = || {
        let faces = scene.mesh.faces().iter().enumerate().filter(|(_, face)| *face == wall);
        faces.flat_map(|(triangle, _)| scene.mesh.corners(triangle))
    };
    let plates: [(&str, Option<Opening>); 2] = [
        ("backing", fixture.backing.map(|backing| backing.opening)),
        ("clamp", fixture.clamp.map(|clamp| clamp.opening)),
    ];
    for (name, opening) in plates {
        let most = opening.and_then(|opening| plates::beyond(scene, opening, corners()));
        let Some(beyond) = most.map(|most| most + fixture.margin).filter(|beyond| *beyond > 0.0) else { continue };
        let message = format!(
            "the addendum reaches {beyond:.3} mm into the margin of {} mm inside setup.fixture.{name}'s opening",
            fixture.margin
        );
        let hint = "take a steeper wall_angle_deg, less height or a smaller corner_radius, or a wider opening";
        return Err(JobError::document("beyond-opening", SECTION, message, hint));
    }
    Ok(())
}
