//! Meshes that a file shows, their transforms, and the numbers of their vertices.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DAffine3, DVec4};
use serde_json::Value;

use super::accessor::{Elements, count, no_such};
use super::container::Buffers;
use super::document::{Attributes, Document, Topology};
use super::{COLOUR, NORMAL, POSITION, TANGENT};
use crate::file_data::FileData;
use crate::file_values::{CornerValues, FileValues, srgb_from_linear};
use crate::mesh_file::{Instances, ParseFaultKind, ReadError, ReadWarning, ReadWarningKind, fault_in};

/// Limit on the parts, corners and vertices shown, per byte of the buffers. At least `FEW` are always allowed.
const COPIES: u64 = 16;
const FEW: u64 = 1 << 24;

/// Contents of a file that are kept for writing it again.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scene {
    pub(super) json: Vec<u8>,
    /// Offset of each buffer in the bytes.
    pub(super) starts: Vec<usize>,
    /// Folder of the file, if it has one.
    pub(super) folder: Option<PathBuf>,
    pub(super) shown: Shown,
    /// Vertex of the mesh for each vertex of the file.
    pub(super) vertex_of: Vec<u32>,
    /// Vertex of the file at each corner of the mesh as read.
    pub(super) corners: Vec<u32>,
}

/// Shown meshes, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Shown {
    pub(super) instances: Vec<Instance>,
    /// Primitives made of triangles, ordered by instance.
    pub(super) parts: Vec<Part>,
    /// Sets of vertices, ordered by instance.
    pub(super) sets: Vec<VertexSet>,
    /// Nodes that show the mesh of an earlier instance, and share its map.
    pub(super) sharing: Vec<usize>,
    /// Nodes that an extension repeats. All copies share one map.
    pub(super) repeated: Vec<usize>,
}

/// Mesh with a transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Instance {
    /// Node of the instance; `None` if the file has no nodes.
    pub(super) node: Option<usize>,
    pub(super) mesh: usize,
    /// Transform from the mesh's space to the scene's; `None` for the identity.
    pub(super) transform: Option<DAffine3>,
}

impl Instance {
    /// True if the transform has no volume, such as a scale of 0, which hides the node.
    fn is_collapsed(&self) -> bool {
        self.transform.is_some_and(|transform| transform.matrix3.determinant() == 0.0)
    }

    /// True if the instance is a mirror image of its mesh: its triangles are reversed.
    pub(super) fn is_mirrored(&self) -> bool {
        self.transform.is_some_and(|transform| transform.matrix3.determinant() < 0.0)
    }
}

/// Primitive of an instance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    pub(super) instance: usize,
    pub(super) primitive: usize,
    pub(super) set: usize,
    /// First face of the part. Its faces end at the next part's first face.
    pub(super) first_face: usize,
}

/// Vertices of an instance that share their accessors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct VertexSet {
    pub(super) instance: usize,
    pub(super) attributes: Attributes,
    pub(super) targets: Vec<Attributes>,
    /// Numbers of its vertices among all of the file.
    pub(super) range: Range<usize>,
}

impl Scene {
    /// Data of the shown meshes that follow from texture coordinates.
    pub(crate) fn texture_data(&self) -> Vec<FileData> {
        let has_tangents = self.shown.sets.iter().any(|set| set.attributes.contains_key(TANGENT));
        has_tangents.then_some(FileData::Tangents).into_iter().collect()
    }

    /// Data of the shown meshes that files of other formats do not hold.
    pub(crate) fn data(&self) -> Vec<FileData> {
        let json: Value = serde_json::from_slice(&self.json).unwrap_or_default();
        let is_named = |instance: &Instance| {
            let of_node = instance.node.map(|node| &json["nodes"][node]["name"]);
            of_node.is_some_and(Value::is_string) || json["meshes"][instance.mesh]["name"].is_string()
        };
        let has_materials = json["materials"].as_array().is_some_and(|materials| !materials.is_empty());
        let names = self.shown.instances.iter().any(is_named).then_some(FileData::Names);
        let materials = has_materials.then_some(FileData::Materials);
        materials.into_iter().chain(names).chain(self.texture_data()).collect()
    }

