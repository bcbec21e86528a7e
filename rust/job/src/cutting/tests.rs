//! Each rule by hand, and every number with its source.

use styluscam_geometry::{kinds, Cutter, CutterMaterial, ProfileDocument, Tool, ToolDocument};

use super::*;
use crate::JobError;

fn flat(diameter: f64) -> Cutter {
    made(kinds::Flat { diameter, tip_flat: 0.0 }.into())
}

fn ball(diameter: f64) -> Cutter {
    made(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }.into())
}

fn made(profile: ProfileDocument) -> Cutter {
    Tool::new(ToolDocument::of(profile)).unwrap().cutter()
}

fn rough(cutter: &Cutter) -> Cut<'_> {
    Cut {
        cutter,
        cutter_material: CutterMaterial::Carbide,
        flutes: Some(2),
        material: "aluminium",
        work: CuttingWork::RoughMilling,
        engagement: Engagement::default(),
        pitch: None,
        limits: MachineLimits::default(),
    }
}

fn found(cut: &Cut<'_>) -> CuttingData {
    cutting_data(cut, CuttingTable::shipped()).unwrap()
}

fn refused(cut: &Cut<'_>) -> (String, String, String) {
    let error = cutting_data(cut, CuttingTable::shipped()).unwrap_err();
    (error.code().to_owned(), error.location(), format!("{error}; {}", error.hint()))
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found} instead of {expected}");
}

#[test]
fn every_file_is_read_and_every_number_has_its_source() {
    let shipped = CuttingTable::shipped();
    let stated: usize = shipped_texts().iter().map(|text| text.matches("[[materials]]").count()).sum();
    assert_eq!(shipped.materials.len(), stated);
    for material in &shipped.materials {
        assert!(!material.title.is_empty() && !material.data.is_empty(), "{}", material.name);
        for (k, entry) in material.data.iter().enumerate() {
            entry.check(&format!("{}[{k}]", material.name)).unwrap();
            for source in [&entry.source, entry.source_of_chips()] {
                assert!(source.len() > 30 && source != "the shop's table", "{}: {source}", material.name);
            }
            let [low, high] = entry.speed().unwrap_or([entry.rpm.unwrap_or_default(); 2]);
            assert!(low >= 1.0 && high <= 20_000.0, "{}", material.name);
            assert!(entry.chips().iter().all(|[d, chip]| *chip < 0.05 * d), "{}", material.name);
        }
    }
    let mut names: Vec<&str> =
        shipped.materials.iter().flat_map(|m| m.also.iter().chain([&m.name])).map(String::as_str).collect();
    names.sort_unstable();
    assert!(names.is_sorted_by(|a, b| a < b), "two materials go by one name: {names:?}");
}

#[test]
fn speed_and_feed_follow_from_the_table() {
    // 367 m/min; 0.04 mm at 6 mm
    let data = found(&rough(&flat(6.0)));
    near(data.rpm, 367_000.0 / (6.0 * std::f64::consts::PI));
    near(data.feed, 0.04 * 2.0 * data.rpm);
    near(data.plunge, 0.04 * data.rpm);
    near(data.speed_m_min, 367.0);
    near(data.chip, 0.04);
    assert!(data.sources[0].contains("atagroup") && data.sources.len() == 1);
    // 440 m/min
    near(found(&Cut { work: CuttingWork::FinishMilling, ..rough(&flat(6.0)) }).speed_m_min, 440.0);
}

#[test]
fn feet_and_inches_are_converted_and_the_lower_end_of_a_range_counts() {
    // 800 to 1500 ft/min; 0.001 in at 1/8 in
    let data = found(&Cut { material: "brass", ..rough(&flat(3.175)) });
    near(data.speed_m_min, 800.0 * 0.3048);
    near(data.feed_per_tooth, 0.0254);
    assert!(data.reasons[0].contains("457.2 is allowed"), "{:?}", data.reasons);
}

#[test]
fn chips_between_sizes_are_interpolated_below_in_proportion_and_above_the_largest() {
    for (diameter, expected) in [(7.0, 0.05), (1.5, 0.005), (14.0, 0.12), (18.0, 0.14), (100.0, 0.16)] {
        near(found(&rough(&flat(diameter))).feed_per_tooth, expected);
    }
    assert!(found(&rough(&flat(1.5))).reasons.iter().any(|words| words.contains("the table begins at 3 mm")));
    assert!(found(&rough(&flat(100.0))).reasons.iter().any(|words| words.contains("the table ends at 20 mm")));
    for diameter in [0.2, 101.0] {
        let (code, location, words) = refused(&rough(&flat(diameter)));
        assert_eq!((code.as_str(), location.as_str()), ("out-of-range", "diameter"));
        assert!(words.contains("3 to 20 mm"), "{words}");
    }
}

