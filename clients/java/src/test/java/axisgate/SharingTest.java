package axisgate;

import static axisgate.Units.mm;
import static axisgate.Units.um;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertInstanceOf;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.io.IOException;
import java.time.Duration;
import java.util.HexFormat;
import java.util.List;
import java.util.Map;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.TimeUnit;
import org.junit.jupiter.api.Test;

/** Leases and jogs, with the real daemon. */
class SharingTest {
  private static final Duration TTL = Duration.ofSeconds(1);

  @Test
  void leases() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      Stage second = daemon.open();
      try (Lease lease = stage.lease(LeaseTerms.of("x").withTtl(TTL).withPurpose("a test"))) {
        assertEquals(List.of(1), lease.axes());
        assertEquals("x 0.1 mm", stage.axis("x").moveTo(mm(0.1)).toString());
        assertThrows(LeaseHeld.class, () -> second.axis("x").moveTo(mm(0)));
        assertEquals("y 0.1 mm", second.axis("y").moveTo(mm(0.1)).toString());

        var inherited =
            new ConnectOptions(
                name ->
                    name.equals("AXISGATE_LEASE") ? HexFormat.of().formatHex(lease.token()) : null);
        Stage inside = daemon.open(inherited.target(daemon.socket()));
        assertEquals("x 0.2 mm", inside.axis("x").moveTo(mm(0.2)).toString());

        var longer = TTL.multipliedBy(5).dividedBy(2); // than the lease lasts unless it is kept
        var lost = new CompletableFuture<AxisgateException>();
        lease.lost().thenAccept(lost::complete);
        lost.completeOnTimeout(null, longer.toMillis(), TimeUnit.MILLISECONDS).join();
        assertFalse(lease.isLost());
        assertEquals("x 0 mm", stage.axis("x").moveTo(mm(0)).toString());
        Thread.currentThread().interrupt();
        lease.release(); // although the thread is interrupted
        assertTrue(Thread.interrupted());
      }
      assertEquals("x 0.1 mm", second.axis("x").moveTo(mm(0.1)).toString());
      stage.lease(); // ends with the Stage
    }
  }

  @Test
  void lostLease() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      try (Lease lease = stage.lease(LeaseTerms.of("x").withTtl(TTL))) {
        daemon.kill();
        daemon.start();
        var error = lease.lost().orTimeout(TestDaemon.LIMIT.toSeconds(), TimeUnit.SECONDS).join();
        assertInstanceOf(LeaseLost.class, error);
        assertThrows(LeaseLost.class, () -> stage.axis("x").moveTo(mm(1)));
      }
      assertEquals("x 1 mm", stage.axis("x").moveTo(mm(1)).toString());
    }
  }

  @Test
  void handOver() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      Stage other = daemon.openOther();
      Lease lease = stage.lease("x");
      LeaseTerms patient = LeaseTerms.of("x").withWait(Duration.ofSeconds(20));
      var given = CompletableFuture.supplyAsync(() -> other.lease(patient));
      String name = other.whoAmI().name();
      TestDaemon.until("a caller who waits", () -> handedOver(lease, name));
      given.join().release();
    }
  }

  private static boolean handedOver(Lease lease, String caller) {
    try {
      lease.handOver(caller);
      return true;
    } catch (Refused e) {
      return false;
    }
  }

  @Test
  void interruptedWaitForALease() throws IOException {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      daemon.openOther().lease("x");
      LeaseTerms patient = LeaseTerms.of("x").withWait(Duration.ofSeconds(20));
      Thread waiting = Thread.currentThread();
      CompletableFuture.runAsync(
          waiting::interrupt, CompletableFuture.delayedExecutor(500, TimeUnit.MILLISECONDS));
      assertThrows(Interrupted.class, () -> stage.lease(patient));
      assertTrue(Thread.interrupted());
    }
  }

  @Test
  void jogs() throws Exception {
    try (var daemon = new TestDaemon()) {
      Stage stage = daemon.open();
      Stage other = daemon.openOther();
      Map<String, Speed> speeds = Map.of("x", um(-200).perSecond());
      try (Jog jog = stage.jog(speeds)) {
        assertThrows(WaitTimeout.class, () -> jog.motion().await(Duration.ofMillis(700)));
        Result result = jog.stop();
        assertTrue(result.positions().get(0).pulses().getAsLong() < 0, result.toString());
        assertEquals("SUCCEEDED", jog.motion().state());
      }
      var fast = Map.of("x", mm(1000).perSecond());
      assertEquals("OUT_OF_RANGE", assertThrows(Refused.class, () -> stage.jog(fast)).reason());
      Jog stopped = stage.jog(speeds);
      other.stop();
      assertThrows(Stopped.class, stopped::close);
    }
  }
}
