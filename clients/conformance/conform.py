#!/usr/bin/python3
"""Runs the scenario with the runner of one package, and prints a line for each step.

usage: conform.py [--transport unix|loopback|tls] [--step N]... RUNNER [ARGUMENT]...

RUNNER is a program that translates one act of the scenario at a time into calls of its package (README.md).
Exits with 0 if every step is as the scenario says, with 1 if one is not, and with 2 if the command line is wrong.
"""

import argparse
import contextlib
import json
import pathlib
import sys
import time

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from newer import NewerDaemon  # noqa: E402
from runner import Runner  # noqa: E402
from world import World, meanwhile  # noqa: E402

ASIDE = {"say", "expect", "starts", "once_started", "at_most", "with_token", "at"}  # what the runner does not see
USUAL_LIMIT_S = 40
WORLD_ACTS = {"axisctl", "begin_lease", "end_lease", "delay", "cut", "cut_off", "restore", "limit", "limit_off", "plug",
              "unplug", "kill_and_start", "stop", "until_stationary", "pass"}


class Otherwise(Exception):
    """A step went otherwise than the scenario says."""


class Play:
    """One runner and its world."""

    def __init__(self, world, runner, newer):
        self._world = world
        self._runner = runner
        self._newer = newer

    def open(self, act):
        way_in = self._newer.way_in() if act.get("at") == "newer" else self._world.way_in()
        if act.get("with_token"):
            role = act["with_token"]
            way_in["token"] = "none-of-this-daemon" if role == "wrong" else self._world.new_token(role)
        return self._runner.say({"say": "open", **way_in})

    def act(self, act):
        if "world" in act:
            return self._do(act["world"], act)
        before, begun = self._world.starts(), time.monotonic()
        end = self._begin_meanwhile(act, before)
        try:
            said = {key: value for key, value in act.items() if key == "say" or key not in ASIDE}
            reply = self.open(act) if act["say"] == "open" else self._runner.say(said)
        finally:
            end()
        compare(act["expect"], reply)
        took_s, limit_s = time.monotonic() - begun, act.get("at_most", USUAL_LIMIT_S)
        if took_s > limit_s:
            raise Otherwise(f"it took {took_s:.1f} s, not at most {limit_s} s")
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


def play_step(play, step):
    """Returns what went otherwise, or None."""
    for number, act in enumerate(step["acts"], 1):
        try:
            play.act(act)
        except (Otherwise, AssertionError) as why:
            return f"act {number}, {act.get('say') or act['world']}: {why}"
    return None


def play_all(steps, transport, command):
    """Returns the number of steps that went otherwise. Prints each."""
    faults = 0
    with contextlib.ExitStack() as begun:
        world = World(transport)
        begun.callback(world.end)
        newer = begun.enter_context(NewerDaemon())
        runner = begun.enter_context(Runner(command))
        play = Play(world, runner, newer)
        play.open({})
        for step in steps:
            started = time.monotonic()
            why = play_step(play, step)
            faults += why is not None
            print(f"{transport} step {step['step']:2} {'FAILED' if why else 'ok'} {time.monotonic() - started:5.1f} s  "
                  f"{step['title']}{': ' + why if why else ''}", flush=True)
    return faults


def chosen(arguments):
    steps = json.loads((HERE / "scenario.json").read_text(encoding="utf-8"))
    if arguments.step:
        return [step for step in steps if step["step"] in arguments.step]
    return [step for step in steps if arguments.transport == "unix" or step.get("everywhere")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--transport", choices=("unix", "loopback", "tls"), default="unix")
    parser.add_argument("--step", type=int, action="append")
    parser.add_argument("runner", nargs="+")
    arguments = parser.parse_args()
    return 1 if play_all(chosen(arguments), arguments.transport, arguments.runner) else 0


if __name__ == "__main__":
    sys.exit(main())
