//! The programs in `examples/applications/`, each run as a process: it ends well, which includes the assertions in it, and
//! says what it found.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

/// Name, and lines or parts of lines that are written.
const APPLICATIONS: &[(&str, &[&str])] = &[
    ("inflections", &["width 2.5   2 inflection points, proved", "everything proved: true"]),
    ("range_search", &["7 points, 29 different answers"]),
    ("motion", &["radius 0.25: yes", "radius 0.7: no"]),
    ("annulus", &["proved: true", "width in ["]),
    ("surfaces", &["proved: true", "double point in"]),
    ("global_minimum", &["Himmelblau", "Rosenbrock", "Ackley", "Rastrigin", "all minima proved"]),
    ("reach", &["no contradiction in", "joint boxes at c = 0.5", "wrote"]),
    ("march", &["all from one compilation", "no ray went through the surface", "wrote"]),
    ("root_finder", &["a ray meets the Barth sextic first at"]),
    ("plugin", &["the workers called all of them", "larger than allowed", "error[E"]),
];

/// The executables by name, built by the Cargo that runs this test: with `cargo test` they are there already, with
/// `cargo test --test applications` they are not.
fn executables() -> &'static BTreeMap<String, PathBuf> {
    static BUILT: OnceLock<BTreeMap<String, PathBuf>> = OnceLock::new();
    BUILT.get_or_init(|| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.current_dir(env!("CARGO_MANIFEST_DIR")).args(["build", "--message-format=json"]);
        cargo.args(APPLICATIONS.iter().flat_map(|(name, _)| ["--example", name]));
        if !cfg!(debug_assertions) {
            cargo.arg("--release");
        }
        let built = cargo.output().expect("Cargo runs");
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        let messages = String::from_utf8(built.stdout).expect("messages are text");
        let messages = messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
        let executable = |message: serde_json::Value| {
            let path = message["executable"].as_str()?;
            Some((message["target"]["name"].as_str()?.to_owned(), PathBuf::from(path)))
        };
        messages.filter_map(executable).collect()
    })
}

fn run(name: &str) {
    let (_, expected) = APPLICATIONS.iter().find(|(known, _)| *known == name).expect("the application is listed");
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(&executables()[name]);
    if ["reach", "march"].contains(&name) {
        command.arg(folder.path().join("picture.png"));
    }
    let output = command.current_dir(folder.path()).output().expect("the application runs");
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{name}: {}\n{said}\n{errors}", output.status);
    for part in *expected {
        assert!(said.contains(part), "{name} does not say `{part}`:\n{said}");
    }
}

macro_rules! applications {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                run(stringify!($name));
            }
        )*

        #[test]
        fn all_are_run() {
            let tested = [$(stringify!($name)),*];
            assert!(APPLICATIONS.iter().all(|(name, _)| tested.contains(name)));
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/applications");
            for entry in std::fs::read_dir(folder).expect("the folder is there") {
                let path = entry.expect("an entry").path();
                if path.extension().is_some_and(|extension| extension == "rs") {
                    let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
                    assert!(tested.contains(&name), "{name} is not run");
                }
            }
        }
    };
}

applications! { inflections range_search motion annulus surfaces global_minimum reach march root_finder plugin }
