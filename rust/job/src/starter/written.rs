//! The text of a starter job.

use std::path::Path;

use super::allowances::Allowances;
use super::choice::Choice;
use super::feed_lines::StarterFeeds;
use super::part::{StarterFace, StarterPart};
use super::sizes::round;
use super::text::{number, quoted, wrapped};
use super::work::Work;
use crate::operations::{About, Operation, Serves};
use crate::{Process, UpAxis};

/// From this slope on a face does not face up: it is not listed, degrees.
const WALL: f64 = 90.1;
/// Faces that the comment lists at most.
const LISTED: usize = 60;
/// Nodes of the grid over the part's plan in which levels look for loops, about.
const NODES: f64 = 2e5;
/// A part that lies farther from its origin than this many times its size gets a zero point of its own.
const FAR: f64 = 1.0;

/// What a job's text is made of.
pub struct Written<'a> {
    pub part: &'a StarterPart<'a>,
    pub choice: &'a Choice,
    /// Of the triangles and of the path, mm.
    pub tolerances: [f64; 2],
    /// None before they are known: operations are without them then.
    pub feeds: Option<&'a StarterFeeds>,
}

impl Written<'_> {
    /// The whole job.
    pub fn job(&self) -> String {
        let Self { part, choice, tolerances: [part_tolerance, _], feeds } = *self;
        let stem = stem_of(part.file);
        let units = part.units.map_or(String::new(), |u| format!("units = {}\n", quoted(u)));
        let undercuts = if choice.allow_undercuts {
            "allow_undercuts = true      # some of the named faces face down in parts: those are left\n"
        } else {
            ""
        };
        format!(
            r#"# A StylusCAM job. Lengths are mm, angles degrees, feeds mm/min.
# Run it: `styluscam run` and the name of this file.
#
# Why it is so:
{reasons}schema = 1
title = {title}

[part]
file = {file}
{units}faces = "all"              # the faces that face up, or names: ["Face3", "Face4"]
{faces}{undercuts}{model_face}tolerance = {part_tolerance}           # largest deviation of triangles from surfaces, checked

{setup}
{process}{material}
{tools}
{operations}
[machine]
name = "linuxcnc"           # or "grbl"; see `styluscam machine list`

[output]
file = {gcode}
program = {program}
"#,
            reasons = choice.reasons.iter().map(|reason| wrapped(reason)).collect::<String>(),
            title = quoted(&stem),
            file = quoted(part.file),
            faces = listed(&lying(part, choice.up)),
            model_face = model_face(choice),
            setup = setup(choice),
            process = process(choice),
            material = feeds.map_or("", |feeds| &feeds.process),
            tools = self.tools(),
            operations = self.operations(),
            gcode = quoted(&format!("{stem}.ngc")),
            program = quoted(&format!("{stem}.program.json")),
            part_tolerance = number(part_tolerance),
        )
    }

    fn tools(&self) -> String {
        let works = &self.choice.operations;
        let first = |(index, work): &(usize, &Work)| !works.iter().take(*index).any(|other| other.tool == work.tool);
        let mut tools = works.iter().enumerate().filter(first).map(|(_, work)| work).enumerate();
        let one = |(number, work): (usize, &Work)| {
            let library = match (number, self.choice.sheet) {
                (0, Some(_)) => "   # or library = \"clothoid:medium\"; see `styluscam tool list`",
                (0, None) => "   # or library = \"ball-d6\"; see `styluscam tool list`",
                _ => "",
            };
            format!(
                "[tools.{}]\nnumber = {}\nreference = \"tip\"           # the point that the program moves\nprofile = {}{library}\n{}",
                quoted_key(&work.tool),
                number + 1,
                work.cutter.profile(),
                self.feeds.map_or("", |feeds| &feeds.tool),
            )
        };
        tools.by_ref().map(one).collect::<Vec<_>>().join("\n")
    }

    fn operations(&self) -> String {
        let one = |(index, work): (usize, &Work)| {
            let feeds = self.feeds.and_then(|feeds| feeds.operations.get(index)).map_or("", String::as_str);
            self.operation(work, feeds)
        };
        self.choice.operations.iter().enumerate().map(one).collect::<Vec<_>>().join("\n")
    }

    fn operation(&self, work: &Work, feeds: &str) -> String {
        let faces = work.faces.as_ref().map_or(String::new(), |faces| format!("faces = {}\n", names(faces)));
        let Some((kind, about)) = Operation::ABOUT.iter().find(|(_, about)| about.serves == work.serves) else {
            return String::new(); // no kind serves that: a test holds the table to it
        };
        let why: String = work.why.iter().map(|sentence| wrapped(sentence)).collect();
        let keys = (about.starter)(work.passes);
        let others = others(work.serves);
        format!(
            "[[operations]]\nid = {}\n{why}kind = \"{kind}\"            # {others}\n{faces}tool = {}\n{keys}{}{feeds}",
            quoted(&work.id),
            quoted(&work.tool),
            self.passes(work),
        )
    }

    /// The keys of what follows faces.
    fn passes(&self, work: &Work) -> String {
        if work.serves == Serves::Holes {
            return String::new();
        }
        let [direction, choices] = match work.serves {
            Serves::Stock => ["climb", "or \"conventional\", \"alternate\""],
            _ => ["alternate", "or \"same\", \"climb\", \"conventional\""],
        };
        let leave = if work.leave > 0.0 {
            let leave = number(work.leave);
            format!("radial_stock_to_leave = {leave}  # on walls, for finishing\naxial_stock_to_leave = {leave}   # and on floors\n")
        } else {
            String::new()
        };
        format!(
            "{leave}direction = \"{direction}\"     # {choices}\ntolerance = {}           # the posted path lies at most this far above \
             the exact one\nsmallest_feature = {}     # no loop is missed that holds a disc of this diameter\n",
            number(self.tolerances[1]),
            number(smallest_feature(self.choice, work)),
        )
    }
}

