//! Random formulas: what two searches say of them must fit together, and fit with signs to 320 bits.

use astro_float::Consts;
use fastrand::Rng;
use imp::graph;
use imp::interval::Decorated;
use imp::interval::Decoration;
use imp::interval::Interval;
use imp::roots::Root;
use imp::roots::Roots;

use crate::answers::Finder;
use crate::answers::expression;
use crate::answers::interval;
use crate::oracle;

/// `IMP_TEST_CASES` sets the number of formulas.
pub fn cases() -> usize {
    std::env::var("IMP_TEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(60)
}

/// A formula in x.
fn formula(rng: &mut Rng, depth: usize) -> String {
    if depth == 0 {
        return match rng.usize(0..3) {
            0 => format!("({}/8)", rng.i32(-24..24)),
            _ => "x".to_owned(),
        };
    }
    let part = |rng: &mut Rng| formula(rng, depth - 1);
    let a = part(rng);
    let b = part(rng);
    match rng.usize(0..16) {
        0..3 => format!("({a} + {b})"),
        3..6 => format!("({a} - {b})"),
        6..9 => format!("({a} * {b})"),
        9 => format!("({a} / {b})"),
        10 => format!("sin({a} + {b})"),
        11 => format!("cos({a} * 2)"),
        12 => format!("atan({a})"),
        13 => format!("sqrt({a})"),
        14 => format!("min({a}, {b})"),
        _ => format!("|{a}|"),
    }
}

/// Where zeros may be, by what was found.
fn covered(found: &Roots, x: Interval) -> bool {
    found.proved.iter().any(|root| !root.bracket.disjoint(x)) || found.unknown.iter().any(|y| !y.disjoint(x))
}

#[test]
fn searches_of_random_formulas_fit_together() {
    let mut rng = Rng::with_seed(21);
    let mut cc = Consts::new().expect("constants");
    let range = interval(-5.0, 5.0);
    let (mut roots, mut sharp, mut signs) = (0, 0, 0);
    let mut wider = Vec::new();
    for case in 0..cases() {
        let text = formula(&mut rng, 3);
        let expression = expression(&text);
        let (graph, f) = (&*expression.graph, expression.root);
        let [reference, compiled] = [Finder::Reference, Finder::Compiled].map(|finder| finder.zeros(graph, f, range));
        let what = format!("case {case}, {text}\nreference:\n{reference}\ncompiled:\n{compiled}");
        // Where one has proved a zero, the other has not refuted it.
        let fits = |a: &Roots, b: &Roots| a.proved.iter().all(|root| covered(b, root.bracket));
        assert!(fits(&reference, &compiled) && fits(&compiled, &reference), "{what}");
        let [mine, theirs] = [&compiled, &reference].map(|found| found.unknown.iter().map(|x| x.width()).sum::<f64>());
        if mine > 4.0 * theirs + 1e-6 {
            wider.push(format!("{text}: {mine:e} is unknown, {theirs:e} for the reference"));
        }
        // A search that ends early leaves brackets as they are.
        for root in compiled.proved.iter().filter(|root| root.alone.is_some() && !compiled.exhausted) {
            roots += 1;
            sharp += usize::from(root.bracket.width() <= 1e-13 * root.bracket.mag().max(1e-3));
            signs += usize::from(check_signs(root, |x| oracle::sign(graph, f, x, &mut cc), &what));
        }
        // No change of sign of a continuous function is passed over.
        let enclose = |x: Interval| {
            let boxes = vec![Decorated::new(x); graph.variables().len()];
            graph::enclose(graph, &[f], &boxes)[0]
        };
        let sign = |x: f64| {
            let value = enclose(Interval::point(x));
            let defined = value.decoration() >= Decoration::Def;
            match value.interval() {
                y if defined && y.lo() > 0.0 => 1,
                y if defined && y.hi() < 0.0 => -1,
                _ => 0,
            }
        };
        let samples: Vec<(f64, i32)> = (0..=800).map(|i| f64::from(i) / 80.0 - 5.0).map(|x| (x, sign(x))).collect();
        for pair in samples.windows(2) {
            let step = interval(pair[0].0, pair[1].0);
            if pair[0].1 * pair[1].1 < 0 && enclose(step).decoration() >= Decoration::Dac {
                assert!(covered(&compiled, step), "lost a zero in {step}: {what}");
                assert!(covered(&reference, step), "lost a zero in {step}: {what}");
            }
        }
    }
    assert!(roots >= cases() / 2 && 10 * sharp >= 9 * roots, "{sharp} of {roots} brackets are sharp");
    assert!(2 * signs >= roots, "{signs} of {roots} brackets have signs to compare");
    assert!(20 * wider.len() <= cases(), "too much is unknown:\n{}", wider.join("\n"));
}

/// A zero that is alone has opposite signs at the ends of its bracket, or is one of them. Whether there was something
/// to compare.
fn check_signs(root: &Root, mut sign: impl FnMut(f64) -> Option<i32>, what: &str) -> bool {
    let Some(_) = root.alone else { return false };
    let ends = [root.bracket.lo(), root.bracket.hi()].map(&mut sign);
    match ends {
        [Some(a), Some(b)] => {
            assert!(a * b <= 0, "{root} has the same sign at both ends: {what}");
            true
        }
        _ => false,
    }
}
