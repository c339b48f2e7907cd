//! Native module of the Python package `freebound`. The package wraps it: see `python/freebound`.
//!
//! | file        | contents                                                 |
//! |-------------|----------------------------------------------------------|
//! | `arrays`    | numpy arrays, out                                        |
//! | `mesh`      | meshes from arrays and from files                        |
//! | `options`   | options of a run                                         |
//! | `errors`    | errors of the package                                    |
//! | `job`       | a run on a thread of its own                             |
//! | `layout`    | finished layouts                                         |
//! | `copied`    | layouts and pictures of one mesh on another              |
//! | `packed`    | new places for the charts of a given layout              |
//! | `flattener` | a method step by step                                    |
//! | `drag`      | dragged pins                                             |
//! | `equations` | the matrices of the paper                                |

mod arrays;
mod copied;
mod drag;
mod equations;
mod errors;
mod flattener;
mod job;
mod layout;
mod mesh;
mod options;
mod packed;

/// Native module of the package `freebound`.
#[pyo3::pymodule]
mod _freebound {
    #[pymodule_export]
    use super::copied::{Baked, Transferred, bake, picture_of, read_picture, transfer};
    #[pymodule_export]
    use super::drag::Drag;
    #[pymodule_export]
    use super::equations::equations;
    #[pymodule_export]
    use super::flattener::{Flattener, FlattenerStep};
    #[pymodule_export]
    use super::job::Job;
    #[pymodule_export]
    use super::layout::Layout;
    #[pymodule_export]
    use super::mesh::{Mesh, check};
    #[pymodule_export]
    use super::options::check_options;
    #[pymodule_export]
    use super::packed::{Packed, charts, pack};

    /// Version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
