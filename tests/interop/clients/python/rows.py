"""The rows of ../../README.md. Each function runs one row and raises Failure if something was not as described."""

import concurrent.futures
import queue
import threading
import time

import grpc
from axisgate.v1 import access_pb2, command_pb2, common_pb2, control_pb2, device_pb2, event_pb2, mill_pb2
from axisgate.v1 import motion_pb2, stage_pb2
from google.protobuf import duration_pb2

from calls import Failure, expect

STAGE = "devices/stage"
NOW = duration_pb2.Duration()
MILL = "devices/mill"
PING_S = 1

ROWS = {}
CHANNEL_OPTIONS = {
    "gzip": {"compression": grpc.Compression.Gzip},
    "keepalive": {"options": [
        ("grpc.keepalive_time_ms", PING_S * 1000),
        ("grpc.keepalive_timeout_ms", 2 * PING_S * 1000),
        ("grpc.keepalive_permit_without_calls", 1),
        ("grpc.http2.max_pings_without_data", 0),
        # The newest grpcio waits this long for the answer to a PING; 1.51 uses the keepalive timeout.
        ("grpc.http2.ping_timeout_ms", 2 * PING_S * 1000),
    ]},
}


def row(name):
    def add(function):
        ROWS[name] = function
        return function
    return add


def say(line):
    print(line, flush=True)


def get_stage(calls, max_age=None, **options):
    """No max_age: as it was read last."""
    request = device_pb2.GetDeviceRequest(device=STAGE, max_age=max_age)
    answer = calls.call("device.DeviceService.GetDevice", request, **options)
    return answer and answer.device


def get_caller(calls, **options):
    return calls.call("access.AccessService.GetCaller", access_pb2.GetCallerRequest(), **options)


class Watch:
    """Checks that each event's revision is the one before, plus 1."""

    def __init__(self, calls, request=event_pb2.WatchRequest(from_revision=0), **options):
        self.stream = calls.stream("event.EventService.Watch", request, **options)
        self.last = None

    def check(self, event):
        if self.last is not None:
            expect("revision", event.revision, self.last.revision + 1)
        self.last = event
        return event

    def next(self):
        return self.check(self.stream.message().event)

    def end(self, code):
        for message in self.stream.end(code):
            self.check(message.event)

    def succeeded(self, name):
        """Reads events until the motion has its outcome, which must be SUCCEEDED."""
        while True:
            motion = self.next().motion
            if motion.name == name and motion.state == motion_pb2.MOTION_STATE_SUCCEEDED:
                return
            if motion.name == name and motion.HasField("end_time"):
                raise Failure(name, motion_pb2.MotionState.Name(motion.state), "MOTION_STATE_SUCCEEDED")


def move(calls, watch, nth=0):
    distance = common_pb2.Distance(um="10" if nth % 2 == 0 else "-10")
    targets = [common_pb2.AxisTarget(axis="1", distance=distance)]
    request = stage_pb2.MoveRequest(device=STAGE, relative=True, targets=targets)
    watch.succeeded(calls.call("stage.StageService.Move", request).motion.name)


@row("unary-front")
def unary_front(calls):
    for _ in range(200):
        device = get_stage(calls)
        expect("name", device.name, STAGE)
        expect("link", device.link, device_pb2.LINK_STATE_UP)
    for _ in range(200):
        answer = calls.call("device.DeviceService.ListDevices", device_pb2.ListDevicesRequest())
        expect("devices", sorted(device.name for device in answer.devices), [MILL, STAGE])
    nothing = device_pb2.GetDeviceRequest(device="devices/none")
    calls.call("device.DeviceService.GetDevice", nothing, code="NOT_FOUND")


@row("unary-grpc")
def unary_grpc(calls):
    for _ in range(200):
        if not get_caller(calls).caller.name:
            raise Failure("who", "nothing", "a name")
    answer = calls.call("command.CommandService.ListCommands", command_pb2.ListCommandsRequest(device=STAGE))
    if len(answer.commands) <= 50:
        raise Failure("commands", len(answer.commands), "more than 50")
    nothing = stage_pb2.GetMotionRequest(motion=f"{STAGE}/motions/999999999")
    calls.call("stage.StageService.GetMotion", nothing, code="NOT_FOUND")


