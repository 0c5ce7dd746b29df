package axisgate

import (
	"crypto/rand"
	"fmt"
	"maps"
	"slices"
	"strings"
	"time"

	"google.golang.org/protobuf/proto"
	"google.golang.org/protobuf/types/known/timestamppb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// newUUID returns a random UUID.
func newUUID() string {
	var id [16]byte
	if _, err := rand.Read(id[:]); err != nil {
		panic(err) // the system has no random numbers
	}
	id[6], id[8] = id[6]&0x0f|0x40, id[8]&0x3f|0x80
	return fmt.Sprintf("%x-%x-%x-%x-%x", id[:4], id[4:6], id[6:8], id[8:10], id[10:])
}

// newContext returns the context of a request that is sent for the first time.
func newContext(memory string, token []byte, notAfter time.Time) *axisgatev1.CallContext {
	return &axisgatev1.CallContext{RequestId: newUUID(), LeaseToken: token, RequestMemory: memory,
		NotAfter: timestamppb.New(notAfter)}
}

// withContext returns a copy of the request with its context, which is the field of that name.
func withContext[Q proto.Message](request Q, context *axisgatev1.CallContext) Q {
	copied := proto.Clone(request).(Q)
	message := copied.ProtoReflect()
	field := message.Descriptor().Fields().ByName("context")
	message.Set(field, message.NewField(field)) // the field exists in every request that changes something
	proto.Merge(message.Mutable(field).Message().Interface(), context)
	return copied
}

// clockAhead returns by how much the daemon's clock is ahead of this machine's, just after the devices were listed. 0
// if nothing was read from any device yet.
func clockAhead(devices []*axisgatev1.Device, now time.Time) time.Duration {
	for _, device := range devices {
		if device.ReadTime != nil && device.Age != nil {
			return device.ReadTime.AsTime().Add(device.Age.AsDuration()).Sub(now)
		}
	}
	return 0
}

// resource returns "devices/stage" for "stage".
func resource(device string) string {
	if strings.HasPrefix(device, "devices/") {
		return device
	}
	return "devices/" + device
}

// choose returns the stage with the name, or the only stage if it is empty.
func choose(devices []*axisgatev1.Device, name string) (*axisgatev1.Device, error) {
	var names []string
	var able []*axisgatev1.Device
	for _, device := range devices {
		names = append(names, strings.TrimPrefix(device.Name, "devices/"))
		if slices.Contains(device.Capabilities, axisgatev1.Capability_CAPABILITY_MOVE) &&
			(name == "" || device.Name == resource(name)) {
			able = append(able, device)
		}
	}
	all := strings.Join(names, ", ")
	switch {
	case len(able) == 1:
		return able[0], nil
	case len(able) > 1:
		return nil, invalid("the daemon has several stages; choose one of these devices by WithDevice: %s", all)
	case name != "":
		return nil, invalid("the daemon has no stage %s; its devices: %s", name, all)
	}
	return nil, invalid("the daemon has no stage; its devices: %s", all)
}

// Targets are distances by the names or numbers of their axes.
type Targets map[string]Distance

// moveRequest returns a move without its context.
func moveRequest(device string, targets Targets, relative bool, options []MoveOption) (*axisgatev1.MoveRequest, error) {
	if len(targets) == 0 {
		return nil, invalid("a move needs at least one axis")
	}
	var terms moveTerms
	for _, option := range options {
		option(&terms)
	}
	request := &axisgatev1.MoveRequest{Device: device, Relative: relative}
	for _, axis := range slices.Sorted(maps.Keys(targets)) {
		target, err := terms.target(axis, targets[axis])
		if err != nil {
			return nil, err
		}
		request.Targets = append(request.Targets, target)
	}
	return request, nil
}

// A MoveOption is a term of a move, for all its axes.
type MoveOption func(*moveTerms)

type moveTerms struct {
	speed    *Speed
	approach *Distance
}

// WithSpeed sets the highest speed of the move. Without it: the present speed profile of the axis.
func WithSpeed(speed Speed) MoveOption { return func(t *moveTerms) { t.speed = &speed } }

// WithApproach sets the displacement of the last part of the move, whose direction is then always the same, so that
// backlash does not matter. Without it, the axis moves directly.
func WithApproach(displacement Distance) MoveOption {
	return func(t *moveTerms) { t.approach = &displacement }
}

func (t moveTerms) target(axis string, distance Distance) (*axisgatev1.AxisTarget, error) {
	target := &axisgatev1.AxisTarget{Axis: axis}
	var err error
	if target.Distance, err = distance.message(); err != nil {
		return nil, err
	}
	if t.speed != nil {
		speed, err := t.speed.message()
		if err != nil {
			return nil, err
		}
		target.Profile = &axisgatev1.Profile{Maximum: speed}
	}
	if t.approach != nil {
		if target.Approach, err = t.approach.message(); err != nil {
			return nil, err
		}
	}
	return target, nil
}
