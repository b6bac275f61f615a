//! Hard cases: for each what plain floating point makes of it, and what Imp must say. `cargo test --test stability --
//! --nocapture` prints a line for each; docs/hard-cases.md is the same as a table, renewed with IMP_BLESS=1.

mod case;
mod exact;
mod expressions;
mod first_root;
mod formula;
mod functions;
mod plain;
mod poles;
mod rays;
mod shot;
mod surfaces;
mod torus;

use std::collections::HashMap;
use std::env;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::LazyLock;
use std::sync::Mutex;
use std::sync::OnceLock;

use case::Case;

/// A heading with its cases, each under a key.
type Group = (&'static str, &'static [(&'static str, fn() -> Case)]);

/// Declares the table of cases, and a test for each.
macro_rules! cases {
    ($($group:ident $title:literal: $($name:ident)*;)*) => {
        const GROUPS: &[Group] =
            &[$(($title, &[$((concat!(stringify!($group), "::", stringify!($name)), $group::$name)),*])),*];

        mod each {
            $(mod $group {
                $(#[test]
                fn $name() {
                    crate::outcome(concat!(stringify!($group), "::", stringify!($name)), crate::$group::$name);
                })*
            })*
        }
    };
}

cases! {
    expressions "Expressions whose terms cancel":
        rump rump_exactly wilkinson_at_its_roots wilkinson_roots wilkinson_perturbed muller
        cosine_near_zero difference_of_roots quadratic_formula;
    functions "Functions and powers":
        sine_of_1e22 sine_of_2_to_1023 odd_root astroid quotient_of_powers inverse_powers vanishing_square;
    rays "Rays that graze or come from afar":
        near_tangent touching grazing far_away small large shifted expanded zoomed_boxes zoomed_picture;
    surfaces "Surfaces that taper, touch and cross":
        steiner_axes steiner_below_axes steiner_on_axes teardrop_neck teardrop_point heart heart_normals sextic_nodes decic_nodes crosscap power_200 squared;
    poles "Poles without a root":
        plane tangent shell inverse;
    first_root "First roots":
        derivative_bisection clamped_newton;
}

/// The outcome of a case, shared by those who ask for it.
type Outcome = Arc<OnceLock<Case>>;

/// What came out of a case, which runs once, whether its own test asks first or the table.
fn outcome(key: &'static str, run: fn() -> Case) -> Outcome {
    static OUTCOMES: LazyLock<Mutex<HashMap<&str, Outcome>>> = LazyLock::new(Default::default);
    let cell = OUTCOMES.lock().expect("no case runs under the lock").entry(key).or_default().clone();
    cell.get_or_init(|| {
        let case = run();
        println!("{}", case.line());
        case
    });
    cell
}

const INTRODUCTION: &str = "# Hard cases

What plain floating point makes of formulas on which it fails, and what Imp says of the same ones. The suite
`tests/stability` computes every entry when it runs, holds Imp's against exact rational arithmetic or values of higher
precision, and compares the results with this page; `IMP_BLESS=1 cargo test --test stability` writes it anew.

Plain `f32` and `f64` are the formula as it is written, rounded to nearest. A ray is *lost* if plain root finding finds
nothing where there is a root, *wrong* if it finds another place than the first root, and *invented* if it finds one where
there is none. Imp calls a ray *proved* if its first root is proved to be in a bracket, *missed* if the ray is proved to
have none, else *unknown*: no proved answer of any of these rays is wrong.
";

fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    for (title, cases) in GROUPS {
        page += &format!("\n## {title}\n\n| case | plain `f32` | plain `f64` | Imp | why |\n|---|---|---|---|---|\n");
        for &(key, run) in *cases {
            page += &outcome(key, run).get().expect("it has run").row();
            page.push('\n');
        }
    }
    page
}

/// Whether this machine is of the kind that has written the page: on others, kernels without fused operations and other
/// libraries of functions may decide a ray more or less.
fn is_usual_machine() -> bool {
    #[cfg(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"))]
    return std::is_x86_feature_detected!("fma");
    #[cfg(not(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu")))]
    return false;
}

/// A line of the page; on other machines without what is computed.
fn comparable(line: &str) -> String {
    let cells: Vec<&str> = line.split(" | ").collect();
    match cells[..] {
        [name, _, _, _, why] if !is_usual_machine() => format!("{name} | {why}"),
        _ => line.to_owned(),
    }
}

#[test]
fn the_page_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/hard-cases.md");
    let page = page();
    if env::var_os("IMP_BLESS").is_some() {
        fs::write(&path, page).expect("the page can be written");
        return;
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    let [new, old] = [&page, &written].map(|page| page.lines().map(comparable).collect::<Vec<_>>());
    for (new, old) in new.iter().zip(&old) {
        assert_eq!(new, old, "docs/hard-cases.md is out of date; IMP_BLESS=1 renews it");
    }
    assert_eq!(new.len(), old.len(), "docs/hard-cases.md is out of date; IMP_BLESS=1 renews it");
}
