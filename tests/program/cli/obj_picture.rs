//! OBJ files with their material and picture, as other programs read them.

use std::fs;
use std::path::Path;

use freebound::examples::Example;
use freebound_core::flatten::Flattener;
use freebound_core::geom::{Picture, PictureFrame, VAxis};
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::{Fit, Outcome, Problem, hard_targets};
use freebound_core::problem::{Control, Pins, Settings};
use freebound_io::{OutputKind, PictureFile, material_picture, read_mesh};
use glam::DVec2;

use super::program::{Program, coordinates_by_vertex, example_file};

/// Picture with red left, green right, and blue added in the upper half.
fn quarters(width: u32, height: u32) -> Picture {
    let pixel = |k: u32| {
        let (x, y) = (k % width, k / width);
        let blue = if y < height / 2 { 255 } else { 0 };
        if x < width / 2 { [255, 0, blue, 255] } else { [0, 255, blue, 255] }
    };
    Picture { width, height, pixels: (0..width * height).flat_map(pixel).collect() }
}

fn write_quarters(path: &Path) {
    freebound_io::raster::write_png(&quarters(40, 20), fs::File::create(path).unwrap()).unwrap();
}

/// Colour shown at a vertex of a mesh, as read by tobj, which is independent of this project. It renumbers vertices,
/// so the vertex is found by its position.
fn colour_at(obj: &Path, position: glam::DVec3) -> [u8; 3] {
    let (models, materials) = tobj::load_obj(obj, &tobj::LoadOptions::default()).expect("tobj reads it");
    let mesh = &models[0].mesh;
    let material = &materials.expect("tobj finds the library")[mesh.material_id.expect("a material in use")];
    let picture = obj.with_file_name(material.diffuse_texture.as_ref().expect("a picture"));
    let image = image::open(picture).expect("the picture is there").to_rgb8();
    let wanted = position.as_vec3().to_array();
    let is_it = |&index: &u32| mesh.positions[3 * index as usize..][..3] == wanted;
    let corner = mesh.indices.iter().position(is_it).expect("a corner at this place");
    let at = mesh.texcoord_indices[corner] as usize * 2;
    let [u, v] = [mesh.texcoords[at], mesh.texcoords[at + 1]].map(f64::from);
    let share = DVec2::new(u, 1.0 - v) * DVec2::new(f64::from(image.width()), f64::from(image.height()));
    let [column, row] = share.to_array().map(|x| (0..1_u32 << 16).find(|&k| f64::from(k + 1) > x).expect("a pixel"));
    image.get_pixel(column, row).0
}

#[test]
fn another_reader_finds_the_picture_and_left_is_left() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    fs::create_dir(program.path("pictures")).unwrap();
    write_quarters(&program.path("pictures/four quarters.png"));
    let arguments = [
        "flatten",
        "in.obj",
        "--picture",
        "pictures/four quarters.png",
        "-o",
        "my out.obj",
        "--pin",
        "3:0.2,0.2",
        "--pin",
        "40:0.8,0.3",
        "--pin",
        "11:0.7,0.9",
    ];
    program.run(&arguments);
    assert_eq!(program.files(), ["four_quarters.png", "in.obj", "my out.obj", "my_out.mtl", "pictures"]);
    let bytes = |name: &str| fs::read(program.path(name)).unwrap();
    assert!(bytes("four_quarters.png") == bytes("pictures/four quarters.png"), "copied byte for byte");
    let obj = program.path("my out.obj");
    assert_eq!(
        [3, 40, 11].map(|v| colour_at(&obj, mesh.mesh().positions[v])),
        [[255, 0, 0], [0, 255, 0], [0, 255, 255]]
    );
    let written = read_mesh(&obj).unwrap();
    assert_eq!(material_picture(&written, &obj), Some(program.path("four_quarters.png")), "and so does this program");
}

