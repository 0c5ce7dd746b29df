package axisgate

import (
	"fmt"
	"strconv"
	"strings"
	"time"

	"google.golang.org/protobuf/reflect/protoreflect"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A Position is the position of one axis.
type Position struct {
	// Axis is the name of the axis, or its number as text.
	Axis string
	// Value is the position in Unit, as an exact decimal: "-0.25". Empty if unknown.
	Value string
	// Unit is the unit of the axis.
	Unit Unit
	// Pulses is the position in drive pulses. nil if unknown.
	Pulses *int64
}

// Float returns the value as a floating-point number, and whether it is known.
func (p Position) Float() (float64, bool) {
	value, err := strconv.ParseFloat(p.Value, 64)
	return value, err == nil
}

// String returns the position with the name of its axis: "x 1.5 mm".
func (p Position) String() string {
	if p.Value == "" {
		return p.Axis + " unknown"
	}
	return fmt.Sprintf("%s %s %s", p.Axis, p.Value, p.Unit)
}

// A ScanResult has the numbers of trigger pulses of a scan. nil means unknown.
type ScanResult struct {
	// Expected is the number of pulses due in the whole run.
	Expected *int64
	// ExpectedInRange is the number of pulses due within the range.
	ExpectedInRange *int64
	// Observed is the number of pulses computed from the displacement.
	Observed *int64
}

// A Result is the result of a motion that succeeded.
type Result struct {
	// Motion is the name of the motion.
	Motion string
	// Positions are the final positions, in the order of the axes' numbers.
	Positions []Position
	// Duration is the time from the start to the outcome.
	Duration time.Duration
	// Scan is the result of a scan. nil: the motion was no scan.
	Scan *ScanResult
}

// Position returns the final position of an axis by its name, and whether the motion has this axis.
func (r *Result) Position(axis string) (Position, bool) {
	for _, position := range r.Positions {
		if position.Axis == axis {
			return position, true
		}
	}
	return Position{}, false
}

// String returns the positions: "x 1.5 mm, y -0.25 mm".
func (r *Result) String() string { return joined(r.Positions) }

func joined[T fmt.Stringer](items []T) string {
	var texts []string
	for _, item := range items {
		texts = append(texts, item.String())
	}
	return strings.Join(texts, ", ")
}

// enumName returns the name of an enum's value without its prefix, or the prefix with the number of an unknown value.
func enumName[E interface {
	~int32
	protoreflect.Enum
}](value E, prefix string) string {
	known := value.Descriptor().Values().ByNumber(value.Number())
	if known == nil {
		return fmt.Sprintf("%s%d", prefix, value)
	}
	return strings.TrimPrefix(string(known.Name()), prefix)
}

// axisName returns the configured name of an axis, or its number as text.
func axisName(name string, number int32) string {
	if name == "" {
		return strconv.Itoa(int(number))
	}
	return name
}

func numbers(axes []int32) []int {
	var all []int
	for _, axis := range axes {
		all = append(all, int(axis))
	}
	return all
}

// outcomeOf returns the result of a motion that is over, or the error of another outcome than success.
func outcomeOf(motion *axisgatev1.Motion) (*Result, error) {
	switch motion.State {
	case axisgatev1.MotionState_MOTION_STATE_SUCCEEDED:
		return resultOf(motion), nil
	case axisgatev1.MotionState_MOTION_STATE_STOPPED:
		return nil, asStopped(problemOf(motion.Problem, ""))
	case axisgatev1.MotionState_MOTION_STATE_UNKNOWN:
		return nil, asOutcomeUnknown(problemOf(motion.Problem, ""))
	}
	return nil, asMotionFailed(problemOf(motion.Problem, ""))
}

func resultOf(motion *axisgatev1.Motion) *Result {
	began := motion.StartTime
	if began == nil {
		began = motion.CreateTime
	}
	result := &Result{Motion: motion.Name, Duration: motion.EndTime.AsTime().Sub(began.AsTime())}
	for _, one := range motion.Results {
		result.Positions = append(result.Positions,
			Position{axisName(one.Name, one.Axis), one.Position, unitOf(one.Unit), one.CommandPulses})
	}
	if scan := motion.Scan; scan != nil {
		result.Scan = &ScanResult{scan.ExpectedTriggers, scan.ExpectedTriggersInRange, scan.ObservedTriggers}
	}
	return result
}
