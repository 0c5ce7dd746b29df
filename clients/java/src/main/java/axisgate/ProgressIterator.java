package axisgate;

import java.time.Duration;
import java.util.Iterator;
import java.util.NoSuchElementException;

/** Iterates over the progress of a motion until its outcome. Not thread safe. */
final class ProgressIterator implements Iterator<Progress> {
  private final Motion motion;
  private final Session session;
  private final Duration interval;
  private Status first;
  private Progress next;

  ProgressIterator(Motion motion, Session session, Duration interval) {
    this.motion = motion;
    this.session = session;
    this.interval = interval;
  }

  @Override
  public boolean hasNext() {
    if (next == null && !motion.followUntil(Times.now().plus(interval))) {
      Status now = Status.of(session.read(null));
      first = first == null ? now : first;
      next = Progress.of(motion.message(), first, now);
    }
    return next != null;
  }

  @Override
  public Progress next() {
    if (!hasNext()) {
      throw new NoSuchElementException();
    }
    Progress progress = next;
    next = null;
    return progress;
  }
}
