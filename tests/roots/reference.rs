//! Small questions with known answers, asked of every search.

use imp::interval::Interval;
use imp::roots::Roots;

use crate::answers::Finder;

/// Every given zero is in a proved bracket of its own, which is narrow, alone, and nothing is unknown.
fn complete(text: &str, lo: f64, hi: f64, zeros: &[f64]) {
    for finder in Finder::ALL {
        let found = finder.roots(text, lo, hi);
        assert!(found.is_complete() && !found.exhausted, "{finder:?} {text}: {found}");
        assert_eq!(found.proved.len(), zeros.len(), "{finder:?} {text}: {found}");
        for (root, zero) in found.proved.iter().zip(zeros) {
            let near = Interval::new(zero - 1e-15 * zero.abs(), zero + 1e-15 * zero.abs()).unwrap();
            assert!(!root.bracket.disjoint(near), "{finder:?} {text}: {root} is not {zero}");
            assert!(root.bracket.width() <= 1e-14 * zero.abs().max(1e-300), "{finder:?} {text}: {root}");
            assert!(root.alone.is_some_and(|alone| alone.contains_interval(root.bracket)), "{finder:?} {text}: {root}");
        }
    }
}

/// What every search says.
fn all(text: &str, lo: f64, hi: f64) -> impl Iterator<Item = Roots> {
    Finder::ALL.into_iter().map(move |finder| finder.roots(text, lo, hi))
}

#[test]
fn simple_zeros_are_all_proved_and_narrow() {
    use std::f64::consts::PI;
    complete("x^2 - 2", 0.0, 2.0, &[2f64.sqrt()]);
    complete("x^2 = 2", -10.0, 10.0, &[-(2f64.sqrt()), 2f64.sqrt()]);
    complete("sin(x)", 1.0, 20.0, &[PI, 2.0 * PI, 3.0 * PI, 4.0 * PI, 5.0 * PI, 6.0 * PI]);
    complete("cos(x) = x", -100.0, 100.0, &[0.739_085_133_215_160_6]);
    complete("exp(x) - 3", f64::NEG_INFINITY, f64::INFINITY, &[3f64.ln()]);
    complete("x^3 - x", -2.0, 2.0, &[-1.0, 0.0, 1.0]);
    complete("(x - 1)(x - 2)(x - 3)", 0.5, 3.5, &[1.0, 2.0, 3.0]);
    complete("ln(x)", 0.0, 10.0, &[1.0]);
    complete("x^2 + 1", -10.0, 10.0, &[]);
}

#[test]
fn zeros_at_the_ends_count() {
    complete("x^2 - 4", 2.0, 3.0, &[2.0]);
    complete("x - 1", 0.0, 1.0, &[1.0]);
}

#[test]
fn poles_are_never_roots() {
    complete("1/x", -1.0, 2.0, &[]);
    complete("tan(x)", 1.0, 4.0, &[std::f64::consts::PI]);
    complete("1/x - 2", -1.0, 1.0, &[0.5]);
    for beside in all("tan(x) + 1", 1.0, 3.0) {
        assert_eq!(beside.proved.len(), 1, "{beside:?}");
        assert!(beside.proved[0].bracket.contains(0.75 * std::f64::consts::PI), "{beside:?}");
        assert!(beside.unknown.len() == 1 && beside.unknown[0].width() < 1e-10, "{beside:?}");
    }
    for jump in all("floor(x) - 1/2", 0.2, 1.7) {
        assert!(jump.proved.is_empty() && jump.unknown.iter().any(|x| x.contains(1.0)), "{jump:?}");
    }
}

#[test]
fn touching_zeros_are_unknown_but_where_they_are_exact() {
    for touching in all("x^2 - 2 sqrt(2) x + 2", 0.0, 3.0) {
        assert!(touching.proved.is_empty(), "{touching:?}");
        assert!(touching.unknown.iter().any(|x| x.contains(2f64.sqrt())), "{touching:?}");
        assert!(touching.unknown.iter().all(|x| (x.mid() - 2f64.sqrt()).abs() < 1e-5), "{touching:?}");
    }
    for exact in all("(x - 1)^2", 0.0, 3.0) {
        assert!(exact.proved.iter().all(|root| root.bracket == Interval::ONE), "{exact:?}");
        assert_eq!(exact.proved.len(), 1, "{exact:?}");
    }
}

#[test]
fn triple_zeros_are_proved_without_being_alone() {
    for triple in all("(x - 1/3)^3", 0.0, 1.0) {
        assert_eq!(triple.proved.len(), 1, "{triple:?}");
        assert!(triple.proved[0].bracket.contains(1.0 / 3.0) && triple.proved[0].alone.is_none(), "{triple:?}");
    }
}

#[test]
fn endless_zeros_end() {
    for dense in all("sin(1/x)", 0.0, 1.0) {
        assert!(dense.exhausted || !dense.unknown.is_empty());
        assert!(dense.proved.iter().any(|root| root.bracket.contains(std::f64::consts::FRAC_1_PI)));
        assert!(dense.proved.iter().all(|root| root.bracket.lo() > 0.0));
    }
    for zero in all("x - x", -1.0, 1.0) {
        assert!(!zero.unknown.is_empty() && zero.proved.iter().all(|root| root.alone.is_none()), "{zero:?}");
    }
}
