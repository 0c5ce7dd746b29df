package axisgate;

import axisgate.v1.AcquireLeaseRequest;
import axisgate.v1.AtLoss;
import java.time.Duration;
import java.util.List;

/**
 * LeaseTerms are the terms of a lease.
 *
 * @param axes names or numbers of the axes. Empty: the whole device
 * @param longestWait longest wait for the axes. 0: do not wait
 * @param ttl time after which the lease ends when the program or the connection has failed
 * @param finishAtLoss true if a running motion ends first when the lease is lost; otherwise it is
 *     stopped
 * @param purpose text for other callers; may be empty
 */
public record LeaseTerms(
    List<String> axes, Duration longestWait, Duration ttl, boolean finishAtLoss, String purpose) {

  /**
   * Returns terms without a wait and a purpose, with a ttl of 10 s.
   *
   * @param axes names or numbers of the axes. None: the whole device
   * @return the terms
   */
  public static LeaseTerms of(String... axes) {
    return new LeaseTerms(List.of(axes), Duration.ZERO, Duration.ofSeconds(10), false, "");
  }

  /**
   * Returns the same terms with a wait.
   *
   * @param longest longest wait for the axes
   * @return the terms
   */
  public LeaseTerms withWait(Duration longest) {
    return new LeaseTerms(axes, longest, ttl, finishAtLoss, purpose);
  }

  /**
   * Returns the same terms with a time to live.
   *
   * @param time time after which the lease ends when the program or the connection has failed
   * @return the terms
   */
  public LeaseTerms withTtl(Duration time) {
    return new LeaseTerms(axes, longestWait, time, finishAtLoss, purpose);
  }

  /**
   * Returns the same terms, but a running motion ends first when the lease is lost.
   *
   * @return the terms
   */
  public LeaseTerms withFinishAtLoss() {
    return new LeaseTerms(axes, longestWait, ttl, true, purpose);
  }

  /**
   * Returns the same terms with a purpose.
   *
   * @param text text for other callers
   * @return the terms
   */
  public LeaseTerms withPurpose(String text) {
    return new LeaseTerms(axes, longestWait, ttl, finishAtLoss, text);
  }

  AcquireLeaseRequest request(String device) {
    AcquireLeaseRequest.Builder request = AcquireLeaseRequest.newBuilder().setDevice(device);
    request
        .getTermsBuilder()
        .addAllAxes(axes)
        .setTimeToLive(Times.message(ttl))
        .setAtLoss(finishAtLoss ? AtLoss.AT_LOSS_FINISH : AtLoss.AT_LOSS_STOP)
        .setPurpose(purpose);
    if (!longestWait.isZero()) {
      request.setWait(Times.message(longestWait));
    }
    return request.build();
  }
}
