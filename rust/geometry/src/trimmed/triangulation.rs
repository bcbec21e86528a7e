//! The constrained Delaunay triangulation of what lies within a border.

use std::collections::HashMap;

use spade::{handles::FixedFaceHandle, ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use super::fault::TrimmedFault;

/// A point and its number.
#[derive(Clone, Copy, Debug)]
struct Numbered {
    at: Point2<f64>,
    number: u32,
}

impl HasPosition for Numbered {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

type Triangulation = ConstrainedDelaunayTriangulation<Numbered>;

/// The triangles (counter-clockwise) of points in the plane that lie within the segments: behind an odd number of them, seen
/// from outside.
pub fn within(points: &[[f64; 2]], segments: &[[u32; 2]]) -> Result<Vec<[u32; 3]>, TrimmedFault> {
    let numbered = points.iter().zip(0..).map(|([x, y], number)| Numbered { at: Point2::new(*x, *y), number });
    let ends = segments.iter().map(|segment| segment.map(|i| i as usize)).collect();
    let mut cross = false;
    let all = Triangulation::try_bulk_load_cdt(numbered.collect(), ends, |_| cross = true);
    let all = all.map_err(|_| TrimmedFault::Border)?;
    if cross || all.num_vertices() != points.len() {
        return Err(TrimmedFault::Border);
    }
    let inside = inside(&all, &times(segments))?;
    let kept = all.inner_faces().filter(|face| inside.get(face.fix().index()) == Some(&Some(true)));
    Ok(kept.map(|face| face.vertices().map(|vertex| vertex.data().number)).collect())
}

/// How often the border runs along each segment.
fn times(segments: &[[u32; 2]]) -> HashMap<[u32; 2], u32> {
    let mut times = HashMap::new();
    for [a, b] in segments {
        *times.entry([*a.min(b), *a.max(b)]).or_insert(0) += 1;
    }
    times
}

/// By face: whether it lies inside. The outer face, which has no end, does not.
fn inside(all: &Triangulation, times: &HashMap<[u32; 2], u32>) -> Result<Vec<Option<bool>>, TrimmedFault> {
    let mut inside = vec![None; all.num_all_faces()];
    let outer = all.outer_face().fix();
    inside[outer.index()] = Some(false);
    let mut open = vec![outer];
    // the outer face is not a triangle: its neighbours are those across the hull
    for edge in all.convex_hull() {
        let hull = edge.rev();
        let (face, within) = (hull.face().fix(), is_crossed(times, edge));
        set(&mut inside, face, within, &mut open)?;
    }
    while let Some(face) = open.pop() {
        let Some(triangle) = all.face(face).as_inner() else { continue };
        let here = inside[face.index()] == Some(true);
        for edge in triangle.adjacent_edges() {
            let within = here ^ is_crossed(times, edge);
            set(&mut inside, edge.rev().face().fix(), within, &mut open)?;
        }
    }
    Ok(inside)
}

type Edge<'a> = spade::handles::DirectedEdgeHandle<'a, Numbered, (), spade::CdtEdge<()>, ()>;
type Face = FixedFaceHandle<spade::handles::PossiblyOuterTag>;

/// Whether the border runs along an edge an odd number of times. A segment that another point parts counts once.
fn is_crossed(times: &HashMap<[u32; 2], u32>, edge: Edge<'_>) -> bool {
    if !edge.is_constraint_edge() {
        return false;
    }
    let [a, b] = [edge.from().data().number, edge.to().data().number];
    times.get(&[a.min(b), a.max(b)]).is_none_or(|times| times % 2 == 1)
}

/// States for a face that it lies inside or not.
fn set(inside: &mut [Option<bool>], face: Face, within: bool, open: &mut Vec<Face>) -> Result<(), TrimmedFault> {
    match inside[face.index()] {
        None => {
            inside[face.index()] = Some(within);
            open.push(face);
            Ok(())
        }
        Some(known) if known == within => Ok(()),
        Some(_) => Err(TrimmedFault::Border),
    }
}
