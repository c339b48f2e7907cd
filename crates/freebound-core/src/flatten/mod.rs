//! A method from its settings to proved steps.
//!
//! | file | contents |
//! |---|---|
//! | `one_call` | [`flatten`]: all steps of a method in one call |
//! | `flattener/` | [`Flattener`]: stage after stage, each step proved |
//! | `prepared`, `tutte` | equations and factors of a linear method; Tutte's map |
//! | `placing`, `upright` | place, size and turn of an embedding that pins leave free |
//! | `equation` | the equation of a vertex in a step |
//! | `linear_system` | the linear system of a step as numbers |

mod equation;
mod flattener;
mod linear_system;
mod one_call;
mod placing;
mod prepared;
mod tutte;
mod upright;

pub use equation::equation_of_step;
pub use flattener::{Candidate, Ending, Flattener, Options, PlanarStart, SolverCache, Step, largest_move};
pub use linear_system::{NoLinearSystem, StepSystem, SystemEntry, SystemRow, linear_system_of_step};
pub use one_call::{FlattenError, flatten};
pub use placing::{to_true_area, to_unit_box, to_unit_square, to_unit_square_by_power_of_two, true_area_factor};
pub use prepared::{Prepared, solve_once};
