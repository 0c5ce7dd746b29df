package axisgate;

import static axisgate.Units.pulses;
import static org.junit.jupiter.api.Assertions.assertEquals;

import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import org.junit.jupiter.api.Test;

/** Threads and descriptors after many calls, with the real daemon. */
class LeakTest {
  private static final int MOVES = 1000;

  @Test
  void movesLeakNothing() throws IOException {
    try (var daemon = new TestDaemon()) {
      openAndMove(daemon, 1); // loads what stays
      long descriptors = descriptors();
      openAndMove(daemon, MOVES);
      TestDaemon.until("the end of the package's threads", () -> threads() == 0);
      TestDaemon.until("closed descriptors", () -> descriptors() <= descriptors);
    }
  }

  private static void openAndMove(TestDaemon daemon, int moves) {
    try (Stage stage = Stage.open(new ConnectOptions().target(daemon.socket()))) {
      for (int count = 1; count <= moves; count++) {
        Result result = stage.axis("x").moveTo(pulses(count % 2));
        assertEquals(count % 2, result.positions().get(0).pulses().getAsLong());
      }
    }
  }

  private static long threads() {
    return Thread.getAllStackTraces().keySet().stream()
        .filter(thread -> thread.getName().equals("axisgate"))
        .count();
  }

  private static long descriptors() throws IOException {
    try (var open = Files.list(Path.of("/proc/self/fd"))) {
      return open.count();
    }
  }
}
