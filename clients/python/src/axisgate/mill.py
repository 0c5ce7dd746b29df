"""Mills: jobs, their queue, and what a person does at the mill."""

from __future__ import annotations

from typing import Any, Callable, List, Optional, Sequence, Union

from axisgate import _requests
from axisgate._methods import (ABORT_JOB, CANCEL_JOB, CONFIRM_JOB, GET_MILL, OPERATE_MILL, PAUSE_JOB, REPORT_JOB_DONE,
                               RESUME_JOB, SEND_JOB_PIECE, START_JOB, WATCH_MILL)
from axisgate._session import DeviceSession
from axisgate._stream import ResumingStream
from axisgate.device import Device
from axisgate.units import Distance, Speed
from axisgate.v1 import common_pb2, device_pb2, mill_pb2

_PIECE_BYTES = 1 << 19
# Bytes that are sent in a second at the least; the time for them is added to the limit of the request.
_BYTES_PER_S = 1_000_000


class MillStates(ResumingStream[mill_pb2.Mill]):
    """MillStates is the iterator of Mill.watch(). Iterate in one thread; close() may be called from any thread."""

    def __init__(self, session: DeviceSession) -> None:
        self._device = session.device
        super().__init__(session.connection, WATCH_MILL)

    def _request(self) -> mill_pb2.WatchMillRequest:
        return mill_pb2.WatchMillRequest(device=self._device)

    def _take(self, answer: mill_pb2.WatchMillResponse) -> mill_pb2.Mill:
        mill: mill_pb2.Mill = answer.mill
        return mill


