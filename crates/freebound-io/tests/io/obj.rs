//! Reading OBJ files.

use freebound_testkit::files::read;
use std::io::{self, Read};
use std::ops::ControlFlow;
use std::path::Path;

use freebound_core::mesh::VertexId;
use freebound_io::{
    MAX_PARSE_FAULTS, NO_TEXTURE, ParseFault, ParseFaultKind, ReadError, ReadOptions, ReadWarning, ReadWarningKind,
    read_mesh, read_mesh_with, read_stream, read_stream_with,
};
use glam::DVec3;
use proptest::prelude::*;

use freebound_testkit::{Random, assert_message, corpus_test, manifest};

/// Four vertices, three texture coordinates and two normals to refer to.
pub(crate) const ELEMENTS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n";

/// Fault of a word that is no number.
pub(crate) fn bad_number(word: &str) -> ParseFaultKind {
    ParseFaultKind::BadNumber(word.to_owned())
}

/// Fault of a word that is no corner of a face.
fn bad_corner(word: &str) -> ParseFaultKind {
    ParseFaultKind::BadCorner(word.to_owned())
}

/// Fault of a file that declares more elements than it has.
pub(crate) fn too_many(element: &str, count: u64) -> ParseFaultKind {
    ParseFaultKind::TooMany { element: element.to_owned(), count }
}

/// Fault of an index of no element.
pub(crate) fn out_of_range(element: &'static str, index: i64, count: usize) -> ParseFaultKind {
    ParseFaultKind::IndexOutOfRange { element, index, count }
}

/// Fault of an unexpected text that begins with this word.
pub(crate) fn unexpected(word: &str) -> ParseFaultKind {
    ParseFaultKind::Unexpected { found: word.to_owned(), expected: "" }
}

/// Place and kind of the only fault of a file. Of an unexpected text only the first word is kept.
pub(crate) fn place_and_kind(error: &ReadError) -> (String, ParseFaultKind) {
    let (place, kind) = match error {
        ReadError::Parse { faults, .. } => {
            let [fault] = &faults[..] else { panic!("{error}") };
            (format!("line {}", fault.line), &fault.kind)
        }
        ReadError::Bytes { byte, kind } => (format!("byte {byte}"), kind),
        ReadError::Element { element, kind } => (element.clone(), kind),
        _ => panic!("{error}"),
    };
    match kind {
        ParseFaultKind::Unexpected { found, .. } => (place, unexpected(found.split(' ').next().unwrap_or_default())),
        kind => (place, kind.clone()),
    }
}

/// Asserts the places and the kinds of faults, and their messages.
pub(crate) fn assert_faults<'a>(topic: &str, cases: impl IntoIterator<Item = (ReadError, &'a str, ParseFaultKind)>) {
    let mut messages = Vec::new();
    for (error, place, kind) in cases {
        assert_eq!(place_and_kind(&error), (place.to_owned(), kind), "{error}");
        messages.push(error.to_string());
    }
    assert_message(topic, &messages.join("\n"));
}

/// Corners of the faces of `ELEMENTS` with more lines after it.
fn faces(lines: &str) -> Vec<Vec<u32>> {
    let mesh = read(&format!("{ELEMENTS}{lines}"));
    (0..mesh.polygons.face_count()).map(|f| mesh.polygons.face(f).iter().map(|v| v.number()).collect()).collect()
}