#[test]
fn the_picture_gives_the_aspect_and_a_second_run_changes_nothing() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    write_quarters(&program.path("four.png"));
    let pins = ["--pin", "3:0.2,0.2", "--pin", "40:0.8,0.3", "--pin", "11:0.7,0.9"];
    program.run(&[&["flatten", "in.obj", "--picture", "four.png", "-o", "out.obj"][..], &pins].concat());
    let once: Vec<Vec<u8>> = program.files().iter().map(|name| fs::read(program.path(name)).unwrap()).collect();
    assert_eq!(
        program.files(),
        ["four.png", "in.obj", "out.mtl", "out.obj"],
        "a picture beside the mesh is not copied"
    );
    program.run(&[&["flatten", "in.obj", "--picture", "four.png", "-o", "out.obj"][..], &pins].concat());
    let again: Vec<Vec<u8>> = program.files().iter().map(|name| fs::read(program.path(name)).unwrap()).collect();
    assert!(once == again);
    program.run(&[&["flatten", "in.obj", "--aspect", "40:20", "-o", "aspect.obj"][..], &pins].concat());
    let read = |name: &str| coordinates_by_vertex(&read_mesh(&program.path(name)).unwrap());
    assert_eq!(read("out.obj"), read("aspect.obj"));
}

#[test]
fn files_of_others_are_not_written_over() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    fs::create_dir(program.path("pictures")).unwrap();
    write_quarters(&program.path("pictures/four.png"));
    program.write("four.png", "somebody's");
    program.write("out.mtl", "newmtl somebody's\n");
    program.run(&["flatten", "in.obj", "--picture", "pictures/four.png", "-o", "out.obj"]).expect(0);
    assert_eq!(fs::read_to_string(program.path("four.png")).unwrap(), "somebody's");
    assert_eq!(fs::read_to_string(program.path("out.mtl")).unwrap(), "newmtl somebody's\n");
    let names = ["four.png", "in.obj", "out-four.png", "out-picture.mtl", "out.mtl", "out.obj", "pictures"];
    assert_eq!(program.files(), names);
    let [r, g, b] = colour_at(&program.path("out.obj"), mesh.mesh().positions[3]);
    assert!(r + g == 255 && (b == 0 || b == 255), "the picture that was asked for");
}

#[test]
fn where_names_are_taken_again_and_again_they_are_counted_up() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    fs::create_dir(program.path("pictures")).unwrap();
    write_quarters(&program.path("pictures/four.png"));
    // A library of another mesh, and a folder, do not belong to this mesh either.
    let others = [
        ("four.png", "somebody's"),
        ("out-four.png", "somebody's"),
        ("out.mtl", "newmtl somebody's\n"),
        ("out-picture.mtl", "# Freebound: the picture of in.obj\n"),
        ("out-picture-2.mtl", ""),
    ];
    for (name, text) in others {
        program.write(name, text);
    }
    fs::create_dir(program.path("out-four-2.png")).unwrap();
    let arguments = ["flatten", "in.obj", "--picture", "pictures/four.png", "-o", "out.obj"];
    program.run(&arguments).expect(0);
    let files = program.files();
    program.run(&arguments).expect(0);
    assert_eq!(program.files(), files, "what was written before is written again");
    for (name, text) in others {
        assert_eq!(fs::read_to_string(program.path(name)).unwrap(), text, "{name}");
    }
    let [picture, library] = ["out-four-3.png", "out-picture-3.mtl"].map(str::to_owned);
    assert!(files.contains(&picture) && files.contains(&library), "{files:?}");
    assert_eq!(files.len(), others.len() + 6, "{files:?}");
    let [r, g, b] = colour_at(&program.path("out.obj"), mesh.mesh().positions[3]);
    assert!(r + g == 255 && (b == 0 || b == 255), "the picture that was asked for");
}

