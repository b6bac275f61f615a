//! The annulus of least width that holds given points. In a face of the arrangement of all bisectors the order of the
//! points by distance is fixed, and there the width (farthest less nearest distance) has no minimum inside: the best centre
//! is a vertex, a crossing of the nearest- and the farthest-point Voronoi diagrams or a vertex of one of them (H. Ebara et
//! al., 1989; M. de Berg et al., Computational Geometry, section 7.4), all of which are crossings of bisectors.
//!
//!     cargo run --release --example annulus

mod shared;

use imp::interval::Interval;

const POINTS: [[f64; 2]; 5] = [[-3.0, -1.0], [-1.0, 3.0], [2.5, 2.0], [3.0, -2.0], [-1.0, -4.0]];
const DOMAIN: [[f64; 2]; 2] = [[-40.0, 41.0], [-42.0, 43.0]];

fn distance(p: [f64; 2], x: Interval, y: Interval) -> Interval {
    ((x - Interval::point(p[0])).sqr() + (y - Interval::point(p[1])).sqr()).sqrt()
}

/// Encloses the width of the least annulus around a centre.
fn width(x: Interval, y: Interval) -> Interval {
    let distances = POINTS.map(|p| distance(p, x, y));
    let far = distances.into_iter().reduce(Interval::max).unwrap_or(Interval::EMPTY);
    let near = distances.into_iter().reduce(Interval::min).unwrap_or(Interval::EMPTY);
    far - near
}

fn main() -> Result<(), String> {
    let mut text = String::new();
    for (i, p) in POINTS.iter().enumerate() {
        for (j, q) in POINTS.iter().enumerate().skip(i + 1) {
            let field = |p: &[f64; 2]| format!("(x - ({}))^2 + (y - ({}))^2", p[0], p[1]);
            text += &format!("curve b{i}{j}: {} = {}\n", field(p), field(q));
        }
    }
    let [x, y] = DOMAIN;
    text += &format!("domain [{}, {}] x [{}, {}]\n", x[0], x[1], y[0], y[1]);
    let (arrangement, counts) = shared::arrange(&text)?;

    // Three bisectors meet in the circumcentre of each of 10 triples; bisectors of disjoint pairs cross, 15 times.
    println!("vertices inside by degree: {:?}, proved: {}", counts.degrees, counts.proved);
    assert_eq!(counts.degrees.into_iter().collect::<Vec<_>>(), [(4, 15), (6, 10)]);

    let inside = arrangement
        .vertices
        .iter()
        .map(|v| v.vertex.area)
        .filter(|[a, b]| x[0] < a.lo() && a.hi() < x[1] && y[0] < b.lo() && b.hi() < y[1]);
    let widths: Vec<_> = inside.map(|[a, b]| (width(a, b), a, b)).collect();
    let least = widths.iter().map(|(w, ..)| w.hi()).fold(f64::INFINITY, f64::min);
    let best: Vec<_> = widths.iter().filter(|(w, ..)| w.lo() <= least).collect();
    for (w, a, b) in &best {
        println!("centre ({:.9}, {:.9}), width in [{:.9}, {:.9}]", a.mid(), b.mid(), w.lo(), w.hi());
    }
    assert_eq!(best.len(), 1, "one centre is best");

    // No other centre does better.
    let mut rng = fastrand::Rng::with_seed(3);
    for _ in 0..200_000 {
        let at = [rng.f64() * 16.0 - 8.0, rng.f64() * 16.0 - 8.0];
        let distances = POINTS.map(|p| (at[0] - p[0]).hypot(at[1] - p[1]));
        let far = distances.into_iter().fold(0.0, f64::max);
        let near = distances.into_iter().fold(f64::INFINITY, f64::min);
        assert!(far - near > best[0].0.lo() - 1e-12, "{at:?}");
    }
    Ok(())
}
