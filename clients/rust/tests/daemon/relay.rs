use std::sync::{Arc, Mutex};

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::unix::{OwnedReadHalf, OwnedWriteHalf};
use tokio::net::{UnixListener, UnixStream};
use tokio::task::JoinHandle;

use super::Daemon;

/// A Relay passes bytes between clients and the daemon's socket, and cuts connections once the daemon answers.
pub struct Relay {
    pub socket: String,
    cutting: Arc<Mutex<Cutting>>,
    serving: JoinHandle<()>,
}

/// Cutting is which answers are dropped.
#[derive(Default)]
struct Cutting {
    first_stream: u32,
    left: u32,
    cuts: u32,
}

impl Relay {
    pub fn new(daemon: &Daemon) -> Relay {
        let (upstream, socket) = (daemon.socket(), format!("{}.relay", daemon.socket()));
        let listener = UnixListener::bind(&socket).expect("a socket");
        let cutting = Arc::new(Mutex::new(Cutting::default()));
        let shared = cutting.clone();
        let serving = tokio::spawn(async move {
            while let Ok((client, _)) = listener.accept().await {
                // Without a daemon, the client's connection is dropped.
                let Ok(daemon) = UnixStream::connect(&upstream).await else { continue };
                tokio::spawn(pass(client, daemon, shared.clone()));
            }
        });
        Relay { socket, cutting, serving }
    }

    /// Drops the answers to a stream of HTTP/2 (1, 3, 5, ... of each connection) and closes the connection. After the
    /// first cut, the first answer on each new connection is dropped, `times` times in all.
    pub fn cut_answers(&self, first_stream: u32, times: u32) {
        let mut cutting = self.cutting.lock().expect("no panic");
        (cutting.first_stream, cutting.left) = (first_stream, times);
    }

    pub fn cuts(&self) -> u32 {
        self.cutting.lock().expect("no panic").cuts
    }
}

impl Drop for Relay {
    fn drop(&mut self) {
        self.serving.abort();
    }
}

async fn pass(client: UnixStream, daemon: UnixStream, cutting: Arc<Mutex<Cutting>>) {
    let (mut from_client, to_client) = client.into_split();
    let (from_daemon, mut to_daemon) = daemon.into_split();
    tokio::select! {
        _ = tokio::io::copy(&mut from_client, &mut to_daemon) => {}
        () = answer(from_daemon, to_client, cutting) => {}
    }
}

async fn answer(mut daemon: OwnedReadHalf, mut client: OwnedWriteHalf, cutting: Arc<Mutex<Cutting>>) {
    let (mut unread, mut bytes) = (Vec::new(), vec![0; 1 << 16]);
    while let Ok(count @ 1..) = daemon.read(&mut bytes).await {
        unread.extend(&bytes[..count]);
        if is_cut(&cutting, &streams(&mut unread)) || client.write_all(&bytes[..count]).await.is_err() {
            return;
        }
    }
}

fn is_cut(cutting: &Mutex<Cutting>, streams: &[u32]) -> bool {
    let mut cutting = cutting.lock().expect("no panic");
    let is_cut = cutting.left > 0 && streams.iter().any(|stream| *stream >= cutting.first_stream);
    if is_cut {
        *cutting = Cutting { first_stream: 1, left: cutting.left - 1, cuts: cutting.cuts + 1 };
    }
    is_cut
}

/// Takes frames of HTTP/2 (RFC 9113, 4.1). Returns the numbers of the streams whose headers or data begin in them.
fn streams(unread: &mut Vec<u8>) -> Vec<u32> {
    let mut found = Vec::new();
    while unread.len() >= 9 {
        let length = u32::from_be_bytes([0, unread[0], unread[1], unread[2]]) as usize;
        if unread.len() < 9 + length {
            break;
        }
        if unread[3] <= 1 {
            found.push(u32::from_be_bytes([unread[5], unread[6], unread[7], unread[8]]));
        }
        unread.drain(..9 + length);
    }
    found
}
