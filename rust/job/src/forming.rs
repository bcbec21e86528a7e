//! What is known of the forming of a sheet before its path: how thin it becomes and the force that it takes, and what experience
//! warns of: tools that are too sharp, parts that are too large for the clamp frame, forces that the machine does not withstand.
//!
//! Derived in docs/concepts/forming-processes.md, as are spindles that roll and clamp frames that go down.

use styluscam_geometry::{Tool, Vector};
use styluscam_post::Machine;
use styluscam_verify::{FindingKind, Found, OrderedPasses, Pitch, Severity, Support};

use crate::numbers::shown;
use crate::operations::Fact;
use crate::resolve::{descent_of, faces_of, tools};
use crate::{plates, JobDocument, JobError, OperationSection, Scene};

/// A radius of curvature of so many thicknesses is least: sharper tools shave and tear the sheet.
const LEAST_RADIUS: f64 = 2.0;
/// Lengths that differ by less are equal, mm.
const SAME: f64 = 1e-9;
/// The sheet is as flat as it was down to so far below where it was, mm.
const FLAT: f64 = 1e-3;
/// Slopes at which radii and forces are looked at are this far apart at most, degrees.
const PITCH_DEG: f64 = 1.0;

/// One operation that forms the job's sheet.
struct Forming<'a> {
    scene: &'a Scene,
    tool: &'a Tool,
    section: &'a OperationSection,
    /// Of the sheet, before, mm.
    thickness: f64,
    /// MPa.
    tensile_strength: Option<f64>,
    /// The triangles that it is for.
    selected: Vec<bool>,
    /// Their steepest slope, rad.
    steepest: f64,
    /// Its passes, where each lies below the one before it.
    passes: Option<OrderedPasses>,
}

/// How thin an operation makes the sheet, and with which axial force, as far as that is known.
pub(crate) fn facts(
    job: &JobDocument,
    scene: &Scene,
    tool: &Tool,
    section: &OperationSection,
    selected: &[bool],
) -> (Option<Fact>, Option<Fact>) {
    let Some(forming) = Forming::of(job, scene, tool, section, selected.to_vec()) else { return (None, None) };
    let force = forming.force().map(|force| Fact {
        fact: "axial_force",
        value: force,
        unit: "N",
        words: format!("axial force about {force:.0} N (Aerens et al. 2010)"),
    });
    let is_first = scene.stage.map_or(scene.stages.is_empty(), |stage| stage == 1);
    (if is_first { forming.thinnest() } else { forming.mean_thickness() }, force)
}

/// What to warn of before the path is looked at.
///
/// # Errors
/// Tools that do not build, faces that do not exist.
pub(crate) fn warnings(job: &JobDocument, scene: &Scene, machine: &Machine) -> Result<Vec<Found>, JobError> {
    let found = found_by(job, scene, |forming, id| {
        let strong = machine.limits.max_axial_force.and_then(|most| forming.strong(most, id));
        let large = forming.large_part(job.process.process.as_kind().support(), id);
        forming.sharp_tool().into_iter().chain(large).chain(strong).collect()
    });
    let mut found = found?;
    // what several operations share is reported once
    found.dedup();
    Ok(found)
}

/// What is thinner by its volume than the sheet may become, of a stage or of a part that is formed in stages: for the sine law
/// holds for the first stage only.
///
/// # Errors
/// Tools that do not build, faces that do not exist.
pub(crate) fn thin(job: &JobDocument, scene: &Scene) -> Result<Vec<Found>, JobError> {
    let Some(least) = job.setup.sheet.and_then(|sheet| sheet.min_thickness) else { return Ok(Vec::new()) };
    found_by(job, scene, |forming, id| forming.thin(least, id).into_iter().collect())
}