#[test]
fn every_form_of_a_face_is_understood() {
    let first = vec![vec![0, 1, 2]];
    for line in [
        "f 1 2 3",
        "f 1/1 2/2 3/3",
        "f 1//1 2//1 3//2",
        "f 1/1/1 2/2/1 3/3/2",
        "f 1// 2// 3//",
        "f 1/ 2/ 3/",
        "f 1/1/ 2/2/ 3/3/",
        "f -4 -3 -2",
        "f -4/-3/-2 -3/-2/-1 -2/-1/-1",
        "f\t1\t 2   3 \t",
        "  f 1 2 3",
        "f +1 2 3",
        "f 1 2 3 # a comment",
        "f 1 2 3 #4",
        "f 1 \\\n2 \\\n 3",
        "f 1 2 3\r",
        "f \\\r\n1 2 3\r\n",
        "f 1 2 3 \\",
        "f 1 2 3 \\\n",
        "# path\\to\\\nf 1 2 3",
        "l 1 2\np 1\nf 1 2 3\ncurv 0 1\nunknown words",
        "#f 3 2 1\n\n\nf 1 2 3",
        "f 1 2 3\n\n# \u{e9}\n",
    ] {
        assert_eq!(faces(line), first, "{line:?}");
    }
    assert_eq!(faces("f 1 2 3 4\nf 1 2 3\nf 4 3 2 1"), [vec![0, 1, 2, 3], vec![0, 1, 2], vec![3, 2, 1, 0]]);
}

#[test]
fn what_stands_behind_three_coordinates_is_ignored() {
    let text = "v 1 2 3 1.0\nv 4 5 6 nan nan nan\nv 7 8 9 0.1 0.2 0.3 words # more\nf 1 2 3";
    let expected = [[1., 2., 3.], [4., 5., 6.], [7., 8., 9.]].map(DVec3::from);
    assert_eq!(read(text).polygons.positions, expected);
}

#[test]
fn numbers_are_read_to_the_last_bit() {
    for word in ["0.1", "-0", "1e-320", "1.7976931348623157e308", "123456789012345678901234567890", "+.5", "5.", "1E3"]
    {
        let mesh = read(&format!("v {word} 0 0\nf 1 1 1"));
        let expected: f64 = word.parse().expect("a number");
        assert_eq!(mesh.polygons.positions[0].x.to_bits(), expected.to_bits(), "{word}");
    }
}

#[test]
fn infinities_and_nans_are_read_for_the_diagnosis_to_name() {
    for word in ["nan", "NaN", "-nan", "inf", "-Infinity", "1e999", "-nan(ind)", "1.#INF", "-1.#IND", "1.#QNAN"] {
        assert!(!read(&format!("v 0 {word} 0\nf 1 1 1")).polygons.positions[0].y.is_finite(), "{word}");
    }
}

#[test]
fn a_face_may_name_vertices_that_come_later() {
    let mesh = read("f 1/2 2/1 3/2\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 5 6\nvt 7 8\n");
    assert_eq!(mesh.polygons.corners, [0, 1, 2].map(VertexId::new));
    assert_eq!(mesh.texture.expect("it has texture").corners, [1, 0, 1]);
}

#[test]
fn a_byte_order_mark_is_passed_over() {
    assert_eq!(read("\u{feff}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").polygons.positions.len(), 3);
}

#[test]
fn text_that_is_not_utf8_is_kept_in_names_and_passed_over_in_comments() {
    let mesh = read_stream(&b"# caf\xe9\nv 0 0 0\ng caf\xe9 \xff\nf 1 1 1\n"[..]).expect("it is right");
    assert_eq!(mesh.statements[0].text, b"g caf\xe9 \xff");
    assert_eq!(mesh.statements[0].keyword(), b"g");
}

#[test]
fn statements_are_kept_with_the_face_they_stand_before() {
    let text = format!("mtllib a b.mtl\no head\n{ELEMENTS}usemtl skin\ns 1\nf 1 2 3\ng  left right \nf 1 3 4\ns off\n");
    let found: Vec<(u32, String, String)> = read(&text)
        .statements
        .iter()
        .map(|s| (s.before_face, String::from_utf8_lossy(s.keyword()).into_owned(), s.argument().into_owned()))
        .collect();
    let expected = [
        (0, "mtllib", "a b.mtl"),
        (0, "o", "head"),
        (0, "usemtl", "skin"),
        (0, "s", "1"),
        (1, "g", "left right"),
        (2, "s", "off"),
    ];
    assert_eq!(found, expected.map(|(face, keyword, rest)| (face, keyword.to_owned(), rest.to_owned())));
}

