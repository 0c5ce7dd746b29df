package axisgate;

import java.time.Duration;

/** An Alarm ends the pauses of one thread early. */
final class Alarm {
  private boolean rung;
  private boolean ended;

  /** Ends the present pause, or the next one. */
  synchronized void ring() {
    rung = true;
    notifyAll();
  }

  /** Ends all pauses. */
  synchronized void end() {
    ended = true;
    notifyAll();
  }

  synchronized boolean hasEnded() {
    return ended;
  }

  /** Waits until the time has passed or the alarm rings. */
  synchronized void pause(Duration time) throws InterruptedException {
    long end = System.nanoTime() + time.toNanos();
    for (long left = time.toNanos(); left > 0 && !rung && !ended; left = end - System.nanoTime()) {
      wait(left / 1_000_000, (int) (left % 1_000_000));
    }
    rung = false;
  }
}
