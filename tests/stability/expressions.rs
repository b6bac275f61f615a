//! Expressions whose terms cancel: Rump, Wilkinson, Muller, and three that every textbook has.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;

use crate::case::Case;
use crate::formula::Formula;
use crate::formula::point;
use crate::formula::rational;
use crate::plain::Plain;

const RUMP: &str = "333.75 b^6 + a^2 (11 a^2 b^2 - b^6 - 121 b^4 - 2) + 5.5 b^8 + a / (2 b)";

/// Rump's value, exactly.
const RUMP_VALUE: &str = "-54767/66192";

fn rump_in<T: Plain>() -> f64 {
    let (a, b) = (T::int(77617), T::int(33096));
    let inner = T::int(11) * a.power(2) * b.power(2) - b.power(6) - T::int(121) * b.power(4) - T::int(2);
    let sum = T::ratio(1335, 4) * b.power(6) + a.power(2) * inner + T::ratio(11, 2) * b.power(8);
    (sum + a / (T::int(2) * b)).to_f64()
}

pub fn rump() -> Case {
    let (single, double) = (rump_in::<f32>(), rump_in::<f64>());
    let wild = |y: f64| y.is_nan() || y.abs() >= 1e20;
    assert!(wild(single) && wild(double), "{single}, {double}");
    let formula = Formula::new(&RUMP.replace('a', "x").replace('b', "y"));
    let at = [point(77617.0), point(33096.0)];
    let said = formula.reference(&at).interval();
    assert!(said.contains_interval(rational(RUMP_VALUE)));
    assert!(said.width() > 1e20 && said.is_bounded(), "the width must say that nothing is known: {said}");
    formula.answers().all(&at, |said| said.contains_interval(rational(RUMP_VALUE)));
    Case {
        name: "Rump's expression",
        why: "Terms of 8e36 cancel to -0.827: the first 37 digits of them say nothing of the result.",
        single: format!("{single:.3e}"),
        double: format!("{double:.3e}"),
        imp: format!(
            "[{:.1e}, {:.1e}], which holds the value and says that nothing is known of it",
            said.lo(),
            said.hi()
        ),
        cost: String::new(),
    }
}

pub fn rump_exactly() -> Case {
    let folded = Formula::with("let a = 77617\nlet b = 33096", RUMP).folded();
    let value: BigRational = RUMP_VALUE.parse().expect("a rational number");
    assert_eq!(folded.number(), Some(&value));
    let said = folded.reference(&[]).interval();
    assert_eq!(said.lo().next_up(), said.hi(), "two neighbours");
    Case {
        name: "Rump's expression of constants",
        why: "Imp keeps constants as rational numbers and folds them exactly; only the result is rounded.",
        single: format!("{:.3e}", rump_in::<f32>()),
        double: format!("{:.3e}", rump_in::<f64>()),
        imp: format!("{said}, from {value} exactly"),
        cost: String::new(),
    }
}

/// The coefficients of (x - 1) ... (x - 20), from x^20 down.
fn wilkinson() -> Vec<BigInt> {
    let mut coefficients = vec![BigInt::from(1)];
    for root in 1..=20 {
        let mut next = coefficients.clone();
        next.push(BigInt::from(0));
        for (next, c) in next[1..].iter_mut().zip(&coefficients) {
            *next -= c * root;
        }
        coefficients = next;
    }
    coefficients
}

fn expanded() -> String {
    let terms = wilkinson().into_iter().enumerate().map(|(i, c)| match i {
        20 => format!("({c})"),
        _ => format!("({c}) * x^{}", 20 - i),
    });
    terms.collect::<Vec<_>>().join(" + ")
}

fn factored() -> String {
    (1..=20).map(|root| format!("(x - {root})")).collect()
}

/// Horner's scheme, with the second coefficient moved.
fn horner<T: Plain>(x: T, moved: T) -> T {
    let number = |c: &BigInt| T::of(c.to_f64().expect("a finite number"));
    let coefficients: Vec<T> = wilkinson().iter().map(number).collect();
    let start = coefficients[0] * x + (coefficients[1] + moved);
    coefficients[2..].iter().fold(start, |sum, &c| sum * x + c)
}

