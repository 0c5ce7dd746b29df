#!/usr/bin/env python3
"""Aborts at random moments, by the daemon, of mills behind pseudo-terminals: nothing of the job is written after the call,
what runs on is within the stated bound, the tool ends at the top and the spindle off.

Each combination of streaming, flow control, a mill 0, 30 and 50 % slower than its profile, and reading of ESC.K has a
mill of its own; all are in one daemon. VIEW is pressed before or after the abort, and released later.
AXISGATE_MILL_ABORTS=200 aborts each so often; the ordinary run does it once. AXISGATE_ABORT_SEED repeats a failure.

What a pseudo-terminal cannot show: RTS/CTS, since it has no modem lines. And it takes up to 20,480 bytes of which it says
that they have left the host (TIOCOUTQ is 0). With `full` streaming `converter` counts these, as TRANSPORTS.md has it.
They are behind XOFF, so an abort that ignores it, since VIEW holds the mill for longer than 200 ms, would let all of them
go at once, and overfill the buffer. So with `full` VIEW is released before the abort, or pressed when that has left, and an abort
that is held for so long all the same, as on a busy machine, is not judged.
Without flow control VIEW is held for so short a time that the buffer does not overflow; what happens else is in
tests/rml1/abort_guard_test.cc.
"""

import concurrent.futures
import dataclasses
import itertools
import os
import pathlib
import random
import re
import tempfile
import time
import unittest

from mill_pty import CONFIG, Gateway, PtyMill, commands, profile_text
from programs import Daemon

ABORTS = int(os.environ.get("AXISGATE_MILL_ABORTS", "1"))
SEED = int(os.environ.get("AXISGATE_ABORT_SEED", random.randrange(1_000_000)))
AT_ONCE = 6  # they mostly wait for their mills
BUFFER = 512
IN_TERMINAL = 20_480
PROLOGUE = ";^DF;"
LONGEST_ON_WAY_S = 0.19  # of an abort: after 200 ms it ignores XOFF
TOP = 1000  # steps above Z0
# Travel is so fast that the move from where the last job ended takes nearly no time (sending/README.md, "What no
# abort can ensure"). By its profile this mill needs a quarter longer for a cut than without acceleration: what a busy
# machine costs the simulator is within that.
PROFILE = profile_text(cutting_maximum=240, best=400, worst=400, spin_up_s=0.05)
SHORTEST_HELD_S, LONGEST_HELD_S, LONGEST_BEFORE_S = 0.001, 1.0, 0.4
VIEWS = {"paced": ("never", "before", "after", "released"), "full": ("never", "after", "released")}


@dataclasses.dataclass(frozen=True)
class Combination:
    streaming: str
    flow: str
    slower: int
    escape_k: str

    def __str__(self):
        return f"{self.streaming} | {self.flow} | {self.slower} % | {self.escape_k}"

    def mill(self, folder):
        paced = self.streaming == "paced"
        baud, converter = (9600, 0) if paced else (1_000_000, IN_TERMINAL)
        settings = f'baud = {baud}\nstreaming = "{self.streaming}"\nbuffer = {BUFFER}\nconverter = {converter}'
        name = re.sub(r"\W+", "-", str(self)).strip("-")
        return PtyMill(folder, name, PROFILE, self.flow, "--buffer", BUFFER, "--baud", baud, "--slower", self.slower,
                       "--option", f"escape_k={self.escape_k}", settings=settings)

    def job(self, chance):
        """Paced, a cut takes about 0.1 s, and some lists are longer than the least window. In full the job is longer than
        what buffer and terminal hold, and its cuts are of one step and so quick that the terminal, which takes bytes again
        when 4,096 have been read, takes the abort within 200 ms."""
        if self.streaming == "paced":
            return Job(chance, sets=100, reach=40, points=5, speeds=(8, 15))
        return Job(chance, sets=8000, reach=1, points=1500, speeds=(180, 240))

    def ahead(self):
        """More bytes than are sent ahead and executed while the abort is called, so that it comes while the job is sent."""
        return 600 if self.streaming == "paced" else 3 * IN_TERMINAL


COMBINATIONS = [Combination(streaming, flow, slower, escape_k)
                for streaming, flow in (("paced", "none"), ("paced", "xon"), ("full", "xon"))
                for slower, escape_k in itertools.product((0, 30, 50), ("toggle", "one-shot", "in-band"))]


