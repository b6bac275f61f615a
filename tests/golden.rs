//! Every scene of the gallery as a small picture, compared with the one kept in `tests/golden`; and what must hold of any
//! picture: the same bytes for any number of threads, and no contradiction between compiled kernels and the reference.
//!
//! With `IMP_BLESS=1` the pictures found are kept. A scene without a picture fails.

use std::fs;
use std::path::Path;
use std::path::PathBuf;

use imp::interpret::Interpreter;
use imp::kernel::Backend;
use imp::program::scene::Scene;
use imp::render;
use imp::render::Certainty;
use imp::render::Control;
use imp::render::Layers;
use imp::render::Options;
use imp::render::Picture;
use imp::render::image::Layer;
use imp::render::image::png;
use imp::session;
use imp::session::Source;

/// Pixels along a side.
const SIDE: u32 = 96;

/// Levels of 255 by which a channel may differ: shading is computed with functions of the standard library, which are not
/// the same everywhere.
const LEVELS: u8 = 4;

/// Pixels that may differ by more. None does on the machines that the pictures were made for; where kernels are
/// interpreted, a hit may be refined to a neighbouring cell, which shows at silhouettes and creases.
const OUTLIERS: usize = 9;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The scenes of the gallery with their names.
fn gallery() -> Vec<(String, Scene)> {
    let entries = fs::read_dir(root().join("examples")).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|e| e == "imp")).collect();
    files.sort();
    assert!(files.len() > 40, "the gallery is missing");
    let scene = |path: &PathBuf| {
        let artefact = session::compile(Source::File(path), &[]);
        assert!(artefact.diagnostics.is_empty(), "{}: {:?}", path.display(), artefact.diagnostics);
        (path.file_stem().unwrap().to_str().unwrap().to_owned(), artefact.scene.unwrap())
    };
    files.iter().map(scene).collect()
}

fn options(side: u32) -> Options {
    Options { width: side, height: side, ..Options::default() }
}

fn picture(scene: &Scene, options: &Options, backend: &dyn Backend) -> Picture {
    render::render(scene, options, backend, &Control::default()).unwrap()
}

#[test]
fn the_gallery_looks_as_it_did() {
    let bless = std::env::var_os("IMP_BLESS").is_some_and(|value| value == "1");
    let folder = root().join("tests/golden");
    let mut faults = Vec::new();
    let mut known = Vec::new();
    for (name, scene) in gallery() {
        let picture = picture(&scene, &options(SIDE), session::backend());
        let path = folder.join(format!("{name}.png"));
        known.push(path.clone());
        if let Err(fault) = compare(&path, &picture) {
            if bless {
                fs::create_dir_all(&folder).unwrap();
                fs::write(&path, png(&picture, Layer::Color)).unwrap();
            } else {
                faults.push(format!("{name}: {fault}"));
            }
        }
    }
    for entry in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
        if !known.contains(&entry) {
            faults.push(format!("{}: no scene of that name", entry.display()));
        }
    }
    assert!(faults.is_empty(), "{}\nRun with IMP_BLESS=1 to accept.", faults.join("\n"));
}

/// What distinguishes a picture from the one that was kept.
fn compare(path: &Path, picture: &Picture) -> Result<(), String> {
    let kept = image::open(path).map_err(|error| error.to_string())?.to_rgb8();
    if kept.dimensions() != (picture.width, picture.height) {
        return Err("the size differs".to_owned());
    }
    let differs = |(kept, found): (&image::Rgb<u8>, &[u8; 3])| {
        kept.0.iter().zip(found).any(|(kept, found)| kept.abs_diff(*found) > LEVELS)
    };
    let outliers = kept.pixels().zip(&picture.color).filter(|pair| differs(*pair)).count();
    if outliers > OUTLIERS { Err(format!("{outliers} pixels differ by more than {LEVELS} levels")) } else { Ok(()) }
}

/// Compiled kernels may leave open what the reference decides, and the reverse; but what one proves the other never
/// refutes.
#[test]
fn compiled_kernels_and_the_reference_never_contradict() {
    for (name, scene) in gallery() {
        let options = Options { layers: Layers { color: false, ..Layers::default() }, ..options(24) };
        let compiled = picture(&scene, &options, session::backend());
        let reference = picture(&scene, &options, &Interpreter);
        for (pixel, pair) in compiled.certainty.iter().zip(&reference.certainty).enumerate() {
            let contradiction = matches!(pair, (Certainty::Hit, Certainty::Miss) | (Certainty::Miss, Certainty::Hit));
            assert!(!contradiction, "{name}, pixel {pixel}: {pair:?}");
        }
    }
}

#[test]
fn every_pixel_is_counted_once() {
    for (name, scene) in gallery() {
        let stats = picture(&scene, &options(40), session::backend()).stats;
        assert_eq!(stats.proved + stats.misses + stats.unknown, stats.pixels, "{name}");
    }
}

#[test]
fn the_picture_does_not_depend_on_the_number_of_threads() {
    let all = Layers { color: true, depth: true, normal: true, certainty: true };
    for (name, scene) in gallery() {
        // A space scene of one shape, one of several, a solid, a transcendental one, and a plane scene.
        if !["barth_sextic", "level_set_conditions", "bracket", "gyroid", "trig_lattice"].contains(&name.as_str()) {
            continue;
        }
        // Not a whole number of tiles.
        let with = |threads| {
            let options = Options { threads: Some(threads), layers: all, ..options(150) };
            picture(&scene, &options, session::backend())
        };
        let (one, three) = (with(1), with(3));
        for layer in [Layer::Color, Layer::Depth, Layer::Normal, Layer::Certainty] {
            assert!(png(&one, layer) == png(&three, layer), "{name}: {layer:?}");
        }
        assert_eq!(one.depth, three.depth, "{name}");
        assert_eq!(one.stats.evaluations, three.stats.evaluations, "{name}");
    }
}
