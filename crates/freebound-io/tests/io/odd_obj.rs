//! Unusual but legal files, flattened and read back by another reader, corner by corner.
//!
//! A written file has the faces of the file that was read, for any reader of both. Readers differ in the line ends
//! they know (LF, CR LF, CR alone, form feed, line separators of Unicode). They also differ in the meaning of a
//! trailing `\`, and in the blanks that separate words. All such bytes are kept.

use std::cell::Cell;
use std::fmt::Write as _;

use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_io::{MeshFile, Texture, read_stream, write_obj};
use glam::DVec2;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use freebound_testkit::grid;

/// Columns and rows of the mesh that is written in unusual forms.
const SIZE: [u32; 2] = [3, 2];

/// Mesh of every unusual file: a grid of triangles.
fn polygons() -> PolygonMesh {
    PolygonMesh::from(&grid(SIZE[0], SIZE[1]))
}

/// Unusual features of a file.
#[derive(Clone, Debug)]
struct Oddity {
    /// Line ends, in turn.
    line_ends: Vec<&'static str>,
    /// Blanks between words, in turn.
    blanks: Vec<&'static str>,
    /// Forms of corners, in turn.
    corners: Vec<Corner>,
    /// Lines between the elements, in turn.
    between: Vec<String>,
    has_mark: bool,
}

#[derive(Clone, Copy, Debug)]
enum Corner {
    Plain,
    Negative,
    WithNormal,
    WithTexture,
    WithAll,
    NegativeWithTexture,
    Signed,
}

fn corner_text(corner: Corner, vertex: usize, count: usize) -> String {
    let (up, down) = (vertex + 1, count - vertex);
    match corner {
        Corner::Plain => format!("{up}"),
        Corner::Negative => format!("-{down}"),
        Corner::WithNormal => format!("{up}//1"),
        Corner::WithTexture => format!("{up}/1"),
        Corner::WithAll => format!("{up}/1/1"),
        Corner::NegativeWithTexture => format!("-{down}/-1"),
        Corner::Signed => format!("+{up}"),
    }
}

/// Lines between the elements: a single line to this reader, perhaps several to others.
fn lines() -> impl Strategy<Value = String> {
    let keywords = prop::sample::select(vec!["g", "o", "s", "usemtl", "mtllib", "#", "vp", "l 1 2", "p 1", "cstype"]);
    let pieces = prop::sample::select(vec![
        "name", " ", "\t", "\r", "\u{b}", "\u{c}", "\\", "#", "f 1 2 3", "v 0 0 0", "vt 0 0", "\u{85}", "\u{2028}",
        "\u{e9}", "\u{a0}", "\\\n", "\\\r\n", "1",
    ]);
    (keywords, prop::collection::vec(pieces, 0..6))
        .prop_map(|(keyword, pieces)| format!("{keyword} x{}", pieces.concat()))
}

fn oddities() -> impl Strategy<Value = Oddity> {
    let corners = prop::sample::select(vec![
        Corner::Plain,
        Corner::Negative,
        Corner::WithNormal,
        Corner::WithTexture,
        Corner::WithAll,
        Corner::NegativeWithTexture,
        Corner::Signed,
    ]);
    (
        prop::collection::vec(
            prop::sample::select(vec!["\n", "\r\n", "\r", " \n", "\n\n", " # end\n", "\t\r\n", " # C:\\\n"]),
            1..5,
        ),
        prop::collection::vec(prop::sample::select(vec![" ", "\t", "  ", " \\\n", "\t\\\r\n "]), 1..5),
        prop::collection::vec(corners, 1..5),
        prop::collection::vec(lines(), 1..4),
        any::<bool>(),
    )
        .prop_map(|(line_ends, blanks, corners, between, has_mark)| Oddity {
            line_ends,
            blanks,
            corners,
            between,
            has_mark,
        })
}

