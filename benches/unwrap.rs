//! Unwrapping of twelve public meshes, beside the figures that other programs reach on them: `cargo bench --bench unwrap`.
//! Arguments after `--` select meshes by name; a number sets the bound on the energy.
//!
//! All measures are computed here from positions and texture coordinates alone, at equal total areas:
//!
//! | column | meaning |
//! |---|---|
//! | seam | length of the edges whose faces have different texture coordinates, relative to √area |
//! | area | mean over the surface of max(r, 1/r), r the ratio of areas |
//! | L² | stretch (P. Sander and others, "Texture mapping progressive meshes", 2001) |
//! | energy | mean symmetric Dirichlet energy; 4 is isometric |
//!
//! Figures of others: seams of `OptCuts` (M. Li and others 2018), charts of `PartUV` (2025) and seams of uvunwrap 0.3,
//! as published or measured in 2026.

mod common;

use std::collections::{BTreeMap, HashMap};

use freebound_core::mesh::{FaceId, PolygonMesh, VertexId};
use freebound_core::{PipelineOptions, Unwrapped, unwrap};
use freebound_io::read_mesh;
use freebound_testkit::corpus;
use glam::{DVec2, DVec3};

use common::machine::print_machine;
use common::table::{Table, ratio, target};
use common::{arguments, time};

/// A mesh, and what others reach on it.
struct Case {
    name: &'static str,
    /// Seam of `OptCuts`, if it succeeds.
    optcuts: Option<f64>,
    /// Charts of `PartUV`, if they are published.
    part_uv: Option<usize>,
    /// Seam of uvunwrap.
    uvunwrap: f64,
    /// Seam to reach.
    seam: f64,
    /// Seconds to reach on two cores.
    seconds: f64,
}

const CASES: [Case; 12] = [
    Case { name: "spot", optcuts: Some(4.06), part_uv: Some(9), uvunwrap: 12.6, seam: 3.4, seconds: 2.0 },
    Case { name: "homer", optcuts: Some(4.78), part_uv: Some(27), uvunwrap: 16.5, seam: 4.0, seconds: 2.0 },
    Case { name: "fandisk", optcuts: Some(1.91), part_uv: Some(4), uvunwrap: 8.0, seam: 1.9, seconds: 2.0 },
    Case { name: "cheburashka", optcuts: Some(4.39), part_uv: Some(22), uvunwrap: 15.5, seam: 3.7, seconds: 2.0 },
    Case { name: "suzanne", optcuts: None, part_uv: Some(27), uvunwrap: 15.4, seam: 7.7, seconds: 2.0 },
    Case { name: "beetle", optcuts: None, part_uv: Some(73), uvunwrap: 17.6, seam: 8.8, seconds: 2.0 },
    Case { name: "cow", optcuts: None, part_uv: Some(20), uvunwrap: 16.7, seam: 8.35, seconds: 2.0 },
    Case { name: "rocker-arm", optcuts: None, part_uv: None, uvunwrap: 13.8, seam: 6.9, seconds: 10.0 },
    Case { name: "beast", optcuts: None, part_uv: Some(188), uvunwrap: 39.0, seam: 19.5, seconds: 10.0 },
    Case { name: "stanford-bunny", optcuts: None, part_uv: None, uvunwrap: 16.3, seam: 8.15, seconds: 12.0 },
    Case { name: "nefertiti", optcuts: None, part_uv: Some(6), uvunwrap: 35.7, seam: 17.85, seconds: 20.0 },
    Case { name: "ogre", optcuts: None, part_uv: Some(174), uvunwrap: 35.4, seam: 17.7, seconds: 25.0 },
];

fn main() {
    print_machine();
    let words = arguments();
    let bound: Option<f64> = words.iter().find_map(|word| word.parse().ok());
    let names: Vec<&String> = words.iter().filter(|word| word.parse::<f64>().is_err()).collect();
    let heads = [
        "mesh",
        "faces",
        "charts",
        "seam",
        "area",
        "L²",
        "energy",
        "planar",
        "in 32 bits",
        "s",
        "OptCuts seam",
        "PartUV charts",
        "uvunwrap seam",
        "seam wanted",
        "s wanted",
    ];
    let mut table = Table::new("unwrapping to an energy of at most 4.1", &heads);
    for case in CASES.iter().filter(|case| names.is_empty() || names.iter().any(|name| *name == case.name)) {
        let path = corpus().join("../unwrap").join(format!("{}.obj", case.name));
        let Ok(file) = read_mesh(&path) else {
            println!("{}: skipped, {} cannot be read", case.name, path.display());
            continue;
        };
        let usual = PipelineOptions::for_any_mesh();
        let options = PipelineOptions { distortion: bound.or(usual.distortion), ..usual };
        let (seconds, unwrapped) = time(|| unwrap(&file.polygons, &options));
        let unwrapped = match unwrapped {
            Ok(unwrapped) => unwrapped,
            Err(error) => {
                println!("{}: {error}", case.name);
                continue;
            }
        };
        let Measures { seam, area, stretch, energy } = measures(&file.polygons, &unwrapped);
        let of = |value: Option<f64>| value.map_or("–".to_owned(), ratio);
        let word = |is: bool| if is { "yes" } else { "NO" }.to_owned();
        table.row([
            case.name.to_owned(),
            file.polygons.triangulate().face_count().to_string(),
            unwrapped.charts.len().to_string(),
            ratio(seam),
            format!("{area:.3}"),
            format!("{stretch:.3}"),
            format!("{energy:.3}"),
            word(unwrapped.verdict.planar),
            word(unwrapped.verdict.planar_in_f32),
            ratio(seconds),
            of(case.optcuts),
            case.part_uv.map_or("–".to_owned(), |charts| charts.to_string()),
            ratio(case.uvunwrap),
            target(seam, case.seam),
            target(seconds, case.seconds),
        ]);
    }
    table.print();
}

