//! `freebound compare --morph`: the animated picture, read frame by frame with the PNG decoder, and every frame's
//! embedding proved by the oracle.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixel numbers and colours come from small positive floats"
)]

use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use freebound::session::{Compared, Document, MORPH_FRAMES, Model, MorphStops, MorphTour};
use freebound::view::{CellShading, MorphPicture, Quantity};
use freebound_core::bijective::Route;
use freebound_core::geom::Picture;
use freebound_core::mesh::{DiskMesh, Preparation, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, NamedOption as _, Phase, Settings, Variant,
};
use freebound_io::figure::{CellContent, Still, TintedDrawing, Window};
use freebound_io::{AnimationForm, AnimationFrame, write_animation};
use serde_json::Value;

use super::program::Program;
use super::report_schema::{Schema, TENT};
use freebound_testkit::oracle::examine;
use freebound_testkit::{assert_message, sheet, write_obj};

/// Mesh file.
const IN: &str = "sheet.obj";

/// Pixels per point of a frame, and the range of the drawing on its page, points.
const PIXELS: f64 = 1.25;
const DRAWING: [f64; 2] = [14.0, 334.0];

fn with_sheet() -> Program {
    let program = Program::new();
    write_obj(&program.path(IN), &sheet(4, 0.4));
    program
}

/// Contents of an animated PNG: pictures without opacity, their display times, and the number of plays.
struct Decoded {
    size: [u32; 2],
    frames: Vec<Vec<u8>>,
    milliseconds: Vec<u32>,
    plays: u32,
}

fn decoded(bytes: &[u8]) -> Decoded {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
    let info = reader.info();
    let control = info.animation_control.expect("it is animated");
    let size = [info.width, info.height];
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    let (mut frames, mut milliseconds) = (Vec::new(), Vec::new());
    for _ in 0..control.num_frames {
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
        let frame = reader.next_frame(&mut pixels).expect("a frame");
        assert_eq!([frame.width, frame.height], size);
        let timing = reader.info().frame_control.expect("every frame has its time");
        milliseconds.push(1000 * u32::from(timing.delay_num) / u32::from(timing.delay_den));
        frames.push(pixels);
    }
    assert!(reader.next_frame(&mut vec![0; 4 * frames[0].len()]).is_err(), "no further frame");
    Decoded { size, frames, milliseconds, plays: control.num_plays }
}

/// Picture as in an animation: without opacity, colours rounded to multiples of 4.
fn opaque(picture: &Picture) -> Vec<u8> {
    let rounded = |channel: &u8| ((f64::from(*channel) / 4.0).round() * 4.0).min(255.0) as u8;
    picture.pixels.chunks_exact(4).flat_map(|pixel| pixel[..3].iter().map(rounded).collect::<Vec<_>>()).collect()
}

/// Mesh with the results of methods, computed as in the program.
fn compared(path: &Path, methods: &[&str]) -> (Model, Vec<Compared>) {
    let model = Model::read(path, Preparation::default()).expect("it was written just now");
    let problem = Document { settings: Settings::default(), ..Document::default() }.problem();
    let run = |name: &&str| {
        let variant = name.parse::<Variant>().expect("a method");
        Compared::run(&model, problem.by(&variant), Control::unattended(), |_| {}).expect("nobody cancels")
    };
    let found = methods.iter().map(run).collect();
    (model, found)
}

fn report(program: &Program, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(program.path(name)).expect("a report")).expect("JSON")
}

/// Smallest ratio of a face's share of the area in the plane to its share on the surface.
fn least_ratio(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let areas: Vec<[f64; 2]> = mesh
        .faces()
        .map(|face| {
            let corners = mesh.face(face);
            let [in_space, in_space_too] = [1, 2].map(|k| mesh.position(corners[k]) - mesh.position(corners[0]));
            let [in_plane, in_plane_too] = [1, 2].map(|k| embedding[corners[k]] - embedding[corners[0]]);
            [in_space.cross(in_space_too).length(), in_plane.perp_dot(in_plane_too)]
        })
        .collect();
    let [surface, plane] = [0, 1].map(|k| areas.iter().map(|of| of[k]).sum::<f64>());
    areas.iter().map(|[on, of]| (of / plane) / (on / surface)).fold(f64::INFINITY, f64::min)
}

