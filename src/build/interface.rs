//! What an object offers to the programs that link it, as plain data: from it the header and the Rust text are written,
//! without a look at any formula.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::build::names;
use crate::derive::Arithmetic;
use crate::derive::Precision;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Interval;

/// A kernel that can be made of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kernel {
    /// Values at points.
    Value,
    /// Values and partial derivatives at points.
    Gradient,
    /// Enclosures over boxes.
    Interval,
    /// Enclosures of values and partial derivatives over boxes.
    IntervalGradient,
    /// Enclosures over boxes with affine forms.
    Affine,
    /// The same of partial derivatives too.
    AffineGradient,
}

impl Kernel {
    /// Every kernel, in the order in which they are written.
    pub const ALL: &[Kernel] = &[
        Kernel::Value,
        Kernel::Gradient,
        Kernel::Interval,
        Kernel::IntervalGradient,
        Kernel::Affine,
        Kernel::AffineGradient,
    ];

    /// What is made where nothing else is asked for.
    pub const USUAL: &[Kernel] = &[Kernel::Value, Kernel::Gradient, Kernel::Interval, Kernel::IntervalGradient];

    /// The last part of its symbol.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Value => "value",
            Kernel::Gradient => "gradient",
            Kernel::Interval => "interval",
            Kernel::IntervalGradient => "interval_gradient",
            Kernel::Affine => "affine",
            Kernel::AffineGradient => "affine_gradient",
        }
    }

    /// Whether it computes at points rather than over boxes.
    pub fn at_points(self) -> bool {
        self.arithmetic() == Arithmetic::Point
    }

    /// Whether partial derivatives are among its outputs.
    pub fn has_gradient(self) -> bool {
        matches!(self, Kernel::Gradient | Kernel::IntervalGradient | Kernel::AffineGradient)
    }

    /// What it computes on.
    pub fn arithmetic(self) -> Arithmetic {
        match self {
            Kernel::Value | Kernel::Gradient => Arithmetic::Point,
            Kernel::Interval | Kernel::IntervalGradient => Arithmetic::Interval,
            Kernel::Affine | Kernel::AffineGradient => Arithmetic::Affine,
        }
    }
}

/// All that one object offers.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The name of the file with the formulas, without its folder.
    pub file: String,
    /// What all symbols begin with.
    pub module: String,
    pub precision: Precision,
    pub kernels: Vec<Kernel>,
    pub functions: Vec<Exported>,
}

/// One function and its kernels, which are the same for all functions of an object.
#[derive(Debug, Clone)]
pub struct Exported {
    pub name: Name,
    /// The definition as it is written, possibly of several lines.
    pub formula: String,
    pub variables: Vec<Name>,
    /// What the values are called: the function's name, or `f[1]`, `f[2]` if it is a list.
    pub values: Vec<String>,
    pub parameters: Vec<Parameter>,
}

/// A name as it is written in Imp and as an identifier.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    pub written: String,
    pub identifier: String,
}

impl Name {
    pub fn new(written: &str) -> Self {
        Self { written: written.to_owned(), identifier: names::identifier(written) }
    }
}

/// A parameter; its numbers are those of the interface's precision.
#[derive(Debug, Clone)]
pub struct Parameter {
    pub name: Name,
    /// Encloses the default.
    pub value: Interval,
    /// The default at points.
    pub point: f64,
    /// Kernels hold for parameters inside this alone; all reals if none was declared.
    pub range: Interval,
}

impl Parameter {
    /// The default, and where it may lie, as a user reads it.
    pub fn describe(&self) -> String {
        let value = match self.value.lo() == self.value.hi() {
            true => self.value.lo().to_string(),
            false => format!("in {}", self.value),
        };
        match self.range == Interval::ENTIRE {
            true => format!("{value} unless given; any number"),
            false => format!("{value} unless given; inside {}", self.range),
        }
    }
}

impl Exported {
    /// What a kernel computes, in order: each value, followed by its partial derivatives if they are asked for.
    pub fn outputs(&self, kernel: Kernel) -> Vec<String> {
        let mut outputs = Vec::new();
        for value in &self.values {
            outputs.push(value.clone());
            if kernel.has_gradient() {
                outputs.extend(self.variables.iter().map(|variable| format!("d{value}/d{}", variable.written)));
            }
        }
        outputs
    }
}

impl Interface {
    /// What the symbols of one function begin with.
    pub fn prefix(&self, function: &Exported) -> String {
        format!("{}_{}", self.module, function.name.identifier)
    }

    /// The symbol of one kernel.
    pub fn symbol(&self, function: &Exported, kernel: Kernel) -> String {
        format!("{}_{}", self.prefix(function), kernel.name())
    }

    /// The data symbol whose name holds the version of the binary interface and a fingerprint of this one: programs that
    /// were compiled against another interface do not link.
    pub fn abi_symbol(&self) -> String {
        format!("{}_abi_{}_{:016x}", self.module, imp_runtime::ABI_VERSION, self.fingerprint())
    }

    /// A hash (FNV-1a, 64 bits) of everything on which a caller relies: names, order, counts, precision, kernels, and the
    /// defaults and ranges of parameters.
    pub fn fingerprint(&self) -> u64 {
        let mut text = format!("{} {:?}", self.module, self.precision);
        // Writing to a string cannot fail.
        for kernel in &self.kernels {
            let _ = write!(text, " {}", kernel.name());
        }
        for function in &self.functions {
            let _ = write!(text, "\n{}:", function.name.written);
            for variable in &function.variables {
                let _ = write!(text, " {}", variable.written);
            }
            let _ = write!(text, " ->");
            for value in &function.values {
                let _ = write!(text, " {value}");
            }
            for Parameter { name, value, point, range } in &function.parameters {
                let ends = [value.lo(), value.hi(), *point, range.lo(), range.hi()].map(f64::to_bits);
                let _ = write!(text, "\n  {} {ends:x?}", name.written);
            }
        }
        text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
    }

