"""mill: what a stage and a mill of one daemon cost each other."""

import contextlib
import pathlib
import tempfile
import time

from beds import bed, measure
from figures import Limit, Row, Series, ratios, shown
from mill_jobs_test import quick_profile
from mill_pty import Gateway, PtyMill, commands

QUESTION = ("--question", "?:D1")
# Each of 0.25 mm, which takes about as long as its bytes on the line: the daemon writes again and again. Some minutes.
JOB = "!MC0;PA;" + "PU100,100;PU110,100;" * 10_000
WINDOW_S = 4
MILL_BAUD = 9600
SETTLED = 100  # commands, after which the window is full


def beside_a_mill(plan):
    """A question to the stage while a job runs and while none does, and the job's pace with questions and without."""
    for what, baud in (("38400 baud", 38400), ("line not paced", 0)):
        for build in plan.builds:
            series = Series()
            with _mill() as mill, bed([build], baud=baud, settings=mill.table) as made:
                gateway = made.gateways[0]
                at_mill = Gateway(gateway.daemon, mill)
                for _ in range(plan.repeat):
                    _pair(plan, gateway, at_mill, series)
            yield from _rows(f"stage at {what}" if baud else f"stage, {what}", build.name, series)


@contextlib.contextmanager
def _mill():
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="axisgate-bench-mill-")))
        mill = PtyMill(folder, "mill", quick_profile(), "none", "--baud", MILL_BAUD, settings=f"baud = {MILL_BAUD}")
        stack.callback(mill.end)
        yield mill


def _pair(plan, gateway, at_mill, series):
    words = ("execute", *gateway.targets["Unix"], *QUESTION, "--seconds", str(plan.seconds(WINDOW_S)))
    series.add("alone", measure(*words).figures["p99"])
    before = len(commands(at_mill.mill.read()))
    at_mill.start(JOB)
    at_mill.mill.await_true(lambda entries: len(commands(entries)) > before + SETTLED, "the job does not run")
    series.add("pace", _pace(at_mill.mill, lambda: time.sleep(plan.seconds(WINDOW_S))))
    series.add("pace", "asked",
               _pace(at_mill.mill, lambda: series.add("with job", measure(*words).figures["p99"])))
    at_mill.abort()
    at_mill.mill.await_true(lambda entries: [entry["command"] for entry in commands(entries)[-2:]] == ["!ZM", "!MC"],
                            "the job does not end")


def _pace(mill, meanwhile):
    """Commands a second that the mill begins, by its own clock."""
    begun = commands(mill.read())
    meanwhile()
    ended = commands(mill.read())
    return (len(ended) - len(begun)) / (ended[-1]["t"] - begun[-1]["t"])


def _rows(stage, name, series):
    absolute = f"{shown(series.median('with job'))} µs beside {shown(series.median('alone'))}"
    yield Row("mill", f"p99 of a question while a job runs, beside none; {stage}", name,
              ratios(series["with job",], series["alone",]), Limit(1.25), absolute, tail=True)
    absolute = f"{shown(series.median('pace', 'asked'))} commands a second beside {shown(series.median('pace'))}"
    yield Row("mill", f"pace of a job while questions are asked, beside none; {stage}", name,
              ratios(series["pace", "asked"], series["pace",]), Limit(0.99, at_least=True), absolute)
