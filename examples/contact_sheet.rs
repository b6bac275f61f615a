//! Renders every `.imp` file of this folder and lays the pictures out on one sheet, in alphabetical order; prints what was
//! proved of each as a Markdown table.
//!
//!     cargo run --release --example contact_sheet -- docs/gallery.png

use std::error::Error;
use std::path::Path;
use std::path::PathBuf;

use ::image::Rgb;
use ::image::RgbImage;
use imp::program::Scene;
use imp::render::Control;
use imp::render::Options;
use imp::render::Picture;
use imp::render::Renderer;
use imp::session;

/// Pixels along the side of one picture, between pictures, and pictures in a row.
const SIDE: u32 = 160;
const GAP: u32 = 4;
const COLUMNS: u32 = 9;
/// Counts are taken from pictures of the default size.
const COUNTED: u32 = 512;

fn main() -> Result<(), Box<dyn Error>> {
    let output = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("gallery.png"), PathBuf::from);
    let mut files: Vec<PathBuf> = std::fs::read_dir("examples")?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "imp"));
    files.sort();
    let rows = (files.len() as u32).div_ceil(COLUMNS);
    let mut sheet = RgbImage::from_pixel(COLUMNS * (SIDE + GAP) - GAP, rows * (SIDE + GAP) - GAP, Rgb([255; 3]));
    println!("| file | hits | proved | unknown | proved of hits | compile ms | render ms |");
    println!("|---|---|---|---|---|---|---|");
    for (place, file) in (0..).zip(&files) {
        let scene = compile(file)?;
        let counted = picture(&scene, COUNTED)?.stats;
        let share = 100.0 * counted.proved as f64 / (counted.hits.max(1)) as f64;
        println!(
            "| {} | {} | {} | {} | {share:.2} % | {:.1} | {:.1} |",
            file.file_stem().unwrap_or_default().to_string_lossy(),
            counted.hits,
            counted.proved,
            counted.unknown,
            counted.compile_ms,
            counted.render_ms
        );
        // Two by two pixels become one.
        let large = picture(&scene, 2 * SIDE)?;
        let (left, top) = (place % COLUMNS * (SIDE + GAP), place / COLUMNS * (SIDE + GAP));
        for y in 0..SIDE {
            for x in 0..SIDE {
                let four =
                    [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| large.color[large.index(2 * x + i, 2 * y + j)]);
                let mean = [0, 1, 2].map(|c| (four.iter().map(|pixel| u32::from(pixel[c])).sum::<u32>() / 4) as u8);
                sheet.put_pixel(left + x, top + y, Rgb(mean));
            }
        }
    }
    sheet.save(&output)?;
    Ok(())
}

fn compile(file: &Path) -> Result<Scene, Box<dyn Error>> {
    let artefact = session::compile(session::Source::File(file), &[]);
    let messages = || imp::diagnostic::render(&artefact.sources, &artefact.diagnostics, false);
    Ok(artefact.scene.clone().ok_or_else(messages)?)
}

fn picture(scene: &Scene, side: u32) -> Result<Picture, Box<dyn Error>> {
    let options = Options { width: side, height: side, ..Options::default() };
    let failed = |diagnostic: imp::diagnostic::Diagnostic| diagnostic.title;
    let renderer = Renderer::new(scene, &options, session::backend()).map_err(failed)?;
    Ok(renderer.render(&scene.parameters, &Control::default()).map_err(failed)?)
}