/// Text of the mesh with unusual features.
fn odd_text(polygons: &PolygonMesh, odd: &Oddity) -> String {
    let mut text = String::from(if odd.has_mark { "\u{feff}" } else { "" });
    let (mut ends, mut blanks) = (odd.line_ends.iter().cycle(), odd.blanks.iter().cycle());
    let (mut corners, mut between) = (odd.corners.iter().cycle(), odd.between.iter().cycle());
    let mut line = |words: &[String]| {
        for word in words {
            write!(text, "{word}{}", blanks.next().unwrap()).unwrap();
        }
        // A blank that continues a line is not allowed at the end of an element.
        while text.ends_with(['\n', '\\', '\r']) {
            text.pop();
        }
        text += ends.next().unwrap();
    };
    let words = |keyword: &str, numbers: &[f64]| -> Vec<String> {
        std::iter::once(keyword.to_owned()).chain(numbers.iter().map(|x| format!("{x:?}"))).collect()
    };
    for p in &polygons.positions {
        line(&words("v", &p.to_array()));
    }
    line(&words("vt", &[0.5, 0.5]));
    line(&words("vn", &[0.0, 0.0, 1.0]));
    let count = polygons.positions.len();
    for face in 0..polygons.face_count() {
        line(&[between.next().unwrap().clone()]);
        let own = polygons.face(face).iter().map(|v| corner_text(*corners.next().unwrap(), v.index(), count));
        line(&std::iter::once("f".to_owned()).chain(own).collect::<Vec<_>>());
    }
    text
}

/// Corners read by `tobj`: vertex position and texture coordinate. Fails if some vertices have no texture coordinate.
fn corners_by_tobj(text: &[u8]) -> Result<Vec<[[f32; 2]; 2]>, String> {
    let no_materials = |_: &std::path::Path| tobj::MTLLoadResult::Err(tobj::LoadError::OpenFileFailed);
    let options = tobj::LoadOptions::default();
    let (models, _) = tobj::load_obj_buf(&mut &*text, &options, no_materials).map_err(|error| error.to_string())?;
    let mut found = Vec::new();
    for mesh in models.iter().map(|model| &model.mesh) {
        if mesh.texcoords.len() / 2 != mesh.positions.len() / 3 {
            return Err(format!(
                "{} texture coordinates for {} vertices",
                mesh.texcoords.len() / 2,
                mesh.positions.len() / 3
            ));
        }
        found.extend(mesh.indices.iter().map(|&v| {
            let (p, t) = (3 * v as usize, 2 * v as usize);
            [[mesh.positions[p], mesh.positions[p + 1]], [mesh.texcoords[t], mesh.texcoords[t + 1]]]
        }));
    }
    Ok(found)
}

/// Elements of a text, one per line, without comments, continued lines and normals.
fn plain(text: &str) -> String {
    let one_end = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
    let words_of = |line: &str| -> Vec<String> {
        let words = line.split([' ', '\t', '\u{b}', '\u{c}']).filter(|word| !word.is_empty());
        words.take_while(|word| !word.starts_with('#')).map(str::to_owned).collect()
    };
    let (mut lines, mut open): (Vec<Vec<String>>, bool) = (Vec::new(), false);
    for line in one_end.split('\n') {
        let has_comment = line.split([' ', '\t', '\u{b}', '\u{c}']).any(|word| word.starts_with('#'));
        let is_continued = line.ends_with('\\') && !has_comment;
        let words = words_of(if is_continued { &line[..line.len() - 1] } else { line });
        match lines.last_mut().filter(|_| open) {
            Some(last) => last.extend(words),
            None => lines.push(words),
        }
        open = is_continued;
    }
    let element = |words: &Vec<String>| match words.first().map(String::as_str) {
        Some("v") => Some(words[..4].join(" ")),
        Some("vt") => Some(words.join(" ")),
        Some("f") => {
            let corners = words.iter().map(|word| word.splitn(3, '/').take(2).collect::<Vec<_>>().join("/"));
            Some(corners.collect::<Vec<_>>().join(" "))
        }
        _ => None,
    };
    lines.iter().filter_map(element).map(|line| line + "\n").collect()
}

/// Characters that some readers take for line ends.
const BREAKS: [char; 8] = ['\u{b}', '\u{c}', '\u{1c}', '\u{1d}', '\u{1e}', '\u{85}', '\u{2028}', '\u{2029}'];

/// Text for a reader that takes [`BREAKS`] for line ends, too, and joins lines after a `\`.
fn as_read_elsewhere(text: &str) -> String {
    let ended = text.replace('\r', "\n").replace(BREAKS, "\n");
    ended
        .lines()
        .map(|line| {
            line.trim_end_matches([' ', '\t']).strip_suffix('\\').map_or(format!("{line}\n"), |line| format!("{line} "))
        })
        .collect()
}

