//! CAPS: the arrangement that implicit curves induce in a box, and how sure each part of it is (Hijazi et al. 2007;
//! Hijazi, "Feature based visualization", 2007, section 4.5).
//!
//! Stages, each a pure function of the one before: `subdivide` quarters the box until each cell is settled or too
//! small, `sides` isolates where curves cross the sides of cells, `local` joins these nodes within each cell, together a
//! [`Complex`]; `build` turns that into halfedges and faces. [`published`] is the algorithm as the source has it.

mod assemble;
mod cluster;
pub mod complex;
pub mod field;
mod functions;
mod local;
mod newton;
pub mod options;
mod sides;
mod solve;
pub mod structure;
mod subdivide;
mod tiling;

pub use complex::Complex;
pub use field::Fields;
pub use options::Options;
pub use solve::solve;
pub use structure::Arrangement;
