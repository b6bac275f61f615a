//! Coefficients and constants of the elementary functions.
//!
//! `tests/elementary/coefficients.sollya` makes the coefficients (`fpminimax`) and certifies the approximation error
//! stated with each table (`supnorm`), as a fraction of [`Format::epsilon`](super::Format). Constants are split here
//! by rounding the exact value to the format, then the rest, and so on.

#![expect(clippy::approx_constant, reason = "a constant's parts are numbers of a table, heads included")]

/// Coefficients of one polynomial, the constant one first.
pub struct Polynomial {
    pub single: &'static [f32],
    pub double: &'static [f64],
}

/// One constant as a sum of numbers of the format, each smaller than an ulp of the one before.
pub struct Constant {
    pub single: &'static [f32],
    pub double: &'static [f64],
}

/// e^r - 1 = r + r^2 q(r) for |r| <= 0.3467: q.
/// Relative error <= 0.118 epsilon (single), 0.088 epsilon (double).
pub const EXP: Polynomial = Polynomial {
    single: &[0.49999997, 0.16666543, 0.041667502, 0.008366539, 0.0013864556],
    double: &[
        0.5000000000000006,
        0.16666666666666594,
        0.04166666666657371,
        0.00833333333338624,
        0.0013888888932344497,
        0.00019841269727158823,
        2.4801504484968054e-05,
        2.7557399536379036e-06,
        2.762631326047002e-07,
        2.5056503070431654e-08,
    ],
};

/// 2 atanh s = 2 s + s z P(z), z = s^2, for |s| <= 0.1717: P.
/// Relative error <= 0.007 epsilon (single), 0.006 epsilon (double).
pub const LN: Polynomial = Polynomial {
    single: &[0.66666776, 0.39977568, 0.2987151],
    double: &[
        0.6666666666666735,
        0.39999999999409713,
        0.2857142874356461,
        0.22222198443972385,
        0.1818357149579129,
        0.15313855444726068,
        0.14798017536961214,
    ],
};

/// sin r = r + r u S(u), u = r^2, for |r| <= 0.7855 (single: 0.80): S.
/// Relative error <= 0.039 epsilon (single), 0.018 epsilon (double).
pub const SIN: Polynomial = Polynomial {
    single: &[-0.16666654, 0.008332095, -0.0001950554],
    double: &[
        -0.1666666666666663,
        0.008333333333321919,
        -0.0001984126982945851,
        2.755731358226442e-06,
        -2.5050742320642017e-08,
        1.589594363745134e-10,
    ],
};

/// cos r = 1 + u C(u), u = r^2, on the same range: C. The error is relative to cos r - 1.
/// Relative error <= 0.008 epsilon (single), 0.003 epsilon (double).
pub const COS: Polynomial = Polynomial {
    single: &[-0.5, 0.041666653, -0.0013887618, 2.4462344e-05],
    double: &[
        -0.5,
        0.041666666666666644,
        -0.0013888888888881768,
        2.480158729422002e-05,
        -2.755731570323664e-07,
        2.087590392395585e-09,
        -1.1368832084489533e-11,
    ],
};

/// atan t = t + t z P(z), z = t^2, for |t| <= 1: P.
/// Relative error <= 0.141 epsilon (single), 0.128 epsilon (double).
pub const ATAN: Polynomial = Polynomial {
    single: &[-0.33333153, 0.19993769, -0.14211023, 0.1066588, -0.07551952, 0.04320876, -0.016366003, 0.0029202034],
    double: &[
        -0.3333333333333186,
        0.1999999999975519,
        -0.1428571427134188,
        0.11111110678905126,
        -0.09090901237534682,
        0.07692212950330658,
        -0.0666586049318346,
        0.058773084003196856,
        -0.05239235294031089,
        0.04673955995155479,
        -0.040926519391092084,
        0.03406803869926244,
        -0.02582708849366313,
        0.016978321219657935,
        -0.009184768399249288,
        0.0038560860801790365,
        -0.0011641121853464271,
        0.00022303139312023209,
        -2.0259475852124486e-05,
    ],
};

