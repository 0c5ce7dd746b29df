//! The daemon's address, and what identifies the caller.

use std::path::Path;
use std::time::Duration;

use tonic::transport::{Certificate, ClientTlsConfig, Endpoint, Identity};

use crate::errors::{Error, Result};

const SYSTEM_SOCKET: &str = "/run/axisgate/axisgate.sock";
const PORT: u16 = 50203;
const TLS_PORT: u16 = 50204;
const CONNECT_LIMIT: Duration = Duration::from_secs(5);
const PING_INTERVAL: Duration = Duration::from_secs(20);
const PING_LIMIT: Duration = Duration::from_secs(10);

/// Names are the target and the credentials as the program or the environment gives them.
#[derive(Clone, Default)]
pub struct Names {
    pub target: Option<String>,
    pub token: Option<String>,
    pub ca: Option<String>,
    pub certificate: Option<String>,
    pub key: Option<String>,
}

/// A Target is the daemon's address, with what identifies the caller. Empty texts are absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Target {
    /// "unix:/run/axisgate/axisgate.sock" or "lab:50203".
    pub address: String,
    pub token: String,
    ca: String,
    certificate: String,
    key: String,
}

impl Target {
    /// Returns the target that the names and the environment say.
    pub fn new(names: Names, environment: impl Fn(&str) -> Option<String>) -> Result<Target> {
        let chosen =
            |argument: Option<String>, variable| argument.or_else(|| environment(variable)).unwrap_or_default();
        let mut target = Target {
            address: String::new(),
            token: chosen(names.token, "AXISGATE_TOKEN"),
            ca: chosen(names.ca, "AXISGATE_CA"),
            certificate: chosen(names.certificate, "AXISGATE_CERTIFICATE"),
            key: chosen(names.key, "AXISGATE_KEY"),
        };
        if target.certificate.is_empty() != target.key.is_empty() {
            return Err(Error::invalid("certificate and key must be given together"));
        }
        target.address = address_of(&chosen(names.target, "AXISGATE_TARGET"), target.uses_tls(), environment)?;
        if !target.token.is_empty() && !target.uses_tls() && !target.is_local() {
            let address = &target.address;
            let message = format!("the token is not sent unencrypted to {address}: use ca() or set AXISGATE_CA");
            return Err(Error::InvalidArgument(message));
        }
        Ok(target)
    }

    /// Reports whether the daemon runs on this machine.
    pub fn is_local(&self) -> bool {
        let Some((host, _)) = self.address.rsplit_once(':').filter(|_| !self.address.starts_with("unix:")) else {
            return true;
        };
        let is_v4 = host.strip_prefix("127.").is_some_and(|rest| rest.bytes().all(|b| b.is_ascii_digit() || b == b'.'));
        host == "localhost" || host == "[::1]" || is_v4
    }

    fn uses_tls(&self) -> bool {
        !self.ca.is_empty() || !self.certificate.is_empty()
    }

    /// Returns the end of a connection, which is kept alive.
    pub fn endpoint(&self) -> Result<Endpoint> {
        let uri = match (self.address.starts_with("unix:"), self.uses_tls()) {
            (true, _) => self.address.clone(),
            (false, true) => format!("https://{}", self.address),
            (false, false) => format!("http://{}", self.address),
        };
        let wrong = |error| Error::invalid(format!("{} is not the address of a daemon: {error}", self.address));
        let endpoint = Endpoint::from_shared(uri).map_err(wrong)?;
        let endpoint = if self.uses_tls() { endpoint.tls_config(self.tls()?).map_err(wrong)? } else { endpoint };
        let endpoint = endpoint.connect_timeout(CONNECT_LIMIT).http2_keep_alive_interval(PING_INTERVAL);
        Ok(endpoint.keep_alive_timeout(PING_LIMIT).keep_alive_while_idle(true))
    }

    fn tls(&self) -> Result<ClientTlsConfig> {
        let config = match self.ca.as_str() {
            "" => ClientTlsConfig::new().with_native_roots(),
            file => ClientTlsConfig::new().ca_certificate(Certificate::from_pem(read(file)?)),
        };
        if self.certificate.is_empty() {
            return Ok(config);
        }
        Ok(config.identity(Identity::from_pem(read(&self.certificate)?, read(&self.key)?)))
    }
}

fn read(file: &str) -> Result<Vec<u8>> {
    std::fs::read(file).map_err(|error| Error::invalid(format!("{file}: {error}")))
}

fn address_of(name: &str, uses_tls: bool, environment: impl Fn(&str) -> Option<String>) -> Result<String> {
    if name.is_empty() {
        return Ok(format!("unix:{}", default_socket(environment)));
    }
    if name.starts_with("unix:") {
        return Ok(name.to_string());
    }
    if name.starts_with("unix-abstract:") {
        return Err(Error::invalid(format!("{name}: abstract sockets are not supported")));
    }
    let port = if uses_tls { TLS_PORT } else { PORT };
    for scheme in ["dns:", "ipv4:", "ipv6:"] {
        if let Some(host) = name.strip_prefix(scheme) {
            return Ok(with_port(host.trim_start_matches('/'), port));
        }
    }
    if name.contains('/') || name.ends_with(".sock") {
        return Ok(format!("unix:{name}"));
    }
    Ok(with_port(name, port))
}

fn with_port(host: &str, port: u16) -> String {
    let bracketed = host.starts_with('[');
    if (bracketed && !host.ends_with(']')) || (!bracketed && host.matches(':').count() == 1) {
        return host.to_string();
    }
    if !bracketed && host.contains(':') {
        return format!("[{host}]:{port}");
    }
    format!("{host}:{port}")
}

fn default_socket(environment: impl Fn(&str) -> Option<String>) -> String {
    if let Some(chosen) = environment("AXISGATE_SOCKET").filter(|chosen| !chosen.is_empty()) {
        return chosen;
    }
    let user = user();
    if Path::new(SYSTEM_SOCKET).exists() || user == Some(0) {
        return SYSTEM_SOCKET.to_string();
    }
    if let Some(runtime) = environment("XDG_RUNTIME_DIR").filter(|runtime| !runtime.is_empty()) {
        return format!("{runtime}/axisgate.sock");
    }
    format!("/tmp/axisgate-{}/axisgate.sock", user.unwrap_or_default())
}

/// Returns the number of the user who runs this program, or None where there are no such numbers.
fn user() -> Option<u32> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        std::fs::metadata("/proc/self").ok().map(|own| own.uid())
    }
    #[cfg(not(unix))]
    None
}
