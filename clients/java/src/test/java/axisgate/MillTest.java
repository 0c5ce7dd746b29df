package axisgate;

import static axisgate.Units.mm;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import axisgate.v1.Job;
import axisgate.v1.JobState;
import java.io.IOException;
import java.nio.charset.StandardCharsets;
import java.nio.file.Path;
import java.util.List;
import org.junit.jupiter.api.Test;

/** Jobs of a simulated mill, with the real daemon. */
class MillTest {
  private static final String MILL =
      """
      [[device]]
      name = "mill"
      kind = "rml1"
      profile = "%s"
      connection = "simulated"
      tools = ["T1", "T2"]
      [[device.origin]]
      name = "vice"
      x = 400
      y = 400
      """
          .formatted(Path.of("../../deploy/mills/mdx-20.toml").toAbsolutePath());

  private static final byte[] TRACES =
      bytes("PA;PA;VS4;!VZ4;!PZ-4,80;!MC1;PU80,80;PD80,80,120,80,120,120,80,120,80,80;PU;!MC0;\n");
  private static final byte[] OUTLINE =
      bytes("PA;PA;VS4;!VZ4;!PZ-23,80;!MC1;PU40,40;PD40,40,160,40;PU;!MC0;\n");

  private static byte[] bytes(String text) {
    return text.getBytes(StandardCharsets.US_ASCII);
  }

  private static JobOptions board(String... tools) {
    return new JobOptions("board", List.of(tools)).origin("vice").acceptedWarnings("drags-tool");
  }

  private static Mill open(TestDaemon daemon, ConnectOptions options) {
    Mill mill = daemon.closedAtEnd(Mill.open(options));
    TestDaemon.until("the line of the mill", () -> mill.read().getLineOpen());
    return mill;
  }

  private static Mill open(TestDaemon daemon) {
    return open(daemon, new ConnectOptions().target(daemon.socket()));
  }

  private static Job newest(Mill mill, Job job) {
    return mill.jobs().stream()
        .filter(one -> one.getName().equals(job.getName()))
        .findFirst()
        .orElseThrow();
  }

  private static void runPart(Mill mill, Job job, JobState state) {
    mill.start(mill.confirm(newest(mill, job)));
    TestDaemon.until("the state " + state, () -> newest(mill, job).getState() == state);
  }

  @Test
  void jobInTwoParts() throws IOException {
    try (var daemon = new TestDaemon(true, MILL)) {
      Mill mill = open(daemon);
      assertEquals("mill", mill.name());
      JobOptions options = board("T1", "T2").stock(mm(50), mm(50), mm(2));
      Job job = mill.send(List.of(TRACES, OUTLINE), options);
      assertEquals(2, job.getPartsCount());
      runPart(mill, job, JobState.JOB_STATE_TOOL_CHANGE);
      runPart(mill, job, JobState.JOB_STATE_FED);
      mill.reportDone(job);
      assertEquals(List.of(), mill.jobs());
    }
  }

  @Test
  void faultyJobIsRefused() throws IOException {
    try (var daemon = new TestDaemon(true, MILL)) {
      Mill mill = open(daemon);
      var faulty = List.of(bytes("G1 X10\n"));
      var error = assertThrows(Refused.class, () -> mill.send(faulty, board("T1")));
      assertEquals("INVALID_REQUEST", error.reason());
      assertThrows(IllegalArgumentException.class, () -> mill.send(faulty, board("T1", "T2")));
      mill.cancel(mill.send(List.of(TRACES), board("T1")));
      assertEquals(List.of(), mill.jobs());
      mill.abort();
    }
  }

  @Test
  void jobWhoseAnswerWasLostIsQueuedOnce() throws IOException {
    try (var daemon = new TestDaemon(true, MILL);
        var relay = new TestRelay(daemon)) {
      Mill direct = open(daemon);
      Mill mill = daemon.closedAtEnd(Mill.open(relay.options()));
      relay.cutAnswers(5, 2); // stream 3, the first of grpc-java, asks for the request memory
      mill.send(List.of(TRACES), board("T1"));
      assertEquals(2, relay.cuts());
      assertEquals(1, direct.jobs().size());
    }
  }

  @Test
  void toolIsMovedByHand() throws IOException {
    try (var daemon = new TestDaemon(true, MILL)) {
      Mill mill = open(daemon);
      assertFalse(mill.step(mm(1), mm(0), mm("-0.5")).isZero());
      try (var states = mill.watch()) {
        assertTrue(states.next().getLineOpen());
      }
    }
  }
}
