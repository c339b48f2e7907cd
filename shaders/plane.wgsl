// Faces of the embedding's pane: flat. Alpha counts how many faces lie on each other; blit.wgsl shows that.

// One face's share of alpha, eight steps of a byte: 31 faces can be told apart.
const COUNT_STEP: f32 = 8.0 / 255.0;
// Distance of the hatching's lines and their width, points.
const HATCH_PERIOD: f32 = 6.0;
const HATCH_WIDTH: f32 = 2.0;
// How strongly faces outside the picture are hatched.
const OUTSIDE: f32 = 0.6;
// Depth of flipped faces, and of the others behind them.
const DEPTH_FLIPPED: f32 = 0.25;
const DEPTH_FACE: f32 = 0.5;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) weight: vec3<f32>,
    // Relative to the pane's middle, so that it keeps its digits however far one zooms in.
    @location(1) plane: vec2<f32>,
    @location(2) @interpolate(flat, either) paint: vec4<f32>,
}

@vertex
fn vs_main(
    @builtin(vertex_index) vertex_index: u32,
    @location(0) plane: vec4<f32>,
    @location(1) paint: vec4<f32>,
) -> Corner {
    var out: Corner;
    let relative = (plane.xy - pane.plane_center.xy) + (plane.zw - pane.plane_center.zw);
    let flags = u32(round(paint.a * 255.0));
    let depth = select(DEPTH_FACE, DEPTH_FLIPPED, (flags & FLIPPED) != 0u);
    out.clip = vec4<f32>(relative * pane.plane_scale.xy, depth, 1.0);
    out.weight = corner_weight(vertex_index);
    out.plane = relative;
    out.paint = paint;
    return out;
}

// Covering by lines that stand still on the screen; `along` is the sum of the pixel's coordinates for lines at 45°, their
// difference for lines the other way.
fn hatch_cover(along: f32) -> f32 {
    let period = HATCH_PERIOD * pane.right.w;
    let across = along * 0.70710678;
    let from_line = abs(fract(across / period) - 0.5) * period;
    return clamp(0.5 * HATCH_WIDTH * pane.right.w + 0.5 - from_line, 0.0, 1.0);
}

@fragment
fn fs_flat(in: Corner) -> @location(0) vec4<f32> {
    let wire = wire_cover(in.weight);
    var colour = face_colour(pane.plane_face.rgb, in.paint.rgb, in.plane);

    let flags = u32(round(in.paint.a * 255.0));
    let is_flipped = (flags & FLIPPED) != 0u;
    colour = marked(colour, flags);
    if is_flipped {
        colour = mix(colour, pane.background.rgb, 0.55 * hatch_cover(in.clip.x + in.clip.y));
    }
    let box = pane.picture_box;
    let has_picture = box.z > box.x;
    if has_picture && !is_flipped && (any(in.clip.xy < box.xy) || any(in.clip.xy > box.zw)) {
        colour = mix(colour, pane.background.rgb, OUTSIDE * hatch_cover(in.clip.x - in.clip.y));
    }
    colour = wired(colour, wire);
    // Flipped faces lie in front and speak for themselves: they are not counted.
    return vec4<f32>(colour, select(COUNT_STEP, 0.0, is_flipped));
}
