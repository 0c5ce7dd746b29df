// Package axisgate is the client of Axisgate, the gateway for stage controllers and mills.
//
//	stage, err := axisgate.Open(ctx)
//	if err != nil {
//		return err
//	}
//	defer stage.Close()
//	result, err := stage.Axis("x").MoveTo(ctx, axisgate.MM("1.5"))
//	var refused *axisgate.Refused
//	if errors.As(err, &refused) {
//		fmt.Println(refused.Reason, refused.Hint)
//	}
//
// A [Refused] error means that nothing moved. The other errors of the daemon are [Stopped], [MotionFailed] and
// [OutcomeUnknown]. A wrong argument is an [InvalidArgument], found before anything is sent.
//
// A lost answer makes no difference: the request is sent again with the same id, and the daemon acts once.
//
// The end of a context ends the call, and stops nothing that has started, with two exceptions. Functions that move and
// wait in one step, such as [Axis.MoveTo], then cancel their motion; they return once the daemon has answered, or the
// time limit of the call has passed. A [Jog] stops. Functions that end something, such as [Stage.Stop] and
// [Motion.Cancel], are sent even if their context has ended.
//
// All functions and methods can be called by several goroutines at once, unless their comment says otherwise.
package axisgate
