#!/usr/bin/env python3
"""Every signal that the daemon can get, while one stage jogs and another one moves, and some while a mill executes a job;
with and without a controlling terminal. What moves afterwards is asked from the simulators."""

import contextlib
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

from mill_pty import CONFIG as MILL_CONFIG
from mill_pty import Gateway, PtyMill, commands, profile_text
from programs import BIN, LIMIT_S, Daemon, Lines
from serial_line import ask

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "jogged"
connection = "serial"
path = "FOLDER/jogged"
at_exit = "POLICY"

[[device]]
name = "moved"
connection = "serial"
path = "FOLDER/moved"
at_exit = "POLICY"
"""
STAGES = {"jogged": "jog", "moved": "move"}  # and what each does

ENDS, CRASHES, GOES_ON = "ended in order", "crashed and stopped at the next start", "ignored"
# Each signal with its name in the log, and what becomes of the daemon. SIGSTOP and SIGCONT have no row: nobody can refuse
# the first, and the second does nothing else.
SIGNALS = (
    (signal.SIGINT, "SIGINT", ENDS),
    (signal.SIGTERM, "SIGTERM", ENDS),
    (signal.SIGHUP, "SIGHUP", ENDS),
    (signal.SIGQUIT, "SIGQUIT", ENDS),
    (signal.SIGUSR1, "SIGUSR1", ENDS),
    (signal.SIGUSR2, "SIGUSR2", ENDS),
    (signal.SIGALRM, "SIGALRM", ENDS),
    (signal.SIGXCPU, "SIGXCPU", ENDS),
    (signal.SIGVTALRM, "SIGVTALRM", ENDS),
    (signal.SIGPROF, "SIGPROF", ENDS),
    (signal.SIGPOLL, "SIGPOLL", ENDS),
    (signal.SIGPWR, "SIGPWR", ENDS),
    (16, "SIGSTKFLT", ENDS),  # signal(7); Python has no name for it
    (signal.SIGRTMIN, "SIGRTMIN+0", ENDS),
    (signal.SIGRTMAX, "SIGRTMIN+30", ENDS),
    (signal.SIGKILL, "SIGKILL", CRASHES),
    (signal.SIGSEGV, "SIGSEGV", CRASHES),
    (signal.SIGABRT, "SIGABRT", CRASHES),
    (signal.SIGTSTP, "SIGTSTP", GOES_ON),
    (signal.SIGTTIN, "SIGTTIN", GOES_ON),
    (signal.SIGTTOU, "SIGTTOU", GOES_ON),
    (signal.SIGPIPE, "SIGPIPE", GOES_ON),
    (signal.SIGXFSZ, "SIGXFSZ", GOES_ON),
)
# On a terminal these are keys, and SIGHUP is its end. All others are sent by kill(2).
KEYS = {signal.SIGINT: b"\x03", signal.SIGQUIT: b"\x1c", signal.SIGTSTP: b"\x1a"}
# Hardly ever sent, and treated like SIGUSR1: to save time, not on a terminal.
RARE = ("SIGVTALRM", "SIGPROF", "SIGPOLL", "SIGPWR", "SIGSTKFLT", "SIGRTMIN+0", "SIGRTMIN+30")
# Moves with the tool up, 200 mm each: more than ten minutes.
MILL_JOB = "^IN;!MC0;!PZ-50,200;" + "PU8000,0;PU0,0;" * 50 + "H;\n"


def rows(expected):
    """Each such signal, without a terminal and with one."""
    return [(number, name, terminal) for number, name, what in SIGNALS if what == expected
            for terminal in (False, True) if not (terminal and name in RARE)]


def wait_until(condition, what):
    deadline = time.monotonic() + LIMIT_S
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(what)
        time.sleep(0.02)  # between two looks; the deadline above decides


class Run:
    """A daemon, on a terminal or without one, in a session of its own. `before` is what runs it, such as nohup;
    `variables` go to its environment."""

    def __init__(self, folder, config, terminal=False, before="", **variables):
        self._folder = folder
        self._config = config
        self._started = []
        self._terminal, far_end = os.openpty() if terminal else (None, os.open(os.devnull, os.O_RDONLY))
        job = pathlib.Path(__file__).with_name("terminal_job.py")
        try:
            self.daemon = self._start(f"/usr/bin/python3 {job}" if terminal else before, stdin=far_end, **variables)
        finally:
            os.close(far_end)
        self.pid = self._child() if terminal else self.daemon.pid

    def _start(self, before="", stdin=None, **variables):
        script = os.path.join(self._folder, "start")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\nexec {before} {BIN / "axisgated"} "$@"\n')
        os.chmod(script, 0o755)
        environment = {name: value for name, value in os.environ.items() if name not in ("NOTIFY_SOCKET", "INVOCATION_ID")}
        environment.update(variables, STATE_DIRECTORY=os.path.join(self._folder, "state"))
        return Daemon(self._folder, self._config, program=script, env=environment, stdin=stdin, start_new_session=True)

    def _child(self):
        with open(f"/proc/{self.daemon.pid}/task/{self.daemon.pid}/children", encoding="ascii") as file:
            return int(file.read())

    def end(self):
        for client in self._started:
            client.kill()
        self.daemon.stop()
        if self._terminal is not None:
            os.close(self._terminal)

    def start_motion(self, device, *arguments):
        motion = self.daemon.start("--device", device, *arguments)
        self._started.append(motion)
        motion.until("RUNNING")
        return motion

    def send(self, number):
        if self._terminal is None or number not in {*KEYS, signal.SIGHUP}:
            os.kill(self.pid, number)
        elif number in KEYS:
            os.write(self._terminal, KEYS[number])
        else:
            os.close(self._terminal)
            self._terminal = None

    def restart(self):
        self.daemon.stop()
        self.daemon = self._start()
        self.pid = self.daemon.pid

    def is_suspended(self):
        with open(f"/proc/{self.pid}/stat", encoding="ascii") as file:
            return file.read().rpartition(")")[2].split()[0] == "T"


class Bed:
    """Two stages, each a simulator of its own, and a daemon."""

    def __init__(self, policy="stop", **arguments):
        with contextlib.ExitStack() as ways_back:
            self.folder = ways_back.enter_context(tempfile.TemporaryDirectory(prefix="axisgate-signals-"))
            for stage in STAGES:
                simulator = Lines([BIN / "shrc203-sim", "--pty", self._tty(stage)])
                ways_back.callback(simulator.kill)
                simulator.until("simulator on")
            self.run = Run(self.folder, CONFIG.replace("FOLDER", self.folder).replace("POLICY", policy), **arguments)
            ways_back.callback(self.run.end)
            self._ways_back = ways_back.pop_all()

    def _tty(self, stage):
        return os.path.join(self.folder, stage)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._ways_back.close()

    def start_long_motions(self):
        for stage in STAGES:
            self.run.daemon.wait_for_log(f"{stage}: link is UP")
        self.run.start_motion("jogged", "jog", "1=+", "--speed", "200um/s")
        self.run.start_motion("moved", "move", "1=+9mm", "--relative", "--speed", "200um/s")

    def place(self, stage):
        """Of axis 1 in pulses, and whether it moves; the simulator's word, once the daemon has gone."""
        fields = ask(self._tty(stage), "Q:SP").split(",")
        return int(fields[0].replace("P", "")), fields[-3] == "B"


