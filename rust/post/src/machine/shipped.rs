//! The machine files that come with the release.

/// The machine files that come with the release: a name and the text.
pub(super) const SHIPPED: [(&str, &str); 23] = [
    ("brother", include_str!("../../machines/brother.toml")),
    ("carvera", include_str!("../../machines/carvera.toml")),
    ("centroid", include_str!("../../machines/centroid.toml")),
    ("fanuc", include_str!("../../machines/fanuc.toml")),
    ("fanuc-five-axis", include_str!("../../machines/fanuc-five-axis.toml")),
    ("fluidnc", include_str!("../../machines/fluidnc.toml")),
    ("grbl", include_str!("../../machines/grbl.toml")),
    ("grblhal", include_str!("../../machines/grblhal.toml")),
    ("haas", include_str!("../../machines/haas.toml")),
    ("heidenhain", include_str!("../../machines/heidenhain.toml")),
    ("linuxcnc", include_str!("../../machines/linuxcnc.toml")),
    ("linuxcnc-trunnion", include_str!("../../machines/linuxcnc-trunnion.toml")),
    ("mach3", include_str!("../../machines/mach3.toml")),
    ("mach4", include_str!("../../machines/mach4.toml")),
    ("marlin", include_str!("../../machines/marlin.toml")),
    ("masso", include_str!("../../machines/masso.toml")),
    ("mazak", include_str!("../../machines/mazak.toml")),
    ("mitsubishi", include_str!("../../machines/mitsubishi.toml")),
    ("okuma", include_str!("../../machines/okuma.toml")),
    ("reprapfirmware", include_str!("../../machines/reprapfirmware.toml")),
    ("siemens", include_str!("../../machines/siemens.toml")),
    ("smoothieware", include_str!("../../machines/smoothieware.toml")),
    ("uccnc", include_str!("../../machines/uccnc.toml")),
];

/// Names of the machines that come with the release, sorted.
#[must_use]
pub fn shipped() -> Vec<&'static str> {
    SHIPPED.iter().map(|(name, _)| *name).collect()
}
