//! The ray caster and the plotter of plane scenes.

mod certificate;
mod plane;
mod scenes;
mod soundness;
mod space;
