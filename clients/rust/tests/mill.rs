//! Jobs of a simulated mill, with the real daemon.

mod daemon;

use axisgate::{mm, Error, Job, Mill, NewJob, Result};
use daemon::{until_async, Daemon};

const MILL: &str = r#"
[[device]]
name = "mill"
kind = "rml1"
profile = "PROFILE"
connection = "simulated"
tools = ["T1", "T2"]
[[device.origin]]
name = "vice"
x = 400
y = 400
"#;
const TRACES: &[u8] = b"PA;PA;VS4;!VZ4;!PZ-4,80;!MC1;PU80,80;PD80,80,120,80,120,120,80,120,80,80;PU;!MC0;\n";
const OUTLINE: &[u8] = b"PA;PA;VS4;!VZ4;!PZ-23,80;!MC1;PU40,40;PD40,40,160,40;PU;!MC0;\n";

async fn milling() -> Result<(Daemon, Mill)> {
    let profile = concat!(env!("CARGO_MANIFEST_DIR"), "/../../deploy/mills/mdx-20.toml");
    let daemon = Daemon::with("true", &MILL.replace("PROFILE", profile)).await;
    let mill = Mill::connect().target(daemon.socket()).await?;
    until_async("the line of the mill", || async { mill.state().await.is_ok_and(|state| state.line_open) }).await;
    Ok((daemon, mill))
}

fn board() -> NewJob {
    NewJob::new("board").part("T1", TRACES).origin("vice").accept_warning("drags-tool")
}

async fn newest(mill: &Mill, job: &Job) -> Option<Job> {
    mill.state().await.ok()?.jobs.into_iter().find(|one| one.name == job.name)
}

async fn run_part(mill: &Mill, job: &Job, state: &str) -> Result<()> {
    let job = newest(mill, job).await.expect("the job is in the queue");
    mill.start(&mill.confirm(&job).await?).await?;
    until_async(state, || async { newest(mill, &job).await.is_some_and(|job| job.state == state) }).await;
    Ok(())
}

#[tokio::test]
async fn a_job_in_two_parts() -> Result<()> {
    let (_daemon, mill) = milling().await?;
    let job = mill.send(board().part("T2", OUTLINE).stock(mm(50), mm(50), mm(2))).await?;
    assert_eq!((job.tools.as_slice(), job.part), (["T1".to_string(), "T2".to_string()].as_slice(), 1));
    run_part(&mill, &job, "TOOL_CHANGE").await?;
    run_part(&mill, &job, "FED").await?;
    mill.report_done(&job).await?;
    let state = mill.watch().await?.next().await.expect("a state")?;
    assert!(state.jobs.is_empty() && state.ended.is_some_and(|ended| ended.state == "DONE"));
    Ok(())
}

#[tokio::test]
async fn a_faulty_job_is_refused() -> Result<()> {
    let (_daemon, mill) = milling().await?;
    let faulty = mill.send(NewJob::new("a").part("T1", b"G1 X10\n")).await;
    assert!(matches!(faulty, Err(Error::Refused(problem)) if problem.reason == "INVALID_REQUEST"));
    assert!(matches!(mill.send(NewJob::new("a")).await, Err(Error::InvalidArgument(_))));
    Ok(())
}

#[tokio::test]
async fn a_job_is_cancelled_and_an_abort_is_sent() -> Result<()> {
    let (_daemon, mill) = milling().await?;
    let job = mill.send(board()).await?;
    mill.cancel(&job).await?;
    assert_eq!(newest(&mill, &job).await, None);
    let job = mill.send(board()).await?;
    mill.start(&mill.confirm(&job).await?).await?;
    mill.abort().await?;
    until_async("the end of the job", || async { newest(&mill, &job).await.is_none_or(|job| job.state != "RUNNING") })
        .await;
    Ok(())
}
