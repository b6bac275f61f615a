//! Which points lie above a line? By duality (a point (a, b) becomes the line y = a x - b, a line y = m x + c the point
//! (m, -c)) a point is above a line exactly if its dual line is below the line's dual point. So the answer is the same for
//! all query points in one face of the arrangement of the dual lines: it is the face's sign vector (M. de Berg et al.,
//! Computational Geometry, chapter 8).
//!
//!     cargo run --release --example range_search

mod shared;

use std::collections::BTreeSet;

use imp::arrange::structure::Sign;

const POINTS: [[f64; 2]; 7] =
    [[-1.5, 0.5], [-1.0, -0.75], [-0.25, 1.25], [0.125, -0.25], [0.75, 0.5], [1.25, -1.0], [1.75, 1.5]];
/// Slopes and intercepts of query lines.
const DOMAIN: [[f64; 2]; 2] = [[-40.0, 41.0], [-60.0, 61.5]];

fn main() -> Result<(), String> {
    // The field y - (a x - b) is positive where the dual point is above the dual line.
    let lines = POINTS.iter().enumerate().map(|(i, [a, b])| format!("curve p{i}: y - ({a}) * x + ({b}) = 0\n"));
    let [x, y] = DOMAIN;
    let text = format!("{}domain [{}, {}] x [{}, {}]", lines.collect::<String>(), x[0], x[1], y[0], y[1]);
    let (arrangement, counts) = shared::arrange(&text)?;
    assert!(counts.proved);

    // n lines in general position: all splits of the points that a line of these slopes can make, each once.
    let n = POINTS.len() as u64;
    assert_eq!(counts.vertices.crossing, n * (n - 1) / 2);
    assert_eq!(counts.faces, 1 + n + n * (n - 1) / 2);
    let answers: BTreeSet<Vec<bool>> =
        arrangement.faces[1..].iter().map(|face| face.signs.iter().map(|&s| s == Sign::Positive).collect()).collect();
    assert_eq!(answers.len() as u64, counts.faces);
    println!("{n} points, {} different answers", counts.faces);

    let mut rng = fastrand::Rng::with_seed(7);
    for k in 0..1000 {
        let [m, c] = [rng.f64() * 4.0 - 2.0, rng.f64() * 3.0 - 1.5];
        let above: Vec<bool> = POINTS.iter().map(|[a, b]| *b > m * a + c).collect();
        assert!(answers.contains(&above), "y = {m} x + {c}");
        if k < 3 {
            let named: Vec<_> = (0..POINTS.len()).filter(|&i| above[i]).collect();
            println!("above y = {m:.3} x + {c:.3}: points {named:?}");
        }
    }
    Ok(())
}
