//! Names: the definitions of all files, what a name means in which file, and an order in which definitions can be evaluated.
//!
//! A file sees its own definitions, then those of the files that it imports (not further), then the standard library.
//! Names of builtins, coordinates, settings and `pi` cannot be redefined, so that their place in this order does not matter;
//! single letters such as `e` can.
//! Definitions may stand in any order; a circle among them is an error.

use std::collections::HashMap;
use std::collections::HashSet;
use std::rc::Rc;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::diagnostic::did_you_mean;
use crate::syntax;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Module;
use crate::syntax::ast::Name;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

use super::builtins;
use super::builtins::Builtin;
use super::builtins::Constant;
use super::errors;
use super::import;
use super::import::Importer;
use super::scene::COORDINATES;
use super::settings;
use super::stdlib;
use super::values::ItemId;

/// All files of a program with their definitions.
#[derive(Debug, Default)]
pub(super) struct Program {
    /// The main file is the first.
    pub files: Vec<ProgramFile>,
    pub items: Vec<Item>,
    /// Definitions that are used, each after all that it needs.
    pub order: Vec<ItemId>,
    /// Names that the caller declares for the main file: the variables of `imp eval`.
    pub variables: HashSet<String>,
    by_path: HashMap<String, usize>,
}

#[derive(Debug)]
pub(super) struct ProgramFile {
    pub id: FileId,
    pub module: Rc<Module>,
    pub origin: Origin,
    own: HashMap<String, ItemId>,
    imports: Vec<usize>,
}

/// What is known of a file beside its module.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin {
    /// Whether it belongs to the standard library.
    pub library: bool,
    /// Whether the parser left statements out of the module.
    pub faulty: bool,
}

/// One `let`, `fn`, `param` or named shape.
#[derive(Debug)]
pub(super) struct Item {
    pub name: Name,
    pub file: usize,
    /// Its place in the file.
    pub statement: usize,
    /// Part of a circle that has been reported.
    pub broken: bool,
}

/// What a name means.
#[derive(Debug, Clone, Copy)]
pub(super) enum Lookup {
    Item(ItemId),
    /// An input of the graph: a coordinate, the time, or a declared variable.
    Input,
    Constant(Constant),
    Builtin(&'static Builtin),
    Ambiguous(ItemId, ItemId),
    Unknown,
}

impl Program {
    /// Reads `main` and everything that it imports and uses, and checks all names in them.
    pub fn load(
        sources: &mut SourceMap,
        main: (FileId, Module),
        faulty: bool,
        variables: HashSet<String>,
        importer: &dyn Importer,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Program {
        let mut program = Program { variables, ..Program::default() };
        let path = import::resolve_path("", &sources.get(main.0).name).to_string_lossy().into_owned();
        program.by_path.insert(path, 0);
        program.add_file(main.0, main.1, Origin { library: false, faulty }, diagnostics);
        program.load_imports(sources, importer, diagnostics);
        program.analyse(sources, diagnostics);
        program
    }

    pub fn statement(&self, item: ItemId) -> &Statement {
        let item = &self.items[item.0];
        &self.files[item.file].module.statements[item.statement]
    }

    /// What `name` means in a file, parameters of functions aside.
    pub fn lookup(&self, file: usize, name: &str) -> Lookup {
        if file == 0 && self.variables.contains(name) {
            return Lookup::Input;
        }
        let scope = &self.files[file];
        if let Some(&item) = scope.own.get(name) {
            return Lookup::Item(item);
        }
        let mut found = None;
        for item in scope.imports.iter().filter_map(|&import| self.files[import].own.get(name).copied()) {
            match found {
                Some(first) if first != item => return Lookup::Ambiguous(first, item),
                _ => found = Some(item),
            }
        }
        if let Some(item) = found {
            return Lookup::Item(item);
        }
        if COORDINATES.contains(&name) || name == builtins::TIME {
            return Lookup::Input;
        }
        if let Some((_, constant)) = builtins::CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return Lookup::Constant(*constant);
        }
        if let Some(builtin) = builtins::builtin(name) {
            return Lookup::Builtin(builtin);
        }
        let library = stdlib::defining_file(name).and_then(|index| self.by_path.get(stdlib::FILES[index].0));
        match library.and_then(|&file| self.files[file].own.get(name)) {
            Some(&item) => Lookup::Item(item),
            None => Lookup::Unknown,
        }
    }

