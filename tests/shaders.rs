//! Every shader is valid, and its structs have the same memory layout as those in Rust. Needs no GPU.

use gnomon::gpu::layout::{self, StructLayout};
use gnomon::gpu::shaders;
use std::path::Path;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::naga::{Module, TypeInner, front::wgsl};

/// A shader's module, or its error with the line.
fn validated(name: &str, source: &str) -> Result<Module, String> {
    let module = wgsl::parse_str(source).map_err(|error| error.emit_to_string_with_path(source, name))?;
    Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(&module)
        .map_err(|error| error.emit_to_string_with_path(source, name))?;
    Ok(module)
}

/// A struct's size and its members' offsets, as the shader has them; none where it has no such struct.
fn in_shader(module: &Module, name: &str) -> Option<(usize, Vec<(String, usize)>)> {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name))?.1;
    let TypeInner::Struct { members, span } = &found.inner else { return None };
    let member = |member: &wgpu::naga::StructMember| (member.name.clone().unwrap_or_default(), member.offset as usize);
    Some((*span as usize, members.iter().map(member).collect()))
}

/// How a struct of the shader differs from Rust's, where it has one of that name.
fn difference(shader: &str, module: &Module, rust: &StructLayout) -> Option<String> {
    let wgsl = in_shader(module, rust.name)?;
    let rust_has = (rust.size, rust.fields.iter().map(|(name, offset)| (name.to_string(), *offset)).collect());
    (wgsl != rust_has).then(|| format!("{shader}: {}: the shader has {wgsl:?}, Rust has {rust_has:?}", rust.name))
}

#[test]
fn all_shaders_are_valid() {
    assert!(!shaders::ALL.is_empty(), "no shader was checked");
    let failures: Vec<_> = shaders::ALL.iter().filter_map(|(name, source)| validated(name, source).err()).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_shader_file_is_in_the_list() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut files = 0;
    for folder in [folder.clone(), folder.join("common")] {
        for entry in std::fs::read_dir(folder).expect("a folder of shaders") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|is| is == "wgsl") {
                let text = std::fs::read_to_string(&path).expect("text");
                let is_listed = shaders::ALL.iter().any(|(_, source)| source.contains(text.trim()));
                assert!(is_listed, "{} is in no shader of gpu::shaders::ALL", path.display());
                files += 1;
            }
        }
    }
    assert!(files > 0, "no shader file was found");
}

#[test]
fn structs_lie_as_in_rust() {
    assert!(!layout::ALL.is_empty(), "no layout was compared");
    let valid = |(name, source): &(&'static str, &str)| Some((*name, validated(name, source).ok()?));
    let modules: Vec<_> = shaders::ALL.iter().filter_map(valid).collect();
    let mut failures = Vec::new();
    for rust in layout::ALL {
        if !modules.iter().any(|(_, module)| in_shader(module, rust.name).is_some()) {
            failures.push(format!("{}: no shader has it", rust.name));
        }
        failures.extend(modules.iter().filter_map(|(name, module)| difference(name, module, rust)));
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_broken_shader_and_a_moved_field_are_found() {
    let broken = "@fragment fn paint() -> @location(0) vec4f { return 1.0; }";
    assert!(validated("broken", broken).is_err());

    let source = "struct Sun { to_sun: vec3f, share: f32 }\n@group(0) @binding(0) var<uniform> sun: Sun;";
    let module = validated("made up", source).expect("a valid shader");
    let sun = |size, fields| StructLayout { name: "Sun", size, fields };
    assert_eq!(difference("made up", &module, &sun(16, &[("to_sun", 0), ("share", 12)])), None);
    for wrong in [
        sun(16, &[("to_sun", 0), ("share", 8)]),
        sun(16, &[("share", 0), ("to_sun", 12)]),
        sun(16, &[("to_sun", 0)]),
        sun(32, &[("to_sun", 0), ("share", 12)]),
    ] {
        assert!(difference("made up", &module, &wrong).is_some());
    }
}
