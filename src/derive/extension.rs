//! The ways in which Imp encloses a formula over a box, side by side: the natural extension, affine forms, centred
//! forms. Reference arithmetic throughout: `f64`, rounded outward, as tight as each way allows.
//!
//! Centred forms (Moore 1966; Neumaier, "Interval methods for systems of equations", 1990, section 2.3) need the
//! increments of f enclosed by derivative times step. That holds where f is continuous on the box and the derivative is
//! defined on all of it, as the hull of the branches at kinks and the whole line across jumps (contract 7): f is then
//! Lipschitz along every segment of the box. Where the decorations do not prove both, the natural extension answers.

use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

use crate::derive::cost;
use crate::derive::gradient::gradient;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::apply;
use crate::graph::apply_affine;
use crate::graph::enclose;
use crate::interval::Coefficients;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Form;
use crate::interval::Interval;
use crate::interval::Sparse;

/// Noise symbols of affine forms: AF1 with so many shared ones, which the first inputs get that are no points, or one
/// for every input and for every operation that is not affine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Symbols {
    One,
    Two,
    Three,
    Full,
}

/// How a formula is enclosed over a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Extension {
    /// Operation by operation on intervals.
    Natural,
    /// The range of affine forms alone.
    Affine(Symbols),
    /// Affine forms whose range is intersected with the natural extension after each operation.
    Intersected(Symbols),
    /// f(m) + f'(X) (X - m) with m the middle of the box X.
    MeanValue,
    /// f(m) + f'(m) (X - m) + (X - m)^T f''(X) (X - m) / 2.
    SecondOrder,
}

impl Extension {
    /// Every extension, the plainest first.
    pub const ALL: &[Self] = &[
        Self::Natural,
        Self::Affine(Symbols::One),
        Self::Affine(Symbols::Two),
        Self::Affine(Symbols::Three),
        Self::Affine(Symbols::Full),
        Self::Intersected(Symbols::One),
        Self::Intersected(Symbols::Two),
        Self::Intersected(Symbols::Three),
        Self::Intersected(Symbols::Full),
        Self::MeanValue,
        Self::SecondOrder,
    ];

    /// What the user calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Natural => "interval",
            Self::Affine(Symbols::One) => "affine1",
            Self::Affine(Symbols::Two) => "affine2",
            Self::Affine(Symbols::Three) => "affine3",
            Self::Affine(Symbols::Full) => "affine",
            Self::Intersected(Symbols::One) => "intersected1",
            Self::Intersected(Symbols::Two) => "intersected2",
            Self::Intersected(Symbols::Three) => "intersected3",
            Self::Intersected(Symbols::Full) => "intersected",
            Self::MeanValue => "centred",
            Self::SecondOrder => "centred2",
        }
    }
}

impl fmt::Display for Extension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The name of no extension.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownExtension(String);

impl fmt::Display for UnknownExtension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = Extension::ALL.iter().map(|extension| extension.name()).collect();
        write!(f, "there is no arithmetic `{}`; there are {}", self.0, names.join(", "))
    }
}

impl std::error::Error for UnknownExtension {}

impl FromStr for Extension {
    type Err = UnknownExtension;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let found = Self::ALL.iter().copied().find(|extension| extension.name() == name);
        found.ok_or_else(|| UnknownExtension(name.to_owned()))
    }
}

/// One formula, ready for all extensions; derivatives are derived when first asked for.
#[derive(Debug, Clone)]
pub struct Formula {
    graph: Graph,
    root: Value,
    gradient: OnceLock<Derived>,
    second: OnceLock<Derived>,
}

/// The formula's graph with some derivatives of it, by rising index of the inputs.
#[derive(Debug, Clone)]
struct Derived {
    graph: Graph,
    roots: Vec<Value>,
}

impl Formula {
    /// The formula `root` in all inputs of `graph`, needed or not.
    pub fn new(graph: &Graph, root: Value) -> Self {
        Self { graph: graph.clone(), root, gradient: OnceLock::new(), second: OnceLock::new() }
    }

    /// The inputs, in the order of the boxes below.
    pub fn variables(&self) -> &[String] {
        self.graph.variables()
    }

    /// Encloses the formula's values on a box. The decoration says what the natural extension proves of the formula
    /// there, whichever extension has computed the enclosure.
    ///
    /// # Panics
    /// If the number of inputs is not the number of variables.
    pub fn enclose(&self, extension: Extension, inputs: &[Decorated]) -> Decorated {
        let natural = enclose(&self.graph, &[self.root], inputs)[0];
        if natural.interval().is_empty() {
            return natural;
        }
        let interval = match extension {
            Extension::Natural => return natural,
            Extension::Affine(symbols) => self.affine(symbols, false, inputs),
            Extension::Intersected(symbols) => self.affine(symbols, true, inputs),
            Extension::MeanValue => self.mean_value(natural, inputs).unwrap_or(natural.interval()),
            Extension::SecondOrder => {
                let centred = self.second_order(natural, inputs).or_else(|| self.mean_value(natural, inputs));
                centred.unwrap_or(natural.interval())
            }
        };
        Decorated::with(interval, natural.decoration())
    }

