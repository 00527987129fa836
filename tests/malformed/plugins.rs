//! Dynamic libraries, weights, and what a training needs.

use crate::support::{self, Bench, seeone};
use crate::{ROBOT, refused};

#[test]
fn an_untrusted_or_damaged_library_is_refused() {
    let bench = Bench::new();
    let library = bench.arg("libmine.so");
    let plugin = |bench: &Bench| bench.run(&["--plugin", &library]);
    refused("missing", &bench, &plugin(&bench), "L001", &["libmine.so"]);
    bench.write("libmine.so", [0x7f, b'E', b'L', b'F', 0, 0]);
    refused("no manifest", &bench, &plugin(&bench), "L001", &["plugins trust"]);
    let trusted = seeone(["plugins", "trust", &library]);
    refused("no library to trust", &bench, &trusted, "L005", &["libmine.so"]);
    let manifest = |size: usize, hash: &str| {
        format!(
            "schema = 2\nabi_major = 3\nsize_bytes = {size}\nblake3 = \"{hash}\"\n\
             [[plugin]]\nname = \"mine\"\nkind = \"alignment\"\nversion = \"1\"\n"
        )
    };
    bench.write("libmine.so.toml", manifest(600, &"0".repeat(64)));
    refused("truncated", &bench, &plugin(&bench), "L003", &["600"]);
    bench.write("libmine.so.toml", manifest(6, &"0".repeat(64)));
    refused("changed", &bench, &plugin(&bench), "L004", &["plugins trust"]);
    bench.write("libmine.so.toml", "schema = ");
    refused("damaged manifest", &bench, &plugin(&bench), "L002", &["libmine.so.toml:1:"]);
}

#[test]
fn missing_or_damaged_weights_are_told() {
    let bench = Bench::new();
    let weights = bench.arg("weights");
    bench.append(ROBOT, &format!("\n[config.perception]\nweights = \"{weights}\"\n"));
    refused("no folder", &bench, &bench.run(&[]), "M002", &["perception", "card.toml"]);
    std::fs::create_dir(bench.path("weights")).expect("a folder");
    let shipped = support::root().join("plugins/nst/weights");
    std::fs::copy(shipped.join("card.toml"), bench.path("weights/card.toml")).expect("a card");
    refused("no weights", &bench, &bench.run(&[]), "M002", &["coarse.safetensors"]);
    for name in ["coarse", "refiner"] {
        let file = format!("{name}.safetensors");
        let bytes = std::fs::read(shipped.join(&file)).expect("shipped weights");
        bench.write(&format!("weights/{file}"), &bytes[..bytes.len() / 2]);
    }
    refused("truncated", &bench, &bench.run(&[]), "M002", &["coarse.safetensors"]);
    let checked = seeone(["check", &bench.arg("weights/coarse.safetensors")]);
    assert_eq!(checked.status, Some(1), "{}", checked.stderr);
    bench.write("weights/card.toml", "schema = 1\nnetwork = ");
    refused("damaged card", &bench, &bench.run(&[]), "M002", &["card.toml:2:"]);
    let robot = bench.text(ROBOT).replace("weights = ", "wieghts = ");
    bench.write(ROBOT, robot);
    refused("unknown key", &bench, &bench.run(&[]), "M002", &["wieghts"]);
}

#[test]
fn what_a_training_lacks_is_told() {
    let bench = Bench::new();
    let (data, out) = (bench.arg("none"), bench.arg("weights"));
    for (network, code) in [("nst", "D001"), ("nse", "W001")] {
        let call = seeone(["train", network, "--data", &data, "--out", &out]);
        refused(network, &bench, &call, code, &[&bench.arg("")]);
    }
    let call = seeone(["data", "--objects", "nonsense", "--out", &bench.arg("out")]);
    refused("objects", &bench, &call, "O001", &["nonsense"]);
}
