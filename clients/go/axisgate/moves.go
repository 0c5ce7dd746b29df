package axisgate

import (
	"context"
	"slices"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// Check checks a move as far as possible without moving. It returns the error of a move that would be refused.
func (s *Stage) Check(ctx context.Context, targets Targets, options ...MoveOption) error {
	request, err := moveRequest(s.session.device, targets, false, options)
	if err != nil {
		return err
	}
	request.ValidateOnly = true
	_, err = change(ctx, s.session, s.session.stages.Move, request, 0)
	return err
}

// Start starts a move of some axes, all at once.
func (s *Stage) Start(ctx context.Context, targets Targets, options ...MoveOption) (*Motion, error) {
	return s.startMove(ctx, targets, false, options)
}

// StartBy does the same as Start with displacements from the present positions.
func (s *Stage) StartBy(ctx context.Context, displacements Targets, options ...MoveOption) (*Motion, error) {
	return s.startMove(ctx, displacements, true, options)
}

// MoveTo moves axes to positions, all at once, and waits for the outcome. The end of ctx cancels the move.
//
// It returns a Refused, Stopped, MotionFailed or OutcomeUnknown unless the move succeeds.
func (s *Stage) MoveTo(ctx context.Context, targets Targets, options ...MoveOption) (*Result, error) {
	return s.session.finish(ctx, func(ctx context.Context) (*Motion, error) {
		return s.Start(ctx, targets, options...)
	})
}

// MoveBy does the same as MoveTo with displacements from the present positions.
func (s *Stage) MoveBy(ctx context.Context, displacements Targets, options ...MoveOption) (*Result, error) {
	return s.session.finish(ctx, func(ctx context.Context) (*Motion, error) {
		return s.StartBy(ctx, displacements, options...)
	})
}

func (s *Stage) startMove(ctx context.Context, targets Targets, relative bool, options []MoveOption) (*Motion, error) {
	request, err := moveRequest(s.session.device, targets, relative, options)
	if err != nil {
		return nil, err
	}
	return start(ctx, s.session, s.session.stages.Move, request)
}

// Home homes axes, without arguments all, and waits for the outcome. The end of ctx cancels the motion.
func (s *Stage) Home(ctx context.Context, axes ...string) (*Result, error) {
	request := &axisgatev1.HomeRequest{Device: s.session.device, Axes: axes}
	return s.session.finish(ctx, func(ctx context.Context) (*Motion, error) {
		return start(ctx, s.session, s.session.stages.Home, request)
	})
}

// HomeIfNeeded does the same as Home for those of the axes that the daemon has not homed yet. The result has no
// positions if there are none.
func (s *Stage) HomeIfNeeded(ctx context.Context, axes ...string) (*Result, error) {
	status, err := s.Status(ctx)
	if err != nil {
		return nil, err
	}
	if len(status.Axes) == 0 {
		return s.Home(ctx, axes...) // the daemon does not know the axes yet, and refuses
	}
	var needed []string
	for _, axis := range s.axes {
		state, known := status.Axis(axis.name)
		chosen := len(axes) == 0 || slices.ContainsFunc(axes, axis.is)
		if chosen && !(known && state.Homed) {
			needed = append(needed, axis.name)
		}
	}
	if len(needed) == 0 {
		return &Result{}, nil
	}
	return s.Home(ctx, needed...)
}
