//! A search that is compiled once and asked many times.
//!
//! The same proofs as in the reference search, eight parts at once. What the kernel leaves undecided down to the resolution,
//! and brackets at which it stalls, the reference arithmetic finishes.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::control::Control;
use crate::diagnostic::Diagnostic;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::limits::Budget;
use crate::limits::Limits;
use crate::roots::answer::Options;
use crate::roots::answer::Root;
use crate::roots::answer::Roots;
use crate::roots::numbers::is_small;
use crate::roots::numbers::scale;
use crate::roots::numbers::simple;
use crate::roots::numbers::simplest;
use crate::roots::packets::Answer;
use crate::roots::packets::Batch;
use crate::roots::packets::CAPACITY;
use crate::roots::packets::Compiled;
use crate::roots::packets::LANES;
use crate::roots::problem::Problem;
use crate::roots::search::CROWD;
use crate::roots::search::CROWDED;
use crate::roots::search::Search;
use crate::roots::search::number;

/// Cuts of wide parts are off the even ones by this part of a piece: zeros of formulas that people write are rarely there,
/// and a zero on a cut is found from both sides.
const SKEW: f64 = 0.013_671_875;
/// Below this part of the interval, or of a number's size, cuts are at simple numbers: what is undecided for so long may be
/// a pole or the end of a domain, which excludes zeros on both sides of a cut that meets it exactly.
const NARROW: f64 = 1.0 / 64.0;
/// A bracket of at most so many units in the last place is narrow enough.
const SHARP: f64 = 4.0;
/// One that stalled so many wide is tried on the reference arithmetic. Below that it is the formula's own cancellation that
/// hides the zero, and the reference gains nothing.
const BLURRED: f64 = (1u64 << 26) as f64;

/// Finds all zeros of a function of one variable for any values of its parameters.
///
/// It is `Send` and `Sync`: many threads may ask at once. A call allocates once, not for each part of the interval.
pub struct Solver {
    problem: Arc<Problem>,
    compiled: Compiled,
    parameters: Vec<String>,
    /// The promises about the variable and about the parameters.
    promised: Interval,
    promises: Vec<Interval>,
}

impl Solver {
    /// A solver for `value = 0` in the input named `variable`; the graph's other inputs become parameters.
    ///
    /// `bounds` may tell what inputs are known to keep to, by name: the kernel is faster where signs are known and overflow
    /// is excluded. Outside of them the solver falls back to the reference arithmetic, which is slower and as right.
    ///
    /// # Errors
    /// If the backend cannot compile the function, as a diagnostic without a place.
    pub fn new(
        graph: &Graph,
        value: Value,
        variable: &str,
        bounds: &[(&str, Interval)],
        backend: &dyn Backend,
    ) -> Result<Self, Diagnostic> {
        Self::within(graph, value, variable, bounds, backend, &Budget::new(&Limits::unlimited()))
    }

    /// The same under a budget.
    ///
    /// # Errors
    /// As [`Solver::new`], and if the budget is exceeded.
    pub fn within(
        graph: &Graph,
        value: Value,
        variable: &str,
        bounds: &[(&str, Interval)],
        backend: &dyn Backend,
        budget: &Budget,
    ) -> Result<Self, Diagnostic> {
        Self::of(Problem::new(graph, value, variable, budget)?, bounds, backend, budget)
    }

    fn of(
        problem: Problem,
        bounds: &[(&str, Interval)],
        backend: &dyn Backend,
        budget: &Budget,
    ) -> Result<Self, Diagnostic> {
        let compiled = Compiled::new(&problem, bounds, backend, budget)?;
        let bound = |name: &str| bounds.iter().find(|(n, _)| *n == name).map_or(Interval::ENTIRE, |&(_, range)| range);
        let mut parameters = problem.graph.variables().to_vec();
        let promised = bound(&parameters.remove(problem.variable));
        let promises = parameters.iter().map(|name| bound(name)).collect();
        Ok(Self { problem: Arc::new(problem), compiled, parameters, promised, promises })
    }

    /// The names of the parameters, in the order in which their values are to be given.
    pub fn parameters(&self) -> &[String] {
        &self.parameters
    }

