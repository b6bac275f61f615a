//! Widths of enclosures by every extension, over a box whole and in parts, as a table in Markdown:
//!
//!     cargo run --release --example affine_widths
//!
//! `docs/measurements/affine.md` holds its output and what is to be seen there.

use imp::derive::Extension;
use imp::derive::Formula;
use imp::interval::Decorated;
use imp::interval::Interval;
use imp::session::expression::Reading;
use imp::session::expression::Snippet;
use imp::session::expression::Workspace;

struct Case {
    formula: &'static str,
    /// The box, by the names of the inputs.
    sides: &'static [(&'static str, f64, f64)],
    /// Into how many parts each side is cut, and into how many for the range that all are compared with.
    parts: [u32; 3],
    fine: u32,
}

const LINE: [u32; 3] = [1, 16, 256];
/// Of three sides: 1, 27 and 216 boxes, the cubes nearest to 1, 16 and 256.
const SPACE: [u32; 3] = [1, 3, 6];

const BARTH: &str = "4(phi^2 x^2 - y^2)(phi^2 y^2 - z^2)(phi^2 z^2 - x^2) - (1 + 2phi)(x^2 + y^2 + z^2 - 1)^2";

const CASES: &[Case] = &[
    Case { formula: "x (10 - x)", sides: &[("x", 4.0, 6.0)], parts: LINE, fine: 1 << 14 },
    Case { formula: BARTH, sides: &[("x", 0.1, 0.2), ("y", 0.3, 0.4), ("z", 0.2, 0.3)], parts: SPACE, fine: 40 },
    Case { formula: BARTH, sides: &[("x", 1.0, 1.1), ("y", 0.5, 0.6), ("z", -0.1, 0.1)], parts: SPACE, fine: 40 },
    Case { formula: "sqrt(x^2 - x + 1/2) / sqrt(x^2 + 1/2)", sides: &[("x", -2.0, 2.0)], parts: LINE, fine: 1 << 14 },
    Case { formula: "exp(-x^2) sin(3x)", sides: &[("x", -2.0, 2.0)], parts: LINE, fine: 1 << 14 },
];

/// The formula, ready for all extensions, and the sides of its box in the order of its inputs.
fn prepare(case: &Case) -> (Formula, Vec<Decorated>) {
    let mut workspace = Workspace::default();
    let golden = Snippet::whole("golden section", "let phi = (1 + sqrt(5)) / 2");
    let written = Snippet::whole("formula", case.formula);
    let names: Vec<&str> = case.sides.iter().map(|side| side.0).collect();
    let found = workspace
        .define(&golden, &Default::default())
        .and_then(|_| workspace.expression(&written, &names, Reading::Value));
    let formula = match found {
        Ok(expression) => expression.formula(),
        Err(messages) => panic!("{}", messages.render(false)),
    };
    let side = |name: &String| {
        let &(_, lo, hi) = case.sides.iter().find(|side| side.0 == name).expect("a side for each input");
        Decorated::new(Interval::new(lo, hi).expect("ends in order"))
    };
    let sides = formula.variables().iter().map(side).collect();
    (formula, sides)
}

fn main() {
    for case in CASES {
        let (formula, sides) = prepare(case);
        let range = formula.enclose_in_parts(Extension::SecondOrder, &sides, case.fine).interval();
        let places: Vec<String> = case.sides.iter().map(|(name, lo, hi)| format!("{name} in [{lo}, {hi}]")).collect();
        println!("`{}`, {}: range [{:.6}, {:.6}],", case.formula, places.join(", "), range.lo(), range.hi());
        println!("width {:.6}.\n", range.width());
        let boxes = case.parts.map(|parts| parts.pow(case.sides.len() as u32));
        println!("| extension | {} box | {} boxes | {} boxes | operations a box |", boxes[0], boxes[1], boxes[2]);
        println!("|---|---|---|---|---|");
        for &extension in Extension::ALL {
            let widths = case.parts.map(|parts| formula.enclose_in_parts(extension, &sides, parts).interval().width());
            let [whole, some, many] = widths.map(|width| format!("{width:.6}"));
            println!("| {extension} | {whole} | {some} | {many} | {} |", formula.operations(extension));
        }
        println!();
    }
}
