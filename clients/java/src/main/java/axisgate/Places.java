package axisgate;

import axisgate.v1.DeletePositionRequest;
import axisgate.v1.ListPositionsRequest;
import axisgate.v1.MoveToPositionRequest;
import axisgate.v1.MoveToPositionResponse;
import axisgate.v1.PositionKind;
import axisgate.v1.PositionServiceGrpc;
import axisgate.v1.SavePositionRequest;
import java.time.Duration;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.OptionalLong;

/** Places are the saved positions of a stage, by name. Thread safe. */
public final class Places {
  /** Time that saving may wait for the end of a running motion. */
  private static final Duration SAVE_TIME = Duration.ofSeconds(20);

  private final Session session;

  Places(Session session) {
    this.session = session;
  }

  /**
   * Saves the present position. It stays the same place when coordinates are set again.
   *
   * @param name name of the place
   */
  public void save(String name) {
    save(name, PositionKind.POSITION_KIND_PLACE);
  }

  /**
   * Saves the coordinates of the present position. They stay the same when coordinates are set
   * again.
   *
   * @param name name of the place
   */
  public void saveCoordinates(String name) {
    save(name, PositionKind.POSITION_KIND_COORDINATES);
  }

  private void save(String name, PositionKind kind) {
    var request =
        SavePositionRequest.newBuilder().setPosition(resource(name)).setKind(kind).build();
    session.change(
        PositionServiceGrpc.getSavePositionMethod(), request, SAVE_TIME, session.token());
  }

  /**
   * Moves all axes to a saved position, and waits for the outcome. An interruption of the thread
   * cancels the move.
   *
   * @param name name of the place
   * @return the result
   */
  public Result moveTo(String name) {
    var request = MoveToPositionRequest.newBuilder().setPosition(resource(name)).build();
    return session.finish(
        () ->
            session.start(
                PositionServiceGrpc.getMoveToPositionMethod(),
                request,
                MoveToPositionResponse::getMotion));
  }

  /**
   * Deletes a saved position.
   *
   * @param name name of the place
   */
  public void delete(String name) {
    var request = DeletePositionRequest.newBuilder().setPosition(resource(name)).build();
    session.change(PositionServiceGrpc.getDeletePositionMethod(), request);
  }

  /**
   * Returns the saved positions by name, with the positions of the axes when they were saved.
   *
   * @return the positions
   */
  public Map<String, List<Position>> list() {
    var request = ListPositionsRequest.newBuilder().setDevice(session.device).build();
    Map<String, List<Position>> places = new LinkedHashMap<>();
    for (var place :
        session.ask(PositionServiceGrpc.getListPositionsMethod(), request).getPositionsList()) {
      places.put(
          Names.last(place.getName()),
          place.getCoordinatesList().stream()
              .map(
                  one ->
                      new Position(
                          Names.axis(one.getName(), one.getAxis()),
                          one.getPosition(),
                          Unit.symbolOf(one.getUnitValue()),
                          OptionalLong.of(one.getPulses())))
              .toList());
    }
    return places;
  }

  private String resource(String name) {
    return session.device + "/positions/" + name;
  }
}
