// Command conformance translates the acts of the conformance scenario into calls of this package, one JSON object on a
// line each way.
package main

import (
	"bufio"
	"context"
	"encoding/json"
	"errors"
	"fmt"
	"os"

	"axisgate.example/go/axisgate"
)

type reply map[string]any

var done = reply{"outcome": "done"}

func shown(result *axisgate.Result, err error) (reply, error) {
	if err != nil {
		return nil, err
	}
	positions := map[string]string{}
	for _, position := range result.Positions {
		positions[position.Axis] = position.Value
	}
	return reply{"outcome": "done", "positions": positions}, nil
}

func replyTo(err error) reply {
	var known axisgate.Error
	var argument *axisgate.InvalidArgument
	switch {
	case errors.Is(err, context.Canceled):
		return reply{"outcome": "interrupted"}
	case errors.Is(err, context.DeadlineExceeded):
		return reply{"outcome": "timeout"}
	case errors.As(err, &known):
		problem := known.Details()
		return reply{"outcome": outcome(known), "reason": problem.Reason, "message": problem.Message,
			"hint": problem.Hint, "axis": problem.Axis}
	case errors.As(err, &argument), errors.Is(err, errPoint):
		return reply{"outcome": "local", "message": err.Error()}
	}
	return reply{"outcome": "unexpected", "message": err.Error()}
}

func outcome(err axisgate.Error) string {
	switch err.(type) {
	case *axisgate.Refused:
		return "refused"
	case *axisgate.Stopped:
		return "stopped"
	case *axisgate.MotionFailed:
		return "failed"
	}
	return "unknown"
}

func (r *runner) reply(line []byte) reply {
	var a act
	err := json.Unmarshal(line, &a)
	verb := verbs[a.Say]
	if verb == nil {
		return reply{"outcome": "unexpected", "message": fmt.Sprintf("%s: no such act (%v)", line, err)}
	}
	answer, err := verb(r, r.context(a), a)
	if err != nil {
		return replyTo(err)
	}
	return answer
}

func main() {
	r := &runner{motions: map[string]*axisgate.Motion{}, leases: map[string]*axisgate.Lease{}}
	replies := json.NewEncoder(os.Stdout)
	for lines := bufio.NewScanner(os.Stdin); lines.Scan(); {
		replies.Encode(r.reply(lines.Bytes()))
	}
}
