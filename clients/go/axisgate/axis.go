package axisgate

import (
	"context"
	"strconv"
)

// An Axis is one axis of a Stage.
type Axis struct {
	stage  *Stage
	name   string
	number int
	unit   Unit
}

// Name returns the name from the configuration, or the number as text.
func (a *Axis) Name() string { return a.name }

// Number returns the number of the axis, from 1. 0: there is no such axis.
func (a *Axis) Number() int { return a.number }

// Unit returns the unit in which positions of the axis are shown.
func (a *Axis) Unit() Unit { return a.unit }

// String returns the name of the axis.
func (a *Axis) String() string { return a.name }

func (a *Axis) is(name string) bool { return name == a.name || name == strconv.Itoa(a.number) }

// State reads the present state of the axis from the controller.
func (a *Axis) State(ctx context.Context) (AxisState, error) {
	status, err := a.stage.FreshStatus(ctx, 0)
	if err != nil {
		return AxisState{}, err
	}
	state, known := status.Axis(a.name)
	if !known {
		return AxisState{}, invalid("the stage has no axis %s", a.name)
	}
	return state, nil
}

// Position reads the present position of the axis from the controller.
func (a *Axis) Position(ctx context.Context) (Position, error) {
	state, err := a.State(ctx)
	return state.Position, err
}

// Start starts a move to a position.
func (a *Axis) Start(ctx context.Context, target Distance, options ...MoveOption) (*Motion, error) {
	return a.stage.Start(ctx, Targets{a.name: target}, options...)
}

// StartBy starts a move by a displacement from the present position.
func (a *Axis) StartBy(ctx context.Context, displacement Distance, options ...MoveOption) (*Motion, error) {
	return a.stage.StartBy(ctx, Targets{a.name: displacement}, options...)
}

// MoveTo moves the axis to a position, and waits for the outcome. The end of ctx cancels the move.
//
// It returns a Refused, Stopped, MotionFailed or OutcomeUnknown unless the move succeeds.
func (a *Axis) MoveTo(ctx context.Context, target Distance, options ...MoveOption) (*Result, error) {
	return a.stage.MoveTo(ctx, Targets{a.name: target}, options...)
}

// MoveBy does the same as MoveTo with a displacement from the present position.
func (a *Axis) MoveBy(ctx context.Context, displacement Distance, options ...MoveOption) (*Result, error) {
	return a.stage.MoveBy(ctx, Targets{a.name: displacement}, options...)
}

// Home homes the axis, and waits for the outcome. The end of ctx cancels the motion.
func (a *Axis) Home(ctx context.Context) (*Result, error) { return a.stage.Home(ctx, a.name) }

// Stop stops the axis. See [Stage.Stop].
func (a *Axis) Stop(ctx context.Context) (*StopReport, error) { return a.stage.Stop(ctx, a.name) }
