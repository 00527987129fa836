//! The header for C is what the tables say, and a plugin written in C against it conforms.

use cbindgen::{Builder, Config, EnumConfig, Language, RenameRule};
use seeone_plugin::abi::{Library, Manifest};
use seeone_plugin::{Setup, conformance};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Set to write the header instead of comparing it.
const WRITE: &str = "SEEONE_WRITE_HEADER";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

/// What a message is, as `methods.rs` says.
fn messages() -> String {
    let text = fs::read_to_string(root().join("src/abi/methods.rs")).expect("the methods");
    let lines = text.lines().map_while(|line| line.strip_prefix("//!"));
    lines
        .map(|line| format!("  {line}").trim_end().to_owned())
        .collect::<Vec<_>>()
        .join("\n")
        .trim_end()
        .to_owned()
}

/// The header as it must be.
fn generated() -> String {
    let mut config = Config {
        language: Language::C,
        include_guard: Some("SEEONE_PLUGIN_H".into()),
        documentation: true,
        usize_is_size_t: true,
        cpp_compat: true,
        header: Some(format!(
            "/* The C ABI of seeone's plugins. Generated from framework/plugin/src/abi; to write it\n   \
             anew: {WRITE}=1 cargo test --release -p seeone-plugin --test c_header\n\n{} */",
            messages()
        )),
        trailer: Some(
            "/* The one symbol that a library exports: its table of this index, from zero; NULL\n   \
             beyond the last. */\n\
             #ifdef __cplusplus\nextern \"C\"\n#endif\n\
             const struct SeeoneHeader *seeone_plugin(uint32_t index);"
                .into(),
        ),
        enumeration: EnumConfig {
            prefix_with_name: true,
            rename_variants: RenameRule::None,
            ..EnumConfig::default()
        },
        ..Config::default()
    };
    for name in ["Span", "Status", "Answer", "Call", "Service", "Header", "Table", "Entry"] {
        config.export.rename.insert(name.into(), format!("Seeone{name}"));
    }
    for name in ["Message", "Method"] {
        config.export.rename.insert(name.into(), format!("Seeone{name}"));
    }
    for name in ["MAGIC", "ABI_MAJOR", "ABI_MINOR"] {
        config.export.rename.insert(name.into(), format!("SEEONE_{name}"));
    }
    for kind in [
        "ALIGNMENT",
        "CAMERA",
        "PERCEPTION",
        "ENCODING",
        "TRANSFER",
        "KINEMATICS",
        "MOTION",
        "ROBOT",
    ] {
        config.export.rename.insert(format!("KIND_{kind}"), format!("SEEONE_KIND_{kind}"));
    }
    config.export.include = vec!["Table".into(), "Method".into(), "Entry".into()];
    let source = |name: &str| root().join("src/abi").join(name);
    let bindings = Builder::new()
        .with_config(config)
        .with_src(source("message.rs"))
        .with_src(source("methods.rs"))
        .with_src(source("table.rs"))
        .generate()
        .expect("a header");
    let mut text = Vec::new();
    bindings.write(&mut text);
    // Instances of a generic structure are not renamed by the generator.
    String::from_utf8(text).expect("UTF-8").replace("Span_", "SeeoneSpan_")
}

#[test]
fn the_header_is_what_the_tables_say() {
    let path = root().join("include/seeone_plugin.h");
    if std::env::var_os(WRITE).is_some() {
        fs::write(&path, generated()).expect("written");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == generated(), "the header has drifted; write it anew with {WRITE}=1");
}

#[test]
fn an_alignment_written_in_c_conforms() {
    let folder = tempfile::tempdir().expect("a folder");
    let library = folder.path().join("libhorn.so");
    let compiled = Command::new("cc")
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC"])
        .args(["-I", &root().join("include").display().to_string(), "-o"])
        .args([&library, &root().join("tests/c/horn.c")])
        .arg("-lm")
        .status();
    assert!(compiled.is_ok_and(|status| status.success()), "the plugin does not compile");
    Manifest::write_for(&library).expect("a sound library");
    let library = Library::open(&library).expect("trusted");
    assert_eq!(library.offers()[0].id.to_string(), "alignment \"horn-c\" 1");
    let config = toml::Table::new();
    let setup = Setup { config: &config, root: Path::new("."), seed: 0, world: None, robot: None };
    for patience in [None, Some(Duration::from_secs(60))] {
        let plugin = library.offers()[0].build(&setup, patience).expect("built");
        conformance::alignment(&plugin).expect("conforms");
    }
}
