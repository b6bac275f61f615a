//! CAPS: the arrangement that implicit curves induce in a box, and how sure each part of it is (Hijazi et al. 2007;
//! Hijazi, "Feature based visualization", 2007, section 4.5).
//!
//! Stages, each a pure function of the one before: `subdivide` quarters the box until each cell is settled or too
//! small, `sides` isolates where curves cross the sides of cells, `local` joins these nodes within each cell, together a
//! [`Complex`]; [`build`](mod@build) turns that into halfedges and faces. [`published`] is the algorithm as the source has it.

mod assemble;
pub mod build;
pub mod certificate;
pub mod check;
mod cluster;
pub mod complex;
pub mod exact;
pub mod export;
pub mod field;
mod functions;
pub mod geometry;
pub mod index;
mod local;
pub mod locate;
mod merge;
mod newton;
pub mod options;
mod projective;
pub mod published;
pub mod query;
mod settle;
mod sides;
mod solve;
pub mod structure;
mod subdivide;
mod tiling;

pub use complex::Complex;
pub use field::Fields;
pub use merge::merge;
pub use options::Options;
pub use projective::projective;
pub use solve::arrange;
pub use solve::replay;
pub use solve::solve;
pub use structure::Arrangement;
