//! Scratch.
use imp::arrange::{Fields, Options, solve};
use imp::control::Control;
use imp::session::{self, Source};
fn main() {
    for text in std::env::args().skip(1) {
        let text =
            if text.ends_with(".imp") { std::fs::read_to_string(&text).unwrap() } else { text.replace(';', "\n") };
        let a = session::compile(Source::Text { name: "t.imp", text: &text }, &[]);
        let Some(scene) = a.scene else {
            eprintln!("{}", imp::diagnostic::render(&a.sources, &a.diagnostics, false));
            continue;
        };
        let t = std::time::Instant::now();
        let fields = match Fields::new(&scene, session::backend()) {
            Ok(f) => f,
            Err(e) => {
                eprintln!("{e:?}");
                continue;
            }
        };
        let compile = t.elapsed().as_secs_f64() * 1e3;
        let t = std::time::Instant::now();
        let eps = std::env::var("EPS").ok().and_then(|e| e.parse().ok());
        let c = solve(&fields, &Options { epsilon: eps, ..Options::default() }, None, &Control::default());
        let ms = t.elapsed().as_secs_f64() * 1e3;
        println!("{}", text.replace('\n', "; "));
        let mut kinds = std::collections::BTreeMap::new();
        for cell in &c.cells {
            for b in &cell.blocks {
                if let Some(v) = &b.vertex {
                    *kinds.entry((format!("{:?}", v.kind), b.nodes.len())).or_insert(0) += 1;
                    if std::env::var("V").is_ok() {
                        println!(
                            "   {:?} {} {:?} w {:.1e} {:?} {:?} boxes {}",
                            v.kind,
                            b.nodes.len(),
                            v.area.map(|a| a.mid()),
                            v.area[0].width().max(v.area[1].width()),
                            v.curves,
                            v.note,
                            cell.boxes.len()
                        );
                    }
                }
            }
        }
        let frame: usize = c.segments.iter().filter(|s| s.frame).map(|s| s.nodes.len()).sum();
        println!(
            "  compile {compile:.1} ms, solve {ms:.1} ms; cells {} segments {} nodes {} frame nodes {frame}; {:?}; {:?}",
            c.cells.len(),
            c.segments.len(),
            c.nodes.len(),
            kinds,
            c.effort
        );
    }
}