#[test]
fn a_narrow_cut_is_fed_faster_by_the_sine_of_its_angle() {
    // a tenth of the diameter: cos = 0.8, sine = 0.6
    let cutter = flat(6.0);
    let engaged = |engagement| found(&Cut { engagement, ..rough(&cutter) });
    let narrow = engaged(Engagement { width: Some(0.6), ..Engagement::default() });
    near(narrow.feed_per_tooth, 0.04 / 0.6);
    near(narrow.chip, 0.04);
    near(narrow.plunge, 0.04 * narrow.rpm);
    near(engaged(Engagement { angle_deg: Some(30.0), ..Engagement::default() }).feed_per_tooth, 0.08);
    for wide in [Some(3.0), Some(6.0)] {
        near(engaged(Engagement { width: wide, ..Engagement::default() }).feed_per_tooth, 0.04);
    }
    near(engaged(Engagement { angle_deg: Some(120.0), ..Engagement::default() }).feed_per_tooth, 0.04);
    // sine 2 sqrt(0.001 x 0.999): 0.632 mm per tooth would leave marks farther apart than passes of 0.006 mm
    near(engaged(Engagement { width: Some(0.006), ..Engagement::default() }).feed_per_tooth, 0.006);
}

#[test]
fn a_ball_cuts_with_the_circle_at_its_depth() {
    // 10 mm wide, 1 mm deep: 2 sqrt(1 x 9) = 6 mm wide there, at a slope whose sine is 3 / 5; Fanar's catalogue lists 6.000 mm
    let cutter = ball(10.0);
    let deep = |depth, width| {
        found(&Cut { engagement: Engagement { width, depth: Some(depth), angle_deg: None }, ..rough(&cutter) })
    };
    let data = deep(1.0, None);
    near(data.diameter, 6.0);
    near(data.rpm, 367_000.0 / (6.0 * std::f64::consts::PI));
    near(data.feed_per_tooth, 0.08 / 0.6);
    near(data.chip, 0.08);
    near(deep(1.0, Some(0.6)).feed_per_tooth, 0.08 / 0.36);
    // rows of the same table: 10 mm wide at 0.1, 0.5, 2 and 5 mm
    for (depth, listed) in [(0.1, 1.990), (0.5, 4.359), (2.0, 8.000), (5.0, 10.000)] {
        assert!((deep(depth, None).diameter - listed).abs() <= 6e-4, "{depth}");
    }
}

#[test]
fn any_convex_profile_cuts_with_its_circle_at_the_depth() {
    // a cone of 90 degrees: 2 mm wide at 1 mm, sine of 45 degrees
    let cone = made(kinds::V { tip_diameter: 0.0, angle_deg: 90.0, diameter: 10.0, tip_flat: 0.0 }.into());
    let data = found(&Cut { engagement: Engagement { depth: Some(1.0), ..Engagement::default() }, ..rough(&cone) });
    near(data.diameter, 2.0);
    near(data.feed_per_tooth, 0.08 * std::f64::consts::SQRT_2);
    // a bull-nose cutter of 10 mm with corners of 2 mm: at 1 mm the corner's circle is 2 sin 60 = 1.7321 beyond the flat of 3 mm radius
    let bull = made(kinds::BullNose { diameter: 10.0, corner_radius: 2.0, tip_flat: 0.0 }.into());
    let data = found(&Cut { engagement: Engagement { depth: Some(1.0), ..Engagement::default() }, ..rough(&bull) });
    near(data.diameter, 6.0 + 2.0 * 3.0_f64.sqrt());
    near(data.feed_per_tooth, 0.08 / (0.5 * 3.0_f64.sqrt()));
}