    /// All zeros in `range`, which may be unbounded, for all values of the parameters in their intervals. There is none in the
    /// empty set, nor for a parameter that has no value.
    ///
    /// # Panics
    /// If the intervals are not as many as [`Solver::parameters`].
    pub fn roots(&self, parameters: &[Interval], range: Interval, options: &Options, control: &Control) -> Roots {
        assert_eq!(parameters.len(), self.parameters.len(), "one interval for each parameter");
        if range.is_empty() || parameters.iter().any(|x| x.is_empty()) {
            return Roots::default();
        }
        let mut boxes: Vec<Decorated> = parameters.iter().copied().map(Decorated::new).collect();
        boxes.insert(self.problem.variable, Decorated::ENTIRE);
        let reference = |spent| Search::of(Arc::clone(&self.problem), boxes.clone(), spent);
        let kept = range.subset(self.promised) && parameters.iter().zip(&self.promises).all(|(x, y)| x.subset(*y));
        if range.is_singleton() || !kept {
            return reference(0).run(range, options, control);
        }
        let mut run = Run::new(Batch::new(&self.compiled, parameters.iter().copied()), range, options);
        run.search(self.compiled.operations, control);
        for root in run.roots.proved.iter_mut().filter(|root| !is_within(root.bracket, BLURRED)) {
            root.bracket = reference(0).contract(root.bracket);
        }
        let Run { mut open, rest, roots, spent, .. } = run;
        open.retain(|x| !roots.proved.iter().any(|root| root.alone.is_some_and(|alone| alone.contains_interval(*x))));
        reference(spent).resume(open, rest, roots, range, options, control)
    }
}

/// Finds all zeros of a function of up to three coordinates along any line, for any values of its parameters.
///
/// It is `Send` and `Sync`, as [`Solver`] is.
pub struct RaySolver {
    solver: Solver,
    coordinates: usize,
}

impl RaySolver {
    /// A solver for `value = 0` in t at origin + t direction. `coordinates` are the inputs that the line replaces, at most
    /// three; the graph's other inputs become parameters. For `bounds`, see [`Solver::new`]; those of a line's own numbers go
    /// by the names in [`ORIGIN`](crate::derive::ORIGIN), [`DIRECTION`](crate::derive::DIRECTION) and [`PARAMETER`](crate::derive::PARAMETER).
    ///
    /// # Errors
    /// If the backend cannot compile the function, as a diagnostic without a place.
    ///
    /// # Panics
    /// If there are more than three coordinates.
    pub fn new(
        graph: &Graph,
        value: Value,
        coordinates: &[&str],
        bounds: &[(&str, Interval)],
        backend: &dyn Backend,
    ) -> Result<Self, Diagnostic> {
        Self::within(graph, value, coordinates, bounds, backend, &Budget::new(&Limits::unlimited()))
    }

    /// The same under a budget.
    ///
    /// # Errors
    /// As [`RaySolver::new`], and if the budget is exceeded.
    ///
    /// # Panics
    /// If there are more than three coordinates.
    pub fn within(
        graph: &Graph,
        value: Value,
        coordinates: &[&str],
        bounds: &[(&str, Interval)],
        backend: &dyn Backend,
        budget: &Budget,
    ) -> Result<Self, Diagnostic> {
        let problem = Problem::along_ray(graph, value, coordinates, budget)?;
        let solver = Solver::of(problem, bounds, backend, budget)?;
        Ok(Self { solver, coordinates: coordinates.len() })
    }

    /// The names of the parameters, in the order in which their values are to be given.
    pub fn parameters(&self) -> &[String] {
        &self.solver.parameters[2 * self.coordinates..]
    }

    /// All t in `range` at which the function is 0 on the exact line origin + t direction. On a line with a number that is
    /// not finite nothing is proved.
    ///
    /// # Panics
    /// If the intervals are not as many as [`RaySolver::parameters`], or origin and direction not as many as the coordinates.
    pub fn roots(
        &self,
        origin: &[f64],
        direction: &[f64],
        parameters: &[Interval],
        range: Interval,
        options: &Options,
        control: &Control,
    ) -> Roots {
        assert_eq!(
            [origin.len(), direction.len()],
            [self.coordinates; 2],
            "one number of origin and direction for each coordinate"
        );
        let line = origin.iter().chain(direction).map(|&x| number(x));
        let values: Vec<Interval> = line.chain(parameters.iter().copied()).collect();
        self.solver.roots(&values, range, options, control)
    }
}

/// What is left to do with a part of the interval.
enum Task {
    /// Undecided: to be cut.
    Cut(Interval),
    /// The function is monotone on `x` and its zero, if it has one, is in `near`: the signs at both ends decide.
    Ends { x: Interval, near: Interval },
    /// The signs did not decide, as the zero is too near to an end: all zeros of the part are in `near`, and `x` is that and
    /// more on both sides.
    Wider { x: Interval, near: Interval },
    /// To be narrowed.
    Narrow(Root),
    /// To be narrowed from points off its middle, where rounding errors hide the sign of the function.
    Squeeze(Root),
}

