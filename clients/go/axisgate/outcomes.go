package axisgate

import (
	"errors"
	"fmt"
	"strings"

	"google.golang.org/grpc/codes"
	"google.golang.org/grpc/status"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A class makes the error of one type.
type class func(Problem) error

func asRefused(p Problem) error        { return &Refused{p} }
func asStopped(p Problem) error        { return &Stopped{p} }
func asMotionFailed(p Problem) error   { return &MotionFailed{p} }
func asOutcomeUnknown(p Problem) error { return &OutcomeUnknown{p} }

// classes has the class of the error of each reason that is not a refusal.
var classes = map[Reason]class{
	"STOPPED":             asStopped,
	"TARGET_NOT_REACHED":  asMotionFailed,
	"OUTCOME_UNKNOWN":     asOutcomeUnknown,
	"REQUEST_MEMORY_LOST": asOutcomeUnknown,
}

const unavailable Reason = "UNAVAILABLE"

var unavailableReasons = map[Reason]bool{
	unavailable: true, "LINK_DOWN": true, "NOT_SENT": true, "REPLY_TIMED_OUT": true, "LINE_FAULT": true,
	"COMPLETION_OUTSTANDING": true, "JOURNAL_UNAVAILABLE": true, "DAEMON_ENDING": true,
}

// beforeMemory has the reasons that the daemon may give before it compares the request's id with earlier requests.
var beforeMemory = map[Reason]bool{
	"INVALID_REQUEST": true, "UNKNOWN_DEVICE": true, "UNKNOWN_AXIS": true, "QUEUE_FULL": true, "NOT_ALLOWED": true,
	"UNAUTHENTICATED": true, "LEASE_LOST": true, "INTERNAL": true, "REQUEST_ID_REUSED": true,
}

// early has the reasons of calls that the daemon refuses before it can send a problem. ResourceExhausted is none of
// them: gRPC also reports it for an answer that is too long, after the request has acted.
var early = map[codes.Code]Reason{
	codes.Unauthenticated:  "UNAUTHENTICATED",
	codes.PermissionDenied: "NOT_ALLOWED",
	codes.Unimplemented:    "UNIMPLEMENTED",
}

// A failure is a call that ended without an answer. The problem is nil if the daemon did not report one. `sent` is
// false if no byte of the call can have reached the daemon.
type failure struct {
	code    codes.Code
	text    string
	problem *axisgatev1.Problem
	sent    bool
}

func failureOf(err error, sent bool) failure {
	found := status.Convert(err)
	f := failure{code: found.Code(), text: found.Message(), sent: sent}
	for _, detail := range found.Details() {
		if problem, ok := detail.(*axisgatev1.Problem); ok {
			f.problem = problem
		}
	}
	return f
}

// reason returns the name of the reason, or an empty one if the answer was lost.
func (f failure) reason() Reason {
	if f.problem == nil {
		return early[f.code]
	}
	return reasonOf(f.problem.Reason)
}

// lost reports whether the answer was lost, so that the request may have acted.
func (f failure) lost() bool { return f.problem == nil && early[f.code] == "" }

// neverSent reports whether the request cannot have acted because there was no connection.
func (f failure) neverSent() bool { return f.lost() && !f.sent }

// passing reports whether the same request may succeed a moment later.
func (f failure) passing() bool { return f.lost() || f.code == codes.Unavailable }

// decidesRepeat reports whether the refusal of a repeat means that the first request did not act either.
func (f failure) decidesRepeat() bool { return !f.passing() && !beforeMemory[f.reason()] }

func reasonOf(number axisgatev1.Reason) Reason {
	name, known := axisgatev1.Reason_name[int32(number)]
	if !known {
		return Reason(fmt.Sprintf("REASON %d", number))
	}
	return Reason(strings.TrimPrefix(name, "REASON_"))
}

// errorOf returns the error of a call that failed and is not repeated. `target` is the daemon's address.
func errorOf(f failure, target string) error {
	switch {
	case f.problem != nil:
		problem := problemOf(f.problem, f.code.String())
		return classOf(problem.Reason)(problem)
	case !f.lost():
		return asRefused(Problem{Reason: f.reason(), Message: f.text, Code: f.code.String()})
	case f.neverSent():
		return unavailableError(f, target)
	}
	return lookFirst(fmt.Sprintf("the answer of the daemon at %s was lost: %s", target, f.text), f.code.String(), nil)
}

// unavailableError returns the error of a request that acted nowhere because the daemon did not answer.
func unavailableError(f failure, target string) error {
	return asRefused(Problem{Reason: unavailable, Message: fmt.Sprintf("no daemon answers at %s: %s", target, f.text),
		Hint: "start axisgated, or set AXISGATE_TARGET to its address", Code: f.code.String()})
}

// undelivered returns the error of a stop. A stop that reached no daemon is not Refused: the axes may be moving.
func undelivered(err error) error {
	var refused *Refused
	if !errors.As(err, &refused) || !errors.Is(err, ErrUnavailable) {
		return err
	}
	return asOutcomeUnknown(Problem{Reason: refused.Reason, Message: "the stop was not delivered: " + refused.Message,
		Hint: "press the emergency stop at the device", Code: refused.Code})
}

// lookFirst returns the error of a request that may have acted.
func lookFirst(message, code string, cause error) error {
	return asOutcomeUnknown(Problem{Reason: "OUTCOME_UNKNOWN", Message: message,
		Hint: "look at the stage before you repeat the request", Code: code, cause: cause})
}

func classOf(reason Reason) class {
	if class := classes[reason]; class != nil {
		return class
	}
	return asRefused
}

// problemOf returns the public form of a problem. An empty code: it is not the answer to a call.
func problemOf(p *axisgatev1.Problem, code string) Problem {
	axis := int(p.GetAxis())
	return Problem{Reason: reasonOf(p.GetReason()), Message: p.GetMessage(), Hint: withFunctions(p.GetHint(), axis),
		Axis: axis, Sent: p.GetSent(), WireReply: p.GetWireReply(), Code: code}
}