/// Parse faults of a text.
fn faults(text: &str) -> Vec<ParseFault> {
    match read_stream(text.as_bytes()) {
        Err(ReadError::Parse { faults, total }) => {
            assert_eq!(faults.len(), total.min(MAX_PARSE_FAULTS));
            faults
        }
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn faces_that_name_what_never_comes_know_their_lines() {
    let found = faults(&format!("{ELEMENTS}f 1 2 99\nf 1 3 99\n\nf 1 2 \\\n99\nf 2 3 99\n"));
    assert_eq!(found, [10, 11, 13, 15].map(|line| ParseFault { line, kind: out_of_range("vertex", 99, 4) }));
}

#[test]
fn malformed_lines_are_named_with_their_numbers() {
    let mut messages = Vec::new();
    for (line, kind) in [
        ("v 1 2", ParseFaultKind::TooFewNumbers { found: 2, needed: 3 }),
        ("v", ParseFaultKind::TooFewNumbers { found: 0, needed: 3 }),
        ("v 1 X0.5 3", bad_number("X0.5")),
        ("v 1,5 2 3", bad_number("1,5")),
        ("v 1 2 0x10", bad_number("0x10")),
        ("vt", ParseFaultKind::TooFewNumbers { found: 0, needed: 2 }),
        ("vt u v", bad_number("u")),
        ("f 0 1 2", ParseFaultKind::IndexZero),
        ("f 1 2 5", out_of_range("vertex", 5, 4)),
        ("f 1 2 99999999999999999999", out_of_range("vertex", i64::MAX, 4)),
        ("f -1 -2 -5", out_of_range("vertex", -5, 4)),
        ("f 1 2 x", bad_corner("x")),
        ("f 1 2 3.5", bad_corner("3.5")),
        ("f 1 2 3/1/1/1", bad_corner("3/1/1/1")),
        ("f 1 2 /3", bad_corner("/3")),
        ("f 1 2 3/x", bad_corner("3/x")),
        ("f 1 2 3//x", bad_corner("3//x")),
        ("f 1 2 -", bad_corner("-")),
    ] {
        // The first faulty line ends the file; the second does not.
        let at_end = faults(&format!("{ELEMENTS}f 1 2 3\n{line}"));
        assert_eq!(at_end, [ParseFault { line: 11, kind: kind.clone() }], "{line}");
        let within = faults(&format!("{ELEMENTS}{line}\nf 1 2 3\n"));
        assert_eq!(within, [ParseFault { line: 10, kind }], "{line}");
        messages.push(within[0].to_string());
    }
    assert_message("obj-malformed-lines", &messages.join("\n"));
}

fn warning(kind: ReadWarningKind, count: usize, line: u64) -> ReadWarning {
    ReadWarning { kind, count, line: Some(line) }
}

#[test]
fn faces_of_few_corners_are_left_out_with_a_warning() {
    for small in ["f", "f 1", "f 1 2", "f 1 2 #3", "f 7/8 9/9"] {
        let mesh = read(&format!("{ELEMENTS}f 1 2 3\n{small}\nf 2 3 4\n{small}\n"));
        assert_eq!(mesh.polygons.face_count(), 2, "{small}");
        assert_eq!(mesh.warnings, [warning(ReadWarningKind::FacesOfFewCorners, 2, 11)], "{small}");
        let alone = read_stream(format!("{ELEMENTS}{small}\n").as_bytes());
        assert!(matches!(alone, Err(ReadError::NoFaces { vertices: 4 })), "{small}: {alone:?}");
    }
}

#[test]
fn texture_coordinates_that_do_not_exist_are_left_out_with_a_warning() {
    // Three of them are missing: beyond the end, zero, and before the beginning.
    for missing in ["4", "0", "-4", "99999999999999999999"] {
        let mesh = read(&format!("{ELEMENTS}f 1/1 2/2 3/3\nf 1/{missing} 2/2 3/3\n"));
        assert_eq!(mesh.warnings, [warning(ReadWarningKind::MissingTextureCoordinates, 1, 11)], "{missing}");
        assert_eq!(mesh.texture.expect("some exist").corners, [0, 1, 2, NO_TEXTURE, 1, 2], "{missing}");
    }
    let mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\nvn 0 0 1\n");
    assert_eq!(mesh.warnings, [warning(ReadWarningKind::MissingTextureCoordinates, 3, 4)]);
    assert_eq!(mesh.texture, None);
    // A coordinate may come after the face.
    assert_eq!(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\nvt 0 0\n").warnings, []);
}

#[test]
fn warnings_of_a_long_file_name_the_first_line_whatever_piece_it_is_in() {
    let mut text = ELEMENTS.to_owned();
    text.push_str(&"f 1 2 3\n".repeat(100_000));
    text.push_str("f 1 2\nf 1/9 2/9 3/9\n");
    text.push_str(&"f 2 3 4\n".repeat(100_000));
    text.push_str("f 3\nf 1/8 2 3\n");
    let kinds = [(ReadWarningKind::FacesOfFewCorners, 2, 0), (ReadWarningKind::MissingTextureCoordinates, 4, 1)];
    let expected = kinds.map(|(kind, count, after)| warning(kind, count, 9 + 100_000 + 1 + after));
    assert_eq!(read(&text).warnings, expected);
}

#[test]
fn all_faults_are_collected_by_line() {
    let text = format!("f 1 2 7\n{ELEMENTS}f 1 2\nf 1 2 \\\n3 x\nv 1 2 z\nf 6 1 2");
    let expected = [
        ParseFault { line: 1, kind: out_of_range("vertex", 7, 5) },
        ParseFault { line: 12, kind: bad_corner("x") },
        ParseFault { line: 14, kind: bad_number("z") },
        ParseFault { line: 15, kind: out_of_range("vertex", 6, 5) },
    ];
    assert_eq!(faults(&text), expected);
}

#[test]
fn faults_beyond_the_limit_are_counted() {
    let text = format!("{ELEMENTS}{}{}", "f 9 1 2\n".repeat(15), "f 1 2 x\n".repeat(40));
    let Err(error) = read_stream(text.as_bytes()) else { panic!("it is wrong") };
    let ReadError::Parse { faults, total } = &error else { panic!("{error}") };
    assert_eq!((faults.len(), *total), (MAX_PARSE_FAULTS, 55));
    assert_eq!(faults[0], ParseFault { line: 10, kind: out_of_range("vertex", 9, 4) });
    let message = error.to_string();
    assert_eq!(message.lines().count(), MAX_PARSE_FAULTS + 1);
    assert_message("obj-faults-beyond-the-limit", &message);
}

#[test]
fn a_file_without_faces_is_named() {
    for (text, vertices) in [("", 0), ("\n\n# nothing\n", 0), ("v 1 2 3\nv 1 2 4\n", 2), ("hello, world\n", 0)] {
        match read_stream(text.as_bytes()) {
            Err(ReadError::NoFaces { vertices: found }) => assert_eq!(found, vertices, "{text}"),
            other => panic!("{text}: {other:?}"),
        }
    }
}

#[test]
fn other_formats_are_named_by_extension_and_by_content() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut messages = Vec::new();
    for (extension, format) in [("FBX", "FBX"), ("dae", "COLLADA"), ("usdz", "USD")] {
        let path = folder.path().join(format!("mesh.{extension}"));
        std::fs::write(&path, "whatever").expect("written");
        let error = read_mesh(&path).expect_err("it is not read yet");
        assert!(matches!(error, ReadError::NotReadYet(name) if name == format), "{error}");
        messages.push(error.to_string());
    }
    for content in
        [&b"4OFF\n3 1 0\n"[..], b"# comment\nOFF BINARY\n", b"<?xml version=\"1.0\"?>\n", b"glTF\x01\0\0\0\0\0\0\0"]
    {
        let error = read_stream(content).expect_err("not read");
        assert!(matches!(error, ReadError::NotReadYet(_)), "{error}");
        messages.push(error.to_string());
    }
    assert_message("obj-other-formats", &messages.join("\n"));
}

#[test]
fn a_folder_and_a_missing_file_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    for path in [folder.path(), &folder.path().join("missing.obj")] {
        let error = read_mesh(path).expect_err("no file");
        assert!(matches!(error, ReadError::Unreadable(_)), "{error}");
    }
}

/// Reader of bytes in pieces of the given sizes, repeated; at the end it fails if told to.
struct Pieces<'a> {
    bytes: &'a [u8],
    sizes: Vec<usize>,
    next: usize,
    breaks: Option<io::ErrorKind>,
}

