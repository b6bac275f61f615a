//! Certified zeros: the reference search, and the compiled solvers against it and against higher precision.

mod answers;
mod oracle;
mod planted;
mod random;
mod rays;
mod reference;
mod use_cases;
