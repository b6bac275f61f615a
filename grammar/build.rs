//! Generates the parser from `grammar/imp.lalrpop` into `OUT_DIR/imp.rs`; a conflict in the grammar fails the build.

fn main() {
    println!("cargo:rerun-if-changed=grammar/imp.lalrpop");
    println!("cargo:rerun-if-changed=grammar/build.rs");
    if let Err(error) = lalrpop::Configuration::new().log_quiet().process_dir("grammar") {
        eprintln!("grammar/imp.lalrpop: {error}");
        std::process::exit(1);
    }
}
