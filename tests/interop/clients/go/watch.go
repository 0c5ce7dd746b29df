package main

import (
	"context"
	"fmt"
	"strings"
	"sync"
	"time"

	"google.golang.org/grpc"
	"google.golang.org/grpc/codes"
	"google.golang.org/grpc/metadata"
	"google.golang.org/grpc/status"
	"google.golang.org/protobuf/proto"
	"google.golang.org/protobuf/types/known/durationpb"

	"interop/api"
)

// A watch is a Watch whose events must be contiguous.
type watch struct {
	*client
	stream api.EventService_WatchClient
	// Newest event. nil before the first one.
	last  *api.Event
	moves int
}

func watchAll(ctx context.Context, c *client) *watch {
	return &watch{client: c, stream: must(c.Watch(ctx, &api.WatchRequest{FromRevision: proto.Uint64(0)}))}
}

// receive returns the next event, or the status with which the call has ended.
func (w *watch) receive() (*api.Event, error) {
	message, err := w.stream.Recv()
	if err != nil {
		return nil, err
	}
	if w.last != nil {
		expect("event.revision", message.GetEvent().GetRevision(), w.last.Revision+1)
	}
	w.last = message.Event
	return w.last, nil
}

// expectEnd receives events until the call ends, and fails if it ends with another code.
func (w *watch) expectEnd(expected codes.Code) {
	for {
		if _, err := w.receive(); err != nil {
			expectCode("Watch", err, expected)
			return
		}
	}
}

// move moves axis 1 to or fro, and receives events until one has the outcome, which must be SUCCEEDED.
func (w *watch) move() {
	distance := &api.Distance{Amount: &api.Distance_Um{Um: []string{"10", "-10"}[w.moves%2]}}
	w.moves++
	name := must(w.Move(background, &api.MoveRequest{Device: stage, Relative: true,
		Targets: []*api.AxisTarget{{Axis: "1", Distance: distance}}})).GetMotion().GetName()
	for {
		motion := must(w.receive()).GetMotion()
		if motion.GetName() == name && motion.GetState() >= api.MotionState_MOTION_STATE_SUCCEEDED {
			expect("the state of "+name, motion.GetState(), api.MotionState_MOTION_STATE_SUCCEEDED)
			return
		}
	}
}

func watchMoves(c *client) {
	ctx, cancel := context.WithCancel(background)
	w := watchAll(ctx, c)
	repeat(3, w.move)
	cancel()
	w.expectEnd(codes.Canceled)
}

func passDeadline(c *client) {
	begin := time.Now()
	ctx, cancel := context.WithTimeout(background, 500*time.Millisecond)
	defer cancel()
	w := &watch{client: c, stream: must(c.Watch(ctx, &api.WatchRequest{}))}
	w.expectEnd(codes.DeadlineExceeded)
	if took := time.Since(begin).Seconds(); took < 0.4 || took > 5 {
		fail("the deadline of 500 ms: seen after %.3f s, expected after 0.4 to 5 s", took)
	}
	checkDevice(c)
	checkCaller(c)
}

// sendJog ignores the error of Send, because Recv returns the status.
func sendJog(stream api.StageService_JogClient, device string, direction api.AxisJog_Direction, speed int64) {
	axis := &api.AxisJog{Axis: "2", Direction: direction,
		Speed: &api.Speed{Amount: &api.Speed_PulsesPerS{PulsesPerS: speed}}}
	_ = stream.Send(&api.JogRequest{Device: device, Axes: []*api.AxisJog{axis}})
}

// startJog starts a jog, and returns when its state is RUNNING.
func startJog(ctx context.Context, c *client) api.StageService_JogClient {
	stream := must(c.Jog(ctx))
	sendJog(stream, stage, api.AxisJog_DIRECTION_PLUS, 1000)
	for must(stream.Recv()).GetMotion().GetState() != api.MotionState_MOTION_STATE_RUNNING {
	}
	return stream
}

