//! The same program as `../build_script`, with kernels that are compiled when it runs: it could take its formulas from a
//! user, and carries a compiler for that.

#[path = "../../shared/motion.rs"]
mod motion;

use std::hint::black_box;

use imp::Columns;
use imp::Enclosure;
use imp::Interval;
use imp::IntervalKernel;
use imp::Options;
use imp::Program;
use motion::Disc;

fn main() -> Result<(), imp::Error> {
    let program = Program::parse(include_str!("../../shared/arm.imp"))?;
    let function = program.function("clearance")?;
    let kernel = function.intervals(&Options::default())?;
    let bound = |kernel: &IntervalKernel, disc: &Disc, from: f64, to: f64| {
        let [u, v] = disc.centre.map(Interval::point);
        let piece = Interval::new(from, to).expect("times are in order");
        let bound = kernel.enclose(&[piece, u, v, Interval::point(disc.radius)]).expect("there are four variables");
        (bound.lo(), bound.hi())
    };
    motion::check_motion("exact lengths", [true, true, false], |disc, from, to| bound(&kernel, disc, from, to));
    let tolerant = kernel.clone().with("upper", about(1.0, 0.01))?.with("lower", about(0.75, 0.01))?;
    motion::check_motion("1 cm more or less", [true, true, false], |disc, from, to| bound(&tolerant, disc, from, to));
    let refused = kernel.clone().with("upper", about(1.0, 0.5)).expect_err("the range ends at 1.2");
    println!("refused: {refused}");

    let options = Options::with_gradient();
    let boxes = motion::sample(4099);
    let column = |v: usize, end: usize| boxes.iter().map(|row| row[v][end]).collect::<Vec<f64>>();
    let columns: Vec<[Vec<f64>; 2]> = (0..4).map(|v| [column(v, 0), column(v, 1)]).collect();
    let views: Vec<[&[f64]; 2]> = columns.iter().map(|[lo, hi]| [lo.as_slice(), hi.as_slice()]).collect();
    let mut results = Columns::default();
    function.intervals(&options)?.enclose_columns(&views, &mut results)?;
    let numbers = (0..boxes.len()).flat_map(|row| {
        let Columns { lo, hi, verdict } = &results;
        (0..5).flat_map(move |output| [lo[output][row], hi[output][row], f64::from(verdict[output][row].0)])
    });
    println!("bits of bounds: {:016x}", motion::hash(numbers));
    let points: Vec<f64> = boxes.iter().flat_map(|row| row.map(|[lo, _]| lo)).collect();
    let mut values = vec![0.0; boxes.len() * 5];
    function.points(&options)?.values_into(&points, &mut values)?;
    println!("bits of values: {:016x}", motion::hash(values.into_iter()));

    times(&kernel, &program.function("shoulder")?.intervals(&Options::default())?)
}

fn times(kernel: &IntervalKernel, line: &IntervalKernel) -> Result<(), imp::Error> {
    let one = [about(0.25, 0.05), Interval::point(1.0), Interval::point(0.5), Interval::point(0.1)];
    let rows = [one; 4096].concat();
    let mut enclosures = vec![Enclosure::UNKNOWN; 4096];
    let single = motion::nanoseconds(10_000, || {
        for _ in 0..10_000 {
            black_box(kernel.enclose(black_box(&one)).expect("there are four variables"));
        }
    });
    let shoulder = motion::nanoseconds(10_000, || {
        for _ in 0..10_000 {
            black_box(line.enclose(black_box(&one[..1])).expect("there is one variable"));
        }
    });
    let batch = motion::nanoseconds(4096, || {
        kernel.enclose_into(black_box(&rows), &mut enclosures).expect("the lengths agree");
    });
    let columns: Vec<[Vec<f64>; 2]> = one.iter().map(|x| [vec![x.lo(); 4096], vec![x.hi(); 4096]]).collect();
    let views: Vec<[&[f64]; 2]> = columns.iter().map(|[lo, hi]| [lo.as_slice(), hi.as_slice()]).collect();
    let mut results = Columns::default();
    let in_columns = motion::nanoseconds(4096, || {
        kernel.enclose_columns(black_box(&views), &mut results).expect("the lengths agree");
    });
    println!("one box of a line: {shoulder:.1} ns");
    println!("one box: {single:.1} ns");
    println!("a box of 4096 in rows: {batch:.1} ns");
    println!("a box of 4096 in columns: {in_columns:.1} ns");
    Ok(())
}

fn about(middle: f64, half: f64) -> Interval {
    Interval::new(middle - half, middle + half).expect("the ends are in order")
}