impl Read for Pieces<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let size = self.sizes[self.next % self.sizes.len()].min(self.bytes.len()).min(buffer.len());
        self.next += 1;
        if let Some(kind) = self.breaks.filter(|_| self.bytes.is_empty()) {
            return Err(kind.into());
        }
        // Every third call is interrupted, which the reader must ignore.
        if self.next.is_multiple_of(3) {
            return Err(io::ErrorKind::Interrupted.into());
        }
        let (now, later) = self.bytes.split_at(size);
        buffer[..size].copy_from_slice(now);
        self.bytes = later;
        Ok(size)
    }
}

/// Words and line ends that are fragile when split between reads.
const TORN: &str = "\u{feff}# start\\\r\nmtllib x.mtl\r\nv 0.125 -1e-7 3\r\nv 1 0 \\\r\n 0\nv 1 1 0\nvt 0.5 0.25\r\n\
    usemtl a\nf 1/1 2/1 \\\n3/1\r\nf -1 -2 -3 1\n\n# end\\\nf 1 2 3 \\";

proptest! {
    #[test]
    fn the_mesh_does_not_depend_on_where_the_bytes_are_torn_apart(sizes in prop::collection::vec(1_usize..9, 1..6)) {
        let reader = Pieces { bytes: TORN.as_bytes(), sizes, next: 0, breaks: None };
        prop_assert_eq!(read_stream(reader).expect("it is right"), read(TORN));
    }

    #[test]
    fn any_bytes_are_read_or_refused_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        drop(read_stream(bytes.as_slice()));
    }

    #[test]
    fn any_words_of_obj_files_are_read_or_refused_without_a_panic(
        words in prop::collection::vec(
            prop::sample::select(vec![
                "v ", "vt ", "f ", "\n", "\n", "1 ", "-1 ", "0 ", "2/2 ", "1//", "-", "\\\n", "\\", "#", "nan ", "g ", "\r\n", "1e9999 ", "\u{e9}",
            ]),
            0..60,
        )
    ) {
        if let Ok(mesh) = read_stream(words.concat().as_bytes()) {
            let triangles = mesh.polygons.triangulate();
            freebound_core::mesh::diagnose(&triangles);
            drop(mesh.texture_mesh());
        }
    }
}

