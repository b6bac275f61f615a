//! The grammar: every lexical and precedence rule of the language as a table from text to tree, and its limits.

use std::time::Duration;
use std::time::Instant;

use imp::diagnostic::FileId;
use imp::diagnostic::SourceMap;
use imp::diagnostic::code;
use imp::syntax;
use imp::syntax::ast::ExprKind;
use imp::syntax::ast::StatementKind;
use imp::syntax::dump;

const FILE: FileId = FileId(0);

fn tree(text: &str) -> String {
    match syntax::parse_expression(FILE, text) {
        Ok(expr) => dump::expression(&expr),
        Err(found) => found.iter().map(|d| d.code).collect::<Vec<_>>().join(" "),
    }
}

fn check(table: &[(&str, &str)]) {
    let wrong: String = table
        .iter()
        .map(|(text, want)| (text, want, tree(text)))
        .filter(|(_, want, found)| *want != found)
        .map(|(text, want, found)| format!("{text}\n  expected {want}\n  found    {found}\n"))
        .collect();
    assert!(wrong.is_empty(), "{wrong}");
}

/// The codes of the messages about a file.
fn codes(text: &str) -> Vec<&'static str> {
    syntax::parse(FILE, text).1.iter().map(|d| d.code).collect()
}

fn statements(text: &str) -> Vec<String> {
    let (module, found) = syntax::parse(FILE, text);
    assert!(found.is_empty(), "{text}: {found:?}");
    module.statements.iter().map(|s| dump::statement(s).trim_end().to_string()).collect()
}

#[test]
fn rule_1_words() {
    check(&[
        ("2", "2"),
        ("0.5", "1/2"),
        (".5", "1/2"),
        ("2e3", "2000"),
        ("1e-2", "1/100"),
        ("0.1", "1/10"),
        ("0x1.8p+1", "3"),
        ("0x1f", "E0104"),
        ("0xg", "(side 0 xg)"),
        ("2e3x", "(side 2000 x)"),
        ("2e", "(side 2 e)"),
        ("x'", "x'"),
        ("f'(x)", "(apply f' x)"),
        ("x_1 # comment", "x_1"),
        ("φ + π", "(sum φ + pi)"),
        ("1e1000000000", "E0105"),
        ("x²", "(^ x 2)"),
        ("x⁻¹²", "(^ x (neg 12))"),
        ("a − b · c × d", "(sum a - (product b * c * d))"),
        ("a ≤ b", "(relation a <= b)"),
        ("a ≥ b ∧ ¬ c ≠ d", "(and (relation a >= b) (not (relation c != d)))"),
    ]);
}

#[test]
fn rule_2_lines() {
    assert_eq!(statements("x = 1\ny = 2").len(), 2);
    assert_eq!(statements("x = 1; y = 2;\n\n;").len(), 2);
    assert_eq!(statements("x\n  + 1 = 2"), ["(shape (relation (sum x + 1) = 2))"]);
    assert_eq!(statements("x +\n1 = 2"), ["(shape (relation (sum x + 1) = 2))"]);
    assert_eq!(statements("x\n  - 1 = 2"), ["(shape (relation (sum x - 1) = 2))"]);
    assert_eq!(codes("x\n- 1 = 2"), [code::AMBIGUOUS_LINE]);
    assert_eq!(codes("  x\n  - 1 = 2"), [code::AMBIGUOUS_LINE]);
    assert_eq!(codes("x\n\u{2212} 1 = 2"), [code::AMBIGUOUS_LINE]);
    assert_eq!(statements("x = (1\n- 2\n)").len(), 1);
    assert_eq!(statements("x = 1\nwhere y < 2"), ["(shape (relation x = 1) (where (relation y < 2)))"]);
    assert_eq!(codes("x = (1\nlet a = 2"), [code::BRACKET]);
    assert_eq!(statements("x = 1\r\ny = 2\rz = 3").len(), 3);
    assert_eq!(statements("# only a comment\n\n"), [] as [&str; 0]);
}

