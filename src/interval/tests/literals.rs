//! Literals: every form of IEEE 1788, what is refused and where, and text that reads back.

use super::{cases, interval, number, set};
use crate::interval::{Decorated, Decoration, Interval};
use fastrand::Rng;

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const MAX: f64 = f64::MAX;
const TINY: f64 = 5e-324;
const TENTH: f64 = 0.1;

#[test]
fn every_form_reads() {
    let table: &[(&str, f64, f64)] = &[
        ("[1, 2]", 1.0, 2.0),
        (" [ 1 ,\t2 ] ", 1.0, 2.0),
        ("[]", NAN, NAN),
        ("[ ]", NAN, NAN),
        ("[Empty]", NAN, NAN),
        ("[ ENTIRE ]", -INF, INF),
        ("[,]", -INF, INF),
        ("[,1]", -INF, 1.0),
        ("[1,]", 1.0, INF),
        ("[-inf, +Infinity]", -INF, INF),
        ("[-INF, 3]", -INF, 3.0),
        ("[1.5]", 1.5, 1.5),
        ("[+.5, 1.]", 0.5, 1.0),
        ("[0.1]", TENTH.next_down(), TENTH),
        ("[-0.1]", -TENTH, (-TENTH).next_up()),
        ("[-0, 0]", 0.0, 0.0),
        ("[1/4, 10/4]", 0.25, 2.5),
        ("[-1/3, 2/6]", -(1.0f64 / 3.0).next_up(), (1.0f64 / 3.0).next_up()),
        ("[0x1.8p+1, 0X3P0]", 3.0, 3.0),
        ("[-0x.8p1, 0xAp-1]", -1.0, 5.0),
        ("[0x1.00000000000008p0]", 1.0, 1f64.next_up()),
        ("[1e3, 1.5E+3]", 1000.0, 1500.0),
        ("[1e400]", MAX, INF),
        ("[-1e400, 1e-400]", -INF, TINY),
        ("[1e-999999999999999999999, 1e999999999999999999999]", 0.0, INF),
        ("[-0x1p99999999999, 0x1p-99999999999]", -INF, TINY),
        ("[0e999999999999]", 0.0, 0.0),
        ("3?", 2.5, 3.5),
        ("-10?", -10.5, -9.5),
        ("10?u", 10.0, 10.5),
        ("10?d", 9.5, 10.0),
        ("-10?u", -10.0, -9.5),
        ("3.5?5", 3.0, 4.0),
        ("3.75?25e2", 350.0, 400.0),
        ("3.75?25ue2", 375.0, 400.0),
        ("25?5e-1", 2.0, 3.0),
        ("10?12", -2.0, 22.0),
        ("0.0??", -INF, INF),
        ("-10??u", -10.0, INF),
        ("-10??de1", -INF, -100.0),
        ("10?3e380", MAX, INF),
        // The f64 nearest to 3.55 and 3.57 are both below.
        ("3.56?1", 3.55, 3.57f64.next_up()),
    ];
    for (text, lo, hi) in table {
        let bare: Interval = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(bare, set(*lo, *hi), "{text}");
        let decorated: Decorated = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(decorated, Decorated::new(bare), "{text}");
    }
}

#[test]
fn long_numbers_are_exact() {
    let zeros = "0".repeat(3000);
    for (text, x) in [
        (format!("[1{zeros}e-3000]"), Interval::ONE),
        (format!("[0.{zeros}25e3001]"), set(2.5, 2.5)),
        (format!("[1{zeros}/2{zeros}]"), set(0.5, 0.5)),
        (format!("[1.{zeros}1]"), set(1.0, 1f64.next_up())),
        (format!("[-1{zeros}, 1.{zeros}]"), set(-INF, 1.0)),
        ("[9e1999, 1e2000]".to_owned(), set(MAX, INF)),
        ("[9e2000, 1e2001]".to_owned(), set(MAX, INF)),
        ("[1e-2001, 9e-2001]".to_owned(), set(0.0, TINY)),
    ] {
        assert_eq!(text.parse(), Ok(x), "{x}");
    }
}

#[test]
fn decorations_read() {
    use Decoration::{Com, Dac, Def, Trv};
    for (text, x, decoration) in [
        ("[1, 2]_com", set(1.0, 2.0), Com),
        ("[1, 2]_DEF", set(1.0, 2.0), Def),
        ("[1, 2]_trv ", set(1.0, 2.0), Trv),
        ("[ ]_trv", Interval::EMPTY, Trv),
        ("[,]_dac", Interval::ENTIRE, Dac),
        ("2?_def", set(1.5, 2.5), Def),
        ("-10??d_dac", set(-INF, -10.0), Dac),
        // Bounded as written, not as rounded.
        ("[1e400]_com", set(MAX, INF), Dac),
    ] {
        assert_eq!(text.parse(), Ok(Decorated::with(x, decoration)), "{text}");
        assert!(text.parse::<Interval>().is_err(), "{text}");
    }
    assert_eq!("[ NaI ]".parse(), Ok(Decorated::ILL));
}