#[test]
fn a_picture_of_no_file_is_not_written_over_files_of_others() {
    let model = Example::Dome.model();
    let mesh: &DiskMesh = model.disk().unwrap();
    let step = Flattener::new(Settings::default(), Pins::new()).step(mesh, Control::unattended()).unwrap();
    let outcome = Outcome::new(mesh, Problem::default(), step);
    let picture = PictureFile { name: "four".into(), path: None, stamp: None, pixels: quarters(4, 2).into() };
    let mut finished = model.finished(&outcome, Vec::new(), Fit::Unit);
    finished.picture = Some(&picture);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["out-picture.png", "out-picture-2.png"] {
        fs::write(path(name), "somebody's").unwrap();
    }
    for _ in 0..2 {
        finished.write(OutputKind::Obj, &path("out.obj")).unwrap();
    }
    for name in ["out-picture.png", "out-picture-2.png"] {
        assert_eq!(fs::read_to_string(path(name)).unwrap(), "somebody's");
    }
    let written = read_mesh(&path("out.obj")).unwrap();
    assert_eq!(material_picture(&written, &path("out.obj")), Some(path("out-picture-3.png")));
    assert_eq!(*PictureFile::read(&path("out-picture-3.png")).unwrap().pixels, quarters(4, 2));
    assert!(!path("out-picture-4.png").exists(), "a second time it is found again");
}

#[test]
fn the_material_replaces_those_before_it_and_groups_stay() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    let text = fs::read_to_string(program.path("in.obj")).unwrap();
    let text = text.replacen("f ", "mtllib old.mtl\no cap\ng half\nusemtl old\nf ", 1) + "g none\n";
    program.write("in.obj", &text);
    write_quarters(&program.path("four.png"));
    program.run(&["flatten", "in.obj", "--picture", "four.png", "-o", "out.obj"]).expect(0);
    let out = read_mesh(&program.path("out.obj")).unwrap();
    let texts: Vec<String> = out.statements.iter().map(|s| String::from_utf8(s.text.clone()).unwrap()).collect();
    assert_eq!(texts, ["mtllib out.mtl", "o cap", "g half", "usemtl picture", "g none"]);
    assert_eq!(out.polygons.face_count(), mesh.face_count());
}

#[test]
fn where_v_runs_down_it_runs_up_in_the_file_and_the_verdict_is_on_that() {
    let model = Example::Dome.model();
    let mesh: &DiskMesh = model.disk().unwrap();
    let frame = PictureFrame { aspect: 2.0, v_axis: VAxis::Down };
    let targets = [(3, [0.2, 0.8]), (40, [0.8, 0.7]), (11, [0.7, 0.1])];
    let uv = hard_targets(targets.map(|(v, uv)| (freebound_core::mesh::VertexId::new(v), uv.into())));
    let problem = Problem { frame, targets: uv, ..Problem::default() };
    let step = Flattener::new(problem.settings.clone(), problem.pins()).step(mesh, Control::unattended()).unwrap();
    let outcome = Outcome::new(mesh, problem, step);
    let finished = model.finished(&outcome, Vec::new(), Fit::Unit);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.obj");
    finished.write(OutputKind::Obj, &path).unwrap();
    let written = coordinates_by_vertex(&read_mesh(&path).unwrap());
    for (v, [u, down]) in targets {
        assert_eq!(written[v as usize], DVec2::new(u, 1.0 - down), "vertex {v}");
    }
    assert_eq!(finished.charts[0].verdict, freebound_core::verify::verdict(mesh, &written));
    assert_eq!(finished.report.pins.as_ref().unwrap().max_error, 0.0);
}

#[test]
fn the_picture_is_on_the_mesh_in_the_picture_of_it() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    write_quarters(&program.path("four.png"));
    program.run(&["flatten", "in.obj", "--picture", "four.png", "--png", "out.png"]).expect(0);
    let shown = PictureFile::read(&program.path("out.png")).unwrap().pixels;
    let left = (0..shown.width / 2).flat_map(|x| (0..shown.height).map(move |y| (x, y)));
    let colours = left.filter_map(|(x, y)| shown.pixel(x, y));
    let (mut red, mut green) = (0, 0);
    for [r, g, ..] in colours {
        red += usize::from(r > 100 && g < 30);
        green += usize::from(g > 100 && r < 30);
    }
    assert!(red > 10_000 && green > 10_000, "{red} {green}");
}

