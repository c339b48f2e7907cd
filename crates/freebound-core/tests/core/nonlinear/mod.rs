//! Energies: fold-over, SLIM, angles.

pub(crate) mod angles;
pub(crate) mod foldover_energy;
pub(crate) mod slim;
