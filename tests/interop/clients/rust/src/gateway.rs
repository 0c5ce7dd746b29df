//! The channel to the daemon, and what several rows do with it.

use std::fmt::Debug;
use std::io;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;

use hyper_util::rt::TokioIo;
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};
use tonic::codegen::{BoxFuture, CompressionEncoding, Service, http::Uri};
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Request, Status, Streaming};

use api::distance::Amount;
use api::event::Fact;
use api::*;

#[allow(clippy::large_enum_variant, dead_code)]
pub mod api {
    tonic::include_proto!("axisgate.v1");
}

pub const STAGE: &str = "devices/stage";
pub const MILL: &str = "devices/mill";
pub const DEADLINE: Duration = Duration::from_secs(30);
pub const PING_INTERVAL: Duration = Duration::from_secs(1);

#[rustfmt::skip]
const CODE_NAMES: [&str; 17] = [
    "OK", "CANCELLED", "UNKNOWN", "INVALID_ARGUMENT", "DEADLINE_EXCEEDED", "NOT_FOUND", "ALREADY_EXISTS",
    "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION", "ABORTED", "OUT_OF_RANGE", "UNIMPLEMENTED",
    "INTERNAL", "UNAVAILABLE", "DATA_LOSS", "UNAUTHENTICATED",
];

/// Outcome of a check. The text of a failure says what was seen and what was expected.
pub type Check<T = ()> = Result<T, String>;

static CALLS: AtomicU64 = AtomicU64::new(0);

/// Returns the number of calls that were made.
pub fn calls() -> u64 {
    CALLS.load(Ordering::Relaxed)
}

/// Makes the request of one call with a deadline of 30 s, and counts the call.
pub fn request<T>(message: T) -> Request<T> {
    CALLS.fetch_add(1, Ordering::Relaxed);
    let mut request = Request::new(message);
    request.set_timeout(DEADLINE);
    request
}

/// Returns a status as text, like `NOT_FOUND (no such device)`.
pub fn text(status: &Status) -> String {
    format!("{} ({})", code_name(status.code()), status.message())
}

/// Returns gRPC's name of a code, like `NOT_FOUND`.
pub fn code_name(code: Code) -> &'static str {
    CODE_NAMES[code as usize]
}

/// During names the call in the text of its failure.
pub trait During<T> {
    fn during(self, call: &str) -> Check<T>;
}

impl<T> During<T> for Result<T, Status> {
    fn during(self, call: &str) -> Check<T> {
        self.map_err(|status| format!("{call}: {}, expected OK", text(&status)))
    }
}

pub fn expect<T: Debug>(what: &str, seen: T, expected: &str, good: bool) -> Check {
    if good { Ok(()) } else { Err(format!("{what}: {seen:?}, expected {expected}")) }
}

pub fn expect_code<T>(call: &str, answer: &Result<T, Status>, expected: Code) -> Check {
    let seen = answer.as_ref().map_or_else(text, |_| "OK".to_string());
    let good = answer.as_ref().map_or_else(Status::code, |_| Code::Ok) == expected;
    if good { Ok(()) } else { Err(format!("{call}: {seen}, expected {}", code_name(expected))) }
}

/// Returns the next message of a stream, or None if the call has ended with OK.
pub async fn next<T>(stream: &mut Streaming<T>) -> Result<Option<T>, Status> {
    let limit = DEADLINE + Duration::from_secs(10);
    let late = |_| Status::internal("the client has waited for 40 s, and neither a message nor an end has come");
    timeout(limit, stream.message()).await.unwrap_or_else(|elapsed| Err(late(elapsed)))
}

/// Patient is a connector that tries again until the daemon has sent its first bytes, the SETTINGS. The calls of the
/// channel wait until then. It replaces wait-for-ready, which tonic does not have.
struct Patient(SocketAddr);

impl Service<Uri> for Patient {
    type Response = TokioIo<TcpStream>;
    type Error = io::Error;
    type Future = BoxFuture<Self::Response, Self::Error>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, _: Uri) -> Self::Future {
        let address = self.0;
        Box::pin(async move {
            loop {
                if let Ok(connection) = TcpStream::connect(address).await
                    && connection.peek(&mut [0]).await.is_ok_and(|bytes| bytes > 0)
                {
                    connection.set_nodelay(true)?;
                    return Ok(TokioIo::new(connection));
                }
                sleep(Duration::from_millis(50)).await;
            }
        })
    }
}

/// One channel, and the clients of its services.
pub struct Gateway {
    channel: Channel,
    pub gzip: bool,
}

macro_rules! service {
    ($name:ident, $module:ident, $client:ident) => {
        pub fn $name(&self) -> api::$module::$client<Channel> {
            let client = api::$module::$client::new(self.channel.clone());
            if !self.gzip {
                return client;
            }
            client.send_compressed(CompressionEncoding::Gzip).accept_compressed(CompressionEncoding::Gzip)
        }
    };
}

