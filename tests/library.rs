//! The library as other programs use it.

use imp::Columns;
use imp::Enclosure;
use imp::Error;
use imp::Interval;
use imp::IntervalKernel;
use imp::Options;
use imp::PointKernel;
use imp::Program;
use imp::Rounding;

const TEXT: &str = "
param a = 1 in [0, 2]
let r = 3/4
# Two terms squared.
fn himmelblau(x, y) = (x^2 + y - 11)^2 + (x + a y^2 - 7)^2
fn arm(p, q) = [cos(p) + cos(p + q), sin(p) + sin(p + q)]
let height = x^2 - y
fn shifted(u) = u + x
fn grown(s) = s and x < r
fn clash(x) = x + height
surface ball: x^2 + y^2 + z^2 = r^2
x^2 <= z
fn wrong(u) = u + [1, 2]
";

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

#[test]
fn functions_are_found_in_order() {
    let program = Program::parse(TEXT).unwrap();
    let found: Vec<String> = program.functions().iter().map(|function| format!("{function:?}")).collect();
    let expected =
        ["himmelblau(x, y; a)", "arm(p, q)", "height(x, y)", "shifted(u, x)", "ball(x, y, z)", "shape2(x, z)"];
    assert_eq!(found, expected);
    let refused: Vec<&str> = program.refused().iter().map(|refused| refused.name.as_str()).collect();
    assert_eq!(refused, ["grown", "clash", "wrong"]);
    let himmelblau = program.function("himmelblau").unwrap();
    assert_eq!(himmelblau.doc(), ["Two terms squared."]);
    assert_eq!(himmelblau.outputs_of(&Options::with_gradient()), ["himmelblau", "dhimmelblau/dx", "dhimmelblau/dy"]);
    assert_eq!(program.function("arm").unwrap().outputs(), ["arm[1]", "arm[2]"]);
}

#[test]
fn mistakes_are_typed_and_have_places() {
    let program = Program::parse(TEXT).unwrap();
    let Err(Error::Source(report)) = program.function("wrong") else { panic!("a list and a number") };
    let span = report.diagnostics()[0].labels[0].span;
    assert_eq!(report.place(span).1, 13);
    assert!(matches!(program.function("himmel"), Err(Error::UnknownFunction { .. })));
    let Err(Error::Source(report)) = Program::named("bad.imp", "fn f(x) = x +\nfn g(x) = q") else { panic!() };
    assert_eq!(report.diagnostics().len(), 2);
    assert!(report.render(false).contains("bad.imp:2:11"));
    assert!(format!("{:?}", Error::Source(report)).contains("error[E0"));
    let f = program.function("himmelblau").unwrap();
    let mut kernel = f.intervals(&Options::default()).unwrap();
    assert!(matches!(kernel.enclose(&[Interval::ZERO]), Err(Error::Length { expected: 2, found: 1, .. })));
    assert!(matches!(kernel.set("b", Interval::ZERO), Err(Error::UnknownParameter { .. })));
    assert!(matches!(kernel.set("a", interval(1.0, 3.0)), Err(Error::OutOfRange { .. })));
    assert!(matches!(kernel.set("a", Interval::EMPTY), Err(Error::OutOfRange { .. })));
    let options = Options { domain: vec![("z".to_owned(), Interval::ZERO)], ..Options::default() };
    assert!(matches!(f.intervals(&options), Err(Error::UnknownVariable { .. })));
    let mut short = [Enclosure::UNKNOWN; 3];
    let boxes = [Interval::ZERO; 8];
    assert!(matches!(kernel.enclose_into(&boxes, &mut short), Err(Error::Length { expected: 4, found: 3, .. })));
}

