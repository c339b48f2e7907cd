//! OBJ texts that are read and written in many pieces: equal to a single piece, on any number of threads.

use std::fmt::Write as _;

use freebound_io::{MeshFile, NO_TEXTURE, ReadError, Texture, read_stream, write_obj};
use glam::{DVec2, DVec3};
use rayon::ThreadPoolBuilder;

/// Number of vertices. The text has twice this number of faces; half of them have texture coordinates.
const COUNT: usize = 9000;

/// Text of some 700 kB with lines of every kind, built line by line together with its expected contents.
#[derive(Default)]
struct Large {
    text: String,
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    /// Texture coordinate of each corner.
    texture: Vec<u32>,
    /// Statements with the face that they precede.
    statements: Vec<(u32, String)>,
}

impl Large {
    fn new() -> Self {
        let mut this = Self { text: "# made for a test\r\n\r\nmtllib some.mtl\r\n".to_owned(), ..Self::default() };
        this.statements.push((0, "mtllib some.mtl".to_owned()));
        for k in 0..COUNT {
            let x = k as f64 / 7.0;
            writeln!(this.text, "v {x} {} -0.125\r", -x).expect("memory takes all");
            writeln!(this.text, "vt {x} 0.5 # a line of its own \\\r").expect("memory takes all");
            this.positions.push(DVec3::new(x, -x, -0.125));
        }
        for k in 0..2 * COUNT {
            this.add_face(k);
        }
        this
    }

    /// Adds a face: first triangles without texture coordinates, then triangles and quads with some.
    fn add_face(&mut self, k: usize) {
        if k.is_multiple_of(1000) {
            write!(self.text, "g part {k}\r\n").expect("memory takes all");
            self.statements.push((u32::try_from(k).expect("few"), format!("g part {k}")));
        }
        let corner_count = if k > COUNT && k.is_multiple_of(3) { 4 } else { 3 };
        let corner = |place: usize| u32::try_from((7 * k + place) % COUNT).expect("few");
        let corners: Vec<u32> = (0..corner_count).map(corner).collect();
        let words: Vec<String> = corners
            .iter()
            .map(|v| if k < COUNT { format!("{}", v + 1) } else { format!("{}/{}/1", v + 1, COUNT - *v as usize) })
            .collect();
        let gap = if k.is_multiple_of(97) { " \\\r\n  " } else { " " };
        write!(self.text, "f {}\r\n", words.join(gap)).expect("memory takes all");
        let coordinate = |v: &u32| if k < COUNT { NO_TEXTURE } else { u32::try_from(COUNT - 1).expect("few") - v };
        self.texture.extend(corners.iter().map(coordinate));
        self.faces.push(corners);
    }

    fn read(&self) -> MeshFile {
        read_stream(self.text.as_bytes()).expect("a text that is right")
    }
}

fn on_threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    ThreadPoolBuilder::new().num_threads(count).build().expect("a few threads").install(work)
}

#[test]
fn a_text_of_many_pieces_is_read_as_it_was_made() {
    let large = Large::new();
    let mesh = large.read();
    let faces: Vec<Vec<u32>> = (0..mesh.polygons.face_count())
        .map(|face| mesh.polygons.face(face).iter().map(|vertex| vertex.number()).collect())
        .collect();
    assert_eq!(mesh.polygons.positions, large.positions);
    assert_eq!(faces, large.faces);
    let texture = mesh.texture.as_ref().expect("some corners have coordinates");
    assert_eq!(texture.corners, large.texture);
    assert_eq!(texture.coordinates.len(), COUNT);
    assert_eq!(texture.coordinates[COUNT - 1], DVec2::new((COUNT - 1) as f64 / 7.0, 0.5));
    let statements: Vec<(u32, String)> = mesh
        .statements
        .iter()
        .map(|statement| (statement.before_face, String::from_utf8(statement.text.clone()).expect("plain text")))
        .collect();
    assert_eq!(statements, large.statements);
}

#[test]
fn a_text_of_many_pieces_reads_and_writes_alike_on_any_number_of_threads() {
    let large = Large::new();
    let texture = Texture {
        coordinates: (0..COUNT).map(|k| DVec2::new(k as f64 / 3.0, 1.0)).collect(),
        corners: large.faces.iter().flatten().copied().collect(),
    };
    let results = [1, 2, 4].map(|count| {
        on_threads(count, || {
            let mesh = large.read();
            let mut bytes = Vec::new();
            write_obj(&mut bytes, &mesh, &texture).expect("memory takes all");
            (mesh, bytes)
        })
    });
    assert!(results.windows(2).all(|pair| pair[0] == pair[1]), "threads made a difference");
    // Expected output, derived line by line from the input.
    let mut expected = String::new();
    let (mut is_first_coordinate, mut is_face) = (true, false);
    for line in large.text.split_inclusive('\n') {
        is_face |= line.starts_with("f ");
        if line.starts_with("vt") {
            if std::mem::take(&mut is_first_coordinate) {
                for z in &texture.coordinates {
                    write!(expected, "vt {:?} {:?}\r\n", z.x, z.y).expect("memory takes all");
                }
            }
        } else if is_face {
            expected += &with_coordinate_of_vertex(line);
        } else {
            expected += line;
        }
        is_face &= line.ends_with("\\\r\n");
    }
    assert!(String::from_utf8_lossy(&results[0].1) == expected, "what is written is not what was expected");
}

/// Line of a face, with coordinate k at the corner of vertex k.
fn with_coordinate_of_vertex(line: &str) -> String {
    let word = |word: &str| {
        let mut parts = word.split('/');
        let vertex = parts.next().expect("there is one");
        let normal = parts.nth(1).map(|normal| format!("/{normal}")).unwrap_or_default();
        if vertex.parse::<u32>().is_ok() { format!("{vertex}/{vertex}{normal}") } else { word.to_owned() }
    };
    let (words, end) = line.split_at(line.find("\r\n").expect("every line has an end"));
    words.split(' ').map(word).collect::<Vec<_>>().join(" ") + end
}

#[test]
fn a_fault_far_behind_is_said_with_its_line_and_indices_count_back_over_pieces() {
    let large = Large::new();
    let lines = large.text.lines().count();
    let Err(ReadError::Parse { faults, total }) = read_stream(format!("{}v 1 x 3\n", large.text).as_bytes()) else {
        panic!("a word that is no number is a fault");
    };
    assert_eq!((faults[0].line, total), (lines as u64 + 1, 1));
    let back = read_stream(format!("{}f -1 -2 -{COUNT}\n", large.text).as_bytes()).expect("indices that there are");
    let last = back.polygons.face(back.polygons.face_count() - 1).iter().map(|v| v.index()).collect::<Vec<_>>();
    assert_eq!(last, [COUNT - 1, COUNT - 2, 0]);
}
