package axisgate;

import java.util.Iterator;
import java.util.NoSuchElementException;

/**
 * Updates are a series of items that continues after a broken connection. {@link #hasNext} waits
 * for the next item; it returns false after {@link #close}, and throws {@link Interrupted} if the
 * thread is interrupted. The iteration can be left and continued. Thread safe; each item is
 * delivered to one thread.
 *
 * @param <T> type of the items
 */
public final class Updates<T> implements Iterable<T>, Iterator<T>, AutoCloseable {
  private final Resuming<?, T> series;
  private T next;

  <A> Updates(Connection connection, Source<A, T> source) {
    series = new Resuming<>(connection, source);
  }

  @Override
  public Iterator<T> iterator() {
    return this;
  }

  @Override
  public synchronized boolean hasNext() {
    if (next == null) {
      try {
        next = series.next().orElse(null);
      } catch (InterruptedException e) {
        throw Connection.interrupted();
      }
    }
    return next != null;
  }

  @Override
  public synchronized T next() {
    if (!hasNext()) {
      throw new NoSuchElementException("the series was closed");
    }
    T item = next;
    next = null;
    return item;
  }

  /** Ends the series, also for another thread that waits for an item. */
  @Override
  public void close() {
    series.close();
  }
}