#[test]
fn kernels_enclose_and_compute() {
    let program = Program::parse(TEXT).unwrap();
    let f = program.function("himmelblau").unwrap();
    let bounds = f.intervals(&Options::default()).unwrap();
    let at = bounds.enclose(&[Interval::point(3.0), Interval::point(2.0)]).unwrap();
    assert!(at.interval.contains(0.0) && at.interval.width() < 1e-12);
    let away = bounds.enclose(&[interval(-1.0, 1.0), interval(-1.0, 1.0)]).unwrap();
    assert!(away.is_positive() && away.is_continuous() && away.excludes_zero());
    // Another value of the parameter for this kernel alone.
    let half = bounds.clone().with("a", Interval::point(0.5)).unwrap();
    assert!(!half.enclose(&[Interval::point(3.0), Interval::point(2.0)]).unwrap().interval.contains(0.0));
    assert!(bounds.enclose(&[Interval::point(3.0), Interval::point(2.0)]).unwrap().interval.contains(0.0));
    let values = f.points(&Options::with_gradient()).unwrap();
    let mut all = [0.0; 6];
    values.values_into(&[3.0, 2.0, 0.0, 0.0], &mut all).unwrap();
    assert_eq!(all, [0.0, 0.0, 0.0, 170.0, -14.0, -22.0]);
    assert_eq!(values.with("a", 0.0).unwrap().value(&[0.0, 1.0]).unwrap(), 149.0);
    let empty = bounds.enclose(&[Interval::EMPTY, Interval::ZERO]).unwrap();
    assert!(empty.is_empty() && empty.interval.is_empty());
    let single: IntervalKernel<f32> = f.interval_kernel(&Options::default()).unwrap();
    let wide = single.enclose(&[interval(0.1, 0.2), interval(0.1, 0.2)]).unwrap().interval;
    let narrow = bounds.enclose(&[interval(0.1, 0.2), interval(0.1, 0.2)]).unwrap().interval;
    assert!(wide.contains_interval(narrow) && wide.width() < narrow.width() * 1.001);
    let nearest = f.intervals(&Options { rounding: Rounding::Nearest, ..Options::default() }).unwrap();
    assert!(!nearest.enclose(&[interval(-1.0, 1.0), interval(-1.0, 1.0)]).unwrap().is_positive());
}

#[test]
fn rows_columns_and_single_boxes_agree() {
    let program = Program::parse(TEXT).unwrap();
    for options in [
        Options::default(),
        Options::with_gradient(),
        Options { affine: true, ..Options::with_gradient() },
        Options { domain: vec![("p".to_owned(), interval(0.0, 2.0))], ..Options::default() },
    ] {
        let kernel = program.function("arm").unwrap().intervals(&options).unwrap();
        let width = kernel.outputs().len();
        // More than a batch, and no whole number of packets.
        let count = 4099;
        let mut random = fastrand::Rng::with_seed(1);
        let numbers: Vec<[f64; 2]> = (0..2 * count)
            .map(|_| {
                let (a, b) = (random.f64() * 6.0 - 3.0, random.f64() * 6.0 - 3.0);
                [a.min(b), a.max(b)]
            })
            .collect();
        let boxes: Vec<Interval> = numbers.iter().map(|[lo, hi]| interval(*lo, *hi)).collect();
        let mut enclosures = vec![Enclosure::UNKNOWN; count * width];
        kernel.enclose_into(&boxes, &mut enclosures).unwrap();
        let mut parallel = vec![Enclosure::UNKNOWN; count * width];
        kernel.par_enclose_into(&boxes, &mut parallel).unwrap();
        assert_eq!(enclosures, parallel);
        for row in [0, 1, 7, 8, 2047, 2048, count - 1] {
            assert_eq!(kernel.enclose(&boxes[2 * row..2 * row + 2]).unwrap(), enclosures[row * width]);
        }
        let column = |variable: usize, end: usize| -> Vec<f64> {
            (0..count).map(|row| numbers[2 * row + variable][end]).collect()
        };
        let columns: Vec<[Vec<f64>; 2]> = (0..2).map(|v| [column(v, 0), column(v, 1)]).collect();
        let columns: Vec<[&[f64]; 2]> = columns.iter().map(|[lo, hi]| [&lo[..], &hi[..]]).collect();
        let mut out = Columns::default();
        kernel.enclose_columns(&columns, &mut out).unwrap();
        for (i, enclosure) in enclosures.iter().enumerate() {
            let (row, output) = (i / width, i % width);
            assert_eq!(out.lo[output][row], enclosure.lo());
            assert_eq!(out.hi[output][row], enclosure.hi());
            assert_eq!(out.verdict[output][row], enclosure.verdict);
        }
    }
}

