//! The stable codes of all messages: E01xx the text, E02xx names and kinds, E03xx the scene, E04xx files and
//! arguments, E09xx faults of Imp itself. A code never changes its meaning.

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $code:literal;)+) => {
        $($(#[doc = $doc])+ pub const $name: &str = $code;)+

        /// Every code with what it means, in ascending order.
        pub const ALL: &[(&str, &str)] = &[$(($code, concat!($($doc),+))),+];
    };
}

codes! {
    /// A character that the language does not use.
    UNKNOWN_CHARACTER = "E0101";
    /// An operator of another language that is spelled differently here.
    FOREIGN_OPERATOR = "E0102";
    /// A quoted text that is not closed on its line.
    OPEN_TEXT = "E0103";
    /// A number written in a way that cannot be read.
    BAD_NUMBER = "E0104";
    /// A number with more digits or a larger exponent than exact constants may have.
    NUMBER_TOO_LARGE = "E0105";
    /// A bracket without its partner.
    BRACKET = "E0106";
    /// An expression nested too deeply.
    TOO_DEEP = "E0107";
    /// Absolute value bars that pair in no way or in several.
    BARS = "E0108";
    /// Two numbers side by side.
    ADJACENT_NUMBERS = "E0109";
    /// A division by a product without a sign between its factors, which can be read in two ways.
    AMBIGUOUS_DIVISION = "E0110";
    /// A function without brackets around its argument.
    FUNCTION_WITHOUT_BRACKETS = "E0111";
    /// Relations that cannot stand in one chain.
    MIXED_RELATIONS = "E0112";
    /// A line that may continue the one before or begin anew.
    AMBIGUOUS_LINE = "E0113";
    /// An operator or bracket that lacks what it works on.
    MISSING_OPERAND = "E0114";
    /// Something that cannot stand where it is.
    UNEXPECTED = "E0115";
    /// A word of the language used as a name.
    RESERVED_WORD = "E0116";
    /// A statement that lacks one of its parts.
    INCOMPLETE_STATEMENT = "E0117";
    /// A domain repeated a number of times that makes no space.
    BAD_REPETITION = "E0118";
    /// More errors than are worth showing at once.
    TOO_MANY_ERRORS = "E0119";

    /// A name that nothing defines.
    UNKNOWN_NAME = "E0201";
    /// A name defined twice.
    DUPLICATE_NAME = "E0202";
    /// A function called with too many or too few arguments.
    WRONG_ARITY = "E0203";
    /// A value of one kind where another is needed.
    WRONG_KIND = "E0204";

    /// A file whose bytes are not UTF-8 text.
    NOT_TEXT = "E0401";
    /// A file too large to be read.
    FILE_TOO_LARGE = "E0402";
    /// A file that cannot be opened.
    CANNOT_OPEN = "E0403";

    /// A fault of Imp, not of its user.
    INTERNAL = "E0901";
}

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn codes_ascend_without_repetition() {
        assert!(ALL.windows(2).all(|w| w[0].0 < w[1].0));
        assert!(ALL.iter().all(|(code, doc)| code.len() == 5 && doc.trim().ends_with('.')));
    }
}
