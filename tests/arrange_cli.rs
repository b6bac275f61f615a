//! `imp arrange` and `imp verify` as their users meet them: what is printed, which files are written, what mistakes are
//! answered with, and that Ctrl-C leaves what there is.

#[path = "support/command.rs"]
mod command;

use std::fs;
use std::process::Command;

use command::command;
use command::fail;
use command::folder;
use command::succeed;

use imp::arrange::Options;
use imp::arrange::arrange;
use imp::arrange::certificate;
use imp::arrange::certificate::Certificate;
use imp::arrange::complex::VertexKind;
use imp::arrange::structure::Sign;
use imp::control::Control;
use imp::diagnostic::code;
use imp::interpret::Interpreter;
use imp::session;
use imp::session::Source;
use serde_json::Value;

const CIRCLES: &str = "curve a: x^2 + y^2 = 1\ncurve b: (x - 1)^2 + y^2 = 1\ndomain [-2, 3] x [-2, 2]\n";

#[test]
fn the_summary_is_one_line_of_json() {
    let folder = folder(&[("circles.imp", CIRCLES)]);
    let line = succeed(folder.path(), &["arrange", "circles.imp", "--json"]);
    assert_eq!(line.lines().count(), 1);
    let head = r#"{"vertices":{"crossing":2,"tangency":0,"singular":0,"end":0,"boundary":0,"loop":0,"cluster":0},"edges":4,"faces":4,"proved":true,"boxes":"#;
    assert!(line.starts_with(head), "{line}");
    let value: Value = serde_json::from_str(&line).unwrap();
    assert!(value["boxes"].as_u64().unwrap() > 4 && value["ms"].as_f64().unwrap() > 0.0);
    let names: Vec<&String> = value.as_object().unwrap().keys().collect();
    assert_eq!(names.len(), 6, "{names:?}");
}

#[test]
fn people_get_a_table() {
    let folder = folder(&[("circles.imp", CIRCLES)]);
    let table = succeed(folder.path(), &["arrange", "circles.imp"]);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "circles.imp: 2 vertices, 4 edges, 4 faces; all proved");
    assert_eq!(lines[1], "  crossing        2");
    assert!(lines[2].contains(" boxes, ") && lines[2].ends_with(" ms"), "{table}");
}

#[test]
fn what_is_not_proved_is_listed_with_its_place() {
    // Two graphs that touch, and no polynomials: no interval test can decide that.
    let folder =
        folder(&[("touch.imp", "curve a: y = cos(x)\ncurve b: y = 2 - cos(x)\ndomain [-1, 1.25] x [0, 2.5]\n")]);
    let table = succeed(folder.path(), &["arrange", "touch.imp"]);
    assert!(table.lines().next().unwrap().ends_with("; 1 vertex is not proved"), "{table}");
    assert!(table.contains(" of a, b near ("), "{table}");
    let line = succeed(folder.path(), &["arrange", "touch.imp", "--json"]);
    assert!(line.contains("\"proved\":false"), "{line}");
}