/// Drawing of a method's map in a window of half-width `half`, cropped from its page.
fn drawing_of(model: &Model, method: &Compared, half: f64, others: &[&Compared]) -> Picture {
    let outcome = method.outcome.as_ref().expect("a map");
    let mesh = model.disk().expect("a disk");
    let quantity = Quantity::Angle;
    let all = others.iter().map(|of| &of.outcome.as_ref().expect("a map").distortion);
    let range = quantity.common_range(all).expect("there are maps");
    let colour = |value: &f64| quantity.scale().colour_at((range.share(*value) * 63.0).round() / 63.0);
    let colours = quantity.values(&outcome.distortion).iter().map(colour).collect();
    let window = Window { centre: outcome.step.candidate.solution.embedding.bounds().middle(), half };
    let content = CellContent::Plane(TintedDrawing::of_step(mesh, &outcome.step, colours, window));
    let still = Still { content, title: String::new(), lines: vec![String::new(); 2], bar: None };
    still.page().picture(PIXELS)
}

/// Pixels of the drawing in a frame, without its outline.
fn drawing(pixels: &[u8], width: u32) -> Vec<&[u8]> {
    let [low, high] = DRAWING.map(|at| (at * PIXELS) as usize);
    let row = 3 * width as usize;
    (low + 2..high - 2).map(|y| &pixels[y * row + 3 * (low + 2)..y * row + 3 * (high - 2)]).collect()
}

#[test]
fn between_two_maps_the_picture_goes_there_and_back_through_frames_that_the_oracle_finds_planar() {
    let program = with_sheet();
    let names = ["natural", "convex/uniform"];
    let files = ["--morph", "m.png", "--frames", "4", "--report", "r.json"];
    let run = program.run(&[&["compare", IN, "--methods", &names.join(",")], &files[..]].concat()).expect(0);
    let found = decoded(&fs::read(program.path("m.png")).unwrap());
    assert_eq!((found.frames.len(), found.plays), (6, 0), "four there and two back, without end");
    assert_eq!(found.milliseconds, [1000, 40, 40, 1000, 40, 40]);
    assert_eq!((&found.frames[1], &found.frames[2]), (&found.frames[5], &found.frames[4]));
    assert!((0..4).all(|k| (0..k).all(|other| found.frames[k] != found.frames[other])));

    // Maps as in `compare`, drawn from their steps.
    let (model, methods) = compared(&program.path(IN), &names);
    let methods: Vec<&Compared> = methods.iter().collect();
    let mesh = model.disk().unwrap();
    let tour = MorphTour::through(mesh, MorphStops::of(&methods), 4, Control::unattended()).unwrap();
    let extent = |embedding: &Embedding| embedding.bounds().size().max_element();
    let half = 0.54 * tour.legs[0].frames.iter().map(extent).fold(0.0, f64::max);
    for (method, frame) in methods.iter().zip([0, 3]) {
        let own = opaque(&drawing_of(&model, method, half, &methods));
        assert_eq!(drawing(&found.frames[frame], found.size[0]), drawing(&own, found.size[0]), "frame {frame}");
    }

    // Intermediate frames are proved by the oracle, and equal the drawn ones.
    let picture = MorphPicture::new(mesh, &tour, CellShading::default());
    let triangles: Vec<[u32; 3]> =
        mesh.mesh().triangles.iter().map(|t| t.map(|v: VertexId| u32::try_from(v.index()).unwrap())).collect();
    for (k, place) in picture.places().into_iter().enumerate() {
        assert!(found.frames[k] == opaque(&picture.frame(place).picture), "frame {k}");
        let answer = examine(&triangles, &tour.legs[place.leg].frames[place.frame]);
        assert!(answer.injective && !answer.mirrored, "frame {k}: {answer:?}");
    }
    let leg = &report(&program, "r.json")["morph"]["legs"][0];
    assert_eq!((&leg["from"], &leg["to"]), (&Value::from(names[0]), &Value::from(names[1])));
    assert_eq!((&leg["frames"], &leg["proved"]), (&Value::from(4), &Value::from(4)));
    assert_eq!(leg["route"], tour.legs[0].route.name());
    let least = tour.legs[0].frames.iter().map(|frame| least_ratio(mesh, frame)).fold(f64::INFINITY, f64::min);
    let reported = leg["least_determinant"].as_f64().unwrap();
    assert!((reported - least).abs() < 1e-9 * least && reported > 0.0, "{reported} and {least}");
    let line = run.stdout.lines().find(|line| line.starts_with("morph")).expect("a line on the morph");
    assert_message("morph-between-two-maps", &line.split(", ").take(2).collect::<Vec<_>>().join(", "));
}