struct Measures {
    seam: f64,
    area: f64,
    stretch: f64,
    energy: f64,
}

/// A triangle in space and in the plane.
struct Mapped {
    space: [DVec3; 3],
    plane: [DVec2; 3],
}

/// Triangles of a mesh with their texture coordinates, as the mesh's own triangulation cuts its polygons.
fn mapped(mesh: &PolygonMesh, unwrapped: &Unwrapped) -> Vec<Mapped> {
    let mut corner_at: HashMap<(u32, VertexId), usize> = HashMap::new();
    for face in 0..mesh.face_count() {
        let number = u32::try_from(face).expect("faces fit");
        for corner in mesh.corner_range(face) {
            corner_at.insert((number, mesh.corners[corner]), corner);
        }
    }
    let triangles = mesh.triangulate();
    let uv = |face: usize, vertex: VertexId| {
        let polygon = triangles.polygon(FaceId::from_index(face));
        let coordinate = unwrapped.corners[corner_at[&(polygon, vertex)]];
        unwrapped.coordinates.get(coordinate as usize).copied()
    };
    let of_face = |face: usize| {
        let corners = triangles.triangles[face];
        let [a, b, c] = corners.map(|vertex| uv(face, vertex));
        Some(Mapped { space: triangles.corners(FaceId::from_index(face)), plane: [a?, b?, c?] })
    };
    (0..triangles.face_count()).filter_map(of_face).collect()
}

fn measures(mesh: &PolygonMesh, unwrapped: &Unwrapped) -> Measures {
    let maps: Vec<[f64; 4]> = mapped(mesh, unwrapped).iter().map(numbers).collect();
    let [on_surface, in_plane] = [0, 1].map(|k| maps.iter().map(|map| map[k]).sum::<f64>());
    // Area in the plane of a unit of area on the surface.
    let scale = in_plane / on_surface;
    let mean = |of: &dyn Fn(&[f64; 4]) -> f64| {
        maps.iter().filter(|map| map[1] > 0.0).map(|map| map[0] * of(map)).sum::<f64>() / on_surface
    };
    let area = mean(&|[space, plane, ..]| {
        let ratio = plane / space / scale;
        ratio.max(ratio.recip())
    });
    let stretch = mean(&|[.., inverse]| 0.5 * inverse * scale).sqrt();
    let energy = mean(&|[_, _, direct, inverse]| direct / scale + inverse * scale);
    Measures { seam: seam(mesh, unwrapped) / on_surface.sqrt(), area, stretch, energy }
}

/// Areas of a triangle on the surface and in the plane, |J|² and |J⁻¹|² of the map between them.
fn numbers(Mapped { space, plane }: &Mapped) -> [f64; 4] {
    let [along, other] = [1, 2].map(|k| space[k] - space[0]);
    let [first, second] = [1, 2].map(|k| plane[k] - plane[0]);
    let length = along.length();
    let foot = other.dot(along) / length;
    let height = along.cross(other).length() / length;
    // Columns of J in an orthonormal frame of the triangle.
    let column = first / length;
    let columns = [column, (second - column * foot) / height];
    let direct = columns[0].length_squared() + columns[1].length_squared();
    let determinant = columns[0].perp_dot(columns[1]);
    let on_surface = 0.5 * length * height;
    if !(on_surface > 0.0 && determinant > 0.0) {
        return [on_surface, 0.0, 0.0, 0.0];
    }
    [on_surface, on_surface * determinant, direct, direct / (determinant * determinant)]
}

/// Length of the edges whose faces have different texture coordinates.
fn seam(mesh: &PolygonMesh, unwrapped: &Unwrapped) -> f64 {
    let mut edges: BTreeMap<[VertexId; 2], Vec<[u32; 2]>> = BTreeMap::new();
    for face in 0..mesh.face_count() {
        let range = mesh.corner_range(face);
        for corner in range.clone() {
            let next = if corner + 1 == range.end { range.start } else { corner + 1 };
            let ([a, b], [p, q]) = (
                [corner, next].map(|corner| mesh.corners[corner]),
                [corner, next].map(|corner| unwrapped.corners[corner]),
            );
            let (ends, uvs) = if a < b { ([a, b], [p, q]) } else { ([b, a], [q, p]) };
            edges.entry(ends).or_default().push(uvs);
        }
    }
    let is_seam = |uvs: &Vec<[u32; 2]>| uvs.iter().any(|other| *other != uvs[0]);
    let length = |[a, b]: &[VertexId; 2]| mesh.positions[a.index()].distance(mesh.positions[b.index()]);
    edges.iter().filter(|(_, uvs)| is_seam(uvs)).map(|(ends, _)| length(ends)).sum()
}
