//! The stable codes of all messages: E01xx the text, E02xx names and kinds, E03xx the scene, E04xx files and
//! arguments, E05xx pictures and certificates, E09xx faults of Imp itself. A code never changes its meaning.

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
    /// A definition that takes a name of the language.
    RESERVED_NAME = "E0205";
    /// Definitions that need each other in a circle.
    CIRCLE = "E0206";
    /// A name that two imported files define.
    AMBIGUOUS_NAME = "E0207";
    /// An import that cannot be read.
    CANNOT_IMPORT = "E0208";
    /// An argument that is unknown, given twice, or in the wrong place.
    BAD_ARGUMENT = "E0209";
    /// An equation where an inside is needed.
    EQUATION_AS_SOLID = "E0210";
    /// An exponent that is too large to be exact.
    EXPONENT_TOO_LARGE = "E0211";
    /// Arguments behind something that is no function.
    NOT_A_FUNCTION = "E0212";
    /// A derivative by something that is no variable.
    DERIVATIVE_BY = "E0213";
    /// A list of the wrong length, or a component outside of it.
    LIST_LENGTH = "E0214";
    /// A formula that grows without bound when its functions and lists are written out.
    TOO_MUCH_EXPANSION = "E0215";
    /// A variable of an expression that has no value.
    NO_VALUE = "E0216";
    /// A formula that takes longer to compile than is allowed.
    TOO_SLOW = "E0217";
    /// A formula that is larger than is allowed, or becomes so on the way to machine code.
    LARGER_THAN_ALLOWED = "E0218";

    /// Something that must be a constant and is not.
    NOT_CONSTANT = "E0301";
    /// A constant without a finite value.
    NOT_FINITE = "E0302";
    /// A range whose ends are not in order.
    EMPTY_RANGE = "E0303";
    /// A setting of the scene that cannot be understood.
    BAD_SETTING = "E0304";
    /// A number outside of its range.
    OUT_OF_RANGE = "E0305";
    /// Something set twice.
    SET_TWICE = "E0306";
    /// Shapes and domain that do not agree on the plane or on space.
    DIMENSION = "E0307";
    /// A statement that is neither an equation nor a region.
    NOT_A_SHAPE = "E0308";
    /// A shape that is the same everywhere.
    NO_COORDINATE = "E0309";
    /// A file without any shape.
    NO_SHAPE = "E0310";
    /// A value from outside for a parameter that cannot take it.
    BAD_OVERRIDE = "E0311";

    /// A file whose bytes are not UTF-8 text.
    NOT_TEXT = "E0401";
    /// A file too large to be read.
    FILE_TOO_LARGE = "E0402";
    /// A file that cannot be opened.
    CANNOT_OPEN = "E0403";
    /// A file that cannot be written.
    CANNOT_WRITE = "E0404";
    /// Arguments of a command that do not fit together or do not fit the scene.
    BAD_OPTION = "E0405";
    /// A scene that is not in canonical layout, where that was asked.
    NOT_FORMATTED = "E0406";
    /// Formulas so large that compiling them takes a while.
    LARGE_FORMULA = "E0407";
    /// A value that is neither a number nor a box.
    BAD_VALUE = "E0421";
    /// A line of `imp eval --json` that is no request.
    BAD_REQUEST = "E0422";
    /// A command of the REPL that does not exist or lacks something.
    BAD_COMMAND = "E0423";

    /// A camera that sees nothing.
    BAD_CAMERA = "E0501";
    /// A domain that has no extent or no bounds.
    NO_EXTENT = "E0502";
    /// A picture of no pixels, or of too many.
    PICTURE_SIZE = "E0503";
    /// Work that was stopped before it was complete.
    STOPPED = "E0504";
    /// Worker threads that cannot be started.
    NO_THREADS = "E0505";
    /// A picture that can have no certificate.
    NO_CERTIFICATE = "E0506";
    /// A file that is no certificate, or a damaged one.
    NOT_A_CERTIFICATE = "E0507";
    /// A certificate of another scene.
    OTHER_SCENE = "E0508";
    /// A certificate that does not prove what it claims.
    REJECTED = "E0509";
    /// A program too large to be compiled; never shown, the interpreter takes it.
    KERNEL_TOO_LARGE = "E0510";

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