#[test]
fn the_picture_of_mesh_and_layout_is_not_squeezed_where_the_aspect_is_not_square() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Ell);
    // Equal positions in the plane, also as texture coordinates of a picture twice as wide as high.
    let shown = |aspect: &str, width: f64| {
        let pin = |&v: &usize| {
            let place = mesh.mesh().positions[v].truncate() * 0.1;
            ["--pin".to_owned(), format!("{v}:{:?},{:?}", place.x / width, place.y)]
        };
        let pins: Vec<String> = [0, 20, 90].iter().flat_map(pin).collect();
        let mut arguments = vec!["flatten", "in.obj", "--aspect", aspect, "--png", "out.png"];
        arguments.extend(pins.iter().map(String::as_str));
        program.run(&arguments).expect(0);
        PictureFile::read(&program.path("out.png")).unwrap().pixels
    };
    let (square, wide) = (shown("1:1", 1.0), shown("2:1", 2.0));
    let pairs = square.pixels.chunks_exact(4).zip(wide.pixels.chunks_exact(4));
    let different = pairs.filter(|(a, b)| a != b).count();
    // Rounding may move the edge of a field past the middle of a pixel.
    assert!(different < 100, "{different} pixels, in checker or layout");
}

/// Material of each triangle of a GLB file, by another reader: its name, its colour, and its decoded picture.
fn materials_of(path: &Path) -> Vec<(String, [f32; 4], Option<image::RgbaImage>, usize)> {
    let bytes = fs::read(path).expect("it was written");
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).expect("another reader takes it");
    let blob = blob.expect("a binary chunk");
    let picture = |texture: gltf::texture::Info<'_>| {
        let gltf::image::Source::View { view, mime_type } = texture.texture().source().source() else {
            panic!("the picture is inside the file");
        };
        let bytes = &blob[view.offset()..][..view.length()];
        let format = image::ImageFormat::from_mime_type(mime_type).expect("a format");
        image::load_from_memory_with_format(bytes, format).expect("a picture").to_rgba8()
    };
    let of = |primitive: gltf::Primitive<'_>| {
        let material = primitive.material();
        let look = material.pbr_metallic_roughness();
        let triangles = primitive.indices().expect("indices").count() / 3;
        let name = material.name().expect("a name").to_owned();
        (name, look.base_color_factor(), look.base_color_texture().map(picture), triangles)
    };
    document.meshes().flat_map(|mesh| mesh.primitives().map(of).collect::<Vec<_>>()).collect()
}

#[test]
fn a_glb_file_holds_the_picture() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    write_quarters(&program.path("quarters.png"));
    program.run(&["flatten", "in.obj", "--picture", "quarters.png", "-o", "out.glb"]).expect(0);
    let materials = materials_of(&program.path("out.glb"));
    let [(name, colour, Some(picture), triangles)] = &materials[..] else { panic!("{} materials", materials.len()) };
    assert_eq!((name.as_str(), *colour, *triangles), ("picture", [1.0; 4], mesh.face_count()));
    assert_eq!(picture.as_raw(), &quarters(40, 20).pixels);
}

