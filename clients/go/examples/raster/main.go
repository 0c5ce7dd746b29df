// Command raster measures at each point of a raster, all night long. It survives a connection that is broken for up to
// a minute: no move is lost, and none is made twice. It ends if the stage needs a person.
package main

import (
	"context"
	"fmt"
	"iter"
	"log"
	"log/slog"
	"os"
	"os/signal"
	"time"

	"axisgate.example/go/axisgate"
)

// outage is the longest time without a connection.
const outage = time.Minute

func main() {
	ctx, cancel := signal.NotifyContext(context.Background(), os.Interrupt) // Ctrl-C cancels the present move
	defer cancel()
	if err := run(ctx); err != nil {
		log.Fatal(err)
	}
}

func run(ctx context.Context) error {
	stage, err := axisgate.Open(ctx, axisgate.WithTimeout(2*outage), axisgate.WithLogger(slog.Default()))
	if err != nil {
		return err
	}
	defer stage.Close()
	lease, err := stage.Lease(ctx, axisgate.LeaseTerms{Axes: []string{"x", "y"}, TTL: 2 * outage, FinishAtLoss: true,
		Purpose: "overnight raster"})
	if err != nil {
		return err
	}
	defer lease.Release(ctx)
	ctx = lease.Context(ctx)
	if _, err := stage.HomeIfNeeded(ctx, "x", "y"); err != nil {
		return err
	}
	for x, y := range raster(26, 26) {
		result, err := stage.MoveTo(ctx, axisgate.Targets{"x": axisgate.UM(20 * x), "y": axisgate.UM(20 * y)})
		if err != nil {
			return err
		}
		measure(result)
	}
	return nil
}

func raster(columns, rows int) iter.Seq2[int, int] {
	return func(yield func(x, y int) bool) {
		for y := range rows {
			for x := range columns {
				if !yield(x, y) {
					return
				}
			}
		}
	}
}

// measure stands for what a program does at each point.
func measure(at *axisgate.Result) { fmt.Println(at) }