#[test]
fn several_planar_maps_are_visited_in_their_order_and_the_others_are_named() {
    let program = Program::new();
    program.write("tent.obj", TENT);
    // With three pins there is no virtual boundary.
    let pins = ["--pin", "0:0,0", "--pin", "1:1,0.2", "--pin", "2:0.9,1"];
    let list = "iterate,virtual-boundary,auto,natural";
    let files = ["--morph", "m.png", "--frames", "3", "--report", "r.json"];
    let run = program.run(&[&["compare", "tent.obj", "--methods", list], &pins[..], &files[..]].concat()).expect(0);
    let morph = &report(&program, "r.json")["morph"];
    let left: Vec<&str> = morph["left_out"].as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap()).collect();
    assert!(left.contains(&"virtual-boundary"), "{morph}");
    let mut stops: Vec<&str> = list.split(',').collect();
    stops.retain(|name| !left.contains(name));
    let legs = morph["legs"].as_array().unwrap();
    let ends: Vec<[&str; 2]> = legs.iter().map(|leg| ["from", "to"].map(|end| leg[end].as_str().unwrap())).collect();
    assert_eq!(ends, stops.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>());
    let names_it = |line: &&str| line.starts_with("morph") && line.contains("virtual-boundary");
    assert_message("morph-without-a-map", run.stdout.lines().find(names_it).expect("a line on the method"));
    let found = decoded(&fs::read(program.path("m.png")).unwrap());
    let count = if legs.len() == 1 { 4 } else { 2 * legs.len() + 1 };
    assert_eq!(found.frames.len(), count, "{morph}");
}

#[test]
fn fewer_than_two_planar_maps_are_an_error_with_a_remedy_and_nothing_is_written() {
    let program = Program::new();
    program.write("tent.obj", TENT);
    let pins = ["--pin", "0:0,0", "--pin", "1:1,0.2", "--pin", "2:0.9,1"];
    let list = "virtual-boundary,auto";
    let files = ["--morph", "m.png", "--csv", "all.csv", "--report", "r.json"];
    let run = program.run(&[&["compare", "tent.obj", "--methods", list], &pins[..], &files[..]].concat()).expect(4);
    assert_message("morph-needs-two-maps", &run.stderr);
    assert_eq!(run.stdout, "");
    assert_eq!(program.files(), ["r.json", "tent.obj"], "nothing but the report of that");
    let report = report(&program, "r.json");
    assert_eq!(Schema::of_reports().faults(&report), Vec::<String>::new(), "{report:#}");
    let error = &report["error"];
    assert_eq!((&error["kind"], &error["exit_status"]), (&Value::from("no-morph"), &Value::from(4)));
    let remedy = error["remedy"].as_str().expect("a remedy");
    assert!(remedy.contains("--methods") && run.stderr.contains(remedy), "{remedy}");
}

