package axisgate;

import java.io.ByteArrayOutputStream;
import java.io.IOException;
import java.io.UncheckedIOException;
import java.net.StandardProtocolFamily;
import java.net.UnixDomainSocketAddress;
import java.nio.ByteBuffer;
import java.nio.channels.ServerSocketChannel;
import java.nio.channels.SocketChannel;
import java.util.List;
import java.util.concurrent.CopyOnWriteArrayList;

/**
 * Passes bytes between clients and the daemon's socket, and cuts connections once the daemon
 * answers.
 */
final class TestRelay implements AutoCloseable {
  private final UnixDomainSocketAddress upstream;
  private final UnixDomainSocketAddress own;
  private final ServerSocketChannel listener;
  private final List<SocketChannel> connections = new CopyOnWriteArrayList<>();
  private int cuts;
  private int left;
  private int firstStream;

  TestRelay(TestDaemon daemon) throws IOException {
    upstream = UnixDomainSocketAddress.of(daemon.socket());
    own = UnixDomainSocketAddress.of(daemon.path("relay.sock"));
    listener = ServerSocketChannel.open(StandardProtocolFamily.UNIX).bind(own);
    spawn(this::serve);
  }

  ConnectOptions options() {
    return new ConnectOptions().target(own.getPath().toString());
  }

  /**
   * Drops the answers to a stream of HTTP/2 (1 or 3, 5, ... of each connection) and closes the
   * connection. After the first cut, the first answer on each new connection is dropped, {@code
   * times} times in all.
   */
  synchronized void cutAnswers(int stream, int times) {
    firstStream = stream;
    left = times;
  }

  synchronized int cuts() {
    return cuts;
  }

  private void serve() throws IOException {
    for (; ; ) {
      SocketChannel client = listener.accept();
      SocketChannel daemon = SocketChannel.open(StandardProtocolFamily.UNIX);
      connections.addAll(List.of(client, daemon));
      daemon.connect(upstream);
      spawn(() -> pass(client, daemon, bytes -> false));
      Frames frames = new Frames();
      spawn(() -> pass(daemon, client, bytes -> isCut(frames, bytes)));
    }
  }

  private static void pass(SocketChannel from, SocketChannel to, Cut cut) throws IOException {
    try (from;
        to) {
      ByteBuffer buffer = ByteBuffer.allocate(1 << 16);
      while (from.read(buffer) >= 0) {
        buffer.flip();
        byte[] bytes = new byte[buffer.remaining()];
        buffer.get(bytes);
        if (cut.isAt(bytes)) {
          return;
        }
        to.write(ByteBuffer.wrap(bytes));
        buffer.clear();
      }
    }
  }

  private synchronized boolean isCut(Frames frames, byte[] bytes) {
    int newest = frames.newestStream(bytes);
    if (left == 0 || newest < firstStream) {
      return false;
    }
    cuts++;
    left--;
    firstStream = 1;
    return true;
  }

  private static void spawn(Task task) {
    Thread thread =
        new Thread(
            () -> {
              try {
                task.run();
              } catch (IOException e) {
                // One of the connections is closed.
              }
            },
            "relay");
    thread.setDaemon(true);
    thread.start();
  }

  @Override
  public void close() {
    try {
      listener.close();
      for (SocketChannel connection : connections) {
        connection.close();
      }
    } catch (IOException e) {
      throw new UncheckedIOException(e);
    }
  }

  /** Decides whether the connection is cut before the bytes are passed on. */
  private interface Cut {
    boolean isAt(byte[] bytes);
  }

  /** A task that ends when its connection is closed. */
  private interface Task {
    void run() throws IOException;
  }

  /** Frames of HTTP/2 that a daemon sends on one connection (RFC 9113, 4.1). */
  private static final class Frames {
    private static final int HEADER = 9;
    private byte[] unread = {};

    /** Returns the highest number of a stream whose headers or data begin in the bytes. 0: none. */
    int newestStream(byte[] bytes) {
      ByteArrayOutputStream joined = new ByteArrayOutputStream();
      joined.writeBytes(unread);
      joined.writeBytes(bytes);
      ByteBuffer frames = ByteBuffer.wrap(joined.toByteArray());
      int newest = 0;
      while (frames.remaining() >= HEADER) {
        int length = frames.getInt(frames.position()) >>> 8;
        if (frames.remaining() < HEADER + length) {
          break;
        }
        boolean answers = frames.get(frames.position() + 3) <= 1;
        newest = Math.max(newest, answers ? frames.getInt(frames.position() + 5) : 0);
        frames.position(frames.position() + HEADER + length);
      }
      unread = new byte[frames.remaining()];
      frames.get(unread);
      return newest;
    }
  }
}
