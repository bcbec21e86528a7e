//! Things at places that are done one after the other, in an order with short ways across.

use styluscam_geometry::Vector;
use styluscam_toolpath::{shortly_ordered, Air, Freedom, Pass, PathPoint, Seam, Sense};

use super::Context;
use crate::JobError;

/// The things in an order with short ways across from place to place, and the length of those, mm.
///
/// # Errors
/// `Cancelled`.
pub(super) fn in_order<T: Clone>(
    context: &Context<'_>,
    things: &[T],
    place: impl Fn(&T) -> [f64; 2],
) -> Result<(Vec<T>, f64), JobError> {
    let pass = |(number, thing): (usize, &T)| {
        let [x, y] = place(thing);
        let tip = Vector::new(x, y, context.scene.clearance);
        let point = PathPoint { tip, normal: Vector::z(), selected: true, triangle: number as u32 };
        Pass { points: vec![point], closed: false, group: 0 }
    };
    let passes: Vec<Pass> = things.iter().enumerate().map(pass).collect();
    let air = Air { height: context.scene.clearance, along: 0.0 };
    let sense = (Sense::Forward, Seam::Nearest);
    let ordered = shortly_ordered(passes, sense, Freedom::WithinGroups, &air, context.watch)?;
    let numbers = ordered.passes.iter().filter_map(|pass| pass.points.first());
    let things = numbers.filter_map(|point| things.get(point.triangle as usize).cloned()).collect();
    Ok((things, ordered.between[1]))
}
