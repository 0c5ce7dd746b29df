package axisgate;

import java.time.Duration;
import java.util.function.Function;

/** An Attempt sends a request once, always with the same bytes. */
@FunctionalInterface
interface Attempt<A> {
  /** Returns the answer. Throws CallFailed if there is none within the limit. */
  A send(Duration limit) throws CallFailed, InterruptedException;

  /** Returns the attempt whose answer is what {@code part} makes of the answer. */
  default <B> Attempt<B> map(Function<A, B> part) {
    return limit -> part.apply(send(limit));
  }
}
