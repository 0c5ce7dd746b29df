package axisgate

import (
	"context"
	"time"

	"google.golang.org/grpc"
	grpcbackoff "google.golang.org/grpc/backoff"
	"google.golang.org/grpc/keepalive"
	"google.golang.org/grpc/metadata"
	"google.golang.org/grpc/peer"
	"google.golang.org/grpc/status"
)

// dial returns a channel. gRPC itself repeats nothing, and keeps the channel connected.
func (c *connection) dial() (*grpc.ClientConn, error) {
	credentials, err := c.target.credentials()
	if err != nil {
		return nil, err
	}
	pauses := grpcbackoff.Config{BaseDelay: firstPause, Multiplier: 1.6, Jitter: 0.2, MaxDelay: time.Second}
	return grpc.NewClient(c.target.dialed(),
		grpc.WithTransportCredentials(credentials),
		grpc.WithDisableRetry(),
		grpc.WithDisableServiceConfig(),
		grpc.WithIdleTimeout(0),
		grpc.WithConnectParams(grpc.ConnectParams{Backoff: pauses, MinConnectTimeout: 5 * time.Second}),
		grpc.WithKeepaliveParams(keepalive.ClientParameters{
			Time: 20 * time.Second, Timeout: 10 * time.Second, PermitWithoutStream: true}),
		grpc.WithUnaryInterceptor(c.sendUnary),
		grpc.WithStreamInterceptor(c.beginStream))
}

// A reachedKey is the key of a flag in the context of a call. The flag is set if gRPC had a connection for the call.
type reachedKey struct{}

func (c *connection) sendUnary(ctx context.Context, method string, request, answer any, channel *grpc.ClientConn,
	next grpc.UnaryInvoker, options ...grpc.CallOption) error {
	began := time.Now()
	var reached peer.Peer
	err := next(metadata.NewOutgoingContext(ctx, c.metadata), method, request, answer, channel,
		append(options, grpc.Peer(&reached))...)
	markReached(ctx, reached.Addr != nil)
	c.logger.DebugContext(ctx, "call", "method", method, "duration", time.Since(began), "code", status.Code(err).String())
	return err
}

func (c *connection) beginStream(ctx context.Context, description *grpc.StreamDesc, channel *grpc.ClientConn,
	method string, next grpc.Streamer, options ...grpc.CallOption) (grpc.ClientStream, error) {
	stream, err := next(metadata.NewOutgoingContext(ctx, c.metadata), description, channel, method, options...)
	markReached(ctx, err == nil)
	c.logger.DebugContext(ctx, "stream", "method", method, "code", status.Code(err).String())
	return stream, err
}

func markReached(ctx context.Context, reached bool) {
	if flag, ok := ctx.Value(reachedKey{}).(*bool); ok {
		*flag = reached
	}
}
