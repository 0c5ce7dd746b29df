package main

import (
	"context"
	"fmt"
	"math/rand/v2"
	"time"

	"google.golang.org/grpc"
	"google.golang.org/grpc/credentials/insecure"
	"google.golang.org/grpc/metadata"
	"google.golang.org/protobuf/types/known/durationpb"
	"google.golang.org/protobuf/types/known/timestamppb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

const (
	timeout = 10 * time.Second
	maxWait = 10 * time.Second
)

// A bare is a program without the package.
type bare struct {
	channel *grpc.ClientConn
	devices axisgatev1.DeviceServiceClient
	stages  axisgatev1.StageServiceClient
	session string
	device  string
	axis    string
}

func randomID() string { return fmt.Sprintf("%016x%016x", rand.Uint64(), rand.Uint64()) }

func newBare(target, device, axis string) (*bare, error) {
	channel, err := grpc.NewClient(target, grpc.WithTransportCredentials(insecure.NewCredentials()))
	if err != nil {
		return nil, err
	}
	return &bare{channel, axisgatev1.NewDeviceServiceClient(channel), axisgatev1.NewStageServiceClient(channel),
		randomID(), device, axis}, nil
}

// send sends a request once.
func send[Q, A any](ctx context.Context, b *bare, call func(context.Context, *Q, ...grpc.CallOption) (*A, error),
	request *Q, limit time.Duration) (*A, error) {
	ctx, cancel := context.WithTimeout(metadata.AppendToOutgoingContext(ctx, "axisgate-session", b.session), limit)
	defer cancel()
	return call(ctx, request)
}

func (b *bare) getDevice(ctx context.Context, _ int64) error {
	_, err := send(ctx, b, b.devices.GetDevice, &axisgatev1.GetDeviceRequest{Device: b.device}, timeout)
	return err
}

func (b *bare) move(ctx context.Context, step int64) error {
	listed, err := send(ctx, b, b.devices.ListDevices, &axisgatev1.ListDevicesRequest{}, timeout)
	if err != nil {
		return err
	}
	started, err := send(ctx, b, b.stages.Move, &axisgatev1.MoveRequest{
		Context: &axisgatev1.CallContext{RequestId: randomID(), RequestMemory: listed.RequestMemory,
			NotAfter: timestamppb.New(time.Now().Add(timeout / 2))},
		Device: b.device, Relative: true,
		Targets: []*axisgatev1.AxisTarget{{Axis: b.axis,
			Distance: &axisgatev1.Distance{Amount: &axisgatev1.Distance_Pulses{Pulses: step}}}}}, timeout)
	if err != nil {
		return err
	}
	for motion := started.Motion; motion.EndTime == nil; {
		answer, err := send(ctx, b, b.stages.WaitMotion,
			&axisgatev1.WaitMotionRequest{Motion: motion.Name, MaxWait: durationpb.New(maxWait)}, maxWait+timeout)
		if err != nil {
			return err
		}
		motion = answer.Motion
	}
	return nil
}