@row("watch")
def watch_row(calls):
    watch = Watch(calls)
    for n in range(3):
        move(calls, watch, n)
    watch.stream.call.cancel()
    watch.end("CANCELLED")


def execute(calls, lines, code):
    request = command_pb2.ExecuteRequest(device=STAGE, lines=lines)
    return calls.stream("command.CommandService.Execute", request).end(code)


def execute_once(calls):
    messages = execute(calls, ["*IDN?", "Q:", "?:N"], "OK")
    expect("changes", [message.WhichOneof("change") for message in messages], ["reply"] * 3)
    expect("reply.line", [message.reply.line for message in messages], [1, 2, 3])
    if not all(message.reply.answer for message in messages):
        raise Failure("reply.answer", "nothing", "an answer")


@row("execute")
def execute_row(calls):
    for _ in range(50):
        execute_once(calls)
    expect("messages of a refused Execute", len(execute(calls, ["QQ:"], "INVALID_ARGUMENT")), 0)


def job_requests(text, count, title):
    """Returns the header, and `text` cut into `count` pieces of almost equal length."""
    data = text.encode()
    cuts = [len(data) * n // count for n in range(count + 1)]
    requests = [mill_pb2.SendJobRequest(data=data[cuts[n]:cuts[n + 1]]) for n in range(count)]
    header = mill_pb2.JobHeader(device=MILL, title=title, tool="T1")
    return [mill_pb2.SendJobRequest(header=header), *requests]


@row("send-job")
def send_job(calls):
    text = "^IN;!MC0;!PZ-50,200;" + "PU4000,0;PU0,0;" * 4000 + "H;\n"
    job = calls.call("mill.MillService.SendJob", iter(job_requests(text, 64, "interop"))).job
    expect("job.bytes", job.bytes, len(text))
    expect("job.title", job.title, "interop")
    calls.call("mill.MillService.CancelJob", mill_pb2.CancelJobRequest(job=job.name))


def converse(calls, name):
    """Begins a call with streams in both directions. Returns its requests, ended by None, and its stream."""
    requests = queue.SimpleQueue()
    return requests, calls.stream(name, iter(requests.get, None))


def axis2(pulses_per_s, **direction):
    return [stage_pb2.AxisJog(axis="2", speed=common_pb2.Speed(pulses_per_s=pulses_per_s), **direction)]


def begin_jog(calls):
    """Begins a jog and returns its requests and its stream after an answer in state RUNNING."""
    requests, stream = converse(calls, "stage.StageService.Jog")
    axes = axis2(1000, direction=stage_pb2.AxisJog.DIRECTION_PLUS)
    requests.put(stage_pb2.JogRequest(device=STAGE, axes=axes))
    while stream.message().motion.state != motion_pb2.MOTION_STATE_RUNNING:
        pass
    return requests, stream


@row("jog")
def jog(calls):
    requests, stream = begin_jog(calls)
    requests.put(stage_pb2.JogRequest(axes=axis2(2000)))
    requests.put(None)
    states = [motion_pb2.MotionState.Name(answer.motion.state) for answer in stream.end("OK")]
    expect("last state", states[-1:], ["MOTION_STATE_SUCCEEDED"])


@row("keep-lease")
def keep_lease(calls):
    terms = control_pb2.LeaseTerms(axes=["3"], time_to_live=duration_pb2.Duration(seconds=10))
    request = control_pb2.AcquireLeaseRequest(device=STAGE, terms=terms)
    token = calls.call("control.ControlService.AcquireLease", request).lease.token
    expect("bytes of the token", len(token), 24)
    requests, stream = converse(calls, "control.ControlService.KeepLeaseAlive")
    for _ in range(10):
        requests.put(control_pb2.KeepLeaseAliveRequest(device=STAGE, lease_token=token))
        expect("lease.axes", list(stream.message().lease.axes), [3])
    requests.put(None)
    expect("further answers", len(stream.end("OK")), 0)
    context = common_pb2.CallContext(lease_token=token)
    calls.call("control.ControlService.ReleaseLease", control_pb2.ReleaseLeaseRequest(device=STAGE, context=context))


@row("gzip")
def gzip(calls):
    for call in (get_stage, get_caller, execute_once):
        for _ in range(20):
            call(calls)
    send_job(calls)
    # gRPC C core sends a message as it is if gzip does not shorten it.
    say("note only the job is compressed: grpcio leaves requests as they are that gzip does not shorten")


@row("deadline")
def deadline(calls):
    begun = time.monotonic()
    calls.stream("event.EventService.Watch", event_pb2.WatchRequest(), timeout=0.5).end("DEADLINE_EXCEEDED")
    seconds = time.monotonic() - begun
    if not 0.4 <= seconds <= 5:
        raise Failure("end of Watch after", f"{seconds} s", "0.4 to 5 s")
    get_stage(calls)
    get_caller(calls)


@row("cancel")
def cancel(calls):
    requests, stream = begin_jog(calls)
    stream.call.cancel()
    stream.end("CANCELLED")
    requests.put(None)

    def read():
        time.sleep(0.05)
        return next(axis for axis in get_stage(calls, NOW).axes if axis.number == 2)

    limit = time.monotonic() + 10
    while not (axis := read()).HasField("busy") or axis.busy:
        if time.monotonic() > limit:
            raise Failure("axis 2 after the cancel", "busy for 10 s", "not busy")
    first, second = read(), read()
    expect("position_pulses is set", first.HasField("position_pulses"), True)
    expect("second position_pulses", second.position_pulses, first.position_pulses)


@row("keepalive")
def keepalive(calls):
    watch = Watch(calls)
    time.sleep(2.5 * PING_S + 1)
    move(calls, watch)


@row("metadata")
def metadata(calls):
    watch = Watch(calls)
    watch.next()
    for kib, code in ((8, "OK"), (15, "OK"), (40, "RESOURCE_EXHAUSTED")):
        note = [("x-note", "a" * (kib * 1024))]
        get_caller(calls, metadata=note, code=code)
        get_stage(calls, metadata=note, code=code)
    move(calls, watch)


@row("many")
def many(calls):
    watch = Watch(calls)
    request = device_pb2.GetDeviceRequest(device=STAGE)
    begun = [calls.begin("device.DeviceService.GetDevice", request) for _ in range(500)]
    for n in range(10):
        move(calls, watch, n)
    for future in begun:
        expect("GetDevice", future.code().name, "OK")


@row("restart")
def restart(calls):
    first = Watch(calls)
    move(calls, first)
    say("ready")
    first.end("UNAVAILABLE")
    revision = first.last.revision + 1
    request = event_pb2.WatchRequest(from_revision=revision, run=first.last.run)
    second = Watch(calls, request, wait_for_ready=True)
    expect("first revision after the restart", second.next().revision, revision)
    while second.last.WhichOneof("fact") != "daemon_started":
        second.next()
    limit = time.monotonic() + 30
    while (link := get_stage(calls).link) != device_pb2.LINK_STATE_UP:
        if time.monotonic() > limit:
            raise Failure("link 30 s after the restart", device_pb2.LinkState.Name(link), "LINK_STATE_UP")
        time.sleep(0.1)


@row("end-in-call")
def end_in_call(calls):
    lock = threading.Lock()
    sent = []

    def send(title):
        requests = iter(job_requests("^IN;!MC0;PU0,0;H;\n", 4, title))
        with lock:
            method = calls.method("mill.MillService.SendJob")
        try:
            method(requests, timeout=30, wait_for_ready=True)
        except grpc.RpcError as error:
            with lock:
                return say(f"failed {title} {error.code().name}")
        with lock:
            sent.append(title)
            return say(f"sent {title}" + ("\nready" if len(sent) == 10 else ""))

    with concurrent.futures.ThreadPoolExecutor(max_workers=4) as pool:
        list(pool.map(send, [f"end-{n}" for n in range(40)]))
