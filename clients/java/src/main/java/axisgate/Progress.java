package axisgate;

import axisgate.v1.AxisResult;
import java.util.List;
import java.util.OptionalDouble;

/**
 * A Progress is how far a motion has come.
 *
 * @param fraction part of the distance that is covered, from 0 to 1. Empty if unknown
 * @param positions present positions of the axes of the motion
 * @param segment number of finished segments of a path
 */
public record Progress(OptionalDouble fraction, List<Position> positions, int segment) {
  /** Returns the progress from the states of the device at the first look and now. */
  static Progress of(axisgate.v1.Motion motion, Status first, Status now) {
    List<String> axes =
        motion.getResultsList().stream()
            .map(result -> Names.axis(result.getName(), result.getAxis()))
            .toList();
    OptionalDouble fraction =
        motion.getSegmentsTotal() > 0
            ? OptionalDouble.of((double) motion.getSegmentsDone() / motion.getSegmentsTotal())
            : motion.getResultsList().stream()
                .map(result -> covered(result, first, now))
                .flatMapToDouble(OptionalDouble::stream)
                .min();
    List<Position> positions =
        now.axes().stream()
            .filter(axis -> axes.contains(axis.name()))
            .map(AxisState::position)
            .toList();
    return new Progress(fraction, positions, motion.getSegmentsDone());
  }

  /** Returns the part of its distance that an axis has covered. Empty if unknown. */
  private static OptionalDouble covered(AxisResult result, Status first, Status now) {
    String name = Names.axis(result.getName(), result.getAxis());
    var from = first.axis(name).map(AxisState::position).map(Position::pulses);
    var at = now.axis(name).map(AxisState::position).map(Position::pulses);
    boolean known =
        result.hasTargetPulses()
            && from.isPresent()
            && from.get().isPresent()
            && at.isPresent()
            && at.get().isPresent();
    if (!known || result.getTargetPulses() == from.get().getAsLong()) {
      return OptionalDouble.empty();
    }
    long start = from.get().getAsLong();
    return OptionalDouble.of(
        (double) (at.get().getAsLong() - start) / (result.getTargetPulses() - start));
  }
}