func jogToEnd(c *client) {
	stream := startJog(background, c)
	sendJog(stream, "", api.AxisJog_DIRECTION_UNSPECIFIED, 2000)
	_ = stream.CloseSend()
	last := &api.JogResponse{}
	for {
		answer, err := stream.Recv()
		if err != nil {
			expectCode("Jog", err, codes.OK)
			break
		}
		last = answer
	}
	expect("the last state of Jog", last.GetMotion().GetState(), api.MotionState_MOTION_STATE_SUCCEEDED)
}

func cancelJog(c *client) {
	ctx, cancel := context.WithCancel(background)
	startJog(ctx, c)
	cancel()
	read := func() *api.Axis {
		time.Sleep(50 * time.Millisecond)
		// A state from before the jog would show an axis that is not busy.
		axes := getStage(c, durationpb.New(0)).GetAxes()
		expect("the number of axes", len(axes), 3)
		return axes[1]
	}
	for begin, axis := time.Now(), read(); axis.Busy == nil || *axis.Busy; axis = read() {
		if time.Since(begin) > 10*time.Second {
			fail("axis 2: seen busy 10 s after the jog was cancelled, expected that it stops")
		}
	}
	first := read().GetPositionPulses()
	expect("position_pulses of the second answer", read().GetPositionPulses(), first)
}

func keepAlive(c *client) {
	w := watchAll(background, c)
	time.Sleep(pingInterval*5/2 + time.Second)
	w.move()
}

func longMetadata(c *client) {
	w := watchAll(background, c)
	must(w.receive())
	for _, kib := range []int{8, 15, 40} {
		ctx := metadata.AppendToOutgoingContext(background, "x-note", strings.Repeat("a", kib<<10))
		_, caller := c.GetCaller(ctx, &api.GetCallerRequest{})
		_, device := c.GetDevice(ctx, &api.GetDeviceRequest{Device: stage})
		expectLong(fmt.Sprintf("GetCaller with %d KiB", kib), caller, kib)
		expectLong(fmt.Sprintf("GetDevice with %d KiB", kib), device, kib)
	}
	w.move()
}

// expectLong accepts that grpc-go itself refuses to send 40 KiB.
func expectLong(what string, err error, kib int) {
	if kib < 40 {
		expectCode(what, err, codes.OK)
	} else if strings.Contains(status.Convert(err).Message(), "header list size to send violates") {
		fmt.Printf("note %s is not sent: %s by grpc-go itself\n", what, codeOf(err))
	} else {
		expectCode(what, err, codes.ResourceExhausted)
	}
}

func manyAtOnce(c *client) {
	w := watchAll(background, c)
	var answers sync.WaitGroup
	repeat(500, func() { answers.Go(func() { getStage(c, nil) }) })
	repeat(10, w.move)
	answers.Wait()
}

func resumeAfterRestart(c *client) {
	w := watchAll(background, c)
	w.move()
	fmt.Println("ready")
	w.expectEnd(codes.Unavailable)
	request := &api.WatchRequest{FromRevision: proto.Uint64(w.last.Revision + 1), Run: w.last.Run}
	w.stream = must(c.Watch(background, request, grpc.WaitForReady(true)))
	for must(w.receive()).GetDaemonStarted() == nil {
	}
	for begin := time.Now(); getStage(c, nil).GetLink() != api.LinkState_LINK_STATE_UP; {
		if time.Since(begin) > 30*time.Second {
			fail("the link of the stage: seen not UP for 30 s, expected UP")
		}
		time.Sleep(50 * time.Millisecond)
	}
}

func endInCall(c *client) {
	titles := make(chan string)
	var senders sync.WaitGroup
	var output sync.Mutex
	sent := 0
	send := func(title string) {
		_, err := upload(c, title, "^IN;!MC0;PU0,0;H;\n", 4, grpc.WaitForReady(true))
		output.Lock()
		defer output.Unlock()
		if err != nil {
			fmt.Println("failed", title, codeOf(err))
			return
		}
		fmt.Println("sent", title)
		if sent++; sent == 10 {
			fmt.Println("ready")
		}
	}
	repeat(4, func() {
		senders.Go(func() {
			for title := range titles {
				send(title)
			}
		})
	})
	for i := range 40 {
		titles <- fmt.Sprintf("end-%d", i)
	}
	close(titles)
	senders.Wait()
}
