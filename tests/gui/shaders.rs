//! Validation of the shaders without a GPU.

use eframe::wgpu::naga;
use freebound::render::{SHADERS, ShaderFile};
use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

fn validated(shader: ShaderFile) -> (naga::Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(shader.source)
        .unwrap_or_else(|error| panic!("{}: {}", shader.name, error.emit_to_string(shader.source)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}: {error:?}", shader.name));
    (module, info)
}

#[test]
fn every_shader_is_valid_without_optional_capabilities() {
    for shader in SHADERS {
        let (module, _) = validated(shader);
        assert!(module.entry_points.len() >= 2, "{} has a vertex and a fragment stage", shader.name);
    }
}

#[test]
fn every_shader_translates_to_gles_3() {
    for shader in SHADERS {
        let (module, info) = validated(shader);
        for entry in &module.entry_points {
            let options = glsl::Options {
                version: glsl::Version::Embedded { version: 300, is_webgl: false },
                ..Default::default()
            };
            let pipeline =
                glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone(), multiview: None };
            let mut text = String::new();
            glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, BoundsCheckPolicies::default())
                .and_then(|mut writer| writer.write())
                .unwrap_or_else(|error| panic!("{} {}: {error}", shader.name, entry.name));
        }
    }
}
