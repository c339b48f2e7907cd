// Shared by all pane shaders; joined in front of each by src/render/pipelines.rs.
// Colours are linear light with straight alpha; none stands in a shader.

// Matches `PaneUniforms` of src/render/uniforms.rs.
struct Pane {
    clip_from_unit: mat4x4<f32>,
    // Axes of the eye in unit space: right, up, backwards. The fourth: pixels per point, nothing, nothing.
    right: vec4<f32>,
    up: vec4<f32>,
    back: vec4<f32>,
    // The eye in unit space.
    eye: vec4<f32>,
    // The pane's middle in unit space: high parts, low parts.
    plane_center: vec4<f32>,
    // Clip units per unit of unit space (2), size of the pane in pixels (2).
    plane_scale: vec4<f32>,
    // Checks per unit, offset of the origin in checks (2), nothing.
    checker: vec4<f32>,
    // Scale (2) and offset (2) from unit space to the picture, (0, 0) its upper left corner.
    picture: vec4<f32>,
    // Cells per pixel, offset of the pane's middle in cells (2), cells per stronger line.
    grid: vec4<f32>,
    // Left, top, right, bottom of the unit square in pixels.
    unit_square: vec4<f32>,
    // Left, top, right, bottom of the picture in pixels.
    picture_box: vec4<f32>,
    // Opacity of the faint grid lines; of the picture; half the width of the wire in pixels; nothing.
    strength: vec4<f32>,
    // Shading, flat normals (0 or 1), nothing, nothing.
    choice: vec4<u32>,
    background: vec4<f32>,
    grid_colour: vec4<f32>,
    unit_square_colour: vec4<f32>,
    clay: vec4<f32>,
    clay_back: vec4<f32>,
    plane_face: vec4<f32>,
    overlap: vec4<f32>,
    checker_light: vec4<f32>,
    checker_dark: vec4<f32>,
    // The wire over bright colours; over dark colours of a checker or a picture.
    wire: vec4<f32>,
    wire_light: vec4<f32>,
    flipped: vec4<f32>,
}

@group(0) @binding(0) var<uniform> pane: Pane;

// Values of `Pane.choice.x`, as `Shading` in src/render/frame.rs.
const SHADING_PLAIN: u32 = 0u;
const SHADING_CHECKER: u32 = 1u;
const SHADING_PAINT: u32 = 2u;
const SHADING_PICTURE: u32 = 3u;
const SHADING_PATTERN: u32 = 4u;

// Bit of a face, as in `FacePaint` of src/view/draw.rs.
const FLIPPED: u32 = 1u;
const FAINT: u32 = 2u;

fn linear_from_srgb(c: vec3<f32>) -> vec3<f32> {
    let low = c / 12.92;
    let high = pow((c + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, low, c <= vec3<f32>(0.04045));
}

fn srgb_from_linear(c: vec3<f32>) -> vec3<f32> {
    let low = c * 12.92;
    let high = 1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, low, c <= vec3<f32>(0.0031308));
}
