//! The rows of `../../README.md`.

use std::time::{Duration, Instant};

use prost_types::Duration as Span;
use tokio::sync::mpsc;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};
use tonic::codegen::tokio_stream::{iter, wrappers::ReceiverStream};
use tonic::transport::Channel;
use tonic::{Code, Request, Status, Streaming};

use crate::gateway::api::axis_jog::Direction;
use crate::gateway::api::event::Fact;
use crate::gateway::api::execute_response::Change;
use crate::gateway::api::mill_service_client::MillServiceClient;
use crate::gateway::api::send_job_request::Part;
use crate::gateway::api::speed::Amount;
use crate::gateway::api::*;
use crate::gateway::{
    Check, DEADLINE, During, Gateway, MILL, PING_INTERVAL, STAGE, code_name, expect, expect_code, next, request,
};

const NO_WAIT_FOR_READY: &str =
    "note tonic has no wait-for-ready: the connector waits for the daemon's SETTINGS instead";

pub async fn run(row: &str, target: &str) -> Check {
    let mut gateway = Gateway::new(target, row == "keepalive", matches!(row, "restart" | "end-in-call"))?;
    gateway.gzip = row == "gzip";
    let gateway = &gateway;
    match row {
        "unary-front" => unary_front(gateway).await,
        "unary-grpc" => unary_grpc(gateway).await,
        "watch" => watch(gateway).await,
        "execute" => execute(gateway).await,
        "send-job" => send_job(gateway).await,
        "jog" => jog(gateway).await,
        "keep-lease" => keep_lease(gateway).await,
        "gzip" => gzip(gateway).await,
        "deadline" => deadline(gateway).await,
        "cancel" => cancel(gateway).await,
        "keepalive" => keepalive(gateway).await,
        "metadata" => metadata(gateway).await,
        "many" => many(gateway).await,
        "restart" => restart(gateway).await,
        "end-in-call" => end_in_call(gateway).await,
        _ => Err(format!("{row}: no such row")),
    }
}

async fn unary_front(gateway: &Gateway) -> Check {
    for _ in 0..200 {
        let stage = gateway.stage().await?;
        expect("device.link", stage.link(), "Up", stage.link() == LinkState::Up)?;
    }
    for _ in 0..200 {
        let answer = gateway.devices().list_devices(request(ListDevicesRequest {})).await.during("ListDevices")?;
        let mut names: Vec<_> = answer.into_inner().devices.into_iter().map(|device| device.name).collect();
        names.sort();
        expect("ListDevices", &names, "the mill and the stage", names == [MILL, STAGE])?;
    }
    let message = GetDeviceRequest { device: "devices/none".to_string(), max_age: None };
    let answer = gateway.devices().get_device(request(message)).await;
    expect_code("GetDevice(devices/none)", &answer, Code::NotFound)
}

async fn unary_grpc(gateway: &Gateway) -> Check {
    for _ in 0..200 {
        caller(gateway).await?;
    }
    let message = ListCommandsRequest { device: STAGE.to_string() };
    let answer = gateway.commands().list_commands(request(message)).await.during("ListCommands")?;
    let commands = answer.into_inner().commands.len();
    expect("number of commands", commands, "more than 50", commands > 50)?;
    let message = GetMotionRequest { motion: format!("{STAGE}/motions/999999999") };
    let answer = gateway.stages().get_motion(request(message)).await;
    expect_code("GetMotion(999999999)", &answer, Code::NotFound)
}

async fn caller(gateway: &Gateway) -> Check {
    let answer = gateway.access().get_caller(request(GetCallerRequest {})).await.during("GetCaller")?;
    let who = answer.into_inner().caller.unwrap_or_default().name;
    expect("who", &who, "a name", !who.is_empty())
}

async fn watch(gateway: &Gateway) -> Check {
    let mut watch = gateway.watch_all().await?;
    for _ in 0..3 {
        gateway.move_and_see(&mut watch).await?;
    }
    drop(watch);
    println!("note tonic cancels by dropping the stream, and gives no status; GetDevice is answered after it");
    gateway.stage().await.map(|_| ())
}

async fn execute(gateway: &Gateway) -> Check {
    for _ in 0..50 {
        execute_questions(gateway).await?;
    }
    let message = ExecuteRequest { device: STAGE.to_string(), lines: vec!["QQ:".to_string()], ..Default::default() };
    let answer = match gateway.commands().execute(request(message)).await {
        Ok(answer) => next(&mut answer.into_inner()).await,
        Err(status) => Err(status),
    };
    expect_code("Execute(QQ:)", &answer, Code::InvalidArgument)
}

