// Command bench compares calls through this package with the same messages through generated clients. The daemon is at
// AXISGATE_TARGET, an address of gRPC without TLS. Bench moves the first axis of its only stage by single pulses, and
// prints the medians in microseconds.
package main

import (
	"context"
	"encoding/json"
	"fmt"
	"log"
	"os"
	"slices"
	"time"

	"axisgate.example/go/axisgate"
)

const (
	readings = 300
	moves    = 60
	warmUp   = 20
)

// A call is one of two ways to do the same. Its argument is 1 and -1 in turn.
type call func(ctx context.Context, step int64) error

type figures struct {
	Package int64 `json:"package_us"`
	Bare    int64 `json:"bare_us"`
}

// measure returns the medians of two calls. They alternate, so that both see the same load.
func measure(ctx context.Context, viaPackage, bare call, count int) (figures, error) {
	calls := []call{viaPackage, bare}
	times := make([][]time.Duration, len(calls))
	for number := range warmUp + count {
		for turn := range calls {
			which := (turn + number) % len(calls)
			begun := time.Now()
			if err := calls[which](ctx, int64(1-number%2*2)); err != nil {
				return figures{}, err
			}
			if number >= warmUp {
				times[which] = append(times[which], time.Since(begun))
			}
		}
	}
	return figures{median(times[0]).Microseconds(), median(times[1]).Microseconds()}, nil
}

func median(times []time.Duration) time.Duration {
	slices.Sort(times)
	return (times[(len(times)-1)/2] + times[len(times)/2]) / 2
}

func run(ctx context.Context) error {
	stage, err := axisgate.Open(ctx)
	if err != nil {
		return err
	}
	defer stage.Close()
	axis := stage.Axes()[0]
	b, err := newBare(os.Getenv("AXISGATE_TARGET"), "devices/"+stage.Name(), fmt.Sprint(axis.Number()))
	if err != nil {
		return err
	}
	defer b.channel.Close()
	status := func(ctx context.Context, _ int64) error {
		_, err := stage.Status(ctx)
		return err
	}
	moveBy := func(ctx context.Context, step int64) error {
		_, err := axis.MoveBy(ctx, axisgate.Pulses(step))
		return err
	}
	found := map[string]figures{}
	if found["get_device"], err = measure(ctx, status, b.getDevice, readings); err != nil {
		return err
	}
	if found["move"], err = measure(ctx, moveBy, b.move, moves); err != nil {
		return err
	}
	return json.NewEncoder(os.Stdout).Encode(found)
}

func main() {
	if err := run(context.Background()); err != nil {
		log.Fatal(err)
	}
}
