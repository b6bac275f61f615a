//! Sources that nobody means well with, made by code.

use std::fs;
use std::fs::File;
use std::io::BufWriter;
use std::io::Write;
use std::path::Path;

/// Writes a source to a folder, its repetitions divided by a number.
type Writer = Box<dyn Fn(&Path, usize) + Send + Sync>;

/// One source: its name, how it is written to `main.imp` of a folder, and why it is harmless if it is accepted.
pub struct Case {
    pub name: &'static str,
    write: Writer,
    pub harmless: Option<&'static str>,
}

impl Case {
    /// Says why the source may be accepted.
    fn harmless(self, why: &'static str) -> Self {
        Self { harmless: Some(why), ..self }
    }

    /// Writes the source, and what it imports, to a folder; large ones piece by piece, so that the memory of the process
    /// that measures others stays small.
    ///
    /// Whatever is there many times is there by `divisor` fewer times.
    pub fn write(&self, folder: &Path, divisor: usize) {
        (self.write)(folder, divisor);
    }
}

/// A text in the making.
pub struct Out {
    file: BufWriter<File>,
    divisor: usize,
}

impl Out {
    fn put(&mut self, text: impl AsRef<[u8]>) -> &mut Self {
        self.file.write_all(text.as_ref()).unwrap();
        self
    }

    fn times(&mut self, count: usize, text: impl AsRef<[u8]>) -> &mut Self {
        for _ in 0..count.div_ceil(self.divisor) {
            self.put(&text);
        }
        self
    }

    fn each(&mut self, count: usize, text: impl Fn(usize) -> String) -> &mut Self {
        for i in 0..count.div_ceil(self.divisor) {
            self.put(text(i));
        }
        self
    }
}

/// A case of one file.
fn text(name: &'static str, write: impl Fn(&mut Out) -> &mut Out + Send + Sync + 'static) -> Case {
    let write = move |folder: &Path, divisor| {
        let mut out = Out { file: BufWriter::new(File::create(folder.join("main.imp")).unwrap()), divisor };
        write(&mut out);
        out.file.flush().unwrap();
    };
    Case { name, write: Box::new(write), harmless: None }
}

fn short(name: &'static str, source: &'static str) -> Case {
    text(name, move |out| out.put(source))
}

/// A case of several files.
fn files(name: &'static str, files: &'static [(&'static str, &'static str)]) -> Case {
    let write =
        move |folder: &Path, _| files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
    Case { name, write: Box::new(write), harmless: None }
}

const MANY: usize = 100_000;
const HUGE: usize = 10_000_000;

/// Every case.
pub fn all() -> Vec<Case> {
    [nesting(), imports(), sizes(), numbers(), names(), growth(), scenes(), texts()].into_iter().flatten().collect()
}

fn nesting() -> Vec<Case> {
    vec![
        text("brackets", |o| o.times(MANY, "(").put("x").times(MANY, ")").put(" = 1")),
        text("brackets unclosed", |o| o.times(MANY, "(").put("x")),
        text("brackets unopened", |o| o.put("x").times(MANY, ")")),
        text("square brackets", |o| o.times(MANY, "[").put("x").times(MANY, "]").put(" = 1")),
        text("square brackets unclosed", |o| o.times(MANY, "[")),
        text("brackets mixed", |o| o.times(MANY, "([").put("x").times(MANY, ")]")),
        text("braces", |o| o.times(MANY, "{").put("x").times(MANY, "}")),
        text("bars", |o| o.times(MANY, "|").put("x").times(MANY, "|").put(" = 1")),
        text("bars with blanks", |o| o.times(MANY, "| ").put("x").times(MANY, " |").put(" = 1")),
        text("bars in sums", |o| o.times(MANY, "|x + ").put("y").times(MANY, "|").put(" = 1")),
        text("brackets side by side", |o| o.times(MANY, "(x)").put(" = 1"))
            .harmless("one product, linear in its length"),
        text("calls", |o| o.times(MANY, "sin(").put("x").times(MANY, ")").put(" = y")),
        text("minus signs", |o| o.times(MANY, "-").put("x = 1")),
        text("minus signs with blanks", |o| o.put("x = ").times(MANY, "- ").put("y")),
        text("plus signs", |o| o.put("x ").times(MANY, "+ ").put("y = 1")),
        text("not", |o| o.times(MANY, "not ").put("x < 1")),
        text("powers", |o| o.put("x = ").times(MANY, "2^").put("2")),
        text("powers of x", |o| o.put("y = ").times(MANY, "x^").put("2")),
        text("square roots", |o| o.put("y = ").times(250, "sqrt(").put("x").times(250, ")")).harmless("250 operations"),
        text("roots of numbers", |o| o.put("y = ").times(250, "sqrt(").put("7").times(250, ")").put("x"))
            .harmless("250 operations"),
        text("floor and mod", |o| o.put("y = ").times(120, "mod(floor(").put("x").times(120, "), 3)"))
            .harmless("240 operations"),
        text("if", |o| o.put("y = ").times(MANY, "if x < 1 then ").put("1").times(MANY, " else 2")),
        text("else if", |o| o.put("y = ").times(MANY, "if x < 1 then 1 else ").put("2")),
        text("and", |o| o.put("x = 1 where x < 1").times(MANY, " and x < 1")).harmless("one condition, repeated"),
        text("relations", |o| o.put("x").times(MANY, " < x")).harmless("one condition, repeated"),
    ]
}

