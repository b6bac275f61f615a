//! Functions of a file to kernels with symbols: what is compiled, and the description of it.

use std::path::Path;

use crate::build::archive::archive;
use crate::build::header::header;
use crate::build::interface::Exported;
use crate::build::interface::Interface;
use crate::build::interface::Kernel;
use crate::build::interface::Name;
use crate::build::interface::Parameter;
use crate::build::names;
use crate::build::rust;
use crate::codegen::object;
use crate::codegen::object::Kind;
use crate::codegen::object::Routine;
use crate::codegen::object::Target;
use crate::codegen::object::Unit;
use crate::derive::Precision;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Severity;
use crate::diagnostic::code;
use crate::interval::Interval;
use crate::kernel::Real;
use crate::library::Error;
use crate::library::Function;
use crate::library::Options;
use crate::library::Program;

/// What is made of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Names of functions; all functions of numbers if there are none.
    pub functions: Vec<String>,
    /// At least one.
    pub kernels: Vec<Kernel>,
    pub precision: Precision,
}

impl Default for Selection {
    /// Every function, with the usual kernels, in double precision.
    fn default() -> Self {
        Self { functions: Vec::new(), kernels: Kernel::USUAL.to_vec(), precision: Precision::Double }
    }
}

/// A file's functions, ready to be compiled for any target.
#[derive(Debug)]
pub struct Export {
    /// What the file is called as a module.
    name: String,
    interface: Interface,
    routines: Vec<Routine>,
    /// What was left out or renamed; their places are in the program's sources.
    pub notes: Vec<Diagnostic>,
}

impl Export {
    /// Selects functions of a program; `file` gives the module its name. Symbols begin with `scope`, which may be empty, and
    /// that name.
    ///
    /// # Errors
    /// If no function or no kernel is left, a function is not there or has a mistake, or two names become one.
    pub fn new(program: &Program, file: &Path, scope: &str, selection: &Selection) -> Result<Self, Error> {
        let mut notes = Vec::new();
        let functions = select(program, &selection.functions, &mut notes)?;
        let mut kernels = selection.kernels.clone();
        kernels.sort();
        kernels.dedup();
        if kernels.is_empty() {
            return Err(Diagnostic::error(code::BAD_OPTION, "no kernel is asked for").into());
        }
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let name = names::identifier(&stem);
        let exported = |function: &Function| exported(program, function, selection.precision);
        let interface = Interface {
            file: file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            module: if scope.is_empty() { name.clone() } else { names::identifier(&format!("{scope}_{name}")) },
            precision: selection.precision,
            kernels,
            functions: functions.iter().map(exported).collect(),
        };
        interface.check_names()?;
        notes.extend(interface.functions.iter().filter_map(renamed));

        let mut routines = Vec::new();
        for (function, exported) in functions.iter().zip(&interface.functions) {
            for &kernel in &interface.kernels {
                routines.push(routine(&interface, function, exported, kernel)?);
            }
        }
        Ok(Self { name, interface, routines, notes })
    }

    /// What the file is called as a module.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The bytes of an object.
    ///
    /// # Errors
    /// If a function is too large.
    pub fn object(&self, target: &Target) -> Result<Vec<u8>, Error> {
        let unit = Unit {
            module: self.interface.module.clone(),
            target: target.clone(),
            abi: self.interface.abi_symbol(),
            routines: self.routines.clone(),
        };
        Ok(object::emit(&unit)?)
    }

    /// The text of the C header.
    pub fn header(&self) -> String {
        header(&self.interface)
    }

    /// The text of a Rust file of its own.
    pub fn rust_file(&self) -> String {
        rust::file(&self.interface)
    }

    /// The text of a Rust module with the name of the file, beside which there is a module `imp_types`.
    pub fn rust_module(&self) -> String {
        rust::module(&self.name, &self.interface)
    }
}

/// The bytes of a static library with one object for each export.
///
/// # Errors
/// As [`Export::object`].
pub fn static_library(exports: &[Export], target: &Target) -> Result<Vec<u8>, Error> {
    let object = |export: &Export| Ok((export.name.clone(), export.object(target)?));
    let objects: Vec<(String, Vec<u8>)> = exports.iter().map(object).collect::<Result<_, Error>>()?;
    Ok(archive(&objects)?)
}

