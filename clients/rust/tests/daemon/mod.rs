//! A daemon with a simulated stage. AXISGATE_BIN names the folder of the programs.

#![allow(dead_code)] // each test program uses a part

use std::fs::{self, File};
use std::future::Future;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use axisgate::Stage;

pub mod relay;

const LIMIT: Duration = Duration::from_secs(30);

/// Configuration of the daemon. The stage runs on a pseudo-terminal of its own, so that it survives the daemon.
const CONFIG: &str = r#"
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "FOLDER/axisgate.sock"
[journal]
kept = JOURNAL
[[device]]
name = "stage"
connection = "serial"
path = "FOLDER/tty"
[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_minimum = "-15mm"
travel_maximum = "15mm"
[[device.axis]]
number = 2
name = "y"
unit = "mm"
"#;

/// A Daemon is the daemon of one test, and the simulator that it serves.
pub struct Daemon {
    folder: PathBuf,
    bin: PathBuf,
    simulator: Child,
    process: Child,
    log: String,
}

impl Daemon {
    /// Starts a daemon, which ends when it is dropped.
    pub async fn new() -> Daemon {
        Daemon::with("true", "").await
    }

    pub async fn with(journal: &str, more: &str) -> Daemon {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("axisgate-rust-{}-{number}", std::process::id()));
        fs::create_dir_all(&folder).expect("a temporary folder");
        let bin = std::env::var_os("AXISGATE_BIN")
            .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../build/bin"), PathBuf::from);
        let simulator = Command::new(bin.join("shrc203-sim"))
            .args(["--speed", "4", "--pty"])
            .arg(folder.join("tty"))
            .arg("--control")
            .arg(folder.join("control"))
            .stdout(Stdio::null())
            .spawn()
            .expect("AXISGATE_BIN names the folder of the daemon's programs");
        until("the simulator's terminal", || folder.join("tty").exists()).await;
        let config = CONFIG.replace("FOLDER", folder.to_str().expect("a path in UTF-8")).replace("JOURNAL", journal);
        fs::write(folder.join("axisgate.toml"), config + more).expect("a configuration");
        let process = begin(&bin, &folder);
        let mut daemon = Daemon { folder, bin, simulator, process, log: String::new() };
        daemon.until_ready().await;
        daemon
    }

    /// Starts the daemon again, and waits until its controller answers.
    pub async fn start(&mut self) {
        self.process = begin(&self.bin, &self.folder);
        self.until_ready().await;
    }

    async fn until_ready(&mut self) {
        let log = self.folder.join("log");
        until("a ready daemon", || fs::read_to_string(&log).is_ok_and(|log| log.contains("stage: link is UP"))).await;
        self.log = fs::read_to_string(&log).expect("the daemon's log");
    }

    pub fn kill(&mut self) {
        end(&mut self.process);
    }

    pub fn socket(&self) -> String {
        self.folder.join("axisgate.sock").to_str().expect("a path in UTF-8").to_string()
    }

    /// Returns the TCP address, whose callers are anonymous.
    pub fn address(&self) -> &str {
        let rest = self.log.split("gRPC on ").nth(1).expect("an address in the log");
        rest.split(' ').next().expect("an address in the log")
    }

    /// Connects over the socket.
    pub async fn connect(&self) -> Stage {
        Stage::connect().target(self.socket()).await.expect("a connection")
    }

    /// Lets another program run `axisctl`, as another caller. Returns what it prints, or its failure.
    pub async fn other(&self, words: &[&str]) -> Result<String, String> {
        let mut command = Command::new(self.bin.join("axisctl"));
        command.args(words).env("AXISGATE_TARGET", self.address()).env_remove("AXISGATE_SOCKET");
        let ended = tokio::task::spawn_blocking(move || command.output()).await.expect("a thread").expect("axisctl");
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        if ended.status.success() {
            Ok(text(ended.stdout))
        } else {
            Err(text(ended.stderr))
        }
    }

    /// Does what a person at the simulated stage does, such as "unplug 3".
    pub fn at_stage(&self, action: &str) {
        let mut person = UnixStream::connect(self.folder.join("control")).expect("the simulator's control");
        writeln!(person, "{action}").expect("an open control");
        let mut answer = [0; 256];
        let count = person.read(&mut answer).expect("an answer");
        assert!(answer[..count].starts_with(b"ok"), "{action}");
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        end(&mut self.process);
        end(&mut self.simulator);
        drop(fs::remove_dir_all(&self.folder));
    }
}

fn begin(bin: &Path, folder: &Path) -> Child {
    let log = File::create(folder.join("log")).expect("a log");
    Command::new(bin.join("axisgated"))
        .arg("--config")
        .arg(folder.join("axisgate.toml"))
        .env("STATE_DIRECTORY", folder.join("state"))
        .stdout(log.try_clone().expect("a log"))
        .stderr(log)
        .spawn()
        .expect("the daemon")
}

fn end(process: &mut Child) {
    drop(process.kill());
    drop(process.wait());
}

/// Waits until the condition is true.
pub async fn until(what: &str, mut is_true: impl FnMut() -> bool) {
    until_async(what, || std::future::ready(is_true())).await;
}

/// Waits until the condition is true.
pub async fn until_async<F: Future<Output = bool>>(what: &str, mut is_true: impl FnMut() -> F) {
    let limit = Instant::now() + LIMIT;
    while !is_true().await {
        assert!(Instant::now() < limit, "waited in vain: {what}");
        tokio::time::sleep(Duration::from_millis(10)).await; // between two looks; the limit decides
    }
}
