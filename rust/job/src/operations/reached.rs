//! How much of the selected faces the tool reaches, and what keeps it from the rest.

use std::collections::BTreeMap;

use styluscam_geometry::{Tool, Vector};
use styluscam_motion::Watch;
use styluscam_toolpath::offset::{bridges, Bridges, Envelope, OffsetSurface, Stopped, SurfaceFlag};
use styluscam_verify::ToolReach;

use super::{BridgedFace, ReachedFace};
use crate::faces::UP;
use crate::stopped::{stopped_points, StoppedTriangle};
use crate::{JobError, Scene};

/// Triangles of a face whose offset is checked, at most: areas are right to a percent or two of the face's.
const OFFSET_SAMPLES: usize = 2000;
/// Points that refining it may add, where something stops the tool.
const OFFSET_POINTS: usize = 1 << 16;

/// The slope-matched offset of faces: of all their triangles, or of up to [`OFFSET_SAMPLES`] of each.
pub fn offset_of(
    scene: &Scene,
    tool: &Tool,
    envelope: &Envelope<'_>,
    faces: &[u32],
    tolerance: f64,
    watch: &Watch,
) -> Result<OffsetSurface, JobError> {
    let mut by_face: BTreeMap<u32, Vec<u32>> = faces.iter().map(|face| (*face, Vec::new())).collect();
    for (t, face) in scene.mesh.faces().iter().enumerate() {
        if let Some(triangles) = by_face.get_mut(face) {
            triangles.push(t as u32);
        }
    }
    let sampled: Vec<u32> = by_face.values().flat_map(|all| spread(all, OFFSET_SAMPLES)).collect();
    Ok(OffsetSurface::new(envelope, tool, scene.sheet.as_ref(), &sampled, tolerance, OFFSET_POINTS, watch)?)
}

/// Up to `most` of some things, spread evenly over them.
fn spread<T: Copy>(all: &[T], most: usize) -> impl Iterator<Item = T> + '_ {
    all.iter().step_by(all.len().div_ceil(most).max(1)).copied()
}

/// What becomes of each face; by what was sampled of it.
pub fn reached(scene: &Scene, offset: &OffsetSurface, bridges: &[Bridges]) -> Vec<ReachedFace> {
    let regions = offset.regions(&scene.mesh);
    let faces = regions.chunk_by(|a, b| a.face == b.face).filter_map(|regions| {
        let face = regions.first()?.face;
        let sampled: f64 = regions.iter().map(|region| region.area).sum();
        let scale = scene.views.get(&face)?.area / sampled;
        let area = |flag| regions.iter().find(|r| r.flag == flag).map_or(0.0, |region| region.area * scale);
        let left = bridges.iter().find(|bridges| bridges.face == face).map_or(1.0, |bridges| bridges.share_left);
        let interferes = area(SurfaceFlag::Interferes);
        Some(ReachedFace {
            face,
            contact: area(SurfaceFlag::Contact) + (1.0 - left) * interferes,
            bridged: area(SurfaceFlag::Bridged),
            interferes: left * interferes,
            rim: area(SurfaceFlag::Rim),
            undercut: area(SurfaceFlag::Undercut),
        })
    });
    faces.collect()
}

/// What the tool leaves of each face by more than the tolerance: looked for from [`stopped_points`] among the points of
/// each face that by the offset are kept from the tool. A flat tool may touch with its edge what it cannot stand on.
pub fn bridges_of(
    scene: &Scene,
    tool: &Tool,
    envelope: &Envelope<'_>,
    offset: &OffsetSurface,
    tolerance: f64,
    watch: &Watch,
) -> Result<Vec<Bridges>, JobError> {
    let mut by_face: BTreeMap<u32, Vec<StoppedTriangle>> = BTreeMap::new();
    for (corners, triangle) in offset.triangles.iter().zip(&offset.numbers) {
        let corners = corners.map(|i| &offset.points[i as usize]);
        let stopped = corners.map(|corner| corner.flag.is_stopped());
        if scene.mesh.normal(*triangle as usize).z > UP && stopped.contains(&true) {
            let is_smooth = corners.iter().find(|corner| corner.flag.is_stopped()).map(|corner| corner.flag);
            let found = StoppedTriangle {
                triangle: *triangle,
                corners: corners.map(|corner| corner.contact),
                stopped,
                is_smooth: is_smooth == Some(SurfaceFlag::Bridged),
            };
            by_face.entry(scene.mesh.faces()[*triangle as usize]).or_default().push(found);
        }
    }
    let sampled: Vec<Stopped> = by_face.values().flat_map(|all| stopped_points(all)).collect();
    let reach = ToolReach::new(tool, scene.sheet.as_ref(), &scene.mesh, &scene.bvh);
    let left = |triangle: u32, point: Vector, enough: f64| reach.left(triangle as usize, point, enough);
    Ok(bridges(envelope, tool, scene.sheet.as_ref(), &sampled, tolerance, &left, watch)?)
}

/// The worst point of each face that the tool bridges, worst first.
pub fn bridged(bridges: &[Bridges]) -> Vec<BridgedFace> {
    let worst = bridges.iter().filter_map(|face| face.worst);
    let worst = worst.map(|b| BridgedFace { face: b.face, excess: b.excess, at: b.point.into() });
    let mut worst: Vec<BridgedFace> = worst.collect();
    worst.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.face.cmp(&b.face)));
    worst
}