#[test]
fn rule_3_precedence() {
    check(&[
        ("a + b * c ^ d", "(sum a + (product b * (^ c d)))"),
        ("a * b + c", "(sum (product a * b) + c)"),
        ("a - b - c + d", "(sum a - b - c + d)"),
        ("a / b * c / d", "(product a / b * c / d)"),
        ("-a * b", "(product (neg a) * b)"),
        ("a * -b", "(product a * (neg b))"),
        ("a - -b", "(sum a - (neg b))"),
        ("--a", "(neg (neg a))"),
        ("-2x", "(neg (side 2 x))"),
        ("2x * 3y", "(product (side 2 x) * (side 3 y))"),
        ("2x / 3", "(product (side 2 x) / 3)"),
        ("-a + b", "(sum (neg a) + b)"),
        ("a < b + c", "(relation a < (sum b + c))"),
        ("not a < b", "(not (relation a < b))"),
        ("not not a", "(not (not a))"),
        ("not a and b or c", "(or (and (not a) b) c)"),
        ("a or b and c or d", "(or a (and b c) d)"),
        ("if a < b then c + d else e or f", "(if (relation a < b) (sum c + d) (or e f))"),
        ("if a then if b then c else d else e", "(if a (if b c d) e)"),
        ("if a then b else if c then d else e", "(if a b (if c d e))"),
        ("(if a then b else c) + d", "(sum (group (if a b c)) + d)"),
        ("1 + if a then b else c", "E0114"),
    ]);
}

#[test]
fn rule_4_juxtaposition() {
    check(&[
        ("2x", "(side 2 x)"),
        ("3(x + 1)", "(side 3 (group (sum x + 1)))"),
        ("phi^2 x^2", "(side (^ phi 2) (^ x 2))"),
        ("x y z", "(side x y z)"),
        ("(a)(b)", "(side (group a) (group b))"),
        ("2|x|y", "(side 2 (bars x) y)"),
        ("2[a, b]", "(side 2 (list a b))"),
        ("[a](b)", "(side (list a) (group b))"),
        ("x -y", "(sum x - y)"),
        ("2 -x", "(sum 2 - x)"),
        ("2 3", "E0109"),
        ("x 3", "(side x 3)"),
        ("x^2 3", "E0109"),
        ("(2) 3", "(side (group 2) 3)"),
        ("4(a - b)(c - d) = e", "(relation (side 4 (group (sum a - b)) (group (sum c - d))) = e)"),
    ]);
}

#[test]
fn rule_5_calls() {
    check(&[
        ("a(b)^2", "(^ (apply a b) 2)"),
        ("f(b)^2", "(^ (apply f b) 2)"),
        ("f (x)", "(apply f x)"),
        ("f()", "(apply f)"),
        ("f(x, y,)", "(apply f x y)"),
        ("2f(x)y", "(side 2 (apply f x) y)"),
        ("f(x)(y)", "(side (apply f x) (group y))"),
        ("x^f(y)", "(^ x (apply f y))"),
        ("2(x)", "(side 2 (group x))"),
    ]);
}

#[test]
fn rule_6_powers() {
    check(&[
        ("2^-x y", "(side (^ 2 (neg x)) y)"),
        ("x^2y", "(side (^ x 2) y)"),
        ("-x^2", "(neg (^ x 2))"),
        ("2^3^2", "(^ 2 (^ 3 2))"),
        ("2^-3^2", "(^ 2 (neg (^ 3 2)))"),
        ("2^--x", "(^ 2 (neg (neg x)))"),
        ("x^(1/3)", "(^ x (group (product 1 / 3)))"),
        ("(-x)^2", "(^ (group (neg x)) 2)"),
        ("|x|^2", "(^ (bars x) 2)"),
        ("2^x²", "(^ 2 (^ x 2))"),
        ("x²^3", "E0115"),
    ]);
}

#[test]
fn rule_7_two_readings() {
    check(&[
        ("1/2x", "E0110"),
        ("1/2(x)", "E0110"),
        ("a/b c", "E0110"),
        ("1/-2x", "E0110"),
        ("1/2 * x", "(product 1 / 2 * x)"),
        ("(1/2)x", "(side (group (product 1 / 2)) x)"),
        ("1/(2x)", "(product 1 / (group (side 2 x)))"),
        ("1/f(x)", "(product 1 / (apply f x))"),
        ("x^1/2", "(product (^ x 1) / 2)"),
        ("sin 2x", "E0111"),
        ("sin x", "E0111"),
        ("sin^2(x)", "E0111"),
        ("sin²(x)", "E0111"),
        ("sin|x|", "E0111"),
        ("sin(2x)", "(apply sin (side 2 x))"),
        ("sin(x)^2", "(^ (apply sin x) 2)"),
    ]);
    for name in syntax::FUNCTIONS {
        assert_eq!(tree(&format!("{name} x")), "E0111");
        assert_eq!(tree(&format!("{name}(x)")), format!("(apply {name} x)"));
    }
}

