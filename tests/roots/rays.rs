//! Zeros along rays.

use fastrand::Rng;
use imp::codegen::Compiler;
use imp::control::Control;
use imp::interval::Decorated;
use imp::interval::Interval;
use imp::roots::Options;
use imp::roots::RaySolver;
use imp::roots::Search;
use imp::session::expression::Expression;
use imp::session::expression::Reading;
use imp::session::expression::Snippet;
use imp::session::expression::Workspace;

use crate::answers::interval;

fn expression(text: &str, variables: &[&str]) -> Expression {
    Workspace::default().expression(&Snippet::whole("", text), variables, Reading::Zero).unwrap()
}

const BARTH: &str = "4(((1 + sqrt(5))/2)^2 x^2 - y^2)(((1 + sqrt(5))/2)^2 y^2 - z^2)(((1 + sqrt(5))/2)^2 z^2 - x^2) \
                     = (2 + sqrt(5))(x^2 + y^2 + z^2 - 1)^2";

#[test]
fn rays_meet_a_sphere_where_they_do() {
    let ball = expression("x^2 + y^2 + z^2 = r^2", &["x", "y", "z", "r"]);
    let solver = RaySolver::new(&ball.graph, ball.root, &["x", "y", "z"], &[], &Compiler).unwrap();
    assert_eq!(solver.parameters(), ["r"]);
    let (options, control) = (Options::default(), Control::default());
    let ask = |r: f64, origin: [f64; 3], direction: [f64; 3]| {
        solver.roots(&origin, &direction, &[Interval::point(r)], interval(0.0, 10.0), &options, &control)
    };
    let found = ask(1.0, [-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert!(found.is_complete() && found.proved.len() == 2, "{found}");
    assert!(found.proved[0].bracket.contains(2.0) && found.proved[1].bracket.contains(4.0), "{found}");
    assert_eq!(found.first(), Some(&found.proved[0]));
    let inside = ask(2.0, [0.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    assert!(inside.is_complete() && inside.proved.len() == 1 && inside.proved[0].bracket.contains(1.0), "{inside}");
    assert_eq!(ask(1.0, [-3.0, 2.0, 0.0], [1.0, 0.0, 0.0]).to_string(), "no root: proved");
    let touching = ask(1.0, [-3.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
    assert!(touching.first().is_none() && touching.unknown.iter().any(|x| x.contains(3.0)), "{touching}");
    let nowhere = ask(1.0, [f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert!(nowhere.proved.is_empty() && nowhere.unknown == [interval(0.0, 10.0)], "{nowhere}");
    // A family of balls: what is proved holds for each.
    let family = [interval(0.9, 1.1)];
    let found = solver.roots(&[-3.0, 0.0, 0.0], &[1.0, 0.0, 0.0], &family, interval(0.0, 10.0), &options, &control);
    let near = found.first().expect("the first hit").bracket;
    assert!(near.contains(1.9) && near.contains(2.1) && near.width() < 0.3, "{found}");
}

#[test]
fn plane_curves_and_other_names() {
    let curve = expression("u v = 1", &["u", "v"]);
    let solver = RaySolver::new(&curve.graph, curve.root, &["u", "v"], &[], &Compiler).unwrap();
    let found = solver.roots(
        &[0.0, 0.0],
        &[1.0, 4.0],
        &[],
        interval(f64::NEG_INFINITY, f64::INFINITY),
        &Options::default(),
        &Control::default(),
    );
    let brackets: Vec<Interval> = found.proved.iter().map(|root| root.bracket).collect();
    assert!(found.is_complete() && brackets == [-0.5, 0.5].map(Interval::point), "{found}");
}

#[test]
fn random_rays_agree_with_the_reference() {
    let barth = expression(BARTH, &["x", "y", "z"]);
    let tube = expression("sin(3x) cos(y) + z^2 = 1/2", &["x", "y", "z"]);
    let mut rng = Rng::with_seed(31);
    let (options, control) = (Options::default(), Control::default());
    let range = interval(0.0, 6.0);
    let mut roots = 0;
    for surface in [barth, tube] {
        let axes = ["x", "y", "z"];
        let solver = RaySolver::new(&surface.graph, surface.root, &axes, &[], &Compiler).unwrap();
        for case in 0..crate::random::cases() / 2 {
            let origin = [0; 3].map(|_| 6.0 * (rng.f64() - 0.5));
            let target = [0; 3].map(|_| 2.0 * (rng.f64() - 0.5));
            let direction: [f64; 3] = std::array::from_fn(|i| 0.5 * (target[i] - origin[i]));
            let found = solver.roots(&origin, &direction, &[], range, &options, &control);
            let boxes = vec![Decorated::ENTIRE; surface.graph.variables().len()];
            let search = Search::along_ray(&surface.graph, surface.root, &boxes, &axes, &origin, &direction);
            let reference = search.run(range, &options, &control);
            assert_eq!(found.proved.len(), reference.proved.len(), "case {case}:\n{found}\n\n{reference}");
            assert_eq!(found.is_complete(), reference.is_complete(), "case {case}:\n{found}\n\n{reference}");
            for (a, b) in found.proved.iter().zip(&reference.proved) {
                assert!(!a.bracket.disjoint(b.bracket), "case {case}: {a} is not {b}");
                assert!(a.bracket.width() <= 4.0 * b.bracket.width() + 1e-13, "case {case}: {a} is wider than {b}");
            }
            roots += found.proved.len();
        }
    }
    assert!(roots > 30, "{roots} roots");
}
