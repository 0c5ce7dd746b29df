// Command move moves the axis x of the local stage, and waits.
package main

import (
	"context"
	"errors"
	"fmt"
	"log"
	"os"
	"os/signal"

	"axisgate.example/go/axisgate"
)

func main() {
	ctx, cancel := signal.NotifyContext(context.Background(), os.Interrupt) // Ctrl-C cancels the move
	defer cancel()
	if err := run(ctx); err != nil {
		log.Fatal(err)
	}
}

func run(ctx context.Context) error {
	stage, err := axisgate.Open(ctx)
	if err != nil {
		return err
	}
	defer stage.Close()
	result, err := stage.Axis("x").MoveTo(ctx, axisgate.MM("1.5"))
	var refused *axisgate.Refused
	if errors.As(err, &refused) {
		return fmt.Errorf("nothing moved: %s", refused.Hint)
	}
	if err != nil {
		return err
	}
	fmt.Println(result)
	return nil
}
