package axisgate;

import axisgate.v1.AxisDistance;
import axisgate.v1.Line;
import axisgate.v1.Segment;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import java.util.Optional;
import java.util.TreeMap;

/**
 * A StagePath is a series of points for some axes.
 *
 * @param axes names or numbers of the axes
 * @param points points, each with one position for each axis, in the order of the axes
 * @param speed speed along the path. Empty: the present speed profiles of the axes
 */
public record StagePath(List<String> axes, Iterable<List<Distance>> points, Optional<Speed> speed) {

  /**
   * Makes a path with the present speed profiles of the axes.
   *
   * @param axes names or numbers of the axes
   * @param points points, each with one position for each axis, in the order of the axes
   */
  public StagePath(List<String> axes, Iterable<List<Distance>> points) {
    this(axes, points, Optional.empty());
  }

  /**
   * Returns the same path with a speed.
   *
   * @param speed speed along the path
   * @return the path
   */
  public StagePath withSpeed(Speed speed) {
    return new StagePath(axes, points, Optional.of(speed));
  }

  /** Reads all points. */
  List<Segment> segments() {
    List<Segment> segments = new ArrayList<>();
    points.forEach(point -> segments.add(segment(point)));
    return segments;
  }

  /** Returns the targets of a move to a point. */
  Map<String, Distance> targets(List<Distance> point) {
    check(point);
    Map<String, Distance> targets = new TreeMap<>();
    for (int at = 0; at < axes.size(); at++) {
      targets.put(axes.get(at), point.get(at));
    }
    return targets;
  }

  MoveOption[] moveOptions() {
    return speed.stream().map(MoveOption::speed).toArray(MoveOption[]::new);
  }

  /** Returns the piece of the path that leads to a point. */
  private Segment segment(List<Distance> point) {
    check(point);
    Line.Builder line = Line.newBuilder();
    for (int at = 0; at < axes.size(); at++) {
      line.addDistances(
          AxisDistance.newBuilder()
              .setAxis(axes.get(at))
              .setDistance(Distance.message(point.get(at))));
    }
    Segment.Builder segment = Segment.newBuilder();
    speed.ifPresent(given -> segment.setSpeed(Speed.message(given)));
    return axes.size() == 1
        ? segment.setSingle(line.getDistances(0)).build()
        : segment.setLine(line).build();
  }

  private void check(List<Distance> point) {
    if (axes.isEmpty() || point.size() != axes.size()) {
      throw new IllegalArgumentException(
          "a point has " + point.size() + " distances for " + axes.size() + " axes");
    }
  }
}