/// What is found by each operation of a channel that forms, with its name.
fn found_by(
    job: &JobDocument,
    scene: &Scene,
    of: impl Fn(&Forming<'_>, &str) -> Vec<Found>,
) -> Result<Vec<Found>, JobError> {
    let tools = tools(job)?;
    let mut found = Vec::new();
    for (index, section) in job.operations_of(scene.channel) {
        let Some((tool, _)) = tools.get(&section.common.tool) else { continue };
        let selected = scene.facing_up(&faces_of(job, scene, section, index)?);
        let Some(forming) = Forming::of(job, scene, tool, section, selected) else { continue };
        found.extend(of(&forming, &section.id(index)));
    }
    Ok(found)
}

impl<'a> Forming<'a> {
    fn of(
        job: &JobDocument,
        scene: &'a Scene,
        tool: &'a Tool,
        section: &'a OperationSection,
        selected: Vec<bool>,
    ) -> Option<Self> {
        let sheet = job.setup.sheet.filter(|_| job.process.process.as_kind().forms())?;
        let steepest = scene.steepest(&selected);
        let (thickness, tensile_strength) = (sheet.thickness, sheet.tensile_strength);
        // the force is that of a tool on a sheet that hangs free
        let hangs = !job.process.process.as_kind().turns_part();
        let passes = descent_of(job, scene, tool, section).filter(|_| hangs);
        Some(Self { scene, tool, section, thickness, tensile_strength, selected, steepest, passes })
    }

    /// Slopes from level to the steepest, rad.
    fn slopes(&self) -> impl Iterator<Item = f64> {
        let count = (self.steepest.to_degrees() / PITCH_DEG).ceil().max(1.0) as u32;
        let steepest = self.steepest;
        (0..=count).map(move |i| steepest * f64::from(i) / f64::from(count))
    }

    /// How thin the sheet becomes by the sine law, t = t0 cos(wall angle), and where.
    fn thinnest(&self) -> Option<Fact> {
        let mesh = &self.scene.mesh;
        let selected = (0..self.selected.len()).filter(|triangle| self.selected[*triangle]);
        let steepest = selected.max_by(|a, b| mesh.model_normal(*b).z.total_cmp(&mesh.model_normal(*a).z))?;
        let thickness = self.thickness * libm::cos(self.steepest);
        let [x, y, z] = (mesh.corners(steepest).iter().sum::<Vector>() / 3.0).into();
        let words = format!("the sheet becomes {thickness:.3} mm thin by the sine law, at X{x:.3} Y{y:.3} Z{z:.3}");
        Some(Fact { fact: "thinnest", value: thickness, unit: "mm", words })
    }

    /// How thin the sheet becomes on average by its volume over what is not left flat, t = t0 A0 / A, with the area A of its upper
    /// side and A0 in plan: what is formed in stages takes from where it was formed before, and the sine law does not hold for it.
    fn mean_thickness(&self) -> Option<Fact> {
        let thickness = self.mean(|triangle| self.is_formed(triangle))?;
        let words = format!(
            "the sheet becomes {thickness:.3} mm thin on average over what is formed, by its volume; where it is thinnest depends on the stages, and no \
             law states that"
        );
        Some(Fact { fact: "mean_thickness", value: thickness, unit: "mm", words })
    }

    /// The mean thickness of those of its triangles, by their volume, mm; none of no area.
    fn mean(&self, takes: impl Fn(usize) -> bool) -> Option<f64> {
        let mesh = &self.scene.mesh;
        let own = (0..self.selected.len()).filter(|triangle| self.selected[*triangle] && takes(*triangle));
        let [area, plan] = own.fold([0.0; 2], |[area, plan], triangle| {
            [area + mesh.area(triangle), plan + mesh.area(triangle) * mesh.normal(triangle).z.max(0.0)]
        });
        Some(self.thickness * plan / area).filter(|thickness| thickness.is_finite())
    }

    /// Whether a triangle lies where the sheet is not left flat.
    fn is_formed(&self, triangle: usize) -> bool {
        let flat = self.scene.flat - self.scene.sheet.map_or(0.0, |sheet| sheet.raise());
        self.scene.mesh.corners(triangle).iter().any(|corner| corner.z < flat - FLAT)
    }

    /// What is thinner than `least` on average over what is not left flat: wherever the sheet is drawn from, it is thinner still
    /// somewhere.
    fn thin(&self, least: f64, id: &str) -> Option<Found> {
        let thickness = self.mean(|triangle| self.is_formed(triangle)).filter(|thickness| *thickness < least - SAME)?;
        let words = format!(
            "{id} makes the sheet {thickness:.3} mm thin on average over what is formed, by its volume, and min_thickness is {} mm: in \
             whatever stages, it becomes thinner than that; form a less deep part, or a thicker sheet, or accept = [\"thinning\"]",
            shown(least)
        );
        Some((FindingKind::Thinning, Severity::Error, words))
    }

    /// The largest axial force in N, on any of its slopes; none where the strength of the sheet is not known, or the passes do
    /// not go down one below the other.
    ///
    /// R. Aerens, P. Eyckens, A. Van Bael, J. R. Duflou, "Force prediction for single point incremental forming deduced from
    /// experimental and FEM observations", International Journal of Advanced Manufacturing Technology 46, 2010: the steady axial
    /// force on a hemispherical tool in a cone, F = 0.0716 R t^1.57 d^0.41 h^0.09 a cos(a), with the tensile strength R in MPa, the
    /// initial thickness t, the tool's diameter d and the height h of the scallops in mm, and the wall angle a in degrees.
    fn force(&self) -> Option<f64> {
        let strength = self.tensile_strength?;
        let passes = self.passes.as_ref()?;
        let cutter = self.tool.cutter();
        let force = |slope: f64| {
            // the ball that is as curved as the tool where it touches this wall
            let diameter = 2.0 * cutter.curvature_radius_at(slope).min(0.5 * self.tool.diameter());
            let across = passes.pitch.largest() / libm::sin(slope);
            let of_step = 0.5 * (diameter - (diameter * diameter - across * across).max(0.0).sqrt());
            let scallop = match passes.pitch {
                Pitch::Even(_) | Pitch::Listed { .. } => of_step,
                Pitch::Scallop { height, .. } => height.min(of_step),
            };
            let (thickness, angle) = (libm::pow(self.thickness, 1.57), slope.to_degrees() * libm::cos(slope));
            0.0716 * strength * thickness * libm::pow(diameter, 0.41) * libm::pow(scallop, 0.09) * angle
        };
        self.slopes().skip(1).map(force).reduce(f64::max).filter(|force| *force > 0.0)
    }

    /// A tool that is more curved than the sheet withstands, anywhere up to the steepest wall.
    fn sharp_tool(&self) -> Option<Found> {
        let cutter = self.tool.cutter();
        let radii = self.slopes().map(|slope| (cutter.curvature_radius_at(slope), slope));
        let (radius, slope) = radii.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let least = LEAST_RADIUS * self.thickness;
        if radius >= least - SAME {
            return None;
        }
        let (name, slope) = (&self.section.common.tool, slope.to_degrees());
        let what = if radius > 0.0 {
            format!("the radius of curvature of tool {name} is {radius:.2} mm at a slope of {slope:.0} degrees")
        } else {
            format!("tool {name} has an edge without a radius, at a slope of {slope:.0} degrees")
        };
        let words = format!(
            "{what}, and a sheet of {} mm needs {} mm, twice its thickness: sharper tools shave and tear it; use a rounder tool",
            shown(self.thickness),
            shown(least)
        );
        Some((FindingKind::ToolRadius, Severity::Warning, words))
    }

    /// Formed faces, with the tool where that goes round them, that are larger in plan than the opening of the clamp frame.
    fn large_part(&self, support: Support, id: &str) -> Option<Found> {
        let mesh = &self.scene.mesh;
        let outside = match support {
            Support::Rim => 0.0,
            Support::DieAndFrame | Support::Mandrel => self.tool.point_at(self.steepest).0 + 0.5 * self.tool.diameter(),
        };
        let is_formed = |triangle: &usize| self.selected[*triangle] && mesh.model_normal(*triangle).z < 1.0 - SAME;
        let formed = (0..self.selected.len()).filter(is_formed).flat_map(|triangle| mesh.corners(triangle));
        let most = plates::beyond_clamp(self.scene, formed)? + outside;
        let margin = self.scene.fixture?.margin;
        if most + margin <= SAME {
            return None;
        }
        let with = if outside > 0.0 { ", with the tool around them," } else { "" };
        let words = format!(
            "the faces of {id}{with} reach {:.3} mm into the margin of {} mm inside the clamp frame's opening: use a frame with \
             a wider opening, or move the part in it (setup.fixture.center)",
            most + margin,
            shown(margin)
        );
        Some((FindingKind::ClampOpening, Severity::Warning, words))
    }

    /// A force that is larger than the machine withstands, N.
    fn strong(&self, most: f64, id: &str) -> Option<Found> {
        let force = self.force().filter(|force| *force > most)?;
        let words = format!(
            "{id} takes an axial force of about {force:.0} N (Aerens et al. 2010), and limits.max_axial_force of the machine is {} \
             N: use a smaller step, a smaller tool or a thinner sheet",
            shown(most)
        );
        Some((FindingKind::AxialForce, Severity::Warning, words))
    }
}
