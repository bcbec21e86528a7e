//! Tables of cutting speeds and chips: workpiece material x material of the cutter x work, each number with its source.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};
use serde_json::{json, Value};
use styluscam_geometry::CutterMaterial;

use crate::JobError;

/// The shipped tables.
const FILES: [&str; 5] = [
    include_str!("data/aluminium.toml"),
    include_str!("data/steel.toml"),
    include_str!("data/other-metals.toml"),
    include_str!("data/plastic.toml"),
    include_str!("data/wood.toml"),
];

static SHIPPED: LazyLock<CuttingTable> = LazyLock::new(|| CuttingTable {
    materials: FILES
        .iter()
        .filter_map(|text| toml::from_str::<CuttingTable>(text).ok())
        .flat_map(|t| t.materials)
        .collect(),
});

/// Smallest diameter as a share of the smallest in an entry, and largest as one of the largest, for which its chips stand:
const SMALLEST: f64 = 0.1;
const LARGEST: f64 = 2.0;
/// in milling at a cutting speed teeth of cutters 100 mm wide take no thinner chips than those of 20 mm (Mitsubishi Materials, general
/// catalogue 2020-2021, recommended cutting conditions: 0.1 to 0.25 mm in steel, 0.2 to 0.25 mm in aluminium).
const LARGEST_OF_MILLS: f64 = 5.0;

/// m in a foot, and mm in an inch.
const FOOT: f64 = 0.3048;
const INCH: f64 = 25.4;

/// What is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CuttingWork {
    /// Most of the stock is removed.
    RoughMilling,
    /// The last pass over a face.
    FinishMilling,
    /// A hole, by a drill.
    Drilling,
    /// A thread, by a tap.
    Tapping,
}

impl CuttingWork {
    /// Every work.
    pub const ALL: [Self; 4] = [Self::RoughMilling, Self::FinishMilling, Self::Drilling, Self::Tapping];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RoughMilling => "rough-milling",
            Self::FinishMilling => "finish-milling",
            Self::Drilling => "drilling",
            Self::Tapping => "tapping",
        }
    }

    /// Whether the cutter's side cuts.
    #[must_use]
    pub fn mills(self) -> bool {
        matches!(self, Self::RoughMilling | Self::FinishMilling)
    }

    /// By its name.
    ///
    /// # Errors
    /// `unknown`, with those that are known.
    pub fn named(name: &str) -> Result<Self, JobError> {
        Self::ALL.into_iter().find(|work| work.name() == name).ok_or_else(|| {
            let known = Self::ALL.map(|work| format!("{:?}", work.name())).join(", ");
            JobError::document("unknown", "work", format!("unknown work {name:?}"), format!("write one of {known}"))
        })
    }
}

/// One number, or a range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or [lowest, highest]")]
pub enum Span {
    /// One number.
    One(f64),
    /// Lowest and highest.
    Range([f64; 2]),
}

impl Span {
    /// Lowest and highest.
    #[must_use]
    pub fn ends(self) -> [f64; 2] {
        match self {
            Self::One(value) => [value; 2],
            Self::Range(ends) => ends,
        }
    }
}

/// Tables of cutting data: a shop's file, or what is shipped.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CuttingTable {
    /// The materials of workpieces.
    pub materials: Vec<CuttingMaterial>,
}

/// A material of workpieces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CuttingMaterial {
    /// Its name in a job.
    pub name: String,
    /// What it is; may be left out of a shop's table.
    #[serde(default)]
    pub title: String,
    /// Other names by which a job may call it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<String>,
    /// What cutters stand in it: of several entries for one cutter and work, the first counts.
    pub data: Vec<CuttingEntry>,
}

/// What cutters of one material stand in a kind of work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CuttingEntry {
    /// What the cutter is made of.
    pub cutter: CutterMaterial,
    /// The work that it is for.
    pub work: Vec<CuttingWork>,
    /// Cutting speed, m/min: this, `speed_ft_min` or `rpm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_min: Option<Span>,
    /// Cutting speed, ft/min.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_ft_min: Option<Span>,
    /// Speed of the spindle whatever the diameter, rev/min.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rpm: Option<f64>,
    /// Diameters of cutters, mm, rising, and feed per tooth (in drilling: per revolution), mm; or in `chip_inch`. None in tapping,
    /// where the pitch is the feed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub chip_mm: Vec<[f64; 2]>,
    /// The same in inches.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub chip_inch: Vec<[f64; 2]>,
    /// Depths of cut, in diameters, rising, and the share of the chip that is allowed there; the whole at any depth when left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub chip_by_depth: Vec<[f64; 2]>,
    /// Where the numbers are stated; "the shop's table" when left out.
    #[serde(default = "shop")]
    pub source: String,
    /// Where the chips are stated, if elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chip_source: Option<String>,
}

