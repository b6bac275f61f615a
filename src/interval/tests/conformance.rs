//! The table of conformance in the docs names what exists.

const TABLE: &str = include_str!("../../../docs/conformance.md");

/// The sources that define operations.
const SOURCES: &[&str] = &[
    include_str!("../arith.rs"),
    include_str!("../cancel.rs"),
    include_str!("../elementary.rs"),
    include_str!("../integer.rs"),
    include_str!("../mod.rs"),
    include_str!("../parse.rs"),
    include_str!("../power.rs"),
    include_str!("../relations.rs"),
    include_str!("../reverse.rs"),
    include_str!("../set_ops.rs"),
    include_str!("../text.rs"),
    include_str!("../trigonometric.rs"),
];
const DECORATED: &[&str] = &[
    include_str!("../decorated_sets.rs"),
    include_str!("../decoration.rs"),
    include_str!("../parse.rs"),
    include_str!("../text.rs"),
];

/// The operations that IEEE Std 1788.1-2017 requires, and those of 1788-2015 that it leaves out.
const REQUIRED: &str = "neg add sub mul div recip sqr sqrt fma pown pow exp exp2 exp10 log log2 log10 sin cos tan asin \
    acos atan atan2 sinh cosh tanh asinh acosh atanh sign ceil floor trunc roundTiesToEven roundTiesToAway abs min max \
    sqrRev absRev pownRev sinRev cosRev tanRev coshRev mulRev powRev1 powRev2 atan2Rev1 atan2Rev2 mulRevToPair \
    cancelMinus cancelPlus intersection convexHull empty entire numsToInterval textToInterval intervalToText \
    intervalToExact inf sup mid wid rad midRad mag mig isEmpty isEntire isNaI isCommonInterval isSingleton isMember \
    equal subset less precedes interior strictLess strictPrecedes disjoint overlap newDec setDec intervalPart \
    decorationPart";

/// The cells of the rows that describe an operation: those whose first cell is code.
fn rows() -> Vec<Vec<&'static str>> {
    let cells = |line: &'static str| line.trim_matches('|').split('|').map(str::trim).collect::<Vec<_>>();
    TABLE.lines().filter(|line| line.starts_with("| `")).map(cells).collect()
}

/// The texts between backquotes.
fn codes(cell: &str) -> impl Iterator<Item = &str> {
    cell.split('`').skip(1).step_by(2)
}

fn defines(sources: &[&str], name: &str) -> bool {
    // Functions, constants, traits, and rows of the macros that define operations.
    let forms = [
        format!("fn {name}("),
        format!("const {name}:"),
        format!("impl {name} for"),
        format!("    {name}("),
        format!("    {name} "),
    ];
    sources.iter().any(|source| forms.iter().any(|form| source.contains(form)))
        || sources.iter().any(|source| {
            source.lines().any(|line| line.starts_with("numbers!") && line.split_whitespace().any(|word| word == name))
        })
}

#[test]
fn the_table_names_what_exists() {
    let rows = rows();
    assert!(rows.len() > 80, "{} rows", rows.len());
    for row in &rows {
        assert_eq!(row.len(), 5, "{row:?}");
        for name in codes(row[1]) {
            assert!(defines(SOURCES, name), "Interval has no {name}: {row:?}");
        }
        for name in codes(row[2]) {
            assert!(defines(DECORATED, name), "Decorated has no {name}: {row:?}");
        }
        assert!(codes(row[1]).count() + codes(row[2]).count() > 0, "{row:?}");
    }
}

#[test]
fn the_table_has_every_required_operation() {
    let named: Vec<&str> = rows().iter().flat_map(|row| codes(row[0])).collect();
    for operation in REQUIRED.split_whitespace() {
        assert!(named.contains(&operation), "{operation} is not in the table");
    }
}