def stages_in_motion(log):
    """On a busy machine axisctl may fail to renew its jog in time; then it had ended before the signal."""
    return [stage for stage in STAGES if f"{stage}: stop of axis 1 asked by the gateway: the caller of the jog" not in log]


class Signals(unittest.TestCase):
    counts = {}
    moved_afterwards = 0  # pulses

    @classmethod
    def tearDownClass(cls):
        print(f"\nsignals in mid-motion: {cls.counts}; moved afterwards: {cls.moved_afterwards} pulses", flush=True)

    def assert_nothing_moves(self, bed):
        for stage in STAGES:
            first, second = bed.place(stage), bed.place(stage)
            type(self).moved_afterwards += second[0] - first[0]
            self.assertFalse(first[1], f"{stage} moves")
            self.assertEqual(first, second)
            self.assertLess(0, first[0])

    def assert_stopped(self, log, *stages):
        for stage in {*stages}.intersection(stages_in_motion(log)):
            self.assertIn(f"{stage}: the line is closed; motions that were running: 1 STOPPED", log)

    def count(self, expected):
        type(self).counts[expected] = self.counts.get(expected, 0) + 1

    def test_signals_that_end_the_daemon(self):
        for number, name, terminal in rows(ENDS):
            with self.subTest(name, terminal=terminal), Bed(terminal=terminal) as bed:
                bed.start_long_motions()
                bed.run.send(number)
                code = bed.run.daemon.exit_code()
                self.assert_nothing_moves(bed)
                self.assertEqual(code, 0)
                log = bed.run.daemon.log()
                self.assertIn(f"ending: {name}", log)
                self.assert_stopped(log, *STAGES)
                self.count(ENDS)

    def test_signals_of_a_crash(self):
        for number, name, terminal in rows(CRASHES):
            with self.subTest(name, terminal=terminal), Bed(terminal=terminal) as bed:
                bed.start_long_motions()
                bed.run.send(number)
                self.assertIn(bed.run.daemon.exit_code(), (-number, 128 + number))
                stages = stages_in_motion(bed.run.daemon.log())
                bed.run.restart()
                for stage in stages:
                    bed.run.daemon.wait_for_log(
                        rf"{stage}: the daemon ended during motion 1 \({STAGES[stage]}, [^\n]* stationary now")
                bed.run.send(signal.SIGTERM)
                self.assertEqual(bed.run.daemon.exit_code(), 0)
                self.assert_nothing_moves(bed)
                self.count(CRASHES)

    def test_signals_that_are_ignored(self):
        for terminal in (False, True):
            with self.subTest(terminal=terminal), Bed(terminal=terminal) as bed:
                self.go_on(bed, [number for number, _, what in SIGNALS if what == GOES_ON])
                bed.run.daemon.wait_for_log(r"SIGTSTP \(Ctrl-Z\) is ignored: [^\n]* press Ctrl-C or send SIGTERM")

    def test_sighup_of_a_service(self):
        for variable in ("NOTIFY_SOCKET", "INVOCATION_ID"):
            with self.subTest(variable), Bed(**{variable: "/nonexistent"}) as bed:
                self.go_on(bed, [signal.SIGHUP])
                bed.run.daemon.wait_for_log("SIGHUP is ignored: [^\n]*nothing to reload")

    def test_sighup_under_nohup(self):
        with Bed(before="nohup") as bed:
            self.go_on(bed, [signal.SIGHUP])
            self.assertNotIn("SIGHUP", bed.run.daemon.log())

    def go_on(self, bed, numbers):
        """Nothing becomes of the motions by these signals."""
        run = bed.run
        for stage in STAGES:
            run.daemon.wait_for_log(f"{stage}: link is UP")
        run.start_motion("jogged", "jog", "1=+", "--speed", "200um/s")
        move = run.start_motion("moved", "move", "1=0.1mm", "--speed", "200um/s")
        for number in numbers:
            run.send(number)
        self.assertEqual(move.end(), 0, move.errors)
        self.assertFalse(run.is_suspended())
        run.send(signal.SIGTERM)
        self.assertEqual(run.daemon.exit_code(), 0)
        self.assert_stopped(run.daemon.log(), "jogged")
        self.assert_nothing_moves(bed)
        self.assertEqual(bed.place("moved"), (10_000, False))
        type(self).counts[GOES_ON] = self.counts.get(GOES_ON, 0) + len(numbers)

    def test_second_signals(self):
        with Bed(policy="finish") as bed:
            move = bed.run.start_motion("moved", "move", "1=0.2mm", "--speed", "200um/s")
            self.send_all(bed, "ending: SIGHUP", "already ending: SIGHUP", "already ending: SIGXCPU")
            self.assertEqual(bed.run.daemon.exit_code(), 0)
            self.assertEqual(move.end(), 0, move.errors)
            self.assertEqual(bed.place("moved"), (20_000, False))
        for words in (("ending: SIGINT", "ending at once: SIGQUIT"),
                      ("ending: SIGHUP", "already ending: SIGTERM", "ending at once: SIGTERM")):
            with self.subTest(words), Bed(policy="finish") as bed:
                bed.run.start_motion("moved", "move", "1=9mm", "--speed", "200um/s")
                self.send_all(bed, *words)
                self.assertEqual(bed.run.daemon.exit_code(), 0)
                self.assertRegex(bed.run.daemon.log(), "ending at once: [^\n]* what moves may continue to move")
                self.assertTrue(bed.place("moved")[1], "it had been told to finish")

    def test_sighup_again_and_again(self):
        """As at the end of a terminal, whose shell and the kernel send it one after the other."""
        with Bed() as bed:
            bed.start_long_motions()
            ended = False
            while not ended:
                bed.run.send(signal.SIGHUP)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    ended = bed.run.daemon.wait(0.001) is not None
            self.assertEqual(bed.run.daemon.exit_code(), 0)
            self.assert_nothing_moves(bed)

    def send_all(self, bed, *words):
        """The signal of each, once the one before has been logged."""
        for words_of_one in words:
            bed.run.send(getattr(signal, words_of_one.rpartition(" ")[2]))
            bed.run.daemon.wait_for_log(words_of_one)

    @contextlib.contextmanager
    def job(self, terminal):
        """A daemon, and a mill that executes a job: (run, mill)."""
        with contextlib.ExitStack() as ways_back:
            folder = ways_back.enter_context(tempfile.TemporaryDirectory(prefix="axisgate-signals-mill-"))
            mill = PtyMill(pathlib.Path(folder), "mill", profile_text(), "none", "--speed", "4")
            ways_back.callback(mill.end)
            run = Run(folder, MILL_CONFIG + mill.table, terminal=terminal)
            ways_back.callback(run.end)
            gateway = Gateway(run.daemon, mill)
            wait_until(lambda: "line open" in gateway.axisctl("mill", "queue"), "the line does not open")
            gateway.start(MILL_JOB)
            mill.await_true(lambda entries: len(commands(entries)) > 5, "the job does not run")
            yield run, mill

    def assert_aborted(self, mill):
        mill.await_true(lambda entries: [entry["command"] for entry in commands(entries)][-3:] == ["!VZ", "!ZM", "!MC"],
                        "the job is not aborted")
        self.assertEqual(mill.person.await_state(moving="no")["buffered"], "0")

    def test_signals_during_a_mill_job(self):
        for number, name, terminal in rows(ENDS):
            with self.subTest(name, terminal=terminal), self.job(terminal) as (run, mill):
                run.send(number)
                self.assertEqual(run.daemon.exit_code(), 0)
                self.assertRegex(run.daemon.log(), rf"ending: {re.escape(name)}[^\n]*\n(?s:.*)mill: the line is closed")
                self.assert_aborted(mill)
                self.count(f"job: {ENDS}")

    def test_crashes_during_a_mill_job(self):
        for number, name, terminal in rows(CRASHES):
            with self.subTest(name, terminal=terminal), self.job(terminal) as (run, mill):
                run.send(number)
                self.assertIn(run.daemon.exit_code(), (-number, 128 + number))
                run.restart()
                self.assert_aborted(mill)
                self.count(f"job: {CRASHES}")

    def test_signals_that_a_mill_job_ignores(self):
        for terminal in (False, True):
            with self.subTest(terminal=terminal), self.job(terminal) as (run, mill):
                for number in [number for number, _, what in SIGNALS if what == GOES_ON]:
                    sent = len(commands(mill.read()))
                    run.send(number)
                    mill.await_true(lambda entries, sent=sent: len(commands(entries)) > sent, "the job does not go on")
                    self.count(f"job: {GOES_ON}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