#[test]
fn the_machine_s_limits_hold_and_the_feed_follows_the_spindle() {
    let cutter = flat(6.0);
    let limited = |limits| found(&Cut { limits, ..rough(&cutter) });
    let slow = limited(MachineLimits { max_rpm: Some(12_000.0), ..MachineLimits::default() });
    assert_eq!([slow.rpm, slow.feed, slow.plunge], [12_000.0, 960.0, 480.0]);
    near(slow.speed_m_min, 0.072 * std::f64::consts::PI * 1000.0);
    assert!(slow.reasons[1].contains("no faster than 12000"), "{:?}", slow.reasons);
    let fast = limited(MachineLimits { min_rpm: Some(24_000.0), ..MachineLimits::default() });
    assert_eq!([fast.rpm, fast.feed], [24_000.0, 1920.0]);
    let fed = limited(MachineLimits { max_rpm: Some(12_000.0), max_feed: Some(300.0), ..MachineLimits::default() });
    assert_eq!([fed.rpm, fed.feed, fed.plunge], [12_000.0, 300.0, 300.0]);
    near(fed.chip, 0.04 * 300.0 / 960.0);
}

#[test]
fn holes_are_fed_by_the_revolution_and_threads_by_their_pitch() {
    let cutter = flat(6.35);
    let hole =
        Cut { work: CuttingWork::Drilling, cutter_material: CutterMaterial::Hss, flutes: None, ..rough(&cutter) };
    let data = found(&hole);
    near(data.speed_m_min, 300.0 * 0.3048);
    near(data.feed, 0.006 * 25.4 * data.rpm);
    assert_eq!(data.plunge, data.feed);
    let thread = Cut { work: CuttingWork::Tapping, pitch: Some(1.0), ..hole };
    let data = found(&thread);
    near(data.speed_m_min, 82.0 * 0.3048);
    assert_eq!(data.feed, data.rpm);
    let slow = found(&Cut { limits: MachineLimits { max_feed: Some(500.0), ..MachineLimits::default() }, ..thread });
    assert_eq!([slow.rpm, slow.feed], [500.0, 500.0]);
    assert_eq!(refused(&Cut { pitch: None, ..thread }).0, "missing");
}

#[test]
fn a_source_s_rule_for_depth_is_kept() {
    // wood: 18000 rev/min; 0.005 in at 1/4 in, three quarters of it at two diameters
    let cutter = flat(6.35);
    let deep = |diameters: f64| {
        let engagement = Engagement { depth: Some(6.35 * diameters), ..Engagement::default() };
        found(&Cut { material: "wood", engagement, ..rough(&cutter) })
    };
    for (diameters, share) in [(0.5, 1.0), (1.0, 1.0), (1.5, 0.875), (2.0, 0.75), (4.0, 0.5)] {
        assert_eq!(deep(diameters).rpm, 18_000.0);
        near(deep(diameters).feed_per_tooth, 0.127 * share);
    }
}

#[test]
fn what_is_not_known_lists_what_is() {
    let cutter = flat(6.0);
    let (code, _, words) = refused(&Cut { material: "unobtainium", ..rough(&cutter) });
    assert_eq!(code, "unknown");
    for name in CuttingTable::shipped().materials.iter().map(|material| &material.name) {
        assert!(words.contains(&format!("{name:?}")), "{name} in {words}");
    }
    let (code, _, words) = refused(&Cut { material: "wood", cutter_material: CutterMaterial::Hss, ..rough(&cutter) });
    assert_eq!(code, "no-cutting-data");
    assert!(words.contains("carbide: rough-milling, finish-milling"), "{words}");
    assert_eq!(found(&Cut { material: "Aluminum", ..rough(&cutter) }), found(&rough(&cutter)));
    assert_eq!(CuttingWork::named("turning").unwrap_err().code(), "unknown");
    for work in CuttingWork::ALL {
        assert_eq!(CuttingWork::named(work.name()), Ok(work));
    }
}

#[test]
fn small_and_large_cutters_are_known_in_every_material() {
    for material in &CuttingTable::shipped().materials {
        for diameter in [0.5, 1.0, 3.0, 6.0, 12.0, 20.0] {
            for work in [CuttingWork::RoughMilling, CuttingWork::FinishMilling] {
                let data = found(&Cut { material: &material.name, work, ..rough(&flat(diameter)) });
                assert!(data.feed > 0.0 && data.chip < 0.05 * diameter, "{} {diameter}", material.name);
            }
        }
    }
}

