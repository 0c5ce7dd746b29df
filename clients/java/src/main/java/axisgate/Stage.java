package axisgate;

import axisgate.v1.Capability;
import axisgate.v1.ChangeSettingsRequest;
import axisgate.v1.ClearErrorsRequest;
import axisgate.v1.ControlServiceGrpc;
import axisgate.v1.DeviceServiceGrpc;
import axisgate.v1.EmergencyStopRequest;
import axisgate.v1.GetSettingsRequest;
import axisgate.v1.RearmRequest;
import axisgate.v1.SettingServiceGrpc;
import axisgate.v1.Settings;
import axisgate.v1.StageServiceGrpc;
import axisgate.v1.StopRequest;
import java.time.Duration;
import java.util.List;

/**
 * A Stage is the connection to one device that moves axes. Axes are named as in the configuration,
 * or by their numbers: "x", "1".
 *
 * <p>Every method throws {@link Refused} if the daemon refuses a request: nothing moved. Thread
 * safe.
 */
public final class Stage extends MovingDevice {
  /** Longest time until the answer to a stop, which then has what is known. */
  private static final Duration STOP_TIME = Duration.ofSeconds(4);

  /** Time for which a change of settings may wait for running commands. */
  private static final Duration CHANGE_TIME = Duration.ofSeconds(20);

  private final List<Axis> axes;

  private Stage(Session session) {
    super(session);
    axes = Status.of(session.opened).axes().stream().map(state -> new Axis(this, state)).toList();
  }

  /**
   * Connects to the local daemon, or to that of the environment variables, and its only stage.
   *
   * @return the stage
   * @throws Unavailable if no daemon answers
   */
  public static Stage open() {
    return open(new ConnectOptions());
  }

  /**
   * Connects to a daemon and a stage.
   *
   * @param options names of the daemon and the stage, and other options
   * @return the stage
   * @throws Unavailable if no daemon answers
   * @throws IllegalArgumentException if there is no such stage, or the options contradict each
   *     other
   */
  public static Stage open(ConnectOptions options) {
    return new Stage(Session.open(options, Capability.CAPABILITY_MOVE));
  }

  /**
   * Returns the axes that can be moved, in the order of their numbers.
   *
   * @return the axes
   */
  public List<Axis> axes() {
    return axes;
  }

  /**
   * Returns an axis.
   *
   * @param name name or number of the axis
   * @return the axis
   * @throws IllegalArgumentException if there is no such axis
   */
  public Axis axis(String name) {
    return axes.stream()
        .filter(axis -> axis.is(name))
        .findFirst()
        .orElseThrow(
            () ->
                new IllegalArgumentException(
                    name() + " has no axis " + name + "; its axes are " + Result.joined(axes)));
  }

  /**
   * Returns the newest known state of the device.
   *
   * @return the state
   */
  public Status status() {
    return Status.of(session.read(null));
  }

  /**
   * Returns the state of the device, which is read from the controller if it is older than {@code
   * maxAge}.
   *
   * @param maxAge maximum age of the known state
   * @return the state
   */
  public Status status(Duration maxAge) {
    return Status.of(session.read(maxAge));
  }

  /**
   * Returns the newest state of the device, now and after every change. A slow reader skips states.
   *
   * @param interval minimum time between two states
   * @return the states
   */
  public Updates<Status> watch(Duration interval) {
    return new Updates<>(
        session.connection(),
        new StatusSource(session.connection().channel, session.device, interval));
  }

  /**
   * Returns every event from now on, each once and in order, also over broken connections and
   * restarts of the daemon. A {@link Gap} in the series means that events were missed.
   *
   * @return the events
   */
  public Updates<EventOrGap> events() {
    return watchEvents(Cursor.fromNow(session.device, session.calls.list()));
  }

  /**
   * Does the same as {@link #events} from a revision on.
   *
   * @param revision first revision. 0: all kept events
   * @return the events
   */
  public Updates<EventOrGap> eventsFrom(long revision) {
    return watchEvents(Cursor.from(session.device, revision));
  }

  /**
   * Does the same as {@link #events} from the successor of an event on.
   *
   * @param last last event that was received
   * @return the events
   */
  public Updates<EventOrGap> eventsAfter(Event last) {
    return watchEvents(Cursor.after(session.device, last.message()));
  }

  private Updates<EventOrGap> watchEvents(Cursor cursor) {
    return new Updates<>(
        session.connection(), new EventSource(session.connection().channel, cursor));
  }

  /**
   * Returns the saved positions of the stage.
   *
   * @return the places
   */
  public Places places() {
    return new Places(session);
  }

  /**
   * Reads the settings of the stage from the controller, as the API's message.
   *
   * @return the settings
   */
  public Settings settings() {
    var request = GetSettingsRequest.newBuilder().setDevice(session.device).build();
    return session.ask(SettingServiceGrpc.getGetSettingsMethod(), request).getSettings();
  }

  /**
   * Changes the settings that are set in the API's message, and no others. Speeds, outputs and the
   * trigger that are set under a lease return to their values after it.
   *
   * @param settings settings to change
   */
  public void changeSettings(Settings settings) {
    var request =
        ChangeSettingsRequest.newBuilder().setDevice(session.device).setSettings(settings).build();
    session.change(
        SettingServiceGrpc.getChangeSettingsMethod(), request, CHANGE_TIME, session.token());
  }

  /**
   * Slows down and stops axes. It needs no lease, and is sent even if the thread is interrupted. It
   * is sent again for half of the time limit if no daemon answers. Not a safety function.
   *
   * @param names names or numbers of the axes. None: all axes of the stage
   * @return what was seen within 4 s
   * @throws OutcomeUnknown if the stop may not have reached the daemon
   */
  public StopReport stop(String... names) {
    var request =
        StopRequest.newBuilder()
            .setContext(session.leaseContext())
            .setDevice(session.device)
            .addAllAxes(List.of(names))
            .setMaxWait(Times.message(STOP_TIME))
            .build();
    var answer = session.calls.stop(StageServiceGrpc.getStopMethod(), request);
    return StopReport.of(answer.getDevicesList(), answer.getStaysOpen());
  }

  /**
   * Stops all axes at once without slowing down. Nothing moves until {@link #clearErrors}.
   * Otherwise the same as {@link #stop}. Not a safety function.
   *
   * @return what was seen within 4 s
   */
  public StopReport emergencyStop() {
    var request =
        EmergencyStopRequest.newBuilder()
            .setContext(session.leaseContext())
            .setDevice(session.device)
            .setMaxWait(Times.message(STOP_TIME))
            .build();
    var answer = session.calls.stop(StageServiceGrpc.getEmergencyStopMethod(), request);
    return StopReport.of(answer.getDevicesList(), answer.getStaysOpen());
  }

  /**
   * Allows motion after a stop by another caller.
   *
   * @return the numbers of the axes that may move again
   */
  public List<Integer> rearm() {
    var request = RearmRequest.newBuilder().setDevice(session.device).build();
    return session.change(ControlServiceGrpc.getRearmMethod(), request).getAxesList();
  }

  /**
   * Clears limit, overflow and emergency errors. Starts no motion.
   *
   * @param names names or numbers of the axes. None: all axes
   */
  public void clearErrors(String... names) {
    var request =
        ClearErrorsRequest.newBuilder()
            .setDevice(session.device)
            .addAllAxes(List.of(names))
            .build();
    session.change(DeviceServiceGrpc.getClearErrorsMethod(), request);
  }
}
