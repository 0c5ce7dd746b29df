import static axisgate.Units.um;

import axisgate.ConnectOptions;
import axisgate.LeaseTerms;
import axisgate.Result;
import axisgate.Stage;
import java.time.Duration;
import java.util.Map;

/**
 * Measures at each point of a raster, all night long. It survives a connection that is broken for
 * up to a minute: no move is lost, and none is made twice. It ends if the stage needs a person.
 */
final class Raster {
  /** Longest time without a connection. */
  private static final Duration OUTAGE = Duration.ofMinutes(1);

  private static final int SIDE = 8;
  private static final int STEP_UM = 20;

  private Raster() {}

  public static void main(String[] arguments) {
    var terms = LeaseTerms.of("x", "y").withTtl(OUTAGE.multipliedBy(2));
    try (var stage = Stage.open(new ConnectOptions().timeout(OUTAGE.multipliedBy(2)));
        var lease = stage.lease(terms.withFinishAtLoss().withPurpose("overnight raster"))) {
      stage.homeIfNeeded("x", "y");
      for (int place = 0; place < SIDE * SIDE && !lease.isLost(); place++) {
        var x = um(STEP_UM * (place % SIDE));
        var y = um(STEP_UM * (place / SIDE));
        measure(stage.moveTo(Map.of("x", x, "y", y)));
      }
    }
  }

  /** Stands for what a program does at each point. */
  private static void measure(Result at) {
    System.out.println(at);
  }
}
