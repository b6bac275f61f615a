//! Source text to functions.

use std::fmt;
use std::path::Path;
use std::path::PathBuf;
use std::sync::Arc;

use crate::arrange;
use crate::arrange::Arrangement;
use crate::control::Control;
use crate::derive;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::library::Error;
use crate::library::Function;
use crate::library::Report;
use crate::limits::Budget;
use crate::limits::Limits;
use crate::program;
use crate::program::Context;
use crate::program::Importer;
use crate::program::Scene;
use crate::render;
use crate::render::Picture;
use crate::session;
use crate::session::Source;
use crate::syntax;
use crate::syntax::ast::Module;

/// A text in Imp's language: definitions, functions, shapes. Cheap to clone.
#[derive(Clone)]
pub struct Program {
    parsed: Arc<Parsed>,
    functions: Arc<[Function]>,
    refused: Arc<[Refused]>,
}

/// How texts are read: their name in messages, and what they may cost.
///
/// ```
/// use imp::Limits;
/// use imp::Loader;
///
/// let strangers = Loader::new("form field", Limits::untrusted());
/// assert!(strangers.parse("fn f(x) = x^2").is_ok());
/// let refused = strangers.parse(&"(".repeat(100_000)).unwrap_err();
/// assert!(refused.to_string().contains("larger than allowed"));
/// ```
#[derive(Debug, Clone)]
pub struct Loader {
    name: String,
    limits: Limits,
}

impl Loader {
    pub fn new(name: impl Into<String>, limits: Limits) -> Self {
        Self { name: name.into(), limits }
    }

    /// Reads a text, which may import files of the standard library alone.
    ///
    /// # Errors
    /// [`Error::Source`] with all of its mistakes, or with the limit that it exceeds.
    pub fn parse(&self, text: &str) -> Result<Program, Error> {
        let budget = Budget::new(&self.limits);
        if let Err(exceeded) = budget.source(text.len()) {
            return Err(Error::Source(Report::new(SourceMap::default(), vec![exceeded.into()])));
        }
        let mut sources = SourceMap::default();
        let file = sources.add(self.name.as_str(), text);
        Program::new(None, sources, file, &budget)
    }

    /// Reads a file; its imports are relative to it.
    ///
    /// # Errors
    /// As [`Loader::parse`], and if it cannot be read.
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Program, Error> {
        let (path, budget) = (path.as_ref(), Budget::new(&self.limits));
        match session::read_within(path, &budget) {
            Ok((sources, file)) => Program::new(Some(path.to_owned()), sources, file, &budget),
            Err((sources, diagnostic)) => Err(Error::Source(Report::new(sources, vec![diagnostic]))),
        }
    }
}

/// What a program is made from.
struct Parsed {
    limits: Limits,
    /// Of the file; a text has none.
    path: Option<PathBuf>,
    sources: SourceMap,
    file: FileId,
    module: Module,
}

/// A function that takes no numbers, such as one of regions, or that has a mistake inside.
#[derive(Clone)]
pub struct Refused {
    pub name: String,
    pub error: Error,
}

