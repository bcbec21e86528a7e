//! A commented job for a part that has none yet: it runs as it stands, and shows what can be changed.

use std::path::Path;

/// A face that slopes at most this much has no levels worth their name, degrees.
const FLAT: f64 = 1.0;
/// From this slope on a face is a wall, which does not look up, degrees.
const WALL: f64 = 89.9;

/// What a starter job is written for.
#[derive(Clone, Debug, PartialEq)]
pub struct StarterPart<'a> {
    /// The part's file, as the job should name it.
    pub file: &'a str,
    /// Its unit, where the file does not state one.
    pub units: Option<&'a str>,
    /// Size of its box, mm.
    pub size: [f64; 3],
    /// Its faces.
    pub faces: &'a [StarterFace],
}

/// A face as the job's comment lists it.
#[derive(Clone, Debug, PartialEq)]
pub struct StarterFace {
    /// `Face1` and so on.
    pub name: String,
    /// plane, cone, ...
    pub kind: String,
    /// Area, mm^2.
    pub area: f64,
    /// Smallest and largest slope, degrees.
    pub slope_deg: [f64; 2],
}

/// A job in TOML. Tool and step follow the part's size: about a tenth of its smaller side, from a few round diameters;
/// the sheet is thinner than the tool is long. Levels where something slopes that looks up, rows where all that looks
/// up is flat.
#[must_use]
pub fn starter(part: &StarterPart<'_>) -> String {
    let [x, y, z] = part.size;
    let diameter = [40.0, 20.0, 10.0, 6.0, 3.0, 1.0].into_iter().find(|d| *d <= 0.15 * x.min(y)).unwrap_or(0.5);
    let step = round(f64::max(0.05 * diameter, z / 400.0));
    let thickness = f64::min(1.0, 0.2 * diameter);
    let up: Vec<&StarterFace> = part.faces.iter().filter(|f| f.slope_deg[0] < WALL).collect();
    let slopes = up.iter().any(|f| f.slope_deg[1] > FLAT);
    let (kind, other) = if slopes { ("z-level", "zig-zag") } else { ("zig-zag", "z-level") };
    let stem = stem_of(part.file);
    let units = part.units.map_or(String::new(), |u| format!("units = {}\n", quoted(u)));
    let faces: String = up.iter().map(|f| described(f)).collect();
    let feature = round(f64::clamp(0.1 * diameter, 0.05, 1.0));
    format!(
        r#"# A StylusCAM job. Lengths are mm, angles degrees, feeds mm/min.
# Run it:  styluscam run {stem}.toml
schema = 1
title = {title}

[part]
file = {file}
{units}faces = "all"              # the faces that look up, or names: ["Face3", "Face4"]
{faces}model_face = "tool"         # the model shows the sheet's face that the tool touches ("back", "mid")
tolerance = 0.001           # largest deviation of triangles from surfaces, checked

[setup]
up = "+z"                   # axis of the model that points to the spindle
zero = "sheet-top"          # Z0 on the sheet, X0 Y0 at the model's origin; or "model", or [x, y, z]
wcs = "G54"
clearance = 10.0            # rapids cross this far above the sheet
retract = 2.0               # and come down to here

[setup.sheet]               # for milling: remove this table and model_face, set process.kind = "milling"
thickness = {thickness}
law = "constant"            # or "sine"
# max_wall_angle_deg = 65.0   # steeper walls are refused; min_thickness = 0.4: thinner ones by the sine law

# [setup.fixture]           # what holds the sheet is kept clear: an opening is [width, height] or a diameter
# clamp = {{ opening = {opening}, height = 8.0 }}
# backing = {{ opening = {opening} }}
# margin = 1.0

[process]
kind = "spif"               # single-point incremental forming

[tools.stylus]
number = 1
reference = "tip"           # the point that the program moves
profile = {{ kind = "ball", diameter = {diameter} }}   # or library = "clothoid:medium"; see `styluscam tool list`

[[operations]]
kind = "{kind}"            # or "{other}"
tool = "stylus"
step = {{ height = {step} }}    # z-level: distance between levels
stepover = {step}              # zig-zag: distance between rows
angle_deg = 0.0             # zig-zag: direction of rows
direction = "alternate"     # or "same"
tolerance = 0.005           # the posted path lies at most this far above the exact one
smallest_feature = {feature}     # no loop is missed that holds a disc of this diameter
feeds = {{ cut = 1500.0, plunge = 300.0 }}

[machine]
name = "linuxcnc"           # or "grbl"; see `styluscam machine list`

[output]
file = {gcode}
program = {program}
"#,
        title = quoted(&stem),
        file = quoted(part.file),
        gcode = quoted(&format!("{stem}.ngc")),
        program = quoted(&format!("{stem}.program.json")),
        opening = format_args!("[{:.1}, {:.1}]", x + diameter, y + diameter),
        diameter = toml_number(diameter),
        thickness = toml_number(thickness),
        step = toml_number(step),
        feature = toml_number(feature),
    )
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

/// A TOML string.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Two significant places.
fn round(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    let rounded = (value / unit - 1e-9).ceil() * unit;
    (rounded * 1e9).round() / 1e9
}

fn toml_number(value: f64) -> String {
    format!("{value:?}")
}