#[test]
fn a_line_longer_than_the_first_chunk_is_read() {
    let corner_count = 100_000;
    let mut text = "v 0 0 0\n".repeat(corner_count);
    text.push('f');
    text.push_str(&" 1".repeat(corner_count));
    let mesh = read(&text);
    assert_eq!(mesh.polygons.corners.len(), corner_count);
}

#[test]
fn a_stream_that_breaks_off_is_an_error() {
    let reader =
        Pieces { bytes: ELEMENTS.as_bytes(), sizes: vec![7], next: 0, breaks: Some(io::ErrorKind::ConnectionReset) };
    let error = read_stream(reader).expect_err("it broke off");
    assert!(matches!(error, ReadError::Unreadable(_)), "{error}");
    assert_message("obj-stream-that-breaks-off", &error.to_string());
}

#[test]
fn a_hundred_megabytes_of_garbage_are_refused() {
    /// 100 MB of random bytes, mapped by the function.
    struct Garbage(Random, usize, fn(u8) -> u8);
    impl Read for Garbage {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = buffer.len().min(self.1);
            for eight in buffer[..count].chunks_mut(8) {
                let bytes = self.0.bits().to_le_bytes();
                eight.iter_mut().zip(bytes).for_each(|(to, from)| *to = self.2(from));
            }
            self.1 -= count;
            Ok(count)
        }
    }
    let size = 100_000_000;
    let garbage = |map| read_stream(Garbage(Random(9), size, map)).expect_err("it is garbage");
    assert!(matches!(garbage(|byte| byte), ReadError::NotText));
    assert!(matches!(garbage(|byte| b' ' + byte % 95), ReadError::LineTooLong { .. }));
    assert!(matches!(garbage(|byte| if byte < 4 { b'\n' } else { 128 | byte }), ReadError::NoFaces { .. }));
}

