//! What a part is made into, and why: formed or milled, from which side, with which operations and which tool.

use styluscam_geometry::{Bvh, Frame, Mesh};

use super::allowances::Allowances;
use super::drilling::{drilling, Drilled};
use super::operations::{self, Milled};
use super::part::StarterPart;
use super::preparing::{Between, Cuts, Part};
use super::roughing::roughing;
use super::shop::Shop;
use super::sizes;
use super::work::Work;
use super::workable::{covered, workable};
use crate::body::{Body, FaceLook, Hollows, Shell, Side, Thickness};
use crate::UpAxis;

/// Share of the area hidden from above that is worth a word.
const HIDDEN: f64 = 0.1;
/// Share that is worth standing the part on its side, where that hides less than half of it; turning it over is less work.
const ON_SIDE: f64 = 0.25;
/// Share of an open surface that must face up for the tool to come from there.
const FACES_TOOL: f64 = 0.5;

/// Thicker sheets are pressed, not formed point by point, mm.
const THICKEST: f64 = 6.0;

/// A choice, with its reasons as sentences.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Sentences, most important first.
    pub reasons: Vec<String>,
    /// Side of the model from which the tool comes.
    pub up: UpAxis,
    /// Thickness of the sheet, mm; none: milling.
    pub sheet: Option<f64>,
    /// By how much the stock of what is milled is larger than the part.
    pub stock: Option<Allowances>,
    /// In order.
    pub operations: Vec<Work>,
    /// Share of the faces that the tool may be unable to get to, where that is more than usual.
    pub max_unreached: Option<f64>,
    /// Whether faces are named that partly face down.
    pub allow_undercuts: bool,
    /// Lowest and highest corner of the part as it lies, mm.
    pub bounds: [[f64; 3]; 2],
}

/// A part turned so that the tool comes from above.
struct Turned {
    mesh: Mesh,
    bvh: Bvh,
}

impl Turned {
    fn new(mesh: &Mesh, up: UpAxis) -> Self {
        let mesh = mesh.placed(&Frame::turning_up(up.vector(), 0.0));
        Self { bvh: Bvh::new(&mesh), mesh }
    }

    fn body(&self) -> Body<'_> {
        Body::new(&self.mesh, &self.bvh)
    }
}

/// How a sheet is formed from one side.
struct Formed {
    turned: Turned,
    up: UpAxis,
    words: String,
}

/// Looks at the part and chooses.
pub fn choose(part: &StarterPart<'_>) -> Choice {
    let shop = Shop::of(part);
    let lying = Turned::new(part.mesh, UpAxis::PlusZ);
    let body = lying.body();
    let shell = body.shell();
    let thickness = body.thickness();
    let sides = body.sides();
    let mut choice = match (shell, thickness) {
        (Shell::Open, _) => open(lying, &sides, &shop),
        (Shell::Closed | Shell::Torn, Some(thickness)) if thickness.is_sheet() => {
            sheet(lying, &thickness, &sides, &shop)
        }
        (Shell::Closed | Shell::Torn, Some(thickness)) => mill(lying, &sides, vec![solid(&thickness)], &shop),
        (Shell::Closed | Shell::Torn, None) => {
            mill(lying, &sides, vec!["the part is a solid: it is milled".to_owned()], &shop)
        }
        (Shell::InsideOut, _) => mill(
            lying,
            &sides,
            vec!["the part's triangles are wound inward: export it with its normals outward".into()],
            &shop,
        ),
        (Shell::Mixed, _) => {
            let words = "some of the part's triangles are wound inward: repair the mesh before you trust this job";
            mill(lying, &sides, vec![words.to_owned()], &shop)
        }
    };
    if shell == Shell::Torn {
        choice.reasons.push("the part's surface has holes: repair it before you trust this job".to_owned());
    }
    choice
}

fn solid(thickness: &Thickness) -> String {
    let Thickness { thin, thick, .. } = *thickness;
    format!("the part is a solid ({thin:.1} to {thick:.1} mm thick), not a sheet of one thickness: it is milled")
}