fn imports() -> Vec<Case> {
    vec![
        files("import of itself", &[("main.imp", "import \"main.imp\"\nx + y = 1")]),
        files(
            "circle of imports",
            &[
                ("main.imp", "import \"a.imp\"\nx = a"),
                ("a.imp", "import \"b.imp\"\nlet a = b"),
                ("b.imp", "import \"a.imp\"\nlet b = a"),
            ],
        ),
        files("import of /dev/zero", &[("main.imp", "import \"/dev/zero\"\nx = y")]),
        files("import of /dev/tty", &[("main.imp", "import \"/dev/tty\"\nx = y")]),
        files("import of a folder", &[("main.imp", "import \"/tmp\"\nx = y")]),
        files("import of nothing", &[("main.imp", "import \"nothing.imp\"\nx = y")]),
        files(
            "import of a long path",
            &[("main.imp", concat!("import \"", "a/../a/../a/../a/../a/../a/../a/../", "main.imp\"\nx = y"))],
        ),
        files("import of a pipe", &[("main.imp", "import \"/proc/self/fd/0\"\nx = y")]),
        text("missing imports", |o| o.each(MANY, |i| format!("import \"{i}.imp\"\n"))),
        Case {
            name: "chain of imports",
            harmless: None,
            write: Box::new(|folder, _| {
                for i in 0..2000 {
                    let name = if i == 0 { "main.imp".to_owned() } else { format!("{i}.imp") };
                    fs::write(folder.join(name), format!("import \"{}.imp\"\nlet a{i} = 1\n", i + 1)).unwrap();
                }
                fs::write(folder.join("2000.imp"), "let last = 1").unwrap();
            }),
        },
        Case {
            name: "large imports",
            harmless: None,
            write: Box::new(|folder, _| {
                let mut main = String::new();
                for i in 0..20 {
                    main += &format!("import \"{i}.imp\"\n");
                    fs::write(folder.join(format!("{i}.imp")), format!("let a{i} = 1{}", "+1".repeat(200_000)))
                        .unwrap();
                }
                fs::write(folder.join("main.imp"), main + "x = y").unwrap();
            }),
        },
    ]
}