#[test]
fn reading_reports_progress_and_stops_when_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mesh.obj");
    std::fs::write(&path, format!("{ELEMENTS}f 1 2 3\n{}", "# filler\n".repeat(100_000))).expect("written");
    let size = std::fs::metadata(&path).expect("it is there").len();
    let mut seen = Vec::new();
    let watched = read_mesh_with(&path, ReadOptions::default(), &mut |progress| {
        assert_eq!(progress.total, Some(size));
        seen.push(progress.bytes);
        ControlFlow::Continue(())
    });
    assert!(watched.is_ok() && seen.len() > 2 && seen.is_sorted() && seen.last() == Some(&size), "{seen:?}");
    let stopped = read_stream_with(ELEMENTS.as_bytes(), ReadOptions::default(), &mut |_| ControlFlow::Break(()));
    assert!(matches!(stopped, Err(ReadError::Cancelled)));
}

corpus_test! {
    fn tobj_sees_the_same_faces_in_the_corpus() {
        let mut compared = 0;
        for entry in manifest().iter().filter(|entry| Path::new(&entry.file).extension().is_some_and(|e| e == "obj")) {
            let Ok(ours) = read_mesh(&entry.path) else { continue };
            // tobj keeps faces of two corners.
            if !ours.warnings.is_empty() {
                continue;
            }
            let (models, _) = tobj::load_obj(&entry.path, &tobj::LoadOptions::default()).expect("tobj reads it");
            // tobj renumbers vertices and splits groups, so corners are compared by position, in file order. Its
            // numbers are rounded from text to single precision at once, ours twice.
            let mut theirs = models.iter().flat_map(|model| {
                let point = |&v: &u32| [0, 1, 2].map(|k| model.mesh.positions[3 * v as usize + k]);
                model.mesh.indices.iter().map(point)
            });
            let mut sizes = models.iter().flat_map(|model| {
                let all_triangles = vec![3; model.mesh.indices.len() / 3];
                if model.mesh.face_arities.is_empty() { all_triangles } else { model.mesh.face_arities.clone() }
            });
            for face in 0..ours.polygons.face_count() {
                let corners = ours.polygons.face(face);
                assert_eq!(sizes.next(), u32::try_from(corners.len()).ok(), "{} face {face}", entry.file);
                for vertex in corners {
                    let position = ours.polygons.positions[vertex.index()].to_array();
                    let other = theirs.next().expect("as many corners").map(f64::from);
                    let near = |a: f64, b: f64| (a - b).abs() <= f64::from(f32::EPSILON) * a.abs();
                    assert!((0..3).all(|k| near(position[k], other[k])), "{} {position:?} {other:?}", entry.file);
                }
            }
            assert!(theirs.next().is_none() && sizes.next().is_none(), "{}", entry.file);
            compared += 1;
        }
        // All 33 OBJ files except one without faces and one with a face of two corners.
        assert!(compared == 31, "{compared}");
    }
}