#[test]
fn wrong_use_of_a_morph_ends_with_2_and_writes_nothing() {
    let program = with_sheet();
    let refused = |arguments: &[&str]| {
        let run = program.run(&[&["compare", IN], arguments].concat()).expect(2);
        assert_eq!(program.files(), [IN], "{arguments:?}");
        run.stderr
    };
    let malformed: [(&[&str], &str); 3] = [
        (&["--methods", "natural,convex", "--frames", "5"], "--morph"),
        (&["--methods", "natural,convex", "--morph", "m.png", "--frames", "2"], "3..=1000"),
        (&["--methods", "natural,convex", "--morph", "m.png", "--frames", "1001"], "3..=1000"),
    ];
    for (arguments, word) in malformed {
        let stderr = refused(arguments);
        assert!(stderr.contains(word), "{arguments:?}: {stderr}");
    }
    let impossible: [(&str, &[&str]); 4] = [
        ("one-method", &["--methods", "natural", "--morph", "m.png"]),
        ("one-file-twice", &["--methods", "natural,convex", "--morph", "m.png", "--png", "m.png"]),
        ("over-the-mesh", &["--methods", "natural,convex", "--morph", IN]),
        ("one-stream-twice", &["--methods", "natural,convex", "--morph", "-", "--csv", "-"]),
    ];
    for (case, arguments) in impossible {
        assert_message(&format!("morph-{case}"), &refused(arguments));
    }
}

/// Longest names of methods on the command line, on named shapes.
fn longest_names() -> [String; 2] {
    let shapes = || BoundaryShape::ALL.iter().filter(|shape| !matches!(shape, BoundaryShape::Polygon(_)));
    let methods = Method::ALL.iter().flat_map(|method| shapes().map(|shape| method.clone().on_shape(shape.clone())));
    let variants = methods.flat_map(|method| {
        let suited = Family::ALL.iter().filter(|family| family.check_for(&method).is_ok() && method.uses_family());
        suited.map(|&family| Variant { method: method.clone(), family: Some(family) }).collect::<Vec<_>>()
    });
    let mut names: Vec<String> = variants.map(|variant| variant.to_string()).collect();
    names.sort_by_key(|name| std::cmp::Reverse(name.len()));
    names.dedup();
    [names[0].clone(), names[1].clone()]
}

#[test]
fn the_longest_names_stay_on_the_page_and_all_frames_have_one_size() {
    let program = with_sheet();
    let (model, methods) = compared(&program.path(IN), &["natural", "convex/uniform"]);
    let mut stops = MorphStops::of(&methods.iter().collect::<Vec<_>>());
    let longest = longest_names();
    assert_eq!(longest, ["convex/shape-preserving@square", "convex/shape-preserving@hull"]);
    for (stop, name) in stops.stops.iter_mut().zip(longest) {
        stop.name = name;
    }
    let mesh = model.disk().unwrap();
    let tour = MorphTour::through(mesh, stops, 3, Control::unattended()).unwrap();
    let picture = MorphPicture::new(mesh, &tour, CellShading::default());
    let pages: Vec<Picture> = picture.places().into_iter().map(|place| picture.frame(place).picture).collect();
    let paper = pages[0].pixels[..4].to_vec();
    // Half of the margin, since a stroke may be rounded into it.
    let free = ((DRAWING[1] + 7.0) * PIXELS) as usize;
    for (number, page) in pages.iter().enumerate() {
        let width = page.width as usize;
        assert_eq!((page.width, page.height), (pages[0].width, pages[0].height));
        assert!(free + 5 < width);
        let rows = page.pixels.chunks_exact(4 * width);
        assert!(rows.into_iter().all(|row| row[4 * free..].chunks_exact(4).all(|at| at == paper)), "frame {number}");
    }
}

