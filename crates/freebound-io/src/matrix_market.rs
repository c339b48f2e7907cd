//! Linear systems as Matrix Market files: a sparse matrix, and a right-hand side.

use std::io::{self, Write};

use freebound_core::flatten::{StepSystem, SystemEntry, SystemRow};
use freebound_core::mesh::VertexId;

/// Largest length of a line of comments, characters.
const LINE: usize = 96;

/// Linear system with its numbering, ready to be written.
#[derive(Debug)]
pub struct MatrixFile<'a> {
    /// The system.
    pub system: &'a StepSystem,
    /// Description of the step: mesh, method, stage.
    pub about: String,
    /// Number of each vertex in the file of the mesh.
    pub numbers: Vec<VertexId>,
}

impl MatrixFile<'_> {
    /// Number of real numbers for each complex one: 2 if u and v depend on each other.
    fn parts(&self) -> usize {
        if self.system.is_coupled { 2 } else { 1 }
    }

    /// Writes the matrix in coordinates.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_matrix(&self, out: &mut impl Write) -> io::Result<()> {
        let (system, parts) = (self.system, self.parts());
        writeln!(out, "%%MatrixMarket matrix coordinate real general")?;
        self.write_comments(out)?;
        let (rows, columns) = (system.rows.len(), system.unknowns.len());
        let has = |part: f64| part != 0.0;
        let count = system.entries.iter().map(|entry| {
            let parts_there = usize::from(has(entry.value.re)) + usize::from(has(entry.value.im));
            parts * parts_there
        });
        writeln!(out, "{} {} {}", parts * rows, parts * columns, count.sum::<usize>())?;
        for &SystemEntry { row, column, value } in &system.entries {
            let (row, column) = (row + 1, column + 1);
            if has(value.re) {
                writeln!(out, "{row} {column} {:?}", value.re)?;
            }
            if parts == 2 {
                if has(value.im) {
                    writeln!(out, "{row} {} {:?}", columns + column, -value.im)?;
                    writeln!(out, "{} {column} {:?}", rows + row, value.im)?;
                }
                if has(value.re) {
                    writeln!(out, "{} {} {:?}", rows + row, columns + column, value.re)?;
                }
            }
        }
        Ok(())
    }

    /// Writes the right-hand side as an array of two columns.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_right_side(&self, out: &mut impl Write) -> io::Result<()> {
        let system = self.system;
        writeln!(out, "%%MatrixMarket matrix array real general")?;
        writeln!(out, "% Right-hand side b of A z = b. {}", self.about)?;
        if system.is_coupled {
            writeln!(
                out,
                "% Column 1 gives (u, v): first all u, then all v. Column 2 gives (-v, u), the map turned by"
            )?;
            writeln!(out, "% 90 degrees, and needs no solve of its own.")?;
        } else {
            writeln!(out, "% Column 1 gives u, column 2 gives v.")?;
        }
        writeln!(out, "{} 2", self.parts() * system.rows.len())?;
        let (re, im) = (|| system.right_side.iter().map(|b| b.re), || system.right_side.iter().map(|b| b.im));
        let first = re().chain(im().filter(|_| system.is_coupled));
        let second: Vec<f64> = if system.is_coupled { im().map(|b| -b).chain(re()).collect() } else { im().collect() };
        for value in first.chain(second) {
            writeln!(out, "{value:?}")?;
        }
        Ok(())
    }

    fn write_comments(&self, out: &mut impl Write) -> io::Result<()> {
        let system = self.system;
        writeln!(out, "% Matrix A of the linear system A z = b. {}", self.about)?;
        writeln!(out, "% Row of a vertex v: sum over its links h of a_h (z_head(h) - z_v) = 0, so the diagonal holds")?;
        writeln!(out, "% -sum a_h. The weights a_h are those of the method. Terms of vertices with a known position")?;
        writeln!(out, "% stand in b with the opposite sign.")?;
        if system.is_coupled {
            writeln!(
                out,
                "% The weights are complex, because the boundary is free: a = p + iq is written as p, -q, q, p."
            )?;
            writeln!(
                out,
                "% Unknowns: first u of all columns below, then v of all. Rows: real parts, then imaginary."
            )?;
        } else {
            writeln!(out, "% The weights are real: one matrix for u and v.")?;
        }
        if system.is_square() {
            writeln!(
                out,
                "% As many rows as unknowns: A z = b. Equations of vertices with a known position are left out."
            )?;
        } else {
            writeln!(out, "% More rows than unknowns: z minimises |A z - b|, with the equations of pins kept.")?;
        }
        let of_rows = |wanted: fn(&SystemRow) -> Option<VertexId>| -> Vec<VertexId> {
            system.rows.iter().filter_map(wanted).collect()
        };
        let equations = of_rows(|row| if let SystemRow::Equation(vertex) = row { Some(*vertex) } else { None });
        let soft = of_rows(|row| if let SystemRow::SoftPin(vertex) = row { Some(*vertex) } else { None });
        writeln!(out, "% Vertices are numbered from 0, as in the file of the mesh.")?;
        self.write_list(out, "Columns, in order", &system.unknowns)?;
        self.write_list(out, "Rows of equations, in order", &equations)?;
        if !soft.is_empty() {
            self.write_list(out, "Then rows w z_v = w t of soft pins, in order", &soft)?;
        }
        self.write_list(out, "Known positions: pins and prescribed boundary", &system.known)
    }

    /// Writes vertices as ranges, in lines of comments.
    fn write_list(&self, out: &mut impl Write, title: &str, vertices: &[VertexId]) -> io::Result<()> {
        let mut ranges: Vec<[u32; 2]> = Vec::new();
        for number in vertices.iter().map(|&vertex| self.numbers[vertex.index()].number()) {
            match ranges.last_mut() {
                Some([_, last]) if last.checked_add(1) == Some(number) => *last = number,
                _ => ranges.push([number; 2]),
            }
        }
        let mut line = format!("% {title}:");
        for [first, last] in ranges {
            let words = if first == last { format!(" {first}") } else { format!(" {first}-{last}") };
            if line.len() + words.len() > LINE {
                writeln!(out, "{line}")?;
                "%  ".clone_into(&mut line);
            }
            line.push_str(&words);
        }
        writeln!(out, "{line}")
    }
}
