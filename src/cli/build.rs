//! `imp build`: kernels for other people's programs.

use std::path::Path;

use crate::build::Export;
use crate::build::Selection;
use crate::build::all_levels;
use crate::build::static_library;
use crate::cli::arguments::BuildArguments;
use crate::cli::arguments::TargetArgument;
use crate::cli::failure;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::codegen::object::Target;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::library::Program;

/// Compiles first and writes then: a mistake leaves all files as they were.
pub fn build(arguments: &BuildArguments) -> Result<(), Failure> {
    let BuildArguments { file, output, header, rust, archive, .. } = arguments;
    let asked: Vec<&Path> = [output, header, rust, archive].into_iter().flatten().map(|path| path.as_path()).collect();
    if asked.is_empty() {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let title = "nothing to write: no output is asked for";
        let help = format!("for a C program: `-o {stem}.o --header {stem}.h`");
        return Err(Diagnostic::error(code::BAD_OPTION, title).help(help).into());
    }
    for (i, path) in asked.iter().enumerate() {
        files::check_folder(path)?;
        if asked[..i].contains(path) || *path == file.as_path() {
            let title = format!("`{}` cannot be two things at once", path.display());
            return Err(Diagnostic::error(code::BAD_OPTION, title).help("give each output a name of its own").into());
        }
    }
    let target = target(arguments)?;
    let selection = Selection {
        functions: arguments.functions.clone(),
        kernels: match arguments.kernels.is_empty() {
            true => Selection::default().kernels,
            false => arguments.kernels.iter().map(|kernel| (*kernel).into()).collect(),
        },
        precision: arguments.precision.into(),
    };
    let program = Program::open(file)?;
    let export = Export::new(&program, file, "", &selection)?;
    failure::print(program.sources(), &export.notes);

    let mut results: Vec<(&Path, Vec<u8>)> = Vec::new();
    if let Some(path) = output {
        results.push((path, export.object(&target)?));
    }
    if let Some(path) = header {
        results.push((path, export.header().into_bytes()));
    }
    if let Some(path) = rust {
        results.push((path, export.rust_file().into_bytes()));
    }
    if let Some(path) = archive {
        results.push((path, static_library(std::slice::from_ref(&export), &target)?));
    }
    results.iter().try_for_each(|(path, bytes)| files::write(path, bytes))
}

fn target(arguments: &BuildArguments) -> Result<Target, Diagnostic> {
    let host = match () {
        _ if cfg!(target_arch = "x86_64") => Some(TargetArgument::X86_64),
        _ if cfg!(target_arch = "aarch64") => Some(TargetArgument::Aarch64),
        _ => None,
    };
    match arguments.target.or(host) {
        Some(TargetArgument::X86_64) => {
            let mut levels = arguments.levels.iter().map(|level| (*level).into()).collect::<Vec<_>>();
            levels.sort();
            levels.dedup();
            Ok(Target::X86_64(if levels.is_empty() { all_levels() } else { levels }))
        }
        Some(TargetArgument::Aarch64) if arguments.levels.is_empty() => Ok(Target::Aarch64),
        Some(TargetArgument::Aarch64) => {
            let title = "levels are those of x86-64; there is one kind of code for AArch64";
            Err(Diagnostic::error(code::BAD_OPTION, title).help("leave `--levels` out"))
        }
        None => {
            let title = "kernels cannot be compiled ahead of time for the processor of this machine";
            Err(Diagnostic::error(code::BAD_OPTION, title).help("name another one: `--target x86_64`"))
        }
    }
}
