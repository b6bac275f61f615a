// Types of kernels that Imp compiled ahead of time. This text is a module of the crate `imp-runtime` and stands in every
// self-contained file that `imp build --rust` writes. It needs `core` alone.

use core::error;
use core::fmt;

/// The version of the interface between kernels and their callers; see the symbol `<module>_abi_<version>_<fingerprint>`.
pub const ABI_VERSION: u32 = 1;

/// The two formats in which kernels compute.
pub trait Real: Copy + PartialOrd + fmt::Debug + fmt::Display + sealed::Sealed + 'static {
    /// Positive infinity.
    const INFINITY: Self;
    /// Negative infinity.
    const NEG_INFINITY: Self;
    /// Zero.
    const ZERO: Self;
    /// The same number.
    fn to_f64(self) -> f64;
    /// The difference, rounded to nearest.
    fn minus(self, other: Self) -> Self;
    /// A number between two others, about in the middle; finite.
    fn between(lo: Self, hi: Self) -> Self;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

macro_rules! real {
    ($type:ty) => {
        impl Real for $type {
            const INFINITY: Self = <$type>::INFINITY;
            const NEG_INFINITY: Self = <$type>::NEG_INFINITY;
            const ZERO: Self = 0.0;

            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn minus(self, other: Self) -> Self {
                self - other
            }

            #[inline]
            fn between(lo: Self, hi: Self) -> Self {
                let (lo, hi) = (lo.max(<$type>::MIN), hi.min(<$type>::MAX));
                // Halves first, so that nothing overflows; clamped, since halves of subnormal numbers round.
                (lo * 0.5 + hi * 0.5).max(lo).min(hi)
            }
        }
    };
}

real!(f32);
real!(f64);

/// All real numbers from `lo` to `hi`. Kernels take an interval whose ends are NaN or not in order for the whole line.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval<T = f64> {
    /// The lower end, or negative infinity.
    pub lo: T,
    /// The upper end, or infinity.
    pub hi: T,
}

impl<T: Real> Interval<T> {
    /// No number: the enclosure of a function that is nowhere defined on a box.
    pub const EMPTY: Self = Self { lo: T::INFINITY, hi: T::NEG_INFINITY };

    /// All numbers.
    pub const ENTIRE: Self = Self { lo: T::NEG_INFINITY, hi: T::INFINITY };

    /// From `lo` to `hi`, which should be in order.
    #[inline]
    pub const fn new(lo: T, hi: T) -> Self {
        Self { lo, hi }
    }

    /// One number.
    #[inline]
    pub const fn point(value: T) -> Self {
        Self { lo: value, hi: value }
    }

    /// Whether there is no number in it, or its ends are NaN.
    #[inline]
    pub fn is_empty(self) -> bool {
        !matches!(self.lo.partial_cmp(&self.hi), Some(core::cmp::Ordering::Less | core::cmp::Ordering::Equal))
    }

    /// Whether a number lies in it.
    #[inline]
    pub fn contains(self, value: T) -> bool {
        self.lo <= value && value <= self.hi
    }

    /// Whether all of another interval lies in it; an empty one lies in every other.
    #[inline]
    pub fn encloses(self, other: Self) -> bool {
        other.is_empty() || self.lo <= other.lo && other.hi <= self.hi
    }

    /// Its length, rounded to nearest; negative or NaN if it is empty.
    #[inline]
    pub fn width(self) -> T {
        self.hi.minus(self.lo)
    }

    /// A finite number in it, about in the middle.
    #[inline]
    pub fn middle(self) -> T {
        T::between(self.lo, self.hi)
    }

    /// Both halves, which share the middle.
    #[inline]
    pub fn halves(self) -> [Self; 2] {
        let middle = self.middle();
        [Self::new(self.lo, middle), Self::new(middle, self.hi)]
    }
}

impl<T: Real> From<T> for Interval<T> {
    fn from(value: T) -> Self {
        Self::point(value)
    }
}

impl<T: Real> fmt::Display for Interval<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.is_empty() {
            true => f.write_str("empty"),
            false => write!(f, "[{}, {}]", self.lo, self.hi),
        }
    }
}

/// What is proved of a function on a box. No bit set says nothing.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Verdict(pub u32);

impl Verdict {
    /// The value is > 0 wherever it is defined on the box.
    pub const POSITIVE: u32 = 1;
    /// The value is < 0 wherever it is defined on the box.
    pub const NEGATIVE: u32 = 2;
    /// The value is nowhere defined on the box.
    pub const EMPTY: u32 = 4;
    /// The value is defined and continuous on all of the box.
    pub const CONTINUOUS: u32 = 8;

    /// Whether the value is proved > 0 wherever it is defined on the box.
    #[inline]
    pub const fn is_positive(self) -> bool {
        self.0 & Self::POSITIVE != 0
    }

