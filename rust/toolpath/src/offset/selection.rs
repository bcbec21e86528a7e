//! To which triangles a contact belongs where some of those that meet there are selected and some are not.

use styluscam_geometry::Vector;

use super::contact::Feature;
use super::envelope::{Contact, Envelope};
use super::features::NO_NEIGHBOUR;

/// Normals that differ by less, as the sine of an angle, are the same.
const SAME: f64 = 1e-9;
/// The tool's upright side touches whatever stands no farther off than this, mm: triangles of a fillet bulge over the wall
/// that they join by what they deviate from it.
const TOGETHER: f64 = 0.01;
/// Directions that are paired at most, the nearest ones: where thousands of triangles meet, those span what matters.
const MOST: usize = 24;
/// Normals that rise by less are those of the tool's upright side.
const SIDE: f64 = 1e-9;

/// How far over the outer edges of the selection a contact still belongs to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rolling {
    /// It ends at the edge.
    #[default]
    Stop,
    /// It goes on over edges below which the selection lies, while it is less steep than that, until the tool stands upright on
    /// them: beyond, it would press down what lies on the other side.
    FromAbove,
    /// It goes on over all of them: until the tool touches something else, or leaves the edge.
    Over,
}

impl Envelope<'_> {
    /// Whether the contact belongs to triangles that `selected` accepts: to those that meet there, or to a wall beside them
    /// that the tool's upright side touches as well.
    ///
    /// Rolling over an edge or corner between selected and other faces, the contact belongs to the selected ones while
    /// its normal is within `spread` (rad) of what they span: the rim of a pin touched between two of its facets is the
    /// pin's wall. What else belongs to them there, `rolling` states.
    #[must_use]
    pub fn belongs(&self, contact: &Contact, selected: &[bool], spread: f64, rolling: Rolling) -> bool {
        self.meets(contact, selected, spread, rolling) || self.has_wall_beside(contact, selected)
    }

    /// Whether the contact belongs to selected triangles of those that meet there.
    fn meets(&self, contact: &Contact, selected: &[bool], spread: f64, rolling: Rolling) -> bool {
        if contact.feature == Feature::Facet {
            return selected[contact.triangle as usize];
        }
        let touched = self.meeting(contact);
        let is_selected = |t: &u32| *t != NO_NEIGHBOUR && selected[*t as usize];
        if touched.iter().all(is_selected) {
            return true;
        }
        let normals = touched.into_iter().filter(is_selected).map(|t| self.mesh().normal(t as usize));
        let normals: Vec<Vector> = normals.collect();
        let rolls = |normal: &Vector| match rolling {
            Rolling::Stop => false,
            Rolling::FromAbove => contact.normal.z >= normal.z && contact.normal.xy().dot(&normal.xy()) >= -SAME,
            Rolling::Over => true,
        };
        normals.iter().any(rolls) || is_spanned(contact.normal, &normals, spread)
    }

    /// Whether a selected wall that joins the triangle touched stands in the same upright line as the contact, as far as
    /// the tool's side can decide.
    fn has_wall_beside(&self, contact: &Contact, selected: &[bool]) -> bool {
        let mesh = self.mesh();
        let stands = |triangle: u32| {
            let (normal, corners) = (mesh.normal(triangle as usize), mesh.corners(triangle as usize));
            let along = Vector::new(-normal.y, normal.x, 0.0);
            let positions = corners.map(|corner| (corner - contact.point).dot(&along));
            let highest = corners.iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
            normal.dot(&contact.normal) > 0.0
                && (contact.point - corners[0]).dot(&normal).abs() <= TOGETHER
                && positions.iter().any(|position| *position <= TOGETHER)
                && positions.iter().any(|position| *position >= -TOGETHER)
                && highest >= contact.tip + self.side_height()
        };
        let is_wall = |t: &u32| *t != NO_NEIGHBOUR && selected[*t as usize] && mesh.is_upright(*t as usize);
        contact.normal.z.abs() <= SIDE
            && (0..3).flat_map(|corner| self.around(contact.triangle, corner)).filter(is_wall).any(stands)
    }

    /// The triangles that meet where the contact is: one, those beside an edge, or those around a corner.
    #[must_use]
    pub fn touched(&self, contact: &Contact) -> Vec<u32> {
        let mut touched = self.meeting(contact);
        touched.retain(|t| *t != NO_NEIGHBOUR);
        touched
    }

    /// The same; where the mesh ends there, [`NO_NEIGHBOUR`] is among them.
    fn meeting(&self, contact: &Contact) -> Vec<u32> {
        match contact.feature {
            Feature::Facet => vec![contact.triangle],
            Feature::Edge(i) => vec![contact.triangle, self.neighbours(contact.triangle)[usize::from(i)]],
            Feature::Corner(i) => self.around(contact.triangle, i),
        }
    }

    /// Triangles around the corner touched, found through the edges of the one that was asked.
    fn around(&self, triangle: u32, corner: u8) -> Vec<u32> {
        let vertex = self.mesh().triangles()[triangle as usize][usize::from(corner)];
        let mut fan = vec![triangle];
        let mut next = 0;
        while next < fan.len() {
            let triangle = fan[next];
            next += 1;
            if triangle == NO_NEIGHBOUR {
                continue;
            }
            let corners = self.mesh().triangles()[triangle as usize];
            for (i, neighbour) in self.neighbours(triangle).into_iter().enumerate() {
                let meets = corners[i] == vertex || corners[(i + 1) % 3] == vertex;
                if meets && !fan.contains(&neighbour) {
                    fan.push(neighbour);
                }
            }
        }
        fan
    }
}

