package axisgate.conformance;

import axisgate.ConnectOptions;
import axisgate.Distance;
import axisgate.MoveOption;
import axisgate.Speed;
import axisgate.Units;
import com.google.gson.JsonArray;
import com.google.gson.JsonElement;
import com.google.gson.JsonObject;
import java.time.Duration;
import java.util.ArrayList;
import java.util.Iterator;
import java.util.List;
import java.util.NoSuchElementException;

/** An act of the scenario: the arguments of one call. */
record Act(JsonObject json) {
  boolean has(String key) {
    return json.has(key);
  }

  String text(String key) {
    return json.has(key) ? json.get(key).getAsString() : null;
  }

  int number(String key) {
    return json.get(key).getAsInt();
  }

  Duration seconds(String key) {
    double seconds = json.has(key) ? json.get(key).getAsDouble() : 0;
    return Duration.ofNanos((long) (seconds * 1e9));
  }

  String[] axes() {
    return texts("axes").toArray(String[]::new);
  }

  List<String> texts(String key) {
    JsonArray array = json.has(key) ? json.getAsJsonArray(key) : new JsonArray();
    return array.asList().stream().map(JsonElement::getAsString).toList();
  }

  /** Returns a text as an exact amount. Null, which no call takes, for a number without a unit. */
  Distance amount(String key) {
    JsonObject amount = json.getAsJsonObject(key);
    if (!amount.has("unit")) {
      return null;
    }
    boolean mm = amount.get("unit").getAsString().equals("mm");
    if (amount.has("text")) {
      String text = amount.get("text").getAsString();
      return mm ? Units.mm(text) : Units.um(text);
    }
    double number = floating(amount.get("number").getAsString());
    return mm ? Units.mm(number) : Units.um(number);
  }

  private static double floating(String text) {
    return switch (text) {
      case "nan" -> Double.NaN;
      case "inf" -> Double.POSITIVE_INFINITY;
      default -> Double.parseDouble(text);
    };
  }

  Speed speed() {
    return amount("speed").perSecond();
  }

  MoveOption[] options() {
    return has("speed") ? new MoveOption[] {MoveOption.speed(speed())} : new MoveOption[0];
  }

  /** Returns the points of a line, which fail after a while if the act says so. */
  Iterable<List<Distance>> points() {
    return () ->
        new Iterator<>() {
          private int place;

          @Override
          public boolean hasNext() {
            return place < number("count");
          }

          @Override
          public List<Distance> next() {
            place++;
            if (has("fails_after") && place > number("fails_after")) {
              throw new NoSuchElementException("there is no such point");
            }
            List<Distance> point = new ArrayList<>();
            for (String step : texts("step")) {
              point.add(Units.um((long) place * Integer.parseInt(step)));
            }
            return point;
          }
        };
  }

  ConnectOptions connection() {
    var options = new ConnectOptions().target(text("target"));
    options.token(text("token")).ca(text("ca"));
    return options.certificate(text("certificate"), text("key"));
  }
}