    /// Checks that no two things share a name.
    ///
    /// # Errors
    /// Which do, and what to do.
    pub fn check_names(&self) -> Result<(), Diagnostic> {
        let mut symbols: BTreeMap<String, String> = BTreeMap::new();
        symbols.insert(format!("{}_level", self.module), "the module's own `level`".to_owned());
        for function in &self.functions {
            let about = format!("`{}`", function.name.written);
            let mut taken = vec![("PARAMETERS", ""), ("VARIABLES", ""), ("VALUES", "")];
            taken.extend(["DEFAULTS", "defaults", "in_range"].map(|part| (part, "")));
            for kernel in &self.kernels {
                taken.extend(["", "_columns", "_packets", "_at", "_OUTPUTS"].map(|end| (kernel.name(), end)));
            }
            for (part, end) in taken {
                let symbol = format!("{}_{part}{end}", self.prefix(function));
                match symbols.insert(symbol.clone(), about.clone()) {
                    Some(other) => return Err(collision(&symbol, &other, &about)),
                    None => continue,
                }
            }
            let mut fields: BTreeMap<String, &str> = BTreeMap::new();
            for name in function.parameters.iter().map(|parameter| &parameter.name) {
                let field = names::in_rust(&name.identifier);
                if let Some(other) = fields.insert(field.clone(), &name.written) {
                    return Err(collision(&field, &format!("`{other}`"), &format!("`{}`", name.written)));
                }
            }
            let mut modules: BTreeMap<String, String> = BTreeMap::new();
            for name in function.variables.iter().chain(function.parameters.iter().map(|p| &p.name)) {
                let about = format!("`{}`", name.written);
                let spelled = names::in_c(&name.identifier);
                if let Some(other) = modules.insert(spelled.clone(), about.clone()) {
                    return Err(collision(&spelled, &other, &about));
                }
            }
        }
        let mut modules: BTreeMap<String, &str> = BTreeMap::new();
        for function in &self.functions {
            let module = names::in_rust(&function.name.identifier);
            if let Some(other) = modules.insert(module.clone(), &function.name.written) {
                return Err(collision(&module, &format!("`{other}`"), &format!("`{}`", function.name.written)));
            }
        }
        Ok(())
    }
}

fn collision(name: &str, one: &str, other: &str) -> Diagnostic {
    let title = format!("{one} and {other} would both be called `{name}` in C and Rust");
    Diagnostic::error(code::BAD_OPTION, title)
        .help("rename one of them, or export only one of them: `--functions NAME,NAME`")
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// An interface with two functions, one of them a list with a parameter.
    pub fn sample(precision: Precision) -> Interface {
        let parameter = Parameter {
            name: Name::new("a"),
            value: Interval::point(1.0),
            point: 1.0,
            range: Interval::new(0.0, 2.0).unwrap(),
        };
        let names = |list: &[&str]| list.iter().map(|name| Name::new(name)).collect();
        Interface {
            file: "sample.imp".to_owned(),
            module: "sample".to_owned(),
            precision,
            kernels: Kernel::ALL.to_vec(),
            functions: vec![
                Exported {
                    name: Name::new("f"),
                    formula: "fn f(x, double) = x^2 + double".to_owned(),
                    variables: names(&["x", "double"]),
                    values: vec!["f".to_owned()],
                    parameters: vec![],
                },
                Exported {
                    name: Name::new("move"),
                    formula: "fn move(t) = [a cos(t), a sin(t)]".to_owned(),
                    variables: names(&["t"]),
                    values: vec!["move[1]".to_owned(), "move[2]".to_owned()],
                    parameters: vec![parameter],
                },
            ],
        }
    }

    #[test]
    fn the_fingerprint_covers_what_callers_rely_on() {
        let first = sample(Precision::Double);
        first.check_names().unwrap();
        let mut others = vec![sample(Precision::Single)];
        let changes: [fn(&mut Interface); 5] = [
            |i| i.functions.swap(0, 1),
            |i| i.functions[0].variables.swap(0, 1),
            |i| i.kernels.truncate(1),
            |i| i.functions[1].parameters[0].range = Interval::new(0.0, 3.0).unwrap(),
            |i| i.functions[1].values.truncate(1),
        ];
        for change in changes {
            let mut other = sample(Precision::Double);
            change(&mut other);
            others.push(other);
        }
        for other in others {
            assert_ne!(other.abi_symbol(), first.abi_symbol());
        }
        let mut formula = sample(Precision::Double);
        formula.functions[0].formula.clear();
        assert_eq!(formula.abi_symbol(), first.abi_symbol());
    }

    #[test]
    fn names_that_collide_are_refused() {
        let renamed = |name: &str| {
            let mut interface = sample(Precision::Double);
            interface.functions[1].name = Name::new(name);
            interface.check_names()
        };
        assert!(renamed("g").is_ok());
        // f_interval has a kernel `gradient`, f a kernel `interval_gradient`.
        for name in ["f", "f_interval"] {
            assert!(renamed(name).unwrap_err().title.contains("both"), "{name}");
        }
        let mut interface = sample(Precision::Double);
        interface.functions[0].variables = vec![Name::new("φ"), Name::new("phi")];
        assert!(interface.check_names().is_err());
    }
}
