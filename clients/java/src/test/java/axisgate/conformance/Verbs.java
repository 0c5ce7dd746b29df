package axisgate.conformance;

import axisgate.Event;
import axisgate.EventOrGap;
import axisgate.Lease;
import axisgate.LeaseTerms;
import axisgate.Motion;
import axisgate.Position;
import axisgate.Result;
import axisgate.Scan;
import axisgate.Stage;
import axisgate.StagePath;
import axisgate.Updates;
import axisgate.v1.MotionState;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.TimeUnit;
import java.util.stream.Collectors;

/** One method for each verb of the scenario, and what earlier acts have made. */
final class Verbs implements AutoCloseable {
  private static final Map<String, Object> DONE = Map.of("outcome", "done");

  private final Map<String, Motion> motions = new HashMap<>();
  private final Map<String, Lease> leases = new HashMap<>();
  private final List<Long> revisions = new ArrayList<>();
  private Stage stage;
  private Updates<EventOrGap> events;

  Map<String, Object> act(String verb, Act act) {
    return switch (verb) {
      case "open" -> open(act);
      case "whoami" -> Map.of("outcome", "done", "role", stage.whoAmI().role());
      case "axes" -> Map.of("outcome", "done", "axes", axes());
      case "home" -> shown(stage.home(act.axes()));
      case "move_to" -> moveTo(act);
      case "move_by" -> shown(stage.axis(act.text("axis")).moveBy(act.amount("amount")));
      case "start" -> start(act);
      case "wait" -> await(act);
      case "cancel" -> done(() -> motions.get(act.text("motion")).cancel());
      case "stop" -> Map.of("outcome", "done", "stays_open", stage.stop().staysOpen());
      case "rearm" -> done(() -> stage.rearm());
      case "lease" -> lease(act);
      case "lost" -> lost(act);
      case "release" -> done(() -> leases.remove(act.text("lease")).release());
      case "path" -> path(act);
      case "scan" -> scan(act);
      case "events" -> done(() -> events = stage.events());
      case "succeeded" -> succeeded(act);
      case "saturate" -> saturate(act);
      default -> Map.of("outcome", "unexpected", "message", verb + ": no such act");
    };
  }

  private static Map<String, Object> done(Runnable action) {
    action.run();
    return DONE;
  }

  private static Map<String, Object> shown(Result result) {
    Map<String, String> positions =
        result.positions().stream().collect(Collectors.toMap(Position::axis, Position::value));
    return Map.of("outcome", "done", "positions", positions);
  }

  private Map<String, Object> open(Act act) {
    close();
    stage = Stage.open(act.connection());
    return DONE;
  }

  private List<List<Object>> axes() {
    return stage.axes().stream().map(axis -> List.<Object>of(axis.name(), axis.number())).toList();
  }

  private Map<String, Object> moveTo(Act act) {
    CompletableFuture<Void> interruption = new CompletableFuture<>();
    if (act.has("interrupt_after")) {
      long delay = act.seconds("interrupt_after").toMillis();
      interruption
          .completeOnTimeout(null, delay, TimeUnit.MILLISECONDS)
          .thenRun(Thread.currentThread()::interrupt);
    }
    return shown(stage.axis(act.text("axis")).moveTo(act.amount("amount"), act.options()));
  }

  private Map<String, Object> start(Act act) {
    Motion motion = stage.axis(act.text("axis")).start(act.amount("amount"), act.options());
    motions.put(act.text("motion"), motion);
    return Map.of("outcome", "started");
  }

  private Map<String, Object> await(Act act) {
    Motion motion = motions.get(act.text("motion"));
    return shown(act.has("timeout") ? motion.await(act.seconds("timeout")) : motion.await());
  }

  private Map<String, Object> lease(Act act) {
    LeaseTerms terms = LeaseTerms.of(act.axes()).withTtl(act.seconds("ttl"));
    leases.put(act.text("lease"), stage.lease(terms));
    return DONE;
  }

  private Map<String, Object> lost(Act act) {
    Lease lease = leases.get(act.text("lease"));
    long limit = act.seconds("within").toMillis();
    lease.lost().completeOnTimeout(null, limit, TimeUnit.MILLISECONDS).join();
    return Map.of("outcome", "done", "lost", lease.isLost());
  }

  private Map<String, Object> path(Act act) {
    StagePath path = new StagePath(act.texts("axes"), act.points()).withSpeed(act.speed());
    return shown(stage.path(path).await());
  }

  private Map<String, Object> scan(Act act) {
    Scan scan =
        new Scan(act.text("axis"), act.amount("from"), act.amount("to"), act.amount("every"));
    var pulses = stage.scan(scan.withSpeed(act.speed())).await().scan().orElseThrow();
    return Map.of(
        "outcome", "done",
        "expected", pulses.expectedInRange().orElseThrow(),
        "observed_equals_expected", pulses.observed().equals(pulses.expected()));
  }

  /** Reads events until so many motions have succeeded. */
  private Map<String, Object> succeeded(Act act) {
    int gaps = 0;
    for (int ended = 0; ended < act.number("count"); ) {
      if (!(events.next() instanceof Event event)) {
        gaps++;
        continue;
      }
      revisions.add(event.revision());
      if (event.message().getMotion().getState() == MotionState.MOTION_STATE_SUCCEEDED) {
        ended++;
      }
    }
    boolean ascending = revisions.stream().sorted().distinct().toList().equals(revisions);
    return Map.of("outcome", "done", "ascending", ascending, "gaps", gaps);
  }

  private Map<String, Object> saturate(Act act) {
    for (int call = 0; call < act.number("calls"); call++) {
      motions.get(act.text("motion")).toFuture();
    }
    return DONE;
  }

  @Override
  public void close() {
    if (stage != null) {
      stage.close();
    }
  }
}
