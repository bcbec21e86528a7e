//! Two programs that form one sheet from both sides: equal numbers of moves, in equal times, with the sheet between the tools.

mod apart;
mod pace;

use rayon::prelude::*;
use styluscam_geometry::{ToolBody, Vector};
use styluscam_motion::{Cancelled, MoveKind, Program, Watch};

use crate::body::Body;
use crate::clearance::Prober;
use crate::convex::{lower, Tangent};
use crate::faults::{self, Fault};
use crate::findings::{Finding, FindingKind, Severity};
use crate::segments::{placed, Segment};
use crate::subject::{Left, Limits, Pairing, Partner, Subject};
use crate::tolerances::{ROOM, SLACK};

use apart::{apart, NOTHING};

/// What the check of a pair found.
#[derive(Default)]
pub(crate) struct Judged {
    /// Of single moves.
    pub faults: Vec<Fault>,
    /// Of the whole.
    pub finding: Option<Finding>,
}

/// One of the two programs.
struct Member<'a> {
    program: &'a Program,
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    /// By the number of the move, where its end is known.
    segments: Vec<Option<Segment>>,
    bodies: Vec<Bodies>,
}

/// A tool as solids, and with its sheet.
struct Bodies {
    /// The profile with the cylinder above it, then what is wider above it.
    solids: Vec<ToolBody>,
    with_sheet: Body,
}

impl<'a> Member<'a> {
    fn new(program: &'a Program, segments: &[Segment], subject: &'a Subject<'a>, limits: &'a Limits) -> Self {
        let mut by_move = vec![None; program.moves.len()];
        segments.iter().for_each(|segment| by_move[segment.index] = Some(*segment));
        let bodies = subject.tools.iter().map(|tool| Bodies {
            solids: std::iter::once(tool.body(None))
                .chain(tool.bodies_above(None).into_iter().map(|(_, body)| body))
                .collect(),
            with_sheet: Body::new(tool, subject.sheet.as_ref()),
        });
        Self { program, subject, limits, segments: by_move, bodies: bodies.collect() }
    }

    fn bodies(&self, segment: &Segment) -> Option<&Bodies> {
        self.bodies.get(segment.tool?)
    }

    /// How far beyond its surface a move of it may be, mm.
    fn excess(&self, segment: &Segment) -> f64 {
        self.limits.excess_of(segment.operation).unwrap_or(0.0)
    }
}

/// Checks a program together with the one beside it, if there is one.
pub(crate) fn judged(
    program: &Program,
    segments: &[Segment],
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Judged, Cancelled> {
    let partner = match subject.pairing {
        Pairing::Alone => return Ok(Judged::default()),
        Pairing::Missing { channel } => return Ok(Judged { finding: Some(not_checked(channel)), faults: Vec::new() }),
        Pairing::With(partner) => partner,
    };
    let (own, other) = (program.moves.len(), partner.program.moves.len());
    if own != other {
        let message = format!(
            "this program has {own} moves and the one on the other side of the sheet {other}: from the first that is missing \
             on nothing is opposite; plan both programs again"
        );
        let finding = Finding::of_all(FindingKind::BlockCount, Severity::Error, message);
        return Ok(Judged { finding: Some(finding), faults: Vec::new() });
    }
    let Partner { program: beside, subject: its, limits: allowed, .. } = partner;
    let own = Member::new(program, segments, subject, limits);
    let other = Member::new(beside, &placed(beside, its, allowed), its, allowed);
    let pair = if partner.follows {
        Pair { members: [own, other], left: partner.left, reported: 0 }
    } else {
        Pair { members: [other, own], left: partner.left, reported: 1 }
    };
    watch.begin("pair", program.moves.len());
    let mut faults = pair.out_of_step();
    let spatial = (0..program.moves.len()).into_par_iter().map(|index| {
        watch.advance(1)?;
        Ok(pair.between(index))
    });
    faults.extend(spatial.collect::<Result<Vec<_>, Cancelled>>()?.into_iter().flatten());
    Ok(Judged { faults, finding: None })
}

fn not_checked(channel: &str) -> Finding {
    let message = format!(
        "the program of channel {channel:?}, which runs together with this one, is not given: numbers of moves, times, the \
         sheet between the tools and their collision are not checked; verify both"
    );
    Finding::of_all(FindingKind::NotChecked, Severity::Warning, message)
}

/// The main tool's program and that of the tool below.
struct Pair<'a> {
    members: [Member<'a>; 2],
    left: Left,
    /// The number of the member whose program the faults are reported of.
    reported: usize,
}

/// A position in the other machine's coordinates.
fn turned([x, y, z]: [f64; 3]) -> Vector {
    Vector::new(x, -y, -z)
}

/// A move of both tools.
struct Both<'p> {
    main: &'p Segment,
    below: &'p Segment,
    bodies: [&'p Bodies; 2],
}

impl Both<'_> {
    /// What touches the sheet.
    fn profiles(&self) -> [&ToolBody; 2] {
        self.bodies.map(|bodies| &bodies.solids[0])
    }

    /// From the tip below to the main one at a share of the move; at its end where its start is not known.
    fn between(&self, share: f64) -> Vector {
        Vector::from(self.main.at(share)) - turned(self.below.at(share))
    }

    fn starts_somewhere(&self) -> bool {
        self.main.start.is_some() && self.below.start.is_some()
    }

    /// The least that is left between two solids and the sheet over the move, where that is below `best`, mm. Chords stand for
    /// arcs.
    fn least(&self, solids: [&ToolBody; 2], sheet: Left, best: f64) -> Option<f64> {
        let pieces = if self.starts_somewhere() { self.main.piece_count().max(1) } else { 1 };
        let mut least = f64::INFINITY;
        for piece in 0..pieces {
            let [from, to] = if self.starts_somewhere() {
                [piece, piece + 1].map(|end| self.between(end as f64 / pieces as f64))
            } else {
                [self.between(1.0); 2]
            };
            let way = to - from;
            lower(1.0, way.norm(), best, |share| {
                let found = apart(solids[0], solids[1], from + share * way, sheet);
                least = least.min(found.value);
                Tangent { value: found.value, rate: found.away.dot(&way), bend: 0.0 }
            });
        }
        (least < best).then_some(least)
    }
}

