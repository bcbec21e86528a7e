//! How steep a wall sheets of known materials bear in one pass: shipped data files, each number with its source.
//!
//! Between measured thicknesses angles are interpolated; beyond them the nearest one holds.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};
use styluscam_verify::WallAngleSource;

use crate::{JobDocument, JobError, SheetSection};

/// The data files.
const FILES: [&str; 2] = [include_str!("materials/sheet-metal.toml"), include_str!("materials/pvc.toml")];

static SHIPPED: LazyLock<Vec<Material>> =
    LazyLock::new(|| FILES.iter().filter_map(|text| toml::from_str(text).ok()).collect());

/// A material of sheets.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Its name in a job.
    pub name: String,
    /// What it is.
    pub title: String,
    /// How steep a wall it withstands, in the order of the thicknesses.
    pub angles: Vec<Angle>,
}

/// A wall angle that a source states.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Angle {
    /// Thickness before, mm; any where it is not stated.
    pub thickness: Option<f64>,
    /// Steepest wall, degrees.
    pub most_deg: f64,
    /// Walls up to this angle are sure, degrees; up to the steepest where it is left out.
    pub sure_deg: Option<f64>,
    /// Where it is stated.
    pub source: String,
}

/// The shipped materials.
#[must_use]
pub fn materials() -> &'static [Material] {
    &SHIPPED
}

/// The wall angle that a sheet withstands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallAngle {
    /// Steepest wall, degrees.
    pub most_deg: f64,
    /// Walls up to this angle are sure, degrees.
    pub sure_deg: f64,
    /// Whence that is known.
    pub source: WallAngleSource,
}

/// What the job's sheet withstands: what the job states, what is known of its material, or what is known of all.
pub(crate) fn wall_angle(job: &JobDocument, sheet: &SheetSection) -> WallAngle {
    if let Some(most_deg) = sheet.max_wall_angle_deg {
        return WallAngle { most_deg, sure_deg: f64::INFINITY, source: WallAngleSource::Job };
    }
    if let Some(material) = job.process.common.material.as_deref().and_then(named) {
        let [sure_deg, most_deg] = material.bears(sheet.thickness);
        return WallAngle { most_deg, sure_deg, source: WallAngleSource::Material(&material.name) };
    }
    let known = SHIPPED.iter().map(|material| material.bears(sheet.thickness));
    let [sure_deg, most_deg] = known.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or([f64::INFINITY; 2]);
    WallAngle { most_deg, sure_deg, source: WallAngleSource::Unknown }
}

/// Refuses a material that is not known.
///
/// # Errors
/// `unknown`, with those that are.
pub(crate) fn check(name: &str) -> Result<(), JobError> {
    if named(name).is_some() {
        return Ok(());
    }
    let known: Vec<String> =
        SHIPPED.iter().map(|material| format!("{:?} ({})", material.name, material.title)).collect();
    Err(JobError::document(
        "unknown",
        "process.material",
        format!("unknown material {name:?}"),
        format!(
            "write {}, or give the wall angle that your sheet withstands as setup.sheet.max_wall_angle_deg",
            known.join(" or ")
        ),
    ))
}

fn named(name: &str) -> Option<&'static Material> {
    SHIPPED.iter().find(|material| material.name.eq_ignore_ascii_case(name.trim()))
}

impl Material {
    /// Sure and steepest angle at a thickness, degrees.
    fn bears(&self, thickness: f64) -> [f64; 2] {
        let at = |angle: &Angle| [angle.sure_deg.unwrap_or(angle.most_deg), angle.most_deg];
        let beyond = self.angles.iter().find(|angle| angle.thickness.is_none_or(|known| known >= thickness));
        let before = self.angles.iter().rev().find(|angle| angle.thickness.is_none_or(|known| known <= thickness));
        match (before, beyond) {
            (Some(low), Some(high)) => {
                let ends = low.thickness.zip(high.thickness).filter(|(low, high)| low < high);
                let share = ends.map_or(0.0, |(low, high)| (thickness - low) / (high - low));
                let [low, high] = [at(low), at(high)];
                [0, 1].map(|i| low[i] + share * (high[i] - low[i]))
            }
            (Some(only), None) | (None, Some(only)) => at(only),
            (None, None) => [f64::INFINITY; 2],
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // sums and halves of whole numbers are exact
mod tests {
    use super::*;

    #[test]
    fn every_file_is_read_and_every_number_has_its_source() {
        assert_eq!(SHIPPED.len(), FILES.len());
        for material in SHIPPED.iter() {
            assert!(!material.angles.is_empty(), "{}", material.name);
            assert!(material.angles.is_sorted_by_key(|angle| angle.thickness), "{}", material.name);
            for angle in &material.angles {
                assert!(angle.source.len() > 10, "{}", material.name);
                assert!((20.0..90.0).contains(&angle.most_deg), "{}", material.name);
                assert!(angle.sure_deg.is_none_or(|sure| sure <= angle.most_deg), "{}", material.name);
            }
        }
    }

    #[test]
    fn angles_between_thicknesses_are_interpolated_and_beyond_them_the_nearest() {
        let angle =
            |thickness, most_deg| Angle { thickness: Some(thickness), most_deg, sure_deg: None, source: String::new() };
        let material =
            Material { name: String::new(), title: String::new(), angles: vec![angle(1.0, 60.0), angle(2.0, 70.0)] };
        for (thickness, expected) in [(0.5, 60.0), (1.0, 60.0), (1.25, 62.5), (2.0, 70.0), (5.0, 70.0)] {
            assert_eq!(material.bears(thickness), [expected; 2]);
        }
    }
}