#[test]
fn the_search_announces_each_frame_that_it_looks_at_once() {
    let program = with_sheet();
    let (model, methods) = compared(&program.path(IN), &["natural", "convex/uniform"]);
    for frames in [5, 6] {
        let (cancel, proofs) = (AtomicBool::new(false), AtomicUsize::new(0));
        let count = |phase: Phase| {
            proofs.fetch_add(usize::from(phase == Phase::Verify), Ordering::Relaxed);
        };
        let stops = MorphStops::of(&methods.iter().collect::<Vec<_>>());
        let tour = MorphTour::through(model.disk().unwrap(), stops, frames, Control::new(&cancel, &count)).unwrap();
        assert_eq!((tour.legs[0].route, tour.legs[0].frames.len()), (Route::Straight, frames));
        // Both ends are already proved. With an even number of frames none is at the midpoint, which is verified
        // additionally.
        let half_way = usize::from(frames % 2 == 0);
        assert_eq!(proofs.load(Ordering::Relaxed), frames - 2 + half_way);
    }
}

#[test]
fn frames_are_refused_that_would_take_more_than_half_of_the_memory() {
    let program = with_sheet();
    let (model, methods) = compared(&program.path(IN), &["natural", "convex/uniform", "convex"]);
    let mesh = model.disk().unwrap();
    let stops = MorphStops::of(&methods.iter().collect::<Vec<_>>());
    assert_eq!((stops.stops.len(), mesh.vertex_count()), (3, 25));
    assert_eq!(MORPH_FRAMES % 2, 1, "one is half way");
    // From map to map twice.
    let needed = 2 * 1000 * 25 * 16;
    assert_eq!(stops.check_memory(mesh, 1000, None), Ok(()));
    assert_eq!(stops.check_memory(mesh, 1000, Some(2 * needed)), Ok(()));
    let shortage = stops.check_memory(mesh, 1000, Some(2 * needed - 1)).unwrap_err();
    assert_eq!((shortage.frames, shortage.needed, shortage.memory), (1000, needed, 2 * needed - 1));
    let tour = MorphTour::through(mesh, stops, 5, Control::unattended()).unwrap();
    let bytes = |frame: &Embedding| size_of_val(&frame[..]);
    let kept: usize = tour.legs.iter().flat_map(|leg| &leg.frames).map(bytes).sum();
    assert_eq!(kept, 2 * 5 * 25 * 16, "what is counted is what is kept");
}

#[test]
fn the_same_animated_picture_comes_out_with_any_number_of_threads() {
    let program = with_sheet();
    let list = ["compare", IN, "--methods", "natural,convex", "--frames", "3", "--shading", "checker"];
    for (threads, name) in [("1", "one.png"), ("3", "three.png")] {
        program.run(&[&list[..], &["--threads", threads, "--morph", name]].concat()).expect(0);
    }
    let [one, three] = ["one.png", "three.png"].map(|name| fs::read(program.path(name)).unwrap());
    assert!(one == three);
    let found = decoded(&one);
    assert!(found.frames.len() == 4 && found.frames[0] != found.frames[1], "the checker moves");
}

#[test]
fn every_route_has_a_name_of_its_own() {
    let mut names = Route::ALL.map(Route::name).to_vec();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Route::ALL.len());
}

#[test]
fn an_animation_has_as_many_frames_of_its_size_as_it_says_or_is_an_error() {
    let frame =
        |side: u32| AnimationFrame { picture: Picture::filled(side, side, [12, 201, 255, 255]), milliseconds: 5 };
    let write = |frame_count: u32, frames: Vec<AnimationFrame>| {
        let mut out = Vec::new();
        write_animation(&mut out, AnimationForm { size: [3, 3], frame_count }, frames).map(|()| out)
    };
    let found = decoded(&write(2, vec![frame(3), frame(3)]).expect("as announced"));
    assert_eq!(found.frames, [[12, 200, 255].repeat(9), [12, 200, 255].repeat(9)]);
    assert_eq!(found.milliseconds, [5, 5]);
    assert!(write(2, vec![frame(3)]).is_err() && write(1, vec![frame(3), frame(3)]).is_err());
    assert!(write(1, vec![frame(4)]).is_err() && write(0, vec![]).is_err());
}