class Job:
    """At least `sets` sets of numbers, lists of up to `points` of them. `sets` has what the record has of each, and where it
    ends in the job."""

    def __init__(self, chance, sets, reach, points, speeds):
        self.text, self.sets = "", []
        self._chance, self._place, self._reach = chance, (500, 500), reach
        self._add("PA", [[]])
        self._add("!PZ", [[-100, 300]])
        self._add("VS", [[speeds[0]]])
        while len(self.sets) < sets:
            kind = chance.random()
            if kind < 0.1:
                self._add("PU", [self._next()])
            elif kind < 0.2:
                self._add("Z", [self._next() + [chance.randint(-50, -1)]])
            elif kind < 0.3:
                self._add("VS", [[chance.randint(*speeds)]])
            else:
                self._add("PD", [self._next() for _ in range(chance.choice((1, 1, 2, points)))])
        self._add("PU", [[]])

    def _next(self):
        """Never the present place."""
        x, y = self._place
        self._place = (x + self._chance.choice((-1, 1)) * self._chance.randint(1, self._reach),
                       y + self._chance.randint(0, self._reach))
        return list(self._place)

    def _add(self, name, sets):
        self.text += name
        for numbers in sets:
            self.text += ",".join(map(str, numbers)) + ("," if numbers is not sets[-1] else ";")
            self.sets.append((name, numbers, len(self.text)))


@dataclasses.dataclass(frozen=True)
class Moment:
    after: int  # sets of the job that have begun
    pause_s: float
    view: str
    before_s: float
    after_s: float
    held_s: float

    @staticmethod
    def drawn(chance, job, combination):
        last = sum(end < len(job.text) - combination.ahead() for _, _, end in job.sets)
        return Moment(chance.randint(1, last), chance.uniform(0, 0.1), chance.choice(VIEWS[combination.streaming]),
                      chance.uniform(0, LONGEST_BEFORE_S), chance.uniform(0, LONGEST_BEFORE_S),
                      chance.uniform(SHORTEST_HELD_S, LONGEST_HELD_S))

    @property
    def held_before(self):
        return self.view in ("before", "released")


class Tally:
    def __init__(self):
        self.aborts = self.forgotten = 0
        self.most = {False: (0, 0), True: (0, 0)}  # what ran on, and the bound; with VIEW before: True

    def add(self, moment, ran_on, bound):
        self.aborts += 1
        most, bounds = self.most[moment.held_before]
        self.most[moment.held_before] = max(most, ran_on), max(bounds, bound)


class Aborted:
    """One abort, and what the mill's record has of it. `at`: the time of the abort in the record, at the latest."""

    def __init__(self, job, entries, at):
        self.job, self.entries, self.at = job, entries, at
        all_commands = commands(entries)
        if [entry["command"] for entry in all_commands[:1]] != ["DF"]:
            raise AssertionError(f"the prologue is {all_commands[:1]}")
        said = [(entry["command"], [float(number) for number in entry["numbers"]]) for entry in all_commands[1:]]
        self.begun = next((i for i, (one, (name, numbers, _)) in enumerate(zip(said, job.sets))
                           if one != (name, numbers)), min(len(said), len(job.sets)))
        self.words = [name for name, _ in said[self.begun:]]

    def end_of(self, sets):
        return self.job.sets[sets - 1][2] if sets > 0 else 0

    def executed(self, held):
        """How many sets were at the abort. That of which something was still to come was not."""
        begun, last = -1, 0.0  # the prologue; when the last movement or wait of the set had ended
        for entry in self.entries:
            if "command" in entry:
                if entry["t"] > self.at or begun == self.begun:
                    break
                begun, last = begun + 1, entry["t"]
            elif "path" in entry or "wait" in entry:
                last = max(last, entry["t"])
        return max(0, begun - 1 if held or last > self.at else begun)

    def discarded(self):
        return sum(entry.get("discarded", 0) for entry in self.entries)


