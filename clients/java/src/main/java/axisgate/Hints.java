package axisgate;

import static java.util.Map.entry;

import java.util.List;
import java.util.Map.Entry;

/** Translates the hints of the API into the terms of this package. */
final class Hints {
  /**
   * Calls that the hints name, and the methods of this package. A call with a field comes before
   * the same call alone. "{}" is the axis in quotes, or {@code axis}.
   */
  private static final List<Entry<String, String>> ROWS =
      List.of(
          entry("`AbortJob`", "`mill.abort()`"),
          entry("`AcquireLease`", "`stage.lease({})`"),
          entry("`CancelJob`", "`mill.cancel(job)`"),
          entry("`ChangeSettings`", "`stage.changeSettings(...)`"),
          entry("`ClearErrors`", "`stage.clearErrors()`"),
          entry("`ConfirmJob`", "`mill.confirm(job)`"),
          entry("`DeletePosition`", "`stage.places().delete(name)`"),
          entry("`Execute`", "`stage.execute(line)`"),
          entry("`GetDevice`", "`stage.status()`"),
          entry("`GetMill`", "`mill.read()`"),
          entry("`GetSettings`", "`stage.settings()`"),
          entry("`Home`", "`stage.home({})`"),
          entry("`Jog`", "`stage.jog(...)`"),
          entry("`ListMotions`", "`stage.motions()`"),
          entry("`ListPositions`", "`stage.places().list()`"),
          entry("`Move`", "`stage.moveTo(...)`"),
          entry("`PauseJob` with `raise_tool`", "`mill.pause(true)`"),
          entry("`Rearm`", "`stage.rearm()`"),
          entry("`ReportJobDone`", "`mill.reportDone(job)`"),
          entry("`ResumeJob`", "`mill.resume()`"),
          entry("`SavePosition`", "`stage.places().save(name)`"),
          entry("`SendJob`", "`mill.send(...)`"),
          entry("`Stop`", "`stage.stop()`"),
          entry("`WatchMill`", "`mill.watch()`"));

  private Hints() {}

  /** Returns the hint with each call replaced by a method of this package. Axis 0: no axis. */
  static String withMethods(String hint, int axis) {
    String argument = axis == 0 ? "axis" : "\"" + axis + "\"";
    String text = hint;
    for (Entry<String, String> row : ROWS) {
      text = text.replace(row.getKey(), row.getValue().replace("{}", argument));
    }
    return text;
  }
}
