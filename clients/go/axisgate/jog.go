package axisgate

import (
	"context"
	"maps"
	"slices"
	"time"

	"google.golang.org/grpc"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// jogInterval is the time between two messages. The daemon stops the axes after 500 ms without a message.
const jogInterval = 100 * time.Millisecond

// A Jog runs axes until Stop, or until its context ends.
//
//	jog, err := stage.Jog(ctx, map[string]axisgate.Speed{"x": axisgate.UM(-200).PerSecond()})
//	if err != nil {
//		return err
//	}
//	time.Sleep(2 * time.Second)
//	result, err := jog.Stop(ctx)
//
// A goroutine keeps the axes running. They are stopped if the program ends, or does not run for 500 ms.
type Jog struct {
	session *deviceSession
	motion  *Motion
	call    grpc.BidiStreamingClient[axisgatev1.JogRequest, axisgatev1.JogResponse]
	cancel  context.CancelFunc

	stopping context.Context
	stop     context.CancelFunc
	sent     chan struct{} // is closed after the last message
}

// Jog runs axes at speeds, by the names or numbers of the axes. A negative speed is one in the minus direction. The end
// of ctx stops the axes; Stop slows them down first, and must be called in any case.
func (s *Stage) Jog(ctx context.Context, speeds map[string]Speed) (*Jog, error) {
	first := &axisgatev1.JogRequest{Context: s.leaseContext(ctx), Device: s.session.device}
	for _, axis := range slices.Sorted(maps.Keys(speeds)) {
		jogged, err := axisJog(axis, speeds[axis])
		if err != nil {
			return nil, err
		}
		first.Axes = append(first.Axes, jogged)
	}
	if err := s.session.interruption(ctx); err != nil {
		return nil, err
	}
	ctx, cancel := context.WithCancel(ctx)
	jog := &Jog{session: s.session, cancel: cancel, sent: make(chan struct{})}
	jog.stopping, jog.stop = context.WithCancel(ctx)
	if err := jog.begin(ctx, first); err != nil {
		cancel()
		return nil, err
	}
	return jog, nil
}

// begin returns once the axes run.
func (j *Jog) begin(ctx context.Context, first *axisgatev1.JogRequest) error {
	limit := time.AfterFunc(2*j.session.half, j.cancel)
	defer limit.Stop()
	call, err := j.session.stages.Jog(ctx)
	if err != nil {
		return errorOf(failureOf(err, false), j.session.target.address)
	}
	j.call = call
	if !j.session.spawn(func() { j.send(first) }) {
		return ErrClosed
	}
	answer, err := call.Recv()
	if err != nil {
		return errorOf(failureOf(err, true), j.session.target.address)
	}
	j.motion = newMotion(j.session, answer.Motion)
	return nil
}

// send keeps the axes running until the jog or the call ends.
func (j *Jog) send(message *axisgatev1.JogRequest) {
	defer close(j.sent)
	ticker := time.NewTicker(jogInterval)
	defer ticker.Stop()
	for j.call.Send(message) == nil {
		message = &axisgatev1.JogRequest{}
		select {
		case <-j.stopping.Done():
			j.call.CloseSend()
			return
		case <-ticker.C:
		}
	}
}

// Motion returns the motion of the jog.
func (j *Jog) Motion() *Motion { return j.motion }

// Stop ends the jog: the axes slow down. It waits for the outcome, and returns a Stopped, MotionFailed or
// OutcomeUnknown if something else has ended the jog.
func (j *Jog) Stop(ctx context.Context) (*Result, error) {
	j.stop()
	<-j.sent
	defer j.cancel()
	defer context.AfterFunc(ctx, j.cancel)()
	for {
		if _, err := j.call.Recv(); err != nil { // the outcome says more
			return j.motion.Wait(ctx)
		}
	}
}

func axisJog(axis string, speed Speed) (*axisgatev1.AxisJog, error) {
	jog := &axisgatev1.AxisJog{Axis: axis, Direction: axisgatev1.AxisJog_DIRECTION_PLUS}
	if speed.amount.negative() {
		jog.Direction = axisgatev1.AxisJog_DIRECTION_MINUS
		speed = speed.Neg()
	}
	var err error
	jog.Speed, err = speed.message()
	return jog, err
}
