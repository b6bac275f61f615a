//! Every message of this layer, one constructor each, in the order of their codes.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Span;
use crate::diagnostic::code;

/// `name` means nothing here. Help is added by the caller, who knows the candidates.
pub(super) fn unknown_name(name: &str, span: Span, called: bool) -> Diagnostic {
    let what = if called { "function" } else { "name" };
    Diagnostic::error(code::UNKNOWN_NAME, format!("unknown {what} `{name}`")).at(span, "not defined")
}

/// A definition takes a name that the language has given a meaning; `meaning` completes "`name` is ...".
pub(super) fn reserved_name(name: &str, span: Span, meaning: &str) -> Diagnostic {
    Diagnostic::error(code::RESERVED_NAME, format!("`{name}` is {meaning} and cannot be redefined"))
        .at(span, "choose another name")
        .help(format!("for example `{name}1`; the parameters of a `fn` may have any name"))
}

pub(super) fn duplicate_name(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::error(code::DUPLICATE_NAME, format!("`{name}` is defined twice"))
        .at(span, "defined again here")
        .at(first, "first defined here")
}

/// Definitions that need each other in a circle; `function` if one of them is a `fn`.
pub(super) fn cycle(names: &[(String, Span)], function: bool) -> Diagnostic {
    let (first, span) = &names[0];
    let title = match (names.len(), function) {
        (1, true) => format!("`{first}` calls itself"),
        (1, false) => format!("`{first}` is defined by itself"),
        _ => {
            let list: Vec<String> = names.iter().map(|(name, _)| format!("`{name}`")).collect();
            format!("{} need each other in a circle", list.join(", "))
        }
    };
    let mut diagnostic = Diagnostic::error(code::CIRCLE, title).at(*span, "this definition needs itself");
    for (_, span) in &names[1..] {
        diagnostic = diagnostic.at(*span, "by way of this one");
    }
    if function {
        diagnostic = diagnostic.help("functions are inlined, so recursion has no end; write its steps out");
    }
    diagnostic
}

pub(super) fn ambiguous_name(name: &str, span: Span, first: Span, second: Span) -> Diagnostic {
    Diagnostic::error(code::AMBIGUOUS_NAME, format!("two imported files define `{name}`"))
        .at(span, "which of the two?")
        .at(first, "one definition")
        .at(second, "the other definition")
        .help("rename one, or define it in this file: own definitions come first")
}

pub(super) fn import_failed(path: &str, span: Span, reason: &str) -> Diagnostic {
    Diagnostic::error(code::CANNOT_IMPORT, format!("cannot import \"{path}\": {reason}")).at(span, "imported here")
}

/// A function that a caller could not give both values of one name.
pub(super) fn ambiguous_variable(title: String, span: Span) -> Diagnostic {
    Diagnostic::error(code::DUPLICATE_NAME, title).at(span, "both are used here")
}

pub(super) fn same_parameter(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::error(code::DUPLICATE_NAME, format!("parameter `{name}` is declared in two files"))
        .at(span, "declared here")
        .at(first, "and here")
        .help("a parameter is set by its name, so that each name can belong to one only; rename one of them")
}

/// `needs` says what stands in this place, e.g. "`+` needs numbers".
pub(super) fn wrong_kind(needs: &str, found: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::WRONG_KIND, format!("{needs}, found {found}")).at(span, format!("this is {found}"))
}

/// `takes` is e.g. "1 argument" or "at least 2 arguments".
pub(super) fn argument_count(name: &str, takes: &str, found: usize, span: Span, label: &str) -> Diagnostic {
    Diagnostic::error(code::WRONG_ARITY, format!("`{name}` takes {takes}, found {found}")).at(span, label)
}

pub(super) fn unknown_argument(function: &str, name: &str, span: Span, known: &str) -> Diagnostic {
    Diagnostic::error(code::BAD_ARGUMENT, format!("`{function}` has no argument `{name}`"))
        .at(span, "unknown argument")
        .help(format!("arguments of `{function}`: {known}"))
}

pub(super) fn argument_twice(function: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::BAD_ARGUMENT, format!("argument `{name}` of `{function}` is given twice"))
        .at(span, "given again here")
}

pub(super) fn positional_after_named(function: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::BAD_ARGUMENT, format!("an argument of `{function}` without name follows one with a name"))
        .at(span, "move it to the front or name it")
}

/// A shape that is used in a formula although only a part of it is drawn.
pub(super) fn conditional_shape(name: &str, span: Span, definition: Span) -> Diagnostic {
    Diagnostic::error(code::WRONG_KIND, format!("`{name}` has a `where` and cannot be used in a formula"))
        .at(span, "used here")
        .at(definition, "kept in part only")
        .help("give its formula a name with `let` and use that in both places")
}

/// An equation (or `!=`) where an inside is needed.
pub(super) fn equation_as_solid(span: Span) -> Diagnostic {
    Diagnostic::error(code::EQUATION_AS_SOLID, "an equation has no inside, so it cannot be a solid")
        .at(span, "this holds on a boundary only")
        .help("write `<=` to mean the inside, as in `x^2 + y^2 + z^2 <= 1`")
}

/// `1/a(b)` where `a` turns out to be a number.
pub(super) fn ambiguous_division(callee: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::AMBIGUOUS_DIVISION, "unclear how far this division reaches")
        .at(span, format!("`{callee}` is a number, so this is a product after `/`"))
        .help(format!("write `/ ({callee} * (...))` to divide by the product"))
        .help(format!("write `/ {callee} * (...)` to divide by `{callee}` alone"))
}

pub(super) fn exponent_too_large(exponent: &str, span: Span, help: &str) -> Diagnostic {
    Diagnostic::error(code::EXPONENT_TOO_LARGE, format!("the exponent {exponent} is too large"))
        .at(span, "exact powers go up to 10000")
        .help(help)
}