/// asin s = s + s z R(z), z = s^2, for |s| <= 1/2: R.
/// Relative error <= 0.041 epsilon (single), 0.067 epsilon (double).
pub const ASIN: Polynomial = Polynomial {
    single: &[0.16666752, 0.0749531, 0.04546902, 0.024185503, 0.042157013],
    double: &[
        0.16666666666665408,
        0.07500000000337102,
        0.044642856828270135,
        0.030381959138980525,
        0.02237175800875863,
        0.01735970531598465,
        0.013885230606394317,
        0.012169240313613137,
        0.0065278628477992455,
        0.01952854650514719,
        -0.016224659548438252,
        0.03191252849702112,
    ],
};

/// sinh r = r + r z S(z), z = r^2, for |r| <= 0.3467: S.
/// Relative error <= 0.001 epsilon (single), 0.002 epsilon (double).
pub const SINH: Polynomial = Polynomial {
    single: &[0.16666667, 0.008333192, 0.00019958474],
    double: &[
        0.16666666666666677,
        0.008333333333321456,
        0.00019841269886514097,
        2.755724385584514e-06,
        2.5109151050986157e-08,
    ],
};

/// cosh r = 1 + z C(z), z = r^2, for |r| <= 0.3467: C. The error is relative to cosh r - 1.
/// Relative error <= 0.028 epsilon (single), 0.001 epsilon (double).
pub const COSH: Polynomial = Polynomial {
    single: &[0.5, 0.04166651, 0.0013930509],
    double: &[
        0.5,
        0.04166666666666667,
        0.0013888888888882163,
        2.4801587330004376e-05,
        2.755726893104363e-07,
        2.0916366700924497e-09,
    ],
};

/// m^(-1/3) on [2^(-3/2), 2^(3/2)], for both formats. Relative error <= 3.01e-3.
pub const CBRT_SEED: [f32; 6] = [2.0151553, -2.3868656, 2.3062735, -1.2357017, 0.3345674, -0.03569153];

/// 1/(1 + f) on [-0.293, 0.4143], for both formats. Relative error <= 0.059.
pub const RECIPROCAL: [f32; 2] = [1.0553966, -0.9412259];

/// log2 10.
pub const LOG2_10: Constant = Constant { single: &[3.321928], double: &[3.321928094887362] };

/// ln 2.
pub const LN_2: Constant =
    Constant { single: &[0.6931472, -1.9046542e-09], double: &[0.6931471805599453, 2.3190468138462996e-17] };

/// ln 10.
pub const LN_10: Constant =
    Constant { single: &[2.3025851, -3.1975436e-08], double: &[2.302585092994046, -2.1707562233822494e-16] };

/// log10 2.
pub const LOG10_2: Constant =
    Constant { single: &[0.30103, -1.4320989e-08], double: &[0.3010299956639812, -2.8037281277851704e-18] };

/// ln 2, its head short enough for exact multiples by an exponent.
pub const LN_2_SHORT: Constant =
    Constant { single: &[0.69314575, 1.4286068e-06], double: &[0.6931471805601177, -1.7239444525614835e-13] };

/// log10 2, its head short enough for exact multiples by an exponent.
pub const LOG10_2_SHORT: Constant =
    Constant { single: &[0.3010254, 4.605039e-06], double: &[0.3010299956640665, -8.532344317057107e-14] };

/// 1 / ln 10.
pub const LOG10_E: Constant =
    Constant { single: &[0.4342945, -1.010305e-08], double: &[0.4342944819032518, 1.098319650216765e-17] };

/// 1 / ln 2.
pub const LOG2_E: Constant =
    Constant { single: &[1.442695, 1.925963e-08], double: &[1.4426950408889634, 2.0355273740931033e-17] };

/// 2 / pi.
pub const TWO_OVER_PI: Constant = Constant { single: &[0.63661975], double: &[0.6366197723675814] };

/// pi / 2.
pub const HALF_PI: Constant = Constant {
    single: &[1.5707964, -4.371139e-08, -1.7151245e-15],
    double: &[1.5707963267948966, 6.123233995736766e-17, -1.4973849048591698e-33],
};

/// pi.
pub const PI: Constant =
    Constant { single: &[3.1415927, -8.742278e-08], double: &[3.141592653589793, 1.2246467991473532e-16] };
