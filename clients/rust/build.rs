//! Generates the messages of the API, and which request belongs to which call.

use std::error::Error;
use std::fmt::Write;

use prost_build::{Config, Service, ServiceGenerator};

const FILES: [&str; 9] = ["access", "command", "control", "device", "event", "mill", "position", "settings", "stage"];

fn main() -> Result<(), Box<dyn Error>> {
    let files = FILES.map(|name| format!("proto/axisgate/v1/{name}.proto"));
    Config::new().disable_comments(["."]).service_generator(Box::new(Calls)).compile_protos(&files, &["proto"])?;
    println!("cargo:rerun-if-changed=proto/axisgate/v1");
    Ok(())
}

/// Calls writes `impl Call` for the request of each call.
struct Calls;

impl ServiceGenerator for Calls {
    fn generate(&mut self, service: Service, code: &mut String) {
        for method in &service.methods {
            let (request, answer) = (&method.input_type, &method.output_type);
            let path = format!("/{}.{}/{}", service.package, service.proto_name, method.proto_name);
            writeln!(
                code,
                "impl super::Call for {request} {{ type Answer = {answer}; const PATH: &'static str = {path:?}; }}"
            )
            .expect("a String takes all text");
        }
    }
}
