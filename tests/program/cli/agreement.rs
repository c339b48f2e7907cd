//! Agreement of `flatten` and `check`: exit status 0 of the one is exit status 0 of the other, on files of every format.

use freebound_testkit::{corpus_test, grid, manifest};

use super::program::{Program, obj_text};

/// Options of the runs.
const OPTIONS: [&[&str]; 5] = [
    &[],
    &["--repair", "all", "--cut", "auto"],
    &["--repair", "safe,separate-duplicates", "--cut", "shortest"],
    &["--repair", "all", "--weld", "0.001", "--cut", "auto"],
    &["--charts", "uv", "--start", "uv"],
];

/// Names of the files of a run: an OBJ file, and a PLY or a GLB file by turns.
fn formats(turn: usize) -> [&'static str; 2] {
    ["out.obj", ["out.ply", "out.glb"][turn % 2]]
}

/// Flattens a file to these files, and checks what was written. Returns the number of files that were written.
fn agree(program: &Program, file: &str, options: &[&str], outputs: [&str; 2]) -> usize {
    let mut written = 0;
    for out in outputs {
        let flattened = program.run(&[&["flatten", file, "-o", out], options].concat());
        if !matches!(flattened.status, Some(0 | 4)) || !program.path(out).exists() {
            assert!(matches!(flattened.status, Some(2..=4)), "{file} {options:?}: {flattened:?}");
            continue;
        }
        written += 1;
        let checked = program.run(&["check", out]);
        let words = format!("{file} {options:?} {out}\n{}\n{}", flattened.stdout, checked.stdout);
        assert_eq!(flattened.status, checked.status, "{words}");
        std::fs::remove_file(program.path(out)).expect("written");
    }
    written
}

/// Small meshes with faces that a file can hold and a map cannot.
fn odd_meshes() -> Vec<(&'static str, String)> {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let hole = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\n";
    vec![
        ("a polygon with a hole", format!("{hole}f 1 2 3 4 1 5 6 7 8 5\n")),
        ("beside a quad", format!("{hole}v 3 3 1\nv 0 3 1\nf 1 2 3 4 1 5 6 7 8 5\nf 4 3 9 10\n")),
        ("a repeated corner", format!("{square}f 1 2 3 4\nf 1 1 2\nf 2 3 3\n")),
        ("a side that runs back", format!("{square}v 2 2 0\nf 1 2 3 5 3 4\n")),
        ("a duplicate face", format!("{square}f 1 2 3\nf 1 3 4\nf 3 1 2\n")),
        ("a duplicate quad that begins elsewhere", format!("{square}f 1 2 3 4\nf 2 3 4 1\n")),
        ("two sides", format!("{square}f 1 2 3 4\nf 4 3 2 1\n")),
        ("two sides with vertices of their own", format!("{square}{square}f 1 2 3 4\nf 8 7 6 5\n")),
        ("slivers", format!("{square}v 0.5 0 0\nv 0.5 0.0001 0\nf 1 2 3 4\nf 1 5 2\nf 1 6 2\n")),
        ("soup", format!("{square}{square}f 1 2 3\nf 5 7 8\n")),
        ("three faces at an edge", format!("{square}v 0 0 1\nv 0 0 -1\nf 1 2 3\nf 2 1 4\nf 1 2 5\nf 1 2 6\n")),
        ("faces that run both ways", format!("{square}f 1 2 3\nf 1 4 3\n")),
        ("a face without area", format!("{square}v 5 0 0\nv 6 0 0\nv 7 0 0\nf 1 2 3 4\nf 5 6 7\n")),
        ("a small part", format!("{square}v 5 0 0\nv 5.001 0 0\nv 5 0.001 0\nf 1 2 3 4\nf 5 6 7\n")),
        ("corners that welding joins", format!("{square}v 0.0005 0 0\nf 1 5 2 3 4\n")),
        ("a quad with corners that welding joins", format!("{square}v 0.0004 0.0003 0\nf 1 2 3\nf 5 1 3 4\n")),
        ("a thin face twice", format!("{square}v 0.0004 -0.0002 0\nf 1 2 3 4\nf 5 2 1\nf 2 1 5\n")),
        (
            "materials that overlap",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 3 0 0\nv 4 0 0\nv 4 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n\
          usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 4/1 5/2 6/3\n"
                .to_owned(),
        ),
        ("a sheet", obj_text(&(&grid(5, 4)).into())),
    ]
}

#[test]
fn flatten_and_check_agree_on_meshes_with_odd_faces() {
    let program = Program::new();
    let mut written = 0;
    for (turn, (name, text)) in odd_meshes().into_iter().enumerate() {
        program.write("in.obj", &text);
        for (place, options) in OPTIONS.into_iter().enumerate() {
            let count = agree(&program, "in.obj", options, formats(turn + place));
            println!("{name} {options:?}: {count} files");
            written += count;
        }
    }
    assert!(written > 120, "only {written} files were written");
}

corpus_test! {
    fn flatten_and_check_agree_on_the_corpus() {
        let program = Program::new();
        let mut written = 0;
        let small = |size: u64| size < 400_000;
        for (turn, entry) in manifest().into_iter().enumerate() {
            if !std::fs::metadata(&entry.path).is_ok_and(|file| small(file.len())) {
                continue;
            }
            for (place, options) in OPTIONS[..2].iter().enumerate() {
                written += agree(&program, &entry.path.display().to_string(), options, formats(turn + place));
            }
        }
        assert!(written > 40, "only {written} files were written");
    }
}
