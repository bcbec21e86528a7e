//! Passes as lines, or as lines and arcs where the job asks for them and the machine has them.

use styluscam_motion::{Arc, Cancelled, Move};
use styluscam_toolpath::{link, link_with_arcs, Arcs, Entered, Fitted, LinkRules, Links, PathPoint, Surface};

use super::facts::counted;
use super::{Context, Fact, Fit};

/// A surface whose passes keep the witnesses that arcs, or lines that turn little, are fitted to, where an operation asks for either.
pub fn witnessed<'a>(surface: Surface<'a>, context: &Context<'_>) -> Surface<'a> {
    let has_arcs = context.common.fit == Fit::Arcs && context.machine.arc.is_some();
    match context.common.corner() {
        f64::INFINITY if has_arcs => surface.keeping_witnesses(),
        f64::INFINITY => surface,
        corner => surface.turning(corner),
    }
}

/// The moves along the passes, which arcs leave by at most `deviation` mm, and what there is to say of how they were fitted.
///
/// # Errors
/// `Cancelled`.
pub fn linked(
    context: &Context<'_>,
    (passes, deviation): (Vec<Entered>, f64),
    rules: &impl LinkRules<PathPoint>,
    links: &Links,
) -> Result<(Vec<Move>, Vec<Fact>), Cancelled> {
    let Context { machine, common, reference_height, watch, .. } = *context;
    let corner = common.corner();
    let Some(arc_rules) = machine.arc.as_ref().filter(|_| common.fit == Fit::Arcs) else {
        let moves = if corner < f64::INFINITY {
            link_with_arcs(passes, (&Arcs::none(corner), deviation), rules, links, watch)?.0
        } else {
            link(passes, rules, links, watch)?
        };
        let asked = (common.fit == Fit::Arcs).then(|| no_arcs(&machine.name));
        return Ok((moves, asked.into_iter().collect()));
    };
    let takes = |ends: [[f64; 3]; 2], arc: &Arc| machine.posts_arc(ends, arc, reference_height);
    let arcs = Arcs {
        planes: &arc_rules.planes,
        unit: machine.resolution_mm(),
        height: reference_height,
        takes: &takes,
        corner,
    };
    let (moves, fitted) = link_with_arcs(passes, (&arcs, deviation), rules, links, watch)?;
    Ok((moves, facts(&fitted, &machine.name)))
}

fn facts(fitted: &Fitted, machine: &str) -> Vec<Fact> {
    if fitted.arcs == 0 {
        return vec![no_arcs(machine)];
    }
    let Fitted { chords, pieces, arcs, corner } = *fitted;
    let ratio = chords as f64 / pieces as f64;
    let degrees = corner.to_degrees();
    vec![
        Fact::count(arcs, "arc", "arcs"),
        Fact {
            fact: "chords_per_piece",
            value: ratio,
            unit: "",
            words: format!(
                "{} instead of {}: one for {ratio:.1}",
                counted(pieces, "line or arc", "lines and arcs"),
                counted(chords, "chord", "chords")
            ),
        },
        Fact {
            fact: "corner_at_arcs",
            value: degrees,
            unit: "deg",
            words: format!("corners at arcs up to {degrees:.2} deg"),
        },
    ]
}

/// That lines were planned though arcs were asked for.
fn no_arcs(machine: &str) -> Fact {
    Fact {
        fact: "arcs",
        value: 0.0,
        unit: "",
        words: format!("no arcs, for {machine} has none for these passes: lines"),
    }
}
