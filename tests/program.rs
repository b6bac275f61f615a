//! Names, kinds and the standard library: what the file tests under `tests/filetests/program` cannot show.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use imp::derive::derivative_within;
use imp::diagnostic::SourceMap;
use imp::diagnostic::render;
use imp::graph::enclose;
use imp::interval::Decorated;
use imp::interval::Interval;
use imp::limits::Budget;
use imp::limits::Limits;
use imp::program;
use imp::program::Context;
use imp::program::Embedded;
use imp::program::FileSystem;
use imp::program::Importer;
use imp::program::Scene;
use imp::program::stdlib_docs;
use imp::syntax;
use imp::syntax::ast::Module;

const EMBEDDED: &dyn Importer = &Embedded;

fn context<'a>(importer: &'a dyn Importer, budget: &'a Budget) -> Context<'a> {
    Context { importer, differentiate: &derivative_within, overrides: &[], budget }
}

fn budget() -> Budget {
    Budget::new(&Limits::default())
}

/// Parses and resolves a file; the messages as text if there are any.
fn scene_of(name: &str, text: &str, importer: &dyn Importer) -> Result<Scene, String> {
    let mut sources = SourceMap::default();
    let file = sources.add(name, text);
    let (scene, diagnostics) =
        program::resolve(&mut sources, file, syntax::parse(file, text), &context(importer, &budget()));
    match scene {
        Some(scene) if diagnostics.is_empty() => Ok(scene),
        _ => Err(render(&sources, &diagnostics, false)),
    }
}

/// The enclosure of an expression at a point of space.
fn value(text: &str, [x, y, z]: [f64; 3]) -> Result<Interval, String> {
    let mut sources = SourceMap::default();
    let file = sources.add("expression", text);
    let expr = syntax::parse_expression(file, text).map_err(|found| render(&sources, &found, false))?;
    let names = ["x", "y", "z"];
    let resolved =
        program::resolve_expression(&mut sources, &expr, &names, Module::default(), &context(EMBEDDED, &budget()));
    let resolved = resolved.map_err(|found| render(&sources, &found, false))?;
    let point: HashMap<&str, f64> = names.into_iter().zip([x, y, z]).collect();
    let input = |name: &String| Decorated::new(Interval::point(point[name.as_str()]));
    let inputs: Vec<Decorated> = resolved.graph.variables().iter().map(input).collect();
    Ok(enclose(&resolved.graph, &[resolved.value], &inputs)[0].interval())
}

#[test]
fn every_example_resolves() {
    let mut faults = String::new();
    let mut count = 0;
    for entry in fs::read_dir("examples").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "imp") {
            let name = path.to_string_lossy();
            if let Err(messages) = scene_of(&name, &fs::read_to_string(&path).unwrap(), &FileSystem) {
                faults += &messages;
            }
            count += 1;
        }
    }
    assert!(faults.is_empty() && count > 50, "{count} examples\n{faults}");
}

