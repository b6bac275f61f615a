//! Language rule 5: what `name(args)` is. A call if the name is a function; a field at another point if there are as
//! many arguments as coordinates; else, with one argument, a product.

use std::collections::HashMap;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Span;
use crate::diagnostic::did_you_mean;
use crate::graph::Op;
use crate::graph::Value;
use crate::syntax::ast::Argument;
use crate::syntax::ast::Name;
use crate::syntax::ast::StatementKind;

use super::builtins::Builtin;
use super::builtins::Lowering;
use super::errors;
use super::lower::Lowerer;
use super::lower::as_truth;
use super::scene::COORDINATES;
use super::values::Equation;
use super::values::Function;
use super::values::ItemId;
use super::values::Meaning;
use super::values::Truth;

/// An argument with the place where it is written.
type Argued = (Meaning, Span);

impl Lowerer<'_> {
    pub fn apply(&mut self, callee: &Name, args: &[Argument], span: Span) -> Meaning {
        let meaning = self.name(&callee.text);
        if let Meaning::Function(function) = meaning {
            return self.call(function, callee, args, span);
        }
        let lowered: Vec<Argued> = args.iter().map(|a| (self.lower(&a.value), a.value.span)).collect();
        if matches!(meaning, Meaning::Invalid) {
            return Meaning::Invalid;
        }
        if let Some(name) = args.iter().find_map(|argument| argument.name.as_ref()) {
            let diagnostic = errors::not_a_function(&callee.text, meaning.kind(), args.len(), callee.span);
            self.report(diagnostic.at(name.span, "only functions have named arguments"));
            return Meaning::Invalid;
        }
        match (&lowered[..], &meaning) {
            ([argument], Meaning::Scalar(_) | Meaning::Vector(_)) => {
                self.arithmetic(Op::Mul, (meaning, callee.span), argument.clone())
            }
            (
                [_, _] | [_, _, _],
                Meaning::Scalar(_) | Meaning::Vector(_) | Meaning::Truth(_) | Meaning::Equation(_),
            ) => self.field_at(callee, meaning, &lowered, span),
            _ => {
                let diagnostic = errors::not_a_function(&callee.text, meaning.kind(), args.len(), callee.span);
                let help = format!("`{0}(x, y, z)` is `{0}` at another point, in the plane `{0}(x, y)`", callee.text);
                self.report(diagnostic.help(help));
                Meaning::Invalid
            }
        }
    }

    /// A field at another point: the coordinates replaced by the arguments, all at once.
    fn field_at(&mut self, callee: &Name, field: Meaning, point: &[Argued], span: Span) -> Meaning {
        let mut replace = HashMap::new();
        for ((meaning, span), name) in point.iter().zip(COORDINATES) {
            let Some(value) = self.scalar("a point's coordinates are numbers", meaning, *span) else {
                return Meaning::Invalid;
            };
            replace.insert(self.graph.var(name), value);
        }
        let roots: Vec<Value> = match &field {
            Meaning::Scalar(value) => vec![*value],
            Meaning::Vector(values) => values.to_vec(),
            Meaning::Truth(truth) => [truth.value].into_iter().chain(truth.solid).collect(),
            Meaning::Equation(equation) => vec![equation.difference, equation.truth],
            Meaning::Text(_) | Meaning::Function(_) | Meaning::Invalid => return Meaning::Invalid,
        };
        let Some((image, depends)) = self.substitute(&roots, &replace, span) else { return Meaning::Invalid };
        if !depends && self.is_definition(&callee.text) {
            let diagnostic = errors::not_a_function(&callee.text, "a number", point.len(), callee.span);
            self.report(diagnostic.help(format!("`{}` contains no coordinate that could be replaced", callee.text)));
            return Meaning::Invalid;
        }
        match field {
            Meaning::Scalar(_) => Meaning::Scalar(image[0]),
            Meaning::Vector(_) => Meaning::Vector(image.into()),
            Meaning::Truth(truth) => Meaning::Truth(Truth { value: image[0], solid: truth.solid.map(|_| image[1]) }),
            Meaning::Equation(equation) => {
                Meaning::Equation(Equation { difference: image[0], truth: image[1], span: equation.span })
            }
            other => other,
        }
    }

    /// The values with inputs replaced, and whether any input was there. As `Graph::substitute`, at a cost proportional
    /// to what is copied and not to the whole graph: a scene of thousands of moved parts copies each part once.
    fn substitute(
        &mut self,
        roots: &[Value],
        replace: &HashMap<Value, Value>,
        span: Span,
    ) -> Option<(Vec<Value>, bool)> {
        let mut image: HashMap<Value, Value> = HashMap::new();
        let mut depends = false;
        let mut stack = roots.to_vec();
        while let Some(&value) = stack.last() {
            if image.contains_key(&value) {
                stack.pop();
                continue;
            }
            if let Some(&replacement) = replace.get(&value) {
                image.insert(value, replacement);
                depends = true;
                stack.pop();
                continue;
            }
            let node = *self.graph.node(value);
            let before = stack.len();
            stack.extend(node.operands().iter().filter(|operand| !image.contains_key(operand)));
            if stack.len() == before {
                if !self.spend(1, span) {
                    return None;
                }
                let operands: Vec<Value> = node.operands().iter().map(|operand| image[operand]).collect();
                let copy = self.graph.push(node.op, &operands);
                image.insert(value, copy);
                stack.pop();
            }
        }
        Some((roots.iter().map(|root| image[root]).collect(), depends))
    }

    fn call(&mut self, function: Function, callee: &Name, args: &[Argument], span: Span) -> Meaning {
        match function {
            Function::Builtin(builtin) => {
                let required: Vec<(&str, bool)> = builtin.parameters.iter().map(|&name| (name, true)).collect();
                let Some(slots) = self.bind(callee, args, &required, builtin.variadic) else { return Meaning::Invalid };
                let args: Vec<Argued> = slots.into_iter().flatten().collect();
                if args.iter().any(|(meaning, _)| matches!(meaning, Meaning::Invalid)) {
                    return Meaning::Invalid;
                }
                self.call_builtin(builtin, &args, span)
            }
            Function::Defined(id) => self.call_defined(id, callee, args, span),
        }
    }

    fn call_defined(&mut self, id: ItemId, callee: &Name, args: &[Argument], span: Span) -> Meaning {
        let program = self.program;
        let item = &program.items[id.0];
        let StatementKind::Fn { params, body, .. } = &program.statement(id).kind else { return Meaning::Invalid };
        let signature: Vec<(&str, bool)> =
            params.iter().map(|param| (param.name.text.as_str(), param.default.is_none())).collect();
        let Some(slots) = self.bind(callee, args, &signature, false) else { return Meaning::Invalid };
        let mut locals: Vec<(String, Meaning)> = Vec::with_capacity(params.len());
        let call = || (item.name.text.clone(), span);
        for (param, slot) in params.iter().zip(slots) {
            let meaning = match (slot, &param.default) {
                (Some((meaning, _)), _) => meaning,
                // A default may use the parameters before it.
                (None, Some(default)) => self.in_frame(item.file, &mut locals, call(), default),
                (None, None) => Meaning::Invalid,
            };
            if matches!(meaning, Meaning::Invalid) {
                return Meaning::Invalid;
            }
            locals.push((param.name.text.clone(), meaning));
        }
        self.in_frame(item.file, &mut locals, call(), body)
    }

    /// Arguments in the places of their parameters, of which those marked `true` are required. Further arguments of a
    /// variadic function follow; one list may stand for all of its arguments.
    fn bind(
        &mut self,
        callee: &Name,
        args: &[Argument],
        parameters: &[(&str, bool)],
        variadic: bool,
    ) -> Option<Vec<Option<Argued>>> {
        let function = &callee.text;
        let mut slots: Vec<Option<Argued>> = vec![None; parameters.len()];
        let mut named = false;
        let mut good = true;
        for (position, argument) in args.iter().enumerate() {
            let argued = (self.lower(&argument.value), argument.value.span);
            let fault = match &argument.name {
                Some(name) => {
                    named = true;
                    match parameters.iter().position(|(parameter, _)| *parameter == name.text) {
                        Some(place) if slots[place].is_none() => {
                            slots[place] = Some(argued);
                            continue;
                        }
                        Some(_) => errors::argument_twice(function, &name.text, name.span),
                        None => unknown_argument(function, name, parameters),
                    }
                }
                None if named => errors::positional_after_named(function, argument.value.span),
                None if position < slots.len() => {
                    slots[position] = Some(argued);
                    continue;
                }
                None if variadic => {
                    slots.push(Some(argued));
                    continue;
                }
                // Said once for all that are too many.
                None if position > slots.len() => continue,
                None => {
                    let takes = counted(parameters, variadic);
                    errors::argument_count(function, &takes, args.len(), argument.value.span, "one argument too many")
                }
            };
            self.report(fault);
            good = false;
        }
        if variadic && matches!(&slots[..], [Some((Meaning::Vector(_), _)), None]) {
            slots.truncate(1);
        }
        let absent = parameters.iter().zip(&slots).filter(|((_, required), slot)| *required && slot.is_none());
        let missing: Vec<String> = absent.map(|((name, _), _)| format!("`{name}`")).collect();
        if good && !missing.is_empty() {
            let label = format!("{} missing", missing.join(", "));
            let takes = counted(parameters, variadic);
            self.report(errors::argument_count(function, &takes, args.len(), callee.span, &label));
            good = false;
        }
        good.then_some(slots)
    }

    fn call_builtin(&mut self, builtin: &'static Builtin, args: &[Argued], span: Span) -> Meaning {
        let needs = |what: &str| format!("`{}` needs {what}", builtin.name);
        match builtin.meaning {
            Lowering::Op(op) => match self.scalars(&needs("numbers"), args) {
                Some(values) => Meaning::Scalar(self.graph.push(op, &values)),
                None => Meaning::Invalid,
            },
            Lowering::Fold(op) => {
                let values = match args {
                    [(Meaning::Vector(values), _)] if !values.is_empty() => Some(values.to_vec()),
                    _ => self.scalars(&needs("numbers"), args),
                };
                values.map_or(Meaning::Invalid, |values| Meaning::Scalar(self.balanced(op, values)))
            }
            Lowering::Power => self.power(&args[0].0, args[0].1, &args[1].0, args[1].1),
            Lowering::Derivative => self.derivative(&args[0], &args[1]),
            Lowering::Component => self.component(&args[0], &args[1]),
            Lowering::Length => match &args[0] {
                (Meaning::Vector(values), _) => Meaning::Scalar(self.length(values)),
                (other, span) => {
                    self.report_kind(&needs("a list"), other, *span);
                    Meaning::Invalid
                }
            },
            Lowering::Dot => match self.two_lists(builtin, args, span) {
                Some((a, b)) => Meaning::Scalar(self.dot(&a, &b)),
                None => Meaning::Invalid,
            },
            Lowering::Cross => match self.two_lists(builtin, args, span) {
                Some((a, b)) if a.len() == 3 => self.cross(&a, &b),
                Some((a, _)) => {
                    let found = format!("lists of {}", a.len());
                    self.report(errors::wrong_kind(&needs("lists of three numbers"), &found, span));
                    Meaning::Invalid
                }
                None => Meaning::Invalid,
            },
            Lowering::Field => match &args[0] {
                (Meaning::Scalar(value), _) => Meaning::Scalar(*value),
                (Meaning::Equation(equation), _) => Meaning::Scalar(equation.difference),
                (Meaning::Truth(Truth { solid: Ok(field), .. }), _) => Meaning::Scalar(*field),
                (Meaning::Truth(Truth { solid: Err(blame), .. }), _) => {
                    self.report(errors::equation_as_solid(*blame));
                    Meaning::Invalid
                }
                (other, span) => {
                    self.report_kind(&needs("a shape"), other, *span);
                    Meaning::Invalid
                }
            },
            Lowering::Union | Lowering::Intersect | Lowering::Difference => self.solids(builtin, args),
        }
    }

    /// Union, intersection and difference of regions.
    fn solids(&mut self, builtin: &'static Builtin, args: &[Argued]) -> Meaning {
        let needs = format!("`{}` needs regions", builtin.name);
        let mut parts = Vec::with_capacity(args.len());
        for (meaning, span) in args {
            match as_truth(meaning) {
                Some(Truth { solid: Err(blame), .. }) => {
                    let mut diagnostic = errors::equation_as_solid(*span);
                    if blame != *span {
                        diagnostic = diagnostic.at(blame, "because of this equation");
                    }
                    self.report(diagnostic);
                }
                Some(truth) => parts.push(truth),
                None if matches!(meaning, Meaning::Scalar(_)) => {
                    let diagnostic = errors::wrong_kind(&needs, meaning.kind(), *span);
                    self.report(diagnostic.help("write `... <= 0` to mean where it is at most 0"));
                }
                None => self.report_kind(&needs, meaning, *span),
            }
        }
        if parts.len() < args.len() {
            return Meaning::Invalid;
        }
        Meaning::Truth(match builtin.meaning {
            Lowering::Union => self.or(&parts),
            Lowering::Difference => {
                for part in &mut parts[1..] {
                    *part = self.not(*part);
                }
                self.and(&parts)
            }
            _ => self.and(&parts),
        })
    }

    fn scalars(&mut self, needs: &str, args: &[Argued]) -> Option<Vec<Value>> {
        let values: Vec<Value> = args.iter().filter_map(|(meaning, span)| self.scalar(needs, meaning, *span)).collect();
        (values.len() == args.len()).then_some(values)
    }

    fn two_lists(&mut self, builtin: &Builtin, args: &[Argued], span: Span) -> Option<(Vec<Value>, Vec<Value>)> {
        let mut lists = Vec::with_capacity(2);
        for (meaning, span) in args {
            match meaning {
                Meaning::Vector(values) => lists.push(values.to_vec()),
                other => self.report_kind(&format!("`{}` needs lists", builtin.name), other, *span),
            }
        }
        let second = lists.pop()?;
        let first = lists.pop()?;
        if first.len() != second.len() {
            self.report(errors::lengths_differ(first.len(), second.len(), span));
            return None;
        }
        Some((first, second))
    }

    fn cross(&mut self, a: &[Value], b: &[Value]) -> Meaning {
        let mut minor = |i: usize, j: usize| {
            let (left, right) = (self.graph.mul(a[i], b[j]), self.graph.mul(a[j], b[i]));
            self.graph.sub(left, right)
        };
        Meaning::Vector([minor(1, 2), minor(2, 0), minor(0, 1)].into())
    }

    fn derivative(&mut self, (f, f_span): &Argued, (by, by_span): &Argued) -> Meaning {
        let f = self.scalar("`deriv` needs a number", f, *f_span);
        let by = self.scalar("`deriv` needs a variable", by, *by_span);
        let (Some(f), Some(by)) = (f, by) else { return Meaning::Invalid };
        if !matches!(self.graph.node(by).op, Op::Var(_)) {
            self.report(errors::derivative_by(*by_span));
            return Meaning::Invalid;
        }
        let before = self.graph.len();
        let derivative = match (self.differentiate)(&mut self.graph, f, by, self.budget) {
            Ok(derivative) => derivative,
            Err(exceeded) => {
                self.give_up(Diagnostic::from(exceeded).at(*f_span, "of the derivatives of this"));
                return Meaning::Invalid;
            }
        };
        // Derivatives of derivatives grow with every order.
        if !self.spend(self.graph.len() - before, *f_span) {
            return Meaning::Invalid;
        }
        Meaning::Scalar(derivative)
    }

    /// A number stands for the list of three equal ones, and a list of two lies in the plane z = 0, so that functions of
    /// space also take plane vectors and uniform factors.
    fn component(&mut self, (list, list_span): &Argued, (index, index_span): &Argued) -> Meaning {
        let length = match list {
            Meaning::Vector(values) => values.len().max(3),
            Meaning::Scalar(_) => 3,
            other => {
                self.report_kind("`component` needs a list", other, *list_span);
                return Meaning::Invalid;
            }
        };
        let Some(index) = self.scalar("`component` needs a number", index, *index_span) else {
            return Meaning::Invalid;
        };
        let exact = self.exact.rational(&self.graph, index).filter(|number| number.is_integer());
        let place = exact.and_then(|number| usize::try_from(number.to_integer()).ok());
        let Some(place) = place.filter(|place| (1..=length).contains(place)) else {
            self.report(errors::component_index(length, *index_span));
            return Meaning::Invalid;
        };
        Meaning::Scalar(match list {
            Meaning::Vector(values) => match values.get(place - 1) {
                Some(&value) => value,
                None => self.graph.int(0),
            },
            Meaning::Scalar(value) => *value,
            _ => return Meaning::Invalid,
        })
    }
}

fn unknown_argument(function: &str, name: &Name, parameters: &[(&str, bool)]) -> Diagnostic {
    let names: Vec<&str> = parameters.iter().map(|(name, _)| *name).collect();
    let diagnostic = errors::unknown_argument(function, &name.text, name.span, &names.join(", "));
    match did_you_mean(&name.text, names) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None => diagnostic,
    }
}

/// How many arguments a function takes, in words.
fn counted(parameters: &[(&str, bool)], variadic: bool) -> String {
    let least = parameters.iter().filter(|(_, required)| *required).count();
    match (least, parameters.len()) {
        (least, _) if variadic => format!("at least {least} arguments"),
        (0, 0) => "no arguments".to_owned(),
        (1, 1) => "1 argument".to_owned(),
        (least, most) if least == most => format!("{most} arguments"),
        (least, most) if most == least + 1 => format!("{least} or {most} arguments"),
        (least, most) => format!("{least} to {most} arguments"),
    }
}