/// The functions with the given names, or all that can be exported.
fn select(program: &Program, names: &[String], notes: &mut Vec<Diagnostic>) -> Result<Vec<Function>, Error> {
    let mut functions = Vec::new();
    if names.is_empty() {
        for function in program.functions() {
            match function.variables().is_empty() {
                true => notes.push(constant(function, Severity::Warning)),
                false => functions.push(function.clone()),
            }
        }
        for refused in program.refused() {
            for diagnostic in refused.error.diagnostics() {
                let title = format!("`{}` is left out: {}", refused.name, diagnostic.title);
                notes.push(Diagnostic { severity: Severity::Warning, title, ..diagnostic.clone() });
            }
        }
    }
    for (i, name) in names.iter().enumerate() {
        let function = program.function(name)?;
        if function.variables().is_empty() {
            return Err(constant(&function, Severity::Error).into());
        }
        if !names[..i].contains(name) {
            functions.push(function);
        }
    }
    if functions.is_empty() {
        let title = "there is no function of numbers from which kernels could be made";
        let help = "define one: `fn f(x, y) = x^2 + y^2 - 1`";
        return Err(Diagnostic::error(code::BAD_OPTION, title).help(help).into());
    }
    Ok(functions)
}

fn constant(function: &Function, severity: Severity) -> Diagnostic {
    let title = format!("`{}` has no variables: it needs no kernel", function.name());
    Diagnostic { severity, ..Diagnostic::error(code::BAD_OPTION, title) }.at(function.span(), "always the same")
}

/// Says how a function is called whose name is a word of Rust or no identifier.
fn renamed(function: &Exported) -> Option<Diagnostic> {
    let Name { written, identifier } = &function.name;
    let rust = names::in_rust(identifier);
    let title = match () {
        _ if *identifier != *written => format!("`{written}` is called `{identifier}` in C and `{rust}` in Rust"),
        _ if rust != *identifier => format!("`{written}` is called `{rust}` in Rust, where `{written}` is a keyword"),
        _ => return None,
    };
    Some(Diagnostic::warning(code::BAD_OPTION, title))
}

fn exported(program: &Program, function: &Function, precision: Precision) -> Exported {
    let parameters = function.parameters().iter().map(|parameter| Parameter {
        name: Name::new(&parameter.name),
        value: fitted(parameter.value, precision),
        point: match precision {
            Precision::Single => f32::nearest(parameter.value.mid()).to_f64(),
            Precision::Double => parameter.value.mid(),
        },
        range: Function::range_in(parameter, precision),
    });
    Exported {
        name: Name::new(function.name()),
        formula: program.sources().text(function.span()).to_owned(),
        variables: function.variables().iter().map(|name| Name::new(name)).collect(),
        values: function.outputs().to_vec(),
        parameters: parameters.collect(),
    }
}

fn routine(interface: &Interface, function: &Function, exported: &Exported, kernel: Kernel) -> Result<Routine, Error> {
    let precision = interface.precision;
    let options = Options {
        affine: matches!(kernel, Kernel::Affine | Kernel::AffineGradient),
        gradient: kernel.has_gradient(),
        ..Options::default()
    };
    let spec = match kernel.at_points() {
        true => function.point_spec(&options, precision)?,
        false => function.box_spec(&options, precision)?,
    };
    let defaults = match kernel.at_points() {
        true => exported.parameters.iter().map(|parameter| parameter.point).collect(),
        false => exported.parameters.iter().flat_map(|p| [p.value.lo(), p.value.hi()]).collect(),
    };
    Ok(Routine {
        symbol: interface.symbol(exported, kernel),
        program: spec.lower(precision),
        rounding: spec.rounding,
        variables: exported.variables.len(),
        outputs: exported.outputs(kernel).len(),
        kind: if kernel.at_points() { Kind::Points } else { Kind::Boxes },
        defaults,
    })
}

/// The hull in a precision.
fn fitted(range: Interval, precision: Precision) -> Interval {
    match precision {
        Precision::Double => range,
        Precision::Single => {
            Interval::new(f32::down(range.lo()).to_f64(), f32::up(range.hi()).to_f64()).unwrap_or(Interval::ENTIRE)
        }
    }
}
