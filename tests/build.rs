//! `imp build`: objects, headers, Rust functions and static libraries, as other people's programs use them. Needs gcc.

#[path = "support/command.rs"]
mod support;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::process::Output;

use imp::Columns;
use imp::Options;
use imp::Program;
use support::fail;
use support::folder;
use support::run;
use support::succeed;

const RING: &str = "param r = 1 in [0.5, 2]
# How far from a ring.
fn f(x, y) = x^2 + y^2 - r^2
fn hand(u, double) = [cos(u) + cos(u + double), sin(u) + sin(u + double)]
fn move(x') = sqrt(x') / (x' - 1)
";

const ALL: &str = "value,gradient,interval,interval_gradient,affine,affine_gradient";

fn tool(folder: &Path, program: &str, arguments: &[&str]) -> Output {
    Command::new(program).args(arguments).current_dir(folder).output().unwrap_or_else(|e| panic!("{program}: {e}"))
}

/// Runs a compiler or a program that must succeed without a word on stderr; its stdout.
fn done(folder: &Path, program: &str, arguments: &[&str]) -> String {
    let output = tool(folder, program, arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{program} {arguments:?}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

/// Everything that can be written of a file, in a folder.
fn built(text: &str, more: &[&str]) -> tempfile::TempDir {
    let folder = folder(&[("ring.imp", text)]);
    let outputs = ["-o", "ring.o", "--header", "ring.h", "--rust", "ring.rs", "--static", "libring.a"];
    let output = run(folder.path(), &[&["build", "ring.imp"], &outputs[..], more].concat());
    assert!(output.status.success(), "{output:?}");
    folder
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let [one, other] = [built(RING, &["--kernels", ALL]), built(RING, &["--kernels", ALL])];
    for name in ["ring.o", "ring.h", "ring.rs", "libring.a"] {
        let [a, b] = [&one, &other].map(|folder| fs::read(folder.path().join(name)).unwrap());
        assert!(a == b && !a.is_empty(), "{name}");
    }
    // An interface is told from another one by its numbers alone.
    let single = built(RING, &["--precision", "f32"]);
    let symbol = |folder: &Path| {
        let header = fs::read_to_string(folder.join("ring.h")).unwrap();
        header.lines().find(|line| line.contains("ring_ABI_SYMBOL")).map(str::to_owned)
    };
    assert_ne!(symbol(single.path()), symbol(one.path()));
}

#[test]
fn headers_are_c_and_cpp() {
    let strict = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c", "-o", "use.o"];
    for precision in ["f64", "f32"] {
        let folder = built(RING, &["--kernels", ALL, "--precision", precision]);
        fs::write(folder.path().join("use.c"), "#include \"ring.h\"\n#include \"ring.h\"\n").unwrap();
        fs::copy(folder.path().join("use.c"), folder.path().join("use.cpp")).unwrap();
        for language in [["-std=c99", "use.c"], ["-std=c17", "use.c"], ["-DIMP_DYNAMIC", "use.c"]] {
            done(folder.path(), "gcc", &[&strict[..], &language].concat());
        }
        // A C compiler alone is enough for the other tests.
        if Command::new("g++").arg("--version").output().is_ok() {
            done(folder.path(), "g++", &[&strict[..], &["-std=c++11", "use.cpp"]].concat());
        }
    }
}

/// Prints the bits of everything that kernels say of some boxes, in rows and in columns, then calls by name.
const PROGRAM: &str = r#"
#include "ring.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#define COUNT 37

static void show(const double *numbers, size_t count)
{
    size_t i;
    uint64_t bits;
    for (i = 0; i < count; i++) {
        memcpy(&bits, numbers + i, 8);
        printf("%016" PRIx64 "\n", bits);
    }
}

int main(void)
{
    static double boxes[2][2][COUNT], rows[COUNT][2][2], columns[6][2][COUNT], ends[COUNT][6][2];
    static uint32_t verdicts[6][COUNT], row_verdicts[COUNT][6];
    double parameters[2];
    imp_interval x = {0.5, 1.0}, y = {2.0, 2.0};
    imp_enclosure bound;
    int i, k;
    for (i = 0; i < COUNT; i++) {
        boxes[0][0][i] = -3.0 + 0.17 * i;
        boxes[0][1][i] = -3.0 + 0.17 * i + (i % 3) * 0.1;
        boxes[1][0][i] = i == 5 ? NAN : i == 6 ? 1.0 : 0.1 * i;
        boxes[1][1][i] = i == 6 ? 0.5 : i == 7 ? INFINITY : 0.1 * i + 0.05;
        for (k = 0; k < 4; k++) rows[i][k / 2][k % 2] = boxes[k / 2][k % 2][i];
    }
    ring_hand_interval_gradient_columns(&boxes[0][0][0], NULL, &columns[0][0][0], &verdicts[0][0], COUNT);
    ring_hand_interval_gradient(&rows[0][0][0], NULL, &ends[0][0][0], &row_verdicts[0][0], COUNT);
    show(&columns[0][0][0], 6 * 2 * COUNT);
    for (i = 0; i < COUNT; i++)
        for (k = 0; k < 6; k++)
            if (memcmp(&ends[i][k][0], &columns[k][0][i], 8) || memcmp(&ends[i][k][1], &columns[k][1][i], 8)
                || row_verdicts[i][k] != verdicts[k][i])
                return 1;

    bound = ring_f_interval_at(x, y, NULL);
    if (!(bound.lo <= 3.25 && bound.hi >= 4.0 && bound.hi - bound.lo < 0.7501)) return 2;
    if (!(bound.verdict & IMP_POSITIVE) || !(bound.verdict & IMP_CONTINUOUS)) return 3;
    ring_f_defaults(parameters);
    if (!ring_f_in_range(parameters) || ring_f_value_at(3.0, 4.0, NULL) != 24.0) return 4;
    parameters[0] = parameters[1] = 2.0;
    bound = ring_f_interval_at(x, y, parameters);
    if (!ring_f_in_range(parameters) || !(bound.lo <= 0.25 && bound.hi >= 1.0 && bound.lo > 0.2)) return 5;
    parameters[1] = 2.5;
    if (ring_f_in_range(parameters)) return 6;
    if (ring_hand_VALUES != 2 || ring_hand_gradient_OUTPUTS != 6 || ring_f_PARAMETERS != 1) return 7;
    x.lo = x.hi = -1.0;
    bound = ring_move_interval_at(x, NULL);
    if (!(bound.verdict & IMP_EMPTY) || bound.lo <= bound.hi) return 8;
    return ring_level() == 0 ? 9 : 0;
}
"#;

#[test]
fn c_programs_compute_what_the_library_does() {
    let folder = built(RING, &[]);
    fs::write(folder.path().join("main.c"), PROGRAM).unwrap();
    let strict = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror"];
    done(folder.path(), "gcc", &[&strict[..], &["main.c", "ring.o", "-lm", "-o", "object"]].concat());
    done(folder.path(), "gcc", &[&strict[..], &["main.c", "-L.", "-lring", "-lm", "-o", "library"]].concat());
    let said = done(folder.path(), folder.path().join("object").to_str().unwrap(), &[]);
    assert_eq!(said, done(folder.path(), folder.path().join("library").to_str().unwrap(), &[]));

    let function = Program::parse(RING).unwrap().function("hand").unwrap();
    let kernel = function.intervals(&Options::with_gradient()).unwrap();
    let boxes: [[Vec<f64>; 2]; 2] = {
        let column = |at: fn(usize) -> f64| (0..37).map(at).collect::<Vec<f64>>();
        [
            [column(|i| -3.0 + 0.17 * i as f64), column(|i| -3.0 + 0.17 * i as f64 + (i % 3) as f64 * 0.1)],
            [
                column(|i| if i == 5 { f64::NAN } else { [0.1 * i as f64, 1.0][usize::from(i == 6)] }),
                column(|i| if i == 7 { f64::INFINITY } else { [0.1 * i as f64 + 0.05, 0.5][usize::from(i == 6)] }),
            ],
        ]
    };
    let views = boxes.each_ref().map(|[lo, hi]| [lo.as_slice(), hi.as_slice()]);
    let mut columns = Columns::default();
    kernel.enclose_columns(&views, &mut columns).unwrap();
    let ends = (0..6).flat_map(|output| [&columns.lo[output], &columns.hi[output]]).flatten();
    let expected: Vec<String> = ends.map(|number| format!("{:016x}", number.to_bits())).collect();
    assert_eq!(said.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn another_interface_does_not_link() {
    let folder = built(RING, &[]);
    fs::write(folder.path().join("main.c"), "#include \"ring.h\"\nint main(void) { return 0; }\n").unwrap();
    done(folder.path(), "gcc", &["main.c", "ring.o", "-lm", "-o", "main"]);
    for changed in [RING.replace("f(x, y)", "f(y, x)"), RING.replace("[0.5, 2]", "[0.5, 3]")] {
        let other = built(&changed, &[]);
        fs::copy(other.path().join("ring.o"), folder.path().join("other.o")).unwrap();
        let output = tool(folder.path(), "gcc", &["main.c", "other.o", "-lm", "-o", "main"]);
        assert!(!output.status.success());
        assert!(String::from_utf8_lossy(&output.stderr).contains("ring_abi_1_"), "{output:?}");
    }
    // Another formula behind the same interface is the same to a caller.
    let other = built(&RING.replace("x^2 + y^2", "x^2 + 2 y^2"), &[]);
    fs::copy(other.path().join("ring.o"), folder.path().join("other.o")).unwrap();
    done(folder.path(), "gcc", &["main.c", "other.o", "-lm", "-o", "main"]);
}

const RUST: &str = r#"
#[path = "ring.rs"]
mod ring;
use ring::imp_types::{Error, Interval, Verdict};

fn main() {
    let box_ = [Interval::new(0.5, 1.0), Interval::point(2.0)];
    let bound = ring::f::interval(box_);
    assert!(bound.interval.encloses(Interval::new(3.25, 4.0)) && bound.is_positive() && bound.interval.width() < 0.7501);
    let wide = ring::f::Parameters { r: Interval::new(1.0, 2.0) }.checked().unwrap();
    assert!(wide.interval(box_).interval.encloses(Interval::new(0.25, 4.0)));
    assert_eq!(wide.value([3.0, 4.0]), 25.0 - 2.25);
    let outside = ring::f::Parameters { r: Interval::new(1.0, 2.5) }.checked();
    assert!(matches!(outside, Err(Error::Parameter { name: "r", .. })));
    assert!(ring::f::Parameters { r: Interval::new(2.0, 1.0) }.checked().is_err());
    assert_eq!(ring::f::Parameters::default().checked().unwrap().interval(box_), bound);
    let (mut ends, mut verdicts) = (vec![Interval::ENTIRE; 9], vec![Verdict::default(); 9]);
    ring::f::interval_gradient_rows(&[box_; 3], &mut ends, Some(&mut verdicts)).unwrap();
    assert_eq!(ends[6], bound.interval);
    assert!(ends[7].encloses(Interval::new(1.0, 2.0)) && ends[8].contains(4.0) && verdicts[7].is_positive());
    assert!(ring::f::interval_gradient_rows(&[box_; 3], &mut ends[..8], None).is_err());
    let mut columns = [0.0; 4];
    ring::f::interval_columns(&[0.5, 0.5, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0], &mut columns, None).unwrap();
    assert_eq!(columns, [bound.interval.lo, bound.interval.lo, bound.interval.hi, bound.interval.hi]);
    let [x, dx, ..] = ring::hand::gradient([0.0, 0.0]);
    assert_eq!([x, dx], [2.0, 0.0]);
    assert!(ring::move_::interval([Interval::point(-1.0)]).is_empty());
    assert!(ring::level() > 0);
}
"#;

#[test]
fn rust_programs_need_no_crate() {
    let folder = built(RING, &[]);
    fs::write(folder.path().join("main.rs"), RUST).unwrap();
    let rustc = std::env::var("RUSTC").unwrap_or("rustc".to_owned());
    let arguments =
        ["--edition", "2024", "-D", "warnings", "main.rs", "-L", ".", "-l", "static=ring", "-l", "m", "-o", "main"];
    done(folder.path(), &rustc, &arguments);
    done(folder.path(), folder.path().join("main").to_str().unwrap(), &[]);
}

#[test]
fn what_cannot_be_exported_is_said() {
    let text = "fn inside(a, b) = union(a, b)\nfn f(x) = x^2\nfn move(x) = x\nfn f'(x) = 2x";
    let folder = folder(&[("a-b.imp", text)]);
    let output = run(folder.path(), &["build", "a-b.imp", "--header", "a.h"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("`f'` is called `f_prime`") && said.contains("`move` is called `move_` in Rust"), "{said}");
    assert!(said.contains("`inside` is left out"), "{said}");
    let header = fs::read_to_string(folder.path().join("a.h")).unwrap();
    assert!(
        header.contains("a_b_f_prime_interval") && header.contains("a_b_move_value") && !header.contains("a_b_inside")
    );
}

#[test]
fn mistakes_write_nothing() {
    let files = [
        ("ok.imp", "fn f(x) = x^2\nfn g(x) = x^3"),
        ("none.imp", "let a = 3"),
        ("wrong.imp", "fn f(x) = x^2 + * y"),
        ("clash.imp", "fn f'(x) = x\nfn f_prime(x) = x"),
        ("kernels.imp", "fn f(x) = x\nfn f_interval(x) = x"),
    ];
    let folder = folder(&files);
    let cases: [(&[&str], &str); 13] = [
        (&["ok.imp"], "no output is asked for"),
        (&["ok.imp", "-o", "no/ok.o", "--header", "k.h"], "there is no folder"),
        (&["ok.imp", "--header", "k.h", "--rust", "k.h"], "two things at once"),
        (&["ok.imp", "--rust", "ok.imp"], "two things at once"),
        (&["ok.imp", "-o", "k.o", "--functions", "f,h"], "there is no function `h`"),
        (&["ok.imp", "-o", "k.o", "--kernels", "values"], "invalid value 'values'"),
        (&["ok.imp", "-o", "k.o", "--levels", "v3,v5"], "invalid value 'v5'"),
        (&["ok.imp", "-o", "k.o", "--target", "aarch64", "--levels", "v3"], "leave `--levels` out"),
        (&["none.imp", "-o", "k.o"], "there is no function of numbers"),
        (&["wrong.imp", "-o", "k.o"], "wrong.imp:1:1"),
        (&["clash.imp", "-o", "k.o"], "would both be called `clash_f_prime"),
        (&["kernels.imp", "-o", "k.o"], "would both be called `kernels_f_interval_gradient"),
        (&["missing.imp", "-o", "k.o"], "missing.imp"),
    ];
    for (arguments, expected) in cases {
        let said = fail(folder.path(), &[&["build"], arguments].concat());
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), files.len());
    assert_eq!(fs::read_to_string(folder.path().join("ok.imp")).unwrap(), files[0].1);
    // One of two functions whose names collide can be had.
    succeed(folder.path(), &["build", "kernels.imp", "-o", "k.o", "--functions", "f_interval"]);
}

/// What `make` does in `examples/embedding/c`.
#[test]
fn the_c_example_runs() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/embedding");
    let folder = tempfile::tempdir().unwrap();
    let formulas = sources.join("himmelblau.imp");
    let outputs = ["-o", "himmelblau.o", "--header", "himmelblau.h", "--kernels", "value,interval"];
    succeed(folder.path(), &[&["build", formulas.to_str().unwrap()], &outputs[..]].concat());
    let program = sources.join("c/minimum.c");
    let flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-I.", "-o", "minimum"];
    done(folder.path(), "gcc", &[&flags[..], &[program.to_str().unwrap(), "himmelblau.o", "-lm"]].concat());
    let said = done(folder.path(), folder.path().join("minimum").to_str().unwrap(), &[]);
    assert!(said.contains("the minimum lies in [0, "), "{said}");
}

#[test]
fn the_python_example_runs() {
    let numpy = Command::new("python3").args(["-c", "import numpy"]).output();
    if !numpy.is_ok_and(|output| output.status.success()) {
        println!("skipped: there is no Python with NumPy here");
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let script = root.join("examples/embedding/python/himmelblau.py");
    let output = Command::new("python3").arg(script).env("IMP", env!("CARGO_BIN_EXE_imp")).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("eight threads compute the same bits"), "{output:?}");
}