    /// Whether the value is proved < 0 wherever it is defined on the box.
    #[inline]
    pub const fn is_negative(self) -> bool {
        self.0 & Self::NEGATIVE != 0
    }

    /// Whether it is proved that the value is nowhere defined on the box.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.0 & Self::EMPTY != 0
    }

    /// Whether the value is proved defined and continuous on all of the box.
    #[inline]
    pub const fn is_continuous(self) -> bool {
        self.0 & Self::CONTINUOUS != 0
    }

    /// Whether it is proved that the value is 0 nowhere on the box.
    #[inline]
    pub const fn excludes_zero(self) -> bool {
        self.0 & (Self::POSITIVE | Self::NEGATIVE | Self::EMPTY) != 0
    }
}

/// The values of a function on a box: all of them lie in `interval`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure<T = f64> {
    /// Holds every value.
    pub interval: Interval<T>,
    /// What is proved besides.
    pub verdict: Verdict,
}

impl<T: Real> Enclosure<T> {
    /// As [`Verdict::is_positive`].
    #[inline]
    pub fn is_positive(&self) -> bool {
        self.verdict.is_positive()
    }

    /// As [`Verdict::is_negative`].
    #[inline]
    pub fn is_negative(&self) -> bool {
        self.verdict.is_negative()
    }

    /// As [`Verdict::is_empty`].
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.verdict.is_empty()
    }

    /// As [`Verdict::is_continuous`].
    #[inline]
    pub fn is_continuous(&self) -> bool {
        self.verdict.is_continuous()
    }

    /// As [`Verdict::excludes_zero`].
    #[inline]
    pub fn excludes_zero(&self) -> bool {
        self.verdict.excludes_zero()
    }
}

impl<T: Real> fmt::Display for Enclosure<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.interval.fmt(f)
    }
}

/// Why a call was refused; nothing was computed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A slice does not have the length that goes with the others.
    Length {
        /// Which one.
        what: &'static str,
        /// How long it has to be.
        expected: usize,
        /// How long it is.
        found: usize,
    },
    /// A parameter is empty, NaN or not inside the range that it was declared with, for which the kernels are compiled.
    Parameter {
        /// Its name.
        name: &'static str,
        /// The declared range.
        range: Interval,
        /// The interval that was given.
        given: Interval,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Length { what, expected, found } => write!(f, "{what}: {found} numbers where {expected} belong"),
            Error::Parameter { name, range, given } if given.is_empty() => {
                write!(f, "the parameter {name} is no interval: [{}, {}]; its range is {range}", given.lo, given.hi)
            }
            Error::Parameter { name, range, given } => {
                write!(f, "the parameter {name} = {given} leaves its range {range}")
            }
        }
    }
}

impl error::Error for Error {}

/// Checks an interval of a parameter against its declared range.
///
/// # Errors
/// If it is no interval, or not inside the range.
pub fn check_parameter<T: Real>(name: &'static str, given: Interval<T>, range: Interval) -> Result<(), Error> {
    let given = Interval::new(given.lo.to_f64(), given.hi.to_f64());
    match !given.is_empty() && range.encloses(given) {
        true => Ok(()),
        false => Err(Error::Parameter { name, range, given }),
    }
}

/// The C interface of a kernel over boxes: boxes, parameters, enclosures, verdicts, count.
pub type RawBoxes<T> = unsafe extern "C" fn(*const T, *const T, *mut T, *mut u32, usize);

/// The C interface of a kernel at points: points, parameters, values, count.
pub type RawPoints<T> = unsafe extern "C" fn(*const T, *const T, *mut T, usize);

/// A kernel over boxes of `V` variables with `P` parameters and `O` outputs.
#[derive(Debug, Clone, Copy)]
pub struct Boxes<T, const V: usize, const P: usize, const O: usize> {
    rows: RawBoxes<T>,
    columns: RawBoxes<T>,
}

impl<T: Real, const V: usize, const P: usize, const O: usize> Boxes<T, V, P, O> {
    /// The kernel behind two entry points.
    ///
    /// # Safety
    /// They are those of a kernel with these numbers of variables, parameters and outputs.
    pub const unsafe fn new(rows: RawBoxes<T>, columns: RawBoxes<T>) -> Self {
        Self { rows, columns }
    }

    /// Encloses the values on one box. Without parameters the defaults hold.
    #[inline]
    pub fn one(&self, parameters: Option<&[Interval<T>; P]>, variables: [Interval<T>; V]) -> [Enclosure<T>; O] {
        let mut ends = [Interval::ENTIRE; O];
        let mut verdicts = [Verdict::default(); O];
        let (first, given) = (variables.as_ptr().cast(), pointer(parameters));
        // SAFETY: the arrays have the lengths that the kernel takes for one box; `Interval` is two numbers, `Verdict` a u32.
        unsafe { (self.rows)(first, given, ends.as_mut_ptr().cast(), verdicts.as_mut_ptr().cast(), 1) };
        core::array::from_fn(|i| Enclosure { interval: ends[i], verdict: verdicts[i] })
    }

