//! Random tools of every kind of profile.

use styluscam_geometry::{ModelFace, Sheet, SheetLaw, Tool};

use super::dice::Dice;

/// A kind of tools: its name, and a random profile document of a diameter, or as near to it as the kind's keys allow.
pub struct Kind {
    pub name: &'static str,
    profile: fn(&mut Dice, f64) -> serde_json::Value,
}

macro_rules! kind {
    ($name:literal, |$dice:ident, $d:ident| $profile:expr) => {
        Kind { name: $name, profile: |$dice, $d| $profile }
    };
}

/// Every kind of profile, some in more than one form.
pub const KINDS: [Kind; 20] = [
    kind!("ball", |_dice, d| serde_json::json!({"kind": "ball", "diameter": d})),
    kind!("ball, part of one", |dice, d| {
        serde_json::json!({"kind": "ball", "diameter": d, "radius": d * dice.scale(0.51, 5.0)})
    }),
    kind!("flat", |_dice, d| serde_json::json!({"kind": "flat", "diameter": d})),
    kind!("cycloid", |_dice, d| serde_json::json!({"kind": "cycloid", "diameter": d})),
    kind!("clothoid", |_dice, d| serde_json::json!({"kind": "clothoid", "diameter": d})),
    kind!("clothoid, part of one", |dice, d| {
        serde_json::json!({"kind": "clothoid", "diameter": d, "end_slope_deg": dice.within(5.0, 85.0)})
    }),
    kind!("parabola", |dice, d| {
        serde_json::json!({"kind": "parabola", "apex_radius": d * dice.scale(0.05, 3.0), "diameter": d})
    }),
    kind!("ellipse", |dice, d| {
        serde_json::json!({"kind": "ellipse", "radial": 0.5 * d, "axial": d * dice.scale(0.05, 3.0)})
    }),
    kind!("power", |dice, d| {
        let exponent = dice.within(1.1, 5.0);
        let coefficient = d * dice.scale(0.05, 1.0) / libm::pow(0.5 * d, exponent);
        serde_json::json!({"kind": "power", "coefficient": coefficient, "exponent": exponent, "diameter": d})
    }),
    kind!("rounded-rectangle", |dice, d| {
        serde_json::json!({"kind": "rounded-rectangle", "diameter": d, "corner_radius": d * dice.scale(0.005, 0.3)})
    }),
    kind!("bull-nose", |dice, d| {
        serde_json::json!({"kind": "bull-nose", "diameter": d, "corner_radius": d * dice.scale(0.005, 0.3)})
    }),
    kind!("barrel", |dice, d| {
        let (radius, tip_radius) = (d * dice.scale(0.6, 20.0), d * dice.within(0.02, 0.3));
        serde_json::json!({"kind": "barrel", "diameter": d, "radius": radius, "tip_radius": tip_radius})
    }),
    kind!("cone, sharp", |dice, d| {
        serde_json::json!({"kind": "cone", "tip_radius": 0.0, "half_angle_deg": dice.within(2.0, 88.0), "diameter": d})
    }),
    kind!("cone", |dice, d| {
        let (tip_radius, half_angle_deg) = (d * dice.within(0.01, 0.25), dice.within(2.0, 88.0));
        serde_json::json!({"kind": "cone", "tip_radius": tip_radius, "half_angle_deg": half_angle_deg, "diameter": d})
    }),
    kind!("tapered-ball", |dice, d| {
        let (tip_radius, angle) = (d * dice.within(0.05, 0.3), dice.within(1.0, 60.0));
        serde_json::json!({"kind": "tapered-ball", "tip_radius": tip_radius, "half_angle_deg": angle, "diameter": d})
    }),
    kind!("v", |dice, d| {
        let (tip_diameter, angle_deg) = (d * dice.within(0.0, 0.5), dice.within(5.0, 175.0));
        serde_json::json!({"kind": "v", "tip_diameter": tip_diameter, "angle_deg": angle_deg, "diameter": d})
    }),
    kind!("points", |dice, d| {
        let (exponent, steepness, count) = (dice.within(1.4, 3.0), dice.scale(0.1, 1.0), 8 + dice.below(12));
        let point = |i: usize| {
            let share = i as f64 / count as f64;
            [0.5 * d * share, d * steepness * libm::pow(share, exponent)]
        };
        let points: Vec<[f64; 2]> = (0..=count).map(point).collect();
        serde_json::json!({"kind": "points", "points": points, "fit_tolerance": 0.01})
    }),
    kind!("formula z(r)", |dice, d| {
        serde_json::json!({"kind": "formula", "z": format!("r^2 / {}", d * dice.scale(0.2, 3.0)), "diameter": d})
    }),
    kind!("formula r(t), z(t)", |dice, d| {
        let z = format!("{} * (1 - cos(t))", d * dice.scale(0.2, 2.0));
        serde_json::json!({"kind": "formula", "r": format!("{} * sin(t)", 0.5 * d), "z": z, "t": [0.0, 1.5]})
    }),
    kind!("formula f(r, z) = 0", |dice, d| {
        let (radial, axial) = (0.5 * d, d * dice.scale(0.2, 2.0));
        let implicit = format!("(r/{radial})^2 + (z/{axial} - 1)^2 - 1");
        serde_json::json!({"kind": "formula", "implicit": implicit, "start": [radial, axial]})
    }),
];

impl Kind {
    /// A tool of 1 to 20 mm diameter; some have a flat at the tip.
    pub fn tool(&self, dice: &mut Dice) -> Tool {
        let (d, tip_flat) = (dice.scale(1.0, 20.0), if dice.chance(0.35) { dice.within(0.01, 0.12) } else { 0.0 });
        let mut profile = (self.profile)(dice, d);
        profile["tip_flat"] = (tip_flat * d).into();
        let document = serde_json::from_value(serde_json::json!({ "profile": profile })).unwrap();
        Tool::new(document).unwrap_or_else(|error| panic!("{profile}: {error}"))
    }
}

/// Often none; each law and each face of the model.
pub fn sheet(dice: &mut Dice) -> Option<Sheet> {
    if dice.chance(0.7) {
        return None;
    }
    let law = if dice.chance(0.5) { SheetLaw::Constant } else { SheetLaw::Sine };
    let model_face = [ModelFace::Tool, ModelFace::Mid, ModelFace::Back][dice.below(3)];
    Some(Sheet { thickness: dice.scale(0.1, 4.0), law, model_face })
}

/// Often none, mm.
pub fn margin(dice: &mut Dice) -> f64 {
    if dice.chance(0.8) {
        0.0
    } else {
        dice.scale(1e-4, 2.0)
    }
}