/// Whether a direction is within `spread` (rad) of one of some others, or of what lies between them: all unit vectors.
///
/// A convex vertex is touched under every direction of the spherical polygon that its facets' normals span (its Gauss map).
/// The triangles of the polygon's corners with the one nearest to the direction cover that polygon.
fn is_spanned(direction: Vector, others: &[Vector], spread: f64) -> bool {
    let near = |a: &&Vector, b: &&Vector| a.dot(&direction).total_cmp(&b.dot(&direction));
    let Some(nearest) = others.iter().max_by(near) else { return false };
    if nearest.dot(&direction) >= libm::cos(spread) {
        return true;
    }
    let mut apart: Vec<&Vector> = others.iter().filter(|other| nearest.cross(other).norm() > SAME).collect();
    apart.sort_by(|a, b| near(b, a));
    apart.truncate(MOST);
    apart.iter().enumerate().any(|(i, second)| {
        is_on_arc(direction, [nearest, second], spread)
            || apart[i + 1..].iter().any(|third| {
                is_on_arc(direction, [second, third], spread) || is_in_triangle(direction, [nearest, second, third])
            })
    })
}

/// Whether a direction is within `spread` (rad) of the great circle through two others, and between them.
fn is_on_arc(direction: Vector, [a, b]: [&Vector; 2], spread: f64) -> bool {
    let Some(pole) = a.cross(b).try_normalize(SAME) else { return false };
    direction.dot(&pole).abs() <= libm::sin(spread)
        && a.cross(&direction).dot(&pole) >= 0.0
        && direction.cross(b).dot(&pole) >= 0.0
}

/// Whether a direction is in the spherical triangle of three others.
fn is_in_triangle(direction: Vector, [a, b, c]: [&Vector; 3]) -> bool {
    let turn = a.cross(b).dot(c);
    turn.abs() > SAME && [[a, b], [b, c], [c, a]].iter().all(|[p, q]| turn * p.cross(q).dot(&direction) >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(x: f64, y: f64, z: f64) -> Vector {
        Vector::new(x, y, z).normalize()
    }

    #[test]
    fn between_two_facets_of_a_pin_is_its_wall() {
        let facets = [unit(1.0, 0.1, 0.0), unit(1.0, -0.1, 0.0)];
        assert!(is_spanned(unit(1.0, 0.0, 0.0), &facets, 0.0175));
        assert!(is_spanned(unit(1.0, 0.09, 0.01), &facets, 0.0175));
        assert!(!is_spanned(unit(1.0, 0.13, 0.0), &facets, 0.0175), "beyond both");
        assert!(!is_spanned(unit(1.0, 0.0, 0.03), &facets, 0.0175), "rolling over the rim");
        assert!(!is_spanned(unit(-1.0, 0.0, 0.0), &facets, 0.0175), "the other side of the circle");
        assert!(!is_spanned(unit(1.0, 0.0, 0.0), &[], 0.0175));
    }

    #[test]
    fn what_leans_down_beside_two_facets_takes_nothing_from_them() {
        let facets = [unit(1.0, 0.07, 0.0), unit(1.0, -0.07, 0.0), unit(1.0, 0.0, -0.03)];
        assert!(is_spanned(unit(1.0, 0.0, 0.001), &facets, 0.0175));
    }

    #[test]
    fn three_facets_span_all_between_them() {
        let facets = [unit(1.0, 0.0, 1.0), unit(-0.5, 0.8, 1.0), unit(-0.5, -0.8, 1.0)];
        assert!(is_spanned(unit(0.0, 0.0, 1.0), &facets, 0.0));
        assert!(!is_spanned(unit(0.0, 0.0, -1.0), &facets, 0.0));
        assert!(!is_spanned(unit(1.0, 0.7, 1.0), &facets, 0.01));
    }
}
