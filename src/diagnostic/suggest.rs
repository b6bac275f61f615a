//! The name that was probably meant.

/// The candidate nearest to `name` by transpositions, insertions, deletions and substitutions, if it is near enough
/// to be a slip: one change for up to four letters, two up to seven, three beyond. A difference in case alone always
/// is. Among equally near candidates the first.
pub fn did_you_mean<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    // A name longer than this is no slip of a candidate, and the distance costs the product of the lengths.
    const LONGEST: usize = 64;
    let letters = name.chars().count();
    if letters > LONGEST {
        return None;
    }
    let allowed = match letters {
        0..=4 => 1,
        5..=7 => 2,
        _ => 3,
    };
    let lower = name.to_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        if candidate == name || candidate.len() > 4 * LONGEST {
            continue;
        }
        let distance = if candidate.to_lowercase() == lower { 0 } else { strsim::osa_distance(name, candidate) };
        // With every letter changed nothing of the name is left.
        let kept = distance < letters.max(1);
        if distance <= allowed && kept && best.is_none_or(|(d, _)| distance < d) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::did_you_mean;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let names = ["sqrt", "sqr", "surface", "smoothstep", "x"];
        for (typed, meant) in [
            ("sqtr", Some("sqrt")),
            ("Surface", Some("surface")),
            ("surfce", Some("surface")),
            ("smothstp", Some("smoothstep")),
            ("y", None),
            ("torus", None),
            ("", None),
        ] {
            assert_eq!(did_you_mean(typed, names), meant, "{typed}");
        }
        assert_eq!(did_you_mean(&"s".repeat(100_000), names), None);
    }
}
