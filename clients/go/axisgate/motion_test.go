package axisgate

import (
	"bytes"
	"context"
	"errors"
	"log/slog"
	"strings"
	"testing"
	"time"
)

var background = context.Background()

// wantResult fails the test unless the call has the result. Use it as wantResult(t, "x 1 mm")(stage.MoveTo(...)).
func wantResult(t *testing.T, wanted string) func(*Result, error) {
	t.Helper()
	return func(result *Result, err error) {
		t.Helper()
		if err != nil || result.String() != wanted {
			t.Errorf("%v, %v, not %s", result, err, wanted)
		}
	}
}

// wantError fails the test unless the call fails with an error of the type and reason.
func wantError[E error](t *testing.T, reason Reason, err error) {
	t.Helper()
	if !isA[E](err) || !errors.Is(err, reason) {
		t.Errorf("%T %v, not %s", err, err, reason)
	}
}

func started(t *testing.T, stage *Stage, target Distance) *Motion {
	t.Helper()
	motion, err := stage.Axis("x").Start(background, target)
	if err != nil {
		t.Fatal(err)
	}
	return motion
}

func outcome(motion *Motion) error {
	_, err := motion.Wait(background)
	return err
}

func TestMoves(t *testing.T) {
	d := newDaemon(t, true)
	log := &bytes.Buffer{}
	stage := d.open(WithLogger(slog.New(slog.NewTextHandler(log, &slog.HandlerOptions{Level: slog.LevelDebug}))))
	x := stage.Axis("1")
	wantResult(t, "x 1.5 mm")(x.MoveTo(background, MM("1.5")))
	wantResult(t, "x 1.25 mm")(x.MoveBy(background, UM(-250), WithSpeed(MM(5).PerSecond()), WithApproach(UM(10))))
	wantResult(t, "x 1 mm, y -0.1 mm")(stage.MoveTo(background, Targets{"x": MM(1), "y": UM(-100)}))
	wantResult(t, "x 1.3 mm, y -0.09995 mm")(stage.MoveBy(background, Targets{"x": MM(0.1 + 0.2), "y": Pulses(5)}))
	_, err := x.MoveTo(background, MM("0.123456789"))
	wantError[*Refused](t, "NOT_REPRESENTABLE", err)
	_, err = x.MoveTo(background, MM(20))
	wantError[*Refused](t, OutsideTravel, err)
	wantError[*Refused](t, OutsideTravel, stage.Check(background, Targets{"x": MM(20)}))
	if err := stage.Check(background, Targets{"x": MM(1)}); err != nil {
		t.Error(err)
	}
	_, err = stage.Axis("z").MoveTo(background, MM(1))
	wantError[*Refused](t, "UNKNOWN_AXIS", err)
	state, err := x.State(background)
	if err != nil || state.Position.String() != "x 1.3 mm" || state.Maximum.String() != "15 mm" {
		t.Error(state, err)
	}
	wantResult(t, "x 0 mm")(x.Home(background))
	wantResult(t, "")(stage.HomeIfNeeded(background, "x"))
	wantResult(t, "y 0 mm, 3 0 um")(stage.HomeIfNeeded(background))
	if !strings.Contains(log.String(), "StageService/Move") || !strings.Contains(log.String(), "OutOfRange") {
		t.Error(log)
	}
	if _, err := Open(background, WithTarget(d.socket), WithDevice("other")); !isA[*InvalidArgument](err) {
		t.Error(err)
	}
}

func TestEnds(t *testing.T) {
	d := newDaemon(t, true)
	stage, other := d.open(), d.openOther()
	motion := started(t, stage, MM(14))
	ctx, cancel := context.WithTimeout(background, 200*time.Millisecond)
	defer cancel()
	if _, err := motion.Wait(ctx); !errors.Is(err, context.DeadlineExceeded) || isA[Error](err) {
		t.Error(err)
	}
	if done, err := motion.Done(background); done || err != nil || motion.State() != "RUNNING" {
		t.Error(motion, err)
	}
	report, err := stage.Stop(ctx, "x") // although ctx has ended
	if err != nil || report.StaysOpen || report.Problem != nil || !*report.Axes[0].Stationary {
		t.Error(report, err)
	}
	wantError[*Stopped](t, "STOPPED", outcome(motion))

	motion = started(t, stage, MM(14)) // a stop of the same program latches nothing
	if err := motion.Cancel(background); err != nil {
		t.Error(err)
	}
	wantError[*Stopped](t, "STOPPED", outcome(motion))

	motion = started(t, stage, MM(14))
	if _, err := other.Stop(background); err != nil {
		t.Error(err)
	}
	wantError[*Stopped](t, "STOPPED", outcome(motion))
	_, err = stage.Axis("x").Start(background, MM(0))
	wantError[*Refused](t, StoppedBy, err)
	if !strings.Contains(err.Error(), "stage.Rearm(ctx)") {
		t.Error(err)
	}
	if axes, err := stage.Rearm(background); err != nil || len(axes) != 1 || axes[0] != 1 {
		t.Error(axes, err)
	}

	motion = started(t, stage, MM(14))
	if _, err := stage.EmergencyStop(background); err != nil {
		t.Error(err)
	}
	if outcome(motion) == nil {
		t.Error("a motion survives an emergency stop")
	}
	_, err = stage.Axis("x").Start(background, MM(0))
	wantError[*Refused](t, "EMERGENCY_STOPPED", err)
	if err := stage.ClearErrors(background); err != nil {
		t.Error(err)
	}
}