impl Pair<'_> {
    fn both(&self, index: usize) -> Option<Both<'_>> {
        let [main, below] = &self.members;
        let (segment, opposite) = (main.segments[index].as_ref()?, below.segments[index].as_ref()?);
        Some(Both { main: segment, below: opposite, bodies: [main.bodies(segment)?, below.bodies(opposite)?] })
    }

    fn fault(&self, both: &Both, kind: &'static faults::FaultKind) -> Fault {
        if self.reported == 0 { both.main } else { both.below }.fault(kind)
    }

    /// What is wrong between the tools in a move.
    fn between(&self, index: usize) -> Option<Fault> {
        let both = self.both(index)?;
        let [main, below] = both.profiles();
        if let Some(depth) = self.collision(&both) {
            return Some(self.fault(&both, &faults::TOOL_COLLISION).measured(depth, 0.0));
        }
        // the main tool is over its face, and the other one under that face lowered by the sheet: lifted by it, it is not in the first
        let nearest = -(self.members[0].limits.gouge + self.members[1].limits.gouge);
        if let Some(least) = both.least([main, below], self.left, nearest - SLACK) {
            return Some(self.fault(&both, &faults::SQUEEZE).measured(least, nearest));
        }
        both.main.excess?;
        let farthest = self.members[0].excess(both.main) + self.members[1].excess(both.below);
        let gap = |share: f64| apart(main, below, both.between(share), NOTHING).beyond(self.left);
        // the distance is a convex function of time: its largest value is at one of its ends
        let ends = if both.starts_somewhere() { &[0.0, 1.0][..] } else { &[1.0] };
        let wide = ends.iter().map(|end| (gap(*end), *end)).filter(|(gap, _)| *gap > farthest + SLACK);
        let (gap, _) = wide.filter(|(_, end)| self.could_be_nearer(&both, *end)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(self.fault(&both, &faults::UNSUPPORTED).measured(gap, farthest))
    }

    /// How deep the solids of the two tools are in each other, mm; negative.
    fn collision(&self, both: &Both) -> Option<f64> {
        let [main, below] = both.bodies.map(|bodies| &bodies.solids);
        let pairs = main.iter().flat_map(|one| below.iter().map(move |other| [one, other]));
        pairs.filter_map(|solids| both.least(solids, NOTHING, -SLACK)).min_by(f64::total_cmp)
    }

    /// Whether the tool below could stand opposite to the main tool's contact, by its slope, without entering the sheet elsewhere.
    fn could_be_nearer(&self, both: &Both, share: f64) -> bool {
        let [main, below] = &self.members;
        let tip = both.main.at(share);
        let body = &both.bodies[0].with_sheet;
        let prober = Prober { body, mesh: main.subject.mesh, bvh: main.subject.bvh };
        let Some(touch) = prober.at(body.position(tip), None) else { return true };
        let normal = -touch.away;
        let (flat, slope) = (normal.xy().norm(), libm::atan2(normal.xy().norm(), normal.z));
        let aside = if flat > 0.0 { Vector::new(normal.x, normal.y, 0.0) / flat } else { Vector::zeros() };
        let [(radius, height), (other_radius, other_height)] = both.profiles().map(|profile| profile.point_at(slope));
        let opposite = Vector::from(tip) - aside * (radius + other_radius) + Vector::z() * (height + other_height)
            - normal * (self.left.normal + self.left.vertical * normal.z);
        let body = &both.bodies[1].with_sheet;
        let prober = Prober { body, mesh: below.subject.mesh, bvh: below.subject.bvh };
        let there = prober.at(body.position(turned(opposite.into()).into()), None);
        there.is_none_or(|touch| touch.value >= -ROOM)
    }
}

/// Whether a move is a rapid.
fn is_rapid(program: &Program, index: usize) -> bool {
    program.moves[index].kind == MoveKind::Rapid
}
