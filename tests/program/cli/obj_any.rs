//! OBJ files of arbitrary pieces in any order survive a round trip.

use std::fmt::Write as _;

use freebound_io::read_stream;
use proptest::prelude::*;

use super::obj_carried::{by_corner, unchanged, written};
use freebound_testkit::files::read;

/// Line style of a generated file.
#[derive(Clone, Debug)]
struct Looks {
    end: &'static str,
    blank: &'static str,
    has_mark: bool,
    is_negative: bool,
    ends_open: bool,
}

fn looks() -> impl Strategy<Value = Looks> {
    let end = prop::sample::select(vec!["\n", "\r\n", "\r"]);
    let blank = prop::sample::select(vec![" ", "\t", "  ", " \\\n "]);
    (end, blank, any::<bool>(), any::<bool>(), any::<bool>()).prop_map(
        |(end, blank, has_mark, is_negative, ends_open)| Looks { end, blank, has_mark, is_negative, ends_open },
    )
}

/// Corners of a polygon: indices among the vertices so far, and true for each texture coordinate and normal.
type Corners = Vec<(prop::sample::Index, bool, bool)>;

/// Piece of a generated file.
#[derive(Clone, Debug)]
enum Piece {
    Vertex([f64; 3], String),
    Coordinate(f64),
    Normal,
    Face(Corners),
    Line(&'static str),
}

fn pieces() -> impl Strategy<Value = Vec<Piece>> {
    let extra = prop::sample::select(vec!["", " 1", " 0.1 0.2 0.3", " # here"]);
    let face = prop::collection::vec((any::<prop::sample::Index>(), any::<bool>(), any::<bool>()), 3..7);
    let lines = prop::sample::select(vec![
        "# comment # twice",
        "",
        "  ",
        "o a b",
        "g",
        "s 3",
        "s off",
        "usemtl x",
        "mtllib y.mtl",
        "l 1 2",
        "p 1",
        "vp 1 2",
        "unknown f 1 2 3",
        "#f 1 2 3",
        "call this.obj",
        "maplib z",
    ]);
    let piece = prop_oneof![
        4 => (prop::array::uniform3(-9.0..9.0_f64), extra).prop_map(|(at, extra)| Piece::Vertex(at, extra.to_owned())),
        2 => (0.0..1.0).prop_map(Piece::Coordinate),
        1 => Just(Piece::Normal),
        4 => face.prop_map(Piece::Face),
        3 => lines.prop_map(Piece::Line),
    ];
    prop::collection::vec(piece, 1..40)
}

/// Text of a file with these pieces. Three vertices, a texture coordinate and a normal come first, and a face last.
fn text_of(pieces: &[Piece], looks: &Looks) -> String {
    let mut text = String::from(if looks.has_mark { "\u{feff}" } else { "" });
    let [mut vertices, mut coordinates, mut normals] = [3_i64, 1, 1];
    let head = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "vn 0 0 1", "vt 0.5 0.5"];
    for line in &head {
        write!(text, "{line}{}", looks.end).expect("memory");
    }
    let index = |number: i64, count: i64| if looks.is_negative { number - count } else { number + 1 };
    for piece in pieces {
        let line = match piece {
            Piece::Vertex([x, y, z], extra) => {
                vertices += 1;
                format!("v {x:.3} {y:e} {z}{extra}")
            }
            Piece::Coordinate(u) => {
                coordinates += 1;
                format!("vt {u}")
            }
            Piece::Normal => {
                normals += 1;
                "vn 1 0 0".to_owned()
            }
            Piece::Face(corners) => corners.iter().fold("f".to_owned(), |line, (place, has_texture, has_normal)| {
                let vertex = i64::try_from(place.index(usize::try_from(vertices).unwrap())).unwrap();
                let word = match (has_texture, has_normal) {
                    (false, false) => format!("{}", index(vertex, vertices)),
                    (true, false) => format!("{}/{}", index(vertex, vertices), index(coordinates - 1, coordinates)),
                    (false, true) => format!("{}//{}", index(vertex, vertices), index(0, normals)),
                    (true, true) => {
                        format!("{}/{}/{}", index(vertex, vertices), index(0, coordinates), index(normals - 1, normals))
                    }
                };
                line + looks.blank + &word
            }),
            Piece::Line(line) => (*line).to_owned(),
        };
        text += &line;
        text += looks.end;
    }
    text + "f 1 2 3" + if looks.ends_open { "" } else { looks.end }
}

proptest! {
    #[test]
    fn any_file_comes_back_as_it_went(pieces in pieces(), looks in looks()) {
        let text = text_of(&pieces, &looks);
        // A reader that ends lines at CR sees what a reader of LF files sees.
        let as_lines = |text: &str| if looks.end == "\r" { text.replace('\r', "\n") } else { text.to_owned() };
        let mesh = read(&text);
        let texture = by_corner(&mesh);
        let out = written(&mesh, &texture);
        prop_assert_eq!(unchanged(&as_lines(&out)), unchanged(&as_lines(&text)));
        let again = read_stream(out.as_bytes()).expect("it reads back");
        prop_assert_eq!(again.polygons, mesh.polygons);
        prop_assert_eq!(again.texture, Some(texture));
    }
}
