//! Values at points.

use std::fmt;

use crate::interval::Interval;
use crate::kernel::Kernel;
use crate::kernel::Real;
use crate::library::Error;
use crate::library::Function;
use crate::library::Options;
use crate::library::kernel::Compile;
use crate::library::kernel::Shared;
use crate::library::kernel::check;
use crate::library::kernel::parameter;
use crate::library::kernel::rows;

/// A function compiled to compute its values at points, rounded to nearest: nothing is proved. NaN where it is undefined.
///
/// Call it from any number of threads. A clone shares the code and has parameters of its own.
#[derive(Clone)]
pub struct PointKernel<T: Real = f64> {
    shared: Shared<T>,
}

impl<T: Real> PointKernel<T> {
    pub(super) fn new(function: &Function, options: &Options) -> Result<Self, Error>
    where
        T: Compile,
    {
        let spec = function.point_spec(options, T::PRECISION)?;
        let code = T::compile(&spec, &function.budget())?;
        let uniforms = function.parameters().iter().map(|parameter| T::nearest(parameter.value.mid())).collect();
        let outputs = function.outputs_of(options).into();
        Ok(Self { shared: Shared { code, uniforms, function: function.clone(), outputs } })
    }

    /// What it was compiled from.
    pub fn function(&self) -> &Function {
        &self.shared.function
    }

    /// Names of the outputs: `f`, and with a gradient `df/dx`, ...
    pub fn outputs(&self) -> &[String] {
        &self.shared.outputs
    }

    /// Gives a parameter another value; nothing is compiled.
    ///
    /// # Errors
    /// If there is no such parameter, or the value lies outside of its range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), Error> {
        let place = parameter(&self.shared.function, name, Interval::point(value))?;
        self.shared.uniforms[place] = T::nearest(value);
        Ok(())
    }

    /// The same kernel with another value of a parameter.
    ///
    /// # Errors
    /// As [`PointKernel::set`].
    pub fn with(mut self, name: &str, value: f64) -> Result<Self, Error> {
        self.set(name, value)?;
        Ok(self)
    }

    /// The first output at one point, which has a number for each variable.
    ///
    /// # Errors
    /// If the point has another number of coordinates.
    pub fn value(&self, at: &[T]) -> Result<T, Error> {
        check("coordinates of the point", self.shared.variables(), at.len())?;
        let mut result = T::default();
        self.shared.run(
            1,
            |_, packets| packets.iter_mut().zip(at).for_each(|(slot, x)| slot.lanes_mut()[0] = *x),
            |_, packets| result = packets[0].lanes()[0],
        );
        Ok(result)
    }

    /// All outputs at points, row by row: `points` holds the coordinates of the first point, then those of the second, and
    /// so on; `values` gets the outputs in the same order.
    ///
    /// # Errors
    /// If the lengths are not those of as many whole rows; then nothing is computed.
    pub fn values_into(&self, points: &[T], values: &mut [T]) -> Result<(), Error> {
        let (variables, width) = (self.shared.variables(), self.outputs().len());
        let count = match variables {
            0 => rows("values", values.len(), width)?,
            _ => rows("coordinates of points", points.len(), variables)?,
        };
        check("values", count * width, values.len())?;
        self.shared.run(
            count,
            |rows, packets| {
                for (lane, row) in rows.enumerate() {
                    let point = &points[row * variables..(row + 1) * variables];
                    packets.iter_mut().zip(point).for_each(|(slot, x)| slot.lanes_mut()[lane] = *x);
                }
            },
            |rows, packets| {
                for (lane, row) in rows.enumerate() {
                    let results = &mut values[row * width..(row + 1) * width];
                    results.iter_mut().zip(packets).for_each(|(value, slot)| *value = slot.lanes()[lane]);
                }
            },
        );
        Ok(())
    }

    /// All outputs at points in columns: `points[v]` holds variable v of all points, `values[o]` gets output o.
    ///
    /// # Errors
    /// If there is not a column for each variable and each output, or one is longer than another.
    pub fn values_columns(&self, points: &[&[T]], values: &mut [&mut [T]]) -> Result<(), Error> {
        check("columns of points", self.shared.variables(), points.len())?;
        check("columns of values", self.outputs().len(), values.len())?;
        let count = points.first().map_or(0, |column| column.len());
        let lengths = points.iter().map(|column| column.len()).chain(values.iter().map(|column| column.len()));
        for length in lengths {
            check("numbers in a column", count, length)?;
        }
        self.shared.run(
            count,
            |rows, packets| {
                for (slot, column) in packets.iter_mut().zip(points) {
                    slot.lanes_mut()[..rows.len()].copy_from_slice(&column[rows.clone()]);
                }
            },
            |rows, packets| {
                for (slot, column) in packets.iter().zip(values.iter_mut()) {
                    column[rows.clone()].copy_from_slice(&slot.lanes()[..rows.len()]);
                }
            },
        );
        Ok(())
    }

    /// The code itself, for callers who keep their points in packets.
    pub fn packets(&self) -> &dyn Kernel<T> {
        &*self.shared.code
    }

    /// The parameters' values as [`PointKernel::packets`] takes them.
    pub fn uniforms(&self) -> &[T] {
        &self.shared.uniforms
    }
}

impl<T: Real> fmt::Debug for PointKernel<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "values of {:?}", self.shared.function)
    }
}