#[test]
fn mistakes_are_located() {
    for (text, position) in [
        ("", 0),
        ("1", 1),
        ("x", 0),
        ("[", 1),
        ("[1", 2),
        ("[1;2]", 2),
        ("[1,2", 4),
        ("[1,2]]", 5),
        ("[1,2] 3", 6),
        ("[2,1]", 3),
        ("[1.0000000000000000000002, 1.0000000000000000000001]", 27),
        ("[inf]", 1),
        ("[inf, inf]", 1),
        ("[-inf, -inf]", 7),
        ("[foo]", 1),
        ("[1, bar]", 4),
        ("[1 2]", 3),
        ("[.]", 1),
        ("[1e]", 3),
        ("[1e+]", 4),
        ("[0x1.8]", 6),
        ("[0xp1]", 3),
        ("[1/0]", 3),
        ("[1/]", 3),
        ("[1.5/2]", 1),
        ("[1/-2]", 3),
        ("[1,2,3]", 4),
        ("1.5?x", 4),
        ("?1", 0),
        ("-?", 0),
        ("[é]", 1),
        ("[1é]", 2),
    ] {
        let error = text.parse::<Interval>().expect_err(text);
        assert_eq!(error.position(), position, "{text}: {error}");
        assert!(!error.message().is_empty() && error.to_string().contains(&position.to_string()), "{error}");
        assert!(text.parse::<Decorated>().is_err(), "{text}");
    }
    for text in
        ["[1,2]_ill", "[1,2]_", "[1,2]_foo", "[1,2]_com2", "[1,2] _com", "[]_com", "[1,]_com", "[nai]_trv", "1??_com"]
    {
        assert!(text.parse::<Decorated>().is_err(), "{text}");
    }
    assert!("[nai]".parse::<Interval>().is_err());
}

/// No text makes the reader panic, and what it accepts is an interval.
#[test]
fn any_text_is_read_or_refused() {
    const ALPHABET: &[u8] = b"[],.-+0123459eExXpP/?ud_comnaif ";
    let mut rng = Rng::with_seed(60);
    let mut read = 0;
    for _ in 0..cases(20_000) {
        let inner: String = (0..rng.usize(0..9)).map(|_| char::from(ALPHABET[rng.usize(0..ALPHABET.len())])).collect();
        let text = if rng.bool() { format!("[{inner}]") } else { format!("{inner}?") };
        if let Ok(x) = text.parse::<Decorated>() {
            read += 1;
            assert!(x.is_nai() || x.is_empty() || x.interval().lo() <= x.interval().hi(), "{text}: {x}");
        }
    }
    assert!(read > 0);
}

#[test]
fn exact_text_reads_back() {
    for (x, text) in [
        (Interval::EMPTY, "[empty]"),
        (Interval::ENTIRE, "[-inf, inf]"),
        (Interval::UNIT, "[0, 0x1p+0]"),
        (set(-1.5, MAX), "[-0x1.8p+0, 0x1.fffffffffffffp+1023]"),
        (set(TINY, 10.0), "[0x0.0000000000001p-1022, 0x1.4p+3]"),
    ] {
        assert_eq!(x.exact_text(), text);
    }
    let mut rng = Rng::with_seed(61);
    for _ in 0..cases(2000) {
        let x = interval(&mut rng);
        assert_eq!(x.exact_text().parse(), Ok(x), "{}", x.exact_text());
        let decorated = Decorated::with(x, [Decoration::Com, Decoration::Def, Decoration::Trv][rng.usize(0..3)]);
        assert_eq!(decorated.exact_text().parse(), Ok(decorated), "{}", decorated.exact_text());
        // Shortest decimals are f64s again, and as real numbers at most one step away.
        let read: Interval = x.to_string().parse().unwrap();
        assert!(read.lo() >= x.lo().next_down() && read.hi() <= x.hi().next_up(), "{x}: {read}");
    }
    assert_eq!(Decorated::ILL.exact_text().parse(), Ok(Decorated::ILL));
    assert_eq!(Decorated::EMPTY.to_string().parse(), Ok(Decorated::EMPTY));
}

#[test]
fn outward_text_encloses() {
    for (x, digits, text) in [
        (set(TENTH, TENTH), 3, "[0.1, 0.101]"),
        (set(-2.0 / 3.0, 2.0 / 3.0), 4, "[-0.6667, 0.6667]"),
        (set(0.999, 0.999), 1, "[0.9, 1]"),
        (set(-1234.5, 0.0), 2, "[-1300, 0]"),
        (set(0.0, INF), 3, "[0, inf]"),
        (set(1.0, 1.0), 5, "[1, 1]"),
        (set(1.25e-10, 1e100), 2, "[1.2e-10, 1.1e100]"),
        (Interval::ENTIRE, 2, "[entire]"),
        (Interval::EMPTY, 2, "[empty]"),
    ] {
        assert_eq!(x.outward_text(digits), text);
    }
    let mut rng = Rng::with_seed(62);
    for _ in 0..cases(2000) {
        let (x, digits) = (interval(&mut rng), rng.usize(0..20));
        let text = x.outward_text(digits);
        let read: Interval = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!(read.contains_interval(x), "{x}, {digits} digits: {text}");
        let point = number(&mut rng);
        let read: Interval = Interval::point(point).outward_text(6).parse().unwrap();
        let margin = point.abs() * 2e-5 + TINY;
        assert!(read.lo() >= point - margin && read.hi() <= point + margin, "{point:e}: {read}");
    }
}