#[test]
fn a_glb_file_holds_the_materials_of_an_obj_file_with_their_colours_and_pictures() {
    let program = Program::new();
    write_quarters(&program.path("four quarters.png"));
    program.write("all.mtl", "newmtl red\nKd 1 0.25 0\nd 0.5\nnewmtl photo\nKd 0 0 0\nmap_Kd four quarters.png\n");
    program.write(
        "in.obj",
        "mtllib all.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 0\n\
         usemtl photo\nf 1 2 3 4\nusemtl red\nf 2 5 6 3\nusemtl photo\nf 5 7 6\nusemtl missing\n",
    );
    program.run(&["flatten", "in.obj", "-o", "out.glb"]).expect(0);
    let found = materials_of(&program.path("out.glb"));
    let looks: Vec<_> = found.iter().map(|(name, colour, _, triangles)| (name.as_str(), *colour, *triangles)).collect();
    assert_eq!(looks, [("photo", [1.0; 4], 3), ("red", [1.0, 0.25, 0.0, 0.5], 2)]);
    assert_eq!(found[0].2.as_ref().expect("a picture").as_raw(), &quarters(40, 20).pixels);
    assert!(found[1].2.is_none());
    // A line that is not understood changes nothing else, and one number is a shade of grey. A picture of another format
    // cannot come along, but the colour does.
    program.write(
        "all.mtl",
        "newmtl red\nKd spectral red.rfl\nKd 0.5\nd -halo 0.5\nnewmtl photo\nKd 0 1 0\nmap_Kd no.tga\n",
    );
    program.run(&["flatten", "in.obj", "-o", "grey.glb"]).expect(0);
    let colours: Vec<_> = materials_of(&program.path("grey.glb")).into_iter().map(|own| own.1).collect();
    assert_eq!(colours, [[0.0, 1.0, 0.0, 1.0], [0.5, 0.5, 0.5, 1.0]]);
    // Without the library the names are left.
    fs::remove_file(program.path("all.mtl")).expect("it is there");
    program.run(&["flatten", "in.obj", "-o", "again.glb"]).expect(0);
    let names: Vec<String> = materials_of(&program.path("again.glb")).into_iter().map(|own| own.0).collect();
    assert_eq!(names, ["photo", "red"]);
}

#[test]
fn a_drawing_has_true_lengths_or_is_the_unit_square() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Ell);
    let view_box = |options: &[&str]| -> [f64; 4] {
        program.run(&[&["flatten", "in.obj", "--svg", "out.svg"][..], options].concat()).expect(0);
        let text = fs::read_to_string(program.path("out.svg")).unwrap();
        let inside = text.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        let numbers: Vec<f64> = inside.split(' ').map(|word| word.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    assert_eq!(view_box(&[]), [0.0, 0.0, 1000.0, 1000.0]);
    assert_eq!(view_box(&["--svg-scale", "unit", "--aspect", "2:1"]), [0.0, 0.0, 1000.0, 500.0]);
    let [.., width, height] = view_box(&["--svg-scale", "true"]);
    // In the drawing's units the outline is as long as on the mesh, since the L is flat.
    let text = fs::read_to_string(program.path("out.svg")).unwrap();
    assert!(text.contains(&format!("width=\"{width}\" height=\"{height}\"")));
    let line = text.lines().find(|line| line.contains("class=\"boundary\"")).unwrap();
    let data = line.split(" d=\"").nth(1).unwrap().split('Z').next().unwrap();
    let points: Vec<DVec2> = data[1..]
        .split('L')
        .map(|point| {
            let (x, y) = point.split_once(' ').unwrap();
            DVec2::new(x.parse().unwrap(), y.parse().unwrap())
        })
        .collect();
    let length: f64 = (0..points.len()).map(|k| points[k].distance(points[(k + 1) % points.len()])).sum();
    let rim = mesh.boundary_loop();
    let wanted: f64 =
        (0..rim.len()).map(|k| mesh.position(rim[k]).distance(mesh.position(rim[(k + 1) % rim.len()]))).sum();
    assert!((length / wanted - 1.0).abs() < 1e-4, "{length} {wanted}");
    let run = program.run(&["flatten", "in.obj", "--svg-scale", "true"]).expect(2);
    assert!(run.stderr.contains("--svg"), "{}", run.stderr);
}
