"""Translates the acts of the conformance scenario into calls of axisgate.aio, one JSON object on a line each way."""

import asyncio
import json
import sys
import time

import axisgate
from axisgate.aio import Stage
from axisgate.v1.motion_pb2 import MOTION_STATE_SUCCEEDED
from runner import PointError, amount, reply_to_error, shown, speed


class Acts:
    """One function for each verb of the scenario."""

    def __init__(self):
        self._stage = None
        self._motions = {}
        self._leases = {}
        self._events = None
        self._revisions = []

    async def open(self, act):
        if self._stage is not None:
            await self._stage.close()
        ways = {key: act[key] for key in ("target", "token", "ca", "certificate", "key") if key in act}
        self._stage = await Stage(**ways).connect()
        return {"outcome": "done"}

    async def whoami(self, _):
        return {"outcome": "done", "role": (await self._stage.whoami())[1]}

    async def axes(self, _):
        return {"outcome": "done", "axes": [[one.name, one.number] for one in self._stage.axes]}

    async def home(self, act):
        return shown(await self._stage.home(*act["axes"]))

    async def move_to(self, act):
        """Moves in a task of its own, which is cancelled if the act says so."""
        moving = asyncio.ensure_future(self._move(act))
        if "interrupt_after" in act:
            asyncio.get_running_loop().call_later(act["interrupt_after"], moving.cancel)
        return await moving

    async def _move(self, act):
        return shown(await self._stage[act["axis"]].move_to(amount(act["amount"]), speed=speed(act)))

    async def move_by(self, act):
        return shown(await self._stage[act["axis"]].move_by(amount(act["amount"])))

    async def start(self, act):
        self._motions[act["motion"]] = await self._stage[act["axis"]].start(amount(act["amount"]), speed=speed(act))
        return {"outcome": "started"}

    async def wait(self, act):
        return shown(await self._motions[act["motion"]].wait(act.get("timeout")))

    async def cancel(self, act):
        await self._motions[act["motion"]].cancel()
        return {"outcome": "done"}

    async def stop(self, _):
        return {"outcome": "done", "stays_open": (await self._stage.stop()).stays_open}

    async def rearm(self, _):
        await self._stage.rearm()
        return {"outcome": "done"}

    async def lease(self, act):
        self._leases[act["lease"]] = await self._stage.lease(*act["axes"], ttl=act["ttl"]).__aenter__()
        return {"outcome": "done"}

    async def lost(self, act):
        limit = time.monotonic() + act.get("within", 0)
        lease = self._leases[act["lease"]]
        while not lease.lost and time.monotonic() < limit:
            await asyncio.sleep(0.05)  # between two looks; the limit above decides
        return {"outcome": "done", "lost": lease.lost}

    async def release(self, act):
        await self._leases.pop(act["lease"]).__aexit__(None, None, None)
        return {"outcome": "done"}

    async def path(self, act):
        unit = getattr(axisgate, act["unit"])

        def points():
            for number in range(1, act["count"] + 1):
                if number > act.get("fails_after", act["count"]):
                    raise PointError
                yield [number * int(step) * unit for step in act["step"]]

        motion = await self._stage.path(points(), act["axes"], speed=speed(act))
        return shown(await motion.wait())

    async def scan(self, act):
        motion = await self._stage.scan(act["axis"], amount(act["from"]), amount(act["to"]), every=amount(act["every"]),
                                        speed=speed(act))
        scan = (await motion.wait()).scan
        return {"outcome": "done", "expected": scan.expected_in_range,
                "observed_equals_expected": scan.observed == scan.expected}

    async def events(self, _):
        self._events = await self._stage.events().__aenter__()
        return {"outcome": "done"}

    async def succeeded(self, act):
        """Reads events until so many motions have succeeded."""
        gaps = ended = 0
        while ended < act["count"]:
            event = await self._events.__anext__()
            if isinstance(event, axisgate.Gap):
                gaps += 1
                continue
            self._revisions.append(event.revision)
            ended += event.kind == "motion" and event.fact.state == MOTION_STATE_SUCCEEDED
        ascending = self._revisions == sorted(set(self._revisions))
        return {"outcome": "done", "ascending": ascending, "gaps": gaps}

    async def saturate(self, act):
        motion = self._motions[act["motion"]]
        for _ in range(act["calls"]):
            motion.add_done_callback(lambda _: None)
        return {"outcome": "done"}


async def reply_to(acts, act):
    try:
        return await getattr(acts, act["say"])(act)
    except asyncio.CancelledError:
        return {"outcome": "interrupted"}
    except Exception as error:
        return reply_to_error(error)


async def main():
    acts = Acts()
    lines = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(lines), sys.stdin)
    while line := await lines.readline():
        print(json.dumps(await reply_to(acts, json.loads(line))), flush=True)


if __name__ == "__main__":
    asyncio.run(main())