    /// Normals in the scene, and colours in sRGB, at the corners of the shown triangles; `None` without any.
    pub(crate) fn corner_values(&self, bytes: &Arc<Vec<u8>>) -> (Option<FileValues>, Option<FileValues>) {
        let Ok(document) = Document::of(&self.json) else { return (None, None) };
        let buffers = Buffers { bytes: Arc::clone(bytes), starts: self.starts.clone() };
        let at_vertices = |name: &str| {
            let mut values = vec![None; self.vertex_of.len()];
            for set in &self.shown.sets {
                let elements = set.attributes.get(name).map(|&index| Elements::of(&document, &buffers, index));
                let Some(Ok(elements)) = elements else { continue };
                let place_count = set.range.len().min(elements.count);
                let number = |place: usize, at: usize| {
                    if at < elements.width { elements.number(place, at) } else { 1.0 }
                };
                for (place, value) in values[set.range.clone()].iter_mut().enumerate().take(place_count) {
                    let read = DVec4::from([0, 1, 2, 3].map(|at| number(place, at)));
                    *value = Some(if name == NORMAL { self.turned(set, read) } else { srgb_from_linear(read) });
                }
            }
            values
        };
        let at_corners = |name: &str| {
            self.shown.sets.iter().any(|set| set.attributes.contains_key(name)).then(|| {
                let values = at_vertices(name);
                FileValues::AtCorners(CornerValues {
                    starts: (0..=self.corners.len() / 3).map(|face| 3 * face).collect(),
                    vertices: self.corners.iter().map(|&corner| self.vertex_of[corner as usize]).collect(),
                    values: self.corners.iter().map(|&corner| values[corner as usize]).collect(),
                })
            })
        };
        (at_corners(NORMAL), at_corners(COLOUR))
    }

    /// Normal of a set in the scene.
    fn turned(&self, set: &VertexSet, normal: DVec4) -> DVec4 {
        let transform = self.shown.instances[set.instance].transform;
        transform.map_or(normal, |transform| (transform.matrix3.inverse().transpose() * normal.truncate()).extend(0.0))
    }

    /// Label for each face, equal for faces of one material; `None` if no primitive has a material.
    pub(crate) fn material_labels(&self, face_count: usize) -> Option<Vec<u32>> {
        let json: Value = serde_json::from_slice(&self.json).ok()?;
        let materials: Vec<Option<u64>> =
            self.shown.parts.iter().map(|part| self.material_of(&json, part).as_u64()).collect();
        let mut numbers: Vec<Option<u64>> = materials.clone();
        numbers.sort_unstable();
        numbers.dedup();
        let label = |part: usize| numbers.binary_search(&materials[part]).expect("each material is in the list");
        materials.iter().any(Option::is_some).then(|| self.labels(face_count, label))
    }

    /// Number of the material of a part in the text of the file. Null if it has none.
    pub(super) fn material_of<'a>(&self, json: &'a Value, part: &Part) -> &'a Value {
        let mesh = self.shown.instances[part.instance].mesh;
        &json["meshes"][mesh]["primitives"][part.primitive]["material"]
    }

    /// Label for each face, equal for faces of one instance, which belongs to one node.
    pub(crate) fn node_labels(&self, face_count: usize) -> Vec<u32> {
        self.labels(face_count, |part| self.shown.parts[part].instance)
    }

    /// Name of the node of each instance, or of its mesh. Empty if neither has a name.
    pub(crate) fn node_names(&self) -> Vec<String> {
        let json: Value = serde_json::from_slice(&self.json).unwrap_or_default();
        let name = |instance: &Instance| {
            let of_node = instance.node.and_then(|node| json["nodes"][node]["name"].as_str());
            let name = of_node.filter(|name| !name.is_empty()).or(json["meshes"][instance.mesh]["name"].as_str());
            name.unwrap_or_default().to_owned()
        };
        self.shown.instances.iter().map(name).collect()
    }

    fn labels(&self, face_count: usize, of_part: impl Fn(usize) -> usize) -> Vec<u32> {
        let label = |face: usize| u32::try_from(of_part(self.shown.part_of(face))).expect("fewer than 2^32 parts");
        (0..face_count).map(label).collect()
    }
}

