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
use crate::diagnostic::MAX_SHOWN;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::diagnostic::did_you_mean;
use crate::syntax;
use crate::syntax::ast::Module;
use crate::syntax::ast::Name;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

use super::builtins;
use super::builtins::Builtin;
use super::builtins::Constant;
use super::errors;
use super::import;
use super::resolve::Context;
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
    /// Whether an import was refused because of the limits.
    exhausted: bool,
}

#[derive(Debug)]
pub(super) struct ProgramFile {
    pub id: FileId,
    pub module: Rc<Module>,
    pub origin: Origin,
    pub own: HashMap<String, ItemId>,
    pub imports: Vec<usize>,
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
        context: &Context,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Program {
        let mut program = Program { variables, ..Program::default() };
        let path = import::resolve_path("", &sources.get(main.0).name).to_string_lossy().into_owned();
        program.by_path.insert(path, 0);
        program.add_file(main.0, main.1, Origin { library: false, faulty }, diagnostics);
        program.load_imports(sources, context, diagnostics);
        program.analyse(sources, diagnostics);
        program
    }

    pub fn statement(&self, item: ItemId) -> &Statement {
        let item = &self.items[item.0];
        &self.files[item.file].module.statements[item.statement]
    }

    /// The definition that a statement of a file is, if its name could be registered.
    pub fn item_of(&self, file: usize, statement: usize) -> Option<ItemId> {
        let name = defined_name(&self.files[file].module.statements[statement])?;
        let item = *self.files[file].own.get(&name.text)?;
        (self.items[item.0].statement == statement).then_some(item)
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
        for statement in &module.statements {
            let StatementKind::Fn { params, .. } = &statement.kind else { continue };
            for (i, param) in params.iter().enumerate() {
                if let Some(first) = params[..i].iter().find(|first| first.name.text == param.name.text) {
                    diagnostics.push(errors::duplicate_name(&param.name.text, param.name.span, first.name.span));
                }
            }
        }
        self.files.push(ProgramFile { id, module: Rc::new(module), origin, own, imports: Vec::new() });
        file
    }

    /// Follows the imports of all files; files are appended while they are walked.
    fn load_imports(&mut self, sources: &mut SourceMap, context: &Context, diagnostics: &mut Vec<Diagnostic>) {
        let mut next = 0;
        while next < self.files.len() {
            let module = Rc::clone(&self.files[next].module);
            for statement in &module.statements {
                let StatementKind::Import { path, path_span } = &statement.kind else { continue };
                if let Some(file) = self.import(next, path, *path_span, sources, context, diagnostics) {
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
        context: &Context,
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
            if file == from {
                diagnostics.push(errors::import_failed(path, span, "this is the file itself"));
                return None;
            }
            return Some(file);
        }
        let imported = self.files.iter().skip(1).filter(|file| !file.origin.library).count();
        let budget = context.budget;
        if let Err(exceeded) = budget.files(imported + 1).and_then(|()| budget.time()) {
            // Once: every further import would say the same.
            if !std::mem::replace(&mut self.exhausted, true) {
                diagnostics.push(Diagnostic::from(exceeded).at(span, "not read"));
            }
            return None;
        }
        let importer = context.importer;
        let text = match importer.read(&target, budget.source_left()) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::FileTooLarge => {
                if !std::mem::replace(&mut self.exhausted, true) {
                    diagnostics.push(errors::too_much_text(path, span, budget.limits().source_bytes));
                }
                return None;
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                let mut diagnostic = errors::import_failed(path, span, "there is no such file");
                let wanted = target.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                // Reading the folder takes a while, and nobody sees more messages.
                let shown = diagnostics.len() <= MAX_SHOWN;
                let folder = target.parent().unwrap_or(std::path::Path::new(""));
                let siblings = if shown { importer.names(folder) } else { Vec::new() };
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
        // Within what is left, as was asked.
        let _ = budget.source(text.len());
        let id = sources.add(key.clone(), text.as_str());
        let (module, faults) = syntax::parse(id, &text);
        let origin = Origin { library: false, faulty: !faults.is_empty() };
        diagnostics.extend(faults);
        let file = self.add_file(id, module, origin, diagnostics);
        self.by_path.insert(key, file);
        Some(file)
    }

    /// The library's file of that index, parsed on its first use.
    pub fn library_file(&mut self, index: usize, sources: &mut SourceMap, diagnostics: &mut Vec<Diagnostic>) -> usize {
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
