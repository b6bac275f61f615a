//! The inflection points of a Gaussian mixture at every width of its bells: f'' = 0 as a curve in the plane of place x
//! and width y. The points of the curve on the line y = s are the inflection points of the mixture of width s.
//!
//! Smoothing makes no new inflection points (A. P. Witkin, "Scale-space filtering", 1983; J. Babaud et al., "Uniqueness of
//! the Gaussian kernel for scale-space filtering", 1986): the arches of the curve close upwards, and the count falls with s.
//!
//!     cargo run --release --example inflections

mod shared;

use std::fmt::Write;

use imp::arrange::complex::VertexKind;

/// Weight and mean of each bell.
const BELLS: [(f64, f64); 3] = [(1.0, -2.0), (0.5, 0.25), (0.75, 3.0)];
/// Widths at which inflection points are counted.
const WIDTHS: [f64; 5] = [0.5, 0.875, 1.25, 1.75, 2.5];
const PLACES: [f64; 2] = [-8.0, 8.5];

/// f'' but for a positive factor.
fn second(x: f64, s: f64) -> f64 {
    BELLS.iter().map(|(w, m)| w * ((x - m).powi(2) - s * s) * (-(x - m).powi(2) / (2.0 * s * s)).exp()).sum()
}

fn main() -> Result<(), String> {
    let terms: Vec<_> =
        BELLS.iter().map(|(w, m)| format!("{w} * ((x - ({m}))^2 - y^2) * exp(-(x - ({m}))^2 / (2 y^2))")).collect();
    let mut text = format!("curve bends: {} = 0\n", terms.join(" + "));
    for (i, s) in WIDTHS.iter().enumerate() {
        writeln!(text, "curve width{i}: y = {s}").map_err(|said| said.to_string())?;
    }
    writeln!(text, "domain [{}, {}] x [0.4, 2.75]", PLACES[0], PLACES[1]).map_err(|said| said.to_string())?;

    let (arrangement, counts) = shared::arrange(&text)?;
    let mut last = usize::MAX;
    for (i, &s) in WIDTHS.iter().enumerate() {
        let on_line = |v: &&imp::arrange::structure::ArrangedVertex| {
            v.vertex.kind == VertexKind::Crossing && v.vertex.curves.contains(&(i as u16 + 1))
        };
        let crossings: Vec<_> = arrangement.vertices.iter().filter(on_line).collect();
        assert!(crossings.iter().all(|v| v.vertex.proved));
        // The same count by sampling, which may miss pairs and here does not.
        let sample = |k: u32| second(PLACES[0] + (PLACES[1] - PLACES[0]) * f64::from(k) / 20_000.0, s) > 0.0;
        let changes = (0..20_000).filter(|&k| sample(k) != sample(k + 1)).count();
        assert_eq!(crossings.len(), changes);
        assert!(crossings.len() <= last, "smoothing made an inflection point");
        last = crossings.len();
        let mut places: Vec<_> = crossings.iter().map(|v| v.vertex.area[0].mid()).collect();
        places.sort_by(f64::total_cmp);
        println!("width {s:<5} {} inflection points, proved, at {places:.6?}", crossings.len());
    }
    assert_eq!(last, 2, "one bell is left");
    println!("{} faces, everything proved: {}", counts.faces, counts.proved);
    Ok(())
}
