//! Zeros of functions, in one variable or along a line.

use std::fmt;

use crate::control::Control;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::library::Error;
use crate::library::Function;
use crate::library::kernel::check;
use crate::library::kernel::parameter;
use crate::roots::Options;
use crate::roots::RaySolver;
use crate::roots::Roots;
use crate::roots::Solver;
use crate::session;

/// Finds all zeros of a function in one of its variables; the other variables and the parameters have values. Compiled
/// once, asked many times, from any number of threads.
pub struct RootFinder {
    solver: Solver,
    function: Function,
    values: Values,
    options: Options,
}

/// Finds all zeros of a function of up to three variables along lines.
pub struct RayFinder {
    solver: RaySolver,
    function: Function,
    values: Values,
    options: Options,
}

/// What does not vary in a search, in the order of the solver's parameters.
#[derive(Clone)]
struct Values {
    names: Vec<String>,
    intervals: Vec<Interval>,
}

impl Values {
    fn set(&mut self, function: &Function, name: &str, value: Interval) -> Result<(), Error> {
        if function.parameters().iter().any(|parameter| parameter.name == name) {
            parameter(function, name, value)?;
        }
        match self.names.iter().position(|other| other == name) {
            Some(place) => self.intervals[place] = value,
            None => return Err(Error::UnknownVariable { name: name.to_owned(), known: self.names.clone() }),
        }
        Ok(())
    }
}

impl Function {
    /// Compiles a search for zeros in a variable. The first output is searched. The other variables may be anything until
    /// [`RootFinder::set`] says more.
    ///
    /// # Errors
    /// If there is no such variable, or the function is too large.
    pub fn root_finder(&self, variable: &str) -> Result<RootFinder, Error> {
        let Some(place) = self.variables().iter().position(|other| other == variable) else {
            return Err(Error::UnknownVariable { name: variable.to_owned(), known: self.variables().to_vec() });
        };
        self.check_names()?;
        let ranges = self.ranges();
        let bounds: Vec<(&str, Interval)> = ranges.iter().map(|(name, range)| (name.as_str(), *range)).collect();
        let budget = self.budget();
        let (backend, input) = (session::Within(&budget), &self.inputs()[place]);
        let solver = Solver::within(self.graph(), self.values()[0], input, &bounds, &backend, &budget)?;
        let values = self.values_of(solver.parameters());
        Ok(RootFinder { solver, function: self.clone(), values, options: Options::default() })
    }

    /// Compiles a search for zeros along lines through the function's variables, of which there are three at most.
    ///
    /// # Errors
    /// If there are more variables, or none, or the function is too large.
    pub fn ray_finder(&self) -> Result<RayFinder, Error> {
        let dimension = self.variables().len();
        if !(1..=3).contains(&dimension) {
            return Err(Error::Length { what: "variables of a function along a line", expected: 3, found: dimension });
        }
        self.check_names()?;
        let ranges = self.ranges();
        let bounds: Vec<(&str, Interval)> = ranges.iter().map(|(name, range)| (name.as_str(), *range)).collect();
        let coordinates: Vec<&str> = self.inputs().iter().map(String::as_str).collect();
        let budget = self.budget();
        let backend = session::Within(&budget);
        let solver = RaySolver::within(self.graph(), self.values()[0], &coordinates, &bounds, &backend, &budget)?;
        let values = self.values_of(solver.parameters());
        Ok(RayFinder { solver, function: self.clone(), values, options: Options::default() })
    }

    /// All zeros of a function of one variable in an interval.
    ///
    /// # Errors
    /// If it has not one variable, or is too large.
    pub fn roots(&self, range: Interval) -> Result<Roots, Error> {
        check("variables of the function", 1, self.variables().len())?;
        Ok(self.root_finder(&self.variables()[0])?.roots(range))
    }

    /// Refuses what could not be told apart by name.
    fn check_names(&self) -> Result<(), Error> {
        let both = self.parameters().iter().find(|parameter| self.variables().contains(&parameter.name));
        let Some(both) = both else { return Ok(()) };
        let title = format!("`{}` has a variable and a parameter of the name `{}`", self.name(), both.name);
        Err(Diagnostic::error(code::DUPLICATE_NAME, title).help("give the variable another name").into())
    }

    /// The parameters' ranges.
    fn ranges(&self) -> Vec<(String, Interval)> {
        self.parameters().iter().filter_map(|parameter| Some((parameter.name.clone(), parameter.range?))).collect()
    }

    /// The values before any is set, for inputs of the graph.
    fn values_of(&self, inputs: &[String]) -> Values {
        let named = inputs.iter().map(|input| {
            let variable = self.inputs().iter().position(|other| other == input);
            let parameter = self.parameters().iter().find(|parameter| parameter.name == *input);
            let name = variable.map_or(input, |place| &self.variables()[place]);
            (name.clone(), parameter.map_or(Interval::ENTIRE, |parameter| parameter.value))
        });
        let (names, intervals) = named.unzip();
        Values { names, intervals }
    }
}

impl RootFinder {
    /// Gives a parameter or another variable a value, which may be an interval: what is proved then holds for each number in
    /// it.
    ///
    /// # Errors
    /// If there is no such name, or a parameter would leave its range.
    pub fn set(&mut self, name: &str, value: Interval) -> Result<(), Error> {
        self.values.set(&self.function, name, value)
    }

    /// How fine and how long is searched.
    pub fn set_options(&mut self, options: Options) {
        self.options = options;
    }

    /// All zeros in an interval, which may be unbounded.
    pub fn roots(&self, range: Interval) -> Roots {
        self.roots_watched(range, &Control::default())
    }

    /// The same with a control that may stop it; then what was not searched is unknown.
    pub fn roots_watched(&self, range: Interval, control: &Control) -> Roots {
        self.solver.roots(&self.values.intervals, range, &self.options, control)
    }
}

impl RayFinder {
    /// Gives a parameter a value.
    ///
    /// # Errors
    /// If there is no such parameter, or it would leave its range.
    pub fn set(&mut self, name: &str, value: Interval) -> Result<(), Error> {
        self.values.set(&self.function, name, value)
    }

    /// How fine and how long is searched.
    pub fn set_options(&mut self, options: Options) {
        self.options = options;
    }

    /// All t in `range` at which the function is 0 on the exact line origin + t direction, whose vectors have a number for each
    /// variable (of `glam`: `&v.to_array()`).
    ///
    /// # Errors
    /// If they have not.
    pub fn roots(&self, origin: &[f64], direction: &[f64], range: Interval) -> Result<Roots, Error> {
        let dimension = self.function.variables().len();
        check("coordinates of the line's origin", dimension, origin.len())?;
        check("coordinates of the line's direction", dimension, direction.len())?;
        let control = Control::default();
        Ok(self.solver.roots(origin, direction, &self.values.intervals, range, &self.options, &control))
    }
}

impl fmt::Debug for RootFinder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "roots of {:?}", self.function)
    }
}

impl fmt::Debug for RayFinder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "roots of {:?} along lines", self.function)
    }
}