#[test]
fn columns_with_strange_ends_are_the_whole_line() {
    let program = Program::parse("fn f(u) = exp(u)").unwrap();
    let kernel = program.function("f").unwrap().intervals(&Options::default()).unwrap();
    let (lo, hi) = ([f64::NAN, 2.0, 0.0], [1.0, 1.0, f64::NAN]);
    let mut out = Columns::default();
    kernel.enclose_columns(&[[&lo, &hi]], &mut out).unwrap();
    assert_eq!(out.lo[0], [0.0; 3]);
    assert_eq!(out.hi[0], [f64::INFINITY; 3]);
    let short = [1.0];
    assert!(matches!(kernel.enclose_columns(&[[&lo, &short]], &mut out), Err(Error::Length { .. })));
}

#[test]
fn expressions_use_the_definitions() {
    let program = Program::parse(TEXT).unwrap();
    let f = program.expression("himmelblau(u, 2u) - r", &["u"]).unwrap();
    assert_eq!(f.variables(), ["u"]);
    let value = f.points(&Options::default()).unwrap().value(&[1.0]).unwrap();
    assert_eq!(value, 66.0 - 2.0 + 4.0 - 0.75 - 0.0 * value);
    for wrong in ["himmelblau(u)", "u +", "v", "", "[u", "arm"] {
        assert!(matches!(program.expression(wrong, &["u"]), Err(Error::Source(_))), "{wrong}");
    }
    assert!(matches!(program.expression("x + y", &["y"]), Err(Error::Source(_))));
    let constant = program.expression("r + 1", &[]).unwrap().intervals(&Options::default()).unwrap();
    assert_eq!(constant.enclose(&[]).unwrap().interval, Interval::point(1.75));
    let mut three = [Enclosure::UNKNOWN; 3];
    constant.enclose_into(&[], &mut three).unwrap();
    assert!(three.iter().all(|enclosure| enclosure.interval == Interval::point(1.75)));
}

#[test]
fn kernels_go_anywhere() {
    fn anywhere<T: Clone + Send + Sync + 'static>() {}
    anywhere::<IntervalKernel<f64>>();
    anywhere::<PointKernel<f32>>();
    anywhere::<Program>();
    anywhere::<imp::Function>();
    anywhere::<Error>();
}

#[test]
fn zeros_are_found() {
    let program = Program::parse("param a = 1 in [1/2, 2]\nfn f(u, v) = u^2 - a v\nsurface s: x^2 + y^2 = z").unwrap();
    let f = program.function("f").unwrap();
    let mut finder = f.root_finder("u").unwrap();
    finder.set("v", Interval::point(2.0)).unwrap();
    let brackets = |found: imp::roots::Roots| -> Vec<Interval> {
        assert!(found.is_complete());
        found.proved.iter().map(|root| root.bracket).collect()
    };
    let found = brackets(finder.roots(Interval::ENTIRE));
    assert!(found.len() == 2 && found[1].contains(f64::sqrt(2.0)) && found[1].width() < 1e-15);
    finder.set("a", Interval::point(0.5)).unwrap();
    assert_eq!(brackets(finder.roots(Interval::ENTIRE)), [Interval::point(-1.0), Interval::point(1.0)]);
    assert!(matches!(finder.set("a", Interval::point(3.0)), Err(Error::OutOfRange { .. })));
    assert!(finder.set("u", Interval::ZERO).is_err() && finder.set("w", Interval::ZERO).is_err());
    assert!(matches!(f.root_finder("w"), Err(Error::UnknownVariable { .. })));
    assert!(matches!(f.roots(Interval::ENTIRE), Err(Error::Length { .. })));
    let rays = program.function("s").unwrap().ray_finder().unwrap();
    let found = rays.roots(&[0.0, 0.0, 4.0], &[1.0, 0.0, 0.0], interval(0.0, 10.0)).unwrap();
    assert_eq!(brackets(found), [Interval::point(2.0)]);
    assert!(matches!(rays.roots(&[0.0; 2], &[1.0; 3], Interval::ENTIRE), Err(Error::Length { .. })));
}

