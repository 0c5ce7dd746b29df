/**
 * Client of Axisgate, the gateway for stage controllers and mills.
 *
 * <pre>{@code
 * import static axisgate.Units.mm;
 *
 * try (var stage = Stage.open()) {
 *   System.out.println(stage.axis("x").moveTo(mm("1.5")));
 * } catch (Refused e) {
 *   System.out.println(e.reason() + " " + e.hint());
 * }
 * }</pre>
 *
 * <p>{@link axisgate.Refused} means that nothing moved. The other errors of the daemon are {@link
 * axisgate.Stopped}, {@link axisgate.MotionFailed} and {@link axisgate.OutcomeUnknown}. A wrong
 * argument is an {@link IllegalArgumentException} or a {@link NullPointerException}, found before
 * anything is sent. A call on a closed object throws {@link IllegalStateException}.
 *
 * <p>A lost answer makes no difference: the request is sent again with the same id, and the daemon
 * acts once.
 *
 * <p>An interruption of the thread ends the call with {@link axisgate.Interrupted}, and stops
 * nothing that has started, with one exception: methods that move and wait in one step, such as
 * {@link axisgate.Axis#moveTo}, then cancel their motion. They return once the daemon has answered,
 * or the time limit of the call has passed. Methods that end something, such as {@link
 * axisgate.Stage#stop} and {@link axisgate.Motion#cancel}, are sent even if the thread is
 * interrupted. The interrupted status of the thread stays set.
 */
package axisgate;
