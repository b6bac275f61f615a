//! `imp cost`: what it measures, and the files it writes.

#[path = "support/command.rs"]
mod command;

use std::fs;
use std::path::Path;

use command::fail;
use command::folder;
use command::succeed;

use serde_json::Value;

const SPHERE: &str = "x^2 + y^2 + z^2 = 1\ndomain [-2, 2]^3\n";

fn scene(text: &str) -> tempfile::TempDir {
    folder(&[("scene.imp", text)])
}

fn json(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
}

/// The levels of a JSON file that gave numbers.
fn measured(cost: &Value) -> Vec<&Value> {
    let levels = cost["levels"].as_array().unwrap();
    levels.iter().filter(|level| level.get("failure").is_none()).collect()
}

#[test]
fn a_scene_becomes_a_table_data_charts_and_a_page() {
    let folder = scene(SPHERE);
    let folder = folder.path();
    let mut arguments = vec!["cost", "scene.imp", "--size", "24", "--levels", "few", "--repeat", "1"];
    for output in ["c.json", "c.csv", "c.svg", "c.html"] {
        arguments.extend(["-o", output]);
    }
    let table = succeed(folder, &arguments);
    assert!(table.contains("reference: imp auto f64 outward 2^-40") && table.contains("Mitchell interval f64 outward"));

    let cost = json(folder, "c.json");
    assert_eq!(cost["size"], serde_json::json!([24, 24]));
    let reference = &cost["reference"];
    let decided = reference["hits"].as_u64().unwrap() + reference["misses"].as_u64().unwrap();
    assert!(reference["hits"].as_u64().unwrap() > 100 && decided + reference["unknown"].as_u64().unwrap() == 576);
    let levels = measured(&cost);
    assert_eq!(levels.len(), cost["levels"].as_array().unwrap().len(), "{}", cost["levels"]);
    for level in &levels {
        assert_eq!(level["compared"].as_u64().unwrap(), decided, "{level}");
        assert_eq!(level["contradicted"], 0, "{level}");
        if level["rounding"] == "nearest" {
            assert_eq!((&level["proved_hits"], &level["proved_misses"]), (&0.into(), &0.into()), "{level}");
            assert_eq!(level["unknown"], 576, "{level}");
        } else if level["engine"] == "imp" {
            assert_eq!(level["wrong"], 0, "{level}");
        }
        let bracket = level["bracket_median"].as_f64().unwrap();
        assert!(bracket > 0.0 && level["depth_max"].as_f64().unwrap() < 1.0, "{level}");
    }
    let errors: Vec<f64> = levels.iter().map(|level| level["error"].as_f64().unwrap()).collect();
    assert!(errors.is_sorted(), "{errors:?}");
    assert!(levels[0]["pareto"].as_bool().unwrap() && levels.iter().any(|level| level["pareto"] == false));

    let csv = fs::read_to_string(folder.join("c.csv")).unwrap();
    let mut lines = csv.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    for wanted in
        ["name", "ms", "ratio", "evaluations", "unknown", "wrong", "depth_max", "thin_parts_missed", "failure"]
    {
        assert!(heads.contains(&wanted), "{wanted}");
    }
    assert_eq!(lines.count(), levels.len());

    let svg = fs::read_to_string(folder.join("c.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Time against error"));
    let page = fs::read_to_string(folder.join("c.html")).unwrap();
    // Self-contained: pictures inside, nothing from elsewhere.
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("data:image/png;base64,") && page.contains("<svg"));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http") && !page.contains("@import"));
    assert_eq!(fs::read_dir(folder).unwrap().count(), 5);
}

#[test]
fn finders_that_cannot_draw_a_scene_say_why_in_their_row() {
    let folder = scene("x^2 + y^2 + z^2 <= 1\ndomain [-2, 2]^3\n");
    let arguments = ["cost", "scene.imp", "--size", "16", "--levels", "few", "--repeat", "1", "-o", "c.json"];
    let table = succeed(folder.path(), &arguments);
    assert!(table.contains("is a solid"), "{table}");
    let cost = json(folder.path(), "c.json");
    let failed: Vec<&Value> =
        cost["levels"].as_array().unwrap().iter().filter(|level| level.get("failure").is_some()).collect();
    assert!(failed.iter().any(|level| level["engine"] == "Mitchell"));
    assert!(failed.iter().all(|level| level["engine"] != "imp" && level["failure"].as_str().unwrap().len() > 10));
}

