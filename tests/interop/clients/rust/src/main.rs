//! client ROW TARGET: calls an Axisgate daemon with tonic as `../../README.md` says, and checks the answers.

mod gateway;
mod rows;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["--version"] => {
            println!("tonic {}", env!("TONIC_VERSION"));
            ExitCode::SUCCESS
        }
        [row, target] => run(row, target),
        _ => {
            eprintln!("usage: client ROW TARGET | client --version");
            ExitCode::from(2)
        }
    }
}

fn run(row: &str, target: &str) -> ExitCode {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a tokio runtime");
    let result = runtime.block_on(rows::run(row, target));
    if let Err(failure) = &result {
        eprintln!("{}", failure.replace('\n', " "));
    }
    println!("calls {}", gateway::calls());
    if result.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
