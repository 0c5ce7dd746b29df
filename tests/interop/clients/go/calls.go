package main

import (
	"fmt"
	"slices"
	"strings"
	"time"

	"google.golang.org/grpc"
	"google.golang.org/grpc/codes"
	"google.golang.org/protobuf/types/known/durationpb"

	"interop/api"
)

const (
	stage = "devices/stage"
	mill  = "devices/mill"
)

func repeat(n int, call func()) {
	for range n {
		call()
	}
}

// getStage returns the stage. Its state was read before, unless maxAge says otherwise.
func getStage(c *client, maxAge *durationpb.Duration) *api.Device {
	device := must(c.GetDevice(background, &api.GetDeviceRequest{Device: stage, MaxAge: maxAge})).GetDevice()
	expect("the name in GetDevice", device.GetName(), stage)
	return device
}

func checkDevice(c *client) {
	expect("the link of the stage", getStage(c, nil).GetLink(), api.LinkState_LINK_STATE_UP)
}

func checkCaller(c *client) {
	if must(c.GetCaller(background, &api.GetCallerRequest{})).GetCaller().GetName() == "" {
		fail("GetCaller: seen an empty name, expected another")
	}
}

func checkList(c *client) {
	var names []string
	for _, device := range must(c.ListDevices(background, &api.ListDevicesRequest{})).Devices {
		names = append(names, device.Name)
	}
	slices.Sort(names)
	expect("the names in ListDevices", strings.Join(names, " "), mill+" "+stage)
}

func unaryFront(c *client) {
	repeat(200, func() { checkDevice(c) })
	repeat(200, func() { checkList(c) })
	_, err := c.GetDevice(background, &api.GetDeviceRequest{Device: "devices/none"})
	expectCode("GetDevice of devices/none", err, codes.NotFound)
}

func unaryGRPC(c *client) {
	repeat(200, func() { checkCaller(c) })
	commands := must(c.ListCommands(background, &api.ListCommandsRequest{Device: stage})).Commands
	if len(commands) <= 50 {
		fail("ListCommands: seen %d commands, expected more than 50", len(commands))
	}
	_, err := c.GetMotion(background, &api.GetMotionRequest{Motion: stage + "/motions/999999999"})
	expectCode("GetMotion of 999999999", err, codes.NotFound)
}

// expectEnd fails if a stream does not end now, with a code.
func expectEnd[T any](what string, stream interface{ Recv() (T, error) }, expected codes.Code) {
	message, err := stream.Recv()
	if err == nil {
		fail("%s: seen {%v}, expected the end", what, message)
	}
	expectCode(what, err, expected)
}

func checkExecute(c *client) {
	request := &api.ExecuteRequest{Device: stage, Lines: []string{"*IDN?", "Q:", "?:N"}}
	stream := must(c.Execute(background, request))
	for line := range int32(3) {
		message := must(stream.Recv())
		if reply := message.GetReply(); reply == nil || reply.Line != line+1 || reply.Answer == "" {
			fail("Execute: seen {%v}, expected the reply to line %d", message, line+1)
		}
	}
	expectEnd("Execute", stream, codes.OK)
}

func executeLines(c *client) {
	repeat(50, func() { checkExecute(c) })
	stream := must(c.Execute(background, &api.ExecuteRequest{Device: stage, Lines: []string{"QQ:"}}))
	expectEnd("Execute of QQ:", stream, codes.InvalidArgument)
}

// upload sends a job in pieces of almost equal length.
func upload(c *client, title, job string, pieces int, options ...grpc.CallOption) (*api.SendJobResponse, error) {
	stream, err := c.SendJob(background, options...)
	if err != nil {
		return nil, err
	}
	header := &api.JobHeader{Device: mill, Title: title, Tool: "T1"}
	messages := []*api.SendJobRequest{{Part: &api.SendJobRequest_Header{Header: header}}}
	for i := range pieces {
		data := []byte(job[len(job)*i/pieces : len(job)*(i+1)/pieces])
		messages = append(messages, &api.SendJobRequest{Part: &api.SendJobRequest_Data{Data: data}})
	}
	for _, message := range messages {
		// Send fails if the call has ended. CloseAndRecv then returns the status.
		if stream.Send(message) != nil {
			break
		}
	}
	return stream.CloseAndRecv()
}

func sendJob(c *client) {
	text := "^IN;!MC0;!PZ-50,200;" + strings.Repeat("PU4000,0;PU0,0;", 4000) + "H;\n"
	job := must(upload(c, "interop", text, 64)).GetJob()
	expect("job.bytes", job.GetBytes(), int64(len(text)))
	expect("job.title", job.GetTitle(), "interop")
	must(c.CancelJob(background, &api.CancelJobRequest{Job: job.GetName()}))
}

func compressed(c *client) {
	repeat(20, func() { checkDevice(c) })
	repeat(20, func() { checkCaller(c) })
	repeat(20, func() { checkExecute(c) })
	sendJob(c)
	fmt.Println("note grpc-go leaves empty messages uncompressed, so those of GetCaller")
}

func keepLease(c *client) {
	terms := &api.LeaseTerms{Axes: []string{"3"}, TimeToLive: durationpb.New(10 * time.Second)}
	lease := must(c.AcquireLease(background, &api.AcquireLeaseRequest{Device: stage, Terms: terms})).GetLease()
	expect("the length of the token", len(lease.GetToken()), 24)
	stream := must(c.KeepLeaseAlive(background))
	repeat(10, func() {
		// The error of Send is ignored, because Recv returns the status.
		_ = stream.Send(&api.KeepLeaseAliveRequest{Device: stage, LeaseToken: lease.Token})
		expect("lease.axes", fmt.Sprint(must(stream.Recv()).GetLease().GetAxes()), "[3]")
	})
	_ = stream.CloseSend()
	expectEnd("KeepLeaseAlive", stream, codes.OK)
	context := &api.CallContext{LeaseToken: lease.Token}
	must(c.ReleaseLease(background, &api.ReleaseLeaseRequest{Context: context, Device: stage}))
}