/// What a lane is asked.
#[derive(Clone, Copy)]
enum Lane {
    Part(Interval),
    /// The sign at the lower end; that at the upper one is in the next lane.
    Low {
        x: Interval,
        near: Interval,
    },
    Wider {
        x: Interval,
        near: Interval,
    },
    Narrow(Root),
    /// From below the middle; the next lane is the same from above.
    Squeeze(Root),
    /// Belongs to the lane before.
    Second,
}

/// One search.
struct Run<'a> {
    batch: Batch<'a>,
    range: Interval,
    options: &'a Options,
    queue: VecDeque<Task>,
    lanes: Vec<Lane>,
    /// Too small to be cut, and too many of those: for the reference arithmetic.
    open: Vec<Interval>,
    rest: Vec<Interval>,
    roots: Roots,
    spent: usize,
}

impl<'a> Run<'a> {
    fn new(batch: Batch<'a>, range: Interval, options: &'a Options) -> Self {
        Self {
            batch,
            range,
            options,
            queue: VecDeque::from([Task::Cut(range)]),
            lanes: Vec::with_capacity(CAPACITY),
            open: Vec::new(),
            rest: Vec::new(),
            roots: Roots::default(),
            spent: 0,
        }
    }

    /// First in, first out: all undecided parts are of about the same width, and when the search has to end what is unknown
    /// is as short as can be.
    fn search(&mut self, operations: usize, control: &Control) {
        loop {
            let over = self.spent > self.options.budget || control.is_cancelled();
            self.fill(over);
            let lanes = self.lanes.len();
            if lanes == 0 {
                return;
            }
            self.batch.run(lanes);
            self.spent += lanes * operations;
            for lane in 0..lanes {
                let answer = self.batch.answer(lane);
                match self.lanes[lane] {
                    Lane::Part(x) => self.part(x, &answer),
                    Lane::Low { x, near } => self.ends(x, near, lane),
                    Lane::Wider { x, near } => self.wider(x, near, &answer),
                    Lane::Narrow(root) => self.narrow(root, &answer),
                    Lane::Squeeze(root) => self.squeeze(root, lane),
                    Lane::Second => {}
                }
            }
        }
    }

    /// Takes tasks from the queue while there are lanes; when the search is over, puts away what is left.
    fn fill(&mut self, over: bool) {
        self.lanes.clear();
        // Few parts are cut into many, many into two each.
        let pieces = (LANES / self.queue.len().max(1)).max(2);
        while self.lanes.len() + pieces <= CAPACITY {
            let Some(task) = self.queue.pop_front() else { return };
            match task {
                Task::Cut(x) if over => {
                    self.roots.exhausted = true;
                    self.rest.push(x);
                }
                Task::Ends { near, .. } | Task::Wider { near, .. } if over => {
                    self.roots.exhausted = true;
                    self.rest.push(near);
                }
                Task::Narrow(root) | Task::Squeeze(root) if over => self.roots.proved.push(root),
                Task::Cut(x) => {
                    let crowded = self.queue.len() + self.lanes.len() > CROWD;
                    if crowded && x.width() <= CROWDED * scale(x, self.range) {
                        self.rest.push(x);
                    } else if is_small(x, self.range, self.options.resolution) || !self.cut(x, pieces) {
                        self.open.push(x);
                    }
                }
                Task::Ends { x, near } => {
                    for (end, lane) in [(x.lo(), Lane::Low { x, near }), (x.hi(), Lane::Second)] {
                        self.ask(lane, Interval::point(end), end);
                    }
                }
                Task::Wider { x, near } => self.ask(Lane::Wider { x, near }, x, inside(x)),
                Task::Narrow(root) => {
                    let x = root.bracket;
                    self.ask(Lane::Narrow(root), x, inside(x));
                }
                Task::Squeeze(root) => {
                    let x = root.bracket;
                    for (part, lane) in [(0.125, Lane::Squeeze(root)), (0.875, Lane::Second)] {
                        self.ask(lane, x, between(x, part));
                    }
                }
            }
        }
    }

    fn ask(&mut self, lane: Lane, x: Interval, middle: f64) {
        self.batch.set(self.lanes.len(), x, middle);
        self.lanes.push(lane);
    }

    /// Asks about the pieces of a part; false if no number lies between its ends.
    fn cut(&mut self, x: Interval, pieces: usize) -> bool {
        let cuts = if x.is_bounded() { pieces - 1 } else { 1 };
        let wide = x.width() > NARROW * scale(x, self.range);
        let place = |number: f64| between(x, number / pieces as f64);
        let mut last = x.lo();
        let mut found = false;
        for i in 1..=cuts {
            let at = match x.is_bounded() {
                true if wide => place(i as f64 + SKEW),
                true => simple(place(i as f64 - 0.5), place(i as f64 + 0.5)),
                false => simplest(x).unwrap_or(x.lo()),
            };
            let Some(piece) = Interval::new(last, at).filter(|_| last < at && at < x.hi()) else { continue };
            self.ask(Lane::Part(piece), piece, inside(piece));
            (last, found) = (at, true);
        }
        if let Some(piece) = Interval::new(last, x.hi()).filter(|_| found) {
            self.ask(Lane::Part(piece), piece, inside(piece));
        }
        found
    }

