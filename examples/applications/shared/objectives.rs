//! Four functions on which global optimisers are tried, in any number of variables, and their kernels under branch and
//! bound. All have the minimum 0. Sources: D. Himmelblau, "Applied Nonlinear Programming", 1972 (here summed over pairs of
//! variables); H. Rosenbrock, 1960; D. Ackley, 1987; L. Rastrigin, 1974.

use imp::Error;
use imp::Function;
use imp::IntervalKernel;
use imp::Options;

use crate::branch::Area;
use crate::branch::Bounds;

use crate::branch::Objective;
use crate::branch::Side;

/// The formulas, by name, with the domain of each variable. No domain is halved towards a minimiser, which would be luck.
pub const NAMES: [(&str, [f64; 2]); 4] =
    [("Himmelblau", [-6.0, 5.0]), ("Rosenbrock", [-5.0, 10.0]), ("Ackley", [-30.0, 35.0]), ("Rastrigin", [-5.0, 5.5])];

/// A function of [`NAMES`] in the variables x1, ..., xn.
pub fn formula(name: &str, n: usize) -> String {
    let sum = |count: usize, term: &dyn Fn(usize) -> String| (1..=count).map(term).collect::<Vec<_>>().join(" + ");
    match name {
        "Himmelblau" => {
            let pair = |x: usize, y: usize| format!("(x{x}^2 + x{y} - 11)^2 + (x{x} + x{y}^2 - 7)^2");
            sum(n / 2, &|i| pair(2 * i - 1, 2 * i))
        }
        "Rosenbrock" => sum(n - 1, &|i| format!("100(x{} - x{i}^2)^2 + (1 - x{i})^2", i + 1)),
        "Ackley" => {
            let (squares, waves) = (sum(n, &|i| format!("x{i}^2")), sum(n, &|i| format!("cos(2pi x{i})")));
            format!("20 + e - 20exp(-sqrt(({squares}) / {n}) / 5) - exp(({waves}) / {n})")
        }
        _ => format!("10 * {n} + {}", sum(n, &|i| format!("(x{i}^2 - 10cos(2pi x{i}))"))),
    }
}

/// A formula compiled for branch and bound: its bounds, and with them those of its gradient, which imp derives.
pub struct Compiled {
    values: IntervalKernel,
    slopes: IntervalKernel,
}

impl Compiled {
    /// Compiles a formula in x1, ..., xN.
    ///
    /// # Errors
    /// What Imp says of the formula.
    pub fn new<const N: usize>(formula: &str) -> Result<Self, Error> {
        let variables: [String; N] = std::array::from_fn(|i| format!("x{}", i + 1));
        let function = Function::parse(formula, &variables.each_ref().map(String::as_str))?;
        let (values, slopes) =
            (function.intervals(&Options::default())?, function.intervals(&Options::with_gradient())?);
        Ok(Self { values, slopes })
    }
}

impl<const N: usize> Objective<N> for Compiled {
    fn values(&self, _: usize, boxes: &[Side], values: &mut [Bounds]) {
        self.values.enclose_packets(boxes.as_flattened(), values.as_flattened_mut());
    }

    fn slopes(&self, _: usize, boxes: &[Side], slopes: &mut [Bounds]) {
        self.slopes.enclose_packets(boxes.as_flattened(), slopes.as_flattened_mut());
    }
}

/// The same domain for each variable.
pub fn cube<const N: usize>(side: [f64; 2]) -> Area<N> {
    [side; N]
}
