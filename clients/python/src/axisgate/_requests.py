"""Builders of request messages. Nothing here sends."""

from __future__ import annotations

import time
import uuid
from decimal import Decimal
from typing import Any, Iterable, List, Mapping, Optional, Sequence, Union

from google.protobuf import duration_pb2

from axisgate.points import Arc
from axisgate.units import Distance, Speed, Unit
from axisgate.v1 import common_pb2, control_pb2, device_pb2, stage_pb2

_UNITS = {
    "nm": common_pb2.UNIT_NANOMETERS,
    "um": common_pb2.UNIT_MICROMETERS,
    "mm": common_pb2.UNIT_MILLIMETERS,
    "deg": common_pb2.UNIT_DEGREES,
    "pulses": common_pb2.UNIT_PULSES,
}
_DISTANCE_FIELDS = {"nm": "nm", "um": "um", "mm": "mm", "deg": "degrees", "pulses": "pulses"}
_SPEED_FIELDS = {"nm": "nm_per_s", "um": "um_per_s", "mm": "mm_per_s", "deg": "degrees_per_s",
                 "pulses": "pulses_per_s"}
_AT_LOSS = {"stop": control_pb2.AT_LOSS_STOP, "finish": control_pb2.AT_LOSS_FINISH}
# Longest time until the answer to a stop, which then has what is known.
_STOP_S = 4.0


def distance(amount: object) -> common_pb2.Distance:
    """Returns the message of a Distance. Raises TypeError for anything else."""
    if isinstance(amount, Speed) or not isinstance(amount, Distance):
        raise TypeError(f"{amount!r} is not a distance: write a number with its unit, such as 1.5 * mm")
    return common_pb2.Distance(**_amount(amount.value, amount.unit, _DISTANCE_FIELDS))


def speed(amount: object) -> common_pb2.Speed:
    """Returns the message of a Speed. Raises TypeError for anything else."""
    if not isinstance(amount, Speed):
        raise TypeError(f"{amount!r} is not a speed: write a number with its unit, such as 2 * mm / s")
    return common_pb2.Speed(**_amount(amount.value, amount.unit, _SPEED_FIELDS))


def _amount(value: Union[int, float, Decimal], unit: Unit, fields: Mapping[str, str]) -> Mapping[str, Any]:
    if isinstance(value, float):
        return {"floating": common_pb2.FloatingAmount(value=value, unit=_UNITS[unit.symbol],
                                                      rounding=common_pb2.ROUNDING_NEAREST)}
    if unit.symbol != "pulses":
        return {fields[unit.symbol]: format(value, "f") if isinstance(value, Decimal) else str(value)}
    if value != int(value):
        raise ValueError(f"{value} is not a whole number of pulses")
    return {fields[unit.symbol]: int(value)}


def duration(seconds: float) -> duration_pb2.Duration:
    """Returns the message of a time span."""
    message = duration_pb2.Duration()
    message.FromNanoseconds(round(seconds * 1e9))
    return message


def new_context(memory: str, lease_token: bytes, clock_ahead_s: float, patience_s: float) -> common_pb2.CallContext:
    """Returns the context of a request that is sent for the first time now, and counts for `patience_s`.

    `clock_ahead_s` is the difference of the daemon's clock to the clock of this machine.
    """
    context = common_pb2.CallContext(request_id=str(uuid.uuid4()), lease_token=lease_token, request_memory=memory)
    context.not_after.FromNanoseconds(int((time.time() + clock_ahead_s + patience_s) * 1e9))
    return context


def clock_ahead(listed: device_pb2.ListDevicesResponse) -> float:
    """Returns by how many seconds the daemon's clock is ahead of this machine's, just after this answer came."""
    if not listed.HasField("time"):
        return 0.0
    now_ns: int = listed.time.ToNanoseconds()
    return now_ns / 1e9 - time.time()


def profile(maximum: Optional[Speed]) -> Optional[common_pb2.Profile]:
    """Returns the speed profile of a move at most at the given speed. None: the present profile of the axis."""
    return None if maximum is None else common_pb2.Profile(maximum=speed(maximum))


def move(device: str, targets: Mapping[str, Distance], *, relative: bool, speed: Optional[Speed] = None,
         approach: Optional[Distance] = None, validate_only: bool = False) -> stage_pb2.MoveRequest:
    """Returns a move without its context. `speed` and `approach` are those of all its axes."""
    if not targets:
        raise TypeError("a move needs at least one axis, such as x=1.5 * mm")
    return stage_pb2.MoveRequest(device=device, relative=relative, validate_only=validate_only, targets=[
        common_pb2.AxisTarget(axis=axis, distance=distance(target), profile=profile(speed),
                              approach=None if approach is None else distance(approach))
        for axis, target in targets.items()])


