//! The API's hints in the terms of this crate.

/// The calls in the API's hints, and the functions of this crate. A call with a field comes before the same call alone.
/// "{}" is the axis. Calls that this crate does not have keep the API's name.
const FUNCTIONS: [(&str, &str); 24] = [
    ("`AbortJob`", "`mill.abort()`"),
    ("`AcquireLease`", "`stage.lease([{}])`"),
    ("`CancelJob`", "`mill.cancel(&job)`"),
    ("`ChangeSettings`", "`stage.change_settings(...)`"),
    ("`ClearErrors`", "`stage.clear_errors(ALL)`"),
    ("`ConfirmJob`", "`mill.confirm(&job)`"),
    ("`DeletePosition`", "`stage.places().delete(name)`"),
    ("`Execute`", "`stage.execute([line])`"),
    ("`GetDevice`", "`stage.status()`"),
    ("`GetMill`", "`mill.state()`"),
    ("`GetSettings`", "`stage.settings()`"),
    ("`Home`", "`stage.home([{}])`"),
    ("`Jog`", "`stage.jog(...)`"),
    ("`ListMotions`", "`stage.motions()`"),
    ("`ListPositions`", "`stage.places().list()`"),
    ("`Move`", "`stage.move_to(...)`"),
    ("`PauseJob` with `raise_tool`", "`mill.pause(true)`"),
    ("`Rearm`", "`stage.rearm()`"),
    ("`ReportJobDone`", "`mill.report_done(&job)`"),
    ("`ResumeJob`", "`mill.resume()`"),
    ("`SavePosition`", "`stage.places().save(name)`"),
    ("`SendJob`", "`mill.send(...)`"),
    ("`Stop`", "`stage.stop(ALL)`"),
    ("`WatchMill`", "`mill.watch()`"),
];

/// Returns the hint with each call replaced by a function of this crate.
pub fn with_functions(hint: &str, axis: Option<i32>) -> String {
    let argument = axis.map_or("axis".to_string(), |number| number.to_string());
    FUNCTIONS
        .iter()
        .fold(hint.to_string(), |text, (call, function)| text.replace(call, &function.replace("{}", &argument)))
}
