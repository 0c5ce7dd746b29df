package axisgate;

import static org.junit.jupiter.api.Assertions.assertTrue;
import static org.junit.jupiter.api.Assertions.fail;

import java.io.IOException;
import java.net.StandardProtocolFamily;
import java.net.UnixDomainSocketAddress;
import java.nio.ByteBuffer;
import java.nio.channels.SocketChannel;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.time.Duration;
import java.util.ArrayList;
import java.util.Comparator;
import java.util.List;
import java.util.Optional;
import java.util.UUID;
import java.util.concurrent.Callable;
import java.util.regex.Pattern;
import org.junit.jupiter.api.Assumptions;

/** The daemon of one test, and the simulator that it serves, which survives the daemon. */
final class TestDaemon implements AutoCloseable {
  static final Duration LIMIT = Duration.ofSeconds(30);

  private static final String STAGE =
      """
      listen = "127.0.0.1:0"
      metrics = "127.0.0.1:0"
      socket = "%1$s/axisgate.sock"
      [journal]
      kept = %2$s
      [[device]]
      name = "stage"
      connection = "serial"
      path = "%1$s/tty"
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
      """;

  private final Path bin;
  private final Path folder;
  private final Process simulator;
  private final List<Device> opened = new ArrayList<>();
  private Process process;

  TestDaemon() throws IOException {
    this(true, "");
  }

  /** Starts a daemon; {@code more} is added to its configuration. */
  TestDaemon(boolean journal, String more) throws IOException {
    String programs = Optional.ofNullable(System.getenv("AXISGATE_BIN")).orElse("../../build/bin");
    bin = Path.of(programs).toAbsolutePath();
    Assumptions.assumeTrue(
        Files.exists(bin.resolve("axisgated")), "AXISGATE_BIN does not name the daemon's folder");
    folder = Files.createTempDirectory("axisgate-java-");
    simulator =
        new ProcessBuilder(
                program("shrc203-sim"),
                "--pty",
                file("tty"),
                "--speed",
                "4",
                "--control",
                file("control"))
            .redirectErrorStream(true)
            .redirectOutput(folder.resolve("simulator").toFile())
            .start();
    until("the simulator's terminal", () -> Files.exists(folder.resolve("tty")));
    Files.writeString(folder.resolve("axisgate.toml"), STAGE.formatted(folder, journal) + more);
    start();
  }

  private String program(String name) {
    return bin.resolve(name).toString();
  }

  private String file(String name) {
    return folder.resolve(name).toString();
  }

  /** Starts the daemon, and waits until its controller answers. */
  void start() throws IOException {
    var builder = new ProcessBuilder(program("axisgated"), "--config", file("axisgate.toml"));
    builder.environment().put("STATE_DIRECTORY", file("state"));
    process =
        builder.redirectErrorStream(true).redirectOutput(folder.resolve("log").toFile()).start();
    until("a ready daemon", () -> log().contains("stage: link is UP"));
  }

  void kill() {
    process.destroyForcibly().onExit().join();
  }

  private String log() throws IOException {
    return Files.readString(folder.resolve("log"));
  }

  String socket() {
    return file("axisgate.sock");
  }

  Path path(String name) {
    return folder.resolve(name);
  }

  /** Returns a Stage that is closed with the daemon. */
  Stage open() {
    return open(new ConnectOptions().target(socket()));
  }

  Stage open(ConnectOptions options) {
    return closedAtEnd(Stage.open(options));
  }

  <D extends Device> D closedAtEnd(D device) {
    opened.add(device);
    return device;
  }

  /** Returns the Stage of another program, an anonymous caller over TCP. */
  Stage openOther() throws IOException {
    var address = Pattern.compile("gRPC on (\\S+) and").matcher(log());
    assertTrue(address.find());
    ConnectOptions options = new ConnectOptions().target(address.group(1));
    options.session = UUID.randomUUID().toString();
    return open(options);
  }

  /** Does what a person at the simulated stage does, such as "limit 1 cw on". */
  void atStage(String action) throws IOException {
    try (var control = SocketChannel.open(StandardProtocolFamily.UNIX)) {
      control.connect(UnixDomainSocketAddress.of(file("control")));
      control.write(ByteBuffer.wrap((action + "\n").getBytes(StandardCharsets.US_ASCII)));
      ByteBuffer answer = ByteBuffer.allocate(256);
      control.read(answer);
      assertTrue(new String(answer.array(), StandardCharsets.US_ASCII).startsWith("ok"), action);
    }
  }

  static void until(String what, Callable<Boolean> happened) {
    long limit = System.nanoTime() + LIMIT.toNanos();
    try {
      while (!happened.call()) {
        if (System.nanoTime() > limit) {
          fail("waited in vain: " + what);
        }
        Thread.sleep(10); // between two looks; the limit above decides
      }
    } catch (Exception e) {
      fail(what, e);
    }
  }

  @Override
  public void close() throws IOException {
    opened.forEach(Device::close);
    kill();
    simulator.destroyForcibly().onExit().join();
    try (var files = Files.walk(folder)) {
      for (Path path : files.sorted(Comparator.reverseOrder()).toList()) {
        Files.delete(path);
      }
    }
  }
}
