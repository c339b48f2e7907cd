// Lines of the same width in pixels, with round ends: boundary, crossings, outlines of flipped faces; and faces filled
// with one colour beside the mesh's.

// Matches `LineUniforms` of src/render/uniforms.rs.
struct Line {
    colour: vec4<f32>,
    // Half the width in pixels; share of the distance by which the line comes nearer to the eye; nothing; nothing.
    shape: vec4<f32>,
}

@group(1) @binding(0) var<uniform> line: Line;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    // Along and across, pixels from the line's begin.
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat, either) length: f32,
}

// Corners of the two triangles of a quad, 0 1 2 and 3 2 1 of (0,0) (1,0) (0,1) (1,1): x along, y across.
fn quad_corner(vertex_index: u32) -> vec2<f32> {
    let number = select(vertex_index, 6u - vertex_index, vertex_index > 2u);
    return vec2<f32>(f32(number & 1u), f32(number >> 1u));
}

// A quad around the segment between two points of clip space with w > 0.
fn quad(vertex_index: u32, a: vec4<f32>, b: vec4<f32>) -> Corner {
    let half_pane = 0.5 * pane.plane_scale.zw;
    let start = a.xy / a.w * half_pane;
    let stop = b.xy / b.w * half_pane;
    let span = stop - start;
    let long = length(span);
    let along = select(vec2<f32>(1.0, 0.0), span / max(long, 1e-20), long > 1e-6);
    let across = vec2<f32>(-along.y, along.x);
    // One pixel more, for the soft edge.
    let reach = line.shape.x + 1.0;
    let corner = quad_corner(vertex_index);
    let along_by = mix(-reach, reach, corner.x);
    let across_by = mix(-reach, reach, corner.y);
    let end = select(a, b, corner.x > 0.5);
    let moved = (along * along_by + across * across_by) / half_pane * end.w;
    var out: Corner;
    out.clip = vec4<f32>(end.xy + moved, end.zw);
    out.place = vec2<f32>(along_by + corner.x * long, across_by);
    out.length = long;
    return out;
}

// Towards the eye, so that the surface that the line lies on does not hide it.
fn lifted(position: vec3<f32>) -> vec4<f32> {
    return pane.clip_from_unit * vec4<f32>(mix(position, pane.eye.xyz, line.shape.y), 1.0);
}

@vertex
fn vs_mesh(
    @builtin(vertex_index) vertex_index: u32,
    @location(0) begin: vec3<f32>,
    @location(1) end: vec3<f32>,
) -> Corner {
    var a = lifted(begin);
    var b = lifted(end);
    // Cut at the near plane: behind the eye there is no place on the screen.
    if a.z < 0.0 && b.z > 0.0 {
        a = mix(a, b, a.z / (a.z - b.z));
    } else if b.z < 0.0 && a.z > 0.0 {
        b = mix(b, a, b.z / (b.z - a.z));
    } else if a.z < 0.0 {
        // Wholly before the near plane: outside the clip volume.
        a = vec4<f32>(0.0, 0.0, -1.0, 1.0);
        b = a;
    }
    return quad(vertex_index, a, b);
}

@vertex
fn vs_plane(
    @builtin(vertex_index) vertex_index: u32,
    @location(0) begin: vec4<f32>,
    @location(1) end: vec4<f32>,
) -> Corner {
    let a = ((begin.xy - pane.plane_center.xy) + (begin.zw - pane.plane_center.zw)) * pane.plane_scale.xy;
    let b = ((end.xy - pane.plane_center.xy) + (end.zw - pane.plane_center.zw)) * pane.plane_scale.xy;
    return quad(vertex_index, vec4<f32>(a, 0.1, 1.0), vec4<f32>(b, 0.1, 1.0));
}

// Behind the faces of plane.wgsl.
const DEPTH_FILL: f32 = 0.75;

@vertex
fn vs_fill(@location(0) point: vec4<f32>) -> @builtin(position) vec4<f32> {
    let relative = (point.xy - pane.plane_center.xy) + (point.zw - pane.plane_center.zw);
    return vec4<f32>(relative * pane.plane_scale.xy, DEPTH_FILL, 1.0);
}

@fragment
fn fs_fill() -> @location(0) vec4<f32> {
    return line.colour;
}

@fragment
fn fs_line(in: Corner) -> @location(0) vec4<f32> {
    let beyond = max(max(-in.place.x, in.place.x - in.length), 0.0);
    let distance = length(vec2<f32>(beyond, in.place.y));
    // A line thinner than a pixel is a fainter line of one pixel.
    let width = line.shape.x;
    let cover = clamp(max(width, 0.5) + 0.5 - distance, 0.0, 1.0) * min(2.0 * width, 1.0);
    return vec4<f32>(line.colour.rgb, line.colour.a * cover);
}
