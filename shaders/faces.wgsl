// What the faces of both panes have in common: checker, picture, flags, wireframe.

@group(0) @binding(1) var picture_texture: texture_2d<f32>;
@group(0) @binding(2) var picture_sampler: sampler;
// A tile of eight by eight checks, repeated over the plane.
@group(0) @binding(3) var pattern_texture: texture_2d<f32>;
@group(0) @binding(4) var pattern_sampler: sampler;

// Checks along the side of a tile.
const CHECKS_PER_TILE: f32 = 8.0;
// Luminance on which black and white have the same contrast: sqrt(1.05 * 0.05) - 0.05 (WCAG 2.2).
const EVEN_LUMINANCE: f32 = 0.179;

// Corner k of each face has weight 1 at k: the corner's number is the running number of the vertex modulo 3.
fn corner_weight(vertex_index: u32) -> vec3<f32> {
    let k = vertex_index % 3u;
    return vec3<f32>(f32(k == 0u), f32(k == 1u), f32(k == 2u));
}

// A triangle wave's antiderivative: the mean of a square wave over a pixel is a difference of two of these.
fn wave_integral(x: vec2<f32>) -> vec2<f32> {
    return abs(fract(x * 0.5) - 0.5) * 2.0;
}

// 0 and 1 in turn, each check averaged over the pixel's box (I. Quilez, "box-filtered checkers").
fn checker(place: vec2<f32>, width: vec2<f32>) -> f32 {
    let w = max(width, vec2<f32>(1e-6));
    let mean = (wave_integral(place + 0.5 * w) - wave_integral(place - 0.5 * w)) / w;
    // Checks much smaller than a pixel become their mean, not noise.
    let fade = clamp(2.0 - max(w.x, w.y), 0.0, 1.0);
    return 0.5 - 0.5 * mean.x * mean.y * fade;
}

// Covering of this pixel by the wireframe: lines of the same width in pixels, whatever the face's size.
fn wire_cover(weight: vec3<f32>) -> f32 {
    if pane.wire.a <= 0.0 {
        return 0.0;
    }
    let per_pixel = max(fwidth(weight), vec3<f32>(1e-9));
    let distance = weight / per_pixel;
    let nearest = min(distance.x, min(distance.y, distance.z));
    let cover = clamp(pane.strength.z + 0.5 - nearest, 0.0, 1.0);
    // Faces of few pixels would drown in their edges: the wire fades there.
    let height = 1.0 / max(per_pixel.x, max(per_pixel.y, per_pixel.z));
    return cover * mix(0.15, 1.0, smoothstep(2.0, 9.0, height));
}

// The surface's own colour by the chosen shading. The branches are the same for all pixels, so derivatives are allowed
// in them.
fn face_colour(plain: vec3<f32>, paint: vec3<f32>, plane: vec2<f32>) -> vec3<f32> {
    switch pane.choice.x {
        case SHADING_CHECKER: {
            let checks = plane * pane.checker.x + pane.checker.yz;
            let share = checker(checks, fwidth(checks));
            return mix(pane.checker_light.rgb, pane.checker_dark.rgb, share);
        }
        case SHADING_PAINT: {
            return linear_from_srgb(paint);
        }
        case SHADING_PICTURE: {
            let place = plane * pane.picture.xy + pane.picture.zw;
            let picture = textureSample(picture_texture, picture_sampler, place);
            return mix(plain, picture.rgb, picture.a);
        }
        case SHADING_PATTERN: {
            let checks = (plane * pane.checker.x + pane.checker.yz) / CHECKS_PER_TILE;
            let pattern = textureSample(pattern_texture, pattern_sampler, vec2<f32>(checks.x, -checks.y));
            return mix(plain, pattern.rgb, pattern.a);
        }
        default: {
            return plain;
        }
    }
}

// The wire over a colour. Over the many colours of a checker or a picture it is opaque, and dark or light by the colour
// below, so that it stands out from each.
fn wired(colour: vec3<f32>, cover: f32) -> vec3<f32> {
    let shading = pane.choice.x;
    let is_over_many = shading == SHADING_CHECKER || shading == SHADING_PATTERN || shading == SHADING_PICTURE;
    if !is_over_many {
        return mix(colour, pane.wire.rgb, cover * pane.wire.a);
    }
    let is_bright = dot(colour, vec3<f32>(0.2126, 0.7152, 0.0722)) > EVEN_LUMINANCE;
    return mix(colour, select(pane.wire_light.rgb, pane.wire.rgb, is_bright), cover);
}

fn marked(colour: vec3<f32>, flags: u32) -> vec3<f32> {
    return select(colour, pane.flipped.rgb, (flags & FLIPPED) != 0u);
}
