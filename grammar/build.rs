//! Generates the parser from `grammar/imp.lalrpop`.

fn main() {
    println!("cargo:rerun-if-changed=grammar/imp.lalrpop");
}