#[test]
fn numbers_that_are_no_sizes_are_refused() {
    let cutter = flat(6.0);
    let engaged =
        |width, angle_deg, depth| Cut { engagement: Engagement { width, angle_deg, depth }, ..rough(&cutter) };
    let limits =
        |min_rpm, max_rpm, max_feed| Cut { limits: MachineLimits { min_rpm, max_rpm, max_feed }, ..rough(&cutter) };
    for (cut, expected) in [
        (engaged(Some(6.1), None, None), ("out-of-range", "width")),
        (engaged(Some(f64::NAN), None, None), ("out-of-range", "width")),
        (engaged(None, Some(181.0), None), ("out-of-range", "angle_deg")),
        (engaged(None, None, Some(0.0)), ("out-of-range", "depth")),
        (engaged(Some(1.0), Some(60.0), None), ("conflict", "angle_deg")),
        (limits(Some(-1.0), None, None), ("out-of-range", "min_rpm")),
        (limits(None, Some(0.0), None), ("out-of-range", "max_rpm")),
        (limits(None, None, Some(f64::INFINITY)), ("out-of-range", "max_feed")),
        (limits(Some(2000.0), Some(1000.0), None), ("conflict", "min_rpm")),
        (Cut { flutes: None, ..rough(&cutter) }, ("missing", "flutes")),
        (Cut { flutes: Some(0), ..rough(&cutter) }, ("missing", "flutes")),
    ] {
        let (code, location, words) = refused(&cut);
        assert_eq!((code.as_str(), location.as_str()), expected, "{words}");
    }
}

const SHOP: &str = r#"
[[materials]]
name = "aluminium"
data = [{ cutter = "carbide", work = ["rough-milling"], speed_m_min = 200, chip_mm = [[6, 0.02]] }]

[[materials]]
name = "bronze"
title = "phosphor bronze"
data = [{ cutter = "hss", work = ["drilling"], rpm = 1000, chip_mm = [[6, 0.1]], source = "trial of 3 May" }]
"#;

#[test]
fn a_shop_s_table_goes_before_the_shipped_one() {
    let table = CuttingTable::from_toml(SHOP).unwrap().before(CuttingTable::shipped());
    let cutter = flat(6.0);
    let data = cutting_data(&rough(&cutter), &table).unwrap();
    near(data.speed_m_min, 200.0);
    near(data.feed_per_tooth, 0.02);
    assert_eq!(data.sources, ["the shop's table"]);
    // by its other name too, and what it does not have comes from the shipped one
    near(cutting_data(&Cut { material: "aluminum", ..rough(&cutter) }, &table).unwrap().speed_m_min, 200.0);
    near(cutting_data(&Cut { work: CuttingWork::FinishMilling, ..rough(&cutter) }, &table).unwrap().speed_m_min, 440.0);
    let bronze =
        Cut { material: "bronze", work: CuttingWork::Drilling, cutter_material: CutterMaterial::Hss, ..rough(&cutter) };
    assert_eq!(cutting_data(&bronze, &table).unwrap().feed, 100.0);
    assert_eq!(table.materials.len(), CuttingTable::shipped().materials.len() + 1);
}

#[test]
fn a_shop_s_table_that_is_wrong_is_refused_with_the_place() {
    let refused = |text: &str| -> JobError { CuttingTable::from_toml(text).unwrap_err() };
    assert_eq!(refused("materials = 1\n\nx").location(), "line 3");
    for (from, to, key) in [
        ("speed_m_min = 200,", "", "speed_m_min"),
        ("speed_m_min = 200,", "speed_m_min = 200, rpm = 3,", "speed_m_min"),
        ("speed_m_min = 200,", "speed_m_min = [200, 100],", "speed_m_min"),
        ("speed_m_min = 200,", "speed_m_min = -1,", "speed_m_min"),
        ("[[6, 0.02]]", "[]", "chip_mm"),
        ("[[6, 0.02]]", "[[6, 0.02], [6, 0.03]]", "chip_mm"),
        ("[[6, 0.02]]", "[[6, 0.02]], chip_inch = [[1, 0.1]]", "chip_mm"),
        ("[[6, 0.02]]", "[[6, 0.02]], chip_by_depth = [[1, 0]]", "chip_by_depth"),
        ("[[6, 0.02]]", "[[6, 0.02]], chip_by_depth = [[1, 1.5]]", "chip_by_depth"),
        (r#"["rough-milling"]"#, "[]", "work"),
    ] {
        let error = refused(&SHOP.replacen(from, to, 1));
        assert_eq!(error.location(), format!("materials[0].data[0].{key}"), "{to}");
        assert_eq!(error.code(), "cutting-data");
    }
}