#[test]
fn every_format_is_written() {
    let folder = folder(&[("circles.imp", CIRCLES)]);
    let mut arguments = vec!["arrange", "circles.imp", "--size", "400x300", "--boxes"];
    let names = ["out.svg", "out.png", "out.json", "out.geojson", "out.dot"];
    names.iter().for_each(|name| arguments.extend(["-o", name]));
    succeed(folder.path(), &arguments);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let svg = read("out.svg");
    for layer in ["faces", "boxes", "edges", "unresolved", "vertices", "frame", "labels"] {
        assert!(svg.contains(&format!("<g id=\"{layer}\">")), "{layer}");
    }
    let picture = image::open(folder.path().join("out.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (400, 300));
    let structure: Value = serde_json::from_str(&read("out.json")).unwrap();
    // The lens of two unit circles at distance 1, and the rest of each: 2 pi/3 - sqrt(3)/2 and pi minus that.
    let lens = 2.0 * std::f64::consts::PI / 3.0 - 0.75f64.sqrt();
    let mut areas: Vec<f64> = Vec::new();
    for face in structure["faces"].as_array().unwrap().iter().filter(|face| face["bounded"] == true) {
        let [lo, hi] = [0, 1].map(|end| face["area"][end].as_f64().unwrap());
        assert!(hi - lo < 1e-4);
        areas.push(0.5 * (lo + hi));
    }
    areas.sort_by(f64::total_cmp);
    assert_eq!(areas.len(), 3);
    let rest = std::f64::consts::PI - lens;
    assert!(areas.iter().zip([lens, rest, rest]).all(|(area, expected)| (area - expected).abs() < 1e-4), "{areas:?}");
    let features: Value = serde_json::from_str(&read("out.geojson")).unwrap();
    assert_eq!(features["features"].as_array().unwrap().len(), 4 + 4 + 2);
    assert_eq!(read("out.dot").matches(" -- ").count(), 4);
    succeed(folder.path(), &["arrange", "circles.imp", "--dual", "-o", "out.dot"]);
    // The outside meets both halves of the union, the lens both too; the two meet only in points.
    assert_eq!(read("out.dot").matches(" -- ").count(), 4);
}

#[test]
fn mistakes_are_answered_before_any_work() {
    let folder = folder(&[("circles.imp", CIRCLES), ("ball.imp", "x^2 + y^2 + z^2 = 1\n")]);
    let surface = fail(folder.path(), &["arrange", "ball.imp"]);
    assert!(surface.contains("E0405") && surface.contains("imp render ball.imp"), "{surface}");
    let twice = fail(folder.path(), &["arrange", "circles.imp", "-o", "a.svg", "-o", "a.svg"]);
    assert!(twice.contains("two outputs would go to `a.svg`"), "{twice}");
    let ending = fail(folder.path(), &["arrange", "circles.imp", "-o", "a.pdf"]);
    assert!(ending.contains(".svg, .png, .json, .geojson or .dot"), "{ending}");
    assert!(fail(folder.path(), &["arrange", "circles.imp", "-o", "none/a.svg"]).contains("E0404"));
    assert!(fail(folder.path(), &["arrange", "circles.imp", "--epsilon", "0"]).contains("above 0"));
    assert!(!folder.path().join("a.svg").exists());
}

#[test]
fn certificates_are_verified_and_belong_to_their_scene() {
    let scene = "param r = 1 in [0.5, 2]\ncurve a: x^2 + y^2 = r^2\ncurve b: y = sin(2 x)\ndomain [-2.5, 2.5]^2\n";
    let folder = folder(&[("scene.imp", scene), ("circles.imp", CIRCLES)]);
    succeed(folder.path(), &["arrange", "scene.imp", "--set", "r=1.5", "--certificate", "proof"]);
    let said = succeed(folder.path(), &["verify", "scene.imp", "proof", "--set", "r=1.5"]);
    assert!(said.starts_with("verified: 4 vertices, 5 edges, 4 faces; all proved; "), "{said}");
    assert!(fail(folder.path(), &["verify", "scene.imp", "proof"]).contains("E0508"));
    assert!(fail(folder.path(), &["verify", "circles.imp", "proof"]).contains("E0508"));
    let bytes = fs::read(folder.path().join("proof")).unwrap();
    fs::write(folder.path().join("short"), &bytes[..bytes.len() / 2]).unwrap();
    assert!(fail(folder.path(), &["verify", "scene.imp", "short"]).contains("E0507"));
}

#[test]
fn a_certificate_that_claims_anything_else_is_rejected() {
    let artefact = session::compile(Source::Text { name: "circles.imp", text: CIRCLES }, &[]);
    let scene = artefact.scene.unwrap();
    let options = Options::default();
    let arrangement = arrange(&scene, &options, session::backend(), &Control::default()).unwrap();
    let honest = Certificate::new(&scene, &options, &arrangement, &Interpreter).unwrap();
    assert_eq!(Certificate::from_bytes(&honest.to_bytes()).unwrap(), honest);
    let answer =
        |certificate: &Certificate| certificate::verify(&scene, certificate, &Interpreter, &Control::default());
    let report = answer(&honest).unwrap();
    assert_eq!((report.summary.vertices.crossing, report.leaves), (2, honest.leaves.len() as u64));
    let rejected = |what: &str, change: &dyn Fn(&mut Certificate)| {
        let mut certificate = honest.clone();
        change(&mut certificate);
        let found = answer(&certificate).expect_err(what);
        assert_eq!(found.code, code::REJECTED, "{what}: {found:?}");
    };
    let crossing = honest.claim.vertices.iter().position(|vertex| vertex.kind == VertexKind::Crossing).unwrap();
    rejected("a leaf is dropped", &|c| {
        c.leaves.pop();
    });
    rejected("a leaf is there twice", &|c| c.leaves.push(c.leaves[0]));
    rejected("a leaf is replaced", &|c| c.leaves[0] = c.leaves[1]);
    rejected("a leaf is no box", &|c| c.leaves[0][0] = [f64::NAN, 1.0]);
    rejected("a leaf has grown", &|c| c.leaves[0][0][1] += 1e-9);
    rejected("there are no leaves", &|c| c.leaves.clear());
    rejected("a vertex is moved", &|c| c.claim.vertices[crossing].area[0].iter_mut().for_each(|end| *end += 1e-6));
    rejected("a vertex is nowhere", &|c| c.claim.vertices[crossing].area[1] = [f64::NAN; 2]);
    rejected("a vertex is of another kind", &|c| c.claim.vertices[crossing].kind = VertexKind::Tangency);
    rejected("a vertex has another curve", &|c| c.claim.vertices[crossing].curves = vec![0]);
    rejected("a vertex is left out", &|c| drop(c.claim.vertices.pop()));
    rejected("halfedges are joined otherwise", &|c| c.claim.halfedges.swap(0, 1));
    rejected("an edge takes another way", &|c| {
        c.claim.edges[0].cells.pop();
    });
    rejected("a face has another sign", &|c| {
        let sign = &mut c.claim.faces[1].signs[0];
        *sign = if *sign == Sign::Negative { Sign::Positive } else { Sign::Negative };
    });
    rejected("a face is left out", &|c| drop(c.claim.faces.pop()));
    rejected("less is said to be proved", &|c| c.claim.proved = false);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_what_there_is() {
    use std::process::Stdio;
    use std::time::Duration;

    // A curve that is everywhere, and so many others that it is pursued for seconds before it is given up.
    let lines: String = (1..=300).map(|i| format!("curve l{i}: y = {i}/300\n")).collect();
    let text = lines + "curve dense: sin(40 x^2 + 31 y^3) = cos(37 x y)\ndomain [-6, 6]^2\n";
    let folder = folder(&[("dense.imp", &text)]);
    let mut child = command(folder.path(), &["arrange", "dense.imp", "--json", "-o", "out.dot"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1000));
    assert!(child.try_wait().unwrap().is_none(), "this scene should take longer");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("stopped: "), "{output:?}");
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["proved"], false);
    assert!(summary["vertices"]["cluster"].as_u64().unwrap() > 0);
    let graph = fs::read_to_string(folder.path().join("out.dot")).unwrap();
    assert_eq!(graph.matches(" -- ").count() as u64, summary["edges"].as_u64().unwrap());
}
