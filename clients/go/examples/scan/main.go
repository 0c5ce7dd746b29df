// Command scan runs the axis x of the local stage over 2 mm, with a trigger pulse every 10 um, and prints the numbers
// of pulses.
package main

import (
	"context"
	"fmt"
	"log"

	"axisgate.example/go/axisgate"
)

func main() {
	if err := run(context.Background()); err != nil {
		log.Fatal(err)
	}
}

func run(ctx context.Context) error {
	stage, err := axisgate.Open(ctx)
	if err != nil {
		return err
	}
	defer stage.Close()
	motion, err := stage.Scan(ctx, axisgate.Scan{Axis: "x", Start: axisgate.MM(0), End: axisgate.MM(2),
		Every: axisgate.UM(10), Speed: axisgate.UM(200).PerSecond()})
	if err != nil {
		return err
	}
	result, err := motion.Wait(ctx)
	if err != nil {
		return err
	}
	if pulses := result.Scan; pulses.Observed != nil && pulses.Expected != nil {
		fmt.Printf("%d of %d pulses\n", *pulses.Observed, *pulses.Expected)
	}
	return nil
}
