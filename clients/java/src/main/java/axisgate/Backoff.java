package axisgate;

import java.time.Duration;

/** A Backoff is a series of pauses, each twice as long as the previous one. */
final class Backoff {
  static final Duration FIRST = Duration.ofMillis(250);
  static final Duration LONGEST = Duration.ofSeconds(5);

  private Duration next = FIRST;

  Duration pause() {
    Duration pause = next;
    next = Times.shorter(pause.multipliedBy(2), LONGEST);
    return pause;
  }

  /** Begins with the shortest pause again. */
  void reset() {
    next = FIRST;
  }
}
