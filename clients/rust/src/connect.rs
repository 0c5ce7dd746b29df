use std::fmt;
use std::future::IntoFuture;
use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Duration;

use crate::api;
use crate::connection::Connection;
use crate::errors::{Error, Result};
use crate::session::{inherited_token, Boxed, Session};
use crate::target::{Names, Target};

const TIMEOUT: Duration = Duration::from_secs(10);

/// A Connect is a connection that is made once it is awaited. What is not given comes from the environment.
///
/// ```no_run
/// # async fn connect() -> axisgate::Result<()> {
/// use axisgate::Stage;
///
/// let stage = Stage::connect().target("lab").ca("lab.crt").token("none").device("stage").await?;
/// # Ok(())
/// # }
/// ```
#[must_use = "nothing is connected until it is awaited"]
pub struct Connect<D> {
    names: Names,
    device: String,
    timeout: Duration,
    kind: PhantomData<fn() -> D>,
}

/// A Connectable is a kind of device.
pub trait Connectable: Sized + Send + 'static {
    const CAPABILITY: api::Capability;
    const KIND: &'static str;

    fn of(session: Session, device: &api::Device) -> Self;
}

impl<D: Connectable> Connect<D> {
    pub(crate) fn new() -> Connect<D> {
        Connect { names: Names::default(), device: String::new(), timeout: TIMEOUT, kind: PhantomData }
    }

    /// Names the daemon: the path of a Unix socket, or HOST\[:PORT\]. Without it: `AXISGATE_TARGET`, or the local daemon.
    pub fn target(mut self, target: impl Into<String>) -> Self {
        self.names.target = Some(target.into());
        self
    }

    /// Gives the caller's token. Without it: `AXISGATE_TOKEN`. A token is never sent unencrypted to another machine.
    pub fn token(mut self, token: impl Into<String>) -> Self {
        self.names.token = Some(token.into());
        self
    }

    /// Names the file of the authority that signed the daemon's certificate, and so chooses TLS. Without it:
    /// `AXISGATE_CA`.
    pub fn ca(mut self, file: impl Into<String>) -> Self {
        self.names.ca = Some(file.into());
        self
    }

    /// Names the files of the caller's own certificate and key for TLS. Without them: `AXISGATE_CERTIFICATE` and
    /// `AXISGATE_KEY`.
    pub fn certificate(mut self, certificate: impl Into<String>, key: impl Into<String>) -> Self {
        (self.names.certificate, self.names.key) = (Some(certificate.into()), Some(key.into()));
        self
    }

    /// Names the device. Without it: the only one of its kind.
    pub fn device(mut self, name: impl Into<String>) -> Self {
        self.device = name.into();
        self
    }

    /// Sets the time limit of each call. Without it: 10 s. While the limit is in its first half, a request whose answer
    /// is lost is sent again; the daemon acts once.
    pub fn timeout(mut self, limit: Duration) -> Self {
        self.timeout = limit;
        self
    }

    async fn open(self) -> Result<D> {
        let target = Target::new(self.names, variable)?;
        let token = inherited_token(&variable("AXISGATE_LEASE").unwrap_or_default())?;
        let connection = Arc::new(Connection::new(target, self.timeout)?);
        let listed = connection.connect().await?;
        compare_versions(&listed.version);
        let device = choose::<D>(&listed.devices, &self.device)?;
        let name = device.name.as_str().into();
        Ok(D::of(Session { connection, device: name, token }, device))
    }
}

impl<D: Connectable> IntoFuture for Connect<D> {
    type Output = Result<D>;
    type IntoFuture = Boxed<D>;

    fn into_future(self) -> Self::IntoFuture {
        Box::pin(self.open())
    }
}

impl<D> fmt::Debug for Connect<D> {
    /// Leaves out the token, which is a secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Connect({:?}, {:?})", self.names.target, self.device)
    }
}

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// Logs a warning if the daemon has another version. Fields that one of them does not know have no effect.
fn compare_versions(daemon: &str) {
    let own = env!("CARGO_PKG_VERSION");
    if !daemon.is_empty() && daemon != own {
        tracing::warn!("the daemon is axisgate {daemon}, and this crate {own}");
    }
}

/// Returns the name of a device without its folder: "stage" for "devices/stage".
pub fn short_name(device: &str) -> &str {
    device.trim_start_matches("devices/")
}

/// Returns the device with the name, or the only one of its kind if the name is empty.
fn choose<'a, D: Connectable>(devices: &'a [api::Device], name: &str) -> Result<&'a api::Device> {
    let all: Vec<&str> = devices.iter().map(|device| short_name(&device.name)).collect();
    let (all, kind) = (all.join(", "), D::KIND);
    let mut able = devices.iter().filter(|device| {
        let named = name.is_empty() || short_name(&device.name) == short_name(name);
        named && device.capabilities.contains(&(D::CAPABILITY as i32))
    });
    match (able.next(), able.next()) {
        (Some(device), None) => Ok(device),
        (Some(_), Some(_)) => Err(Error::invalid(format!(
            "the daemon has more than one {kind}; choose one of these devices by device(): {all}"
        ))),
        (None, _) if !name.is_empty() => {
            Err(Error::invalid(format!("the daemon has no {kind} {name}; its devices: {all}")))
        }
        (None, _) => Err(Error::invalid(format!("the daemon has no {kind}; its devices: {all}"))),
    }
}
