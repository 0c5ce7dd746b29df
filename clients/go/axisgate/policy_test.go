package axisgate

import (
	"errors"
	"slices"
	"testing"
	"time"

	"google.golang.org/grpc/codes"
	"google.golang.org/grpc/status"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

var (
	broken = failure{code: codes.Unavailable, text: "error reading from server: EOF", sent: true}
	never  = failure{code: codes.Unavailable, text: "connection refused"}
	start0 = time.Unix(1000, 0)
)

func refusal(reason Reason, code codes.Code) failure {
	number := axisgatev1.Reason_value["REASON_"+string(reason)]
	return failure{code: code, sent: true,
		problem: &axisgatev1.Problem{Reason: axisgatev1.Reason(number), Message: "a sentence."}}
}

func action(remembered bool) *repeat {
	return &repeat{until: start0.Add(5 * time.Second), target: "here", answer: 3 * time.Second, acts: true,
		remembered: remembered}
}

// pauses returns the pauses in ms until the error, on a clock that only pauses move.
func pauses(r *repeat, f failure) ([]int64, error) {
	var all []int64
	for now := start0; ; {
		pause, err := r.after(f, now)
		if err != nil {
			return all, err
		}
		now = now.Add(pause)
		all = append(all, pause.Milliseconds())
	}
}

func isA[E error](err error) bool {
	var found E
	return errors.As(err, &found)
}

func TestLostAnswerIsRepeated(t *testing.T) {
	all, err := pauses(action(true), broken)
	if !slices.Equal(all, []int64{250, 500, 1000, 2000, 1250}) || !isA[*OutcomeUnknown](err) {
		t.Error(all, err)
	}
}

func TestDeadlineCoversTheAnswer(t *testing.T) {
	r := action(true)
	if r.timeout(start0.Add(time.Second)) != 7*time.Second || r.timeout(start0.Add(9*time.Second)) != 3*time.Second {
		t.Error(r.timeout(start0))
	}
}

func TestWithoutAnyConnectionNothingActed(t *testing.T) {
	all, err := pauses(action(true), never)
	if len(all) != 5 || !isA[*Refused](err) || !errors.Is(err, ErrUnavailable) {
		t.Error(all, err)
	}
}

func TestNoConnectionAfterALostAnswer(t *testing.T) {
	r := action(true)
	r.after(broken, start0)
	if _, err := pauses(r, never); !isA[*OutcomeUnknown](err) {
		t.Error(err)
	}
}

func TestRefusalIsFinal(t *testing.T) {
	_, err := action(true).after(refusal(OutsideTravel, codes.OutOfRange), start0)
	if !isA[*Refused](err) || !errors.Is(err, OutsideTravel) || errors.Is(err, ErrUnavailable) {
		t.Error(err)
	}
}

func TestUnavailableIsRepeated(t *testing.T) {
	all, err := pauses(action(true), refusal("LINK_DOWN", codes.Unavailable))
	if len(all) != 5 || !errors.Is(err, ErrUnavailable) || !errors.Is(err, Reason("LINK_DOWN")) {
		t.Error(all, err)
	}
}

func TestRefusalAfterALostAnswer(t *testing.T) {
	for reason, decides := range map[Reason]bool{OutsideTravel: true, "DEADLINE_PASSED": true, LeaseLost: false,
		Unauthenticated: false, "REQUEST_MEMORY_LOST": false} {
		r := action(true)
		r.after(broken, start0)
		_, err := r.after(refusal(reason, codes.FailedPrecondition), start0)
		if isA[*Refused](err) != decides || isA[*OutcomeUnknown](err) == decides {
			t.Error(reason, err)
		}
	}
}

func TestWithoutAMemory(t *testing.T) {
	r := action(false)
	if _, err := r.after(never, start0); err != nil {
		t.Error(err)
	}
	if _, err := r.after(broken, start0); !isA[*OutcomeUnknown](err) {
		t.Error(err)
	}
}

func TestQuestionIsRepeated(t *testing.T) {
	r := action(false)
	r.acts = false
	all, err := pauses(r, broken)
	if len(all) != 5 || !errors.Is(err, ErrUnavailable) {
		t.Error(all, err)
	}
}

func TestInterruption(t *testing.T) {
	if err := action(true).interrupted(never, ErrClosed); err != ErrClosed {
		t.Error(err)
	}
	err := action(true).interrupted(broken, ErrClosed)
	if !isA[*OutcomeUnknown](err) || !errors.Is(err, ErrClosed) {
		t.Error(err)
	}
}

func newFollowing() *following {
	motion := &axisgatev1.Motion{Name: "devices/stage/motions/1", RequestId: "a"}
	return &following{motion: motion, target: "here", answered: start0}
}

func TestWaitsInParts(t *testing.T) {
	for left, wait := range map[time.Duration]time.Duration{100 * time.Second: 10 * time.Second,
		3 * time.Second: 3 * time.Second, -time.Second: 0} {
		request, limit := newFollowing().question(left)
		if request.MaxWait.AsDuration() != wait || limit != wait+5*time.Second {
			t.Error(request, limit)
		}
	}
}

func TestFollowsOverBrokenConnections(t *testing.T) {
	f := newFollowing()
	for _, wanted := range []float64{0.25, 0.5, 1, 2, 4, 5, 5} {
		if pause, err := f.after(broken, start0); err != nil || pause.Seconds() != wanted {
			t.Error(pause, err)
		}
	}
	f.take(f.motion, start0.Add(50*time.Second))
	if pause, err := f.after(never, start0.Add(lostLimit+49*time.Second)); err != nil || pause != firstPause {
		t.Error(pause, err)
	}
	if _, err := f.after(never, start0.Add(lostLimit+51*time.Second)); !isA[*OutcomeUnknown](err) {
		t.Error(err)
	}
}

func TestMotionThatIsNoLongerKept(t *testing.T) {
	_, err := newFollowing().after(refusal("NOT_FOUND", codes.NotFound), start0)
	if !isA[*OutcomeUnknown](err) || isA[*Refused](err) {
		t.Error(err)
	}
}

func TestOtherMotionOfTheSameName(t *testing.T) {
	f := newFollowing()
	if err := f.take(&axisgatev1.Motion{Name: f.motion.Name, RequestId: "b"}, start0); !isA[*OutcomeUnknown](err) {
		t.Error(err)
	}
}

func TestEveryReasonHasAnError(t *testing.T) {
	for number, name := range axisgatev1.Reason_name {
		f := refusal("", codes.FailedPrecondition)
		f.problem.Reason = axisgatev1.Reason(number)
		var known Error
		if err := errorOf(f, "here"); !errors.As(err, &known) || "REASON_"+string(known.Details().Reason) != name {
			t.Error(err)
		}
	}
	if reasonOf(999) != "REASON 999" {
		t.Error(reasonOf(999))
	}
}

func TestDetailsOfAnError(t *testing.T) {
	axis := int32(2)
	found, err := status.New(codes.FailedPrecondition, "text").WithDetails(&axisgatev1.Problem{
		Reason: axisgatev1.Reason_REASON_LEASE_HELD, Message: "a sentence.", Hint: "acquire it: `AcquireLease`",
		Axis: &axis, Sent: "G:1", WireReply: "NG"})
	if err != nil {
		t.Fatal(err)
	}
	var refused *Refused
	if !errors.As(errorOf(failureOf(found.Err(), true), "here"), &refused) {
		t.Fatal("no Refused")
	}
	if refused.Axis != 2 || refused.Sent != "G:1" || refused.WireReply != "NG" || refused.Code != "FailedPrecondition" ||
		refused.Error() != "LEASE_HELD: a sentence. (acquire it: `stage.Lease(ctx, ...)`)" {
		t.Errorf("%+v", refused)
	}
}

func TestEarlyRefusals(t *testing.T) {
	for code, reason := range early {
		f := failure{code: code, text: "text", sent: true}
		if err := errorOf(f, "here"); f.lost() || !isA[*Refused](err) || !errors.Is(err, reason) {
			t.Error(code, err)
		}
	}
}

func TestOutcomes(t *testing.T) {
	problem := &axisgatev1.Problem{Reason: axisgatev1.Reason_REASON_LINK_DOWN}
	for state, is := range map[axisgatev1.MotionState]func(error) bool{
		axisgatev1.MotionState_MOTION_STATE_STOPPED: isA[*Stopped],
		axisgatev1.MotionState_MOTION_STATE_FAILED:  isA[*MotionFailed],
		axisgatev1.MotionState_MOTION_STATE_UNKNOWN: isA[*OutcomeUnknown]} {
		_, err := outcomeOf(&axisgatev1.Motion{State: state, Problem: problem})
		if !is(err) || !errors.Is(err, Reason("LINK_DOWN")) || errors.Is(err, ErrUnavailable) {
			t.Error(state, err)
		}
	}
}

func TestHints(t *testing.T) {
	for hint, wanted := range map[string]string{
		"home it: `Home`":              "home it: `stage.Home(ctx, \"1\")`",
		"`ChangeSettings` with `on`":   "`stage.ChangeSettings(ctx, ...)` with `on`",
		"see `ListHistory` or `Rearm`": "see `ListHistory` or `stage.Rearm(ctx)`"} {
		if found := withFunctions(hint, 1); found != wanted {
			t.Errorf("%s, not %s", found, wanted)
		}
	}
}

func TestCursorResumesAfterTheLastEvent(t *testing.T) {
	c := cursorNow("devices/stage", &axisgatev1.ListDevicesResponse{NextRevision: 5, Run: "a"})
	if request := c.request(); request.GetFromRevision() != 5 || request.Run != "a" {
		t.Error(request)
	}
	c.take(&axisgatev1.Event{Revision: 7, Run: "a"})
	if request := c.request(); request.GetFromRevision() != 8 || request.Run != "a" {
		t.Error(request)
	}
	compacted := refusal("COMPACTED", codes.OutOfRange)
	compacted.problem.Metadata = map[string]string{"resume_revision": "40"}
	if gap := c.gapAfter(compacted); gap == nil || gap.ResumeRevision != 40 {
		t.Error(gap)
	}
	if request := c.request(); request.GetFromRevision() != 40 || request.Run != "" || c.gapAfter(broken) != nil {
		t.Error(request)
	}
}
