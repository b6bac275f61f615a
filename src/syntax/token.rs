//! Tokens: the words of the language as they stand in the text, comments and line ends included.

use logos::Logos;

/// What one stretch of text is. The last group is never written: the filter puts those in for the grammar.
#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[logos(skip r"[ \t\x0B\x0C\p{Zs}\u{200B}\u{FEFF}]+")]
pub enum Token {
    #[regex(r"\r\n|\n|\r")]
    Newline,
    #[regex(r"#[^\r\n]*", allow_greedy = true)]
    Comment,
    #[token(";")]
    Semicolon,

    /// `2`, `0.5`, `.5`, `2e3`, and `0x1.8p+1`.
    #[regex(r"[0-9]+(\.[0-9]*)?([eE][+\-]?[0-9]+)?|\.[0-9]+([eE][+\-]?[0-9]+)?")]
    #[regex(r"0[xX]([0-9a-fA-F]+(\.[0-9a-fA-F]*)?|\.[0-9a-fA-F]+)[pP][+\-]?[0-9]+", priority = 50)]
    Number,
    /// `0x1f`: hexadecimal by its looks, but without the `p` that would tell it from 0 times x1f.
    #[regex(r"0[xX][0-9][0-9a-zA-Z_]*(\.[0-9a-zA-Z_]*)?", priority = 5)]
    BadHexadecimal,
    /// `²`, `⁻¹`: a power written with raised digits.
    #[regex(r"⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+")]
    Superscript,
    #[regex(r"[\p{L}_][\p{L}0-9_]*'*", priority = 2)]
    Name,
    #[regex(r#""[^"\r\n]*""#)]
    Text,
    #[regex(r#""[^"\r\n]*"#, allow_greedy = true)]
    OpenText,

    #[token("let")]
    Let,
    #[token("fn")]
    Fn,
    #[token("param")]
    Param,
    #[token("surface")]
    Surface,
    #[token("curve")]
    Curve,
    #[token("domain")]
    Domain,
    #[token("import")]
    Import,
    #[token("where")]
    Where,
    #[token("in")]
    In,
    #[token("if")]
    If,
    #[token("then")]
    Then,
    #[token("else")]
    Else,
    #[token("and")]
    #[token("∧")]
    And,
    #[token("or")]
    #[token("∨")]
    Or,
    #[token("not")]
    #[token("¬")]
    Not,

    #[token("+")]
    Plus,
    #[token("-")]
    #[token("−")]
    #[token("–")]
    Minus,
    #[token("*")]
    #[token("·")]
    #[token("⋅")]
    #[token("∗")]
    Star,
    /// `×`: a product, and between the ranges of a domain the product of sets.
    #[token("×")]
    Cross,
    #[token("/")]
    #[token("÷")]
    #[token("∕")]
    Slash,
    #[token("^")]
    Caret,
    #[token("=")]
    Equal,
    #[token("!=")]
    #[token("≠")]
    NotEqual,
    #[token("<")]
    Less,
    #[token("<=")]
    #[token("≤")]
    #[token("⩽")]
    LessEqual,
    #[token(">")]
    Greater,
    #[token(">=")]
    #[token("≥")]
    #[token("⩾")]
    GreaterEqual,
    #[token("(")]
    LeftParen,
    #[token(")")]
    RightParen,
    #[token("[")]
    LeftBracket,
    #[token("]")]
    RightBracket,
    #[token("|")]
    Bar,
    #[token(",")]
    Comma,
    #[token(":")]
    Colon,

    /// An operator of another language: `repair` knows what it is called here.
    #[token("**")]
    #[token("==")]
    #[token("===")]
    #[token("!==")]
    #[token("&")]
    #[token("&&")]
    #[token("!")]
    #[token("~")]
    #[token("%")]
    #[token("{")]
    #[token("}")]
    #[token("=>")]
    #[token("=<")]
    #[token("<>")]
    #[token(":=")]
    #[token("//")]
    #[token("/*")]
    #[token("->")]
    #[token("?")]
    #[token("√")]
    #[token("∞")]
    Foreign,
    /// Characters that the language does not use.
    Unknown,

    /// Between two operands that stand side by side: a product.
    Juxtaposed,
    BarOpen,
    BarClose,
    /// `x` or `×` between the ranges of a domain.
    BoxTimes,
    /// The `=` of a named argument or of a default.
    ArgumentEqual,
}

/// Offsets are 32 bits wide.
pub const MAX_BYTES: usize = u32::MAX as usize;

/// A token and its bytes `start..end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lexeme {
    pub token: Token,
    pub start: u32,
    pub end: u32,
}

