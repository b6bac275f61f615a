//! One hard case: what plain arithmetic gives, what Imp says, and why.

/// What came out of a case. Its numbers are computed when the suite runs; all that is claimed about them is asserted there.
pub struct Case {
    /// Short, as in the table.
    pub name: &'static str,
    /// Why plain floating point goes wrong, in a sentence.
    pub why: &'static str,
    pub single: String,
    pub double: String,
    pub imp: String,
    /// What it cost Imp, which is counted but may differ from machine to machine.
    pub cost: String,
}

impl Case {
    /// The line of `cargo test --test stability -- --nocapture`.
    pub fn line(&self) -> String {
        let Self { name, single, double, imp, cost, .. } = self;
        let cost = if cost.is_empty() { String::new() } else { format!(" ({cost})") };
        format!("{name:<34} | f32: {single} | f64: {double} | Imp: {imp}{cost}")
    }

    /// The row of docs/hard-cases.md.
    pub fn row(&self) -> String {
        let Self { name, why, single, double, imp, .. } = self;
        let cell = |text: &str| text.replace('|', "\\|");
        format!("| {} | {} | {} | {} | {} |", cell(name), cell(single), cell(double), cell(imp), cell(why))
    }
}
