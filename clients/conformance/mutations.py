"""Mutations of the daemon. Each makes the daemon wrong in one way, which the scenario must notice with every package.

The function of a mutation answers the calls of one method: it sends requests to the daemon, or does not, and yields
answers, or raises grpc.RpcError. The table at the end says what each does.
"""

import dataclasses
import decimal
import time
import typing

import grpc
from google.protobuf import text_format

from messages import METHODS, Problem, Status

LATE_S = 10
DETAILS = "grpc-status-details-bin"
ACQUIRE_LEASE = "/axisgate.v1.ControlService/AcquireLease"
MOVE = "/axisgate.v1.StageService/Move"
RENEW_LEASE = "/axisgate.v1.ControlService/RenewLease"
STOP = "/axisgate.v1.StageService/Stop"
WAIT_MOTION = "/axisgate.v1.StageService/WaitMotion"
WATCH = "/axisgate.v1.EventService/Watch"


class Refusal(grpc.RpcError):
    """A Refusal is the error of a call that the daemon refuses with a problem."""

    def __init__(self, code, problem):
        self._code = code
        self._problem = problem

    def code(self):
        return self._code

    def details(self):
        return self._problem.message

    def trailing_metadata(self):
        status = Status(code=self._code.value[0], message=self._problem.message)
        status.details.add().Pack(self._problem)
        return ((DETAILS, status.SerializeToString()),)


def problem_of(error):
    """Returns the problem of a call that failed. None: the daemon did not report a problem."""
    details = dict(error.trailing_metadata() or ()).get(DETAILS, b"")
    problem = Problem()
    return next((problem for detail in Status.FromString(details).details if detail.Unpack(problem)), None)


def changed(message, text):
    """Returns the message with the fields of a text in protobuf's text format."""
    return text_format.Merge(text, message)


def has_state(motion, name):
    """Reports whether the motion has the state with this name."""
    return motion.state == type(motion)(state=f"MOTION_STATE_{name}").state


def unknown_reason(_):
    """Refuses every move with a reason that no package knows yet, as a newer daemon may."""
    text = 'reason: 999 message: "the moon is full" hint: "wait for another night"'
    raise Refusal(grpc.StatusCode.FAILED_PRECONDITION, changed(Problem(), text))


def wrong_reason(call):
    try:
        yield from call.send()
    except grpc.RpcError as error:
        problem = problem_of(error)
        if problem is None:
            raise
        raise Refusal(error.code(), changed(problem, "reason: REASON_TOO_FAST")) from None


def lost_event(call):
    seen = 0
    for answer in call.send():
        succeeded = has_state(answer.event.motion, "SUCCEEDED")
        seen += succeeded
        if not succeeded or seen != 2:
            yield answer


def second_motion(call):
    request = next(call.requests)
    for answer in call.send(request):
        call.ask(WAIT_MOTION, motion=answer.motion.name)
        request.context.request_id += " again"
        list(call.send(request))
        yield answer


def off_by_one_pulse(call):
    for answer in call.send():
        for result in answer.motion.results:
            if result.command_pulses and result.position:
                pulse = decimal.Decimal(result.position) / result.command_pulses
                result.command_pulses += 1
                result.position = str(pulse * result.command_pulses)
        yield answer


def lease_not_extended(call):
    request = next(call.requests)
    answer = METHODS[RENEW_LEASE][1]()
    answer.lease.token = request.context.lease_token
    yield answer


def another_request(call):
    for answer in call.send():
        answer.motion.request_id = "the request of another caller"
        yield answer


def unknown_as_stopped(call):
    for answer in call.send():
        if has_state(answer.motion, "UNKNOWN"):
            changed(answer.motion, "state: MOTION_STATE_STOPPED problem { reason: REASON_STOPPED }")
        yield answer


def late_lease_lost(call):
    try:
        yield from call.send()
    except grpc.RpcError:
        time.sleep(LATE_S)  # the delay is the mutation
        raise


def long_lease(call):
    request = next(call.requests)
    request.terms.time_to_live.seconds *= 10
    yield from call.send(request)


def gap_left_out(call):
    request = next(call.requests)
    try:
        yield from call.send(request)
    except grpc.RpcError as error:
        problem = problem_of(error)
        if problem is None or "resume_revision" not in problem.metadata:
            raise
        request.from_revision, request.run = int(problem.metadata["resume_revision"]), ""
        yield from call.send(request)


def stop_not_sent(_):
    yield METHODS[STOP][1]()


@dataclasses.dataclass(frozen=True)
class Mutation:
    """A Mutation is one row of the table. It makes `step` fail with a difference that begins with `difference`.

    `answer` answers the calls of the method `path`, and of `also`. A mutation with step 0 is a part of the scenario.
    """

    name: str
    does: str
    path: str
    answer: typing.Callable
    step: int = 0
    difference: str = ""
    also: str = ""


UNKNOWN_REASON = Mutation("unknown-reason", "a newer daemon refuses moves with a new reason", MOVE, unknown_reason)

MUTATIONS = (
    Mutation("wrong-reason", "refuses a move with another reason", MOVE, wrong_reason,
             6, 'reason is "TOO_FAST", not "OUTSIDE_TRAVEL"'),
    Mutation("lost-event", "leaves out the second motion that succeeded from a stream of events", WATCH, lost_event,
             22, 'no reply within 10 s to {"say": "succeeded", "count": 2}'),
    Mutation("second-motion", "does a move twice", MOVE, second_motion,
             3, "the controller was sent 2 starts of motion, not 1"),
    Mutation("off-by-one-pulse", "reports a position that is wrong by one pulse", WAIT_MOTION, off_by_one_pulse,
             3, 'positions is {"x": "1.50'),
    Mutation("lease-not-extended", "answers renewals of a lease without extending it", RENEW_LEASE, lease_not_extended,
             13, 'outcome is "refused", not "done"'),
    Mutation("another-request", "answers with the motion of another request", WAIT_MOTION, another_request,
             3, 'outcome is "unknown", not "done"'),
    Mutation("another-motion", "answers a move with the motion of another request", MOVE, another_request,
             3, 'outcome is "unknown", not "done"'),
    Mutation("unknown-as-stopped", "says that a motion with an unknown end was stopped", WAIT_MOTION,
             unknown_as_stopped, 21, 'outcome is "stopped", not "unknown"', MOVE),
    Mutation("late-lease-lost", "says too late that a lease is lost", RENEW_LEASE, late_lease_lost,
             27, "lost is false, not true"),
    Mutation("long-lease", "ends a lease only after ten times its time to live", ACQUIRE_LEASE, long_lease,
             14, 'outcome is "done", not "refused"'),
    Mutation("gap-left-out", "resumes after events that are no longer kept, and does not say so", WATCH, gap_left_out,
             26, "gaps is 0, not 1"),
    Mutation("stop-not-sent", "answers a stop without sending it to the stage", STOP, stop_not_sent,
             23, 'outcome is "done", not "stopped"'),
)
