package axisgate

import (
	"context"
	"slices"
	"strings"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A Stage is the connection to one device that moves axes. Axes are named as in the configuration, or by their numbers:
// "x", "1".
//
// Every method returns a [Refused] if the daemon refuses a request: nothing moved.
type Stage struct {
	session *deviceSession
	axes    []*Axis
}

// Open connects to the daemon. Without options it is the local daemon, or the one of the environment variables, and its
// only stage. Call Close when the Stage is no longer used.
//
// It returns an error that matches [ErrUnavailable] if no daemon answers.
func Open(ctx context.Context, options ...Option) (*Stage, error) {
	s := newSettings(options)
	c, err := newConnection(s)
	if err != nil {
		return nil, err
	}
	stage, err := openStage(ctx, c, s)
	if err != nil {
		c.close()
		return nil, err
	}
	return stage, nil
}

func openStage(ctx context.Context, c *connection, s settings) (*Stage, error) {
	listed, err := c.connect(ctx)
	if err != nil {
		return nil, err
	}
	device, err := choose(listed.Devices, s.device)
	if err != nil {
		return nil, err
	}
	session, err := newDeviceSession(c, device.Name, s.getenv(leaseVariable))
	if err != nil {
		return nil, err
	}
	stage := &Stage{session: session}
	for _, state := range statusOf(device).Axes {
		stage.axes = append(stage.axes, &Axis{stage: stage, name: state.Name, number: state.Number, unit: state.Unit})
	}
	return stage, nil
}

// Close closes the connection, and ends all calls and goroutines of the Stage. Motions continue. Leases that were not
// released expire.
func (s *Stage) Close() error { return s.session.close() }

// Name returns the name of the device.
func (s *Stage) Name() string { return strings.TrimPrefix(s.session.device, "devices/") }

// Axes returns the axes that can be moved, in the order of their numbers.
func (s *Stage) Axes() []*Axis { return slices.Clone(s.axes) }

// Axis returns an axis by its name or number. The daemon refuses the calls of an axis that does not exist.
func (s *Stage) Axis(name string) *Axis {
	for _, axis := range s.axes {
		if axis.is(name) {
			return axis
		}
	}
	return &Axis{stage: s, name: name}
}

// WhoAmI returns the caller's name and role, as the daemon identifies this program. The role is "observer", "operator"
// or "admin".
func (s *Stage) WhoAmI(ctx context.Context) (name, role string, err error) {
	answer, err := ask(ctx, s.session.connection, s.session.access.GetCaller, &axisgatev1.GetCallerRequest{},
		s.session.half)
	if err != nil {
		return "", "", err
	}
	return answer.Caller.GetName(), strings.ToLower(enumName(answer.Role, "ROLE_")), nil
}

// Motions returns the newest 100 motions, newest first, also those of other callers.
func (s *Stage) Motions(ctx context.Context) ([]*Motion, error) {
	listed, err := ask(ctx, s.session.connection, s.session.stages.ListMotions,
		&axisgatev1.ListMotionsRequest{Device: s.session.device}, s.session.half)
	if err != nil {
		return nil, err
	}
	var motions []*Motion
	for _, motion := range listed.Motions {
		motions = append(motions, newMotion(s.session, motion))
	}
	return motions, nil
}

// Places returns the saved positions of the stage.
func (s *Stage) Places() *Places { return &Places{s.session} }
