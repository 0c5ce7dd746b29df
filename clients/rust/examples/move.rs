//! Moves the axis x of the local stage, and waits. Ctrl-C cancels the move.

use axisgate::{mm, Error, Result, Stage};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<()> {
    let stage = Stage::connect().await?;
    tokio::select! {
        moved = stage.axis("x")?.move_to(mm("1.5")) => match moved {
            Err(Error::Refused(p)) => println!("nothing moved: {}", p.hint),
            other => println!("{}", other?),
        },
        _ = tokio::signal::ctrl_c() => println!("the move is cancelled"),
    }
    stage.close().await; // a cancellation is sent before the program ends
    Ok(())
}