async fn execute_questions(gateway: &Gateway) -> Check {
    let lines = ["*IDN?", "Q:", "?:N"].map(String::from).to_vec();
    let message = ExecuteRequest { device: STAGE.to_string(), lines, ..Default::default() };
    let mut replies = gateway.commands().execute(request(message)).await.during("Execute")?.into_inner();
    for line in 0..3 {
        let change = next(&mut replies).await.during("Execute")?.and_then(|message| message.change);
        let good = matches!(&change, Some(Change::Reply(reply)) if reply.line == line + 1 && !reply.answer.is_empty());
        expect("Execute", &change, &format!("the reply to line {line}"), good)?;
    }
    expect_end("Execute", &mut replies).await
}

async fn expect_end<T: std::fmt::Debug>(call: &str, answers: &mut Streaming<T>) -> Check {
    let more = next(answers).await.during(call)?;
    expect(call, &more, "the end of the call", more.is_none())
}

/// Returns the header, and the job cut into pieces of almost equal length.
fn job_messages(job: &str, title: &str, count: usize) -> Vec<SendJobRequest> {
    let place = |index: usize| job.len() * index / count;
    let pieces = (0..count).map(|index| job.as_bytes()[place(index)..place(index + 1)].to_vec());
    let header = JobHeader {
        device: MILL.to_string(),
        title: title.to_string(),
        tool: "T1".to_string(),
        ..Default::default()
    };
    std::iter::once(Part::Header(header))
        .chain(pieces.map(Part::Data))
        .map(|part| SendJobRequest { part: Some(part) })
        .collect()
}

async fn send_job(gateway: &Gateway) -> Check {
    let job = format!("^IN;!MC0;!PZ-50,200;{}H;\n", "PU4000,0;PU0,0;".repeat(4000));
    let messages = iter(job_messages(&job, "interop", 64));
    let answer = gateway.mills().send_job(request(messages)).await.during("SendJob")?;
    let seen = answer.into_inner().job.unwrap_or_default();
    expect("job.bytes", seen.bytes, &job.len().to_string(), usize::try_from(seen.bytes) == Ok(job.len()))?;
    expect("job.title", &seen.title, "interop", seen.title == "interop")?;
    let message = CancelJobRequest { job: seen.name, ..Default::default() };
    gateway.mills().cancel_job(request(message)).await.during("CancelJob").map(|_| ())
}

fn jog_message(device: &str, direction: Direction, pulses_per_s: i64) -> JogRequest {
    let speed = Some(Speed { amount: Some(Amount::PulsesPerS(pulses_per_s)) });
    let axes = vec![AxisJog { axis: "2".to_string(), direction: direction.into(), speed }];
    JogRequest { device: device.to_string(), axes, ..Default::default() }
}

/// Returns a jog that runs: the sender of its messages and its answers.
async fn running_jog(gateway: &Gateway) -> Check<(mpsc::Sender<JogRequest>, Streaming<JogResponse>)> {
    let (sender, receiver) = mpsc::channel(2);
    let first = jog_message(STAGE, Direction::Plus, 1000);
    sender.send(first).await.map_err(|error| error.to_string())?;
    let answer = gateway.stages().jog(request(ReceiverStream::new(receiver))).await.during("Jog")?;
    let mut answers = answer.into_inner();
    loop {
        let answer = next(&mut answers).await.during("Jog")?;
        match answer.clone().and_then(|answer| answer.motion).unwrap_or_default().state() {
            MotionState::Queued => {}
            MotionState::Running => return Ok((sender, answers)),
            _ => return Err(format!("Jog: {answer:?}, expected RUNNING")),
        }
    }
}

async fn jog(gateway: &Gateway) -> Check {
    let (sender, mut answers) = running_jog(gateway).await?;
    let second = jog_message("", Direction::Unspecified, 2000);
    sender.send(second).await.map_err(|error| error.to_string())?;
    drop(sender);
    let mut last = None;
    while let Some(answer) = next(&mut answers).await.during("Jog")? {
        last = answer.motion;
    }
    let succeeded = last.as_ref().is_some_and(|motion| motion.state() == MotionState::Succeeded);
    expect("last answer of Jog", &last, "SUCCEEDED", succeeded)
}

