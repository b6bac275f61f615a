//! Which definitions every statement mentions: unknown names with what may have been meant, circles, and an order in which
//! definitions can be evaluated.

use std::collections::HashMap;
use std::collections::HashSet;
use std::rc::Rc;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::diagnostic::did_you_mean;
use crate::syntax::ast::Argument;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

use super::builtins;
use super::errors;
use super::names::Item;
use super::names::Lookup;
use super::names::Program;
use super::names::ProgramFile;
use super::settings;
use super::stdlib;
use super::values::ItemId;

/// Unknown names with a suggestion, which takes a look at every name there is.
const SUGGESTED: usize = 20;

/// Parameters of one function; they are looked through for every name in it.
const MAX_PARAMETERS: usize = 256;

impl Program {
    /// Checks the names in the main file and in everything that it reaches, and finds the order of evaluation.
    pub fn analyse(&mut self, sources: &mut SourceMap, diagnostics: &mut Vec<Diagnostic>) {
        let mut scan = Scan { sources, diagnostics, reported: HashSet::new(), introduced: HashMap::new() };
        let module = Rc::clone(&self.files[0].module);
        let mut needs: HashMap<ItemId, Vec<ItemId>> = HashMap::new();
        let mut open = Vec::new();
        for (index, statement) in module.statements.iter().enumerate() {
            match self.item_of(0, index) {
                Some(item) => open.push(item),
                None => open.extend(self.scan_statement(0, statement, &mut scan)),
            }
        }
        while let Some(item) = open.pop() {
            if needs.contains_key(&item) {
                continue;
            }
            let Item { file, statement, .. } = self.items[item.0];
            let module = Rc::clone(&self.files[file].module);
            let statement = &module.statements[statement];
            if let StatementKind::Fn { name, params, .. } = &statement.kind
                && params.len() > MAX_PARAMETERS
            {
                scan.diagnostics.push(errors::too_many_parameters(&name.text, params.len(), MAX_PARAMETERS, name.span));
                self.items[item.0].broken = true;
                needs.insert(item, Vec::new());
                continue;
            }
            let mentioned = self.scan_statement(file, statement, &mut scan);
            open.extend(&mentioned);
            needs.insert(item, mentioned);
        }
        self.sort(&needs, diagnostics);
    }

    /// Depth-first search without recursion: fills `order`, reports circles and marks what lies on them.
    fn sort(&mut self, needs: &HashMap<ItemId, Vec<ItemId>>, diagnostics: &mut Vec<Diagnostic>) {
        #[derive(Clone, Copy, PartialEq)]
        enum State {
            New,
            Open,
            Done,
        }
        let mut state = vec![State::New; self.items.len()];
        for root in (0..self.items.len()).map(ItemId).filter(|item| needs.contains_key(item)) {
            let mut path = vec![(root, 0)];
            while let Some((item, next)) = path.last_mut() {
                let item = *item;
                if *next == 0 && state[item.0] == State::Done {
                    path.pop();
                    continue;
                }
                state[item.0] = State::Open;
                let Some(&needed) = needs[&item].get(*next) else {
                    state[item.0] = State::Done;
                    self.order.push(item);
                    path.pop();
                    continue;
                };
                *next += 1;
                match state[needed.0] {
                    State::New => path.push((needed, 0)),
                    State::Done => {}
                    // A circle through what is in another one is not reported.
                    State::Open if self.items[item.0].broken || self.items[needed.0].broken => {}
                    State::Open => {
                        let start = path.iter().position(|(on_path, _)| *on_path == needed).unwrap_or(0);
                        let circle: Vec<ItemId> = path[start..].iter().map(|(item, _)| *item).collect();
                        self.report_circle(&circle, diagnostics);
                    }
                }
            }
        }
    }

    fn report_circle(&mut self, circle: &[ItemId], diagnostics: &mut Vec<Diagnostic>) {
        if circle.iter().any(|item| self.items[item.0].broken) {
            return;
        }
        let function = circle.iter().any(|&item| matches!(self.statement(item).kind, StatementKind::Fn { .. }));
        let names: Vec<(String, Span)> =
            circle.iter().map(|item| &self.items[item.0].name).map(|name| (name.text.clone(), name.span)).collect();
        diagnostics.push(errors::cycle(&names, function));
        for item in circle {
            self.items[item.0].broken = true;
        }
    }

