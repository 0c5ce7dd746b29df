package axisgate

import (
	"fmt"
	"time"

	"google.golang.org/protobuf/types/known/durationpb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

const (
	// lostLimit is the time without an answer after which the outcome of a motion counts as unknown.
	lostLimit = 60 * time.Second
	// waitPart is the longest wait of one question for an outcome, and answerTime the time for its answer.
	waitPart   = 10 * time.Second
	answerTime = 5 * time.Second
)

// A following asks for the outcome of one motion, also over broken connections and restarts of the daemon. It has no
// clock and no connection.
type following struct {
	motion   *axisgatev1.Motion
	target   string
	answered time.Time
	backoff  backoff
}

// question returns the next request, which waits at most `wait`, and its deadline.
func (f *following) question(wait time.Duration) (*axisgatev1.WaitMotionRequest, time.Duration) {
	wait = max(min(wait, waitPart), 0)
	return &axisgatev1.WaitMotionRequest{Motion: f.motion.Name, MaxWait: durationpb.New(wait)}, wait + answerTime
}

// take takes an answer. It returns an error if the answer is about another motion: a daemon without a journal gives the
// names of motions again after a restart.
func (f *following) take(motion *axisgatev1.Motion, now time.Time) error {
	f.answered = now
	f.backoff = backoff{}
	if motion.RequestId != f.motion.RequestId {
		return f.unknown("the daemon was restarted, and no longer has the motion")
	}
	f.motion = motion
	return nil
}

// after returns the pause after which the daemon is asked again, or the error with which following ends.
func (f *following) after(failed failure, now time.Time) (time.Duration, error) {
	if !failed.passing() && failed.reason() != "QUEUE_FULL" {
		return 0, f.unknown(fmt.Sprintf("its outcome cannot be read: %v", errorOf(failed, f.target)))
	}
	if now.Sub(f.answered) > lostLimit {
		return 0, f.unknown(fmt.Sprintf("the daemon has not answered for %v", lostLimit))
	}
	return f.backoff.pause(), nil
}

func (f *following) unknown(why string) error {
	return asOutcomeUnknown(Problem{Reason: "OUTCOME_UNKNOWN",
		Message: fmt.Sprintf("the outcome of %s is unknown: %s", f.motion.Name, why),
		Hint:    "look at the stage before you repeat the motion"})
}
