package axisgate;

import java.time.Duration;
import java.util.Set;
import java.util.concurrent.ConcurrentHashMap;
import java.util.concurrent.ExecutionException;
import java.util.concurrent.ExecutorService;
import java.util.concurrent.Executors;
import java.util.concurrent.Future;
import java.util.concurrent.RejectedExecutionException;
import java.util.function.Supplier;

/**
 * A Connection is the daemon as one program sees it: its channels, and the threads that wait for
 * it. Thread safe.
 *
 * <p>Stops have a channel of their own, which is open from the start, so that no other call delays
 * them.
 */
final class Connection {
  final Target target;
  final Duration half;
  final System.Logger logger;
  final DaemonChannel channel;
  final DaemonChannel stops;

  private final ExecutorService tasks =
      Executors.newCachedThreadPool(
          task -> {
            Thread thread = new Thread(task, "axisgate");
            thread.setDaemon(true);
            return thread;
          });
  private final Set<Alarm> alarms = ConcurrentHashMap.newKeySet();
  private volatile boolean closed;

  Connection(ConnectOptions options) {
    target = Target.of(options);
    half = options.timeout.dividedBy(2);
    logger = options.logger;
    channel = new DaemonChannel(target, options.session, logger);
    stops = new DaemonChannel(target, options.session, logger);
  }

  /**
   * Throws IllegalStateException if the connection is closed, and Interrupted if the thread is
   * interrupted.
   */
  void check() {
    checkOpen();
    if (Thread.currentThread().isInterrupted()) {
      throw new Interrupted("the thread was interrupted before the call");
    }
  }

  boolean isClosed() {
    return closed;
  }

  private void checkOpen() {
    if (closed) {
      throw closedError();
    }
  }

  static IllegalStateException closedError() {
    return new IllegalStateException("the connection to the daemon is closed");
  }

  /** Returns the error of an interrupted wait, and sets the interrupted status of the thread. */
  static Interrupted interrupted() {
    Thread.currentThread().interrupt();
    return new Interrupted("the thread was interrupted while it waited for the daemon");
  }

  /** Returns an alarm that close() ends. Call {@link #forget} after its use. */
  Alarm newAlarm() {
    Alarm alarm = new Alarm();
    alarms.add(alarm);
    if (closed) {
      alarm.end();
    }
    return alarm;
  }

  void forget(Alarm alarm) {
    alarms.remove(alarm);
  }

  /** Waits after a failure; if the call had no connection, at most until there is one. */
  void pause(Alarm alarm, DaemonChannel used, Failure failure, Duration pause)
      throws InterruptedException {
    if (failure.neverSent()) {
      used.reconnect(alarm);
    }
    alarm.pause(pause);
  }

  /** Runs a task on another thread. */
  <T> Future<T> spawn(Supplier<T> task) {
    try {
      return tasks.submit(task::get);
    } catch (RejectedExecutionException e) {
      throw closedError();
    }
  }

  /** Returns the executor of the tasks, which accepts none after close(). */
  ExecutorService tasks() {
    checkOpen();
    return tasks;
  }

  /** Returns the result of an action that an interruption of this thread does not end. */
  <T> T uninterrupted(Supplier<T> action) {
    Future<T> running = spawn(action);
    boolean interrupted = false;
    try {
      for (; ; ) {
        try {
          return running.get();
        } catch (InterruptedException e) {
          interrupted = true;
        }
      }
    } catch (ExecutionException e) {
      throw rethrown(e.getCause());
    } finally {
      if (interrupted) {
        Thread.currentThread().interrupt();
      }
    }
  }

  /**
   * Returns the exception of a task with the stack of this thread, which shows the caller's line.
   */
  private static RuntimeException rethrown(Throwable thrown) {
    if (thrown instanceof Error error) {
      throw error;
    }
    thrown.fillInStackTrace();
    return (RuntimeException) thrown;
  }

  /** Ends all calls and tasks. Motions continue. */
  void close() {
    closed = true;
    tasks.shutdown();
    alarms.forEach(Alarm::end);
    channel.close();
    stops.close();
  }
}