impl Shown {
    /// Collects the shown meshes of a file.
    pub(super) fn of(document: &Document, buffers: &Buffers, instances: Instances) -> Result<Self, ReadError> {
        let mut own = Self { instances: all_instances(document)?, ..Self::default() };
        let is_repeated = |node: &usize| document.nodes[*node].is_repeated();
        own.repeated = own.instances.iter().filter_map(|instance| instance.node).filter(is_repeated).collect();
        if instances == Instances::Shared {
            own.share();
        }
        let most = (COPIES * buffers.bytes.len() as u64).max(FEW).min(u64::from(u32::MAX));
        let part_count = |instance: &Instance| document.meshes[instance.mesh].primitives.len() as u64;
        let mut shown: u64 = own.instances.iter().map(part_count).sum();
        if shown > most {
            return Err(ReadError::TooManyCopies { shown });
        }
        for (instance, Instance { mesh, .. }) in own.instances.iter().enumerate() {
            let mut set_of: BTreeMap<(&Attributes, &Vec<Attributes>), usize> = BTreeMap::new();
            for (primitive, found) in document.meshes[*mesh].primitives.iter().enumerate() {
                let (Some(topology), Some(&position)) = (found.topology(), found.attributes.get(POSITION)) else {
                    continue;
                };
                let count_of = |accessor: usize| count(document, buffers, accessor);
                let set = if let Some(&set) = set_of.get(&(&found.attributes, &found.targets)) {
                    set
                } else {
                    let begin = own.sets.last().map_or(0, |set| set.range.end);
                    let (attributes, targets) = (found.attributes.clone(), found.targets.clone());
                    let range = begin..begin + count_of(position)?;
                    own.sets.push(VertexSet { instance, attributes, targets, range });
                    set_of.insert((&found.attributes, &found.targets), own.sets.len() - 1);
                    own.sets.len() - 1
                };
                let vertices = own.sets[set].range.len();
                let listed = found.indices.map_or(Ok(vertices), count_of)?;
                shown += 3 * topology.count(listed as u64);
                if shown + own.sets[set].range.end as u64 > most {
                    return Err(ReadError::TooManyCopies { shown });
                }
                own.parts.push(Part { instance, primitive, set, first_face: 0 });
            }
        }
        Ok(own)
    }

    /// Keeps the first instance of each mesh that its node does not collapse, else the first.
    fn share(&mut self) {
        let mut kept: BTreeMap<usize, usize> = BTreeMap::new();
        for (number, instance) in self.instances.iter().enumerate() {
            let first = *kept.entry(instance.mesh).or_insert(number);
            if self.instances[first].is_collapsed() && !instance.is_collapsed() {
                kept.insert(instance.mesh, number);
            }
        }
        let Self { instances, sharing, .. } = self;
        let mut number = 0;
        instances.retain(|instance| {
            let is_kept = kept[&instance.mesh] == number;
            number += 1;
            if !is_kept {
                sharing.extend(instance.node);
            }
            is_kept
        });
    }

    /// Warnings about nodes that share a map.
    pub(super) fn warnings(&self) -> Vec<ReadWarning> {
        let of = |kind, nodes: &[usize]| {
            let warning = ReadWarning { kind, count: nodes.len(), line: None };
            (!nodes.is_empty()).then_some(warning)
        };
        let sharing = of(ReadWarningKind::SharedInstances, &self.sharing);
        sharing.into_iter().chain(of(ReadWarningKind::RepeatedNodes, &self.repeated)).collect()
    }

    /// Part that contains a face.
    pub(super) fn part_of(&self, face: usize) -> usize {
        self.parts.partition_point(|part| part.first_face <= face) - 1
    }
}

