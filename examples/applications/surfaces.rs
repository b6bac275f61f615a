//! The intersection curve of a sphere and an ellipsoid, seen from above. As polynomials in z both are monic quadratic,
//!     z^2 + b1 z + c1 = 0,  z^2 + b2 z + c2 = 0,
//! and have a common root exactly where their resultant (c1 - c2)^2 + (b1 - b2) (b1 c2 - b2 c1) is 0. Two points of the
//! space curve above each other are a double point of its projection: both roots are common, b1 = b2 and c1 = c2.
//!
//!     cargo run --release --example surfaces

mod shared;

use imp::arrange::complex::VertexKind;

const SCENE: &str = "
let b1 = 0
let c1 = x^2 + y^2 - 4
let b2 = x
let c2 = x^2 / 2 + 3y^2 - 6
curve seen: (c1 - c2)^2 + (b1 - b2) (b1 c2 - b2 c1) = 0
domain [-3, 3.2] x [-3, 3.1]
";

fn main() -> Result<(), String> {
    let (arrangement, counts) = shared::arrange(SCENE)?;
    // b1 = b2 on x = 0, c1 = c2 there for y = 1 and -1, and z^2 = 3: two real double points, in a loop each.
    println!("vertices inside by degree: {:?}, {} faces, proved: {}", counts.degrees, counts.faces, counts.proved);
    assert_eq!(counts.degrees.into_iter().collect::<Vec<_>>(), [(4, 2)]);
    assert_eq!((counts.faces, counts.components, counts.isolated), (5, 2, 0));
    let mut nodes: Vec<_> =
        arrangement.vertices.iter().map(|v| &v.vertex).filter(|v| v.kind != VertexKind::Corner).collect();
    nodes.sort_by(|a, b| a.area[1].lo().total_cmp(&b.area[1].lo()));
    assert_eq!(nodes.len(), 2);
    for (node, y) in nodes.iter().zip([-1.0, 1.0]) {
        assert!(node.area[0].contains(0.0) && node.area[1].contains(y));
        let [a, b] = node.area.map(|side| side.outward_text(17));
        println!("double point in {a} x {b}, proved: {}", node.proved);
    }
    Ok(())
}