/// A name as a key of TOML: bare where that is allowed.
fn quoted_key(name: &str) -> String {
    if name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_') {
        name.to_owned()
    } else {
        quoted(name)
    }
}

/// The kinds that may take the place of one: "z-level" for walls, ...
fn others(serves: Serves) -> String {
    let is_other = |about: &About| about.serves == serves || serves != Serves::Stock && serves != Serves::Holes;
    let one = |(name, about): &(&str, About)| format!("{name:?} {}", about.purpose);
    Operation::ABOUT.iter().filter(|(_, about)| is_other(about)).map(one).collect::<Vec<_>>().join(", ")
}

fn model_face(choice: &Choice) -> &'static str {
    if choice.sheet.is_some() {
        "model_face = \"tool\"         # the model shows the sheet's face that the tool touches (\"back\", \"mid\")\n"
    } else {
        ""
    }
}

fn setup(choice: &Choice) -> String {
    let [low, high] = choice.bounds;
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let is_far = (0..2).any(|axis| low[axis] > FAR * size[axis] || high[axis] < -FAR * size[axis])
        || (choice.sheet.is_none() && (low[2] > size[2].max(100.0) || high[2] < -size[2].max(100.0)));
    let corner = [low[0], low[1], high[2]].map(|x| number((x * 1000.0).round() / 1000.0 + 0.0)).join(", ");
    let zero = match (is_far, choice.sheet) {
        (true, _) => format!("zero = [{corner}]  # the part's left front corner, its top: its own origin lies far off"),
        (false, Some(_)) => {
            "zero = \"sheet-top\"          # Z0 on the sheet, X0 Y0 at the model's origin; or \"model\", \
                             or [x, y, z]"
                .to_owned()
        }
        (false, None) => "zero = \"model\"              # the model's origin, or [x, y, z] of the model".to_owned(),
    };
    let over = if choice.sheet.is_some() { "sheet" } else { "part" };
    let setup = format!(
        "[setup]\nup = \"{}\"                   # axis of the model that points to the spindle\n{zero}\nwcs = \
         \"G54\"\nclearance = 10.0            # rapids cross this far above the {over}\nretract = 2.0               # \
         and come down to here\n",
        choice.up.name()
    );
    let Some(thickness) = choice.sheet else { return format!("{setup}{}", choice.stock.map_or(String::new(), stock)) };
    let widest = choice.operations.iter().map(|work| work.cutter.diameter).fold(0.0, f64::max);
    let room = 2.0 * widest;
    let opening = format!("[{:.1}, {:.1}]", size[0] + room, size[1] + room);
    format!(
        r#"{setup}
[setup.sheet]
thickness = {}
law = "constant"            # or "sine"
# max_wall_angle_deg = 65.0   # steeper walls are refused; min_thickness = 0.4: thinner ones by the sine law

# [setup.fixture]           # what holds the sheet is kept clear: an opening is [width, height] or a diameter
# clamp = {{ opening = {opening}, height = 8.0 }}
# backing = {{ opening = {opening} }}
# margin = 1.0
"#,
        number(thickness)
    )
}