async fn keep_lease(gateway: &Gateway) -> Check {
    let time_to_live = Some(Span { seconds: 10, nanos: 0 });
    let terms = Some(LeaseTerms { axes: vec!["3".to_string()], time_to_live, ..Default::default() });
    let message = AcquireLeaseRequest { device: STAGE.to_string(), terms, ..Default::default() };
    let answer = gateway.control().acquire_lease(request(message)).await.during("AcquireLease")?;
    let token = answer.into_inner().lease.unwrap_or_default().token;
    expect("bytes of the token", token.len(), "24", token.len() == 24)?;
    keep_alive(gateway, &token).await?;
    let context = Some(CallContext { lease_token: token, ..Default::default() });
    let message = ReleaseLeaseRequest { context, device: STAGE.to_string() };
    gateway.control().release_lease(request(message)).await.during("ReleaseLease").map(|_| ())
}

async fn keep_alive(gateway: &Gateway, token: &[u8]) -> Check {
    let message = KeepLeaseAliveRequest { device: STAGE.to_string(), lease_token: token.to_vec() };
    let (sender, receiver) = mpsc::channel(2);
    sender.send(message.clone()).await.map_err(|error| error.to_string())?;
    let answer = gateway.control().keep_lease_alive(request(ReceiverStream::new(receiver))).await;
    let mut answers = answer.during("KeepLeaseAlive")?.into_inner();
    for number in 0..10 {
        if number > 0 {
            sender.send(message.clone()).await.map_err(|error| error.to_string())?;
        }
        let lease = next(&mut answers).await.during("KeepLeaseAlive")?.and_then(|answer| answer.lease);
        let axes = lease.unwrap_or_default().axes;
        expect("lease.axes", &axes, "[3]", axes == [3])?;
    }
    drop(sender);
    expect_end("KeepLeaseAlive", &mut answers).await
}

async fn gzip(gateway: &Gateway) -> Check {
    for _ in 0..20 {
        gateway.stage().await?;
    }
    for _ in 0..20 {
        caller(gateway).await?;
    }
    for _ in 0..20 {
        execute_questions(gateway).await?;
    }
    send_job(gateway).await
}

async fn deadline(gateway: &Gateway) -> Check {
    let begun = Instant::now();
    let mut call: Request<_> = request(WatchRequest::default());
    call.set_timeout(Duration::from_millis(500));
    let end = match gateway.events().watch(call).await {
        Ok(answer) => end_of(answer.into_inner()).await,
        Err(status) => Err(status),
    };
    let took = begun.elapsed().as_secs_f64();
    expect_code("Watch with a deadline of 0.5 s", &end, Code::DeadlineExceeded)?;
    expect("seconds until it has ended", took, "0.4 to 5", (0.4..=5.0).contains(&took))?;
    println!("note the Watch ended after {took:.2} s; in a stream, tonic leaves the deadline to the server");
    gateway.stage().await?;
    caller(gateway).await
}

/// Reads a stream to its end.
async fn end_of<T>(mut stream: Streaming<T>) -> Result<(), Status> {
    while next(&mut stream).await?.is_some() {}
    Ok(())
}

async fn cancel(gateway: &Gateway) -> Check {
    let (sender, answers) = running_jog(gateway).await?;
    // tonic sends RST_STREAM (CANCEL) once both are dropped; with `answers` alone, the call goes on.
    drop(answers);
    drop(sender);
    println!("note tonic cancels by dropping the streams, and gives no status");
    let begun = Instant::now();
    while axis_2(gateway).await?.busy() {
        let waited = begun.elapsed();
        expect("axis 2 is busy after", waited, "at most 10 s", waited.as_secs() < 10)?;
        sleep(Duration::from_millis(50)).await;
    }
    let (first, second) = (axis_2(gateway).await?.position_pulses, axis_2(gateway).await?.position_pulses);
    expect("two positions", (first, second), "the same", first.is_some() && first == second)
}

/// Returns axis 2, read now. Just after a start, the state that the daemon knows can be older than the motion.
async fn axis_2(gateway: &Gateway) -> Check<Axis> {
    let axes = gateway.stage_not_older(Some(Span::default())).await?.axes;
    axes.into_iter().find(|axis| axis.number == 2).ok_or("GetDevice: expected axis 2".to_string())
}

