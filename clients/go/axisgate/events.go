package axisgate

import (
	"context"
	"strings"
	"time"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// An EventOrGap is an *[Event], or a *[Gap] if events were missed.
type EventOrGap interface{ isEventOrGap() }

// An Event is one fact about a device or the daemon.
type Event struct {
	// Revision is the number of the event, ascending over all devices and over restarts.
	Revision uint64
	// Time is the time of the event by the daemon's clock.
	Time time.Time
	// Device is the name of the device. Empty: an event of the daemon itself.
	Device string
	// Kind is the name of the fact, such as "motion", "stop_requested" or "condition". Empty for a fact of a newer
	// daemon.
	Kind string
	// Message is the event as the API's message, which has the fact.
	Message *axisgatev1.Event
}

// A Gap means that events were missed, because they are no longer kept.
type Gap struct {
	// ResumeRevision is the revision of the event with which the stream continues.
	ResumeRevision uint64
}

func (*Event) isEventOrGap() {}
func (*Gap) isEventOrGap()   {}

// Events streams every event from now on, each once and in order, also over broken connections and restarts of the
// daemon. A Gap in the series means that events were missed. The stream lasts until ctx ends or it is closed.
func (s *Stage) Events(ctx context.Context) (*Stream[EventOrGap], error) {
	listed, err := s.session.list(ctx)
	if err != nil {
		return nil, err
	}
	return s.watchEvents(ctx, cursorNow(s.session.device, listed))
}

// EventsFrom does the same as Events from a revision on. Revision 0: all kept events.
func (s *Stage) EventsFrom(ctx context.Context, revision uint64) (*Stream[EventOrGap], error) {
	return s.watchEvents(ctx, &cursor{device: s.session.device, first: revision})
}

// EventsAfter does the same as Events from the successor of an event on.
func (s *Stage) EventsAfter(ctx context.Context, last *Event) (*Stream[EventOrGap], error) {
	c := &cursor{device: s.session.device}
	c.take(last.Message)
	return s.watchEvents(ctx, c)
}

func (s *Stage) watchEvents(ctx context.Context, c *cursor) (*Stream[EventOrGap], error) {
	return newStream(ctx, s.session.connection, feed[*axisgatev1.WatchResponse, EventOrGap]{
		begin: func(ctx context.Context) (answers[*axisgatev1.WatchResponse], error) {
			return s.session.events.Watch(ctx, c.request())
		},
		item: func(answer *axisgatev1.WatchResponse) EventOrGap {
			c.take(answer.Event)
			return eventOf(answer.Event)
		},
		skip: func(f failure) (EventOrGap, bool) {
			gap := c.gapAfter(f)
			return gap, gap != nil
		},
	})
}

func eventOf(event *axisgatev1.Event) *Event {
	message := event.ProtoReflect()
	fact := message.WhichOneof(message.Descriptor().Oneofs().ByName("fact"))
	kind := ""
	if fact != nil {
		kind = string(fact.Name())
	}
	return &Event{Revision: event.Revision, Time: event.Time.AsTime(), Kind: kind, Message: event,
		Device: strings.TrimPrefix(event.Device, "devices/")}
}