    /// The hull of the enclosures over each input cut into `parts` equal parts; points and unbounded inputs are not
    /// cut. The decoration is the least of all boxes': they are closed and cover the whole, so that what is continuous
    /// on each of them is continuous on their union.
    ///
    /// # Panics
    /// As [`Formula::enclose`].
    pub fn enclose_in_parts(&self, extension: Extension, inputs: &[Decorated], parts: u32) -> Decorated {
        let pieces: Vec<Vec<Decorated>> = inputs.iter().map(|&x| cut(x, parts)).collect();
        let mut chosen = vec![0; inputs.len()];
        let mut hull: Option<Decorated> = None;
        loop {
            let part: Vec<Decorated> = pieces.iter().zip(&chosen).map(|(pieces, &i)| pieces[i]).collect();
            let value = self.enclose(extension, &part);
            hull = Some(hull.map_or(value, |hull| {
                let decoration = hull.decoration().min(value.decoration());
                Decorated::with(hull.interval().hull(value.interval()), decoration)
            }));
            // Count on, the first input fastest.
            let Some(next) = (0..chosen.len()).find(|&i| chosen[i] + 1 < pieces[i].len()) else {
                return hull.unwrap_or(value);
            };
            chosen[next] += 1;
            chosen[..next].fill(0);
        }
    }

    /// Operations on `f64` numbers that one box costs: counted from the graph, so that it never changes. How an
    /// operation counts is written in `derive::cost`.
    pub fn operations(&self, extension: Extension) -> u64 {
        let natural = cost::natural(&self.graph, &[self.root]);
        let dimension = self.variables().len() as u64;
        match extension {
            Extension::Natural => natural,
            Extension::Affine(symbols) => cost::affine(&self.graph, self.root, symbols),
            Extension::Intersected(symbols) => {
                let intersections = 2 * cost::steps(&self.graph, self.root);
                natural + cost::affine(&self.graph, self.root, symbols) + intersections
            }
            // The natural extension for the decoration, the value at the middle, the slopes; then, for each input, a
            // step, a product and a sum.
            Extension::MeanValue => {
                let Derived { graph, roots } = self.gradient();
                2 * natural + cost::natural(graph, roots) + dimension * (2 + cost::PRODUCT + 2)
            }
            Extension::SecondOrder => {
                let slopes = self.gradient();
                let Derived { graph, roots } = self.second();
                let terms = dimension + roots.len() as u64;
                2 * natural
                    + 2 * cost::natural(&slopes.graph, &slopes.roots)
                    + cost::natural(graph, roots)
                    + terms * (2 + cost::PRODUCT + 2)
            }
        }
    }

    fn affine(&self, symbols: Symbols, intersect: bool, inputs: &[Decorated]) -> Interval {
        match symbols {
            Symbols::One => self.forms::<[f64; 1]>(intersect, inputs),
            Symbols::Two => self.forms::<[f64; 2]>(intersect, inputs),
            Symbols::Three => self.forms::<[f64; 3]>(intersect, inputs),
            Symbols::Full => self.forms::<Sparse>(intersect, inputs),
        }
    }

    /// Operation by operation on affine forms. Beside each form goes the enclosure that the next operations see: its
    /// range, or that within the natural extension.
    fn forms<C: Coefficients>(&self, intersect: bool, inputs: &[Decorated]) -> Interval {
        let needed = self.graph.reachable(&[self.root]);
        let mut values: Vec<(Form<C>, Interval)> = vec![(Form::UNBOUNDED, Interval::EMPTY); self.graph.len()];
        let mut taken = 0;
        for (value, node) in self.graph.iter().filter(|(value, _)| needed[value.index()]) {
            let (form, enclosure) = match node.op {
                Op::Var(id) => {
                    let x = inputs[id as usize].interval();
                    let form = if x.is_singleton() { Form::constant(x) } else { Form::from_interval(x, taken) };
                    taken += usize::from(!x.is_singleton());
                    (form, x)
                }
                _ => {
                    let operands: Vec<(Form<C>, Interval)> =
                        node.operands().iter().map(|v| values[v.index()].clone()).collect();
                    let enclosures: Vec<Decorated> = operands.iter().map(|(_, x)| Decorated::new(*x)).collect();
                    let enclosure = apply(&self.graph, node, &enclosures).interval();
                    // Inputs take symbols below their number, operations those above.
                    let symbol = inputs.len() + value.index();
                    (apply_affine(node.op, &operands, enclosure).claim(symbol), enclosure)
                }
            };
            // A form has no way to be empty.
            let range = match () {
                _ if enclosure.is_empty() => enclosure,
                _ if intersect => enclosure.intersect(form.to_interval()),
                _ => form.to_interval(),
            };
            values[value.index()] = (form, range);
        }
        values[self.root.index()].1
    }

