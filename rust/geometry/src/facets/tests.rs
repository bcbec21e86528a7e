use super::*;

/// A cone of 45 degrees, 10 mm deep, with a flat flange: rings of points from the axis outwards.
fn cone(sides: usize, rings: usize) -> Facets {
    let mesh = |n: usize, i: usize| {
        let radius = 20.0 * n as f64 / rings as f64;
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / sides as f64);
        Vector::new(radius * cos, radius * sin, (radius - 10.0).min(0.0))
    };
    let points = (0..=rings).flat_map(|n| (0..sides).map(move |i| mesh(n, i))).collect();
    let number = |n: usize, i: usize| (n * sides + i % sides) as i64;
    let squares = (0..rings).flat_map(|n| (0..sides).map(move |i| (n, i)));
    let triangles: Vec<[i64; 3]> = squares
        .flat_map(|(n, i)| {
            let [a, b, c, d] = [number(n, i), number(n + 1, i), number(n + 1, i + 1), number(n, i + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    Facets::of(&Mesh::new(points, &triangles, &[]).unwrap(), |_| true)
}

#[test]
fn a_body_between_two_faces_is_closed_and_as_thick_as_it_was_made() {
    let face = cone(90, 20);
    let outward = face.outward();
    let body = face.body_to(&face.moved(|i| -outward[i] * 0.5));
    assert_eq!(body.borders(), Vec::<[u32; 2]>::new());
    let area: f64 = face.triangles.iter().map(|t| 0.5 * face.doubled(t).norm()).sum();
    assert!((body.volume() / (0.5 * area) - 1.0).abs() < 0.01, "{} {}", body.volume(), 0.5 * area);
    let sine = face.body_to(&face.moved(|_| Vector::new(0.0, 0.0, -0.5)));
    let plan: f64 = face.triangles.iter().map(|t| 0.5 * face.doubled(t).z).sum();
    assert!((sine.volume() - 0.5 * plan).abs() < 1e-9);
}

#[test]
fn fewer_triangles_stay_within_the_tolerance_and_keep_the_border() {
    let face = cone(180, 40);
    let fewer = face.simplified(0.05, |_, _| false);
    assert!(fewer.triangles.len() * 8 < face.triangles.len(), "{}", fewer.triangles.len());
    let triangles: Vec<[i64; 3]> = fewer.triangles.iter().map(|t| t.map(i64::from)).collect();
    let mesh = Mesh::new(fewer.points.clone(), &triangles, &[]).unwrap();
    let bvh = crate::Bvh::new(&mesh);
    let off = face.points.iter().map(|p| (bvh.nearest(&mesh, *p).0 - p).norm()).fold(0.0, f64::max);
    assert!(off <= 0.05 && off > 0.01, "{off}");
    let area = |facets: &Facets| facets.triangles.iter().map(|t| 0.5 * facets.doubled(t).z).sum::<f64>();
    assert!((area(&fewer) / area(&face) - 1.0).abs() < 0.005);
    assert!(fewer.triangles.iter().all(|t| fewer.doubled(t).z > 0.0));
}

#[test]
fn normals_are_smooth_but_for_edges() {
    let drawn = cone(90, 20).creased();
    let on_wall = drawn.vertices.iter().zip(&drawn.normals).filter(|(v, _)| v.z < -0.5 && v.z > -9.5);
    for (vertex, normal) in on_wall {
        let inward = Vector::new(-vertex.x, -vertex.y, 0.0).normalize();
        assert!((normal - (inward + Vector::z()).normalize()).norm() < 1e-3, "{vertex} {normal}");
    }
    let is_level = |edge: &&[u32; 2]| edge.iter().all(|i| drawn.vertices[*i as usize].z.abs() < 1e-12);
    // the rim of the cone, and the border of the flange: 90 sides each
    assert_eq!(drawn.edges.iter().filter(is_level).count(), 180);
}

#[test]
fn divided_triangles_have_no_long_sides_and_are_the_same_surface() {
    let face = cone(180, 40).simplified(0.05, |_, _| false);
    let is_long = |a: &Vector, b: &Vector| (a - b).norm() > 2.0;
    let finer = face.divided(is_long);
    let fewer = finer.simplified(0.01, is_long);
    for facets in [&finer, &fewer] {
        let long = |t: &[u32; 3]| {
            (0..3).any(|k| is_long(&facets.points[t[k] as usize], &facets.points[t[(k + 1) % 3] as usize]))
        };
        assert!(!facets.triangles.iter().any(long));
        assert!((area(facets) / area(&face) - 1.0).abs() < 1e-3);
    }
    assert!(fewer.points.len() < 1500 && fewer.triangles.len() < finer.triangles.len(), "{}", fewer.points.len());
    let plan: f64 = finer.triangles.iter().map(|t| finer.doubled(t).z).sum();
    assert!((plan - face.triangles.iter().map(|t| face.doubled(t).z).sum::<f64>()).abs() < 1e-9);
}

fn area(facets: &Facets) -> f64 {
    facets.triangles.iter().map(|t| 0.5 * facets.doubled(t).norm()).sum()
}
