package axisgate

import (
	"context"
	"fmt"
	"math"
	"time"

	"google.golang.org/grpc"
	"google.golang.org/grpc/connectivity"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// An attempt sends a request once.
type attempt[A any] func(context.Context) (A, error)

// A method is a call of a generated client.
type method[Q, A any] func(context.Context, *Q, ...grpc.CallOption) (*A, error)

// attempt returns the function that sends the request, always with the same bytes.
func (m method[Q, A]) attempt(request *Q) attempt[*A] {
	return func(ctx context.Context) (*A, error) { return m(ctx, request) }
}

// once sends a request within the limit. It returns nil or the failure.
func once[A any](ctx context.Context, limit time.Duration, try attempt[A]) (A, *failure) {
	ctx, cancel := context.WithTimeout(ctx, limit)
	defer cancel()
	var reached bool
	answer, err := try(context.WithValue(ctx, reachedKey{}, &reached))
	if err == nil {
		return answer, nil
	}
	f := failureOf(err, reached)
	return answer, &f
}

// send sends a request, and sends it again as `r` decides. It returns the answer or the error with which `r` ends.
func send[A any](ctx context.Context, c *connection, channel *grpc.ClientConn, r *repeat, try attempt[A]) (A, error) {
	var none A
	if err := c.interruption(ctx); err != nil {
		return none, err
	}
	for {
		answer, f := once(ctx, r.timeout(time.Now()), try)
		if f == nil {
			return answer, nil
		}
		if err := c.interruption(ctx); err != nil {
			return none, r.interrupted(*f, err)
		}
		pause, err := r.after(*f, time.Now())
		if err != nil {
			return none, err
		}
		c.pause(ctx, channel, *f, pause)
	}
}

// pause waits; if the call had no connection, at most until there is one.
func (c *connection) pause(ctx context.Context, channel *grpc.ClientConn, f failure, pause time.Duration) {
	ctx, cancel := context.WithTimeout(ctx, pause)
	defer cancel()
	defer context.AfterFunc(c.open, cancel)()
	if !f.neverSent() {
		<-ctx.Done()
		return
	}
	for state := channel.GetState(); state != connectivity.Ready; state = channel.GetState() {
		channel.Connect()
		if !channel.WaitForStateChange(ctx, state) {
			return
		}
	}
}

// ask returns the answer to a question. It is repeated for `patience` while no daemon answers.
func ask[Q, A any](ctx context.Context, c *connection, call method[Q, A], request *Q,
	patience time.Duration) (*A, error) {
	r := &repeat{until: time.Now().Add(patience), target: c.target.address, answer: c.half}
	return send(ctx, c, c.channel, r, call.attempt(request))
}

// list lists the devices.
func (c *connection) list(ctx context.Context) (*axisgatev1.ListDevicesResponse, error) {
	devices := axisgatev1.NewDeviceServiceClient(c.channel)
	return ask(ctx, c, devices.ListDevices, &axisgatev1.ListDevicesRequest{}, c.half)
}

// connect connects the channel for stops, and lists the devices. It fails at once if no daemon answers.
func (c *connection) connect(ctx context.Context) (*axisgatev1.ListDevicesResponse, error) {
	devices := axisgatev1.NewDeviceServiceClient(c.stops)
	r := &repeat{until: time.Now(), target: c.target.address, answer: c.half}
	list := method[axisgatev1.ListDevicesRequest, axisgatev1.ListDevicesResponse](devices.ListDevices)
	return send(ctx, c, c.stops, r, list.attempt(&axisgatev1.ListDevicesRequest{}))
}

// act sends a request that changes something, so that it acts at most once, and returns its answer. `patience` is the
// time that the request may wait for something. `with` returns the function that sends the request with its context.
func act[A any](ctx context.Context, c *connection, token []byte, patience time.Duration,
	with func(*axisgatev1.CallContext) attempt[A]) (A, error) {
	var none A
	listed, err := c.list(ctx)
	if err != nil {
		return none, err
	}
	memory := listed.RequestMemory
	if !listed.RequestsKept {
		memory = ""
	}
	patience += c.half
	var ahead time.Duration
	if !c.target.isLocal() {
		ahead = clockAhead(listed.Devices, time.Now())
	}
	now := time.Now()
	call := newContext(memory, token, now.Add(ahead+patience))
	r := &repeat{until: now.Add(patience), target: c.target.address, answer: c.half, acts: true,
		remembered: memory != ""}
	answer, err := send(ctx, c, c.channel, r, with(call))
	if err == nil {
		err = checkOwn(answer, call.RequestId)
	}
	return answer, err
}

// checkOwn returns an OutcomeUnknown if the motion of the answer is that of another request.
func checkOwn(answer any, requestID string) error {
	var motion *axisgatev1.Motion
	switch answer := answer.(type) {
	case *axisgatev1.Motion:
		motion = answer
	case interface{ GetMotion() *axisgatev1.Motion }:
		motion = answer.GetMotion()
	}
	if motion == nil || motion.RequestId == requestID {
		return nil
	}
	return lookFirst(fmt.Sprintf("the daemon answered with %s, which another request started", motion.Name), "", nil)
}

// stop sends a stop over its own channel. The end of ctx does not keep the stop from being sent.
func stop[Q, A any](ctx context.Context, c *connection, call method[Q, A], request *Q) (*A, error) {
	r := &repeat{until: time.Now().Add(c.half), target: c.target.address, answer: c.half, acts: true, remembered: true}
	answer, err := send(context.WithoutCancel(ctx), c, c.stops, r, call.attempt(request))
	return answer, undelivered(err)
}

// follow returns the motion with its outcome, or as it is at `end`. A zero `end`: no limit.
func (c *connection) follow(ctx context.Context, motion *axisgatev1.Motion, end time.Time) (*axisgatev1.Motion, error) {
	wait := method[axisgatev1.WaitMotionRequest, axisgatev1.WaitMotionResponse](
		axisgatev1.NewStageServiceClient(c.channel).WaitMotion)
	f := &following{motion: motion, target: c.target.address, answered: time.Now()}
	for !isOver(f.motion) {
		if err := c.interruption(ctx); err != nil {
			return f.motion, err
		}
		left := timeLeft(ctx, end)
		request, limit := f.question(left)
		answer, failed := once(ctx, limit, wait.attempt(request))
		if err := c.took(ctx, f, answer, failed); err != nil {
			return f.motion, err
		}
		if left <= 0 && !end.IsZero() {
			break
		}
	}
	return f.motion, nil
}

// took takes the answer to a question for an outcome, or waits after its failure.
func (c *connection) took(ctx context.Context, f *following, answer *axisgatev1.WaitMotionResponse,
	failed *failure) error {
	if failed == nil {
		return f.take(answer.Motion, time.Now())
	}
	if err := c.interruption(ctx); err != nil {
		return err
	}
	pause, err := f.after(*failed, time.Now())
	if err == nil {
		c.pause(ctx, c.channel, *failed, pause)
	}
	return err
}

// timeLeft returns the time until `end`, or until the deadline of ctx if it is earlier.
func timeLeft(ctx context.Context, end time.Time) time.Duration {
	left := time.Duration(math.MaxInt64)
	if !end.IsZero() {
		left = time.Until(end)
	}
	if deadline, ok := ctx.Deadline(); ok {
		left = min(left, time.Until(deadline))
	}
	return left
}