fn shop() -> String {
    "the shop's table".to_owned()
}

/// The shipped tables as their files have them: TOML, to begin a shop's own with.
#[must_use]
pub fn shipped_texts() -> [&'static str; 5] {
    FILES
}

impl CuttingTable {
    /// The shipped ones.
    #[must_use]
    pub fn shipped() -> &'static Self {
        &SHIPPED
    }

    /// Reads and checks a shop's table written as TOML.
    ///
    /// # Errors
    /// The line or the entry that is wrong, and what is allowed.
    pub fn from_toml(text: &str) -> Result<Self, JobError> {
        let table: Self = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start.min(text.len()));
            let line = text.bytes().take(start).filter(|byte| *byte == b'\n').count() + 1;
            let hint = "the shipped tables show the format: `styluscam material cutting --toml` prints them";
            JobError::document("cutting-data", format!("line {line}"), error.message().to_owned(), hint)
        })?;
        for (i, material) in table.materials.iter().enumerate() {
            for (k, entry) in material.data.iter().enumerate() {
                entry.check(&format!("materials[{i}].data[{k}]"))?;
            }
        }
        Ok(table)
    }

    /// This table, and what only `other` has; for what both have, this one's entries come first.
    #[must_use]
    pub fn before(&self, other: &Self) -> Self {
        let mut materials = self.materials.clone();
        for theirs in &other.materials {
            match materials.iter_mut().find(|ours| theirs.is_called(&ours.name)) {
                Some(ours) => ours.take(theirs),
                None => materials.push(theirs.clone()),
            }
        }
        Self { materials }
    }

    /// The table in mm and m/min, as JSON for people and scripts.
    #[must_use]
    pub fn listed(&self) -> Value {
        let entry = |entry: &CuttingEntry| {
            let sources = [&*entry.source, entry.source_of_chips()];
            let other = usize::from(sources[0] != sources[1]);
            json!({
                "cutter": entry.cutter,
                "work": entry.work,
                "speed_m_min": entry.speed(),
                "rpm": entry.rpm,
                "chips": entry.chips(),
                "chip_by_depth": entry.chip_by_depth,
                "sources": sources.iter().take(1 + other).collect::<Vec<_>>(),
            })
        };
        let material = |material: &CuttingMaterial| {
            let data: Vec<Value> = material.data.iter().map(entry).collect();
            json!({ "name": material.name, "title": material.title, "also": material.also, "data": data })
        };
        Value::Array(self.materials.iter().map(material).collect())
    }

    /// A material by its name or another one that it goes by.
    ///
    /// # Errors
    /// `unknown`, with those that are known.
    pub fn material(&self, name: &str) -> Result<&CuttingMaterial, JobError> {
        self.materials.iter().find(|material| material.is_called(name)).ok_or_else(|| {
            let known: Vec<String> = self.materials.iter().map(CuttingMaterial::described).collect();
            let hint = format!("write {}, or add it to a table of your own", known.join(", "));
            JobError::document("unknown", "material", format!("unknown material {name:?}"), hint)
        })
    }
}

impl CuttingMaterial {
    fn is_called(&self, name: &str) -> bool {
        let same = |known: &String| known.eq_ignore_ascii_case(name.trim());
        same(&self.name) || self.also.iter().any(same)
    }

    /// Its name, and what it is.
    fn described(&self) -> String {
        if self.title.is_empty() {
            format!("{:?}", self.name)
        } else {
            format!("{:?} ({})", self.name, self.title)
        }
    }

    /// Adds what another table has of it, behind its own.
    fn take(&mut self, theirs: &Self) {
        if self.title.is_empty() {
            self.title.clone_from(&theirs.title);
        }
        let names = std::iter::once(&theirs.name).chain(&theirs.also).filter(|name| !self.is_called(name)).cloned();
        let names: Vec<String> = names.collect();
        self.also.extend(names);
        self.data.extend(theirs.data.iter().cloned());
    }