    fn part(&mut self, x: Interval, answer: &Answer) {
        if answer.refuted {
            return;
        }
        let Some(newton) = answer.newton.filter(|_| x.is_bounded()) else { return self.queue.push_back(Task::Cut(x)) };
        let near = newton.intersect(x);
        if near.is_empty() {
            return;
        }
        // The Newton operator maps the part into itself: there is a zero, and the slope allows one only.
        self.queue.push_back(match x.contains_interval(newton) {
            true => Task::Narrow(Root { bracket: near, alone: Some(x) }),
            false => Task::Ends { x, near },
        });
    }

    /// The signs at the ends of a part on which the function is monotone.
    fn ends(&mut self, x: Interval, near: Interval, lane: usize) {
        let [low, high] = [lane, lane + 1].map(|lane| self.batch.answer(lane));
        let exact = [(low, x.lo()), (high, x.hi())].into_iter().find(|(answer, _)| answer.zero);
        if let Some((_, end)) = exact {
            self.roots.proved.push(Root { bracket: Interval::point(end), alone: Some(x) });
            return;
        }
        match (low.sign, high.sign) {
            (Some(a), Some(b)) if a == b => {}
            (Some(_), Some(_)) => self.queue.push_back(Task::Narrow(Root { bracket: near, alone: Some(x) })),
            _ => {
                // Twice its width on both sides leaves room for the Newton operator to map into.
                let margin = 2.0 * (near.hi() - near.lo()) + 4.0 * f64::EPSILON * near.mag();
                let wider = Interval::new(near.lo() - margin, near.hi() + margin);
                let x = wider.map_or(near, |wider| wider.intersect(self.range));
                self.queue.push_back(Task::Wider { x, near });
            }
        }
    }

    /// What the signs at the ends of its part did not decide about `near`.
    fn wider(&mut self, x: Interval, near: Interval, answer: &Answer) {
        if answer.refuted {
            return;
        }
        match answer.newton.filter(|newton| x.is_bounded() && x.contains_interval(*newton)) {
            Some(newton) => self.queue.push_back(Task::Narrow(Root { bracket: newton, alone: Some(x) })),
            None => self.open.push(near),
        }
    }

    /// A Newton step in a bracket that holds one zero.
    fn narrow(&mut self, root: Root, answer: &Answer) {
        let x = root.bracket;
        if answer.zero && answer.monotone {
            self.roots.proved.push(Root { bracket: Interval::point(inside(x)), ..root });
            return;
        }
        let bracket = stepped(x, answer);
        let root = Root { bracket, ..root };
        match is_within(bracket, SHARP) {
            true => self.roots.proved.push(root),
            false if halved(bracket, x) => self.queue.push_back(Task::Narrow(root)),
            false => self.queue.push_back(Task::Squeeze(root)),
        }
    }

    fn squeeze(&mut self, root: Root, lane: usize) {
        let x = root.bracket;
        let bracket = [lane, lane + 1].iter().fold(x, |x, &lane| stepped(x, &self.batch.answer(lane)));
        let root = Root { bracket, ..root };
        match halved(bracket, x) && !is_within(bracket, SHARP) {
            true => self.queue.push_back(Task::Narrow(root)),
            false => self.roots.proved.push(root),
        }
    }
}

/// What a Newton step leaves of an interval that holds a zero.
fn stepped(x: Interval, answer: &Answer) -> Interval {
    let left = answer.newton.map_or(x, |newton| newton.intersect(x));
    // Never empty: the zero is in both.
    if left.is_empty() { x } else { left }
}

fn halved(x: Interval, before: Interval) -> bool {
    x.hi() - x.lo() <= 0.5 * (before.hi() - before.lo())
}

/// Whether an interval is at most so many units in the last place wide.
fn is_within(x: Interval, units: f64) -> bool {
    x.hi() - x.lo() <= units * f64::EPSILON * x.mag().max(f64::MIN_POSITIVE)
}

/// A number of the interval, near the middle if it is bounded; a simple one, since those are often zeros.
fn inside(x: Interval) -> f64 {
    simplest(x).unwrap_or_else(|| x.mid())
}

/// A number of a bounded interval, at a part of its width.
fn between(x: Interval, part: f64) -> f64 {
    (x.lo() * (1.0 - part) + x.hi() * part).clamp(x.lo(), x.hi())
}
