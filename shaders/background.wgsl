// Behind the embedding: the grid, the picture and the unit square.

@group(0) @binding(1) var picture_texture: texture_2d<f32>;
@group(0) @binding(2) var picture_sampler: sampler;

@vertex
fn vs_main(@builtin(vertex_index) vertex_index: u32) -> @builtin(position) vec4<f32> {
    // One triangle that covers the pane.
    let corner = vec2<f32>(f32(vertex_index & 1u), f32(vertex_index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.9, 1.0);
}

// Covering by a line of a width in pixels at a distance in pixels.
fn line_cover(distance: f32, width: f32) -> f32 {
    return clamp(0.5 * width + 0.5 - abs(distance), 0.0, 1.0) * min(width, 1.0);
}

// Covering by grid lines at the multiples of `period` cells.
fn grid_cover(cells: vec2<f32>, period: f32, cells_per_pixel: f32) -> f32 {
    let from_line = abs(fract(cells / period + 0.5) - 0.5) * period / cells_per_pixel;
    return line_cover(min(from_line.x, from_line.y), 1.0);
}

@fragment
fn fs_background(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    let from_middle = (pixel.xy - 0.5 * pane.plane_scale.zw) * vec2<f32>(1.0, -1.0);
    let cells = from_middle * pane.grid.x + pane.grid.yz;
    let minor = grid_cover(cells, 1.0, pane.grid.x) * pane.strength.x;
    let major = grid_cover(cells, pane.grid.w, pane.grid.x);

    let size = pane.picture_box.zw - pane.picture_box.xy;
    let place = (pixel.xy - pane.picture_box.xy) / max(size, vec2<f32>(1e-6));
    let inside = all(place >= vec2<f32>(0.0)) && all(place <= vec2<f32>(1.0));
    let per_pixel = 1.0 / max(size, vec2<f32>(1e-6));
    let across = vec2<f32>(per_pixel.x, 0.0);
    let down = vec2<f32>(0.0, per_pixel.y);
    let picture = textureSampleGrad(picture_texture, picture_sampler, place, across, down);
    let picture_cover = select(0.0, picture.a * pane.strength.y, inside);

    var colour = mix(pane.background.rgb, pane.grid_colour.rgb, max(minor * 0.45, major) * pane.grid_colour.a);
    colour = mix(colour, picture.rgb, picture_cover);

    // Distance to the outline of the unit square.
    let square = pane.unit_square;
    let middle = 0.5 * (square.xy + square.zw);
    let outside = abs(pixel.xy - middle) - 0.5 * (square.zw - square.xy);
    let distance = length(max(outside, vec2<f32>(0.0))) + min(max(outside.x, outside.y), 0.0);
    let outline = line_cover(distance, 1.25 * pane.right.w);
    colour = mix(colour, pane.unit_square_colour.rgb, outline * pane.unit_square_colour.a);
    return vec4<f32>(colour, 0.0);
}
