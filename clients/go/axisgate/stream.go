package axisgate

import (
	"context"
	"errors"
	"iter"
	"sync"

	"google.golang.org/grpc/metadata"
)

// A Stream is a series of items that continues after a broken connection. It ends with its context, with Close, and
// with the Stage.
type Stream[T any] struct {
	mutex  sync.Mutex
	next   func() (T, error)
	cancel context.CancelFunc
}

// All yields the items. The iteration can be left and continued; only one goroutine receives at a time. It ends without
// an error after Close; otherwise its last error is that of the context, of the daemon, or [ErrClosed].
func (s *Stream[T]) All() iter.Seq2[T, error] {
	return func(yield func(T, error) bool) {
		for {
			item, err := s.receive()
			if errors.Is(err, errStreamClosed) || !yield(item, err) || err != nil {
				return
			}
		}
	}
}

// Close ends the stream, also for another goroutine that iterates.
func (s *Stream[T]) Close() { s.cancel() }

func (s *Stream[T]) receive() (T, error) {
	s.mutex.Lock()
	defer s.mutex.Unlock()
	return s.next()
}

var errStreamClosed = errors.New("axisgate: the stream is closed")

// answers are the answers of one call.
type answers[A any] interface {
	Recv() (A, error)
	Header() (metadata.MD, error)
}

// A feed is how a stream begins, and what its answers become. `skip` returns the item for answers that can no longer be
// received, and reports whether there is one; it may be nil.
type feed[A, T any] struct {
	begin func(context.Context) (answers[A], error)
	item  func(A) T
	skip  func(failure) (T, bool)
}

// newStream begins a stream, and returns once the daemon has begun to answer.
func newStream[A, T any](ctx context.Context, c *connection, f feed[A, T]) (*Stream[T], error) {
	own, cancel := context.WithCancel(ctx)
	r := &resuming[A, T]{connection: c, feed: f, caller: ctx, own: own}
	r.begin()
	if err := r.ended(); err != nil {
		cancel()
		return nil, err
	}
	if r.call == nil && !r.failed.passing() {
		cancel()
		return nil, errorOf(r.failed, c.target.address)
	}
	return &Stream[T]{next: r.next, cancel: cancel}, nil
}

// A resuming is a call that is begun again after a broken connection. `call` is nil if it has failed.
type resuming[A, T any] struct {
	*connection
	feed    feed[A, T]
	caller  context.Context
	own     context.Context
	call    answers[A]
	failed  failure
	backoff backoff
}

// ended returns why the stream has ended, or nil.
func (r *resuming[A, T]) ended() error {
	if err := r.interruption(r.caller); err != nil {
		return err
	}
	if r.own.Err() != nil {
		return errStreamClosed
	}
	return nil
}

// begin sends the request, and waits until the daemon has begun to answer.
func (r *resuming[A, T]) begin() {
	call, err := r.feed.begin(r.own)
	if err != nil {
		r.fail(err, false)
		return
	}
	r.call = call
	if header, err := call.Header(); header == nil || err != nil {
		_, err := call.Recv() // says why the call ended without headers
		r.fail(err, true)
	}
}

func (r *resuming[A, T]) fail(err error, sent bool) {
	r.call, r.failed = nil, failureOf(err, sent)
}

func (r *resuming[A, T]) next() (T, error) {
	var none T
	for {
		if r.call != nil {
			answer, err := r.call.Recv()
			if err == nil {
				r.backoff = backoff{}
				return r.feed.item(answer), nil
			}
			r.fail(err, true)
		}
		if err := r.ended(); err != nil {
			return none, err
		}
		if item, found, err := r.resume(); found || err != nil {
			return item, err
		}
	}
}

// resume begins the call again. It returns an item for what was missed, and whether there is one.
func (r *resuming[A, T]) resume() (item T, found bool, err error) {
	if r.feed.skip != nil {
		item, found = r.feed.skip(r.failed)
	}
	if !found {
		if !r.failed.passing() && r.failed.reason() != "QUEUE_FULL" {
			return item, false, errorOf(r.failed, r.target.address)
		}
		r.pause(r.own, r.channel, r.failed, r.backoff.pause())
	}
	r.begin()
	return item, found, nil
}