class Mill(Device):
    """A Mill is the connection to one mill. All functions are thread safe.

    A mill never answers, so the progress of a job is a range that the daemon computes. Jobs and states are the API's
    messages `Job` and `Mill`. A job is sent to the queue, confirmed by a person at the mill, started, and reported as
    done. Not a safety function: use the mill's own emergency stop.
    """

    _capability = device_pb2.CAPABILITY_JOBS

    def read(self) -> mill_pb2.Mill:
        """Returns the state of the mill: its queue, the running job, tools and origins."""
        answer = self._session.connection.ask(GET_MILL, mill_pb2.GetMillRequest(device=self._session.device))
        mill: mill_pb2.Mill = answer.mill
        return mill

    def watch(self) -> MillStates:
        """Iterates over the state of the mill, now and after every change, also over broken connections."""
        return MillStates(self._session)

    def send(self, *parts: bytes, title: str, tools: Sequence[str], origin: str = "",
             accepted_warnings: Sequence[str] = (), stock: Optional[Sequence[Distance]] = None) -> mill_pb2.Job:
        """Puts a job into the queue, once, even if an answer is lost. Returns the job.

        `parts` are the contents of the job's files, and `tools` the names of their tools. The operator changes the tool
        between two parts. `title` has 1 to 100 bytes. `origin` is the name of a configured origin; empty: the origin
        set at the panel. `stock` is the size of the workpiece in X, Y and Z.

        Raises Refused if the check of the job finds an error, or a warning that is not in `accepted_warnings`.
        """
        if not parts or len(parts) != len(tools):
            raise ValueError(f"there are {len(tools)} tools for {len(parts)} parts of the job")
        header = mill_pb2.JobHeader(
            device=self._session.device, title=title, origin=origin, accepted_warnings=accepted_warnings,
            parts=[mill_pb2.JobPart(tool=tool, bytes=len(part)) for tool, part in zip(tools, parts)],
            stock=None if stock is None else mill_pb2.Stock(
                **{axis: _requests.distance(size) for axis, size in zip("xyz", stock)}))
        content = b"".join(parts)

        def attempt_with(context: common_pb2.CallContext) -> Callable[[float], mill_pb2.Job]:
            header.context.CopyFrom(context)
            return lambda timeout: self._send_pieces(header, content, timeout)
        return self._session.connection.act_by(attempt_with, self._session.token(), len(content) / _BYTES_PER_S)

    def confirm(self, job: mill_pb2.Job) -> mill_pb2.Job:
        """Confirms that a person has set up the mill as `job.setup` says, for the next job or its next part."""
        return self._job(CONFIRM_JOB, mill_pb2.ConfirmJobRequest(job=job.name, seen=job.setup))

    def start(self, job: mill_pb2.Job) -> mill_pb2.Job:
        """Starts a confirmed job, or its next part."""
        return self._job(START_JOB, mill_pb2.StartJobRequest(job=job.name))

    def pause(self, *, raise_tool: bool = False) -> None:
        """Sends no more of the running job. The mill executes what it has received; with `raise_tool` the tool is then
        raised."""
        request = mill_pb2.PauseJobRequest(device=self._session.device, raise_tool=raise_tool)
        self._session.act(PAUSE_JOB, request)

    def resume(self) -> None:
        """Continues a job that was paused with the tool in the cut."""
        self._session.act(RESUME_JOB, mill_pb2.ResumeJobRequest(device=self._session.device))

    def abort(self) -> None:
        """Ends the running job, discards the mill's buffer, raises the tool and stops the spindle. Needs no lease.

        It is unknown whether the mill has done so. The abort is sent again for half of the timeout if no daemon
        answers.
        """
        request = mill_pb2.AbortJobRequest(device=self._session.device)
        request.context.lease_token = self._session.token()
        self._session.connection.stop(ABORT_JOB, request)

    def cancel(self, job: mill_pb2.Job) -> None:
        """Removes a job that does not run from the queue."""
        self._session.act(CANCEL_JOB, mill_pb2.CancelJobRequest(job=job.name))

    def report_done(self, job: mill_pb2.Job) -> None:
        """Reports that a person has seen the workpiece of a job that is FED."""
        self._session.act(REPORT_JOB_DONE, mill_pb2.ReportJobDoneRequest(job=job.name))

    def step(self, *, speed: Optional[Speed] = None, **displacements: Distance) -> float:
        """Moves the tool by hand: ``mill.step(z=-0.5 * mm)``. Z grows upward. Nothing checks where a step leads.

        Returns the longest time in seconds until the mill has done it.
        """
        step = mill_pb2.JogStep(speed=None if speed is None else _requests.speed(speed),
                                **{axis: _requests.distance(amount) for axis, amount in displacements.items()})
        return self._operate(step=step)

    def set_z0(self, height: Union[None, str, Distance] = None) -> float:
        """Sets Z0 at the height of the tool, of a configured origin, or of a machine coordinate. Returns as step()."""
        if isinstance(height, str):
            return self._operate(surface=mill_pb2.SetZ0(origin=height))
        z = None if height is None else _requests.distance(height)
        return self._operate(surface=mill_pb2.SetZ0(z=z))

    def spindle(self, on: bool) -> float:
        """Starts or stops the spindle. Returns as step()."""
        return self._operate(spindle=on)

    def raise_tool(self) -> float:
        """Raises the tool to the top, with the spindle stopped. Returns as step()."""
        return self._operate(raise_tool=mill_pb2.RaiseTool())

    def jobs(self) -> List[mill_pb2.Job]:
        """Returns the jobs in the order of the queue, with the running job."""
        return list(self.read().jobs)

    def _job(self, method: Any, request: Any) -> mill_pb2.Job:
        job: mill_pb2.Job = self._session.act(method, request).job
        return job

    def _operate(self, **act: Any) -> float:
        answer = self._session.act(OPERATE_MILL, mill_pb2.OperateMillRequest(device=self._session.device, **act))
        return float(answer.longest_time.ToNanoseconds() / 1e9)

    def _send_pieces(self, header: mill_pb2.JobHeader, content: bytes, timeout: float) -> mill_pb2.Job:
        """Sends the job from the byte on that the daemon does not have yet."""
        at = 0
        while True:
            piece = content[at:at + _PIECE_BYTES]
            request = mill_pb2.SendJobPieceRequest(header=header, offset=at, data=piece,
                                                   last=at + len(piece) == len(content))
            answer = self._session.connection.once(SEND_JOB_PIECE, request)(timeout)
            if answer.HasField("job"):
                job: mill_pb2.Job = answer.job
                return job
            at = answer.received
