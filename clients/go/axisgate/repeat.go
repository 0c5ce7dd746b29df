package axisgate

import (
	"errors"
	"fmt"
	"time"
)

const (
	firstPause   = 250 * time.Millisecond
	longestPause = 5 * time.Second
)

// A backoff is a series of pauses, each twice as long as the previous one. Its zero value begins with the shortest.
type backoff struct{ last time.Duration }

func (b *backoff) pause() time.Duration {
	b.last = min(max(2*b.last, firstPause), longestPause)
	return b.last
}

// A repeat decides after each failed attempt whether the same request is sent again. It has no clock and no connection.
//
// `until` is the latest time of an attempt, and `answer` the time for its answer. `acts` is false for a question, which
// may always be repeated. `remembered` is false if the daemon does not remember requests: a request that acts is then
// not repeated once it may have reached the daemon.
type repeat struct {
	until      time.Time
	target     string
	answer     time.Duration
	acts       bool
	remembered bool

	backoff      backoff
	mayHaveActed bool
}

// timeout returns the deadline of the attempt that is sent now.
func (r *repeat) timeout(now time.Time) time.Duration { return max(r.until.Sub(now), 0) + r.answer }

// after returns the pause after which the same request is sent again, or the error with which the call ends.
func (r *repeat) after(f failure, now time.Time) (time.Duration, error) {
	r.take(f)
	if r.mayBeRepeated(f) {
		if pause := min(r.backoff.pause(), r.until.Sub(now)); pause > 0 {
			return pause, nil
		}
	}
	return 0, r.errorOf(f)
}

// interrupted returns the error of a request whose caller waits no longer because of `cause`.
func (r *repeat) interrupted(f failure, cause error) error {
	r.take(f)
	if !r.mayHaveActed {
		return cause
	}
	return lookFirst(fmt.Sprintf("the answer of the daemon at %s was not awaited: %v", r.target, cause), "", cause)
}

func (r *repeat) take(f failure) {
	r.mayHaveActed = r.mayHaveActed || (r.acts && f.lost() && f.sent)
}

func (r *repeat) mayBeRepeated(f failure) bool {
	if r.mayHaveActed && !r.remembered {
		return false
	}
	return f.passing() || (r.mayHaveActed && f.reason() == "QUEUE_FULL")
}

func (r *repeat) errorOf(f failure) error {
	if !r.acts && f.lost() {
		return unavailableError(f, r.target)
	}
	err := errorOf(f, r.target)
	var unknown *OutcomeUnknown
	if !r.mayHaveActed || f.decidesRepeat() || errors.As(err, &unknown) {
		return err
	}
	return lookFirst(fmt.Sprintf("the answer to the request was lost, and a repeat was refused: %v", err),
		f.code.String(), nil)
}
