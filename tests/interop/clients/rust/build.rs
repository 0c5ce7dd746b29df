//! Generates the Rust code of the services, and gives the program the version of tonic that it was built with.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

const FILES: [&str; 7] = ["access", "command", "control", "device", "event", "mill", "stage"];

// Debian has these files in another package than protoc. The crate prost-types has the Rust types.
const WELL_KNOWN: [(&str, &str); 3] = [
    ("any", "message Any { string type_url = 1; bytes value = 2; }"),
    ("duration", "message Duration { int64 seconds = 1; int32 nanos = 2; }"),
    ("timestamp", "message Timestamp { int64 seconds = 1; int32 nanos = 2; }"),
];

fn main() -> Result<(), Box<dyn Error>> {
    let well_known = Path::new(&env::var("OUT_DIR")?).join("well-known");
    fs::create_dir_all(well_known.join("google/protobuf"))?;
    for (name, message) in WELL_KNOWN {
        let text = format!("syntax = \"proto3\"; package google.protobuf; {message}\n");
        fs::write(well_known.join(format!("google/protobuf/{name}.proto")), text)?;
    }
    let files: Vec<_> = FILES.iter().map(|name| format!("proto/axisgate/v1/{name}.proto").into()).collect();
    tonic_prost_build::configure()
        .build_server(false)
        .build_transport(false)
        .disable_comments(["."])
        .compile_protos(&files, &["proto".into(), well_known])?;
    println!("cargo:rerun-if-changed=proto");
    println!("cargo:rerun-if-changed=Cargo.lock");
    println!("cargo:rustc-env=TONIC_VERSION={}", locked_version(&fs::read_to_string("Cargo.lock")?, "tonic")?);
    Ok(())
}

/// Returns the version of a package in a Cargo.lock: the line after its name.
fn locked_version<'a>(lock: &'a str, package: &str) -> Result<&'a str, String> {
    let name = format!("name = \"{package}\"");
    let line = lock.lines().skip_while(|line| *line != name).nth(1).ok_or("Cargo.lock does not name the package")?;
    Ok(line.trim_start_matches("version = ").trim_matches('"'))
}
