package axisgate

import (
	"context"
	"log/slog"
	"sync"
	"time"

	"google.golang.org/grpc"
	"google.golang.org/grpc/metadata"
)

// session is the session of this process: the daemon treats all of its connections as one program.
var session = newUUID()

// A connection is the daemon as one program sees it. It sends and waits; repeat and following decide.
//
// Stops have a channel of their own, which is open from the start, so that no other call delays them.
type connection struct {
	target   target
	half     time.Duration
	logger   *slog.Logger
	metadata metadata.MD

	channel *grpc.ClientConn
	stops   *grpc.ClientConn

	// `open` ends when the connection is closed. `tasks` are the goroutines that end then; `mutex` guards their start.
	open  context.Context
	shut  context.CancelFunc
	mutex sync.Mutex
	tasks sync.WaitGroup
}

func newConnection(s settings) (*connection, error) {
	t, err := newTarget(s)
	if err != nil {
		return nil, err
	}
	c := &connection{target: t, half: s.timeout / 2, logger: s.logger,
		metadata: metadata.Pairs("axisgate-session", session)}
	if t.token != "" {
		c.metadata.Set("authorization", "Bearer "+t.token)
	}
	if c.channel, err = c.dial(); err != nil {
		return nil, err
	}
	if c.stops, err = c.dial(); err != nil {
		c.channel.Close()
		return nil, err
	}
	c.open, c.shut = context.WithCancel(context.Background())
	return c, nil
}

// spawn runs a task, which must end when the connection is closed. Returns false if it is closed already.
func (c *connection) spawn(task func()) bool {
	c.mutex.Lock()
	defer c.mutex.Unlock()
	if c.open.Err() != nil {
		return false
	}
	c.tasks.Add(1)
	go func() {
		defer c.tasks.Done()
		task()
	}()
	return true
}

// close ends all calls and tasks. Motions continue.
func (c *connection) close() error {
	c.mutex.Lock()
	c.shut()
	c.mutex.Unlock()
	err := c.channel.Close()
	if other := c.stops.Close(); err == nil {
		err = other
	}
	c.tasks.Wait()
	return err
}

// interruption returns why the caller waits no longer, or nil.
func (c *connection) interruption(ctx context.Context) error {
	if c.open.Err() != nil {
		return ErrClosed
	}
	return ctx.Err()
}
