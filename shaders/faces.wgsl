// What the faces of both panes have in common: checker, picture, flags, wireframe.

@group(0) @binding(1) var picture_texture: texture_2d<f32>;
@group(0) @binding(2) var picture_sampler: sampler;

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
        default: {
            return plain;
        }
    }
}

fn marked(colour: vec3<f32>, flags: u32) -> vec3<f32> {
    return select(colour, pane.flipped.rgb, (flags & FLIPPED) != 0u);
}
