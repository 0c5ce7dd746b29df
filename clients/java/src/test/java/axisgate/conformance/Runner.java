package axisgate.conformance;

import axisgate.AxisgateException;
import axisgate.Interrupted;
import axisgate.MotionFailed;
import axisgate.OutcomeUnknown;
import axisgate.Refused;
import axisgate.Stopped;
import axisgate.WaitTimeout;
import com.google.gson.Gson;
import com.google.gson.JsonObject;
import com.google.gson.JsonParser;
import java.io.BufferedReader;
import java.io.IOException;
import java.io.InputStreamReader;
import java.nio.charset.StandardCharsets;
import java.util.Map;
import java.util.NoSuchElementException;

/** Translates the acts of the conformance scenario, one JSON object on a line each way. */
final class Runner {
  private static final Gson GSON = new Gson();

  private Runner() {}

  public static void main(String[] arguments) throws IOException {
    try (Verbs verbs = new Verbs();
        var lines = new BufferedReader(new InputStreamReader(System.in, StandardCharsets.UTF_8))) {
      for (String line = lines.readLine(); line != null; line = lines.readLine()) {
        System.out.println(GSON.toJson(reply(verbs, line)));
      }
    }
  }

  private static Map<String, Object> reply(Verbs verbs, String line) {
    JsonObject json = JsonParser.parseString(line).getAsJsonObject();
    try {
      return verbs.act(json.get("say").getAsString(), new Act(json));
    } catch (AxisgateException e) {
      var problem = e.problem();
      return Map.of(
          "outcome", outcomeOf(e),
          "reason", problem.reason(),
          "message", problem.message(),
          "hint", problem.hint(),
          "axis", problem.axis());
    } catch (Interrupted e) {
      return outcome(Thread.interrupted() ? "interrupted" : "unexpected", e);
    } catch (WaitTimeout e) {
      return outcome("timeout", e);
    } catch (IllegalArgumentException | NullPointerException | NoSuchElementException e) {
      return outcome("local", e);
    }
  }

  private static Map<String, Object> outcome(String outcome, RuntimeException error) {
    return Map.of("outcome", outcome, "message", String.valueOf(error.getMessage()));
  }

  private static String outcomeOf(AxisgateException error) {
    if (error instanceof Refused) {
      return "refused";
    } else if (error instanceof Stopped) {
      return "stopped";
    } else if (error instanceof MotionFailed) {
      return "failed";
    }
    return error instanceof OutcomeUnknown ? "unknown" : "unexpected";
  }
}
