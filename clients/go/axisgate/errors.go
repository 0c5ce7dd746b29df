package axisgate

import (
	"errors"
	"fmt"
)

// ErrClosed is the error of a call on a Stage that is closed.
var ErrClosed = errors.New("axisgate: the stage is closed")

// ErrUnavailable matches, with [errors.Is], a refusal because the daemon or the controller cannot be reached.
var ErrUnavailable = errors.New("axisgate: the daemon or the controller cannot be reached")

// A Reason is the stable name of what went wrong: "OUTSIDE_TRAVEL". A reason that this package does not know is
// "REASON 99". The comment of axisgatev1.Reason lists all reasons.
//
// A Reason is also an error, which matches every error with this reason:
//
//	errors.Is(err, axisgate.LeaseHeld)
type Reason string

// Reasons that programs often distinguish. Any other reason can be written as Reason("TOO_FAST").
const (
	// OutsideTravel: the target is outside the travel limits of the axis.
	OutsideTravel Reason = "OUTSIDE_TRAVEL"
	// NotHomed: the axis must be homed before any other motion.
	NotHomed Reason = "NOT_HOMED"
	// LeaseHeld: another caller holds the axes, or moves them.
	LeaseHeld Reason = "LEASE_HELD"
	// LeaseLost: the lease of this program has ended.
	LeaseLost Reason = "LEASE_LOST"
	// StoppedBy: another caller stopped the axes. Call [Stage.Rearm] before the next motion.
	StoppedBy Reason = "STOPPED_BY"
	// NotAllowed: the caller's role does not allow the request.
	NotAllowed Reason = "NOT_ALLOWED"
	// Unauthenticated: the token is wrong, expired or revoked, or a required token is missing.
	Unauthenticated Reason = "UNAUTHENTICATED"
)

// Error returns the name of the reason.
func (r Reason) Error() string { return string(r) }

// An Error is an error that the daemon reports, or that the connection to it causes: a *Refused, *Stopped,
// *MotionFailed or *OutcomeUnknown.
type Error interface {
	error
	// Details returns the problem of the error.
	Details() *Problem
}

// A Problem is what happened, where, why, and what the caller can do.
type Problem struct {
	// Reason is stable. Programs should compare it, never Message.
	Reason Reason
	// Message is one sentence for people.
	Message string
	// Hint is advice to the caller. May be empty.
	Hint string
	// Axis is the number of the axis, from 1. 0: the problem does not concern a single axis.
	Axis int
	// Sent is the command line concerned. May be empty.
	Sent string
	// WireReply is the controller's reply. May be empty.
	WireReply string
	// Code is the name of the gRPC code, such as "OutOfRange". Empty: the error is not the answer to a call.
	Code string

	cause error // of the caller's context or ErrClosed; never an Error, which would say how the call ended
}

// Error returns the reason, the message and the hint.
func (p *Problem) Error() string {
	text := string(p.Reason) + ": " + p.Message
	if p.Hint != "" {
		text += " (" + p.Hint + ")"
	}
	return text
}

// Details returns the problem.
func (p *Problem) Details() *Problem { return p }

// Is reports whether target is the Reason of the problem.
func (p *Problem) Is(target error) bool { return target == p.Reason }

// Unwrap returns the error of the context that ended the call, ErrClosed, or nil.
func (p *Problem) Unwrap() error { return p.cause }

// Refused is the error of a request that was refused: nothing moved.
type Refused struct{ Problem }

// Is reports whether target is the Reason of the refusal, or ErrUnavailable for a reason of this kind.
func (r *Refused) Is(target error) bool {
	return r.Problem.Is(target) || (target == ErrUnavailable && unavailableReasons[r.Reason])
}

// Stopped is the error of a motion that a stop ended or prevented.
type Stopped struct{ Problem }

// MotionFailed is the error of a motion that ended with an error of the stage.
type MotionFailed struct{ Problem }

// OutcomeUnknown is the error of a request whose outcome is unknown. The axes may be moving: look at the stage before
// you repeat the request.
type OutcomeUnknown struct{ Problem }

// InvalidArgument is the error of a call with a wrong argument. Nothing was sent.
type InvalidArgument struct{ message string }

// Error returns the message.
func (e *InvalidArgument) Error() string { return "axisgate: " + e.message }

func invalid(format string, values ...any) error {
	return &InvalidArgument{fmt.Sprintf(format, values...)}
}
