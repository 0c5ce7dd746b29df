package axisgate;

import java.util.Optional;

/** A Source is how a series of updates begins, and what its answers become. */
interface Source<A, T> {
  /** Sends the request for the updates that were not received yet. */
  Call<?, A> begin();

  T item(A answer);

  /**
   * Returns the item for answers that can no longer be received. Empty: the failure is another one.
   */
  default Optional<T> skip(Failure failure) {
    return Optional.empty();
  }
}
