// Faces of the 3D pane: lit clay, both sides.

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) weight: vec3<f32>,
    @location(3) plane: vec2<f32>,
    @location(4) @interpolate(flat, either) paint: vec4<f32>,
}

@vertex
fn vs_main(
    @builtin(vertex_index) vertex_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec4<f32>,
    @location(2) plane: vec4<f32>,
    @location(3) paint: vec4<f32>,
) -> Corner {
    var out: Corner;
    out.clip = pane.clip_from_unit * vec4<f32>(position, 1.0);
    out.position = position;
    out.normal = normal.xyz;
    out.weight = corner_weight(vertex_index);
    out.plane = plane.xy + plane.zw;
    out.paint = paint;
    return out;
}

// Light from above the viewer's left shoulder, a weaker one from below right, sky and ground, and a rim.
fn lit(albedo: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, relief: f32) -> vec3<f32> {
    let key = normalize(-0.45 * pane.right.xyz + 0.55 * pane.up.xyz + 0.75 * pane.back.xyz);
    let fill = normalize(0.80 * pane.right.xyz - 0.15 * pane.up.xyz + 0.40 * pane.back.xyz);
    let key_light = max(dot(normal, key), 0.0);
    let fill_light = max(dot(normal, fill), 0.0);
    let sky = 0.5 + 0.5 * dot(normal, pane.up.xyz);
    let light = 0.10 + 0.20 * sky + 0.88 * key_light + 0.16 * fill_light;
    let facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    let halfway = normalize(key + to_eye);
    let gloss = 0.055 * pow(max(dot(normal, halfway), 0.0), 28.0);
    let rim = 0.07 * pow(1.0 - facing, 3.0) * sky;
    // Colours that carry numbers keep closer to their legend.
    return albedo * mix(1.0, light, relief) + vec3<f32>((gloss + rim) * relief);
}

@fragment
fn fs_shaded(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    // Derivatives come first: they need every pixel of a block of four.
    let across = dpdx(in.position);
    let down = dpdy(in.position);
    let wire = wire_cover(in.weight);
    let plain = select(pane.clay_back.rgb, pane.clay.rgb, front);
    var albedo = face_colour(plain, in.paint.rgb, in.plane);

    let to_eye = normalize(pane.eye.xyz - in.position);
    // Of a face seen from either side, the normal that looks at the eye.
    let face_normal = cross(down, across);
    let flat_normal = select(-face_normal, face_normal, dot(face_normal, to_eye) > 0.0);
    let smooth_normal = select(-in.normal, in.normal, front);
    let wants_flat = pane.choice.y == 1u || dot(in.normal, in.normal) < 0.1;
    var normal = select(smooth_normal, flat_normal, wants_flat);
    let length_squared = dot(normal, normal);
    normal = select(to_eye, normal * inverseSqrt(length_squared), length_squared > 0.0);

    let flags = u32(round(in.paint.a * 255.0));
    // The back is told from the front in every shading.
    albedo = select(albedo * 0.72, albedo, front || pane.choice.x == SHADING_PLAIN);
    albedo = marked(albedo, flags);
    // What is not worked on stands back, plain in every shading.
    let is_faint = (flags & FAINT) != 0u;
    albedo = select(albedo, mix(plain, pane.background.rgb, 0.6), is_faint);
    let relief = select(0.6, 1.0, pane.choice.x == SHADING_PLAIN || pane.choice.x == SHADING_CHECKER || pane.choice.x == SHADING_PATTERN);
    let shaded = lit(albedo, normal, to_eye, relief);
    return vec4<f32>(wired(shaded, select(wire, 0.3 * wire, is_faint)), 1.0);
}