    /// The definitions that a statement mentions; unknown names are reported.
    fn scan_statement(&mut self, file: usize, statement: &Statement, scan: &mut Scan) -> Vec<ItemId> {
        let mut locals: Vec<&str> = Vec::new();
        let mut open: Vec<&Expr> = Vec::new();
        let mut proposal = None;
        match &statement.kind {
            StatementKind::Let { value, .. } => open.push(value),
            StatementKind::Fn { params, body, .. } => {
                locals.extend(params.iter().map(|param| param.name.text.as_str()));
                open.push(body);
                open.extend(params.iter().filter_map(|param| param.default.as_ref()));
            }
            StatementKind::Param { value, range, .. } => {
                open.push(value);
                open.extend(range.iter().flat_map(|(lo, hi)| [lo, hi]));
            }
            StatementKind::Domain { ranges } => open.extend(ranges.iter().flat_map(|(lo, hi)| [lo, hi])),
            StatementKind::Import { .. } => {}
            StatementKind::Shape { keyword, name, relation, condition } => {
                match settings::as_setting(statement) {
                    Some((setting, _, args)) => {
                        let rest = match args {
                            // The name of the shape whose material it is.
                            [first, rest @ ..] if setting.name == "material" && self.names_shape(file, first) => rest,
                            _ => args,
                        };
                        open.extend(rest.iter().map(|argument| &argument.value));
                    }
                    None => open.push(relation),
                }
                open.extend(condition);
                if keyword.is_none() && name.is_none() {
                    proposal = left_name(relation);
                }
            }
        }
        let mut mentioned = Vec::new();
        while let Some(expr) = open.pop() {
            match &expr.kind {
                ExprKind::Name(name) if !locals.contains(&name.as_str()) => {
                    let define = proposal == Some(name.as_str());
                    mentioned.extend(self.mention(file, name, expr.span, Use { called: false, define }, scan));
                }
                ExprKind::Apply { callee, args } => {
                    if !locals.contains(&callee.text.as_str()) {
                        let used = Use { called: true, define: false };
                        mentioned.extend(self.mention(file, &callee.text, callee.span, used, scan));
                    }
                    open.extend(args.iter().map(|argument| &argument.value));
                }
                other => push_children(other, &mut open),
            }
        }
        mentioned
    }

    /// The definition behind one name, if it is one; an unknown name is reported once in a file.
    fn mention(&mut self, file: usize, name: &str, span: Span, used: Use, scan: &mut Scan) -> Option<ItemId> {
        let mut meaning = self.lookup(file, name);
        if let (Lookup::Unknown, Some(index)) = (meaning, stdlib::defining_file(name)) {
            self.library_file(index, scan.sources, scan.diagnostics);
            meaning = self.lookup(file, name);
        }
        match meaning {
            Lookup::Item(item) => {
                if let StatementKind::Shape { condition: Some(_), .. } = self.statement(item).kind {
                    scan.diagnostics.push(errors::conditional_shape(name, span, self.items[item.0].name.span));
                }
                return Some(item);
            }
            Lookup::Input | Lookup::Constant(_) | Lookup::Builtin(_) => {}
            Lookup::Ambiguous(first, second) => {
                let place = |item: ItemId| self.items[item.0].name.span;
                scan.diagnostics.push(errors::ambiguous_name(name, span, place(first), place(second)));
            }
            Lookup::Unknown => {
                let ProgramFile { id, origin, .. } = self.files[file];
                let lost = origin.faulty && {
                    let introduced = || introduced(&scan.sources.get(id).text);
                    scan.introduced.entry(file).or_insert_with(introduced).contains(name)
                };
                if !lost && scan.reported.insert((file, name.to_owned())) {
                    let diagnostic = errors::unknown_name(name, span, used.called);
                    let shown = scan.reported.len() <= SUGGESTED;
                    let diagnostic = if shown { self.help_unknown(diagnostic, file, name, used) } else { diagnostic };
                    scan.diagnostics.push(diagnostic);
                }
            }
        }
        None
    }

    /// Whether an argument is the bare name of a shape.
    fn names_shape(&self, file: usize, argument: &Argument) -> bool {
        let (None, ExprKind::Name(name)) = (&argument.name, &argument.value.kind) else { return false };
        let Lookup::Item(item) = self.lookup(file, name) else { return false };
        matches!(self.statement(item).kind, StatementKind::Shape { .. })
    }