fn open(lying: Turned, sides: &[Side; 6], shop: &Shop) -> Choice {
    let what = "the part is an open surface without thickness";
    let ups = [UpAxis::PlusZ, UpAxis::MinusZ];
    let looks = |up: &UpAxis| sides.iter().any(|side| side.up == *up && side.up_share >= FACES_TOOL);
    let facing: Vec<UpAxis> = ups.into_iter().filter(looks).collect();
    match formed(&lying, None, &facing) {
        Ok(found) => {
            let reasons = vec![
                format!("{what}, and {}: it is formed", found.words),
                "the surface is taken for the sheet's face that the tool touches; the thickness is a guess: write your \
                 sheet's"
                    .to_owned(),
            ];
            form(found, None, reasons)
        }
        Err(why) => {
            let torn = "if it should be a solid, faces or triangles are missing: repair it before you trust this job";
            mill(lying, sides, vec![format!("{what}, but {why}: it is milled"), torn.to_owned()], shop)
        }
    }
}

fn sheet(lying: Turned, thickness: &Thickness, sides: &[Side; 6], shop: &Shop) -> Choice {
    let t = sizes::measured(thickness.median);
    let what = format!("the part is a sheet {t} mm thick on {:.0} % of its area", 100.0 * thickness.alike);
    match formed(&lying, Some(t), &[UpAxis::PlusZ, UpAxis::MinusZ]) {
        Ok(found) => {
            let reasons = vec![
                format!("{what}, and {}: it is formed", found.words),
                "the tool touches the model's upper face, so model_face is \"tool\"".to_owned(),
            ];
            form(found, Some(t), reasons)
        }
        Err(why) => mill(lying, sides, vec![format!("{what}, but {why}: it is milled")], shop),
    }
}

/// The first side from which a sheet can be formed, or why not even the first can.
fn formed(lying: &Turned, thickness: Option<f64>, ups: &[UpAxis]) -> Result<Formed, String> {
    if thickness.is_some_and(|thickness| thickness > THICKEST) {
        return Err(format!("that is more than the {THICKEST} mm that a stylus forms"));
    }
    let mut first = None;
    for up in ups {
        let turned = Turned::new(&lying.mesh, *up);
        match turned.body().formed_depth(thickness) {
            Ok(depth) => {
                let words = format!("it goes down {depth:.1} mm from its border");
                return Ok(Formed { turned, up: *up, words });
            }
            Err(why) => first = first.or(Some(why.to_string())),
        }
    }
    Err(first.unwrap_or_else(|| "most of it faces neither up nor down".to_owned()))
}

fn form(found: Formed, thickness: Option<f64>, mut reasons: Vec<String>) -> Choice {
    let Formed { turned, up, .. } = found;
    if up != UpAxis::PlusZ {
        reasons.push("it opens downward: setup.up = \"-z\" turns it over, so that its border is on top".to_owned());
    }
    let looks = turned.body().hollows();
    let (tool, words) = sizes::stylus(&turned.mesh, &looks, thickness);
    reasons.push(words);
    let thickness = thickness.unwrap_or_else(|| sizes::measured(f64::min(1.0, 0.2 * tool.diameter)));
    Choice {
        reasons,
        up,
        sheet: Some(thickness),
        stock: None,
        operations: vec![operations::forming(&turned.mesh, &looks, &tool)],
        max_unreached: None,
        allow_undercuts: false,
        bounds: bounds(&turned.mesh),
    }
}

fn mill(lying: Turned, sides: &[Side; 6], mut reasons: Vec<String>, shop: &Shop) -> Choice {
    let (up, words) = best_side(sides);
    reasons.extend(words);
    let turned = if up == UpAxis::PlusZ { lying } else { Turned::new(&lying.mesh, up) };
    let body = turned.body();
    let looks = body.hollows();
    let allowances = Allowances::of(&turned.mesh);
    let mut works: Vec<Work> = Vec::new();
    let drilled = drilling(&body);
    let of_holes: Vec<u32> = drilled.iter().flat_map(|holes| holes.faces.iter().copied()).collect();
    let open: Vec<u32> = workable(&looks).map(|face| face.face).filter(|face| !of_holes.contains(face)).collect();
    let are_all = of_holes.is_empty() && covered(&looks).next().is_none();
    let faces = Some(open).filter(|open| !are_all && open.len() <= operations::NAMES);
    let roughings = roughing((&body, shop), allowances, &drilled, faces.as_deref()).unwrap_or_else(|why| {
        reasons.push(why);
        Vec::new()
    });
    let part = Part::new((&body, shop), allowances, &drilled);
    let (Milling { rougher, milled, .. }, between) = milling((&body, &looks, &drilled), &part, &roughings);
    works.extend(rougher);
    reasons.extend(milled.reasons);
    works.extend(drilled.into_iter().map(|holes| holes.work));
    match between {
        Ok(between) => works.extend(between.before(milled.works)),
        Err(why) => {
            reasons.push(why);
            works.extend(milled.works);
        }
    }
    let named = |face: &FaceLook| face.looks_down && works.iter().any(|work| work.names(face.face));
    Choice {
        reasons,
        up,
        sheet: None,
        stock: Some(allowances),
        max_unreached: milled.max_unreached,
        allow_undercuts: looks.faces.iter().any(named),
        operations: works,
        bounds: bounds(&turned.mesh),
    }
}