impl Program {
    /// Reads a text, which may import files of the standard library alone.
    ///
    /// # Errors
    /// [`Error::Source`] with all of its mistakes.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::named("formula", text)
    }

    /// Reads a text under a name for messages.
    ///
    /// # Errors
    /// As [`Program::parse`].
    pub fn named(name: &str, text: &str) -> Result<Self, Error> {
        Loader::new(name, Limits::default()).parse(text)
    }

    /// Reads a file; its imports are relative to it.
    ///
    /// # Errors
    /// As [`Program::parse`], and if it cannot be read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Loader::new("", Limits::default()).open(path)
    }

    fn new(path: Option<PathBuf>, sources: SourceMap, file: FileId, budget: &Budget) -> Result<Self, Error> {
        let text = Arc::clone(&sources.get(file).text);
        let (module, faults) = syntax::parse(file, &text);
        let mut parsed = Parsed { limits: *budget.limits(), path, sources, file, module };
        let mut sources = parsed.sources.clone();
        let found = parsed.resolve(&mut sources, (parsed.module.clone(), faults), None, budget);
        // Imported files are known from here on.
        parsed.sources = sources;
        let found = found.map_err(|diagnostics| parsed.error(diagnostics))?;
        let refused = found.refused.into_iter();
        let refused = refused.map(|r| Refused { name: r.name, error: parsed.error(r.diagnostics) }).collect();
        let functions = found.functions.into_iter().map(|f| Function::new(f, parsed.limits)).collect();
        Ok(Self { parsed: Arc::new(parsed), functions, refused })
    }

    /// In source order: each `fn` of numbers, each `let` that depends on the coordinates, and each shape, whose value is the
    /// difference of an equation's sides, or a field that is at most 0 inside of a region. A `where` is not part of it. Shapes
    /// without a name are `shape1`, `shape2`, ... by their position.
    pub fn functions(&self) -> &[Function] {
        &self.functions
    }

    /// What [`Program::functions`] leaves out, and why.
    pub fn refused(&self) -> &[Refused] {
        &self.refused
    }

    /// A function by its name.
    ///
    /// # Errors
    /// If there is none, or it has a mistake.
    pub fn function(&self, name: &str) -> Result<Function, Error> {
        if let Some(function) = self.functions.iter().find(|function| function.name() == name) {
            return Ok(function.clone());
        }
        if let Some(refused) = self.refused.iter().find(|refused| refused.name == name) {
            return Err(refused.error.clone());
        }
        let known = self.functions.iter().map(|function| function.name().to_owned()).collect();
        Err(Error::UnknownFunction { name: name.to_owned(), known })
    }

    /// An expression of the given variables, and of the program's definitions, as a function.
    ///
    /// # Errors
    /// [`Error::Source`] with all of its mistakes.
    pub fn expression(&self, text: &str, variables: &[&str]) -> Result<Function, Error> {
        let limits = self.parsed.limits;
        let budget = Budget::new(&limits);
        budget.source(text.len()).map_err(Diagnostic::from)?;
        let mut sources = self.parsed.sources.clone();
        let file = sources.add("expression", text);
        let found = syntax::parse_expression(file, text).and_then(|expression| {
            let module = program::with_expression(self.parsed.module.clone(), expression, variables);
            self.parsed.resolve(&mut sources, (module, Vec::new()), Some(""), &budget)
        });
        let found = match found {
            Ok(mut found) => match (found.functions.pop(), found.refused.pop()) {
                (Some(function), _) => {
                    return Ok(Function::new(program::Function { name: text.to_owned(), ..function }, limits));
                }
                (None, refused) => refused.map_or(Vec::new(), |refused| refused.diagnostics),
            },
            Err(diagnostics) => diagnostics,
        };
        Err(Error::Source(Report::new(sources, found)))
    }

    /// Every file that was read.
    pub(crate) fn sources(&self) -> &SourceMap {
        &self.parsed.sources
    }

    /// The scene of the program's shapes: what [`crate::render`] and [`crate::arrange`] take.
    ///
    /// # Errors
    /// If it has no shapes, or mistakes that concern a scene alone.
    pub fn scene(&self) -> Result<Scene, Error> {
        let parsed = &self.parsed;
        let source = parsed.sources.get(parsed.file);
        let from = match &parsed.path {
            Some(path) => Source::File(path),
            None => Source::Text { name: &source.name, text: &source.text },
        };
        let artefact = session::compile_within(from, &[], &Budget::new(&parsed.limits));
        artefact.scene.ok_or(Error::Source(Report::new(artefact.sources, artefact.diagnostics)))
    }

    /// Draws the scene. To draw it several times, or with other values of its parameters, keep a
    /// [`render::Renderer`].
    ///
    /// # Errors
    /// As [`Program::scene`] and [`render::render`].
    pub fn render(&self, options: &render::Options) -> Result<Picture, Error> {
        Ok(render::render(&self.scene()?, options, session::backend(), &Control::default())?)
    }

    /// The arrangement of the scene's plane curves.
    ///
    /// # Errors
    /// As [`Program::scene`] and [`arrange::arrange`].
    pub fn arrange(&self, options: &arrange::Options) -> Result<Arrangement, Error> {
        Ok(arrange::arrange(&self.scene()?, options, session::backend(), &Control::default())?)
    }
}

impl Parsed {
    fn resolve(
        &self,
        sources: &mut SourceMap,
        parsed: (Module, Vec<Diagnostic>),
        only: Option<&str>,
        budget: &Budget,
    ) -> Result<program::Functions, Vec<Diagnostic>> {
        let importer: &dyn Importer = if self.path.is_some() { &program::FileSystem } else { &program::Embedded };
        let context = Context { importer, differentiate: &derive::derivative_within, overrides: &[], budget };
        program::resolve_functions(sources, self.file, parsed, only, &context)
    }

    fn error(&self, diagnostics: Vec<Diagnostic>) -> Error {
        Error::Source(Report::new(self.sources.clone(), diagnostics))
    }
}

/// The functions.
impl fmt::Debug for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.functions.iter()).finish()
    }
}