    /// Adds what the user may have meant by an unknown name.
    fn help_unknown(&self, diagnostic: Diagnostic, file: usize, name: &str, used: Use) -> Diagnostic {
        if let Some(instead) = builtins::synonym(name) {
            return diagnostic.help(format!("write {instead}"));
        }
        if used.define {
            return diagnostic.help(format!("to define it write `let {name} = ...`"));
        }
        if settings::SETTINGS.iter().any(|setting| setting.name == name) {
            return diagnostic.help(format!("`{name}(...)` sets up the scene and is a statement of its own"));
        }
        let known = |part: &str| !matches!(self.lookup(file, part), Lookup::Unknown);
        let letters: Vec<String> = name.chars().map(String::from).collect();
        if letters.len() > 1 && letters.iter().all(|letter| known(letter)) {
            return diagnostic.help(format!("a product needs spaces: `{}`", letters.join(" ")));
        }
        if let Some((first, digits)) = name.char_indices().nth(1).map(|(at, _)| name.split_at(at))
            && known(first)
            && digits.bytes().all(|byte| byte.is_ascii_digit())
        {
            return diagnostic.help(format!("for a power write `{first}^{digits}`, for a multiple `{digits}{first}`"));
        }
        let scope = &self.files[file];
        let imported = scope.imports.iter().flat_map(|&import| self.files[import].own.keys());
        let candidates = scope.own.keys().chain(imported).chain(&self.variables).map(String::as_str);
        let builtin = builtins::BUILTINS.iter().map(|builtin| builtin.name);
        let constants = builtins::CONSTANTS.iter().map(|(name, _)| *name);
        let library = stdlib::stdlib_docs().iter().map(|doc| doc.name);
        let settings = settings::SETTINGS.iter().map(|setting| setting.name).filter(|_| used.called);
        // Sorted, so that the answer does not depend on the order of a hash table.
        let mut all: Vec<&str> = candidates.chain(builtin).chain(constants).chain(library).chain(settings).collect();
        all.sort_unstable();
        match did_you_mean(name, all) {
            Some(candidate) => diagnostic.help(format!("did you mean `{candidate}`?")),
            None => diagnostic,
        }
    }
}

/// How an unknown name was used.
#[derive(Debug, Clone, Copy)]
struct Use {
    /// Before a bracket.
    called: bool,
    /// Alone on the left of a bare equation, as if to define it.
    define: bool,
}

/// What scanning needs beside the program.
struct Scan<'a> {
    sources: &'a mut SourceMap,
    diagnostics: &'a mut Vec<Diagnostic>,
    reported: HashSet<(usize, String)>,
    /// By file, what [`introduced`] says of it.
    introduced: HashMap<usize, HashSet<String>>,
}

/// The names that stand in a text right after a keyword that defines names: the parser may have left a definition out.
fn introduced(text: &str) -> HashSet<String> {
    const KEYWORDS: [&str; 5] = ["let", "fn", "param", "surface", "curve"];
    let words = text.split_whitespace().zip(text.split_whitespace().skip(1));
    let names = words.filter(|(word, _)| KEYWORDS.contains(word)).map(|(_, next)| {
        let end = next.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '\'')).unwrap_or(next.len());
        next[..end].to_owned()
    });
    names.collect()
}

/// The name that stands alone on the left of an equation.
fn left_name(relation: &Expr) -> Option<&str> {
    match &relation.kind {
        ExprKind::Relation { operands, .. } => match &operands.first()?.kind {
            ExprKind::Name(name) => Some(name),
            _ => None,
        },
        _ => None,
    }
}

/// The expressions directly below one, but for names and calls, which the caller treats.
fn push_children<'a>(kind: &'a ExprKind, open: &mut Vec<&'a Expr>) {
    match kind {
        ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Text(_) => {}
        ExprKind::Apply { args, .. } => open.extend(args.iter().map(|argument| &argument.value)),
        ExprKind::List(items) | ExprKind::And(items) | ExprKind::Or(items) => open.extend(items),
        ExprKind::Bars(inner) | ExprKind::Group(inner) | ExprKind::Neg(inner) | ExprKind::Not(inner) => {
            open.push(inner)
        }
        ExprKind::Sum { first, rest } => {
            open.push(first);
            open.extend(rest.iter().map(|(_, term)| term));
        }
        ExprKind::Product { first, rest } => {
            open.push(first);
            open.extend(rest.iter().map(|(_, factor)| factor));
        }
        ExprKind::Power { base, exponent } => open.extend([&**base, &**exponent]),
        ExprKind::Relation { operands, .. } => open.extend(operands),
        ExprKind::If { condition, then, otherwise } => open.extend([&**condition, &**then, &**otherwise]),
    }
}
