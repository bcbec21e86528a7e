//! A commented job for a part that has none yet: it runs as it stands, and shows what can be changed.

/// What a starter job is written for.
#[derive(Clone, Debug, PartialEq)]
pub struct StarterPart<'a> {
    /// The part's file, as the job should name it.
    pub file: &'a str,
    /// Its unit, where the file does not state one.
    pub units: Option<&'a str>,
    /// A name for outputs: the file's, without its ending.
    pub stem: &'a str,
    /// Size of its box, mm.
    pub size: [f64; 3],
    /// Faces that look up, in words: `Face1 plane, 1200 mm2`.
    pub faces: &'a [String],
}

/// A job in TOML. Tool and step follow the part's size: a tenth of its smaller side, from a few round diameters.
#[must_use]
pub fn starter(part: &StarterPart<'_>) -> String {
    let [x, y, z] = part.size;
    let diameter = [40.0, 20.0, 10.0, 6.0, 3.0, 1.0].into_iter().find(|d| *d <= 0.15 * x.min(y)).unwrap_or(0.5);
    let step = round(f64::max(0.05 * diameter, z / 400.0));
    let units = part.units.map_or(String::new(), |u| format!("units = {u:?}\n"));
    let faces: String = part.faces.iter().map(|f| format!("#   {f}\n")).collect();
    let feature = (0.1 * diameter).clamp(0.05, 1.0);
    format!(
        r#"# A StylusCAM job. Lengths are mm, angles degrees, feeds mm/min.
# Run it:  styluscam run {stem}.toml
schema = 1
title = {title:?}

[part]
file = {file:?}
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
thickness = 1.0
law = "constant"            # or "sine"

[process]
kind = "spif"               # single-point incremental forming

[tools.stylus]
number = 1
reference = "tip"           # the point that the program moves
profile = {{ kind = "ball", diameter = {diameter} }}   # or kind = "clothoid"

[[operations]]
kind = "z-level"            # or "zig-zag"
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
file = "{stem}.ngc"
program = "{stem}.program.json"
"#,
        stem = part.stem,
        title = part.stem,
        file = part.file,
        diameter = toml_number(diameter),
        step = toml_number(step),
        feature = toml_number(feature),
    )
}

/// Two significant places.
fn round(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    let rounded = (value / unit).ceil() * unit;
    (rounded * 1e9).round() / 1e9
}

fn toml_number(value: f64) -> String {
    format!("{value:?}")
}
