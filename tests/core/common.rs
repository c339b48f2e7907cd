//! Meshes by name, and the corpus.

use std::fs;
use std::path::{Path, PathBuf};

use freebound::io::{ObjMesh, read_mesh};
use freebound::mesh::{DiskMesh, TriMesh};
use glam::DVec3;

/// The folder of test meshes, where there is one. Says so where there is none.
pub(crate) fn corpus() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus");
    if folder.join("manifest.csv").is_file() {
        return Some(folder);
    }
    println!("nothing to do: there is no corpus at {}", folder.display());
    None
}

/// One line of the corpus's manifest.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Path under the corpus.
    pub(crate) file: String,
    /// Where it lies.
    pub(crate) path: PathBuf,
    columns: Vec<(String, String)>,
}

impl Entry {
    /// A column as text.
    pub(crate) fn text(&self, column: &str) -> &str {
        &self.columns.iter().find(|(name, _)| name == column).expect("the manifest has the column").1
    }

    /// A column as a number, if it has one.
    pub(crate) fn number(&self, column: &str) -> Option<i64> {
        self.text(column).parse().ok()
    }

    /// The file as read.
    pub(crate) fn read(&self) -> ObjMesh {
        read_mesh(&self.path).unwrap_or_else(|error| panic!("{}: {error}", self.file))
    }

    /// The file as triangles.
    pub(crate) fn mesh(&self) -> TriMesh {
        self.read().polygons.triangulate()
    }

    /// The file as a disk.
    pub(crate) fn disk(&self) -> DiskMesh {
        DiskMesh::try_from(self.mesh()).unwrap_or_else(|faults| panic!("{}: {faults}", self.file))
    }
}

/// All files of the corpus, in the manifest's order. Empty where there is no corpus.
pub(crate) fn manifest() -> Vec<Entry> {
    let Some(folder) = corpus() else { return Vec::new() };
    let text = fs::read_to_string(folder.join("manifest.csv")).expect("the manifest is readable");
    let mut rows = csv_rows(&text).into_iter();
    let head = rows.next().expect("the manifest has a head");
    rows.map(|row| {
        assert_eq!(row.len(), head.len(), "{row:?}");
        let file = row[0].clone();
        Entry { path: folder.join(&file), file, columns: head.iter().cloned().zip(row).collect() }
    })
    .collect()
}

/// The disks of the corpus.
pub(crate) fn corpus_disks() -> Vec<Entry> {
    manifest().into_iter().filter(|entry| !entry.file.starts_with("bad/")).collect()
}

/// Rows of comma-separated values; fields may be quoted, with quotes inside doubled.
pub(crate) fn csv_rows(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut field) = (Vec::new(), Vec::new(), String::new());
    let mut quoted = false;
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                field.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => row.push(std::mem::take(&mut field)),
            '\r' if !quoted => {}
            '\n' if !quoted => {
                row.push(std::mem::take(&mut field));
                rows.push(std::mem::take(&mut row));
            }
            _ => field.push(c),
        }
    }
    if !field.is_empty() || !row.is_empty() {
        row.push(field);
        rows.push(row);
    }
    rows
}

/// A flat grid of `columns` × `rows` unit squares, each cut along the diagonal from its lower left corner.
pub(crate) fn grid(columns: u32, rows: u32) -> TriMesh {
    let stride = columns + 1;
    let mut positions = Vec::new();
    for y in 0..=rows {
        positions.extend((0..=columns).map(|x| DVec3::new(f64::from(x), f64::from(y), 0.0)));
    }
    let mut triangles = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            let v = y * stride + x;
            triangles.push([v, v + 1, v + stride + 1]);
            triangles.push([v, v + stride + 1, v + stride]);
        }
    }
    TriMesh::new(positions, &triangles)
}

/// A closed fan: vertex 0 in the middle of a regular polygon with `sides` corners.
pub(crate) fn fan(sides: u32) -> TriMesh {
    let on_rim = |k| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
        DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let positions = std::iter::once(DVec3::ZERO).chain((0..sides).map(on_rim)).collect();
    let triangles: Vec<[u32; 3]> = (0..sides).map(|k| [0, 1 + k, 1 + (k + 1) % sides]).collect();
    TriMesh::new(positions, &triangles)
}

/// A tetrahedron, closed, its faces counter-clockwise seen from outside.
pub(crate) fn tetrahedron() -> TriMesh {
    let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(DVec3::from).to_vec();
    TriMesh::new(positions, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
}

/// A band of squares around a ring of `length`, joined with its beginning straight or twisted.
pub(crate) fn band(length: u32, twisted: u32) -> TriMesh {
    let at = |k: u32, side: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(length);
        let tilt = angle / 2.0 * f64::from(twisted);
        let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
        out * 3.0 + (out * tilt.cos() + DVec3::Z * tilt.sin()) * (f64::from(side) - 0.5)
    };
    let positions = (0..length).flat_map(|k| [at(k, 0), at(k, 1)]).collect();
    let squares = (0..length).flat_map(|k| {
        let [a, b] = [2 * k, 2 * k + 1];
        let [mut c, mut d] = [2 * ((k + 1) % length), 2 * ((k + 1) % length) + 1];
        if k + 1 == length && twisted == 1 {
            std::mem::swap(&mut c, &mut d);
        }
        [[a, b, d], [a, d, c]]
    });
    TriMesh::new(positions, &squares.collect::<Vec<_>>())
}

/// Numbers that look random and are the same in every run (splitmix64).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// A number from 0 to `limit`, without `limit`.
    pub(crate) fn below(&mut self, limit: u32) -> u32 {
        u32::try_from(self.bits() % u64::from(limit)).expect("smaller than a u32")
    }

    /// A number from 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
}
