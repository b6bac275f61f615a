//! Can a disc get from here to there among obstacles? Its centre must stay further from all of them than its radius r: the
//! curves at distance r from the obstacles cut the room into faces, and the answer is yes exactly if start and goal are in
//! the same one (T. Lozano-Perez, "Spatial planning: a configuration space approach", 1983). Start and goal are curves of one
//! point each, so that the arrangement itself says in which face they lie.
//!
//!     cargo run --release --example motion

mod shared;

/// A room of 10 by 7 with a wall that has a door, another with a passage above it, and a column behind the door.
const SIDES: [f64; 2] = [10.0, 7.0];
/// Place in x and range in y of each wall.
const WALLS: [[f64; 3]; 3] = [[4.0, 0.0, 3.0], [4.0, 4.2, 7.0], [7.0, 0.0, 5.0]];
/// Centre and radius.
const COLUMN: [f64; 3] = [5.5, 3.5, 0.8];
const START: [f64; 2] = [1.5, 3.75];
const GOAL: [f64; 2] = [8.875, 1.5];

/// The scene of the centre of a disc of radius r.
fn scene(r: f64) -> String {
    let walls =
        WALLS.iter().map(|[x, a, b]| format!("curve wall: (x - {x})^2 + (y - max({a}, min(y, {b})))^2 = {r}^2\n"));
    let [x, y, own] = COLUMN;
    let mut text: String = walls.enumerate().map(|(i, wall)| wall.replacen("wall", &format!("wall{i}"), 1)).collect();
    text += &format!("curve column: (x - {x})^2 + (y - {y})^2 = ({own} + {r})^2\n");
    for (name, [x, y]) in [("start", START), ("goal", GOAL)] {
        text += &format!("curve {name}: (x - {x})^2 + (y - {y})^2 = 0\n");
    }
    text + &format!("domain [{r}, {}] x [{r}, {}]\n", SIDES[0] - r, SIDES[1] - r)
}

/// Whether the disc gets there in steps on a grid: an independent answer, where passages are wider than the steps.
fn by_flooding(r: f64) -> bool {
    const STEPS: usize = 100;
    let [columns, rows] = SIDES.map(|side| side as usize * STEPS + 1);
    let free = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|k| k as f64 / STEPS as f64);
        let inside = r <= x && x <= SIDES[0] - r && r <= y && y <= SIDES[1] - r;
        let clear = WALLS.iter().all(|[at, a, b]| (x - at).hypot(y - y.clamp(*a, *b)) > r);
        inside && clear && (x - COLUMN[0]).hypot(y - COLUMN[1]) > COLUMN[2] + r
    };
    let cell = |at: [f64; 2]| at.map(|v| (v * STEPS as f64).round() as usize);
    let mut seen = vec![false; columns * rows];
    let mut stack = vec![cell(START)];
    while let Some([i, j]) = stack.pop() {
        if [i, j] == cell(GOAL) {
            return true;
        }
        for [k, l] in [[i + 1, j], [i.wrapping_sub(1), j], [i, j + 1], [i, j.wrapping_sub(1)]] {
            if k < columns && l < rows && !seen[k * rows + l] && free(k, l) {
                seen[k * rows + l] = true;
                stack.push([k, l]);
            }
        }
    }
    false
}

fn main() -> Result<(), String> {
    // The narrowest place of the best way is between the column and the door's upper end: (sqrt(1.5^2 + 0.7^2) - 0.8) / 2.
    let widest = (1.5f64.hypot(0.7) - COLUMN[2]) / 2.0;
    println!("the largest disc that gets there has radius {widest:.4}");
    for r in [0.25, 0.41, 0.44, 0.7] {
        let (arrangement, counts) = shared::arrange(&scene(r))?;
        let shape = |name: &str| arrangement.curves.iter().position(|curve| curve == name).map(|i| i as u16);
        let face = |name: &str| {
            let own = |curves: &[u16]| shape(name).is_some_and(|shape| curves.contains(&shape));
            arrangement.vertices.iter().find(|v| own(&v.vertex.curves)).and_then(|v| v.face)
        };
        let (start, goal) = (face("start"), face("goal"));
        assert!(start.is_some() && goal.is_some(), "start and goal are points");
        let reached = start == goal;
        println!(
            "radius {r}: {}, {} faces, proved: {}",
            if reached { "yes" } else { "no" },
            counts.faces,
            counts.proved
        );
        assert_eq!(reached, by_flooding(r));
        assert_eq!(reached, r < widest);
    }
    Ok(())
}