#[test]
fn results_can_be_stored() {
    let program = Program::parse("fn f(u) = 1/u").unwrap();
    let kernel = program.function("f").unwrap().intervals(&Options::default()).unwrap();
    let enclosure = kernel.enclose(&[interval(2.0, 4.0)]).unwrap();
    let json = serde_json::to_string(&enclosure).unwrap();
    assert_eq!(json, r#"{"interval":{"lo":"0.25","hi":"0.5"},"verdict":9}"#);
    assert_eq!(serde_json::from_str::<Enclosure>(&json).unwrap(), enclosure);
    assert_eq!(enclosure.to_string(), "[0.25, 0.5], positive, continuous");
}

#[test]
fn no_name_of_a_formula_is_one_of_ours() {
    let names = ["nothing", "unused", "ray_t", "ray_ox", "ray_m", "roots_centre", "u_of_fn"];
    for name in names {
        let text = format!("param {name} = 4 in [0, 10]\nfn f(x) = x - {name}\nsurface s: x^2 + y^2 + z^2 = {name}");
        let program = Program::parse(&text).unwrap();
        let constant = program.expression(&format!("{name} + 1"), &[]).unwrap();
        assert_eq!(
            constant.intervals(&Options::default()).unwrap().enclose(&[]).unwrap().interval,
            Interval::point(5.0)
        );
        let found = program.function("f").unwrap().roots(interval(0.0, 10.0)).unwrap();
        assert!(found.is_complete() && found.proved.len() == 1 && found.proved[0].bracket.contains(4.0), "{found}");
        let rays = program.function("s").unwrap().ray_finder().unwrap();
        let found = rays.roots(&[0.0, 0.0, 5.0], &[0.0, 0.0, -1.0], interval(0.0, 10.0)).unwrap();
        let hits: Vec<f64> = found.proved.iter().map(|root| root.bracket.mid()).collect();
        assert_eq!(hits, [3.0, 7.0], "{name}");
    }
}

#[test]
fn arguments_have_names_of_their_own() {
    assert!(matches!(Program::parse("fn f(x, x) = x"), Err(Error::Source(_))));
    assert!(matches!(imp::Function::parse("x", &["x", "x"]), Err(Error::Source(_))));
    // A parameter and a variable of one name can be told apart by kernels, which set parameters alone, not by finders.
    let program = Program::parse("param a = 2\nfn g(x) = a x\nfn f(a, b) = g(a) - b").unwrap();
    let f = program.function("f").unwrap();
    let kernel = f.intervals(&Options::default()).unwrap().with("a", Interval::point(3.0)).unwrap();
    let at = kernel.enclose(&[Interval::point(5.0), Interval::point(1.0)]).unwrap();
    assert_eq!(at.interval, Interval::point(14.0));
    assert!(f.root_finder("b").is_err());
}

#[test]
fn defaults_lie_in_their_ranges() {
    let program = Program::parse("param a = 2 sin(pi/6) in [1, 2]\nfn f(x) = a x").unwrap();
    let f = program.function("f").unwrap();
    let value = f.parameters()[0].value;
    assert!(value.contains(1.0) && value.lo() == 1.0);
    assert!(f.intervals(&Options::default()).unwrap().with("a", value).is_ok());
}

#[test]
fn a_domain_that_is_empty_has_no_values() {
    let f = imp::Function::parse("x + 1", &["x"]).unwrap();
    let options = Options::default().on("x", interval(0.0, 1.0)).on("x", interval(2.0, 3.0));
    let found = f.intervals(&options).unwrap().enclose(&[interval(0.0, 3.0)]).unwrap();
    assert!(found.is_empty() && found.interval.is_empty(), "{found}");
}