/// Meshes of the nodes of the scene, or of all nodes; all meshes if there are no nodes.
fn all_instances(document: &Document) -> Result<Vec<Instance>, ReadError> {
    let mut found = Vec::new();
    if document.nodes.is_empty() {
        found.extend((0..document.meshes.len()).map(|mesh| Instance { node: None, mesh, transform: None }));
        return Ok(found);
    }
    let roots = roots(document)?;
    let mut is_passed = vec![false; document.nodes.len()];
    let mut ahead: Vec<(usize, Option<DAffine3>)> = roots.iter().rev().map(|&root| (root, None)).collect();
    while let Some((index, of_parent)) = ahead.pop() {
        let node = document.nodes.get(index).ok_or_else(|| no_node(index, document))?;
        if std::mem::replace(&mut is_passed[index], true) {
            return Err(fault_in("node", index, ParseFaultKind::SecondParent));
        }
        let transform = match (of_parent, node.transform()) {
            (Some(outer), Some(own)) => Some(outer * own),
            (outer, own) => outer.or(own),
        };
        if let Some(mesh) = node.mesh {
            let count = document.meshes.len();
            if mesh >= count {
                return Err(fault_in("node", index, no_such("mesh", mesh, count)));
            }
            // Joints place a skinned mesh, so its node's transform is ignored.
            let transform = transform.filter(|_| !node.is_skinned());
            found.push(Instance { node: Some(index), mesh, transform });
        }
        ahead.extend(node.children.iter().rev().map(|&child| (child, transform)));
        if ahead.len() > document.nodes.len() {
            return Err(fault_in("node", index, ParseFaultKind::SecondParent));
        }
    }
    match is_passed.iter().position(|&is_passed| !is_passed) {
        Some(index) if document.scene.is_none() => Err(fault_in("node", index, ParseFaultKind::SecondParent)),
        _ => Ok(found),
    }
}

/// Roots of the scene that the file names; all nodes without a parent if it names none.
fn roots(document: &Document) -> Result<Vec<usize>, ReadError> {
    if let Some(scene) = document.scene {
        let scenes = &document.scenes;
        let of_scene =
            scenes.get(scene).ok_or_else(|| fault_in("scene", scene, no_such("scene", scene, scenes.len())))?;
        return Ok(of_scene.nodes.clone());
    }
    let mut is_root = vec![true; document.nodes.len()];
    for &child in document.nodes.iter().flat_map(|node| &node.children) {
        *is_root.get_mut(child).ok_or_else(|| no_node(child, document))? = false;
    }
    Ok((0..is_root.len()).filter(|&node| is_root[node]).collect())
}

fn no_node(index: usize, document: &Document) -> ReadError {
    fault_in("node", index, no_such("node", index, document.nodes.len()))
}

/// Triangles of a part, as vertices of its set, in the order and orientation of the scene.
pub(super) fn triangles(
    document: &Document,
    buffers: &Buffers,
    shown: &Shown,
    part: &Part,
) -> Result<Vec<[usize; 3]>, ReadError> {
    let (instance, set) = (&shown.instances[part.instance], &shown.sets[part.set]);
    let primitive = &document.meshes[instance.mesh].primitives[part.primitive];
    let topology = primitive.topology().unwrap_or(Topology::Triangles);
    let indices = match primitive.indices {
        Some(index) => {
            let elements = Elements::of(document, buffers, index)?;
            if !elements.are_indices() {
                let kind = ParseFaultKind::Unexpected { found: "numbers".to_owned(), expected: "indices" };
                return Err(fault_in("accessor", index, kind));
            }
            let vertices: Vec<usize> = (0..elements.count).map(|place| elements.index(place)).collect();
            if let Some(&wrong) = vertices.iter().find(|&&vertex| vertex >= set.range.len()) {
                return Err(fault_in("accessor", index, no_such("vertex", wrong, set.range.len())));
            }
            Some(vertices)
        }
        None => None,
    };
    let listed = indices.as_ref().map_or(set.range.len(), Vec::len);
    let count = usize::try_from(topology.count(listed as u64)).expect("fewer than there are vertices");
    let vertex = |place: usize| indices.as_ref().map_or(place, |vertices| vertices[place]);
    let is_mirrored = instance.is_mirrored();
    let all = (0..count).map(|number| {
        let [a, b, c] = topology.triangle(number).map(vertex);
        if is_mirrored { [a, c, b] } else { [a, b, c] }
    });
    // Strips and fans repeat vertices to jump from one place to another.
    let is_stitch = |[a, b, c]: &[usize; 3]| a == b || b == c || c == a;
    Ok(all.filter(|triangle| topology == Topology::Triangles || !is_stitch(triangle)).collect())
}
