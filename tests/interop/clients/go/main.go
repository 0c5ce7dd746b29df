// Client runs one row of the interop tests with grpc-go: client ROW TARGET.
package main

import (
	"context"
	"fmt"
	"io"
	"os"
	"reflect"
	"strings"
	"sync/atomic"
	"time"

	"google.golang.org/genproto/googleapis/rpc/code"
	"google.golang.org/grpc"
	"google.golang.org/grpc/codes"
	"google.golang.org/grpc/credentials/insecure"
	"google.golang.org/grpc/encoding/gzip"
	"google.golang.org/grpc/keepalive"
	"google.golang.org/grpc/status"

	"interop/api"
)

// pingInterval is the smallest interval of PING that grpc-go permits.
const pingInterval = 10 * time.Second

var background = context.Background()

// calls counts the calls that were made.
var calls atomic.Int64

// rows are the rows of the table in README.md.
var rows = map[string]func(*client){
	"unary-front": unaryFront,
	"unary-grpc":  unaryGRPC,
	"watch":       watchMoves,
	"execute":     executeLines,
	"send-job":    sendJob,
	"jog":         jogToEnd,
	"keep-lease":  keepLease,
	"gzip":        compressed,
	"deadline":    passDeadline,
	"cancel":      cancelJog,
	"keepalive":   keepAlive,
	"metadata":    longMetadata,
	"many":        manyAtOnce,
	"restart":     resumeAfterRestart,
	"end-in-call": endInCall,
}

// options are those of a row's channel besides the usual ones, which they override.
var options = map[string][]grpc.DialOption{
	"gzip": {grpc.WithDefaultCallOptions(grpc.UseCompressor(gzip.Name))},
	// Of 30 s, the silence of 26 s would leave only 4 s for the move.
	"keepalive": {grpc.WithKeepaliveParams(keepalive.ClientParameters{Time: pingInterval, PermitWithoutStream: true}),
		callDeadline(60)},
}

// callDeadline sets the deadline of calls whose context has no earlier one.
func callDeadline(seconds int) grpc.DialOption {
	return grpc.WithDefaultServiceConfig(fmt.Sprintf(`{"methodConfig": [{"name": [{}], "timeout": "%ds"}]}`, seconds))
}

// A client has the stubs of all services that the rows call, over one channel.
type client struct {
	api.AccessServiceClient
	api.CommandServiceClient
	api.ControlServiceClient
	api.DeviceServiceClient
	api.EventServiceClient
	api.MillServiceClient
	api.StageServiceClient
}

func newClient(channel *grpc.ClientConn) *client {
	return &client{api.NewAccessServiceClient(channel), api.NewCommandServiceClient(channel),
		api.NewControlServiceClient(channel), api.NewDeviceServiceClient(channel), api.NewEventServiceClient(channel),
		api.NewMillServiceClient(channel), api.NewStageServiceClient(channel)}
}

// fail ends the program. It may be called from any goroutine.
func fail(format string, arguments ...any) {
	fmt.Printf("calls %d\n", calls.Load())
	fmt.Fprintln(os.Stderr, strings.ReplaceAll(fmt.Sprintf(format, arguments...), "\n", " "))
	os.Exit(1)
}

// codeOf returns the name of a status as in the gRPC specification. The error io.EOF is the end of a stream with OK.
func codeOf(err error) string {
	if err == io.EOF {
		err = nil
	}
	return code.Code(status.Code(err)).String()
}

// must returns an answer or the next message of a stream, and fails if there is none.
func must[T any](answer T, err error) T {
	if err != nil {
		fail("a call ended with %s (%v), expected %v", codeOf(err), err, reflect.TypeFor[T]())
	}
	return answer
}

// expect fails if a value is not the expected one.
func expect[T comparable](what string, seen, expected T) {
	if seen != expected {
		fail("%s: seen %v, expected %v", what, seen, expected)
	}
}

// expectCode fails if a call has ended with another code.
func expectCode(what string, err error, expected codes.Code) {
	if seen, name := codeOf(err), code.Code(expected).String(); seen != name {
		fail("%s ended with %s (%v), expected %s", what, seen, err, name)
	}
}

func countUnary(ctx context.Context, method string, request, answer any, channel *grpc.ClientConn,
	call grpc.UnaryInvoker, options ...grpc.CallOption) error {
	calls.Add(1)
	return call(ctx, method, request, answer, channel, options...)
}

func countStream(ctx context.Context, description *grpc.StreamDesc, channel *grpc.ClientConn, method string,
	call grpc.Streamer, options ...grpc.CallOption) (grpc.ClientStream, error) {
	calls.Add(1)
	return call(ctx, description, channel, method, options...)
}

func main() {
	if len(os.Args) == 2 && os.Args[1] == "--version" {
		fmt.Println("grpc-go", grpc.Version)
		return
	}
	if len(os.Args) != 3 || rows[os.Args[1]] == nil {
		fail("usage: client ROW TARGET, or client --version")
	}
	channel := must(grpc.NewClient(os.Args[2], append([]grpc.DialOption{callDeadline(30), grpc.WithNoProxy(),
		grpc.WithTransportCredentials(insecure.NewCredentials()), grpc.WithUnaryInterceptor(countUnary),
		grpc.WithStreamInterceptor(countStream)}, options[os.Args[1]]...)...))
	rows[os.Args[1]](newClient(channel))
	channel.Close()
	fmt.Printf("calls %d\n", calls.Load())
}