fn sizes() -> Vec<Case> {
    vec![
        short("nothing", ""),
        text("10 MB in one sum", |o| o.put("x = 1").times(HUGE / 2, "+1")).harmless("numbers are folded"),
        text("10 MB in one product", |o| o.put("x = 1").times(HUGE / 2, "*x")),
        text("10 MB in one name", |o| o.times(HUGE, "a").put(" = 1")),
        text("10 MB in one number", |o| o.put("x = ").times(HUGE, "9")),
        text("10 MB in one comment", |o| o.put("#").times(HUGE, "a").put("\nx = y"))
            .harmless("a part of it stands for nothing"),
        text("10 MB of line ends", |o| o.times(HUGE, "\n").put("x = y")).harmless("a part of them stands for nothing"),
        text("10 MB of blanks", |o| o.times(HUGE, " ").put("x = y")).harmless("a part of them stands for nothing"),
        text("10 MB of brackets", |o| o.times(HUGE, "(")),
        text("10 MB of NUL", |o| o.times(HUGE, "\0")),
        text("10 MB of quotes", |o| o.times(HUGE / 2, "\"\n")),
        text("much in one sum", |o| o.put("x = 1").times(500_000, "+x")),
        text("much in one product", |o| o.put("x = 1").times(500_000, "*x")),
        text("much side by side", |o| o.put("y = x").times(500_000, " x")),
        text("much of errors", |o| o.times(500_000, "1 2\n")),
        text("60 KB in one sum", |o| o.put("x = 1").each(9_000, |i| format!("+{i}x"))).harmless("linear in its length"),
        text("60 KB in one product", |o| o.put("y = x").each(6_000, |i| format!("(x-{i})")))
            .harmless("linear in its length"),
        text("60 KB of functions", |o| o.put("y = 0").each(4_000, |i| format!("+sin({i}x)")))
            .harmless("linear in its length"),
        text("60 KB of slow functions", |o| o.put("y = 0").each(3_500, |i| format!("+atan2(x,{i}y)")))
            .harmless("linear in its length"),
        text("60 KB of different numbers", |o| o.put("y = x").each(30, |i| format!("+0.{}{i}x", "7".repeat(1_900))))
            .harmless("60 operations"),
    ]
}

fn numbers() -> Vec<Case> {
    vec![
        short("x^1000000000", "y = x^1000000000"),
        short("x^(10^9)", "y = x^(10^9)"),
        short("2^10^9", "y = 2^10^9"),
        short("(1/3)^(10^9)", "y = (1/3)^(10^9)"),
        short("10^-10^9", "y = x + 10^-10^9"),
        short("x^10000 in towers", "let a = x^10000\nlet b = a^10000\nlet c = b^10000\ny = c^10000")
            .harmless("four operations"),
        short("1e1000000000", "y = 1e1000000000"),
        short("1e-1000000000", "y = 1e-1000000000x"),
        short("0x1p1000000000", "y = 0x1p1000000000"),
        text("a tower of numbers", |o| {
            o.put("let a0 = 3\n").each(200, |i| format!("let a{} = a{i}^9999\n", i + 1)).put("y = a200 x")
        })
        .harmless("numbers past 4096 bits are not folded"),
        text("sum of 1/k", |o| o.put("y = x").each(3_000, |k| format!("+1/{}", k + 1)))
            .harmless("numbers past 4096 bits are not folded"),
        text("product of k/(k+1)", |o| o.put("y = x").each(3_000, |k| format!("*{}/{}", k + 3, k + 2)))
            .harmless("numbers past 4096 bits are not folded"),
        text("sums of long fractions", |o| {
            o.put("let a = 1/3^1200\nlet b = 1/7^700\ny = 0").each(4_000, |i| format!("+(a+{i}b)x"))
        })
        .harmless("numbers past 4096 bits are not folded"),
        text("pi to a power of 1000 digits", |o| o.put("y = x + pi^").times(1000, "7")),
        text("root of 2000 digits", |o| o.put("y = x + sqrt(").times(1000, "17").put(")")).harmless("one number"),
        text("x to a fraction of long numbers", |o| o.put("y = x^(").times(500, "7").put("/").times(500, "3").put(")"))
            .harmless("one operation"),
        text("long numbers", |o| o.put("y = x").each(900, |i| format!("+{}{i}x", "7".repeat(2000 - 8))))
            .harmless("linear in its length"),
    ]
}