    /// Encloses the values on many boxes: `enclosures` and `verdicts` hold the `O` results of the first box, then those of
    /// the next.
    ///
    /// # Errors
    /// If the lengths do not agree.
    pub fn rows(
        &self,
        parameters: Option<&[Interval<T>; P]>,
        boxes: &[[Interval<T>; V]],
        enclosures: &mut [Interval<T>],
        verdicts: Option<&mut [Verdict]>,
    ) -> Result<(), Error> {
        let count = boxes.len();
        check_length("enclosures", count * O, enclosures.len())?;
        let verdicts = verdict_pointer(count * O, verdicts)?;
        // SAFETY: the slices have the lengths that the kernel takes for `count` boxes.
        unsafe {
            (self.rows)(boxes.as_ptr().cast(), pointer(parameters), enclosures.as_mut_ptr().cast(), verdicts, count)
        };
        Ok(())
    }

    /// The same with transposed arrays: all lower ends of the first variable, all its upper ends, then those of the next;
    /// likewise the enclosures; all verdicts of the first output, then those of the next.
    ///
    /// # Errors
    /// If the lengths do not agree.
    pub fn columns(
        &self,
        parameters: Option<&[Interval<T>; P]>,
        boxes: &[T],
        enclosures: &mut [T],
        verdicts: Option<&mut [Verdict]>,
    ) -> Result<(), Error> {
        let count = boxes.len() / (2 * V);
        check_length("boxes", 2 * V * count, boxes.len())?;
        check_length("enclosures", 2 * O * count, enclosures.len())?;
        let verdicts = verdict_pointer(count * O, verdicts)?;
        // SAFETY: the slices have the lengths that the kernel takes for `count` boxes.
        unsafe { (self.columns)(boxes.as_ptr(), pointer(parameters), enclosures.as_mut_ptr(), verdicts, count) };
        Ok(())
    }
}

/// A kernel at points of `V` variables with `P` parameters and `O` outputs.
#[derive(Debug, Clone, Copy)]
pub struct Points<T, const V: usize, const P: usize, const O: usize> {
    rows: RawPoints<T>,
    columns: RawPoints<T>,
}

impl<T: Real, const V: usize, const P: usize, const O: usize> Points<T, V, P, O> {
    /// The kernel behind two entry points.
    ///
    /// # Safety
    /// They are those of a kernel with these numbers of variables, parameters and outputs.
    pub const unsafe fn new(rows: RawPoints<T>, columns: RawPoints<T>) -> Self {
        Self { rows, columns }
    }

    /// The values at one point. Without parameters the defaults hold.
    #[inline]
    pub fn one(&self, parameters: Option<&[T; P]>, variables: [T; V]) -> [T; O] {
        let mut values = [T::ZERO; O];
        // SAFETY: the arrays have the lengths that the kernel takes for one point.
        unsafe { (self.rows)(variables.as_ptr(), pointer(parameters), values.as_mut_ptr(), 1) };
        values
    }

    /// The values at many points: `values` holds the `O` results of the first point, then those of the next.
    ///
    /// # Errors
    /// If the lengths do not agree.
    pub fn rows(&self, parameters: Option<&[T; P]>, points: &[[T; V]], values: &mut [T]) -> Result<(), Error> {
        check_length("values", points.len() * O, values.len())?;
        // SAFETY: the slices have the lengths that the kernel takes for so many points.
        unsafe { (self.rows)(points.as_ptr().cast(), pointer(parameters), values.as_mut_ptr(), points.len()) };
        Ok(())
    }

    /// The same with transposed arrays: the first variable of all points, then the next; likewise the values.
    ///
    /// # Errors
    /// If the lengths do not agree.
    pub fn columns(&self, parameters: Option<&[T; P]>, points: &[T], values: &mut [T]) -> Result<(), Error> {
        let count = points.len() / V;
        check_length("points", V * count, points.len())?;
        check_length("values", O * count, values.len())?;
        // SAFETY: the slices have the lengths that the kernel takes for `count` points.
        unsafe { (self.columns)(points.as_ptr(), pointer(parameters), values.as_mut_ptr(), count) };
        Ok(())
    }
}

/// Null for the defaults.
#[inline]
fn pointer<A, T, const P: usize>(parameters: Option<&[A; P]>) -> *const T {
    parameters.map_or(core::ptr::null(), |given| given.as_ptr().cast())
}

/// Null where nobody asks for verdicts.
#[inline]
fn verdict_pointer(expected: usize, verdicts: Option<&mut [Verdict]>) -> Result<*mut u32, Error> {
    let Some(verdicts) = verdicts else { return Ok(core::ptr::null_mut()) };
    check_length("verdicts", expected, verdicts.len())?;
    Ok(verdicts.as_mut_ptr().cast())
}

#[inline]
fn check_length(what: &'static str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Error::Length { what, expected, found }) }
}