/// A call of every function of the library on sample arguments, so that none is broken. Functions of numbers give a number,
/// regions their field, at a point inside and at one outside.
#[test]
fn every_library_function_evaluates() {
    let mut faults = String::new();
    for doc in stdlib_docs() {
        if SAMPLES.iter().all(|(call, ..)| !call.contains(&format!("{}(", doc.name))) {
            faults += &format!("{} has no sample\n", doc.signature);
        }
    }
    for (call, point, accept) in SAMPLES {
        match value(&format!("field({call})"), *point) {
            Ok(found) if found.is_bounded() && accept(found) => {}
            Ok(found) => faults += &format!("{call} at {point:?} is [{}, {}]\n", found.lo(), found.hi()),
            Err(messages) => faults += &messages,
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

type Sample = (&'static str, [f64; 3], fn(Interval) -> bool);

const O: [f64; 3] = [0.0, 0.0, 0.0];
const INSIDE: fn(Interval) -> bool = |found| found.hi() < 0.0;
const OUTSIDE: fn(Interval) -> bool = |found| found.lo() > 0.0;
const ZERO: fn(Interval) -> bool = |found| found.contains(0.0) && found.width() < 1e-12;
const ONE: fn(Interval) -> bool = |found| found.contains(1.0) && found.width() < 1e-12;

const SAMPLES: &[Sample] = &[
    // Numbers.
    ("clamp(x, 0, 1)", [3.0, 0.0, 0.0], ONE),
    ("mix(-1, 3, x)", [0.5, 0.0, 0.0], ONE),
    ("component(mix([1, 2], [3, 4], 1/2), 1) - 1", O, ONE),
    ("smoothstep(1, 3, x)", [3.0, 0.0, 0.0], ONE),
    ("smoothstep(1, 3, x) - 1/2", [2.0, 0.0, 0.0], ZERO),
    ("ease(x)", [1.0, 0.0, 0.0], ONE),
    ("step(2, x)", [2.0, 0.0, 0.0], ONE),
    ("step(2, x)", [1.0, 0.0, 0.0], ZERO),
    ("fraction(x) - 3/4", [-1.25, 0.0, 0.0], ZERO),
    ("zigzag(x)", [3.0, 0.0, 0.0], ONE),
    ("zigzag(x)", [-4.0, 0.0, 0.0], ZERO),
    ("bell(x)", O, ONE),
    ("degrees(180) - pi", O, ZERO),
    ("length(normalize([x, y, z]))", [1.0, -2.0, 3.0], ONE),
    ("distance([x, y, z], [1, 1, 0])", [1.0, 0.0, 0.0], ONE),
    ("length(gradient(x)) ", O, ONE),
    ("distance_estimate(x^2 + y^2 + z^2 - 1) - 3/4", [2.0, 0.0, 0.0], ZERO),
    ("laplacian(x^2 + y^2 + z^2) - 6", [1.0, 2.0, 3.0], ZERO),
    ("at(x + 10y + 100z, [z, x, y]) - 213", [1.0, 2.0, 3.0], ZERO),
    // Solids: a point inside and one outside, some at the surface.
    ("sphere(2)", [0.0, 0.0, 2.0], ZERO),
    ("sphere(1, [1, 2, 3])", [1.0, 2.0, 2.5], INSIDE),
    ("ellipsoid([1, 2, 3])", [0.0, 0.0, 2.9], INSIDE),
    ("ellipsoid([1, 2, 3])", [1.1, 0.0, 0.0], OUTSIDE),
    ("box([2, 4, 6])", [0.9, 1.9, 2.9], INSIDE),
    ("box(2)", [0.0, 0.0, 2.0], ONE),
    ("rounded_box(4, 1/2)", [0.0, 0.0, 2.0], ZERO),
    ("rounded_box(4, 1/2)", [1.9, 1.9, 1.9], OUTSIDE),
    ("box_distance(-1, 1, -2)", O, ONE),
    ("cylinder(1, 4)", [0.6, 0.6, 1.9], INSIDE),
    ("cylinder(1, 4)", [0.8, 0.8, 0.0], OUTSIDE),
    ("axis_distance([1, 0, 0])", [1.0, 1.0, 5.0], ONE),
    ("cone(1, 2)", [0.0, 0.45, 1.0], INSIDE),
    ("cone(1, 2)", [0.0, 0.55, 1.0], OUTSIDE),
    ("cone(1, 2)", [0.0, 0.0, 2.1], OUTSIDE),
    ("frustum(2, 1, 3)", [1.4, 0.0, 1.5], INSIDE),
    ("frustum(2, 1, 3)", [0.0, 0.0, -1.0], ONE),
    ("torus(2, 1/2)", [2.0, 0.0, 0.5], ZERO),
    ("torus(2, 1/2)", O, OUTSIDE),
    ("torus_slice(2, 1/2, pi)", [2.0, 0.1, 0.0], INSIDE),
    ("torus_slice(2, 1/2, pi)", [-2.0, 0.1, 0.0], OUTSIDE),
    ("wedge(3)", [1.0, 0.0, 0.0], INSIDE),
    ("wedge(5)", [-1.0, 0.1, 0.0], OUTSIDE),
    ("wedge(5)", [0.0, -1.0, 0.0], INSIDE),
    ("capsule([0, 0, -1], [0, 0, 1], 1/2)", [0.0, 0.0, 1.4], INSIDE),
    ("capsule([0, 0, -1], [0, 0, 1], 1)", [0.0, 2.0, 0.5], ONE),
    ("segment_distance([x, y, z], [0, 0, 0], [1, 0, 0])", [2.0, 0.0, 0.0], ONE),
    ("half_space([0, 0, 2], 1)", [5.0, 5.0, 2.0], ONE),
    ("plane([0, 3, 0], 0.1, 1)", [5.0, 1.0, 2.0], INSIDE),
    ("superquadric([1, 1, 1], 0.5, 0.5)", [0.7, 0.7, -0.7], INSIDE),
    ("superquadric([1, 1, 1])", [0.6, 0.6, 0.6], OUTSIDE),
    ("tetrahedron(1)", [-1.7, -1.7, -1.7], INSIDE),
    ("tetrahedron(1)", [1.1, 1.1, 1.1], OUTSIDE),
    ("octahedron(1)", [0.0, 1.7, 0.0], INSIDE),
    ("octahedron(1)", [0.6, 0.6, 0.6], OUTSIDE),
    ("dodecahedron(1)", [0.0, 0.0, 0.99], INSIDE),
    ("dodecahedron(1)", [0.0, 0.0, 1.2], OUTSIDE),
    ("golden_faces(1, 0, 0, 0)", O, ONE),
    ("icosahedron(1)", [0.57, 0.57, 0.57], INSIDE),
    ("icosahedron(1)", [0.6, 0.6, 0.6], OUTSIDE),
    ("icosahedral_faces(x, x, x, (1 + sqrt(5)) / 2) - sqrt(3)", [1.0, 0.0, 0.0], ZERO),
    ("hyperboloid(1, 1)", [0.0, 1.0, 0.5], INSIDE),
    ("paraboloid()", [0.0, 1.0, 2.0], INSIDE),
    // Plane regions.
    ("disk(2)", [0.0, 1.0, 0.0], |found| found.contains(-1.0)),
    ("ring(1, 2)", [0.0, 1.5, 0.0], INSIDE),
    ("ring(1, 2)", [0.0, 0.5, 0.0], OUTSIDE),
    ("rectangle([2, 4])", [0.9, -1.9, 0.0], INSIDE),
    ("ellipse([1, 2])", [0.0, 2.0, 0.0], ZERO),
    ("half_plane([1, 1])", [-1.0, 0.0, 0.0], INSIDE),
    ("stroke([0, 0], [2, 0], 1)", [1.0, 0.4, 0.0], INSIDE),
    ("triangle([0, 0], [1, 0], [0, 1])", [0.3, 0.3, 0.0], INSIDE),
    ("triangle([0, 0], [1, 0], [0, 1])", [0.6, 0.6, 0.0], OUTSIDE),
    ("left_of([0, 0], [1, 0])", [0.0, -1.0, 0.0], ONE),
    ("polygon(6, 2)", [-1.5, 0.1, 0.0], INSIDE),
    ("polygon(4, 1)", [0.6, 0.6, 0.0], OUTSIDE),
    ("sector_angle(1, 2)", O, ZERO),
    // Combinations.
    ("smooth_min(1, 3, 1)", O, ONE),
    ("smooth_max(x, -1, 1)", [1.0, 0.0, 0.0], ONE),
    ("smooth_union(sphere(1), sphere(1, [1.9, 0, 0]), 1)", [0.95, 0.4, 0.0], INSIDE),
    ("smooth_intersect(sphere(1), z <= 0)", [0.0, 0.0, -0.5], INSIDE),
    ("smooth_difference(sphere(1), z <= 0)", [0.0, 0.0, 0.5], INSIDE),
    ("chamfer_union(x <= 0, y <= 0, 1)", [0.4, 0.4, 0.0], INSIDE),
    ("exclusive(sphere(1), z <= 0)", [0.0, 0.0, -0.5], OUTSIDE),
    ("offset(sphere(1), 1)", [0.0, 2.0, 0.0], ZERO),
    ("shell(sphere(1), 0.5)", [0.0, 0.8, 0.0], INSIDE),
    ("morph(sphere(1), sphere(3), 1/2)", [0.0, 2.0, 0.0], ZERO),
    ("exponential_union(sphere(1), sphere(1, [1.9, 0, 0]), 1)", [0.95, 0.4, 0.0], INSIDE),
    ("ricci_union(x^2, y^2, 4)", [0.5, 2.0, 0.0], INSIDE),
    ("ricci_intersect(x^2, y^2, 4)", [0.5, 2.0, 0.0], OUTSIDE),
    ("blob([0, 0, 0])", O, ONE),
    ("metaball([0, 0, 1])", O, ONE),
    ("squared_distance([0, 1])", O, ONE),
    // Transforms: the unit ball around (2, 0, 0), moved.
    ("translate(sphere(1), [2, 0, 0])", [2.0, 0.0, 1.0], ZERO),
    ("rotate_x(sphere(1, [0, 2, 0]), pi / 2)", [0.0, 0.0, 2.0], INSIDE),
    ("rotate_y(sphere(1, [0, 0, 2]), pi / 2)", [2.0, 0.0, 0.0], INSIDE),
    ("rotate_z(sphere(1, [2, 0, 0]), pi / 2)", [0.0, 2.0, 0.0], INSIDE),
    ("rotate(sphere(1, [2, 0, 0]), [0, 0, 5], pi / 2)", [0.0, 2.0, 0.0], INSIDE),
    ("rotate(sphere(1, [2, 0, 0]), [1, 1, 1], 2 pi / 3)", [0.0, 2.0, 0.0], INSIDE),
    ("length(turned([1, 0, 0], [0, 0, 1], 0, 1))", O, ONE),
    ("scale(sphere(1), 3)", [0.0, 3.0, 0.0], ZERO),
    ("scale(sphere(1), [1, 2, 3])", [0.0, 2.0, 0.0], ZERO),
    ("mirror(sphere(1, [2, 0, 0]), [3, 0, 0])", [-2.0, 0.0, 0.0], INSIDE),
    ("length(mirrored([1, 0, 0], [1, 0, 0]))", O, ONE),
    ("symmetric_x(sphere(1, [2, 0, 0]))", [-2.0, 0.0, 0.0], INSIDE),
    ("symmetric_y(sphere(1, [0, 2, 0]))", [0.0, -2.0, 0.0], INSIDE),
    ("symmetric_z(sphere(1, [0, 0, 2]))", [0.0, 0.0, -2.0], INSIDE),
    ("twist(sphere(1, [2, 0, 1]), pi / 2)", [0.0, 2.0, 1.0], INSIDE),
    ("bend(sphere(1, [0, 0, 2]), 1)", [0.0, 0.0, 2.0], INSIDE),
    ("taper(cylinder(1, 2), 1/2)", [0.6, 0.0, 0.9], OUTSIDE),
    ("shear(sphere(1), 1)", [2.0, 0.0, 0.5], OUTSIDE),
    ("repeat(sphere(1), 4)", [8.1, -4.1, 12.0], INSIDE),
    ("cell(x, 4)", [9.0, 0.0, 0.0], ONE),
    ("repeat_limited(sphere(1), 4, [1, 0, 0])", [4.1, 0.1, 0.1], INSIDE),
    ("repeat_limited(sphere(1), 4, 1)", [8.0, 0.0, 0.0], OUTSIDE),
    ("limited_cell(x, 4, 1)", [5.0, 0.0, 0.0], ONE),
    ("repeat_around(sphere(1/2, [2, 0, 0]), 6)", [1.0, 1.732, 0.0], INSIDE),
    ("in_sector(sphere(1, [2, 0, 0]), 0)", [0.0, 2.0, 0.0], INSIDE),
    ("elongate(sphere(1), [1, 0, 0])", [1.9, 0.0, 0.0], INSIDE),
    ("extrude(disk(1), 4)", [0.5, 0.0, 1.9], INSIDE),
    ("revolve(disk(1, [2, 0]))", [0.0, 2.0, 0.5], INSIDE),
    // Surfaces, each at a point that lies on it or at its centre.
    ("barth_sextic()", [1.0, 0.0, 0.0], ZERO),
    ("barth_sextic_with(1)", [1.0, 0.0, 0.0], ZERO),
    ("barth_decic()", [0.0, 0.0, 0.0], OUTSIDE),
    ("barth_decic_with(1)", [1.0, 0.0, 0.0], ZERO),
    ("cayley()", [0.5, 0.0, 0.0], ZERO),
    ("cayley()", [-0.5, -0.5, -0.5], ZERO),
    ("clebsch()", O, ONE),
    ("kummer()", [1.3, 0.0, 0.0], |found| found.is_bounded()),
    ("tangle()", O, OUTSIDE),
    ("tangle()", [1.6, 1.6, 1.6], INSIDE),
    ("heart()", [1.0, 0.0, 0.0], ZERO),
    ("heart()", O, INSIDE),
    ("steiner()", [0.0, 0.0, 0.4], ZERO),
    ("cross_cap()", [0.0, 1.0, 0.0], ZERO),
    ("klein_bottle()", [0.0, 0.0, 1.0], ZERO),
    ("torus_quartic(2, 1/2)", [2.5, 0.0, 0.0], ZERO),
    ("genus_two()", O, ONE),
    ("orthocircle()", [0.0, 0.0, 1.0], |found| found.is_bounded()),
    ("decocube()", [0.8, 0.0, 1.0], INSIDE),
    ("chmutov_octic() - 3", O, ZERO),
    ("chmutov_quartic() - 3", O, ZERO),
    ("chebyshev4(x)", [1.0, 0.0, 0.0], ONE),
    ("chebyshev8(x)", [1.0, 0.0, 0.0], ONE),
    ("whitney_umbrella()", [1.0, 1.0, 1.0], ZERO),
    ("monkey_saddle()", [1.0, 0.0, 1.0], ZERO),
    ("ding_dong()", [0.0, 0.0, 1.0], ZERO),
    ("cassini_surface(1, 1)", O, ZERO),
    ("dupin_cyclide(1, 1, 1/2)", [1.5, 0.0, 0.0], ZERO),
    ("helicoid()", [1.0, 0.0, 0.0], ZERO),
    ("gyroid()", O, ZERO),
    ("schwarz_p() - 3", O, ZERO),
    ("schwarz_d()", O, ZERO),
    ("neovius() - 13", O, ZERO),
    ("lidinoid() + 2.7", O, ZERO),
    // Curves.
    ("circle(2)", [0.0, 2.0, 0.0], ZERO),
    ("astroid()", [0.0, 1.0, 0.0], ZERO),
    ("cardioid()", [2.0, 0.0, 0.0], ZERO),
    ("deltoid()", [3.0, 0.0, 0.0], ZERO),
    ("nephroid()", [2.0, 0.0, 0.0], ZERO),
    ("limacon()", [1.5, 0.0, 0.0], ZERO),
    ("lemniscate()", [1.0, 0.0, 0.0], ZERO),
    ("gerono()", [1.0, 0.0, 0.0], ZERO),
    ("cassini(1, 1)", O, ZERO),
    ("trefoil()", [1.0, 0.0, 0.0], ZERO),
    ("quatrefoil()", [1.0, 0.0, 0.0], ZERO),
    ("rose(5)", [1.0, 0.0, 0.0], ZERO),
    ("folium()", [1.5, 1.5, 0.0], ZERO),
    ("trisectrix()", [1.5, 0.0, 0.0], ZERO),
    ("cissoid(2)", [1.0, 1.0, 0.0], ZERO),
    ("strophoid()", [1.0, 0.0, 0.0], ZERO),
    ("conchoid()", [3.0, 0.0, 0.0], ZERO),
    ("serpentine()", [1.0, 0.5, 0.0], ZERO),
    ("agnesi()", [0.0, 1.0, 0.0], ZERO),
    ("elliptic(-1, 1)", [1.0, 1.0, 0.0], ZERO),
    ("trott()", [0.0, 1.0, 0.0], ZERO),
    ("klein_quartic()", [1.0, 0.0, 0.0], ONE),
    ("bicorn()", [1.0, 0.0, 0.0], ZERO),
    ("bean()", [1.0, 0.0, 0.0], ZERO),
    ("devil()", [1.0, 0.0, 0.0], ZERO),
    ("kappa()", O, ZERO),
    ("superellipse(1, 2)", [0.0, 2.0, 0.0], ZERO),
    ("plane_heart()", [1.0, 0.0, 0.0], ZERO),
    ("lissajous()", [0.0, 0.0, 0.0], |found| found.contains(-1.0)),
];

/// Every file of the library resolves by itself, without the other files' text being loaded by anything else.
#[test]
fn every_library_file_stands_alone() {
    let mut files: Vec<&str> = stdlib_docs().iter().map(|doc| doc.file).collect();
    files.dedup();
    assert_eq!(files.len(), 7);
    for file in files {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file.replace("std/", "stdlib/"));
        let text = fs::read_to_string(path).unwrap();
        // A file of definitions has no shape, which must be its only fault.
        let messages = scene_of("library.imp", &text, EMBEDDED).unwrap_err();
        assert_eq!(messages.matches("error[").count(), 1, "{messages}");
        assert!(messages.contains("describes no shape"), "{messages}");
        scene_of("main.imp", &format!("import \"{file}\"\nx = y"), EMBEDDED).unwrap();
    }
}

/// The parser knows names of functions too, for its own messages.
#[test]
fn every_function_that_the_parser_knows_exists() {
    for name in syntax::FUNCTIONS {
        let known = program::BUILTINS.iter().any(|builtin| builtin.name == *name)
            || stdlib_docs().iter().any(|doc| doc.name == *name);
        assert!(known, "{name}");
    }
}

#[test]
fn library_names_hide_no_builtin() {
    for doc in stdlib_docs() {
        assert!(program::BUILTINS.iter().all(|builtin| builtin.name != doc.name), "{}", doc.name);
        assert!(program::SETTINGS.iter().all(|setting| setting.name != doc.name), "{}", doc.name);
    }
}

#[test]
fn long_sums_and_deep_nests_are_no_problem() {
    let terms: String = (0..80_000).map(|i| format!(" + {i} y")).collect();
    let scene = scene_of("main.imp", &format!("x{terms} = 0"), EMBEDDED).unwrap();
    assert!(scene.graph.len() > 240_000);
    let nests = [("(1 + 2*", "x", ")"), ("sin(1 + 2*", "x", ")"), ("-(-x)^", "x", ""), ("hypot(2, ", "x", ")")];
    for (open, middle, close) in nests {
        let text = format!("{}{middle}{} = 0", open.repeat(100), close.repeat(100));
        scene_of("main.imp", &text, EMBEDDED).unwrap();
    }
    let union = format!("surface s: {}x <= 0{}", "union(z <= 1, ".repeat(250), ")".repeat(250));
    scene_of("main.imp", &union, EMBEDDED).unwrap();
    let moved = format!("surface s: {}sphere(1){}", "translate(".repeat(250), ", [1, 0, 0])".repeat(250));
    scene_of("main.imp", &moved, EMBEDDED).unwrap();
    // Each definition calls the next: 2000 files' worth of `let` in the worst order, and calls past the limit.
    let chain: String = (0..2000).map(|i| format!("let a{i} = a{} + 1\n", i + 1)).collect();
    scene_of("main.imp", &format!("{chain}let a2000 = 1\nx = a0"), EMBEDDED).unwrap();
    let calls: String = (0..2000).map(|i| format!("fn f{i}(u) = f{}(u) + 1\n", i + 1)).collect();
    let messages = scene_of("main.imp", &format!("{calls}fn f2000(u) = u\nx = f0(y)"), EMBEDDED).unwrap_err();
    assert!(messages.contains("nest too deeply"), "{messages}");
}

/// Thousands of moved parts: the cost of each is its own size, not that of the whole scene.
#[test]
fn many_moved_parts_resolve_quickly() {
    let parts: Vec<String> = (0..2000).map(|i| format!("translate(rotate_z(box(1), {i}), [{i}, 0, 0])")).collect();
    let scene = scene_of("main.imp", &format!("surface s: union({})", parts.join(", ")), EMBEDDED).unwrap();
    assert!(scene.graph.len() > 20_000);
}

#[test]
fn expressions_name_their_variables() {
    assert_eq!(value("x^2 - 1", [3.0, 0.0, 0.0]), Ok(Interval::point(8.0)));
    assert_eq!(value("x < 1", [3.0, 0.0, 0.0]), Ok(Interval::ZERO));
    assert_eq!(value("x^2 = 9", [3.0, 0.0, 0.0]), Ok(Interval::ONE));
    assert!(value("x + t", [3.0, 0.0, 0.0]).unwrap_err().contains("`t` has no value"));
    assert!(value("x + q", [3.0, 0.0, 0.0]).unwrap_err().contains("unknown name `q`"));
    assert!(value("[x, y]", [3.0, 0.0, 0.0]).unwrap_err().contains("is a number, found a list"));
}

/// Variables hide constants and the library, definitions are seen, parameters keep their values.
#[test]
fn expressions_see_definitions() {
    let mut sources = SourceMap::default();
    let text = "let a = 7\nfn f(u) = u^2 + a + k\nlet a = 1\nparam k = 3 in [0, 5]\nsurface s: x = 1\ndomain [0, 1]^3";
    let file = sources.add("definitions", text);
    let (definitions, faults) = syntax::parse(file, text);
    assert!(faults.is_empty());
    let text = "f(e) + sphere(2)";
    let file = sources.add("expression", text);
    let expr = syntax::parse_expression(file, text).unwrap();
    let resolved =
        program::resolve_expression(&mut sources, &expr, &["e", "sphere"], definitions, &context(EMBEDDED, &budget()));
    let resolved = resolved.unwrap();
    assert_eq!(resolved.graph.variables(), ["k", "e", "sphere"]);
    assert_eq!((resolved.parameters[0].name.as_str(), resolved.parameters[0].value), ("k", Interval::point(3.0)));
}

#[test]
fn constants_from_outside_are_enclosed() {
    let constant = |text: &str| {
        let mut sources = SourceMap::default();
        let file = sources.add("--set", text);
        let expr = syntax::parse_expression(file, text).unwrap();
        program::resolve_constant(&mut sources, &expr, &context(EMBEDDED, &budget())).map_err(|found| found[0].code)
    };
    assert!(constant("pi/2").unwrap().contains(std::f64::consts::FRAC_PI_2));
    let tenth = constant("0.1").unwrap();
    assert!(tenth.lo() < tenth.hi() && tenth.contains(0.1));
    assert_eq!(constant("x + 1"), Err("E0301"));
    assert_eq!(constant("ln(-1)"), Err("E0302"));
    assert_eq!(constant("1 < 2"), Err("E0204"));
}
