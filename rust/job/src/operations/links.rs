//! Links from pass to pass: at clearance, or as low as what stands under them allows, with leads into passes and out of them.

use styluscam_motion::{Arc, Cancelled, Move, MoveKind, Role};
use styluscam_post::machine::{CommentForm, Rapids};
use styluscam_toolpath::{
    Across, AlongSurface, Entered, LeadRule, LeadShape, Leading, LinkRules, Links, Low, PathPoint, Seam, Standing,
};

use super::facts::counted;
use super::{fit, Context, Fact, LeadForm, LinkHeight};

/// Heights that differ by less are one, mm.
const SAME: f64 = 1e-9;

/// What links go over, and how.
struct Over<'a> {
    standing: &'a Standing<'a>,
    across: Option<Across>,
    links: &'a Links,
}

/// The moves along passes on a surface, which arcs leave by at most a deviation, mm, and what there is to say of them. Where links
/// may go `across`, the longest that `along` has go straight over what the passes leave out.
///
/// # Errors
/// `Cancelled`.
pub fn linked(
    context: &Context<'_>,
    (mut passes, seam, deviation): (Vec<Entered>, Seam, f64),
    (along, across): (AlongSurface<'_>, bool),
    links: &Links,
) -> Result<(Vec<Move>, Vec<Fact>), Cancelled> {
    let Context { machine, common, reference_height, scene, .. } = *context;
    // inside a loop sheet hangs no higher than that; stock stays until it is cut
    let is_sheet = scene.sheet.is_some();
    let standing = Standing::new(along.surface, scene.top, (&passes, is_sheet), deviation);
    // a remark states that they are links, so that what lies under them is no missing pass
    let may_cross = across && !is_sheet && machine.comment.form != CommentForm::None;
    let over = Over {
        standing: &standing,
        across: may_cross.then_some(Across { longest: along.longest, feed: along.feed }),
        links,
    };
    let Some(shape) = shape(common.lead) else {
        return with_heights(context, (passes, deviation), along, &over);
    };
    if machine.comment.form == CommentForm::None {
        let (moves, mut facts) = with_heights(context, (passes, deviation), along, &over)?;
        facts.push(no_leads(&machine.name));
        return Ok((moves, facts));
    }
    let planes = machine.arc.as_ref().map_or(&[][..], |rules| &rules.planes);
    let takes =
        |ends: [[f64; 3]; 2], arc: &Arc| planes.contains(&arc.plane) && machine.posts_arc(ends, arc, reference_height);
    let lead = LeadRule {
        shape,
        radius: common.lead_radius,
        angle: common.lead_angle_deg.to_radians(),
        feeds: [common.feeds.approaching(), common.feeds.leaving()],
        deviation,
    };
    let leading = Leading { rules: along, standing: &standing, is_sheet, lead, takes: &takes };
    let moved = match seam {
        Seam::Nearest => leading.begin_where_they_fit(&mut passes, context.watch)?,
        Seam::Bearing { .. } => 0,
    };
    let (moves, mut facts) = with_heights(context, (passes, deviation), leading, &over)?;
    facts.push(leads(&moves, moved, seam));
    Ok((moves, facts))
}

/// About how high rapids of an operation cross, mm.
pub fn crossing_height(context: &Context<'_>) -> f64 {
    let Context { machine, common, scene, .. } = *context;
    match common.links {
        LinkHeight::Low if machine.motion.rapids != Rapids::DogLeg => {
            (scene.top + common.link_margin).min(scene.clearance)
        }
        LinkHeight::Low | LinkHeight::Clearance => scene.clearance,
    }
}

/// Leads touch nothing, which a remark has to state.
fn no_leads(machine: &str) -> Fact {
    let words = format!("no leads, for texts of {machine} have no remarks that state them");
    Fact { fact: "leads", value: 0.0, unit: "", words }
}

fn shape(form: LeadForm) -> Option<LeadShape> {
    match form {
        LeadForm::None => None,
        LeadForm::Tangent => Some(LeadShape::Tangent),
        LeadForm::Vertical => Some(LeadShape::Vertical),
    }
}

/// The moves by some rules, whose rapids go as high as the operation states.
fn with_heights(
    context: &Context<'_>,
    passes: (Vec<Entered>, f64),
    rules: impl LinkRules<PathPoint>,
    &Over { standing, across, links }: &Over<'_>,
) -> Result<(Vec<Move>, Vec<Fact>), Cancelled> {
    let Context { machine, common, .. } = *context;
    match common.links {
        LinkHeight::Clearance => fit::linked(context, passes, &rules, links),
        LinkHeight::Low if machine.motion.rapids == Rapids::DogLeg => {
            let (moves, mut facts) = fit::linked(context, passes, &rules, links)?;
            facts.push(no_low_links(&machine.name));
            Ok((moves, facts))
        }
        LinkHeight::Low => {
            let low = Low { rules, standing, margin: common.link_margin, across };
            let (moves, mut facts) = fit::linked(context, passes, &low, links)?;
            facts.extend(travelled(&moves, links.heights.clearance));
            Ok((moves, facts))
        }
    }
}

/// How many times the tool comes to a pass, or leaves it, along a lead; where none fits it goes straight. So many loops begin
/// elsewhere for them.
fn leads(moves: &[Move], moved: usize, seam: Seam) -> Fact {
    let is_lead = |step: &Move| step.role == Some(Role::Lead);
    let is_rapid = |step: &Move| step.kind == MoveKind::Rapid;
    // in: a rapid, the feed down, the lead; out: the lead, a rapid
    let landings = moves.windows(3).filter(|three| is_rapid(&three[0]) && !is_rapid(&three[1]));
    let [into, straight_in] = parted(landings.map(|three| is_lead(&three[2])));
    let departures = moves.windows(2).filter(|pair| !is_rapid(&pair[0]) && is_rapid(&pair[1]));
    let [out, straight_out] = parted(departures.map(|pair| is_lead(&pair[0])));
    let mut words = format!("{into} leads in and {out} out");
    if moved > 0 {
        words += &format!("; {} where they fit", counted(moved, "loop begins", "loops begin"));
    }
    if straight_in + straight_out > 0 {
        words += &format!("; none fits {straight_in} times in and {straight_out} out: straight there");
        if seam != Seam::Nearest {
            words += " (without seam_direction_deg and seam_spread_deg loops begin where leads fit)";
        }
    }
    Fact { fact: "leads", value: (into + out) as f64, unit: "", words }
}

/// How many are, and how many are not.
fn parted(all: impl Iterator<Item = bool>) -> [usize; 2] {
    all.fold([0, 0], |[are, not], is| if is { [are + 1, not] } else { [are, not + 1] })
}

fn no_low_links(machine: &str) -> Fact {
    Fact {
        fact: "low_links",
        value: 0.0,
        unit: "",
        words: format!("no links below clearance, for rapids of {machine} are not known to go straight"),
    }
}

/// How many links stay below clearance, and how far the tool moves through the air: with them, and had they gone there.
fn travelled(moves: &[Move], clearance: f64) -> [Fact; 2] {
    let (mut low, mut length, mut over_clearance) = (0, 0.0, 0.0);
    let mut rest = moves;
    let mut from: Option<[f64; 3]> = None;
    while let Some(first) = rest.first() {
        if first.kind != MoveKind::Rapid {
            from = Some(first.end.tip);
            rest = &rest[1..];
            continue;
        }
        let rapids = rest.iter().take_while(|step| step.kind == MoveKind::Rapid).count();
        // the feed after the rapids comes down
        let air = &rest[..(rapids + 1).min(rest.len())];
        let start = from.unwrap_or(first.end.tip);
        let ends = air.iter().map(|step| step.end.tip);
        let points: Vec<[f64; 3]> = std::iter::once(start).chain(ends).collect();
        length += points.windows(2).map(|pair| apart(pair[0], pair[1])).sum::<f64>();
        let (end, highest) = (points[points.len() - 1], points.iter().fold(f64::NEG_INFINITY, |a, p| a.max(p[2])));
        over_clearance +=
            (clearance - start[2]) + (clearance - end[2]) + libm::hypot(end[0] - start[0], end[1] - start[1]);
        low += usize::from(highest < clearance - SAME);
        from = Some(end);
        rest = &rest[air.len()..];
    }
    let words = format!(
        "{} below clearance: {length:.1} mm through the air instead of {over_clearance:.1} mm",
        counted(low, "link", "links")
    );
    [
        Fact { fact: "low_links", value: low as f64, unit: "", words },
        Fact::length("air", length, "through the air, rapids and plunges,"),
    ]
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|i| b[i] - a[i]);
    (x * x + y * y + z * z).sqrt()
}