    /// What a cutter stands in a work.
    ///
    /// # Errors
    /// `no-cutting-data`, with what there is of this material.
    pub fn entry(&self, cutter: CutterMaterial, work: CuttingWork) -> Result<&CuttingEntry, JobError> {
        let fits = |entry: &&CuttingEntry| entry.cutter == cutter && entry.work.contains(&work);
        self.data.iter().find(fits).ok_or_else(|| {
            let has = |cutter: CutterMaterial| {
                let known = CuttingWork::ALL
                    .into_iter()
                    .filter(|work| self.data.iter().any(|entry| entry.cutter == cutter && entry.work.contains(work)));
                let known: Vec<&str> = known.map(CuttingWork::name).collect();
                (!known.is_empty()).then(|| format!("{}: {}", cutter.name(), known.join(", ")))
            };
            let known: Vec<String> = CutterMaterial::ALL.into_iter().filter_map(has).collect();
            let message = format!("{}: no data of {} with {}", self.name, work.name(), cutter.name());
            let hint = format!("there are data of {}; add yours to a table of your own", known.join("; "));
            JobError::document("no-cutting-data", "material", message, hint)
        })
    }
}

impl CuttingEntry {
    /// Lowest and highest cutting speed, m/min, where it is one.
    #[must_use]
    pub fn speed(&self) -> Option<[f64; 2]> {
        let in_feet = self.speed_ft_min.map(|span| span.ends().map(|speed| FOOT * speed));
        self.speed_m_min.map(Span::ends).or(in_feet)
    }

    /// Diameters and chips, mm.
    #[must_use]
    pub fn chips(&self) -> Vec<[f64; 2]> {
        let in_inches = self.chip_inch.iter().map(|point| point.map(|inches| INCH * inches));
        self.chip_mm.iter().copied().chain(in_inches).collect()
    }

    /// The smallest and the largest diameter for which its chips stand, mm.
    #[must_use]
    pub fn sizes(&self, work: CuttingWork) -> [f64; 2] {
        let chips = self.chips();
        let largest = if work.mills() && self.speed().is_some() { LARGEST_OF_MILLS } else { LARGEST };
        let [first, last] = [chips.first(), chips.last()].map(|point| point.map_or(0.0, |point| point[0]));
        [SMALLEST * first, largest * last]
    }

    /// Where the chips are stated.
    #[must_use]
    pub fn source_of_chips(&self) -> &str {
        self.chip_source.as_ref().unwrap_or(&self.source)
    }

    /// Refuses what is no entry.
    pub(super) fn check(&self, path: &str) -> Result<(), JobError> {
        let wrong = |key: &str, message: &str, hint: &str| {
            Err(JobError::document("cutting-data", format!("{path}.{key}"), message, hint))
        };
        let speeds = [self.speed_m_min.is_some(), self.speed_ft_min.is_some(), self.rpm.is_some()];
        if speeds.into_iter().filter(|stated| *stated).count() != 1 {
            return wrong("speed_m_min", "one speed is expected", "give speed_m_min, speed_ft_min or rpm");
        }
        let ends = self.speed().or(self.rpm.map(|rpm| [rpm; 2])).unwrap_or_default();
        if !is_positive(&ends) || ends[0] > ends[1] {
            return wrong(
                "speed_m_min",
                "a speed is no positive number, or the range runs down",
                "write [lowest, highest]",
            );
        }
        if self.work.is_empty() {
            return wrong("work", "no work is named", "name one: rough-milling, finish-milling, drilling, tapping");
        }
        if !self.chip_mm.is_empty() && !self.chip_inch.is_empty() {
            return wrong("chip_mm", "chips are given twice", "give chip_mm or chip_inch");
        }
        if self.chip_mm.is_empty() && self.chip_inch.is_empty() && self.work != [CuttingWork::Tapping] {
            return wrong("chip_mm", "no chips are given", "give [[diameter, feed per tooth], ...]");
        }
        for (key, points) in [("chip_mm", self.chips()), ("chip_by_depth", self.chip_by_depth.clone())] {
            if !points.iter().all(|point| is_positive(point)) || !points.is_sorted_by(|a, b| a[0] < b[0]) {
                return wrong(key, "expected pairs of positive numbers, the first ones rising", "correct the pairs");
            }
        }
        if self.chip_by_depth.iter().any(|point| point[1] > 1.0) {
            return wrong("chip_by_depth", "a share of more than 1", "write [depth in diameters, share from 0 to 1]");
        }
        Ok(())
    }
}

fn is_positive(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| *number > 0.0 && number.is_finite())
}
