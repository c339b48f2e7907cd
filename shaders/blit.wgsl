// Puts a pane's finished picture into its rectangle of the window.

@group(0) @binding(1) var picture: texture_2d<f32>;

// Shares of the overlap colour where two faces lie on each other, and at most.
const OVERLAP_STEP: f32 = 0.45;
const OVERLAP_MOST: f32 = 0.75;
// Steps of alpha per byte, as `COUNT_STEP` of plane.wgsl.
const COUNTS_PER_ALPHA: f32 = 255.0 / 8.0;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) place: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex_index: u32) -> Corner {
    let corner = vec2<f32>(f32(vertex_index & 1u), f32(vertex_index >> 1u));
    var out: Corner;
    out.clip = vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
    out.place = vec2<f32>(corner.x * 2.0, 1.0 - corner.y * 2.0);
    return out;
}

fn finished(place: vec2<f32>) -> vec3<f32> {
    let size = vec2<i32>(textureDimensions(picture));
    let pixel = clamp(vec2<i32>(floor(place * vec2<f32>(size))), vec2<i32>(0), size - 1);
    let value = textureLoad(picture, pixel, 0);
    let extra = max(value.a * COUNTS_PER_ALPHA - 1.0, 0.0);
    return mix(value.rgb, pane.overlap.rgb, min(extra * OVERLAP_STEP, OVERLAP_MOST) * pane.overlap.a);
}

// For a window that stores bytes as they are shown, which is what egui prefers.
@fragment
fn fs_gamma(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(srgb_from_linear(finished(in.place)), 1.0);
}

// For a window that encodes on writing.
@fragment
fn fs_linear(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(finished(in.place), 1.0);
}
