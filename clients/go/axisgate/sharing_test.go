package axisgate

import (
	"context"
	"encoding/hex"
	"errors"
	"slices"
	"testing"
	"time"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

func acquired(t *testing.T, stage *Stage, terms LeaseTerms) *Lease {
	t.Helper()
	lease, err := stage.Lease(background, terms)
	if err != nil {
		t.Fatal(err)
	}
	return lease
}

func TestLeases(t *testing.T) {
	d := newDaemon(t, true)
	stage, other := d.open(), d.openOther()
	lease := acquired(t, stage, LeaseTerms{Axes: []string{"x"}, TTL: time.Second, Purpose: "a test"})
	if !slices.Equal(lease.Axes(), []int{1}) {
		t.Error(lease.Axes())
	}
	ctx := lease.Context(background)
	wantResult(t, "x 0.1 mm")(stage.Axis("x").MoveTo(ctx, MM(0.1)))
	_, err := stage.Axis("x").MoveTo(background, MM(0))
	wantError[*Refused](t, LeaseHeld, err)
	wantResult(t, "y 0.1 mm")(other.Axis("y").MoveTo(ctx, MM(0.1))) // a lease of another Stage is not carried

	t.Setenv(leaseVariable, hex.EncodeToString(lease.Token()))
	wantResult(t, "x 0.2 mm")(d.open().Axis("x").MoveTo(background, MM(0.2)))

	time.Sleep(2500 * time.Millisecond) // longer than the lease lasts unless it is kept alive
	wantResult(t, "x 0 mm")(stage.Axis("x").MoveTo(ctx, MM(0)))
	ended, cancel := context.WithCancel(background)
	cancel()
	if err := errors.Join(lease.Release(ended), lease.Release(ended), lease.Err()); err != nil {
		t.Error(err)
	}
	wantResult(t, "x 0.1 mm")(other.Axis("x").MoveTo(background, MM(0.1)))
	acquired(t, stage, LeaseTerms{}) // ends with the Stage
}

func TestLostLease(t *testing.T) {
	d := newDaemon(t, true)
	stage := d.open()
	lease := acquired(t, stage, LeaseTerms{Axes: []string{"x"}, TTL: time.Second})
	d.kill()
	d.start()
	select {
	case <-lease.Lost():
	case <-time.After(testLimit):
		t.Fatal("the lease is not lost")
	}
	wantError[*Refused](t, LeaseLost, lease.Err())
	_, err := stage.Axis("x").MoveTo(lease.Context(background), MM(1))
	wantError[*Refused](t, LeaseLost, err)
	if err := lease.Release(background); err != nil {
		t.Error(err)
	}
}

func TestHandOver(t *testing.T) {
	d := newDaemon(t, true)
	stage, other := d.open(), d.openOther()
	lease := acquired(t, stage, LeaseTerms{Axes: []string{"x"}})
	given := make(chan error)
	go func() {
		next, err := other.Lease(background, LeaseTerms{Axes: []string{"x"}, Wait: 20 * time.Second})
		if err == nil {
			defer next.Release(background)
		}
		given <- err
	}()
	name, role, err := other.WhoAmI(background)
	if err != nil || role == "" {
		t.Error(role, err)
	}
	until(t, "a caller who waits", func() bool { return lease.HandOver(background, name) == nil })
	if err := <-given; err != nil {
		t.Error(err)
	}
}

func TestJogs(t *testing.T) {
	d := newDaemon(t, true)
	stage, other := d.open(), d.openOther()
	jog, err := stage.Jog(background, map[string]Speed{"x": UM(-200).PerSecond()})
	if err != nil {
		t.Fatal(err)
	}
	time.Sleep(700 * time.Millisecond) // longer than the daemon waits for a message
	result, err := jog.Stop(background)
	if err != nil || *result.Positions[0].Pulses >= 0 || jog.Motion().State() != "SUCCEEDED" {
		t.Error(result, err)
	}

	_, err = stage.Jog(background, map[string]Speed{"x": MM(1000).PerSecond()})
	wantError[*Refused](t, "OUT_OF_RANGE", err)

	ctx, cancel := context.WithCancel(background)
	jog, err = stage.Jog(ctx, map[string]Speed{"x": UM(200).PerSecond()})
	if err != nil {
		t.Fatal(err)
	}
	cancel()
	wantError[*Stopped](t, "STOPPED", outcome(jog.Motion()))

	jog, err = stage.Jog(background, map[string]Speed{"x": UM(200).PerSecond()})
	if err != nil {
		t.Fatal(err)
	}
	if _, err := other.Stop(background); err != nil {
		t.Error(err)
	}
	_, err = jog.Stop(background)
	wantError[*Stopped](t, "STOPPED", err)
}

func TestPathsScansAndPlaces(t *testing.T) {
	stage := newDaemon(t, true).open()
	diagonal := func(yield func(Point) bool) {
		for i := 1; i <= 10 && yield(Point{UM(100 * i), UM(50 * i)}); i++ {
		}
	}
	path := Path{Axes: []string{"x", "y"}, Points: Points(diagonal), Speed: MM(0.5).PerSecond()}
	motion, err := stage.Path(background, path)
	if err != nil {
		t.Fatal(err)
	}
	for progress, err := range motion.Progress(background, 50*time.Millisecond) {
		if err != nil || progress.Fraction == nil || *progress.Fraction < 0 || len(progress.Positions) != 2 {
			t.Error(progress, err)
		}
	}
	wantResult(t, "x 1 mm, y 0.5 mm")(motion.Wait(background))

	outside := slices.Values([]Point{{MM(1), MM(1)}, {MM(20), MM(1)}})
	_, err = stage.Path(background, Path{Axes: path.Axes, Points: Points(outside), Speed: path.Speed})
	wantError[*Refused](t, OutsideTravel, err)
	short := slices.Values([]Point{{MM(1)}})
	if _, err = stage.Path(background, Path{Axes: path.Axes, Points: Points(short)}); !isA[*InvalidArgument](err) {
		t.Error(err)
	}

	scan, err := stage.Scan(background, Scan{Axis: "x", Start: MM(0), End: MM(1), Every: UM(100),
		Speed: MM(0.2).PerSecond()})
	if err != nil {
		t.Fatal(err)
	}
	result, err := scan.Wait(background)
	if err != nil || *result.Scan.ExpectedInRange != 11 || *result.Scan.Observed != *result.Scan.Expected {
		t.Error(result, err)
	}

	visited := 0
	for result, err := range stage.Visit(background, Path{Axes: []string{"x"},
		Points: Points(slices.Values([]Point{{MM(0.1)}, {MM(0.2)}}))}) {
		visited++
		if err != nil || len(result.Positions) != 1 {
			t.Error(result, err)
		}
	}
	places := stage.Places()
	if err := places.Save(background, "sample"); err != nil || visited != 2 {
		t.Error(visited, err)
	}
	wantResult(t, "x 1 mm")(stage.Axis("x").MoveTo(background, MM(1)))
	if result, err := places.MoveTo(background, "sample"); err != nil || result.Positions[0].String() != "x 0.2 mm" {
		t.Error(result, err)
	}
	if all, err := places.List(background); err != nil || all["sample"][0].String() != "x 0.2 mm" {
		t.Error(all, err)
	}
	if err := places.Delete(background, "sample"); err != nil {
		t.Error(err)
	}
	wantError[*Refused](t, "NOT_FOUND", places.Delete(background, "sample"))
}

func TestSettings(t *testing.T) {
	stage := newDaemon(t, true).open()
	off := false
	settings := &axisgatev1.Settings{Axes: []*axisgatev1.AxisSettings{{Axis: "x", Excited: &off}}}
	if err := stage.ChangeSettings(background, settings); err != nil {
		t.Error(err)
	}
	settings, err := stage.Settings(background)
	if err != nil || settings.Axes[0].GetExcited() {
		t.Error(settings, err)
	}
	_, err = stage.Axis("x").MoveTo(background, MM(1))
	wantError[*Refused](t, "NOT_EXCITED", err)
}

func TestStreams(t *testing.T) {
	d := newDaemon(t, true)
	r := newRelay(t, d)
	direct := d.open()
	stage := d.open(WithTarget(r.socket))
	states, err := stage.Watch(background, 0)
	if err != nil {
		t.Fatal(err)
	}
	for status, err := range states.All() {
		if err != nil || status.Link != "UP" {
			t.Error(status, err)
		}
		states.Close()
	}

	ctx, cancel := context.WithCancel(background)
	events, err := stage.EventsFrom(ctx, 0)
	if err != nil {
		t.Fatal(err)
	}
	last := readUntilMotion(t, events)
	wantMotion := func() {
		t.Helper()
		wantResult(t, "x 1 mm")(direct.Axis("x").MoveTo(background, MM(1)))
		if next := readUntilMotion(t, events); next.Revision <= last.Revision {
			t.Error(next)
		}
	}
	wantMotion()
	r.cutAnswers(1, 1)
	wantMotion()
	d.kill()
	d.start()
	direct = d.open()
	wantMotion()

	again, err := stage.EventsAfter(background, last)
	if err != nil {
		t.Fatal(err)
	}
	defer again.Close()
	for item, err := range again.All() {
		if event, ok := item.(*Event); !ok || event.Revision != last.Revision+1 || err != nil {
			t.Error(item, err)
		}
		break
	}
	cancel()
	for _, err := range events.All() {
		if !errors.Is(err, context.Canceled) {
			t.Error(err)
		}
	}
}

func TestEventsResumeBeforeTheFirstEvent(t *testing.T) {
	d := newDaemon(t, true)
	events, err := d.open().Events(background)
	if err != nil {
		t.Fatal(err)
	}
	defer events.Close()
	d.kill()
	started := make(chan struct{})
	time.AfterFunc(1500*time.Millisecond, func() {
		defer close(started)
		d.start()
	})
	for item, err := range events.All() {
		if event, ok := item.(*Event); !ok || event.Kind != "daemon_started" || err != nil {
			t.Error(item, err)
		}
		break
	}
	<-started
}

// readUntilMotion reads the kept events, or up to a motion that has succeeded.
func readUntilMotion(t *testing.T, events *Stream[EventOrGap]) *Event {
	t.Helper()
	for item, err := range events.All() {
		event, ok := item.(*Event)
		if !ok || err != nil {
			t.Fatal(item, err)
		}
		succeeded := event.Message.GetMotion().GetState() == axisgatev1.MotionState_MOTION_STATE_SUCCEEDED
		if event.Kind == "daemon_started" && event.Revision == 1 || succeeded {
			return event
		}
	}
	return nil
}