func TestInterruptedMoveIsCancelled(t *testing.T) {
	stage := newDaemon(t, true).open()
	ctx, cancel := context.WithCancel(background)
	defer cancel()
	time.AfterFunc(300*time.Millisecond, cancel)
	if _, err := stage.Axis("x").MoveTo(ctx, MM(14)); !errors.Is(err, context.Canceled) || isA[Error](err) {
		t.Error(err)
	}
	if _, err := stage.Axis("x").MoveTo(ctx, MM(14)); err != context.Canceled {
		t.Error(err)
	}
	motions, err := stage.Motions(background)
	if err != nil || len(motions) != 1 {
		t.Fatal(motions, err)
	}
	wantError[*Stopped](t, "STOPPED", outcome(motions[0]))
}

func TestClosedStage(t *testing.T) {
	stage := newDaemon(t, true).open()
	motion := started(t, stage, MM(14))
	time.AfterFunc(300*time.Millisecond, func() { stage.Close() })
	if err := outcome(motion); err != ErrClosed {
		t.Error(err)
	}
	if _, err := stage.Axis("x").MoveTo(background, MM(1)); err != ErrClosed {
		t.Error(err)
	}
}

func TestLostAnswers(t *testing.T) {
	d := newDaemon(t, true)
	r := newRelay(t, d)
	direct := d.open()
	stage := d.open(WithTarget(r.socket), WithTimeout(4*time.Second))
	r.cutAnswers(3, 3) // stream 1 asks for the request memory
	wantResult(t, "x 1 mm")(stage.Axis("x").MoveBy(background, MM(1)))
	if motions, _ := direct.Motions(background); len(motions) != 1 || r.cuts != 3 {
		t.Error(motions, r.cuts)
	}

	motion := started(t, stage, MM(10))
	r.cutAnswers(1, 3)
	wantResult(t, "x 10 mm")(motion.Wait(background))

	r.cutAnswers(3, 1000)
	_, err := d.open(WithTarget(r.socket), WithTimeout(2*time.Second)).Axis("x").MoveBy(background, MM(-1))
	wantError[*OutcomeUnknown](t, "OUTCOME_UNKNOWN", err)
	if motions, _ := direct.Motions(background); len(motions) != 3 {
		t.Error(motions)
	}
}

func TestLostAnswerWithoutJournal(t *testing.T) {
	d := newDaemon(t, false)
	r := newRelay(t, d)
	stage := d.open(WithTarget(r.socket))
	r.cutAnswers(3, 1)
	_, err := stage.Axis("x").MoveBy(background, MM(1))
	wantError[*OutcomeUnknown](t, "OUTCOME_UNKNOWN", err)
	if motions, _ := d.open().Motions(background); len(motions) != 1 {
		t.Error(motions)
	}
}

func TestAtTheStage(t *testing.T) {
	d := newDaemon(t, true)
	motion := started(t, d.open(), MM(14))
	d.atStage("limit 1 cw on")
	wantError[*MotionFailed](t, "LIMIT_DETECTED", outcome(motion))
}

func TestKilledDaemon(t *testing.T) {
	d := newDaemon(t, true)
	stage := d.open(WithTimeout(2 * time.Second))
	motion := started(t, stage, MM(14))
	d.kill()
	_, err := stage.Axis("x").MoveTo(background, MM(1))
	wantError[*Refused](t, unavailable, err)
	if !errors.Is(err, ErrUnavailable) {
		t.Error(err)
	}
	_, err = stage.Stop(background)
	wantError[*OutcomeUnknown](t, unavailable, err)
	_, err = Open(background, WithTarget(d.socket))
	wantError[*Refused](t, unavailable, err)
	d.start()
	wantError[*OutcomeUnknown](t, "OUTCOME_UNKNOWN", outcome(motion))
	until(t, "the stop after the restart", func() bool {
		status, err := stage.Status(background)
		return err == nil && len(status.Message.OpenStops) == 0
	})
	wantResult(t, "x 0 mm")(stage.Axis("x").MoveTo(background, MM(0)))
}

func TestAxesAreUnknownAfterARestart(t *testing.T) {
	d := newDaemon(t, true)
	stage := d.open()
	d.restartWithoutController()
	_, err := stage.HomeIfNeeded(background)
	wantError[*Refused](t, "LINK_DOWN", err)
	_, err = stage.Axis("x").Position(background)
	wantError[*Refused](t, "LINK_DOWN", err)
}
