"""Translation of the API's hints, which name calls, to the methods of this package."""

from __future__ import annotations

# A call with a field comes before the same call alone. "{}" is the axis in quotes, or `axis`.
_ROWS = (
    ("`AbortJob`", "`mill.abort()`"),
    ("`AcquireLease`", "`stage.lease({})`"),
    ("`CancelJob`", "`mill.cancel(job)`"),
    ("`ChangeSettings` with `sleeping`", "`stage.settings.write(...)` with `sleeping`"),
    ("`ChangeSettings` with `excited`", "`stage.settings.change({}, motor_on=True)`"),
    ("`ChangeSettings` with `speeds`", "`stage.settings.change({}, minimum_speed=..., maximum_speed=...)`"),
    ("`ChangeSettings`", "`stage.settings.write(...)`"),
    ("`ClearErrors`", "`stage.clear_errors()`"),
    ("`ConfirmJob`", "`mill.confirm(job)`"),
    ("`DeletePosition`", "`stage.places.delete(name)`"),
    ("`Execute`", "`stage.execute(line)`"),
    ("`GetDevice`", "`stage.status()`"),
    ("`GetMill`", "`mill.read()`"),
    ("`GetSettings`", "`stage.settings.read()`"),
    ("`Home`", "`stage.home({})`"),
    ("`Jog`", "`stage.jog(...)`"),
    ("`ListMotions`", "`stage.motions()`"),
    ("`ListPositions`", "`stage.places`"),
    ("`Move`", "`stage.move_to(...)`"),
    ("`PauseJob` with `raise_tool`", "`mill.pause(raise_tool=True)`"),
    ("acquire a lease with `wait`", "`stage.lease({}, wait=60)`"),
    ("`Rearm`", "`stage.rearm()`"),
    ("`ReportJobDone`", "`mill.report_done(job)`"),
    ("`ResumeJob`", "`mill.resume()`"),
    ("`SavePosition`", "`stage.places.save(name)`"),
    ("`SendJob`", "`mill.send(...)`"),
    ("`Stop`", "`stage.stop()`"),
    ("`WatchMill`", "`mill.watch()`"),
)


def with_methods(hint: str, axis: str) -> str:
    """Returns the hint with each call replaced by this package's method. `axis` may be empty."""
    argument = f'"{axis}"' if axis else "axis"
    for call, method in _ROWS:
        hint = hint.replace(call, method.replace("{}", argument))
    return hint