fn names() -> Vec<Case> {
    vec![
        short("param named as a keyword", "param where = 1\nx = y"),
        short("param named as a builtin", "param sin = 1\nx = y"),
        short("param named as a coordinate", "param x = 1\nx = y"),
        short("param named as a setting", "param camera = 1\nx = y"),
        short("circle of definitions", "let a = b\nlet b = c\nlet c = a\nx = a"),
        text("long circle of definitions", |o| {
            let count = MANY.div_ceil(o.divisor);
            o.each(MANY, |i| format!("let a{i} = a{}\n", (i + 1) % count)).put("x = a0")
        }),
        text("many circles of definitions", |o| {
            o.each(50_000, |i| format!("let a{i} = b{i}\nlet b{i} = a{i}\n")).put("x = y")
        }),
        short("recursion", "fn f(n) = if n < 1 then 1 else n f(n - 1)\ny = f(x)"),
        text("100 000 unknown names", |o| o.put("y = 0").each(MANY, |i| format!("+unknown{i}"))),
        text("100 000 names twice", |o| o.times(MANY, "let a = 1\n").put("x = y")),
        text("unknown names among many", |o| o.each(40_000, |i| format!("let name{i} = nome{i}\n")).put("x = y")),
        short("look-alike letters", "let а = 1\ny = a + x"),
        short("right-to-left marks", "y = \u{202e}x + 1\u{202c}"),
        text("combining marks", |o| o.put("y = a").times(10_000, "\u{301}")),
        text("100 000 params", |o| o.each(MANY, |i| format!("param a{i} = {i}\n")).put("x = y"))
            .harmless("parameters that nothing uses"),
        text("100 000 params in use", |o| {
            o.each(MANY, |i| format!("param a{i} = {i}\n")).put("x = y").each(MANY, |i| format!("+a{i}"))
        })
        .harmless("linear in its length"),
        text("5000 params in use", |o| {
            o.each(2_500, |i| format!("param a{i} = {i}\n")).put("x = y").each(2_500, |i| format!("+a{i}"))
        })
        .harmless("5000 operations"),
        text("a function of many parameters", |o| {
            o.put("fn f(a")
                .each(20_000, |i| format!(",a{i}=a"))
                .put(") = a0")
                .each(20_000, |i| format!("+a{i}"))
                .put("\ny = f(x)")
        }),
        text("many arguments", |o| o.put("y = max(x").each(MANY, |i| format!(",{i}x")).put(")"))
            .harmless("linear in its length"),
        text("many named arguments", |o| o.put("fn f(a) = a\ny = f(a=x").each(MANY, |i| format!(",b{i}=1")).put(")")),
    ]
}

fn growth() -> Vec<Case> {
    fn doubling(o: &mut Out) -> &mut Out {
        o.put("fn f0(x) = x^2 + 1\n").each(60, |i| format!("fn f{}(x) = f{i}(f{i}(x))\n", i + 1)).put("y = f60(x)")
    }
    vec![
        text("doubling functions", doubling),
        text("doubling by two calls", |o| {
            o.put("fn f0(x) = x^2 + 1\n")
                .each(60, |i| format!("fn f{}(x) = f{i}(x) f{i}(x + 1)\n", i + 1))
                .put("y = f60(x)")
        }),
        text("defaults that call", |o| {
            o.put("fn f0(a, b = a) = a + b\n")
                .each(60, |i| format!("fn f{}(a, b = f{i}(a), c = f{i}(b)) = f{i}(c) + b\n", i + 1))
                .put("y = f60(x)")
        }),
        text("squares of squares", |o| {
            let last = MANY.div_ceil(o.divisor);
            o.put("y = a0\n")
                .each(MANY, |i| format!("let a{i} = a{0}*a{0}\n", i + 1))
                .put(format!("let a{last} = x + 1"))
        })
        .harmless("parts are shared"),
        text("squares of squares, short", |o| {
            o.put("let a0 = x + 1\n").each(2_500, |i| format!("let a{} = a{i} a{i}\n", i + 1)).put("y = a2500")
        })
        .harmless("2500 operations"),
        text("many live values", |o| {
            o.each(700, |i| format!("let a{i} = {i}x + y^{}\n", i % 7 + 2))
                .put("y = 0")
                .each(700, |i| format!("+a{i} a{}", 699 - i))
        })
        .harmless("3500 operations"),
        text("400 functions", |o| o.put("y = 0").each(400, |i| format!("+sin({i}x)"))).harmless("1600 operations"),
        text("2000 products", |o| o.put("y = x").each(2_000, |i| format!("*(x-{i})"))).harmless("4000 operations"),
        text("deriv of deriv", |o| o.put("y = ").times(30, "deriv(").put("sin(x)exp(x)").times(30, ", x)"))
            .harmless("parts are shared"),
        text("deriv of deriv of a quotient", |o| {
            o.put("y = ").times(12, "deriv(").put("sin(x^2)/(1 + exp(x)^x)").times(12, ", x)")
        })
        .harmless("parts are shared"),
        text("deriv of a huge product", |o| o.put("y = deriv(x").each(5_000, |i| format!("(x+{i})")).put(", x)"))
            .harmless("parts are shared"),
        text("derivatives by definitions", |o| {
            o.put("let a0 = sin(x) exp(x y)\n")
                .each(40, |i| format!("let a{} = deriv(a{i}, x) a{i}\n", i + 1))
                .put("y = a40")
        })
        .harmless("parts are shared"),
        text("moved shapes", |o| {
            o.put("let a0 = x^2 + y^2 - 1\n")
                .each(60, |i| format!("let a{} = a{i}(x + 1, y) a{i}(x, y + 1)\n", i + 1))
                .put("a60 = 0")
        })
        .harmless("parts are shared"),
        text("a huge list", |o| o.put("let v = [1").times(MANY, ",x").put("]\ny = |v|"))
            .harmless("linear in its length"),
        text("sums of huge lists", |o| {
            o.put("let v = [1").each(5_000, |i| format!(",{i}x")).put("]\ny = |v").times(5_000, "+v").put("|")
        }),
        text("huge lists to and fro", |o| {
            o.put("let v = [1").times(15_000, ",x").put("]\ny = |v").times(7_500, "-v+v").put("|")
        }),
        text("repeated conditions", |o| o.put("y = x").each(2_000, |i| format!("+(if x<{i} then 1 else 2)")))
            .harmless("8000 operations"),
    ]
}

