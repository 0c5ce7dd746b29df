// Calls that the API's hints name, and the functions of this package. A call with a field comes before the same call
// alone. "{}" is the axis in quotes, or `axis`.
const ROWS: readonly (readonly [string, string])[] = [
  ["`AbortJob`", "`mill.abort()`"],
  ["`AcquireLease`", "`stage.lease([{}])`"],
  ["`CancelJob`", "`mill.cancel(job)`"],
  ["`ChangeSettings` with `excited`", "`stage.settings.change({}, { motorOn: true })`"],
  ["`ChangeSettings` with `speeds`", "`stage.settings.change({}, { minimumSpeed, maximumSpeed })`"],
  ["`ChangeSettings`", "`stage.settings.write(...)`"],
  ["`ClearErrors`", "`stage.clearErrors()`"],
  ["`ConfirmJob`", "`mill.confirm(job)`"],
  ["`DeletePosition`", "`stage.places.delete(name)`"],
  ["`Execute`", "`stage.execute([line])`"],
  ["`GetDevice`", "`stage.status()`"],
  ["`GetMill`", "`mill.read()`"],
  ["`GetSettings`", "`stage.settings.read()`"],
  ["`Home`", "`stage.home([{}])`"],
  ["`Jog`", "`stage.jog(...)`"],
  ["`ListMotions`", "`stage.motions()`"],
  ["`ListPositions`", "`stage.places.read()`"],
  ["`Move`", "`stage.moveTo(...)`"],
  ["`PauseJob` with `raise_tool`", "`mill.pause({ raiseTool: true })`"],
  ["`Rearm`", "`stage.rearm()`"],
  ["`ReportJobDone`", "`mill.reportDone(job)`"],
  ["`ResumeJob`", "`mill.resume()`"],
  ["`SavePosition`", "`stage.places.save(name)`"],
  ["`SendJob`", "`mill.send(...)`"],
  ["`Stop`", "`stage.stop()`"],
  ["`WatchMill`", "`mill.watch()`"],
];

/** Returns the API's hint with each call replaced by a function of this package. `axis` may be empty. */
export function withMethods(hint: string, axis: string): string {
  const argument = axis ? `"${axis}"` : "axis";
  return ROWS.reduce((text, [call, method]) => text.replaceAll(call, method.replace("{}", argument)), hint);
}
