//! What a job's keys mean for a part: zero point, heights, faces, tools.

use styluscam_geometry::Vector;

use super::setup::{job, levels, milling, scene, with, LEVELS};
use crate::resolve::{faces_of, heights_of, tools_in_order};
use crate::MAIN_CHANNEL;

fn with_setup(keys: &str) -> String {
    with(&levels(), "\n[tools.a]", &format!("\nsetup = {{ {keys} }}\n[tools.a]"))
}

/// The same part as a sheet of 1 mm, whose face that the model shows is `face`.
fn sheet(face: &str) -> String {
    let text = with_setup("sheet = { thickness = 1.0 }");
    let text = with(&text, "kind = \"milling\"", "kind = \"spif\"");
    with(&text, "units = \"mm\" }", &format!("units = \"mm\", model_face = \"{face}\" }}"))
}

#[test]
fn the_zero_point_and_the_heights_of_rapids() {
    let cases = [
        (levels(), 0.0, 4.0),
        (with_setup("zero = [1.0, 2.0, 4.0]"), -4.0, 0.0),
        (with_setup("up = \"-z\""), -4.0, 0.0),
        (with_setup("up = \"+x\""), -10.0, 10.0),
        (sheet("tool"), -4.0, 0.0),
        (sheet("back"), -5.0, 0.0),
        (sheet("mid"), -4.5, 0.0),
    ];
    for (text, foot, top) in cases {
        let scene = scene(&job(&text));
        assert!((scene.mesh.bounds().0.z - foot).abs() < 1e-12, "{text}: {:?}", scene.mesh.bounds());
        assert!((scene.top - top).abs() < 1e-12, "{text}: {}", scene.top);
        assert!((scene.clearance - top - 10.0).abs() < 1e-12 && (scene.retract - top - 2.0).abs() < 1e-12);
    }
}

#[test]
fn a_turned_part_is_turned_about_the_zero_point() {
    let scene = scene(&job(&with_setup("zero = [10.0, 0.0, 0.0], rotation = 90.0")));
    let corner = scene.frame.point(Vector::new(10.0, 0.0, 0.0));
    // the point is one of the turned model
    assert!((corner - Vector::new(-10.0, 10.0, 0.0)).norm() < 1e-12, "{corner}");
}

#[test]
fn a_milling_tool_goes_no_lower_than_the_table_and_a_stylus_as_low_as_it_touches() {
    let bottom = |text: &str| {
        let job = job(text);
        heights_of(&job, &scene(&job), &job.operations[0]).bottom
    };
    assert_eq!(bottom(&levels()), 0.0);
    assert_eq!(bottom(&milling(&format!("z_bottom = -3.0\n{LEVELS}"))), -3.0);
    assert_eq!(bottom(&sheet("tool")), f64::NEG_INFINITY);
}

#[test]
fn all_means_the_faces_that_face_up_and_names_are_their_numbers() {
    let faces = |selection: &str| {
        let job = job(&with(&levels(), "units = \"mm\" }", &format!("units = \"mm\", faces = {selection} }}")));
        faces_of(&job, &scene(&job), &job.operations[0], 0)
    };
    assert_eq!(faces("\"all\"").unwrap(), [1, 3, 4, 5, 6]);
    assert_eq!(faces("[\"Face4\", \"1\", \"Face4\"]").unwrap(), [1, 4]);
    for (selection, code, path) in
        [("[\"Face1\", \"Face9\"]", "no-such-face", "part.faces[1]"), ("[\"Face2\"]", "undercut", "part.faces[0]")]
    {
        let error = faces(selection).expect_err(selection);
        assert_eq!((error.code(), error.location().as_str()), (code, path));
    }
}

#[test]
fn an_operation_s_own_faces_go_before_the_part_s() {
    let job = job(&milling(&format!("faces = [\"Face5\"]\n{LEVELS}")));
    let scene = scene(&job);
    assert_eq!(faces_of(&job, &scene, &job.operations[0], 0).unwrap(), [5]);
    let facing_up = scene.facing_up(&[5, 2]);
    let expected: Vec<bool> = scene.mesh.faces().iter().map(|face| *face == 5).collect();
    assert_eq!(facing_up, expected, "Face2 faces down");
}

#[test]
fn tools_are_listed_in_the_order_of_their_first_use() {
    let stands = "spindle = { mode = \"off\" }\n";
    let rows = format!("[[operations]]\ntool = \"b\"\nkind = \"zig-zag\"\nstepover = 1.0\n{stands}");
    let more = format!("{rows}[[operations]]\ntool = \"a\"\n{stands}");
    let text =
        with(&levels(), "[tools.a]", "[tools.b]\nnumber = 7\nprofile = { kind = \"flat\", diameter = 2.0 }\n[tools.a]");
    let job = job(&format!("{text}\n{more}{LEVELS}"));
    let (tools, records) = tools_in_order(&job, MAIN_CHANNEL).unwrap();
    assert_eq!(records.iter().map(|record| record.number).collect::<Vec<_>>(), [1, 7]);
    assert_eq!(tools.iter().map(|tool| tool.diameter()).collect::<Vec<_>>(), [3.0, 2.0]);
}