def axis_move(device: str, axis: int, target: Distance, relative: bool, speed: Optional[Speed],
              approach: Optional[Distance]) -> stage_pb2.MoveRequest:
    """Returns a move of one axis without its context."""
    return move(device, {str(axis): target}, relative=relative, speed=speed, approach=approach)


def scan(device: str, axis: str, start: Distance, stop: Distance, every: Distance,
         fastest: Optional[Speed]) -> stage_pb2.ScanRequest:
    """Returns a scan without its context."""
    return stage_pb2.ScanRequest(device=device, axis=axis, start=distance(start), end=distance(stop),
                                 distance=distance(every), speed=None if fastest is None else speed(fastest))


def segment(axes: Sequence[str], point: Union[Arc, Iterable[object]], fastest: Optional[Speed]) -> stage_pb2.Segment:
    """Returns the piece of a path that leads to a point. Raises ValueError if the point has other axes."""
    at = None if fastest is None else speed(fastest)
    if isinstance(point, Arc):
        course = stage_pb2.ArcThroughPoint(point=_steps(axes, point.through), end=_steps(axes, point.end))
        return stage_pb2.Segment(arc=stage_pb2.Arc(through=course), speed=at)
    steps = _steps(axes, point)
    if len(steps) == 1:
        return stage_pb2.Segment(single=steps[0], speed=at)
    return stage_pb2.Segment(line=stage_pb2.Line(distances=steps), speed=at)


def _steps(axes: Sequence[str], point: Iterable[object]) -> List[common_pb2.AxisDistance]:
    distances = [distance(amount) for amount in ([point] if isinstance(point, Distance) else point)]
    if len(distances) != len(axes):
        raise ValueError(f"a point has {len(distances)} distances for {len(axes)} axes")
    return [common_pb2.AxisDistance(axis=axis, distance=amount) for axis, amount in zip(axes, distances)]


def path(device: str, context: common_pb2.CallContext, segments: Iterable[stage_pb2.Segment]) -> List[bytes]:
    """Returns the messages of a path: its header and its segments."""
    header = stage_pb2.PathHeader(context=context, device=device)
    return [stage_pb2.RunPathRequest(header=header).SerializeToString(),
            *(stage_pb2.RunPathRequest(segment=one).SerializeToString() for one in segments)]


def axis_jog(axis: str, at: Speed) -> stage_pb2.AxisJog:
    """Returns the jog of one axis. A negative speed is one in the minus direction."""
    if not isinstance(at, Speed):
        speed(at)
    direction = stage_pb2.AxisJog.DIRECTION_MINUS if at.value < 0 else stage_pb2.AxisJog.DIRECTION_PLUS
    return stage_pb2.AxisJog(axis=axis, direction=direction, speed=speed(abs(at)))


def jog(device: str, speeds: Mapping[str, Speed], lease_token: bytes) -> stage_pb2.JogRequest:
    """Returns the first message of a jog."""
    return stage_pb2.JogRequest(device=device, axes=[axis_jog(*one) for one in speeds.items()],
                                context=common_pb2.CallContext(lease_token=lease_token))


def stop(device: str, axes: Sequence[str], lease_token: bytes) -> stage_pb2.StopRequest:
    """Returns a stop of axes, or of all axes if there are none."""
    return stage_pb2.StopRequest(device=device, axes=axes, max_wait=duration(_STOP_S),
                                 context=common_pb2.CallContext(lease_token=lease_token))


def emergency_stop(device: str, lease_token: bytes) -> stage_pb2.EmergencyStopRequest:
    """Returns an emergency stop of all axes."""
    return stage_pb2.EmergencyStopRequest(device=device, max_wait=duration(_STOP_S),
                                          context=common_pb2.CallContext(lease_token=lease_token))


def acquire_lease(device: str, axes: Sequence[str], wait: float, ttl: float, at_loss: str,
                  purpose: str) -> control_pb2.AcquireLeaseRequest:
    """Returns the request for a lease, without its context. Raises ValueError if `at_loss` is unknown."""
    if at_loss not in _AT_LOSS:
        raise ValueError(f'at_loss is "{at_loss}"; allowed are {", ".join(_AT_LOSS)}')
    terms = control_pb2.LeaseTerms(axes=axes, time_to_live=duration(ttl), at_loss=_AT_LOSS[at_loss], purpose=purpose)
    return control_pb2.AcquireLeaseRequest(device=device, terms=terms, wait=duration(wait) if wait > 0 else None)
