package axisgate

import (
	"context"
	"fmt"
	"time"

	"google.golang.org/protobuf/types/known/durationpb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// stopTime is the longest time until the answer to a stop, which then has what is known.
const stopTime = 4 * time.Second

// An AxisStop is the result of a stop for one axis.
type AxisStop struct {
	// Position is the position that was seen after the stop.
	Position Position
	// Stationary is nil if the axis was not seen after the stop.
	Stationary *bool
}

// String returns the position, and whether the axis is stationary.
func (s AxisStop) String() string {
	state := "not seen stationary"
	if s.Stationary != nil && *s.Stationary {
		state = "stationary"
	} else if s.Stationary != nil {
		state = "still moving"
	}
	return fmt.Sprintf("%s (%s)", s.Position, state)
}

// A StopReport is what was seen of a stop.
type StopReport struct {
	// Axes are the results of the axes, in the order of their numbers.
	Axes []AxisStop
	// StaysOpen is true if the axes were not confirmed stationary. The daemon then repeats the stop, and refuses motion
	// of these axes.
	StaysOpen bool
	// Problem says why. nil: no problem.
	Problem error
}

// String returns the results of the axes, and the problem.
func (r *StopReport) String() string {
	text := joined(r.Axes)
	if r.StaysOpen {
		text += "; the stop stays open"
	}
	if r.Problem != nil {
		text += ": " + r.Problem.Error()
	}
	return text
}

// Stop slows down and stops axes, without arguments all of the stage. It needs no lease, and is sent even if ctx has
// ended. Stop is not a safety function.
//
// The report says what was seen within 4 s. The stop is sent again for half of the Stage's timeout if no daemon
// answers.
func (s *Stage) Stop(ctx context.Context, axes ...string) (*StopReport, error) {
	stages := axisgatev1.NewStageServiceClient(s.session.stops)
	answer, err := stop(ctx, s.session.connection, stages.Stop, &axisgatev1.StopRequest{
		Context: s.leaseContext(ctx), Device: s.session.device, Axes: axes, MaxWait: durationpb.New(stopTime)})
	if err != nil {
		return nil, err
	}
	return reportOf(answer.Devices, answer.StaysOpen), nil
}

// EmergencyStop stops all axes at once without slowing down. Nothing moves until [Stage.ClearErrors]. Otherwise it does
// the same as Stop. EmergencyStop is not a safety function.
func (s *Stage) EmergencyStop(ctx context.Context) (*StopReport, error) {
	stages := axisgatev1.NewStageServiceClient(s.session.stops)
	answer, err := stop(ctx, s.session.connection, stages.EmergencyStop, &axisgatev1.EmergencyStopRequest{
		Context: s.leaseContext(ctx), Device: s.session.device, MaxWait: durationpb.New(stopTime)})
	if err != nil {
		return nil, err
	}
	return reportOf(answer.Devices, answer.StaysOpen), nil
}

func (s *Stage) leaseContext(ctx context.Context) *axisgatev1.CallContext {
	return &axisgatev1.CallContext{LeaseToken: s.session.token(ctx)}
}

// Rearm allows motion after a stop by another caller. It returns the numbers of the axes that may move again.
func (s *Stage) Rearm(ctx context.Context) ([]int, error) {
	answer, err := change(ctx, s.session, s.session.control.Rearm, &axisgatev1.RearmRequest{Device: s.session.device}, 0)
	if err != nil {
		return nil, err
	}
	return numbers(answer.Axes), nil
}

// ClearErrors clears limit, overflow and emergency errors of axes, without arguments of all. It starts no motion.
func (s *Stage) ClearErrors(ctx context.Context, axes ...string) error {
	request := &axisgatev1.ClearErrorsRequest{Device: s.session.device, Axes: axes}
	_, err := change(ctx, s.session, s.session.devices.ClearErrors, request, 0)
	return err
}

func reportOf(devices []*axisgatev1.DeviceStop, staysOpen bool) *StopReport {
	report := &StopReport{StaysOpen: staysOpen}
	for _, device := range devices {
		for _, one := range device.Axes {
			position := Position{axisName(one.Name, one.Axis), one.Position, unitOf(one.Unit), one.PositionPulses}
			report.Axes = append(report.Axes, AxisStop{position, one.Ready})
		}
		if device.Problem != nil && report.Problem == nil {
			problem := problemOf(device.Problem, "")
			report.Problem = classOf(problem.Reason)(problem)
		}
	}
	return report
}