impl Gateway {
    pub fn new(target: &str, pings: bool, wait_for_ready: bool) -> Check<Gateway> {
        let address = target.parse().map_err(|_| format!("{target}: expected ADDRESS:PORT"))?;
        let uri = format!("http://{target}");
        let mut endpoint = Endpoint::from_shared(uri).map_err(|error| format!("{target}: {error}"))?;
        if pings {
            endpoint = endpoint.http2_keep_alive_interval(PING_INTERVAL).keep_alive_timeout(PING_INTERVAL * 2);
            endpoint = endpoint.keep_alive_while_idle(true);
        }
        let channel = if wait_for_ready {
            endpoint.connect_with_connector_lazy(Patient(address))
        } else {
            endpoint.connect_timeout(DEADLINE).connect_lazy()
        };
        Ok(Gateway { channel, gzip: false })
    }

    service!(access, access_service_client, AccessServiceClient);
    service!(commands, command_service_client, CommandServiceClient);
    service!(control, control_service_client, ControlServiceClient);
    service!(devices, device_service_client, DeviceServiceClient);
    service!(events, event_service_client, EventServiceClient);
    service!(mills, mill_service_client, MillServiceClient);
    service!(stages, stage_service_client, StageServiceClient);

    /// Returns the stage as the daemon knows it.
    pub async fn stage(&self) -> Check<Device> {
        self.stage_not_older(None).await
    }

    /// Returns the stage. The daemon reads its state again if that is older than `max_age`.
    pub async fn stage_not_older(&self, max_age: Option<prost_types::Duration>) -> Check<Device> {
        let message = GetDeviceRequest { device: STAGE.to_string(), max_age };
        let answer = self.devices().get_device(request(message)).await.during("GetDevice")?;
        let device = answer.into_inner().device.unwrap_or_default();
        expect("device.name", &device.name, STAGE, device.name == STAGE)?;
        Ok(device)
    }

    /// Returns a Watch of everything that is kept.
    pub async fn watch_all(&self) -> Check<Watch> {
        self.watch_from(0, String::new()).await
    }

    pub async fn watch_from(&self, revision: u64, run: String) -> Check<Watch> {
        let message = WatchRequest { from_revision: Some(revision), run, ..Default::default() };
        let mut client = self.events();
        let answer = timeout(DEADLINE, client.watch(request(message))).await;
        let answer = answer.unwrap_or_else(|_| Err(Status::deadline_exceeded("the client has waited for 30 s")));
        Ok(Watch { stream: answer.during("Watch")?.into_inner(), last: None, moves: 0 })
    }

    /// Moves axis 1, forth and back by turns, and reads events until the move has succeeded.
    pub async fn move_and_see(&self, watch: &mut Watch) -> Check {
        let um = if watch.moves.is_multiple_of(2) { "10" } else { "-10" };
        watch.moves += 1;
        let distance = Distance { amount: Some(Amount::Um(um.to_string())) };
        let target = AxisTarget { axis: "1".to_string(), distance: Some(distance), ..Default::default() };
        let device = STAGE.to_string();
        let message = MoveRequest { device, targets: vec![target], relative: true, ..Default::default() };
        let answer = self.stages().r#move(request(message)).await.during("Move")?;
        let name = answer.into_inner().motion.unwrap_or_default().name;
        loop {
            match watch.next().await?.fact {
                Some(Fact::Motion(motion)) if motion.name == name => match motion.state() {
                    MotionState::Queued | MotionState::Running => {}
                    MotionState::Succeeded => return Ok(()),
                    _ => return Err(format!("{name}: {motion:?}, expected SUCCEEDED")),
                },
                _ => {}
            }
        }
    }
}

/// A Watch that checks that its revisions are contiguous.
pub struct Watch {
    pub stream: Streaming<WatchResponse>,
    pub last: Option<Event>,
    moves: u32,
}

impl Watch {
    pub async fn next(&mut self) -> Check<Event> {
        let event = self.next_or_end().await.during("Watch")?;
        event.ok_or("Watch: OK, expected an event".to_string())
    }

    /// Returns the next event, or the status with which the Watch has ended.
    pub async fn next_or_end(&mut self) -> Result<Option<Event>, Status> {
        let Some(answer) = next(&mut self.stream).await? else { return Ok(None) };
        let event = answer.event.unwrap_or_default();
        if let Some(last) = &self.last
            && event.revision != last.revision + 1
        {
            let text = format!("the client has seen revision {} after {}", event.revision, last.revision);
            return Err(Status::data_loss(text));
        }
        self.last = Some(event.clone());
        Ok(Some(event))
    }
}