async fn keepalive(gateway: &Gateway) -> Check {
    let mut watch = gateway.watch_all().await?;
    println!("note a PING every {PING_INTERVAL:?}, also without calls");
    sleep(PING_INTERVAL * 5 / 2 + Duration::from_secs(1)).await;
    gateway.move_and_see(&mut watch).await
}

async fn metadata(gateway: &Gateway) -> Check {
    let mut watch = gateway.watch_all().await?;
    watch.next().await?;
    for (kib, expected) in [(8, Code::Ok), (15, Code::Ok), (40, Code::ResourceExhausted)] {
        let call = noted(GetCallerRequest {}, kib);
        let answer = gateway.access().get_caller(call).await;
        expect_code(&format!("GetCaller with {kib} KiB"), &answer, expected)?;
        let call = noted(GetDeviceRequest { device: STAGE.to_string(), max_age: None }, kib);
        let answer = gateway.devices().get_device(call).await;
        expect_code(&format!("GetDevice with {kib} KiB"), &answer, expected)?;
    }
    gateway.move_and_see(&mut watch).await
}

fn noted<T>(message: T, kib: usize) -> Request<T> {
    let mut request = request(message);
    request.metadata_mut().insert("x-note", "a".repeat(kib * 1024).parse().expect("letters"));
    request
}

async fn many(gateway: &Gateway) -> Check {
    let mut watch = gateway.watch_all().await?;
    let mut calls = JoinSet::new();
    for _ in 0..500 {
        let mut client = gateway.devices();
        let message = GetDeviceRequest { device: STAGE.to_string(), max_age: None };
        calls.spawn(async move { client.get_device(request(message)).await });
    }
    for _ in 0..10 {
        gateway.move_and_see(&mut watch).await?;
    }
    while let Some(answer) = calls.join_next().await {
        answer.map_err(|error| error.to_string())?.during("GetDevice")?;
    }
    Ok(())
}

async fn restart(gateway: &Gateway) -> Check {
    println!("{NO_WAIT_FOR_READY}");
    let mut watch = gateway.watch_all().await?;
    gateway.move_and_see(&mut watch).await?;
    println!("ready");
    let end = loop {
        match watch.next_or_end().await {
            Ok(Some(_)) => {}
            Ok(None) => break Ok(()),
            Err(status) => break Err(status),
        }
    };
    expect_code("Watch over the restart", &end, Code::Unavailable)?;
    let last = watch.last.ok_or("Watch: no event, expected some")?;
    let mut resumed = gateway.watch_from(last.revision + 1, last.run).await?;
    let first = resumed.next().await?;
    expect("first revision", first.revision, &(last.revision + 1).to_string(), first.revision == last.revision + 1)?;
    let mut event = first;
    while !matches!(event.fact, Some(Fact::DaemonStarted(_))) {
        event = resumed.next().await?;
    }
    until_up(gateway).await
}

async fn until_up(gateway: &Gateway) -> Check {
    let begun = Instant::now();
    loop {
        let link = gateway.stage().await?.link();
        if link == LinkState::Up {
            return Ok(());
        }
        expect("device.link after 30 s", link, "Up", begun.elapsed() < DEADLINE)?;
        sleep(Duration::from_millis(100)).await;
    }
}

async fn end_in_call(gateway: &Gateway) -> Check {
    println!("{NO_WAIT_FOR_READY}");
    let mut calls = JoinSet::new();
    let (mut begun, mut sent) = (0, 0);
    loop {
        while begun < 40 && calls.len() < 4 {
            calls.spawn(send_one(gateway.mills(), format!("end-{begun}")));
            begun += 1;
        }
        let Some(outcome) = calls.join_next().await else { return Ok(()) };
        let (title, answer) = outcome.map_err(|error| error.to_string())?;
        match answer {
            Ok(()) => {
                println!("sent {title}");
                sent += 1;
                if sent == 10 {
                    println!("ready");
                }
            }
            Err(status) => println!("failed {title} {}", code_name(status.code())),
        }
    }
}

async fn send_one(mut client: MillServiceClient<Channel>, title: String) -> (String, Result<(), Status>) {
    let messages = iter(job_messages("^IN;!MC0;PU0,0;H;\n", &title, 4));
    let answer = timeout(DEADLINE, client.send_job(request(messages))).await;
    let late = |_| Err(Status::deadline_exceeded("the client has waited for 30 s"));
    (title, answer.unwrap_or_else(late).map(|_| ()))
}
