package axisgate;

import axisgate.v1.CallContext;
import axisgate.v1.ControlServiceGrpc;
import axisgate.v1.HandOverLeaseRequest;
import axisgate.v1.ReleaseLeaseRequest;
import axisgate.v1.RenewLeaseRequest;
import com.google.protobuf.ByteString;
import java.time.Duration;
import java.util.List;
import java.util.concurrent.CompletableFuture;

/**
 * A Lease is the exclusive right to move some axes. A thread keeps it alive until it is released.
 *
 * <pre>{@code
 * try (var lease = stage.lease("x", "y")) {
 *   stage.axis("x").moveTo(mm(1));
 * }
 * }</pre>
 *
 * <p>All calls of the Stage carry its newest lease, on every thread. A lease is lost if it cannot
 * be kept alive, or if an administrator takes the axes over. Motion then fails with {@link
 * LeaseLost} until the lease is released. Thread safe.
 */
public final class Lease implements AutoCloseable {
  private final Session session;
  private final axisgate.v1.Lease message;
  private final Duration ttl;
  private final Alarm ending;
  private final CompletableFuture<AxisgateException> lost = new CompletableFuture<>();

  private boolean released;

  private Lease(Session session, axisgate.v1.Lease message, Duration ttl) {
    this.session = session;
    this.message = message;
    this.ttl = ttl;
    ending = session.connection().newAlarm();
  }

  static Lease acquire(Session session, LeaseTerms terms) {
    var request = terms.request(session.device);
    try {
      var answer =
          session.change(
              ControlServiceGrpc.getAcquireLeaseMethod(),
              request,
              terms.longestWait(),
              session.token());
      Lease lease = new Lease(session, answer.getLease(), terms.ttl());
      session.connection().spawn(lease::keep);
      session.carry(lease.tokenBytes());
      return lease;
    } catch (OutcomeUnknown e) {
      if (e.getCause() instanceof Interrupted interrupted) {
        throw interrupted; // The daemon releases a lease whose answer is not received.
      }
      throw e;
    }
  }

  /**
   * Returns the token of the lease. It is a secret: every program that has it can use the lease.
   *
   * @return the token
   */
  public byte[] token() {
    return tokenBytes().toByteArray();
  }

  private ByteString tokenBytes() {
    return message.getToken();
  }

  /**
   * Returns the numbers of the axes.
   *
   * @return the numbers; empty for the whole device
   */
  public List<Integer> axes() {
    return message.getAxesList();
  }

  /**
   * Reports whether the lease was lost.
   *
   * @return true if the lease was lost
   */
  public boolean isLost() {
    return lost.isDone();
  }

  /**
   * Returns a future that completes with the reason once the lease is lost.
   *
   * @return the future, which completes on a thread of the package
   */
  public CompletableFuture<AxisgateException> lost() {
    return lost.copy();
  }

  /**
   * Gives the axes to a waiting caller. The lease ends.
   *
   * @param caller name of the caller, such as "unix anna"
   * @throws Refused if this caller does not wait for exactly these axes, or while a motion runs
   *     under the lease
   */
  public void handOver(String caller) {
    var request =
        HandOverLeaseRequest.newBuilder().setDevice(session.device).setCaller(caller).build();
    session.change(
        ControlServiceGrpc.getHandOverLeaseMethod(), request, Duration.ZERO, tokenBytes());
    end();
  }

  /**
   * Ends the lease. A motion that runs under it continues. It is sent even if the thread is
   * interrupted. Has no effect on a lease that has ended.
   */
  public void release() {
    if (!end() || isLost()) {
      return;
    }
    var request = ReleaseLeaseRequest.newBuilder().setDevice(session.device).build();
    session
        .connection()
        .uninterrupted(
            () ->
                session.change(
                    ControlServiceGrpc.getReleaseLeaseMethod(),
                    request,
                    Duration.ZERO,
                    tokenBytes()));
  }

  /**
   * Does the same as {@link #release}. If the daemon does not answer, the lease ends when it
   * expires.
   */
  @Override
  public void close() {
    try {
      release();
    } catch (AxisgateException | IllegalStateException e) {
      warn("the lease was not released", e);
    }
  }

  /** Carries and keeps the lease no longer. Reports whether this call has ended it. */
  private synchronized boolean end() {
    boolean first = !released;
    released = true;
    ending.end();
    session.connection().forget(ending);
    session.leave(tokenBytes());
    return first;
  }

  /** Renews the lease until it has ended or is lost. */
  private Void keep() {
    Duration kept = Times.now();
    try {
      for (pause(); !ending.hasEnded(); pause()) {
        try {
          renew();
          kept = Times.now();
        } catch (AxisgateException e) {
          boolean expired = Times.now().minus(kept).compareTo(ttl) > 0;
          if (!passes(e) || expired) {
            lose(passes(e) ? expired(e) : e);
            return null;
          }
        }
      }
    } catch (InterruptedException | IllegalStateException | Interrupted e) {
      return null; // The connection is closed.
    }
    return null;
  }

  private void pause() throws InterruptedException {
    ending.pause(ttl.dividedBy(3));
  }

  private void renew() {
    var request =
        RenewLeaseRequest.newBuilder()
            .setDevice(session.device)
            .setContext(CallContext.newBuilder().setLeaseToken(tokenBytes()))
            .build();
    session.calls.askOnce(ControlServiceGrpc.getRenewLeaseMethod(), request, ttl);
  }

  /** Reports whether a renewal that failed may succeed a moment later. */
  private static boolean passes(AxisgateException error) {
    return error instanceof Unavailable || error.reason().equals("QUEUE_FULL");
  }

  private static LeaseLost expired(AxisgateException error) {
    String message = "the lease has expired: " + error.problem().message();
    return new LeaseLost(Problem.of("LEASE_LOST", message, error.hint(), ""));
  }

  private void lose(AxisgateException error) {
    if (!ending.hasEnded()) {
      warn("the lease was lost", error);
      lost.complete(error);
    }
  }

  private void warn(String what, RuntimeException why) {
    var logger = session.connection().logger;
    logger.log(System.Logger.Level.WARNING, () -> what + ": " + why.getMessage());
  }
}