#[test]
fn coarse_brackets_are_further_from_the_truth() {
    let folder = scene("(x^2 + y^2 + z^2 + 0.91)^2 = 4 (x^2 + y^2)\ndomain [-2, 2]^3\n");
    let arguments = ["cost", "scene.imp", "--size", "32", "--repeat", "1", "-o", "c.json"];
    succeed(folder.path(), &arguments);
    let cost = json(folder.path(), "c.json");
    let error = |depth: u64| {
        let wanted = |level: &&&Value| {
            level["engine"] == "bisection"
                && level["depth"] == depth
                && level["rounding"] == "outward"
                && level["arithmetic"] == "interval"
        };
        measured(&cost).iter().find(wanted).unwrap()["error"].as_f64().unwrap()
    };
    assert!(error(8) > error(12) && error(12) > error(16) && error(16) > error(20));
}

#[test]
fn plane_scenes_have_levels_of_size() {
    let folder = scene("curve c: x^2 + y^2 = 1\ndomain [-2, 2]^2\n");
    let arguments = ["cost", "scene.imp", "--size", "64", "--repeat", "1", "-o", "c.json", "-o", "c.html"];
    succeed(folder.path(), &arguments);
    let cost = json(folder.path(), "c.json");
    assert_eq!(cost["dimension"], 2);
    let levels = measured(&cost);
    let wrong = |size: u64| {
        let wanted = |level: &&&Value| level["size"][0] == size && level["rounding"] == "outward";
        levels.iter().find(wanted).unwrap()["wrong"].as_u64().unwrap()
    };
    assert_eq!(wrong(64), 0);
    assert!(wrong(16) > wrong(32) && wrong(32) > 0);
    assert!(levels.iter().all(|level| level["depth_max"].is_null() && level["contradicted"] == 0));
    assert!(levels.iter().filter(|level| level["rounding"] == "nearest").all(|level| level["proved_hits"] == 0));
}

#[test]
fn expressions_are_enclosed_in_every_way() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["cost", "x*(10-x)", "x=[4,6]", "--repeat", "1", "-o", "c.json", "-o", "c.html", "-o", "c.csv"];
    let table = succeed(folder.path(), &arguments);
    assert!(table.contains("affine x16") && table.contains("compiled interval f32 outward x1"), "{table}");
    let cost = json(folder.path(), "c.json");
    assert_eq!(cost["inputs"], serde_json::json!([{"name": "x", "lo": 4.0, "hi": 6.0}]));
    let rows = cost["enclosures"].as_array().unwrap();
    let row = |name: &str| rows.iter().find(|row| row["name"] == name).unwrap();
    assert_eq!((&row("interval x1")["lo"], &row("interval x1")["hi"]), (&16.0.into(), &36.0.into()));
    // The centred form gives 25 + [-2, 2] [-1, 1].
    assert_eq!((&row("centred x1")["lo"], &row("centred x1")["hi"]), (&23.0.into(), &27.0.into()));
    assert!(rows.iter().filter(|row| row["rounding"] == "outward").all(|row| row["holds"] == true));
    assert!(row("interval x256")["width"].as_f64() < row("interval x16")["width"].as_f64());
    assert!(fs::read_to_string(folder.path().join("c.html")).unwrap().contains("x*(10-x)"));
}

#[test]
fn infinite_widths_are_texts_in_json() {
    let folder = tempfile::tempdir().unwrap();
    succeed(folder.path(), &["cost", "1/x", "x=[-1,1]", "--repeat", "1", "-o", "c.json"]);
    let cost = json(folder.path(), "c.json");
    assert!(cost["enclosures"].as_array().unwrap().iter().any(|row| row["width"] == "inf"));
}

#[test]
fn constants_have_a_row_for_every_way() {
    let folder = tempfile::tempdir().unwrap();
    let table = succeed(folder.path(), &["cost", "1/3 + 1/5", "--repeat", "1"]);
    assert!(table.contains("interval x1") && table.contains("needs no compiled kernel"), "{table}");
}

#[test]
fn mistakes_are_told_before_anything_is_measured() {
    let folder = scene(SPHERE);
    let folder = folder.path();
    assert!(fail(folder, &["cost", "scene.imp", "x=[0,1]"]).contains("--set x=[0,1]"));
    assert!(fail(folder, &["cost", "scene.imp", "-o", "c.png"]).contains(".html"));
    assert!(fail(folder, &["cost", "scene.imp", "-o", "no/c.html"]).contains("no folder"));
    assert!(fail(folder, &["cost", "scene.imp", "-o", "a.csv", "-o", "a.csv"]).contains("two outputs"));
    assert!(fail(folder, &["cost", "missing.imp"]).contains("missing.imp"));
    assert!(fail(folder, &["cost", "x*y", "x=[0,1]"]).contains("y"));
    assert_eq!(fs::read_dir(folder).unwrap().count(), 1);
}
