package axisgate;

/** A CallFailed carries the failure of one attempt to the code that decides what follows. */
final class CallFailed extends Exception {
  private static final long serialVersionUID = 1;

  final transient Failure failure;

  CallFailed(Failure failure) {
    super(failure.text());
    this.failure = failure;
  }
}