    /// Registers a file's definitions; its imports come later.
    fn add_file(&mut self, id: FileId, module: Module, origin: Origin, diagnostics: &mut Vec<Diagnostic>) -> usize {
        let file = self.files.len();
        let mut own: HashMap<String, ItemId> = HashMap::new();
        for (statement, name) in module.statements.iter().enumerate().filter_map(|(i, s)| Some((i, defined_name(s)?))) {
            if let Some(meaning) = reserved(&name.text) {
                diagnostics.push(errors::reserved_name(&name.text, name.span, meaning));
            } else if let Some(first) = own.get(&name.text) {
                diagnostics.push(errors::duplicate_name(&name.text, name.span, self.items[first.0].name.span));
            } else {
                own.insert(name.text.clone(), ItemId(self.items.len()));
                self.items.push(Item { name: name.clone(), file, statement, broken: false });
            }
        }
        self.files.push(ProgramFile { id, module: Rc::new(module), origin, own, imports: Vec::new() });
        file
    }

    /// Follows the imports of all files; files are appended while they are walked.
    fn load_imports(&mut self, sources: &mut SourceMap, importer: &dyn Importer, diagnostics: &mut Vec<Diagnostic>) {
        let mut next = 0;
        while next < self.files.len() {
            let module = Rc::clone(&self.files[next].module);
            for statement in &module.statements {
                let StatementKind::Import { path, path_span } = &statement.kind else { continue };
                if let Some(file) = self.import(next, path, *path_span, sources, importer, diagnostics) {
                    self.files[next].imports.push(file);
                }
            }
            next += 1;
        }
    }

    fn import(
        &mut self,
        from: usize,
        path: &str,
        span: Span,
        sources: &mut SourceMap,
        importer: &dyn Importer,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<usize> {
        if path.starts_with("std/") {
            let Some(index) = stdlib::FILES.iter().position(|(name, _)| *name == path) else {
                let names = stdlib::FILES.iter().map(|(name, _)| *name);
                let help = match did_you_mean(path, names.clone()) {
                    Some(name) => format!("did you mean \"{name}\"?"),
                    None => format!("the library's files: {}", names.collect::<Vec<_>>().join(", ")),
                };
                diagnostics.push(errors::import_failed(path, span, "no such file in the library").help(help));
                return None;
            };
            return Some(self.library_file(index, sources, diagnostics));
        }
        let target = import::resolve_path(&sources.get(self.files[from].id).name, path);
        let key = target.to_string_lossy().into_owned();
        if let Some(&file) = self.by_path.get(&key) {
            return Some(file);
        }
        let text = match importer.read(&target) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                let mut diagnostic = errors::import_failed(path, span, "there is no such file");
                let wanted = target.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                let siblings = importer.names(target.parent().unwrap_or(std::path::Path::new("")));
                let library = stdlib::FILES.iter().map(|(name, _)| *name);
                let as_library = format!("std/{wanted}");
                if let Some(name) = library.clone().find(|name| *name == as_library) {
                    diagnostic = diagnostic.help(format!("the library's file is \"{name}\"; its names need no import"));
                } else if let Some(name) = did_you_mean(&wanted, siblings.iter().map(String::as_str)) {
                    diagnostic = diagnostic.help(format!("did you mean \"{name}\"?"));
                }
                diagnostics.push(diagnostic);
                return None;
            }
            Err(error) => {
                diagnostics.push(errors::import_failed(path, span, &error.to_string()));
                return None;
            }
        };
        let id = sources.add(key.clone(), text.as_str());
        let (module, faults) = syntax::parse(id, &text);
        let origin = Origin { library: false, faulty: !faults.is_empty() };
        diagnostics.extend(faults);
        let file = self.add_file(id, module, origin, diagnostics);
        self.by_path.insert(key, file);
        Some(file)
    }

