#!/usr/bin/env python3
"""Compares calls through the package with the same messages through generated stubs.

The daemon is at AXISGATE_TARGET, an address of gRPC without TLS. Moves the first axis of its only stage by single
pulses, and prints the medians in microseconds:

    PYTHONPATH=src ../conformance/example.py ./bench.py
    {"get_device": {"package_us": 390, "bare_us": 370}, "move": {"package_us": 14600, "bare_us": 14800}}
"""

import json
import os
import statistics
import time
import uuid

import grpc

from axisgate import Stage, pulses
from axisgate.v1 import common_pb2, device_pb2, device_pb2_grpc, stage_pb2, stage_pb2_grpc

READINGS = 300
MOVES = 60
WARM_UP = 20
TIMEOUT_S = 10.0


class Bare:
    """The calls of a program without the package."""

    def __init__(self, target, device, axis):
        channel = grpc.insecure_channel(target)
        self._devices = device_pb2_grpc.DeviceServiceStub(channel)
        self._stages = stage_pb2_grpc.StageServiceStub(channel)
        self._metadata = (("axisgate-session", str(uuid.uuid4())),)
        self._device = device
        self._axis = axis

    def _send(self, call, request, timeout=TIMEOUT_S):
        return call(request, timeout=timeout, metadata=self._metadata)

    def get_device(self):
        return self._send(self._devices.GetDevice, device_pb2.GetDeviceRequest(device=self._device))

    def move(self, step):
        listed = self._send(self._devices.ListDevices, device_pb2.ListDevicesRequest())
        context = common_pb2.CallContext(request_id=str(uuid.uuid4()), request_memory=listed.request_memory)
        context.not_after.FromNanoseconds(int((time.time() + TIMEOUT_S / 2) * 1e9))
        target = common_pb2.AxisTarget(axis=self._axis, distance=common_pb2.Distance(pulses=step))
        request = stage_pb2.MoveRequest(context=context, device=self._device, relative=True, targets=[target])
        motion = self._send(self._stages.Move, request).motion
        while not motion.HasField("end_time"):
            wait = stage_pb2.WaitMotionRequest(motion=motion.name)
            wait.max_wait.FromSeconds(10)
            motion = self._send(self._stages.WaitMotion, wait, timeout=15).motion
        return motion


def medians(package, bare, count):
    """Returns the medians of two calls in microseconds. They alternate, so that both see the same load.

    The argument of a call is 1 and -1 in turn.
    """
    times = {"package_us": [], "bare_us": []}
    calls = (("package_us", package), ("bare_us", bare))
    for number in range(WARM_UP + count):
        for name, call in calls if number % 2 else reversed(calls):
            begun = time.perf_counter_ns()
            call(-1 if number % 2 else 1)
            if number >= WARM_UP:
                times[name].append((time.perf_counter_ns() - begun) / 1000)
    return {name: round(statistics.median(values)) for name, values in times.items()}


def main():
    with Stage() as stage:
        axis = stage.axes[0]
        bare = Bare(os.environ["AXISGATE_TARGET"], f"devices/{stage.name}", str(axis.number))
        print(json.dumps({
            "get_device": medians(lambda _: stage.status(), lambda _: bare.get_device(), READINGS),
            "move": medians(lambda step: axis.move_by(step * pulses), bare.move, MOVES),
        }))


if __name__ == "__main__":
    main()
