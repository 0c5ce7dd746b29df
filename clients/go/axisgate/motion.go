package axisgate

import (
	"context"
	"errors"
	"fmt"
	"iter"
	"strconv"
	"strings"
	"sync"
	"time"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A Motion was started, and continues whatever this program does.
type Motion struct {
	session *deviceSession

	mutex   sync.Mutex
	message *axisgatev1.Motion
}

func newMotion(session *deviceSession, message *axisgatev1.Motion) *Motion {
	return &Motion{session: session, message: message}
}

// Message returns the motion as last received, as the API's message. Do not change it.
func (m *Motion) Message() *axisgatev1.Motion {
	m.mutex.Lock()
	defer m.mutex.Unlock()
	return m.message
}

// Name returns the name of the motion: "devices/stage/motions/12".
func (m *Motion) Name() string { return m.Message().Name }

// ID returns the number of the motion. Numbers ascend.
func (m *Motion) ID() int64 {
	name := m.Name()
	id, _ := strconv.ParseInt(name[strings.LastIndexByte(name, '/')+1:], 10, 64)
	return id
}

// State returns the state as last received: "QUEUED", "RUNNING", "STOPPING", "SUCCEEDED", "STOPPED", "FAILED" or
// "UNKNOWN".
func (m *Motion) State() string { return enumName(m.Message().State, "MOTION_STATE_") }

// RequestID returns the id of the request that started the motion.
func (m *Motion) RequestID() string { return m.Message().RequestId }

// String returns the name and the state of the motion.
func (m *Motion) String() string { return m.Name() + " " + m.State() }

// Done reports whether the motion has its outcome. It asks the daemon if the outcome is not known yet.
func (m *Motion) Done(ctx context.Context) (bool, error) {
	err := m.follow(ctx, time.Now())
	return m.over(), err
}

// Wait waits for the outcome, also over broken connections and restarts of the daemon. The end of ctx stops nothing.
//
// It returns a Stopped, MotionFailed or OutcomeUnknown unless the motion succeeds, and the error of ctx if it ends
// first.
func (m *Motion) Wait(ctx context.Context) (*Result, error) {
	if err := m.follow(ctx, time.Time{}); err != nil {
		return nil, err
	}
	return outcomeOf(m.Message())
}

// Cancel stops the motion, or drops it if it has not started. It has no effect on a motion with an outcome. It is sent
// even if ctx has ended.
func (m *Motion) Cancel(ctx context.Context) error {
	request := &axisgatev1.CancelMotionRequest{Motion: m.Name()}
	_, err := change(context.WithoutCancel(ctx), m.session, m.session.stages.CancelMotion, request, 0)
	return err
}

// A Progress is how far a motion has come.
type Progress struct {
	// Fraction is the part of the distance that is covered, from 0 to 1. nil if the distance is unknown.
	Fraction *float64
	// Positions are the present positions of the axes of the motion.
	Positions []Position
	// Segment is the number of finished segments of a path.
	Segment int
}

// Progress yields the progress at each interval until the motion has its outcome, which Wait then returns.
func (m *Motion) Progress(ctx context.Context, interval time.Duration) iter.Seq2[Progress, error] {
	return func(yield func(Progress, error) bool) {
		var first *axisgatev1.Device
		for {
			err := m.follow(ctx, time.Now().Add(interval))
			if err == nil && m.over() {
				return
			}
			device, failed := m.session.read(ctx, nil)
			if err == nil {
				err = failed
			}
			if err != nil {
				yield(Progress{}, err)
				return
			}
			if first == nil {
				first = device
			}
			if !yield(progressOf(m.Message(), first, device), nil) {
				return
			}
		}
	}
}

// follow waits for the outcome until `end`. A zero `end`: no limit.
func (m *Motion) follow(ctx context.Context, end time.Time) error {
	motion := m.Message()
	if isOver(motion) {
		return nil
	}
	motion, err := m.session.follow(ctx, motion, end)
	m.mutex.Lock()
	defer m.mutex.Unlock()
	if !isOver(m.message) {
		m.message = motion
	}
	if err != nil && errors.Is(err, ctx.Err()) {
		return fmt.Errorf("axisgate: %s has no outcome yet: %w", motion.Name, err)
	}
	return err
}

func (m *Motion) over() bool { return isOver(m.Message()) }

func isOver(motion *axisgatev1.Motion) bool { return motion.EndTime != nil }

func progressOf(motion *axisgatev1.Motion, first, now *axisgatev1.Device) Progress {
	p := Progress{Segment: int(motion.SegmentsDone)}
	if motion.SegmentsTotal > 0 {
		part := float64(motion.SegmentsDone) / float64(motion.SegmentsTotal)
		p.Fraction = &part
	}
	before, after := statusOf(first), statusOf(now)
	for _, result := range motion.Results {
		name := axisName(result.Name, result.Axis)
		state, _ := after.Axis(name)
		p.Positions = append(p.Positions, state.Position)
		start, _ := before.Axis(name)
		if part := covered(start.Position.Pulses, state.Position.Pulses, result.TargetPulses); part != nil &&
			motion.SegmentsTotal == 0 && (p.Fraction == nil || *part < *p.Fraction) {
			p.Fraction = part
		}
	}
	return p
}

// covered returns the part of its distance that an axis has covered. nil if unknown.
func covered(first, now, target *int64) *float64 {
	if first == nil || now == nil || target == nil || *target == *first {
		return nil
	}
	part := float64(*now-*first) / float64(*target-*first)
	return &part
}
