package axisgate

import (
	"strconv"
	"strings"
)

// hintCalls maps the calls in the API's hints to the functions of this package. "{}" is the
// axis. Calls that this package does not have keep the API's name.
var hintCalls = []struct{ call, function string }{
	{"`AcquireLease`", "`stage.Lease(ctx, ...)`"},
	{"`ChangeSettings`", "`stage.ChangeSettings(ctx, ...)`"},
	{"`ClearErrors`", "`stage.ClearErrors(ctx)`"},
	{"`DeletePosition`", "`stage.Places().Delete(ctx, name)`"},
	{"`GetDevice`", "`stage.Status(ctx)`"},
	{"`GetSettings`", "`stage.Settings(ctx)`"},
	{"`Home`", "`stage.Home(ctx, {})`"},
	{"`Jog`", "`stage.Jog(ctx, ...)`"},
	{"`ListMotions`", "`stage.Motions(ctx)`"},
	{"`ListPositions`", "`stage.Places().List(ctx)`"},
	{"`Move`", "`stage.MoveTo(ctx, ...)`"},
	{"`Rearm`", "`stage.Rearm(ctx)`"},
	{"`SavePosition`", "`stage.Places().Save(ctx, name)`"},
	{"`Stop`", "`stage.Stop(ctx)`"},
}

// withFunctions returns the hint with each call replaced by a function of this package. Axis 0: no axis.
func withFunctions(hint string, axis int) string {
	argument := "axis"
	if axis != 0 {
		argument = strconv.Quote(strconv.Itoa(axis))
	}
	for _, row := range hintCalls {
		hint = strings.ReplaceAll(hint, row.call, strings.ReplaceAll(row.function, "{}", argument))
	}
	return hint
}