/// How often the sign changes over a grid of [1/2, 43/2] with 2^10 points in each unit.
fn changes<T: Plain>(moved: f64) -> usize {
    let zero = T::of(0.0);
    let below = |i: i32| horner(T::of(0.5 + f64::from(i) / 1024.0), T::of(moved)) < zero;
    let signs: Vec<bool> = (0..=21 * 1024).map(below).collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

pub fn wilkinson_at_its_roots() -> Case {
    let (single, double) = (horner(20f32, 0.0), horner(20f64, 0.0));
    assert!(single.abs() > 1e15 && double.abs() > 1e5, "{single}, {double}");
    let (expanded, factored) = (Formula::new(&expanded()), Formula::new(&factored()));
    let (answers, factors) = (expanded.answers(), factored.answers());
    for root in 1..=20 {
        let at = [point(root.into())];
        assert_eq!(factored.reference(&at).interval(), point(0.0));
        answers.all(&at, |said| said.contains(0.0));
        factors.all(&at, |said| said.contains(0.0));
    }
    let said = expanded.reference(&[point(20.0)]).interval();
    Case {
        name: "Wilkinson's polynomial at 20",
        why: "Coefficients of 1e19 cancel at the roots; what is left is the rounding of the terms.",
        single: format!("{single:.2e}"),
        double: format!("{double:.2e}"),
        imp: format!("expanded [{:.1e}, {:.1e}], factored [0, 0]", said.lo(), said.hi()),
        cost: String::new(),
    }
}

/// Cells of [0.53, 21.53] in which a formula has exactly one proved zero, and cells that stay open.
fn proved_roots(formula: &Formula, slope: &Formula) -> (usize, usize, usize) {
    let sign = |x: f64| {
        let value = formula.reference(&[point(x)]).interval();
        i32::from(value.lo() > 0.0) - i32::from(value.hi() < 0.0)
    };
    // No cell ends at a root, as the signs there prove.
    let end = |i: i32| 0.53125 + f64::from(i) / 2.0;
    let mut cells: Vec<(f64, f64)> = (0..42).map(|i| (end(i), end(i + 1))).collect();
    let (mut roots, mut open, mut tried) = (0, 0, 0);
    while let Some((a, b)) = cells.pop() {
        tried += 1;
        let cell = [rational_cell(a, b)];
        let value = formula.reference(&cell).interval();
        if !value.contains(0.0) {
            continue;
        }
        let growth = slope.reference(&cell).interval();
        let ends = [sign(a), sign(b)];
        if !growth.contains(0.0) && ends[0] * ends[1] != 0 {
            roots += usize::from(ends[0] != ends[1]);
            continue;
        }
        if b - a < 2f64.powi(-40) {
            open += 1;
            continue;
        }
        // Beside the middle, so that no cut is a root.
        let cut = a + (b - a) * 0.484375;
        cells.extend([(a, cut), (cut, b)]);
    }
    (roots, open, tried)
}

fn rational_cell(a: f64, b: f64) -> imp::interval::Interval {
    imp::interval::Interval::new(a, b).expect("the ends are in order")
}

pub fn wilkinson_roots() -> Case {
    let (single, double) = (changes::<f32>(0.0), changes::<f64>(0.0));
    assert!(single > 40 && double > 20, "{single}, {double}");
    let (formula, slope) = (Formula::new(&factored()), Formula::new(&format!("deriv({}, x)", factored())));
    let (roots, open, tried) = proved_roots(&formula, &slope);
    assert_eq!((roots, open), (20, 0));
    // From the expanded form only those signs are proved that its rounding errors leave.
    let dense = Formula::new(&expanded());
    let signs: Vec<i32> = (0..=20)
        .map(|i| {
            let value = dense.reference(&[point(f64::from(i) + 0.5)]).interval();
            let sign = i32::from(value.lo() > 0.0) - i32::from(value.hi() < 0.0);
            assert!(sign == 0 || sign == if i % 2 == 0 { 1 } else { -1 }, "a wrong sign at {i} + 1/2");
            sign
        })
        .collect();
    let proved = signs.windows(2).filter(|pair| pair[0] * pair[1] == -1).count();
    Case {
        name: "Wilkinson's 20 roots",
        why: "Around each root the computed values are noise, so that the sign changes many times where it changes once.",
        single: format!("{single} sign changes"),
        double: format!("{double} sign changes"),
        imp: format!("20 proved, none open; {proved} sign changes proved from the expanded form"),
        cost: format!("{tried} cells"),
    }
}

pub fn wilkinson_perturbed() -> Case {
    let moved = -(2f64.powi(-23));
    let (single, double) = (changes::<f32>(moved), changes::<f64>(moved));
    assert_eq!(-210f32 + moved as f32, -210.0, "single precision cannot hold the coefficient");
    assert!(single > 40 && double >= 10, "{single}, {double}");
    let text = format!("{} - x^19 / 2^23", factored());
    let (formula, slope) = (Formula::new(&text), Formula::new(&format!("deriv({text}, x)")));
    let (roots, open, tried) = proved_roots(&formula, &slope);
    // Wilkinson, Rounding Errors in Algebraic Processes (1963), chapter 2: ten roots stay real.
    assert_eq!((roots, open), (10, 0));
    Case {
        name: "Wilkinson's, one coefficient moved",
        why: "2^-23 less in the second coefficient, -210, makes ten of the twenty real roots complex; f32 rounds the change away.",
        single: format!("{single} sign changes"),
        double: format!("{double} sign changes"),
        imp: "10 proved, none open".to_owned(),
        cost: format!("{tried} cells"),
    }
}

fn muller_in<T: Plain>(steps: u32) -> f64 {
    let (mut before, mut x) = (T::ratio(11, 2), T::ratio(61, 11));
    for _ in 1..steps {
        (before, x) = (x, T::int(111) - (T::int(1130) - T::int(3000) / before) / x);
    }
    x.to_f64()
}

pub fn muller() -> Case {
    let (single, double) = (muller_in::<f32>(30), muller_in::<f64>(30));
    assert!((single - 100.0).abs() < 1e-3 && (double - 100.0).abs() < 1e-3, "{single}, {double}");
    let steps = (2..=30).map(|n| format!("let a{n} = 111 - (1130 - 3000 / a{}) / a{}", n - 2, n - 1));
    let definitions =
        ["let a0 = 11/2", "let a1 = 61/11"].map(str::to_owned).into_iter().chain(steps).collect::<Vec<_>>().join("\n");
    let mut blown = None;
    for n in 2..=30u32 {
        // The closed form of the sequence with these starts: (6^(n+1) + 5^(n+1)) / (6^n + 5^n).
        let [six, five] = [6, 5].map(BigInt::from);
        let truth = BigRational::new(six.pow(n + 1) + five.pow(n + 1), six.pow(n) + five.pow(n));
        let formula = Formula::with(&definitions, &format!("a{n}"));
        let said = formula.reference(&[]).interval();
        let tight = imp::interval::Interval::from_rational(&truth);
        assert!(said.contains_interval(tight), "a{n}: {said} misses {truth}");
        if said.width() > 1.0 {
            blown.get_or_insert((n, said));
        }
        let folded = formula.folded();
        assert_eq!(folded.number(), Some(&truth));
        assert_eq!(folded.reference(&[]).interval(), tight);
    }
    let (n, _) = blown.expect("the widths grow");
    let limit = Formula::with(&definitions, "a30").folded().reference(&[]).interval();
    Case {
        name: "Muller's recurrence after 30 steps",
        why: "The limit 6 repels: any rounding error grows by 100/6 a step, until the sequence is at the fixed point that attracts, 100.",
        single: format!("{single:.3}"),
        double: format!("{double:.3}"),
        imp: format!("intervals are wider than 1 from step {n} on and hold the truth; exactly folded {limit}"),
        cost: String::new(),
    }
}

/// Two ways to write one number: what each of them encloses at a point.
fn two_forms(naive: &str, stable: &str, at: f64) -> [imp::interval::Interval; 2] {
    let both = [naive, stable].map(Formula::new);
    let enclosed = [&both[0], &both[1]].map(|formula| formula.reference(&[point(at)]).interval());
    assert!(enclosed[0].contains_interval(enclosed[1]), "{naive} at {at}: {enclosed:?}");
    for formula in &both {
        formula.answers().all(&[point(at)], |said| !said.disjoint(enclosed[1]));
    }
    enclosed
}

pub fn cosine_near_zero() -> Case {
    let (single, double) = ((1.0 - 1e-4f32.cos()) / (1e-4f32 * 1e-4), (1.0 - 1e-8f64.cos()) / (1e-8 * 1e-8));
    assert_eq!((single, double), (0.0, 0.0));
    let [naive, stable] = two_forms("(1 - cos(x)) / x^2", "2 (sin(x/2) / x)^2", 1e-8);
    // 1/2 - x^2/24 + ...
    assert!(stable.contains(0.5 - 1e-16 / 24.0) && stable.width() < 1e-14, "{stable}");
    assert!(naive.lo() <= 0.5 && naive.hi() >= 0.5 && naive.width() > 0.5, "{naive}");
    Case {
        name: "(1 - cos x) / x^2 near 0",
        why: "cos x rounds to 1 and the difference to 0, where the quotient is 1/2 (x = 1e-4 for f32, 1e-8 for f64 and Imp).",
        single: format!("{single}"),
        double: format!("{double}"),
        imp: format!("[{:.3}, {:.3}]; as 2 (sin(x/2) / x)^2 {stable}", naive.lo(), naive.hi()),
        cost: String::new(),
    }
}

pub fn difference_of_roots() -> Case {
    let single = (1e8f32 + 1.0).sqrt() - 1e8f32.sqrt();
    let double = (1e15f64 + 1.0).sqrt() - 1e15f64.sqrt();
    let [naive, stable] = two_forms("sqrt(x + 1) - sqrt(x)", "1 / (sqrt(x + 1) + sqrt(x))", 1e15);
    assert_eq!(single, 0.0);
    assert!((double / stable.mid() - 1.0).abs() > 0.1 && stable.width() < 1e-22, "{double}, {stable}");
    Case {
        name: "sqrt(x + 1) - sqrt(x), x = 1e15",
        why: "Both roots agree in all digits but the last (x = 1e8 for f32).",
        single: format!("{single}"),
        double: format!("{double:.3e}"),
        imp: format!(
            "[{:.2e}, {:.2e}]; as 1 / (sqrt(x + 1) + sqrt(x)) {:.6e}, all digits right",
            naive.lo(),
            naive.hi(),
            stable.mid()
        ),
        cost: String::new(),
    }
}

/// The smaller root of x^2 - 2 b x + 1 by the formula of the schools.
macro_rules! smaller_root {
    ($b:expr) => {
        $b - ($b * $b - 1.0).sqrt()
    };
}

pub fn quadratic_formula() -> Case {
    let (single, double) = (smaller_root!(1e8f32), smaller_root!(1e8f64));
    let [naive, stable] = two_forms("x - sqrt(x^2 - 1)", "1 / (x + sqrt(x^2 - 1))", 1e8);
    assert_eq!((single, double), (0.0, 0.0));
    assert!((stable.mid() - 5e-9).abs() < 1e-15 && stable.width() < 1e-23, "{stable}");
    Case {
        name: "the smaller root of t^2 - 2e8 t + 1",
        why: "b - sqrt(b^2 - 1) subtracts equal numbers; the root is 5e-9.",
        single: format!("{single}"),
        double: format!("{double}"),
        imp: format!(
            "[{:.2e}, {:.2e}]; as 1 / (b + sqrt(b^2 - 1)) {:.6e}, all digits right",
            naive.lo(),
            naive.hi(),
            stable.mid()
        ),
        cost: String::new(),
    }
}
