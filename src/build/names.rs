//! Names of Imp as identifiers of C, C++ and Rust.

/// Keywords of C up to C23 and of C++ up to C++20, macros of common C compilers, and what generated helpers call their own.
const C_WORDS: &[&str] = &[
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "explicit",
    "export",
    "extern",
    "false",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "union",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq", // keywords
    "I",
    "complex",
    "errno",
    "i386",
    "imaginary",
    "linux",
    "unix", // macros
    "at",
    "box",
    "ends",
    "i",
    "parameters",
    "results",
    "verdicts", // locals of helpers
];

/// Keywords of Rust up to edition 2024, reserved ones too, and what generated modules define beside their functions.
const RUST_WORDS: &[&str] = &[
    "Self",
    "abstract",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "struct",
    "super",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "union",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    // A module of every generated file.
    "imp_types",
    "core",
    "std",
];

const GREEK: &[(char, &str)] = &[
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "epsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('ι', "iota"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('ν', "nu"),
    ('ξ', "xi"),
    ('ο', "omicron"),
    ('π', "pi"),
    ('ρ', "rho"),
    ('σ', "sigma"),
    ('ς', "sigma"),
    ('τ', "tau"),
    ('υ', "upsilon"),
    ('φ', "phi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Γ', "Gamma"),
    ('Δ', "Delta"),
    ('Θ', "Theta"),
    ('Λ', "Lambda"),
    ('Ξ', "Xi"),
    ('Π', "Pi"),
    ('Σ', "Sigma"),
    ('Φ', "Phi"),
    ('Ψ', "Psi"),
    ('Ω', "Omega"),
];

/// A name in ASCII letters, digits and underscores that does not begin with a digit: Greek letters by their names, a prime
/// as `_prime`, other letters by their code points.
pub fn identifier(name: &str) -> String {
    let mut result = String::new();
    for c in name.chars() {
        match c {
            _ if c.is_ascii_alphanumeric() || c == '_' => result.push(c),
            '\'' => result += "_prime",
            _ => match GREEK.iter().find(|(letter, _)| *letter == c) {
                Some((_, spelled)) => result += spelled,
                None if c.is_alphanumeric() => result += &format!("u{:04x}", u32::from(c)),
                None => result.push('_'),
            },
        }
    }
    if !result.starts_with(|c: char| c.is_ascii_alphabetic()) {
        // Names that begin with an underscore belong to compilers.
        result.insert(0, 'm');
    }
    result
}

/// The name of an argument in C and C++.
pub fn in_c(identifier: &str) -> String {
    avoid(identifier, C_WORDS)
}

/// The name of a module, a function or a field in Rust.
pub fn in_rust(identifier: &str) -> String {
    avoid(identifier, RUST_WORDS)
}

fn avoid(identifier: &str, words: &[&str]) -> String {
    match words.contains(&identifier) {
        true => format!("{identifier}_"),
        false => identifier.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        let table = [
            ("f", "f"),
            ("f'", "f_prime"),
            ("φ_1", "phi_1"),
            ("höhe", "hu00f6he"),
            ("2 circles-and", "m2_circles_and"),
            ("_x", "m_x"),
            ("", "m"),
        ];
        for (name, expected) in table {
            assert_eq!(identifier(name), expected, "{name}");
        }
    }

    #[test]
    fn words_of_the_languages_are_avoided() {
        assert_eq!([in_c("double"), in_c("move"), in_c("x")], ["double_", "move", "x"]);
        assert_eq!([in_rust("double"), in_rust("move"), in_rust("self")], ["double", "move_", "self_"]);
    }
}
