//! Writes the tests' synthetic set, to measure speed on: `synthetic_set FOLDER OBJECTS DROPS`.

#[path = "../tests/synthetic/mod.rs"]
mod synthetic;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, objects, drops] = arguments.as_slice() else {
        return Err("usage: synthetic_set FOLDER OBJECTS DROPS".into());
    };
    std::fs::create_dir_all(folder)?;
    synthetic::write(folder.as_ref(), objects.parse()?, drops.parse()?);
    Ok(())
}
