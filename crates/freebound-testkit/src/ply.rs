//! Makes and parses PLY files, number by number. Independent of the library's reader and writer.

use std::fmt::Write as _;

use freebound_core::mesh::PolygonMesh;

/// Encoding of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Text,
    Little,
    Big,
}

impl Encoding {
    pub const ALL: [Self; 3] = [Self::Text, Self::Little, Self::Big];

    fn name(self) -> &'static str {
        match self {
            Self::Text => "ascii",
            Self::Little => "binary_little_endian",
            Self::Big => "binary_big_endian",
        }
    }
}

/// A PLY file of a mesh.
#[derive(Clone, Copy)]
pub struct PlyMaker<'a> {
    pub mesh: &'a PolygonMesh,
    pub encoding: Encoding,
    /// Type of positions.
    pub number: &'static str,
    /// Type of the corners of faces, and name of their list.
    pub index: &'static str,
    pub corners: &'static str,
    /// Names of the texture coordinates of vertices. Their values are the x and y of the vertices.
    pub at_vertices: Option<[&'static str; 2]>,
    /// Number of faces with texture coordinates of corners. Their values are the x and y of the corners.
    pub at_corners: Option<usize>,
    /// True if the file has properties and elements beside those of the mesh.
    pub is_rich: bool,
}

impl<'a> PlyMaker<'a> {
    pub fn plain(mesh: &'a PolygonMesh) -> Self {
        let [number, index, corners] = ["double", "int", "vertex_indices"];
        let (at_vertices, at_corners) = (None, None);
        Self { mesh, encoding: Encoding::Text, number, index, corners, at_vertices, at_corners, is_rich: false }
    }

    pub fn rich(mesh: &'a PolygonMesh) -> Self {
        Self { is_rich: true, ..Self::plain(mesh) }
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut out = self.head().into_bytes();
        let mut put = Put { out: &mut out, encoding: self.encoding };
        for (k, p) in self.mesh.positions.iter().enumerate() {
            if self.is_rich {
                put.number("uchar", (k % 256) as f64);
            }
            p.to_array().iter().for_each(|&x| put.number(self.number, x));
            if self.at_vertices.is_some() {
                for x in [p.x, p.y] {
                    put.number(self.number, x);
                }
            }
            if self.is_rich {
                put.list("uchar", "short", &vec![-3.0; k % 3]);
                put.number("float", 0.5);
            }
            put.end();
        }
        if self.is_rich {
            for x in [7.0, 8.0] {
                put.number("double", x);
            }
            put.end();
        }
        for face in 0..self.mesh.face_count() {
            let corners: Vec<f64> = self.mesh.face(face).iter().map(|v| f64::from(v.number())).collect();
            if self.is_rich {
                put.number("int", -1.0);
            }
            put.list("uchar", self.index, &corners);
            if let Some(count) = self.at_corners {
                let flat = |v: &freebound_core::mesh::VertexId| self.mesh.positions[v.index()].truncate().to_array();
                let coordinates: Vec<f64> = self.mesh.face(face).iter().flat_map(flat).collect();
                put.list("uchar", self.number, if face < count { &coordinates } else { &[] });
            }
            if self.is_rich {
                put.number("uchar", 255.0);
            }
            put.end();
        }
        if self.is_rich {
            put.list("int", "int", &[0.0, 1.0, -1.0]);
            put.end();
        }
        out
    }

    fn head(&self) -> String {
        let mut head = format!("ply\nformat {} 1.0\ncomment TextureFile some.png\n", self.encoding.name());
        let mut line = |text: String| writeln!(head, "{text}").expect("memory");
        line(format!("element vertex {}", self.mesh.positions.len()));
        if self.is_rich {
            line("property uchar red".into());
        }
        for name in ["x", "y", "z"] {
            line(format!("property {} {name}", self.number));
        }
        self.at_vertices.iter().flatten().for_each(|name| line(format!("property {} {name}", self.number)));
        if self.is_rich {
            line("property list uchar short weights".into());
            line("property float confidence".into());
            line("obj_info made by hand".into());
            line("element camera 1\nproperty double focus\nproperty double range".into());
        }
        line(format!("element face {}", self.mesh.face_count()));
        if self.is_rich {
            line("property int32 flags".into());
        }
        line(format!("property list uchar {} {}", self.index, self.corners));
        if self.at_corners.is_some() {
            line(format!("property list uchar {} texcoord", self.number));
        }
        if self.is_rich {
            line("property uint8 alpha".into());
            line("element tristrips 1\nproperty list int int strip_indices".into());
        }
        line("end_header".into());
        head
    }
}

/// Writer of consecutive numbers.
struct Put<'a> {
    out: &'a mut Vec<u8>,
    encoding: Encoding,
}

