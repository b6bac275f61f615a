//! The ray caster and the plotter of plane scenes.

mod certificate;
mod plane;
mod scenes;
mod space;
