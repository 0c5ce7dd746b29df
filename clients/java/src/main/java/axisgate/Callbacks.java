package axisgate;

import java.util.concurrent.BlockingQueue;
import java.util.concurrent.Executor;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;

/**
 * Callbacks run the callbacks of a call on the thread that waits for it, which saves a change of
 * threads for each answer. Thread safe.
 */
final class Callbacks implements Executor {
  private static final Runnable WAKE = () -> {};

  private final BlockingQueue<Runnable> queue = new LinkedBlockingQueue<>();
  private volatile boolean abandoned;

  @Override
  public void execute(Runnable callback) {
    queue.add(callback);
    if (abandoned) {
      runAll();
    }
  }

  /** Waits for the next callback, at most for the given time, and runs it. */
  void runNext(long limitNs) throws InterruptedException {
    Runnable callback = queue.poll(limitNs, TimeUnit.NANOSECONDS);
    if (callback != null) {
      callback.run();
    }
  }

  /** Runs all further callbacks at once, on whatever thread, so that gRPC can free its buffers. */
  void abandon() {
    abandoned = true;
    runAll();
  }

  private void runAll() {
    for (Runnable callback = queue.poll(); callback != null; callback = queue.poll()) {
      callback.run();
    }
    queue.add(WAKE); // A thread that waits looks again at what the callbacks have changed.
  }
}