impl Put<'_> {
    fn list(&mut self, count: &str, item: &str, items: &[f64]) {
        self.number(count, items.len() as f64);
        for &x in items {
            self.number(item, x);
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "tests give numbers of the type")]
    fn number(&mut self, kind: &str, x: f64) {
        let is_integer = !matches!(kind, "float" | "double");
        let mut little = match kind.trim_start_matches('u') {
            _ if self.encoding == Encoding::Text && is_integer => format!("{} ", x as i64).into_bytes(),
            _ if self.encoding == Encoding::Text => format!("{x:?} ").into_bytes(),
            "char" | "int8" => (x as i64).to_le_bytes()[..1].to_vec(),
            "short" | "int16" => (x as i64).to_le_bytes()[..2].to_vec(),
            "int" | "int32" => (x as i64).to_le_bytes()[..4].to_vec(),
            "float" => (x as f32).to_le_bytes().to_vec(),
            "double" => x.to_le_bytes().to_vec(),
            other => panic!("{other}"),
        };
        if self.encoding == Encoding::Big {
            little.reverse();
        }
        self.out.extend(little);
    }

    fn end(&mut self) {
        if self.encoding == Encoding::Text {
            self.out.pop();
            self.out.push(b'\n');
        }
    }
}

/// Element of a PLY file: a list of rows.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyElement {
    pub name: String,
    /// Type and name of each property. A list has the types of its count and of its items, and its name.
    pub properties: Vec<Vec<String>>,
    /// Numbers of each property, row by row.
    pub rows: Vec<Vec<Vec<f64>>>,
}

impl PlyElement {
    /// Numbers of a property, row by row.
    pub fn column(&self, name: &str) -> Option<Vec<Vec<f64>>> {
        let at = self.properties.iter().position(|words| words.last().is_some_and(|last| last == name))?;
        Some(self.rows.iter().map(|row| row[at].clone()).collect())
    }

    /// Element without the properties of these names.
    #[must_use]
    pub fn without(&self, names: &[&str]) -> Self {
        let is_kept = |words: &Vec<String>| !words.last().is_some_and(|last| names.contains(&last.as_str()));
        let kept: Vec<bool> = self.properties.iter().map(is_kept).collect();
        let properties = self.properties.iter().filter(|words| is_kept(words)).cloned().collect();
        let of_row =
            |row: &Vec<Vec<f64>>| row.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(x, _)| x.clone()).collect();
        Self { name: self.name.clone(), properties, rows: self.rows.iter().map(of_row).collect() }
    }
}

/// Contents of a PLY file: the lines of its header that are no elements, and its elements.
pub fn taken_apart(bytes: &[u8]) -> (Vec<String>, Vec<PlyElement>) {
    let end = bytes.windows(11).position(|eleven| eleven == b"end_header\n").expect("a header") + 11;
    let (mut others, mut elements, mut counts) = (Vec::new(), Vec::<PlyElement>::new(), Vec::new());
    for line in String::from_utf8_lossy(&bytes[..end]).lines() {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        match words[0].as_str() {
            "element" => {
                counts.push(words[2].parse::<usize>().expect("a count"));
                elements.push(PlyElement { name: words[1].clone(), properties: Vec::new(), rows: Vec::new() });
            }
            "property" => elements.last_mut().expect("an element").properties.push(words[1..].to_vec()),
            _ => others.push(line.to_owned()),
        }
    }
    let mut take = Take {
        rest: &bytes[end..],
        encoding: Encoding::ALL.into_iter().find(|e| others[1].contains(e.name())).expect("one"),
    };
    for (element, count) in elements.iter_mut().zip(counts) {
        for _ in 0..count {
            let properties = element.properties.iter().map(|words| match words.as_slice() {
                [_, count, item, _] => {
                    let items = take.number(count);
                    (0..=u16::MAX).take_while(|&k| f64::from(k) < items).map(|_| take.number(item)).collect()
                }
                words => vec![take.number(&words[0])],
            });
            let row = properties.collect();
            element.rows.push(row);
        }
    }
    assert!(take.rest.trim_ascii().is_empty(), "nothing is left");
    (others, elements)
}

struct Take<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

impl Take<'_> {
    fn number(&mut self, kind: &str) -> f64 {
        if self.encoding == Encoding::Text {
            let rest = self.rest.trim_ascii_start();
            let (word, rest) = rest.split_at(rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len()));
            self.rest = rest;
            return std::str::from_utf8(word).expect("text").parse().expect("a number");
        }
        let size = match kind {
            "char" | "uchar" | "int8" | "uint8" => 1,
            "short" | "ushort" | "int16" | "uint16" => 2,
            "double" => 8,
            _ => 4,
        };
        let (bytes, rest) = self.rest.split_at(size);
        self.rest = rest;
        let mut little = bytes.to_vec();
        if self.encoding == Encoding::Big {
            little.reverse();
        }
        if kind == "double" {
            return f64::from_le_bytes(little.try_into().expect("eight"));
        }
        if kind == "float" {
            return f64::from(f32::from_le_bytes(little.try_into().expect("four")));
        }
        let whole = little.iter().rev().fold(0_i64, |whole, &byte| 256 * whole + i64::from(byte));
        let is_negative = !kind.starts_with('u') && little[size - 1] > 127;
        (if is_negative { whole - (1 << (8 * size)) } else { whole }) as f64
    }
}
