"""Plays the steps of the scenario with one runner, and compares its replies with what the scenario expects."""

import contextlib
import json
import pathlib
import threading
import time

from mutations import UNKNOWN_REASON
from proxy import Proxy
from runner import Runner
from world import World

HERE = pathlib.Path(__file__).resolve().parent
ASIDE = {"say", "expect", "starts", "once_started", "at_most", "with_token", "at"}  # what the runner does not see
USUAL_LIMIT_S = 40
WORLD_ACTS = {"axisctl", "begin_lease", "end_lease", "delay", "cut", "cut_off", "restore", "limit", "limit_off", "plug",
              "unplug", "kill_and_start", "forget_and_start", "stop", "until_stationary", "pass"}


class Otherwise(Exception):
    """A step went otherwise than the scenario says."""


class Play:
    """One runner and its world."""

    def __init__(self, world, runner, newer):
        self._world = world
        self._runner = runner
        self._newer = newer

    def begin(self):
        """Starts the runner if it has not been started, or has ended, and opens its Stage."""
        if not self._runner.runs:
            self._runner.start()
            self.open({})

    def open(self, act):
        way_in = {"target": f"unix:{self._newer.socket}"} if act.get("at") == "newer" else self._world.way_in()
        if act.get("with_token"):
            role = act["with_token"]
            way_in["token"] = "none-of-this-daemon" if role == "wrong" else self._world.new_token(role)
        return self._runner.say({"say": "open", **way_in}, USUAL_LIMIT_S)

    def act(self, act):
        if "world" in act:
            return self._do(act["world"], act)
        before = self._world.starts()
        end = self._begin_meanwhile(act, before)
        try:
            said = {key: value for key, value in act.items() if key == "say" or key not in ASIDE}
            limit_s = act.get("at_most", USUAL_LIMIT_S)
            reply = self.open(act) if act["say"] == "open" else self._runner.say(said, limit_s)
        finally:
            end()
        compare(act["expect"], reply)
        seen = self._world.starts() - before
        if "starts" in act and seen != act["starts"]:
            raise Otherwise(f"the controller was sent {seen} starts of motion, not {act['starts']}")

    def _begin_meanwhile(self, act, before):
        if "once_started" not in act:
            return lambda: None

        def once_started():
            self._world.until_started(before)
            self._do(act["once_started"], act)

        return meanwhile(once_started)

    def _do(self, name, act):
        if name not in WORLD_ACTS:
            raise Otherwise(f"the world has no act {name}")
        if name == "axisctl":
            self._world.axisctl(*act["words"])
        elif name == "pass":
            time.sleep(act["seconds"])  # the lapse of time is the act
        else:
            getattr(self._world, name)()


def meanwhile(act):
    """Does `act` in another thread. Returns a function that waits for its end, and raises what it raised."""
    raised = []

    def run():
        try:
            act()
        except BaseException as error:  # noqa: B902 - it is raised again below
            raised.append(error)

    thread = threading.Thread(target=run)
    thread.start()

    def end():
        thread.join()
        if raised:
            raise raised[0]

    return end


def compare(expected, reply):
    """Raises Otherwise unless the reply has all that is expected; `has_hint` and `message_has` are about its texts."""
    for key, wanted in expected.items():
        if key == "has_hint":
            seen = bool(reply.get("hint"))
        elif key == "message_has":
            seen = wanted if wanted in reply.get("message", "") else reply.get("message")
        elif key == "positions":
            seen = {name: reply.get("positions", {}).get(name) for name in wanted}
        else:
            seen = reply.get(key)
        if seen != wanted:
            raise Otherwise(f"{key} is {json.dumps(seen)}, not {json.dumps(wanted)}, in {json.dumps(reply)}")


def read_scenario():
    """Returns the steps of the scenario."""
    return json.loads((HERE / "scenario.json").read_text(encoding="utf-8"))


def play_step(play, step):
    """Returns the first act that differs from the scenario, and its difference. None: the step has no difference."""
    for number, act in enumerate(step["acts"], 1):
        try:
            play.act(act)
        except (Otherwise, AssertionError) as why:
            return f"act {number}, {act.get('say') or act['world']}", str(why)
    return None


def play_steps(steps, transport, command, through=None):
    """Yields each step, its difference as play_step() returns it, and its duration in seconds.

    `through` returns a proxy in front of a daemon's socket. None: the client reaches the daemon without a proxy.
    """
    with contextlib.ExitStack() as begun:
        world = World(transport, through)
        begun.callback(world.end)
        newer = begun.enter_context(Proxy(world.daemon.socket, UNKNOWN_REASON))
        play = Play(world, begun.enter_context(Runner(command)), newer)
        for step in steps:
            play.begin()
            started = time.monotonic()
            difference = play_step(play, step)
            yield step, difference, time.monotonic() - started