#[test]
fn rule_7_offers_both_readings() {
    let help = |text: &str| syntax::parse_expression(FILE, text).unwrap_err().remove(0).help.join("; ");
    assert_eq!(help("1/2x"), "write `(1/2)x`; or write `1/(2x)`");
    assert_eq!(help("4/3 pi r^3"), "write `(4/3) pi r^3`; or write `4/(3 pi r^3)`");
    assert_eq!(help("sin 2x"), "write `sin(2x)`");
    assert_eq!(help("sin^2(x)"), "write `sin(x)^2`");
    assert_eq!(help("|x|y|z|"), "write `abs(x)y abs(z)`; write `abs(x abs(y)z)`");
}

#[test]
fn rule_8_bars() {
    check(&[
        ("|x|", "(bars x)"),
        ("|x| + |y|", "(sum (bars x) + (bars y))"),
        ("|x| - |y| - |z|", "(sum (bars x) - (bars y) - (bars z))"),
        ("||x| - 1|", "(bars (sum (bars x) - 1))"),
        ("|1 - |x||", "(bars (sum 1 - (bars x)))"),
        ("||x||", "(bars (bars x))"),
        ("|x||y|", "(side (bars x) (bars y))"),
        ("|-x|", "(bars (neg x))"),
        ("2|x|", "(side 2 (bars x))"),
        ("|x|y", "(side (bars x) y)"),
        ("|x| < |y|", "(relation (bars x) < (bars y))"),
        ("f(|x|, |y|)", "(apply f (bars x) (bars y))"),
        ("|(|x|)(|y|)|", "(bars (side (group (bars x)) (group (bars y))))"),
        ("|x|^2|y|^2", "(side (^ (bars x) 2) (^ (bars y) 2))"),
        ("|x|y|z|", "E0108"),
        ("|a|b|c|d|e|", "E0108"),
        ("|x", "E0108"),
        ("x||y", "E0108"),
        ("||", "E0108"),
        ("|x < 1|", "E0108"),
        ("|(x < 1)|", "(bars (group (relation x < 1)))"),
    ]);
}

#[test]
fn rule_9_relations() {
    check(&[
        ("x = 1", "(relation x = 1)"),
        ("a < b <= c", "(relation a < b <= c)"),
        ("a > b >= c > d", "(relation a > b >= c > d)"),
        ("a != b", "(relation a != b)"),
        ("a < b > c", "E0112"),
        ("a = b = c", "E0112"),
        ("a = b < c", "E0112"),
        ("a < b = c", "E0112"),
        ("f(x = 1)", "(apply f (= x 1))"),
        ("f(a, x = y < z)", "(apply f a (= x (relation y < z)))"),
        ("f((x = 1))", "(apply f (group (relation x = 1)))"),
        ("f(2x = 1)", "(apply f (relation (side 2 x) = 1))"),
        ("(x = 1)", "(group (relation x = 1))"),
        ("2(x = 1)", "(side 2 (group (relation x = 1)))"),
        ("[x = 1]", "(list (relation x = 1))"),
        ("f([x = 1], y = 2)", "(apply f (list (relation x = 1)) (= y 2))"),
        ("f(x + (y = 1))", "(apply f (sum x + (group (relation y = 1))))"),
    ]);
}

#[test]
fn rule_10_domains() {
    let three = "(domain (range 0 1) (range 0 1) (range 0 1))";
    for text in [
        "domain [0, 1]^3",
        "domain [0, 1]³",
        "domain [0, 1] x [0, 1] x [0, 1]",
        "domain [0,1]x[0,1]×[0,1]",
        "domain [0, 1]^2 x [0, 1]",
        "domain [0, 1]^2x[0, 1]",
        "domain [0, 1] x\n[0, 1]^2",
        "domain [0, 1] ×\n[0, 1]^2",
    ] {
        assert_eq!(statements(text), [three], "{text}");
    }
    assert_eq!(statements("domain [-x, 2 x]"), ["(domain (range (neg x) (side 2 x)))"]);
    assert_eq!(codes("domain [0, 1] [0, 1]"), [code::INCOMPLETE_STATEMENT]);
    assert_eq!(codes("domain [0, 1]^4"), [code::BAD_REPETITION]);
    assert_eq!(codes("domain [0, 1]^1000000000000000000000000"), [code::BAD_REPETITION]);
}

