//! The whole way of a tool along a strip: down to it, in from the free side, along it, out, and up again.

use styluscam_geometry::Vector;
use styluscam_motion::{Move, Role, UnitAxis};

use super::FlankError;

/// A tool beside a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlankPose {
    /// The tool's tip, mm.
    pub tip: Vector,
    /// Unit vector from there up the tool.
    pub axis: Vector,
    /// A point of the strip that it touches, mm.
    pub contact: Vector,
}

/// How a pass is come to and left. Lengths mm, feeds mm/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlankWays {
    /// How far the tool goes on beyond both ends of the strip as it stands there.
    pub extension: f64,
    /// Length of the way in from the free side and out to it, at 45 deg to the pass.
    pub lead: f64,
    /// Along the pass.
    pub cut: f64,
    /// Down along the axis.
    pub plunge: f64,
    /// In, and out.
    pub leads: [f64; 2],
}

/// The moves of a pass along poses, two at least; `height` is how far up along its axis the tool is free, of the first and the last
/// pose on the path.
///
/// # Errors
/// [`FlankError::Count`].
pub fn flank_pass(
    poses: &[FlankPose],
    ways: &FlankWays,
    height: &dyn Fn(&FlankPose) -> f64,
) -> Result<Vec<Move>, FlankError> {
    let [first, second, ..] = poses else { return Err(FlankError::Count(poses.len())) };
    let [.., before, last] = poses else { return Err(FlankError::Count(poses.len())) };
    let (into, out) = (beyond(first, second, ways), beyond(last, before, ways));
    let at = |tip: Vector, axis: Vector, feed: f64| -> Result<Move, FlankError> {
        let unit = UnitAxis::new(axis.into()).map_err(|_| FlankError::Count(0))?;
        Ok(Move::feed(tip.into(), feed).with_axis(unit))
    };
    let up = |pose: &FlankPose, outermost: Vector| -> Result<Move, FlankError> {
        let outer = FlankPose { tip: outermost, ..*pose };
        let step = at(outermost + pose.axis * height(&outer).max(0.0), pose.axis, 0.0)?;
        Ok(Move::rapid(step.end.tip).with_axis(step.end.axis))
    };
    let start = into.last().copied().unwrap_or(first.tip);
    let mut moves = vec![up(first, start)?];
    for (number, tip) in into.iter().rev().chain([&first.tip]).enumerate() {
        let feed = if number == 0 { ways.plunge } else { ways.leads[0] };
        moves.push(at(*tip, first.axis, feed)?.role(Role::Lead));
    }
    for pose in &poses[1..] {
        moves.push(at(pose.tip, pose.axis, ways.cut)?.role(Role::Cut));
    }
    for tip in &out {
        moves.push(at(*tip, last.axis, ways.leads[1])?.role(Role::Lead));
    }
    moves.push(up(last, out.last().copied().unwrap_or(last.tip))?);
    Ok(moves)
}

/// Tips beyond an end of the strip, from there outwards: on along the surface, and away from it.
fn beyond(end: &FlankPose, inner: &FlankPose, ways: &FlankWays) -> Vec<Vector> {
    let FlankPose { tip, axis, contact } = *end;
    let across = |v: Vector, unit: Vector| v - unit * unit.dot(&v);
    let free = across(tip - contact, axis).normalize();
    // along the surface: across the axis and across the way to it
    let out = across(across(contact - inner.contact, axis), free).normalize();
    let extended = tip + out * ways.extension;
    let aside = extended + not_down(out + free, axis).normalize() * ways.lead;
    let extension = (ways.extension > 0.0).then_some(extended);
    extension.into_iter().chain((ways.lead > 0.0).then_some(aside)).collect()
}

/// The direction of a way across a tool's axis, level instead of down: along its axis it goes up for that. A floor may lie there.
fn not_down(way: Vector, axis: Vector) -> Vector {
    if way.z < 0.0 && axis.z > UnitAxis::LEAST_RISE {
        way - axis * (way.z / axis.z)
    } else {
        way
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_motion::MoveKind;

    fn pose(x: f64, axis: Vector) -> FlankPose {
        // the tool on the side of +Y of a wall along X
        FlankPose { tip: Vector::new(x, 3.0, 0.0), axis, contact: Vector::new(x, 0.0, 5.0) }
    }

    const WAYS: FlankWays = FlankWays { extension: 2.0, lead: 4.0, cut: 800.0, plunge: 200.0, leads: [500.0, 600.0] };

    #[test]
    fn a_pass_comes_down_goes_in_along_and_out_and_up() {
        let poses = [pose(0.0, Vector::z()), pose(10.0, Vector::z())];
        let moves = flank_pass(&poses, &WAYS, &|pose| 20.0 - pose.tip.z).unwrap();
        let d = 2.0 * 2.0_f64.sqrt();
        let expected = [
            (-2.0 - d, 3.0 + d, 20.0, 0.0),
            (-2.0 - d, 3.0 + d, 0.0, 200.0),
            (-2.0, 3.0, 0.0, 500.0),
            (0.0, 3.0, 0.0, 500.0),
            (10.0, 3.0, 0.0, 800.0),
            (12.0, 3.0, 0.0, 600.0),
            (12.0 + d, 3.0 + d, 0.0, 600.0),
            (12.0 + d, 3.0 + d, 20.0, 0.0),
        ];
        assert_eq!(moves.len(), expected.len());
        for (step, (x, y, z, feed)) in moves.iter().zip(expected) {
            let apart = Vector::from(step.end.tip) - Vector::new(x, y, z);
            assert!(apart.norm() < 1e-12 && (step.feed - feed).abs() < 1e-12, "{step:?}");
            assert_eq!(step.kind == MoveKind::Rapid, feed == 0.0);
        }
    }

    #[test]
    fn a_tool_that_leans_away_from_the_wall_does_not_go_down_on_its_way_to_it() {
        let axis = Vector::new(0.0, 0.3, 1.0).normalize();
        let poses = [pose(0.0, axis), pose(10.0, axis)];
        let moves = flank_pass(&poses, &WAYS, &|_| 30.0).unwrap();
        let lowest = moves.iter().map(|step| step.end.tip[2]).fold(f64::INFINITY, f64::min);
        assert!(lowest > -1e-9, "{lowest}");
        // and is as far from the wall as it was to be
        let aside = Vector::from(moves[1].end.tip) - poses[0].tip;
        let way = aside - (Vector::from(moves[2].end.tip) - poses[0].tip);
        assert!((way.norm() - WAYS.lead).abs() < 1e-12, "{way:?}");
        assert!((aside - axis * aside.dot(&axis)).norm() > 4.0, "{aside:?}");
    }
}