fn stock(Allowances { sides, top }: Allowances) -> String {
    format!(
        "\n[setup.stock]               # what the part is cut from\nkind = \"box\"                # or \"cylinder\"\nsides = {}                 # \
         by how much it is larger than the part's box on each side\ntop = {}                   # and higher; bottom: and lower\n",
        number(sides),
        number(top)
    )
}

fn process(choice: &Choice) -> String {
    let known = Process::ABOUT.iter().find(|(_, about)| about.for_sheets == choice.sheet.is_some());
    let kind = known.map_or(String::new(), |(name, about)| match about.words {
        "" => format!("kind = {name:?}\n"),
        words => format!("kind = {name:?}               # {words}\n"),
    });
    let unreached = choice.max_unreached.map_or(String::new(), |share| {
        format!("max_unreached = {}        # share of the faces that the tool may be unable to get to\n", number(share))
    });
    format!("[process]\n{kind}{unreached}")
}

/// A tenth of the tool, but no more nodes over the part's plan than anybody waits for.
fn smallest_feature(choice: &Choice, work: &Work) -> f64 {
    let [low, high] = choice.bounds;
    let plan = (high[0] - low[0]) * (high[1] - low[1]);
    round(f64::clamp(0.1 * work.cutter.diameter, 0.05, 1.0).max((2.0 * plan / NODES).sqrt()).min(100.0))
}

/// A TOML list of names, broken into lines.
fn names(faces: &[u32]) -> String {
    let names: Vec<String> = faces.iter().map(|face| format!("\"Face{face}\"")).collect();
    if names.len() <= 8 {
        return format!("[{}]", names.join(", "));
    }
    let lines: Vec<String> = names.chunks(10).map(|line| format!("    {},\n", line.join(", "))).collect();
    format!("[\n{}]", lines.concat())
}

/// The faces as they slope with the tool's side up.
fn lying(part: &StarterPart<'_>, up: UpAxis) -> Vec<StarterFace> {
    let mut faces = part.faces.to_vec();
    if up == UpAxis::PlusZ {
        return faces;
    }
    faces.iter_mut().for_each(|face| face.slope_deg = [180.0, 0.0]);
    for (triangle, number) in part.mesh.faces().iter().enumerate() {
        let Some(face) = faces.get_mut((*number as usize).wrapping_sub(1)) else { continue };
        for normal in part.mesh.corner_normals(triangle) {
            let slope = libm::acos(normal.dot(&up.vector()).clamp(-1.0, 1.0)).to_degrees();
            face.slope_deg = [face.slope_deg[0].min(slope), face.slope_deg[1].max(slope)];
        }
    }
    faces
}

fn listed(faces: &[StarterFace]) -> String {
    let up: Vec<&StarterFace> = faces.iter().filter(|face| face.slope_deg[0] < WALL).collect();
    let mut lines: String = up.iter().take(LISTED).map(|face| described(face)).collect();
    if up.len() > LISTED {
        lines.push_str(&format!("#   and {} more: see `styluscam part show`\n", up.len() - LISTED));
    }
    lines
}

fn described(face: &StarterFace) -> String {
    let [low, high] = face.slope_deg;
    format!("#   {}: {}, {:.0} mm2, slope {low:.0} to {high:.0} deg\n", face.name, face.kind, face.area)
}

/// The file's name without its ending; what ends a line or a comment would break the job's text.
fn stem_of(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    stem.chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}