/// Text of the mesh, written with x and y of its vertices as texture coordinates.
fn written(mesh: &MeshFile) -> String {
    let flat: Embedding = mesh.polygons.positions.iter().map(|p| DVec2::new(p.x, p.y)).collect();
    let mut text = Vec::new();
    write_obj(&mut text, mesh, &Texture::per_vertex(&mesh.polygons, &flat)).unwrap();
    String::from_utf8(text).expect("the odd texts are UTF-8")
}

/// Writes a mesh and reads it back: directly, with the line ends of other readers, and with another reader.
fn assert_same_corners(text: &str, mesh: &MeshFile) -> Result<(), TestCaseError> {
    let out = written(mesh);
    let again = read_stream(out.as_bytes()).expect("what was written is read");
    prop_assert_eq!(&again.polygons.corners, &mesh.polygons.corners, "{}", out);
    // If another reader reads the input as this one does, it must also read the output as this one does.
    let elsewhere = |text: &str| read_stream(as_read_elsewhere(text).as_bytes()).ok().map(|mesh| mesh.polygons);
    if elsewhere(text).is_some_and(|polygons| polygons == mesh.polygons) {
        let again = elsewhere(&out).map(|polygons| polygons.corners);
        prop_assert_eq!(again.as_ref(), Some(&mesh.polygons.corners), "{}", out);
    }
    let theirs = corners_by_tobj(plain(&out).as_bytes());
    let theirs = theirs.map_err(|error| TestCaseError::fail(format!("{error}: {out}")))?;
    let flat = |vertex: &VertexId| mesh.polygons.positions[vertex.index()].as_vec3().truncate().to_array();
    let ours: Vec<_> = mesh.polygons.corners.iter().map(|vertex| [flat(vertex), flat(vertex)]).collect();
    prop_assert_eq!(theirs, ours, "{}", out);
    Ok(())
}

#[test]
fn what_is_written_of_an_odd_file_has_the_same_corners_for_every_reader() {
    const CASES: u32 = 400;
    let config = ProptestConfig { cases: CASES, source_file: Some(file!()), ..ProptestConfig::default() };
    let accepted = Cell::new(0);
    let same_each_time = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let tried = TestRunner::new_with_rng(config, same_each_time).run(&oddities(), |odd| {
        // Text that other readers take for separate lines may be faulty: the file is then rejected, not misread.
        let text = odd_text(&polygons(), &odd);
        let Ok(mesh) = read_stream(text.as_bytes()) else { return Ok(()) };
        accepted.set(accepted.get() + 1);
        assert_same_corners(&text, &mesh)
    });
    tried.unwrap_or_else(|error| panic!("{error}"));
    assert!(4 * accepted.get() >= 3 * CASES, "only {} of {CASES} files were read", accepted.get());
}

#[test]
fn a_carriage_return_alone_ends_a_line() {
    let text = "v 0 0 0\rv 1 0 0\rv 0 1 0\rg name\rf 1 2 3\r";
    let mesh = read_stream(text.as_bytes()).unwrap();
    assert_eq!((mesh.polygons.face_count(), mesh.statements[0].text.as_slice()), (1, &b"g name"[..]));
}

#[test]
fn a_face_behind_a_carriage_return_in_a_name_is_a_face_with_texture_coordinates() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\ng name\rf 2 4 3\n";
    let out = written(&read_stream(text.as_bytes()).unwrap());
    assert!(out.ends_with("f 1/1 2/2 3/3\ng name\rf 2/2 4/4 3/3\n"), "{out}");
}

#[test]
fn a_name_never_swallows_the_face_behind_it() {
    for name in ["name\\ ", "name\\\t", "name # C:\\", "name\u{c}", "name\\\u{b}"] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\ng {name}\nf 2 4 3\n");
        let out = written(&read_stream(text.as_bytes()).unwrap());
        assert_eq!(read_stream(out.as_bytes()).unwrap().polygons.face_count(), 2, "{name:?}: {out}");
        assert!(out.contains(&format!("\ng {name}\n")), "{out}");
    }
}