/// `name(…)` with a number of arguments that fits neither a product nor a point.
pub(super) fn not_a_function(name: &str, kind: &str, found: usize, span: Span) -> Diagnostic {
    let plural = if found == 1 { "" } else { "s" };
    Diagnostic::error(code::NOT_A_FUNCTION, format!("`{name}` is {kind}, not a function of {found} argument{plural}"))
        .at(span, "called here")
}

pub(super) fn derivative_by(span: Span) -> Diagnostic {
    Diagnostic::error(code::DERIVATIVE_BY, "a derivative is taken by a variable")
        .at(span, "not a variable")
        .help("variables are the coordinates x, y, z, the time t and parameters")
}

pub(super) fn lengths_differ(left: usize, right: usize, span: Span) -> Diagnostic {
    Diagnostic::error(code::LIST_LENGTH, format!("lists of {left} and {right} numbers do not fit together"))
        .at(span, "combined here")
}

pub(super) fn component_index(length: usize, span: Span) -> Diagnostic {
    Diagnostic::error(code::LIST_LENGTH, format!("a component is numbered 1 to {length} here"))
        .at(span, "not such a number")
        .help("the number must be written out or a constant")
}

pub(super) fn too_much_expansion(span: Span) -> Diagnostic {
    Diagnostic::error(
        code::TOO_MUCH_EXPANSION,
        "this formula grows too large when its functions and lists are written out",
    )
    .at(span, "given up here")
    .help("functions that call functions several times multiply; name a shared part with `let`")
}

pub(super) fn too_much_text(path: &str, span: Span, allowed: usize) -> Diagnostic {
    let title = format!("with `{path}` there is more text than allowed: {} KiB in all", allowed >> 10);
    Diagnostic::error(code::FILE_TOO_LARGE, title).at(span, "not read")
}

pub(super) fn too_many_parameters(name: &str, found: usize, allowed: usize, span: Span) -> Diagnostic {
    let title = format!("`{name}` has {found} parameters, and {allowed} are allowed");
    Diagnostic::error(code::LARGER_THAN_ALLOWED, title).at(span, "").help("a list can hold many numbers")
}

pub(super) fn too_deep(span: Span) -> Diagnostic {
    Diagnostic::error(code::TOO_DEEP, "calls and brackets nest too deeply").at(span, "given up here")
}

/// `needs` is e.g. "the end of a range".
pub(super) fn not_constant(needs: &str, span: Span, depends_on: &str) -> Diagnostic {
    Diagnostic::error(code::NOT_CONSTANT, format!("{needs} must be a constant"))
        .at(span, format!("depends on `{depends_on}`"))
}

pub(super) fn not_finite(needs: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::NOT_FINITE, format!("{needs} must be a finite number")).at(span, "has no finite value")
}

pub(super) fn empty_range(lo: f64, hi: f64, span: Span) -> Diagnostic {
    Diagnostic::error(code::EMPTY_RANGE, format!("the range from {lo} to {hi} is empty"))
        .at(span, "the first end must be less than the second")
}

pub(super) fn unknown_setting_value(title: String, span: Span) -> Diagnostic {
    Diagnostic::error(code::BAD_SETTING, title).at(span, "this value")
}

pub(super) fn out_of_range(what: &str, found: f64, range: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::OUT_OF_RANGE, format!("{what} is {found}, which is not {range}")).at(span, "out of range")
}

pub(super) fn set_twice(what: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::error(code::SET_TWICE, format!("{what} is set twice"))
        .at(span, "set again here")
        .at(first, "first set here")
}

pub(super) fn light_and_none(span: Span, first: Span) -> Diagnostic {
    Diagnostic::error(code::SET_TWICE, "light(\"none\") and another light contradict each other")
        .at(span, "this one")
        .at(first, "and this one")
}

pub(super) fn dimension(title: &str, span: Span, label: &str, help: &str) -> Diagnostic {
    Diagnostic::error(code::DIMENSION, title).at(span, label).help(help)
}

/// A statement that is neither an equation nor a region; `kind` is what it is.
pub(super) fn not_a_shape(kind: &str, span: Span, help: &str) -> Diagnostic {
    Diagnostic::error(code::NOT_A_SHAPE, format!("a shape is an equation or a region, found {kind}"))
        .at(span, format!("this is {kind}"))
        .help(help)
}

pub(super) fn no_coordinate(span: Span) -> Diagnostic {
    Diagnostic::error(code::NO_COORDINATE, "this shape contains no coordinate")
        .at(span, "the same everywhere")
        .help("a shape is a relation between x, y and z; to define a name write `let NAME = ...`")
}

pub(super) fn nothing_to_draw(empty: bool, span: Span) -> Diagnostic {
    let title = if empty { "the file is empty" } else { "the file describes no shape" };
    Diagnostic::error(code::NO_SHAPE, title)
        .at(span, "nothing to draw")
        .help("write an equation, for example `x^2 + y^2 + z^2 = 1`, or a region such as `sphere(1)`")
}

/// A value given from outside the file; it has no place in it unless the parameter has.
pub(super) fn override_failed(title: String, span: Option<Span>, help: Option<String>) -> Diagnostic {
    let mut diagnostic = Diagnostic::error(code::BAD_OVERRIDE, title);
    if let Some(span) = span {
        diagnostic = diagnostic.at(span, "the parameter");
    }
    match help {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

/// In `imp eval`: a coordinate that the expression depends on has no value.
pub(super) fn no_value(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::NO_VALUE, format!("`{name}` has no value"))
        .at(span, format!("depends on `{name}`"))
        .help(format!("give it one: `{name}=0.5` or a range `{name}=[0, 1]`"))
}
