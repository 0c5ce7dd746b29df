package main

import (
	"context"
	"slices"
	"time"

	"axisgate.example/go/axisgate"
	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A runner has what earlier acts have made.
type runner struct {
	stage     *axisgate.Stage
	motions   map[string]*axisgate.Motion
	leases    map[string]*axisgate.Lease
	events    *axisgate.Stream[axisgate.EventOrGap]
	revisions []uint64
}

// context returns the context of an act's call, with the lease that the act names.
func (r *runner) context(a act) context.Context {
	if lease := r.leases[a.Lease]; lease != nil {
		return lease.Context(context.Background())
	}
	return context.Background()
}

// verbs has one function for each verb of the scenario.
var verbs = map[string]func(*runner, context.Context, act) (reply, error){
	"open": func(r *runner, ctx context.Context, a act) (reply, error) {
		if r.stage != nil {
			r.stage.Close()
		}
		stage, err := axisgate.Open(ctx, a.connection()...)
		r.stage = stage
		return done, err
	},
	"whoami": func(r *runner, ctx context.Context, a act) (reply, error) {
		_, role, err := r.stage.WhoAmI(ctx)
		return reply{"outcome": "done", "role": role}, err
	},
	"axes": func(r *runner, ctx context.Context, a act) (reply, error) {
		var axes [][]any
		for _, axis := range r.stage.Axes() {
			axes = append(axes, []any{axis.Name(), axis.Number()})
		}
		return reply{"outcome": "done", "axes": axes}, nil
	},
	"home": func(r *runner, ctx context.Context, a act) (reply, error) {
		return shown(r.stage.Home(ctx, a.Axes...))
	},
	"move_to": func(r *runner, ctx context.Context, a act) (reply, error) {
		ctx, cancel := context.WithCancel(ctx)
		defer cancel()
		if a.InterruptAfter != 0 {
			time.AfterFunc(seconds(a.InterruptAfter), cancel)
		}
		return shown(r.stage.Axis(a.Axis).MoveTo(ctx, a.Amount.distance(), a.options()...))
	},
	"move_by": func(r *runner, ctx context.Context, a act) (reply, error) {
		return shown(r.stage.Axis(a.Axis).MoveBy(ctx, a.Amount.distance()))
	},
	"start": func(r *runner, ctx context.Context, a act) (reply, error) {
		motion, err := r.stage.Axis(a.Axis).Start(ctx, a.Amount.distance(), a.options()...)
		r.motions[a.Motion] = motion
		return reply{"outcome": "started"}, err
	},
	"wait": func(r *runner, ctx context.Context, a act) (reply, error) {
		if a.Timeout != 0 {
			limited, cancel := context.WithTimeout(ctx, seconds(a.Timeout))
			defer cancel()
			ctx = limited
		}
		return shown(r.motions[a.Motion].Wait(ctx))
	},
	"cancel": func(r *runner, ctx context.Context, a act) (reply, error) {
		return done, r.motions[a.Motion].Cancel(ctx)
	},
	"stop": func(r *runner, ctx context.Context, a act) (reply, error) {
		report, err := r.stage.Stop(ctx)
		if err != nil {
			return nil, err
		}
		return reply{"outcome": "done", "stays_open": report.StaysOpen}, nil
	},
	"rearm": func(r *runner, ctx context.Context, a act) (reply, error) {
		_, err := r.stage.Rearm(ctx)
		return done, err
	},
	"lease": func(r *runner, ctx context.Context, a act) (reply, error) {
		lease, err := r.stage.Lease(ctx, axisgate.LeaseTerms{Axes: a.Axes, TTL: seconds(a.TTL)})
		r.leases[a.Lease] = lease
		return done, err
	},
	"lost": func(r *runner, ctx context.Context, a act) (reply, error) {
		lease := r.leases[a.Lease]
		select {
		case <-lease.Lost():
		case <-time.After(seconds(a.Within)):
		}
		return reply{"outcome": "done", "lost": lease.Err() != nil}, nil
	},
	"release": func(r *runner, ctx context.Context, a act) (reply, error) {
		lease := r.leases[a.Lease]
		delete(r.leases, a.Lease)
		return done, lease.Release(ctx)
	},
	"path": func(r *runner, ctx context.Context, a act) (reply, error) {
		motion, err := r.stage.Path(ctx, axisgate.Path{Axes: a.Axes, Points: a.points(), Speed: a.speed()})
		if err != nil {
			return nil, err
		}
		return shown(motion.Wait(ctx))
	},
	"scan": func(r *runner, ctx context.Context, a act) (reply, error) {
		motion, err := r.stage.Scan(ctx, axisgate.Scan{Axis: a.Axis, Start: a.From.distance(), End: a.To.distance(),
			Every: a.Every.distance(), Speed: a.speed()})
		if err != nil {
			return nil, err
		}
		result, err := motion.Wait(ctx)
		if err != nil {
			return nil, err
		}
		return reply{"outcome": "done", "expected": result.Scan.ExpectedInRange,
			"observed_equals_expected": *result.Scan.Observed == *result.Scan.Expected}, nil
	},
	"events": func(r *runner, ctx context.Context, a act) (reply, error) {
		events, err := r.stage.Events(ctx)
		r.events = events
		return done, err
	},
	"succeeded": succeeded,
	"saturate": func(r *runner, ctx context.Context, a act) (reply, error) {
		for range a.Calls {
			go r.motions[a.Motion].Wait(ctx)
		}
		return done, nil
	},
}

// succeeded reads events until so many motions have succeeded.
func succeeded(r *runner, ctx context.Context, a act) (reply, error) {
	gaps, ended := 0, 0
	for item, err := range r.events.All() {
		if err != nil {
			return nil, err
		}
		event, ok := item.(*axisgate.Event)
		if !ok {
			gaps++
			continue
		}
		r.revisions = append(r.revisions, event.Revision)
		if event.Message.GetMotion().GetState() == axisgatev1.MotionState_MOTION_STATE_SUCCEEDED {
			ended++
		}
		if ended == a.Count {
			break
		}
	}
	unique := slices.Compact(slices.Sorted(slices.Values(r.revisions)))
	return reply{"outcome": "done", "ascending": slices.Equal(unique, r.revisions), "gaps": gaps}, nil
}