class Aborts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-aborts-")
        self.addCleanup(folder.cleanup)
        folder = pathlib.Path(folder.name)
        self.mills = {}
        for combination in COMBINATIONS:
            mill = combination.mill(folder)
            self.addCleanup(mill.end)
            self.mills[combination] = mill
        self.daemon = Daemon(str(folder), CONFIG + "".join(mill.table for mill in self.mills.values()))
        self.addCleanup(self.daemon.stop)

    def logged(self, mill, what, number):
        """When the log had this line for that time, at the latest: it has milliseconds."""
        line = re.compile(rf"^(\S+ \S+)\.(\d+) info {mill.name}: .*{what}", re.MULTILINE)
        mill.await_true(lambda _: len(line.findall(self.daemon.log())) >= number, f"the log has no more '{what}'")
        day, part = line.findall(self.daemon.log())[number - 1]
        return time.mktime(time.strptime(day, "%Y-%m-%d %H:%M:%S")) + (int(part) + 1) / 1000

    def run_combination(self, combination):
        tally, mill = Tally(), self.mills[combination]
        mill.say(f"z0 -{TOP}")
        began = mill.began_at()
        for round_ in itertools.count():
            if tally.aborts == ABORTS:
                return tally
            chance = random.Random(f"{SEED} {combination} {round_}")
            job = combination.job(chance)
            moment = Moment.drawn(chance, job, combination)
            try:
                self.abort_once(combination, job, moment, began, tally, round_ + 1)
            except Exception as error:
                raise AssertionError(f"AXISGATE_ABORT_SEED={SEED} AXISGATE_MILL_ABORTS={round_ + 1}, {combination}, "
                                     f"{moment}: {error}") from error

    def abort_once(self, combination, job, moment, began, tally, number):
        mill = self.mills[combination]
        gateway, first = Gateway(self.daemon, mill), len(mill.read())
        gateway.start(job.text)
        mill.await_true(lambda entries: len(commands(entries[first:])) > moment.after, "the job does not run")
        time.sleep(moment.pause_s)  # the moment itself, as those below
        self.hold_before(mill, moment)
        answer = gateway.abort()
        self.assertIn("running", answer, "the job had ended")
        running = answer["running"]
        if combination.streaming == "full" and int(running["written"]) == len(job.text):
            return self.forget(mill, tally)
        asked = self.logged(mill, "requests: abort", number)
        if combination.streaming == "full" and self.logged(mill, "is ABORTED", number) - asked > LONGEST_ON_WAY_S:
            return self.forget(mill, tally)
        self.hold_after(mill, moment)
        mill.await_true(lambda entries: [entry["command"] for entry in commands(entries[first:])[-2:]] == ["!ZM", "!MC"],
                        "the words of the abort do not come")
        state = mill.person.await_state(moving="no", buffered="0", paused="no")
        aborted = Aborted(job, mill.read()[first:], asked - began)
        self.check_only_words(combination, aborted, int(running["written"]))
        self.assertEqual((state["z"], state["spindle"], state["errors"], state["discarding"]),
                         (str(TOP), "0", "none", "no"))
        if moment.view == "never":
            self.assertFalse([entry for entry in aborted.entries if entry.get("spindle") and entry["t"] > asked - began])
        ran_on = aborted.end_of(aborted.begun) - aborted.end_of(aborted.executed(moment.held_before))
        bound = int(running["run_on"]["if_held" if moment.held_before else "at_most"])
        tally.add(moment, ran_on, bound)
        self.assertLessEqual(ran_on, bound, "more ran on than was stated")
        self.check_executed(answer["executed"], aborted, moment)

    def forget(self, mill, tally):
        """An abort that has ignored XOFF: here that lets go what the terminal holds. Or one that came on a busy machine when
        all was written, with the epilogue."""
        tally.forgotten += 1
        self.assertLess(tally.forgotten, 10 + ABORTS / 2, "nearly every abort is held")
        mill.person.await_state(moving="no", buffered="0")
        mill.say("power off")
        mill.say("power on")

    def hold_before(self, mill, moment):
        if not moment.held_before:
            return
        mill.say("view")
        if moment.view == "released":
            held = min(moment.held_s, moment.before_s)
            time.sleep(held)
            mill.say("view")
            return time.sleep(moment.before_s - held)
        time.sleep(moment.before_s)

    def hold_after(self, mill, moment):
        if moment.view == "after":
            time.sleep(moment.after_s)
            mill.say("view")
        if moment.view in ("before", "after"):
            time.sleep(moment.held_s)
            mill.say("view")

    def check_only_words(self, combination, aborted, written):
        """`written`: bytes of the job by the time of the call. Where ESC.K waits its turn, the mill executes just these."""
        self.assertIn(aborted.words, (["PA", "!VZ", "!ZM", "!MC"], ["!MC", "PA", "!VZ", "!ZM", "!MC"]))
        begun = aborted.end_of(aborted.begun)
        if combination.escape_k == "in-band":
            self.assertEqual(begun, written)
        else:
            self.assertLessEqual(begun + aborted.discarded(), written)

    def check_executed(self, said, aborted, moment):
        """The places, by the mill's profile: with VIEW the mill has executed less."""
        least, most = (int(said[end].get("byte", 0)) for end in ("least", "most"))
        if not moment.held_before:
            self.assertLessEqual(least, aborted.end_of(aborted.executed(False)), "it says more than was executed")
        self.assertGreaterEqual(most, aborted.end_of(aborted.begun), "it says less than was begun")

    def test_nothing_is_written_the_bound_is_true_and_the_tool_is_up(self):
        with concurrent.futures.ThreadPoolExecutor(max_workers=AT_ONCE) as pool:
            results = [(one, pool.submit(self.run_combination, one)) for one in COMBINATIONS]
        for combination, result in results:
            with self.subTest(str(combination)):
                tally = result.result()
                (ran_on, bound), (ran_on_held, bound_held) = tally.most[False], tally.most[True]
                print(f"| {combination} | {tally.aborts} | {ran_on} of {bound} | {ran_on_held} of {bound_held} |"
                      + f" {tally.forgotten} forgotten" * (tally.forgotten > 0))


if __name__ == "__main__":
    unittest.main()
