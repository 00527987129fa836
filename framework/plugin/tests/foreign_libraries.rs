//! Real libraries that are no plugins: each is told apart by a diagnostic, none ends the
//! host.

use seeone_plugin::abi::{Library, Manifest};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Compiles `source` to a dynamic library in its own folder.
fn compiled(source: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, path) = (folder.path().join("foreign.rs"), folder.path().join("libforeign.so"));
    fs::write(&code, source).expect("written");
    let status = Command::new(option_env!("RUSTC").unwrap_or("rustc"))
        .args(["--edition", "2024", "--crate-type", "cdylib", "-o"])
        .args([&path, &code])
        .status();
    assert!(status.is_ok_and(|s| s.success()), "the library could not be compiled");
    (folder, path)
}

/// Why a library is not trusted, nor opened with a manifest that fits its bytes.
fn refusal(source: &str) -> String {
    let (_folder, path) = compiled(source);
    let untrusted = Manifest::write_for(&path).expect_err("no plugin").to_string();
    let bytes = fs::read(&path).expect("there");
    let manifest = format!(
        "schema = 2\nabi_major = 3\nsize_bytes = {}\nblake3 = \"{}\"\n\
         [[plugin]]\nname = \"foreign\"\nkind = \"alignment\"\nversion = \"1\"\n",
        bytes.len(),
        blake3::hash(&bytes)
    );
    fs::write(Manifest::path_for(&path), manifest).expect("written");
    let refused = Library::open(&path).expect_err("no plugin").to_string();
    assert_eq!(untrusted, refused);
    refused
}

#[test]
fn a_library_without_the_entry_is_told() {
    let told = refusal("");
    assert!(told.starts_with("error[L006]") && told.contains("seeone_plugin"), "{told}");
}

#[test]
fn a_table_of_something_else_is_told() {
    let told = refusal(
        "#[unsafe(no_mangle)] pub extern \"C\" fn seeone_plugin(_: u32) -> *const u64 {
            static TABLE: [u64; 16] = [7; 16]; TABLE.as_ptr() }",
    );
    assert!(told.starts_with("error[L007]") && told.contains("does not begin"), "{told}");
}

#[test]
fn no_table_is_told() {
    let told = refusal(
        "#[unsafe(no_mangle)] pub extern \"C\" fn seeone_plugin(_: u32) -> *const u64 {
            std::ptr::null() }",
    );
    assert!(told.starts_with("error[L007]") && told.contains("no table"), "{told}");
}