fn scenes() -> Vec<Case> {
    vec![
        short("domain [a, b]^100000", "x + y = 1\ndomain [0, 1]^100000"),
        text("a domain of 100 000 ranges", |o| o.put("x = y\ndomain [0, 1]").times(MANY, " x [0, 1]")),
        text("100 000 domains", |o| o.put("x = y\n").times(MANY, "domain [0, 1]^2\n")),
        text("100 000 shapes", |o| o.each(MANY, |i| format!("x + {i}y = 1\n"))).harmless("linear in its length"),
        text("100 000 named shapes", |o| o.each(MANY, |i| format!("curve c{i}: x + {i}y = 1\n")))
            .harmless("linear in its length"),
        text("2000 shapes", |o| o.each(2_000, |i| format!("curve c{i}: x^2 + {i}y = 1\n"))).harmless("8000 operations"),
        text("100 000 materials", |o| {
            o.put("surface s: x + y + z = 1\n").times(MANY, "material(s, color = \"red\")\n")
        }),
        text("100 000 lights", |o| o.put("surface s: x + y + z = 1\n").times(MANY, "light([1, 2, 3])\n"))
            .harmless("linear in its length"),
        short("nothing bounded", "sin(x y) cos(x + y) tan(x^3 y) = floor(x) mod(y, 3)").harmless("nothing large"),
        text("a domain that is hard to find", |o| o.put("0 = 1").each(900, |i| format!("+sin({i}x)cos({i}y)exp(z)")))
            .harmless("the search is bounded"),
    ]
}

fn texts() -> Vec<Case> {
    vec![
        text("invalid UTF-8", |o| o.put(b"x = y + \xff\xfe").times(MANY, "1")),
        text("10 MB of invalid UTF-8", |o| o.times(HUGE / 4, b"\xff\xfe\xfd\xfc")),
        text("100 000 NUL", |o| o.times(MANY, "\0x\0").put(" = 1")),
        text("100 000 errors", |o| o.times(MANY, "x = = 1\n")),
        text("100 000 unclosed texts", |o| o.times(MANY, "import \"\n")),
        text("errors on one line", |o| o.times(MANY, "x = = 1; ")),
        text("unknown characters", |o| o.times(MANY, "x § y ")),
        text("statements on one line", |o| o.times(MANY, "let a = 1;").put("x = y")),
        text("one long line of errors", |o| o.put("x = ").times(MANY, "y 1 2 ")),
        text("a name of 60 KB", |o| o.put("let ").times(60_000, "a").put(" = 1\ny = x ").times(1000, "a")),
        text("letters of four bytes", |o| o.put("y = ").times(15_000, "𝑥")),
    ]
}
