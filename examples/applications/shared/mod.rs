//! What the applications have in common: a scene in, its arrangement with counts out.

use imp::arrange::Arrangement;
use imp::arrange::Options;
use imp::arrange::check::Counts;
use imp::arrange::check::check;
use imp::control::Control;
use imp::diagnostic;
use imp::session;
use imp::session::Source;

/// The arrangement of the curves in a text, checked.
///
/// # Errors
/// What Imp says of the text, or of the arrangement.
pub fn arrange(text: &str) -> Result<(Arrangement, Counts), String> {
    let artefact = session::compile(Source::Text { name: "application.imp", text }, &[]);
    let Some(scene) = &artefact.scene else {
        return Err(diagnostic::render(&artefact.sources, &artefact.diagnostics, false));
    };
    let arranged = imp::arrange::arrange(scene, &Options::default(), session::backend(), &Control::default());
    let arrangement = arranged.map_err(|said| said.title)?;
    let counts = check(&arrangement).map_err(|fault| fault.to_string())?;
    Ok((arrangement, counts))
}
