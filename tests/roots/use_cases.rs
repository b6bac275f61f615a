//! What programs rely on: parameters, promises, threads, budgets, cancellation, serde.

use std::sync::atomic::AtomicBool;

use imp::codegen::Compiler;
use imp::control::Control;
use imp::interval::Interval;
use imp::roots::Options;
use imp::roots::RaySolver;
use imp::roots::Roots;
use imp::roots::Solver;
use imp::session::expression::Reading;
use imp::session::expression::Snippet;
use imp::session::expression::Workspace;

use crate::answers::expression;
use crate::answers::interval;

/// M = E - e sin(E), solved for E.
fn kepler(bounds: &[(&str, Interval)]) -> Solver {
    let workspace = Workspace::default();
    let text = Snippet::whole("", "E - e sin(E) = M");
    let expression = workspace.expression(&text, &["E", "e", "M"], Reading::Zero).unwrap();
    Solver::new(&expression.graph, expression.root, "E", bounds, &Compiler).unwrap()
}

/// Parameters by name.
fn ordered(solver: &Solver, e: Interval, m: Interval) -> Vec<Interval> {
    solver.parameters().iter().map(|name| if name == "e" { e } else { m }).collect()
}

#[test]
fn a_sweep_of_parameters_recompiles_nothing_and_misses_nothing() {
    let range = interval(0.0, 7.0);
    let bounds = [("E", range), ("e", Interval::UNIT), ("M", range)];
    let [free, promised] = [kepler(&[]), kepler(&bounds)];
    for i in 0..40 {
        let (e, m) = (f64::from(i) / 41.0, f64::from(i) * 0.15);
        for solver in [&free, &promised] {
            let values = ordered(solver, Interval::point(e), Interval::point(m));
            let found = solver.roots(&values, range, &Options::default(), &Control::default());
            assert!(found.is_complete() && found.proved.len() == 1, "e = {e}, M = {m}: {found}");
            let x = found.proved[0].bracket;
            assert!(x.width() <= 1e-15 * x.mag().max(1.0), "e = {e}, M = {m}: {found}");
            assert!((x.mid() - e * x.mid().sin() - m).abs() < 1e-14, "e = {e}, M = {m}: {found}");
        }
    }
    // Outside of what was promised the answer is as right.
    let values = ordered(&promised, Interval::point(-0.5), Interval::point(-20.0));
    let found = promised.roots(&values, interval(-30.0, 0.0), &Options::default(), &Control::default());
    assert!(found.is_complete() && found.proved.len() == 1, "{found}");
}

#[test]
fn a_family_has_a_zero_for_each_of_its_members() {
    let solver = kepler(&[]);
    let (e, m) = (interval(0.4, 0.5), interval(1.0, 1.1));
    let found = solver.roots(&ordered(&solver, e, m), interval(0.0, 7.0), &Options::default(), &Control::default());
    assert!(found.is_complete() && found.proved.len() == 1, "{found}");
    for (e, m) in [(0.4, 1.0), (0.4, 1.1), (0.5, 1.0), (0.5, 1.1), (0.45, 1.05)] {
        let values = ordered(&solver, Interval::point(e), Interval::point(m));
        let one = solver.roots(&values, interval(0.0, 7.0), &Options::default(), &Control::default());
        assert!(found.proved[0].bracket.contains_interval(one.proved[0].bracket), "{found} and {one}");
    }
}

#[test]
fn budgets_and_cancellation_leave_what_is_unknown() {
    let sine = expression("sin(x^2)");
    let solver = Solver::new(&sine.graph, sine.root, "x", &[], &Compiler).unwrap();
    let range = interval(0.0, 40.0);
    let all = solver.roots(&[], range, &Options::default(), &Control::default());
    assert!(!all.exhausted && all.proved.len() > 500);
    let cancelled = AtomicBool::new(true);
    let stopped = solver.roots(&[], range, &Options::default(), &Control::new(None, Some(&cancelled)));
    assert!(stopped.exhausted && stopped.unknown == [range], "{stopped}");
    for budget in [0, 1000, 10_000, 30_000] {
        let some = solver.roots(&[], range, &Options { budget, ..Options::default() }, &Control::default());
        assert!(some.exhausted && some.proved.len() < all.proved.len(), "{budget}");
        for root in &all.proved {
            let proved = some.proved.iter().any(|other| !other.bracket.disjoint(root.bracket));
            let unknown = some.unknown.iter().any(|x| !x.disjoint(root.bracket));
            assert!(proved || unknown, "{budget}: {root} is lost");
        }
    }
}

#[test]
fn nothing_is_found_in_nothing() {
    let line = expression("x - 1");
    let solver = Solver::new(&line.graph, line.root, "x", &[], &Compiler).unwrap();
    let ask = |range| solver.roots(&[], range, &Options::default(), &Control::default());
    assert_eq!(ask(Interval::EMPTY), Roots::default());
    assert_eq!(ask(Interval::point(1.0)).proved[0].bracket, Interval::ONE);
    assert_eq!(ask(Interval::point(2.0)), Roots::default());
    assert_eq!(ask(Interval::ENTIRE).proved.len(), 1);
    let constant = expression("2");
    let solver = Solver::new(&constant.graph, constant.root, "x", &[], &Compiler).unwrap();
    assert_eq!(solver.roots(&[], Interval::ENTIRE, &Options::default(), &Control::default()), Roots::default());
}

#[test]
fn threads_share_one_solver() {
    fn shared<T: Send + Sync>() {}
    shared::<Solver>();
    shared::<RaySolver>();
    let solver = kepler(&[]);
    let ask = |i: u32| {
        let values = ordered(&solver, Interval::point(0.3), Interval::point(f64::from(i)));
        solver.roots(&values, interval(0.0, 10.0), &Options::default(), &Control::default())
    };
    let alone: Vec<Roots> = (0..8).map(ask).collect();
    let together: Vec<Roots> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|i| scope.spawn(move || ask(i))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(alone, together);
}

#[test]
fn answers_survive_a_file() {
    let tangent = expression("(x^2 - 2)(tan(x) + 1)(x - 1)^2");
    let solver = Solver::new(&tangent.graph, tangent.root, "x", &[], &Compiler).unwrap();
    let found = solver.roots(&[], interval(0.0, 3.0), &Options::default(), &Control::default());
    assert!(found.proved.len() >= 2 && !found.unknown.is_empty(), "{found}");
    let text = serde_json::to_string(&found).unwrap();
    assert_eq!(serde_json::from_str::<Roots>(&text).unwrap(), found);
    assert_eq!(postcard::from_bytes::<Roots>(&postcard::to_stdvec(&found).unwrap()).unwrap(), found);
}