/// How a solid is milled.
struct Milling {
    rougher: Option<Work>,
    /// The finishing.
    milled: Milled,
    cuts: Cuts,
}

/// With the first of some roughings after which no finishing tool cuts deeper at once than it is wide, without rows with balls over
/// level floors first, else with the first of all; and what comes between roughing and finishing, or why finishing cuts deep without.
fn milling(
    (body, looks, drilled): (&Body<'_>, &Hollows, &[Drilled]),
    part: &Part<'_>,
    roughings: &[Work],
) -> (Milling, Result<Between, String>) {
    let after = |rougher: Option<&Work>| {
        let milled = operations::milling((body, part.shop), looks, drilled, rougher.map(|work| &work.cutter));
        let cuts = part.cuts(rougher, &milled.works);
        Milling { rougher: rougher.cloned(), milled, cuts }
    };
    let between = |milling: &Milling, on_floors: bool| {
        part.between(&milling.cuts, (milling.rougher.as_ref(), &milling.milled.works), on_floors)
    };
    let mut tried = Vec::new();
    for rougher in roughings {
        let milling = after(Some(rougher));
        match between(&milling, false) {
            Ok(works) => return (milling, Ok(works)),
            Err(why) => tried.push((milling, why)),
        }
    }
    let on_floors = tried.iter().enumerate().find_map(|(i, (milling, _))| Some((i, between(milling, true).ok()?)));
    let (number, works) = on_floors.map_or((0, None), |(number, works)| (number, Some(works)));
    match tried.into_iter().nth(number) {
        Some((milling, why)) => (milling, works.ok_or(why)),
        None => {
            let milling = after(None);
            let between = between(&milling, true);
            (milling, between)
        }
    }
}

/// +Z, unless much is hidden from there and another side hides less than half of that.
fn best_side(sides: &[Side; 6]) -> (UpAxis, Option<String>) {
    let [above, ..] = sides;
    let cost = |side: &Side| side.hidden + if is_upright(side.up) { 0.0 } else { 0.5 * HIDDEN };
    let best = sides.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(above);
    let [percent, other] = [above, best].map(|side| sizes::percent(side.hidden));
    if above.hidden <= HIDDEN {
        return (above.up, None);
    }
    let hidden = format!("{percent} of the surface is hidden from above (it faces down, or lies under the rest)");
    let name = best.up.name();
    if best.up == above.up {
        return (above.up, Some(format!("{hidden}, and no other side hides less: what is left may take a second job")));
    }
    if best.hidden > 0.5 * above.hidden {
        let words = format!("{hidden}, {other} from {name}: what is left may take a second job with another setup.up");
        return (above.up, Some(words));
    }
    if !is_upright(best.up) && above.hidden <= ON_SIDE {
        let words = format!("{hidden}; from {name} {other} would be: setup.up = \"{name}\" mills that side");
        return (above.up, Some(words));
    }
    let words = format!("{percent} of the surface is hidden from +z, {other} from {name}: setup.up turns the part so");
    (best.up, Some(words))
}

fn is_upright(up: UpAxis) -> bool {
    matches!(up, UpAxis::PlusZ | UpAxis::MinusZ)
}

fn bounds(mesh: &Mesh) -> [[f64; 3]; 2] {
    let (low, high) = mesh.bounds();
    [low.into(), high.into()]
}