/// All tokens of `text`, comments and line ends included; every byte that is not white space is in exactly one.
/// Of a text that is larger than [`MAX_BYTES`] there are none.
pub fn lex(text: &str) -> Vec<Lexeme> {
    let mut out: Vec<Lexeme> = Vec::new();
    if text.len() > MAX_BYTES {
        return out;
    }
    for (token, range) in Token::lexer(text).spanned() {
        let (start, end) = (range.start as u32, range.end as u32);
        let token = token.unwrap_or(Token::Unknown);
        match out.last_mut() {
            // One message for a run of characters that nobody can read.
            Some(last) if token == Token::Unknown && last.token == Token::Unknown && last.end == start => {
                last.end = end
            }
            _ => out.push(Lexeme { token, start, end }),
        }
    }
    out
}

impl Token {
    /// Words that open a statement, at the start of a line always.
    pub fn opens_statement(self) -> bool {
        use Token::*;
        matches!(self, Let | Fn | Param | Surface | Curve | Domain | Import)
    }

    pub fn is_keyword(self) -> bool {
        use Token::*;
        self.opens_statement() || matches!(self, Where | In | If | Then | Else | And | Or | Not)
    }

    pub fn is_relation(self) -> bool {
        use Token::*;
        matches!(self, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
    }

    /// An operator that needs something on its left and on its right (`-` can do without the left).
    pub fn is_binary(self) -> bool {
        use Token::*;
        self.is_relation() || matches!(self, Plus | Minus | Star | Cross | Slash | Caret | And | Or)
    }

    /// Whether an operand can end with this token.
    pub fn ends_operand(self) -> bool {
        use Token::*;
        matches!(self, Number | Superscript | Name | RightParen | RightBracket | BarClose)
    }

    /// Whether an operand can begin with this token and so stand behind another one as a factor.
    pub fn begins_operand(self) -> bool {
        use Token::*;
        matches!(self, Number | Name | LeftParen | LeftBracket | BarOpen)
    }

    /// A line that ends with this token goes on.
    pub fn continues_after(self) -> bool {
        use Token::*;
        self.is_binary() || self.is_keyword() || matches!(self, Comma | Colon | ArgumentEqual | BoxTimes)
    }

    /// A line that begins with this token continues the line before.
    pub fn continues_before(self) -> bool {
        use Token::*;
        self.is_binary() || matches!(self, Where | In | Then | Else | Comma | Colon | Superscript)
    }

    /// The name of the kind, for `imp emit tokens`.
    pub fn kind(self) -> &'static str {
        use Token::*;
        match self {
            Newline => "newline",
            Comment => "comment",
            Number => "number",
            Superscript => "superscript",
            Name => "name",
            Text => "text",
            BadHexadecimal | OpenText | Foreign | Unknown => "unreadable",
            Juxtaposed => "juxtaposed",
            BarOpen => "bar open",
            BarClose => "bar close",
            BoxTimes => "box product",
            ArgumentEqual => "argument",
            LeftParen | RightParen | LeftBracket | RightBracket => "bracket",
            Bar => "bar",
            Comma | Colon | Semicolon => "punctuation",
            Let | Fn | Param | Surface | Curve | Domain | Import | Where | In | If | Then | Else => "keyword",
            And | Or | Not | Plus | Minus | Star | Cross | Slash | Caret => "operator",
            Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual => "relation",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(Token, &str)> {
        lex(text).iter().map(|l| (l.token, &text[l.start as usize..l.end as usize])).collect()
    }

    #[test]
    fn numbers_take_the_longest_reading() {
        use Token::*;
        assert_eq!(kinds("2e3x"), [(Number, "2e3"), (Name, "x")]);
        assert_eq!(kinds("2exp"), [(Number, "2"), (Name, "exp")]);
        assert_eq!(kinds("2e"), [(Number, "2"), (Name, "e")]);
        assert_eq!(kinds(".5.5"), [(Number, ".5"), (Number, ".5")]);
        assert_eq!(kinds("0x1.8p+1x"), [(Number, "0x1.8p+1"), (Name, "x")]);
        assert_eq!(kinds("0x1p3 0X.8P-2"), [(Number, "0x1p3"), (Number, "0X.8P-2")]);
        assert_eq!(kinds("0x"), [(Number, "0"), (Name, "x")]);
        assert_eq!(kinds("0x1f"), [(BadHexadecimal, "0x1f")]);
    }

    #[test]
    fn names_and_keywords() {
        use Token::*;
        assert_eq!(kinds("x' lets φ_1 in"), [(Name, "x'"), (Name, "lets"), (Name, "φ_1"), (In, "in")]);
        assert_eq!(
            kinds("a\r\nb # c\n"),
            [(Name, "a"), (Newline, "\r\n"), (Name, "b"), (Comment, "# c"), (Newline, "\n")]
        );
        assert_eq!(kinds("||x|"), [(Bar, "|"), (Bar, "|"), (Name, "x"), (Bar, "|")]);
        assert_eq!(kinds("@@\u{1F600} x²"), [(Unknown, "@@\u{1F600}"), (Name, "x"), (Superscript, "²")]);
        assert_eq!(kinds("\"a b\" \"c"), [(Text, "\"a b\""), (OpenText, "\"c")]);
    }
}
