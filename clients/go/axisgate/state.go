package axisgate

import (
	"context"
	"strings"
	"time"

	"google.golang.org/protobuf/types/known/durationpb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// An AxisState is the state of one axis. nil means unknown; a limit that is nil does not exist.
type AxisState struct {
	// Number is the number of the axis, from 1.
	Number int
	// Name is the name from the configuration, or the number as text.
	Name string
	// Unit is the unit of the positions.
	Unit Unit
	// Position is the position as last read.
	Position Position
	// Moving reports whether the axis moves.
	Moving *bool
	// MotorOn reports whether the motor has current.
	MotorOn *bool
	// Homed reports whether the daemon has homed the axis.
	Homed bool
	// Minimum and Maximum are the travel limits from the configuration.
	Minimum, Maximum *Distance
	// Conditions are the names of the present conditions, such as "CW_LIMIT".
	Conditions []string
}

// A Status is the state of a device. Axes that the controller does not allow to be moved are left out.
type Status struct {
	// Device is the name of the device.
	Device string
	// Link is "UP" if the controller answers; otherwise LinkProblem says why not.
	Link, LinkProblem string
	// Mode is the mode of the controller: "HOST".
	Mode string
	// Axes are the axes in the order of their numbers.
	Axes []AxisState
	// Message is the whole state, as the API's message.
	Message *axisgatev1.Device
}

// Axis returns the state of an axis by its name, and whether there is such an axis.
func (s *Status) Axis(name string) (AxisState, bool) {
	for _, axis := range s.Axes {
		if axis.Name == name {
			return axis, true
		}
	}
	return AxisState{}, false
}

// String returns the state of the link and the positions.
func (s *Status) String() string {
	shown := s.LinkProblem
	if shown == "" {
		var positions []Position
		for _, axis := range s.Axes {
			positions = append(positions, axis.Position)
		}
		shown = joined(positions)
	}
	return s.Device + " " + s.Link + ": " + shown
}

// Status returns the newest known state of the device.
func (s *Stage) Status(ctx context.Context) (*Status, error) { return s.status(ctx, nil) }

// FreshStatus returns the state of the device, which is read from the controller if it is older than `maxAge`.
func (s *Stage) FreshStatus(ctx context.Context, maxAge time.Duration) (*Status, error) {
	return s.status(ctx, &maxAge)
}

func (s *Stage) status(ctx context.Context, maxAge *time.Duration) (*Status, error) {
	device, err := s.session.read(ctx, maxAge)
	if err != nil {
		return nil, err
	}
	return statusOf(device), nil
}

// Watch streams the newest state of the device, now and after every change, until ctx ends or the stream is closed. A
// slow reader skips states. The stream continues after a broken connection. `interval` is the minimum time between two
// states.
func (s *Stage) Watch(ctx context.Context, interval time.Duration) (*Stream[*Status], error) {
	request := &axisgatev1.WatchDeviceRequest{Device: s.session.device, MinInterval: durationpb.New(interval)}
	return newStream(ctx, s.session.connection, feed[*axisgatev1.WatchDeviceResponse, *Status]{
		begin: func(ctx context.Context) (answers[*axisgatev1.WatchDeviceResponse], error) {
			return s.session.devices.WatchDevice(ctx, request)
		},
		item: func(answer *axisgatev1.WatchDeviceResponse) *Status { return statusOf(answer.Device) },
	})
}

func statusOf(device *axisgatev1.Device) *Status {
	status := &Status{Device: strings.TrimPrefix(device.Name, "devices/"), Link: enumName(device.Link, "LINK_STATE_"),
		LinkProblem: device.LinkProblem, Mode: enumName(device.Mode, "MODE_"), Message: device}
	for _, axis := range device.Axes {
		if axis.Controllable {
			status.Axes = append(status.Axes, axisStateOf(axis))
		}
	}
	return status
}

func axisStateOf(axis *axisgatev1.Axis) AxisState {
	name, unit := axisName(axis.Name, axis.Number), unitOf(axis.Unit)
	state := AxisState{Number: int(axis.Number), Name: name, Unit: unit, Moving: axis.Busy, MotorOn: axis.Excited,
		Position: Position{name, axis.Position, unit, axis.PositionPulses}, Homed: axis.Homed,
		Minimum: limitOf(axis.TravelMinimum), Maximum: limitOf(axis.TravelMaximum)}
	for _, condition := range axis.Conditions {
		state.Conditions = append(state.Conditions, enumName(condition, "CONDITION_"))
	}
	return state
}

// limitOf returns a travel limit. nil: there is none.
func limitOf(limit *axisgatev1.Distance) *Distance {
	var found Distance
	switch amount := limit.GetAmount().(type) {
	case *axisgatev1.Distance_Pulses:
		found = Pulses(amount.Pulses)
	case *axisgatev1.Distance_Nm:
		found = NM(amount.Nm)
	case *axisgatev1.Distance_Um:
		found = UM(amount.Um)
	case *axisgatev1.Distance_Mm:
		found = MM(amount.Mm)
	case *axisgatev1.Distance_Degrees:
		found = Deg(amount.Degrees)
	default:
		return nil
	}
	return &found
}