    fn gradient(&self) -> &Derived {
        self.gradient.get_or_init(|| {
            let mut graph = self.graph.clone();
            let inputs = inputs(&mut graph);
            let roots = gradient(&mut graph, self.root, &inputs);
            Derived { graph, roots }
        })
    }

    /// The second derivatives by inputs i <= j: those of i = 0 first, each by rising j.
    fn second(&self) -> &Derived {
        self.second.get_or_init(|| {
            let Derived { graph, roots: slopes } = self.gradient();
            let mut graph = graph.clone();
            let inputs = inputs(&mut graph);
            let roots = (0..inputs.len()).flat_map(|i| gradient(&mut graph, slopes[i], &inputs[i..])).collect();
            Derived { graph, roots }
        })
    }

    /// The middle of the box, and how far the box reaches from there in each input.
    fn middle(inputs: &[Decorated]) -> (Vec<Decorated>, Vec<Interval>) {
        let middle: Vec<Interval> = inputs.iter().map(|x| Interval::point(x.interval().mid())).collect();
        let steps = inputs.iter().zip(&middle).map(|(x, m)| x.interval() - *m).collect();
        (middle.into_iter().map(Decorated::new).collect(), steps)
    }

    fn mean_value(&self, natural: Decorated, inputs: &[Decorated]) -> Option<Interval> {
        if natural.decoration() < Decoration::Dac {
            return None;
        }
        let Derived { graph, roots } = self.gradient();
        let slopes = enclose(graph, roots, inputs);
        if slopes.iter().any(|slope| slope.decoration() < Decoration::Def) {
            return None;
        }
        let (middle, steps) = Self::middle(inputs);
        let value = enclose(&self.graph, &[self.root], &middle)[0].interval();
        Some(slopes.iter().zip(steps).fold(value, |sum, (slope, step)| sum + slope.interval() * step))
    }

    /// Taylor's formula of second order holds where the gradient is continuous and has increments enclosed by its
    /// derivatives. A continuous gradient has every kink decided, so that the mixed derivatives are symmetric and one
    /// of each two will do.
    fn second_order(&self, natural: Decorated, inputs: &[Decorated]) -> Option<Interval> {
        if natural.decoration() < Decoration::Dac {
            return None;
        }
        let slopes = self.gradient();
        if enclose(&slopes.graph, &slopes.roots, inputs).iter().any(|slope| slope.decoration() < Decoration::Dac) {
            return None;
        }
        let Derived { graph, roots } = self.second();
        let curvatures = enclose(graph, roots, inputs);
        if curvatures.iter().any(|curvature| curvature.decoration() < Decoration::Def) {
            return None;
        }
        let (middle, steps) = Self::middle(inputs);
        let value = enclose(&self.graph, &[self.root], &middle)[0].interval();
        let at_middle = enclose(&slopes.graph, &slopes.roots, &middle);
        let mut sum = at_middle.iter().zip(&steps).fold(value, |sum, (slope, &step)| sum + slope.interval() * step);
        let half = Interval::point(0.5);
        let mut curvatures = curvatures.iter().map(|curvature| curvature.interval());
        for i in 0..steps.len() {
            for j in i..steps.len() {
                // Each mixed term occurs twice, which the half undoes.
                let area = if i == j { half * steps[i].sqr() } else { steps[i] * steps[j] };
                sum = sum + curvatures.next().expect("one curvature for each pair") * area;
            }
        }
        Some(sum)
    }
}

/// The values of all inputs, in order.
fn inputs(graph: &mut Graph) -> Vec<Value> {
    let names = graph.variables().to_vec();
    names.iter().map(|name| graph.var(name)).collect()
}

/// An interval in equal parts, up to rounding, that share their ends.
fn cut(x: Decorated, parts: u32) -> Vec<Decorated> {
    let interval = x.interval();
    if !interval.is_bounded() || interval.is_singleton() {
        return vec![x];
    }
    let (lo, hi) = (interval.lo(), interval.hi());
    let mut pieces = Vec::with_capacity(parts as usize);
    let mut start = lo;
    for i in 1..=parts.max(1) {
        let share = f64::from(i) / f64::from(parts.max(1));
        let end = if share == 1.0 { hi } else { (lo * (1.0 - share) + hi * share).clamp(start, hi) };
        let piece = Interval::new(start, end).expect("the ends are in order");
        pieces.push(Decorated::with(piece, x.decoration()));
        start = end;
    }
    pieces
}

#[cfg(test)]
#[path = "extension_tests.rs"]
mod tests;
