package axisgate

import (
	"context"
	"encoding/hex"
	"fmt"
	"time"

	"google.golang.org/protobuf/proto"
	"google.golang.org/protobuf/types/known/durationpb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

const (
	leaseVariable = "AXISGATE_LEASE"
	tokenBytes    = 24
)

// A deviceSession sends the requests for one device: its connection, its name, and the lease that the calls carry.
type deviceSession struct {
	*connection
	device    string
	inherited []byte

	access    axisgatev1.AccessServiceClient
	control   axisgatev1.ControlServiceClient
	devices   axisgatev1.DeviceServiceClient
	events    axisgatev1.EventServiceClient
	positions axisgatev1.PositionServiceClient
	settings  axisgatev1.SettingServiceClient
	stages    axisgatev1.StageServiceClient
}

func newDeviceSession(c *connection, device, lease string) (*deviceSession, error) {
	token, err := inheritedToken(lease)
	return &deviceSession{connection: c, device: device, inherited: token,
		access:    axisgatev1.NewAccessServiceClient(c.channel),
		control:   axisgatev1.NewControlServiceClient(c.channel),
		devices:   axisgatev1.NewDeviceServiceClient(c.channel),
		events:    axisgatev1.NewEventServiceClient(c.channel),
		positions: axisgatev1.NewPositionServiceClient(c.channel),
		settings:  axisgatev1.NewSettingServiceClient(c.channel),
		stages:    axisgatev1.NewStageServiceClient(c.channel)}, err
}

// A leaseKey is the key of the token of a lease in a context.
type leaseKey struct{ session *deviceSession }

// token returns the token of the lease that ctx carries, or that of `axisctl lease run`. Empty: no lease.
func (s *deviceSession) token(ctx context.Context) []byte {
	if token, ok := ctx.Value(leaseKey{s}).([]byte); ok {
		return token
	}
	return s.inherited
}

func inheritedToken(text string) ([]byte, error) {
	token, err := hex.DecodeString(text)
	if err != nil || (len(token) != 0 && len(token) != tokenBytes) {
		return nil, invalid("%s is not the token of a lease: unset it, or use `axisctl lease run`", leaseVariable)
	}
	return token, nil
}

// A changing message is a request that has a CallContext.
type changing[Q any] interface {
	*Q
	proto.Message
	GetContext() *axisgatev1.CallContext
}

// change sends a request that changes something, under the lease that ctx carries, and returns its answer.
func change[Q any, P changing[Q], A any](ctx context.Context, s *deviceSession, call method[Q, A], request P,
	patience time.Duration) (*A, error) {
	return act(ctx, s.connection, s.token(ctx), patience, func(context *axisgatev1.CallContext) attempt[*A] {
		return call.attempt(withContext(request, context))
	})
}

// A starting message is an answer that has a motion.
type starting interface{ GetMotion() *axisgatev1.Motion }

// start starts a motion.
func start[Q any, P changing[Q], A any, R interface {
	*A
	starting
}](ctx context.Context, s *deviceSession, call method[Q, A], request P) (*Motion, error) {
	answer, err := change(ctx, s, call, request, 0)
	if err != nil {
		return nil, err
	}
	return newMotion(s, R(answer).GetMotion()), nil
}

// finish waits for the outcome of the motion that `begin` starts. The end of ctx cancels the motion.
//
// The end of ctx does not end `begin`, which would leave it open whether the motion has started.
func (s *deviceSession) finish(ctx context.Context, begin func(context.Context) (*Motion, error)) (*Result, error) {
	if err := s.interruption(ctx); err != nil {
		return nil, err
	}
	motion, err := begin(context.WithoutCancel(ctx))
	if err != nil {
		return nil, err
	}
	result, err := motion.Wait(ctx)
	if err == nil || ctx.Err() == nil || motion.over() {
		return result, err
	}
	if failed := motion.Cancel(ctx); failed != nil {
		return nil, lookFirst(fmt.Sprintf("%s was interrupted, but not cancelled: %v", motion.Name(), failed), "",
			ctx.Err())
	}
	return nil, fmt.Errorf("axisgate: %s is cancelled: %w", motion.Name(), ctx.Err())
}

// read returns the state of the device, which is read again if it is older than `maxAge`. nil: any age.
func (s *deviceSession) read(ctx context.Context, maxAge *time.Duration) (*axisgatev1.Device, error) {
	request := &axisgatev1.GetDeviceRequest{Device: s.device}
	if maxAge != nil {
		request.MaxAge = durationpb.New(*maxAge)
	}
	answer, err := ask(ctx, s.connection, s.devices.GetDevice, request, s.half)
	if err != nil {
		return nil, err
	}
	return answer.Device, nil
}