    /// The library's file of that index, parsed on its first use.
    fn library_file(&mut self, index: usize, sources: &mut SourceMap, diagnostics: &mut Vec<Diagnostic>) -> usize {
        let (path, text) = stdlib::FILES[index];
        if let Some(&file) = self.by_path.get(path) {
            return file;
        }
        let id = sources.add(path, text);
        let (module, faults) = syntax::parse(id, text);
        let origin = Origin { library: true, faulty: !faults.is_empty() };
        diagnostics.extend(faults);
        let file = self.add_file(id, module, origin, diagnostics);
        self.by_path.insert(path.to_owned(), file);
        file
    }

    /// Checks the names in the main file and in everything that it reaches, and finds the order of evaluation.
    fn analyse(&mut self, sources: &mut SourceMap, diagnostics: &mut Vec<Diagnostic>) {
        let mut scan = Scan { sources, diagnostics, reported: HashSet::new() };
        let module = Rc::clone(&self.files[0].module);
        let mut needs: HashMap<ItemId, Vec<ItemId>> = HashMap::new();
        let mut open = Vec::new();
        for (index, statement) in module.statements.iter().enumerate() {
            let own = defined_name(statement).and_then(|name| self.files[0].own.get(&name.text).copied());
            match own.filter(|item| self.items[item.0].statement == index) {
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
            let mentioned = self.scan_statement(file, &module.statements[statement], &mut scan);
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
                    Some((_, _, args)) => open.extend(args.iter().map(|argument| &argument.value)),
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
            Lookup::Item(item) => return Some(item),
            Lookup::Input | Lookup::Constant(_) | Lookup::Builtin(_) => {}
            Lookup::Ambiguous(first, second) => {
                let place = |item: ItemId| self.items[item.0].name.span;
                scan.diagnostics.push(errors::ambiguous_name(name, span, place(first), place(second)));
            }
            Lookup::Unknown => {
                let lost =
                    self.files[file].origin.faulty && is_introduced(name, &scan.sources.get(self.files[file].id).text);
                if !lost && scan.reported.insert((file, name.to_owned())) {
                    let diagnostic = errors::unknown_name(name, span, used.called);
                    scan.diagnostics.push(self.help_unknown(diagnostic, file, name, used));
                }
            }
        }
        None
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
}

/// Whether a text holds the name right after a keyword that defines names: the parser may have left the definition out.
fn is_introduced(name: &str, text: &str) -> bool {
    const KEYWORDS: [&str; 5] = ["let", "fn", "param", "surface", "curve"];
    let mut words = text.split_whitespace();
    while let Some(word) = words.next() {
        let next = words.clone().next().unwrap_or("");
        let rest = next.strip_prefix(name);
        if KEYWORDS.contains(&word)
            && rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        {
            return true;
        }
    }
    false
}

/// The name that a statement defines.
pub(super) fn defined_name(statement: &Statement) -> Option<&Name> {
    match &statement.kind {
        StatementKind::Let { name, .. } | StatementKind::Fn { name, .. } | StatementKind::Param { name, .. } => {
            Some(name)
        }
        StatementKind::Shape { name, .. } => name.as_ref(),
        StatementKind::Domain { .. } | StatementKind::Import { .. } => None,
    }
}

/// What the language means by a name, in words that complete "`name` is ...".
fn reserved(name: &str) -> Option<&'static str> {
    if COORDINATES.contains(&name) {
        return Some("a coordinate");
    }
    if name == builtins::TIME {
        return Some("the time of an animation");
    }
    if builtins::builtin(name).is_some() {
        return Some("a built-in function");
    }
    if settings::SETTINGS.iter().any(|setting| setting.name == name) {
        return Some("a setting of the scene");
    }
    (name == "pi").then_some("the constant 3.14159...")
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
