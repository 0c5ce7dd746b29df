package axisgate

import (
	"strconv"

	"google.golang.org/protobuf/proto"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A cursor knows the first event that a watcher has not received yet. `first` is its revision. 0: all kept events.
// `run` is the run to which the revision belongs, or empty.
type cursor struct {
	device string
	first  uint64
	run    string
}

// cursorNow returns the place after all events until the answer `listed`.
func cursorNow(device string, listed *axisgatev1.ListDevicesResponse) *cursor {
	return &cursor{device: device, first: listed.NextRevision, run: listed.Run}
}

func (c *cursor) request() *axisgatev1.WatchRequest {
	return &axisgatev1.WatchRequest{Device: c.device, FromRevision: proto.Uint64(c.first), Run: c.run}
}

// take moves past an event.
func (c *cursor) take(event *axisgatev1.Event) {
	c.first, c.run = event.Revision+1, event.Run
}

// gapAfter returns the gap that the failure reports, and moves to its end. nil: the failure is another one.
func (c *cursor) gapAfter(f failure) *Gap {
	if f.reason() != "COMPACTED" {
		return nil
	}
	resume, err := strconv.ParseUint(f.problem.Metadata["resume_revision"], 10, 64)
	if err != nil {
		return nil
	}
	c.first, c.run = resume, ""
	return &Gap{ResumeRevision: resume}
}
