package axisgate;

import axisgate.v1.HomeRequest;
import axisgate.v1.HomeResponse;
import axisgate.v1.ListMotionsRequest;
import axisgate.v1.MoveResponse;
import axisgate.v1.ScanResponse;
import axisgate.v1.StageServiceGrpc;
import java.util.Iterator;
import java.util.List;
import java.util.Map;

/** The calls of a {@link Stage} that move axes. */
abstract sealed class MovingDevice extends Device permits Stage {
  MovingDevice(Session session) {
    super(session);
  }

  /**
   * Checks a move as far as possible without moving. Throws the error of a move that would be
   * refused.
   *
   * @param targets positions by the names or numbers of their axes
   * @param options terms of the move
   */
  public void check(Map<String, Distance> targets, MoveOption... options) {
    var request = Requests.move(session.device, targets, false, options);
    session.change(
        StageServiceGrpc.getMoveMethod(), request.toBuilder().setValidateOnly(true).build());
  }

  /**
   * Starts a move of some axes, all at once.
   *
   * @param targets positions by the names or numbers of their axes
   * @param options terms of the move
   * @return the motion
   */
  public Motion start(Map<String, Distance> targets, MoveOption... options) {
    return startMove(targets, false, options);
  }

  /**
   * Does the same as {@link #start} with displacements from the present positions.
   *
   * @param displacements displacements by the names or numbers of their axes
   * @param options terms of the move
   * @return the motion
   */
  public Motion startBy(Map<String, Distance> displacements, MoveOption... options) {
    return startMove(displacements, true, options);
  }

  /**
   * Moves axes, all at once, and waits for the outcome. An interruption of the thread cancels the
   * move.
   *
   * @param targets positions by the names or numbers of their axes
   * @param options terms of the move
   * @return the result
   * @throws Refused if nothing moved
   * @throws Stopped if a stop ended the move
   * @throws MotionFailed if the move ended with an error
   * @throws OutcomeUnknown if the outcome could not be seen
   * @throws Interrupted if the thread is interrupted
   */
  public Result moveTo(Map<String, Distance> targets, MoveOption... options) {
    return session.finish(() -> start(targets, options));
  }

  /**
   * Does the same as {@link #moveTo} with displacements from the present positions.
   *
   * @param displacements displacements by the names or numbers of their axes
   * @param options terms of the move
   * @return the result
   */
  public Result moveBy(Map<String, Distance> displacements, MoveOption... options) {
    return session.finish(() -> startBy(displacements, options));
  }

  private Motion startMove(Map<String, Distance> targets, boolean relative, MoveOption... options) {
    var request = Requests.move(session.device, targets, relative, options);
    return session.start(StageServiceGrpc.getMoveMethod(), request, MoveResponse::getMotion);
  }

  /**
   * Homes axes, and waits for the outcome. An interruption of the thread cancels the motion.
   *
   * @param axes names or numbers of the axes. None: all axes
   * @return the result
   */
  public Result home(String... axes) {
    var request =
        HomeRequest.newBuilder().setDevice(session.device).addAllAxes(List.of(axes)).build();
    return session.finish(
        () -> session.start(StageServiceGrpc.getHomeMethod(), request, HomeResponse::getMotion));
  }

  /**
   * Does the same as {@link #home} for those of the axes that the daemon has not homed yet.
   *
   * @param axes names or numbers of the axes. None: all axes
   * @return the result; without positions if all are homed
   */
  public Result homeIfNeeded(String... axes) {
    List<String> chosen = List.of(axes);
    String[] needed =
        Status.of(session.read(null)).knownAxes().stream()
            .filter(axis -> !axis.homed())
            .filter(
                axis ->
                    chosen.isEmpty()
                        || chosen.contains(axis.name())
                        || chosen.contains(Integer.toString(axis.number())))
            .map(AxisState::name)
            .toArray(String[]::new);
    return needed.length == 0 ? Result.NONE : home(needed);
  }

  /**
   * Starts a path, through whose points the axes move without a halt. All points are read before
   * the path starts, so nothing moves if their iterator throws an exception.
   *
   * @param path the path
   * @return the motion
   */
  public Motion path(StagePath path) {
    return PathRun.start(session, path.segments());
  }

  /**
   * Moves to one point of the path after another. Each step of the iteration moves, and returns the
   * result once the axes are stationary. An interruption of the thread cancels the present move.
   * Use this under a lease, so that nobody else moves the axes in between.
   *
   * @param path the path
   * @return the results
   */
  public Iterable<Result> visit(StagePath path) {
    return () -> {
      Iterator<List<Distance>> points = path.points().iterator();
      return new Iterator<>() {
        @Override
        public boolean hasNext() {
          return points.hasNext();
        }

        @Override
        public Result next() {
          return moveTo(path.targets(points.next()), path.moveOptions());
        }
      };
    };
  }

  /**
   * Starts a scan. {@link Result#scan} has the expected and the observed number of pulses.
   *
   * @param scan the scan
   * @return the motion
   */
  public Motion scan(Scan scan) {
    return session.start(
        StageServiceGrpc.getScanMethod(), scan.request(session.device), ScanResponse::getMotion);
  }

  /**
   * Returns the newest 100 motions, newest first, also those of other callers.
   *
   * @return the motions
   */
  public List<Motion> motions() {
    var request = ListMotionsRequest.newBuilder().setDevice(session.device).build();
    return session.ask(StageServiceGrpc.getListMotionsMethod(), request).getMotionsList().stream()
        .map(motion -> new Motion(session, motion))
        .toList();
  }

  /**
   * Runs axes until the jog is stopped or closed.
   *
   * @param speeds speeds by the names or numbers of their axes; negative in the minus direction
   * @return the jog
   */
  public Jog jog(Map<String, Speed> speeds) {
    return Jog.start(session, speeds);
  }

  /**
   * Sends lines in the controller's own language, once, and returns its answers.
   *
   * @param lines the lines
   * @return the answers, and the motion that the lines started
   * @throws Refused if nothing moved
   * @throws MotionFailed if the controller refused a line after others that may move
   * @throws OutcomeUnknown if it is unknown whether a line was executed
   */
  public Executed execute(String... lines) {
    return new Execution(session).run(List.of(lines));
  }
}