#[test]
fn rule_11_every_statement_by_itself() {
    let text = "let a = 1 +\nlet b = 2\nlet c = sin x + 1/2y\nlet d = (3\nlet e = 4 ** 2\nlet f = 5";
    let (module, found) = syntax::parse(FILE, text);
    let names: Vec<_> = module
        .statements
        .iter()
        .map(|s| match &s.kind {
            StatementKind::Let { name, .. } => name.text.as_str(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(names, ["b", "f"]);
    let codes: Vec<_> = found.iter().map(|d| d.code).collect();
    use code::{BRACKET, FOREIGN_OPERATOR, FUNCTION_WITHOUT_BRACKETS, MISSING_OPERAND};
    assert_eq!(codes, [MISSING_OPERAND, FUNCTION_WITHOUT_BRACKETS, BRACKET, FOREIGN_OPERATOR]);
}

#[test]
fn reported_errors_are_bounded() {
    let found = codes(&"x @ y;".repeat(10_000));
    assert_eq!(found.len(), 101);
    assert_eq!(found.last(), Some(&code::TOO_MANY_ERRORS));
}

/// What nests exactly `n` deep, in every way that nests.
fn nested(n: usize) -> Vec<String> {
    let around = |open: &str, close: &str| format!("{}x{}", open.repeat(n), close.repeat(n));
    vec![
        around("(", ")"),
        around("[", "]"),
        around("f(", ")"),
        around("f(a = ", ")"),
        around("-", ""),
        around("not ", ""),
        around("2^", ""),
        around("if a then b else ", ""),
        around("if ", " then a else b"),
    ]
}

#[test]
fn nesting_is_capped() {
    for text in nested(syntax::MAX_DEPTH) {
        let expr = syntax::parse_expression(FILE, &text);
        assert!(expr.is_ok(), "{text}: {expr:?}");
        assert!(!dump::expression(&expr.unwrap()).is_empty());
    }
    for text in nested(syntax::MAX_DEPTH + 1) {
        assert_eq!(tree(&text), code::TOO_DEEP, "{text}");
    }
    for text in nested(200_000) {
        assert_eq!(tree(&text), code::TOO_DEEP);
    }
    // The most nodes for one level, of which seven and the last name make `MAX_NODES`.
    let rich = |n: usize| format!("{}x{}", "a or b and c < d + e * 2f(".repeat(n), ")".repeat(n));
    let most = (syntax::MAX_NODES - 1) / 7;
    assert!(!dump::expression(&syntax::parse_expression(FILE, &rich(most)).unwrap()).is_empty());
    assert_eq!(tree(&rich(most + 1)), code::TOO_DEEP);
    assert_eq!(tree(&rich(syntax::MAX_DEPTH)), code::TOO_DEEP);
    assert_eq!(codes(&format!("let a = {}; let b = 2", rich(syntax::MAX_DEPTH))), [code::TOO_DEEP]);
    // Mixed: each bracket with what waits around it counts.
    assert_eq!(tree(&format!("{}x{}", "-(2^(".repeat(100), "))".repeat(100))), code::TOO_DEEP);
    assert_eq!(tree(&format!("{}x", "(".repeat(1_000_000))), code::BRACKET);
    assert_eq!(tree(&"|".repeat(1_000_000)), code::BARS);
    assert_eq!(tree(&format!("{}x{}", "|".repeat(100), "|".repeat(100))), code::BARS);
}

#[test]
fn what_stands_side_by_side_does_not_nest() {
    for text in ["x^2 ", "(x)^2", "f(x)^2 ", "|x|^2", "-x^2 + ", "not a and ", "2^-x * ", "(if a then b else c)"] {
        let all = format!("{}x", text.repeat(1000));
        assert!(syntax::parse_expression(FILE, &all).is_ok(), "{text}");
    }
    let arguments = format!("f({})", "if a then b else c, ".repeat(1000));
    assert!(syntax::parse_expression(FILE, &arguments).is_ok());
}

#[test]
fn a_million_terms_are_flat() {
    for (term, sign) in [("x", " + "), ("2", "*"), ("x", " "), ("x", " and "), ("x", " < ")] {
        let text = vec![term; 1_000_000].join(sign);
        let begun = Instant::now();
        let expr = syntax::parse_expression(FILE, &text).unwrap();
        let operands = match &expr.kind {
            ExprKind::Sum { rest, .. } => rest.len() + 1,
            ExprKind::Product { rest, .. } => rest.len() + 1,
            ExprKind::And(operands) => operands.len(),
            ExprKind::Relation { operands, .. } => operands.len(),
            other => panic!("{other:?}"),
        };
        assert_eq!(operands, 1_000_000);
        drop(expr);
        // About a second on a slow machine without optimisation; quadratic work would take hours.
        assert!(begun.elapsed() < Duration::from_secs(60), "{sign:?}: {:?}", begun.elapsed());
    }
}

#[test]
fn long_inputs_of_errors_stay_linear() {
    let n = 200_000;
    for text in [
        "|x|y".repeat(n),
        "sin x ".repeat(2_000),
        "1/2x + ".repeat(2_000),
        "2 3 ".repeat(n),
        "x\n- ".repeat(n),
        "(\n".repeat(n),
        ")".repeat(n),
        "\"".repeat(n),
        "x = ".repeat(n),
        "# c\n".repeat(n),
        "é".repeat(n),
        "²".repeat(n),
        "9".repeat(n),
        "a\n".repeat(n),
    ] {
        let begun = Instant::now();
        let mut map = SourceMap::default();
        let file = map.add("long.imp", text.as_str());
        let found = syntax::parse(file, &text).1;
        let shown = imp::diagnostic::render(&map, &found, false);
        let start: String = text.chars().take(12).collect();
        assert!(begun.elapsed() < Duration::from_secs(60), "{start:?}: {:?}", begun.elapsed());
        assert!(shown.len() < 200_000, "{start:?}: {} bytes of messages", shown.len());
    }
}

#[test]
fn expressions_alone() {
    check(&[
        ("x +\n 1\n", "(sum x + 1)"),
        ("x\n- 1", "(sum x - 1)"),
        ("", "E0114"),
        ("# nothing", "E0114"),
        ("x; y", "E0115"),
        ("let a = 1", "E0115"),
        ("x where y", "E0115"),
        ("x,", "E0115"),
        ("x)", "E0106"),
        ("\"text\"", "\"text\""),
    ]);
}

#[test]
fn more_input_is_wanted_while_a_statement_is_open() {
    for text in ["f(1,", "x +", "let a =", "x = (1\n + 2", "if a", "if a then", "domain [0, 1] x", "x = # then"] {
        let open = !matches!(text, "if a");
        assert_eq!(syntax::wants_more(text), open, "{text}");
    }
    for text in ["", "x", "f(1)", "x = 1 + 2 # and", "x +; y", "2x", ")"] {
        assert!(!syntax::wants_more(text), "{text}");
    }
}

#[test]
fn bytes_that_are_no_text_are_pointed_at() {
    let mut map = SourceMap::default();
    let (_, fault) = map.add_bytes("good.imp", "x² = 1".as_bytes());
    assert!(fault.is_none());
    let (_, fault) = map.add_bytes("bad.imp", b"x = 1\ny = \xFF2\xC3");
    let fault = fault.unwrap();
    assert_eq!(fault.code, code::NOT_TEXT);
    let shown = imp::diagnostic::render(&map, &[fault], false);
    assert!(shown.contains("bad.imp:2:5") && shown.contains("0xFF"), "{shown}");
}

#[test]
fn spans_point_at_what_was_written() {
    let text = "let a = 1\nsurface s: 2x + |y| = f(k = [1, 2]) where x < 3";
    let mut map = SourceMap::default();
    let file = map.add("a.imp", text);
    let (module, _) = syntax::parse(file, text);
    assert_eq!(map.text(module.statements[1].span), &text[10..]);
    let StatementKind::Shape { name, relation, condition, .. } = &module.statements[1].kind else { panic!() };
    assert_eq!(map.text(name.as_ref().unwrap().span), "s");
    assert_eq!(map.text(condition.as_ref().unwrap().span), "x < 3");
    let ExprKind::Relation { operands, .. } = &relation.kind else { panic!() };
    assert_eq!(map.text(operands[0].span), "2x + |y|");
    assert_eq!(map.text(operands[1].span), "f(k = [1, 2])");
}
