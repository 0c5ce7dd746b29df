"""G5, and G10 to G12: stops under load, paths, wrong replies, and moves."""

import os
import re
import subprocess
import sys

import beds
from beds import NotMeasured, bed, measure
from figures import Limit, Row, Series, shown

BAUD = 38400
# The simulator is READY so long after its completion (device/shrc203/simulator/README.md).
SETTLING_US = 5000
COMPLETION_BYTES = len("1\r\n")
OUTCOME_BEYOND_EXCHANGE_US = 8000
QUIET = "idle_poll_ms = 60000"  # so that the exchanges are those of the moves
FULL_S = 45_100  # pulses that take a second with the simulator's speeds
SHORT_UM = 10
PULSES_PER_UM = 100


def stops(plan):
    """G5: the first byte of a stop while others wait, and while others are refused."""
    loads = (("990 commands wait", "?:O", 990), ("1,000 refused calls in a loop", "G:1", 1000))
    series = Series()
    for _ in range(plan.repeat):
        for what, line, calls in loads:
            # A daemon of its own each time: what waits would still wait in the next repetition.
            with bed(plan.builds, baud=BAUD) as made:
                cycle = measure("direct", "--target", made.direct, "--question", "?:O").figures["p50"]
                for gateway in made.gateways:
                    _stops_of(plan, gateway, (what, line, calls), cycle, series)
    for what, _, _ in loads:
        for build in plan.builds:
            absolute = (f"{shown(series.median(build.name, what, 'p99') / 1000)} ms p99, "
                        f"{shown(series.median(build.name, what, 'p50') / 1000)} p50 beside two cycles of "
                        f"{shown(series.median(build.name, what, 'cycles') / 1000)}; answered after "
                        f"{shown(series.median(build.name, what, 'answered') / 1000)} p99; "
                        f"{shown(series.median(build.name, what, 'waiting'))} waited, the others ended "
                        f"{shown(series.median(build.name, what, 'others'))} a second"
                        f"{series[build.name, what, 'refusal'][0]}")
            yield Row("G5", f"Stop, {what}: first byte, p99", build.name, series[build.name, what], Limit(1.15),
                      absolute, tail=True)


def _stops_of(plan, gateway, load, cycle, series):
    what, line, calls = load
    measured = measure("stop_under_load", *gateway.targets["Unix"], "--line", line, "--calls", str(calls), "--stops",
                       str(plan.count(60)), look=lambda: gateway.metric("axisgate_queue_depth", "lane"))
    figures = measured.figures
    if not figures["count"]:
        raise NotMeasured("no stop is in the recording")
    series.add(gateway.name, what, figures["p99"] / (2 * cycle))
    refusal = f", {figures['refused']:,} of them refused: {figures['first_refusal']}" if figures["refused"] else ""
    for part, value in (("p99", figures["p99"]), ("p50", figures["p50"]), ("cycles", 2 * cycle), ("refusal", refusal),
                        ("answered", figures["answered"]["p99"]), ("waiting", sum(measured.before.values())),
                        ("others", figures["others_per_second"])):
        series.add(gateway.name, what, part, value)


def paths(plan):
    """G10: what tests/paced-path.sh proves, shorter. The turnaround itself is not measured here."""
    segments = plan.count(200)
    for build in plan.builds:
        environment = dict(os.environ, AXISGATE_SEGMENTS=str(segments), AXISGATE_BIN=str(build.folder),
                           PYTHONDONTWRITEBYTECODE="1")
        ended = subprocess.run(
            [sys.executable, "-m", "unittest", "paced_path_test.PacedPath.test_no_underrun_while_all_ask"],
            cwd=beds.HERE.parent / "integration", env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, check=False)
        path = re.search(r"path: (\w+), segments (\d+), .*underruns (\d+)", ended.stdout)
        what = f"underruns in {segments} segments of 60 ms while 32 clients ask"
        if path:
            yield Row("G10", what, build.name, [int(path[3])], Limit(0), f"{path[1]}, {path[2]} segments")
        else:
            yield Row("G10", what, build.name, [], absolute="not measured: " + ended.stdout.strip()[-200:])


def wrong_replies(plan):
    """G11: two pollers and one mover, through the daemon and over one raw port."""
    count = plan.count(20_000)
    series = Series()
    with bed(plan.builds) as made:
        for _ in range(plan.repeat):
            for gateway in made.gateways:
                figures = measure("wrong_replies", *gateway.targets["Unix"], "--count", str(count)).figures
                series.add(gateway.name, figures)
            _sharer_round(plan, series)
    for gateway in made.gateways:
        yield _wrong_row(gateway.name, series[gateway.name,], Limit(0))
    if series["ser2net",]:
        yield _wrong_row("ser2net", series["ser2net",], None)
    else:
        yield Row("G11", "wrong replies", "ser2net", [], absolute=f"not measured: {series['why',][0]}")


def _sharer_round(plan, series):
    try:
        with beds.serial_sharer() as address:
            words = ("wrong_replies", "--target", address, "--raw", "--count", str(plan.count(1000)))
            series.add("ser2net", measure(*words).figures)
    except NotMeasured as why:
        series.add("why", str(why))


def _wrong_row(name, rounds, limit):
    replies, wrong = sum(one["count"] for one in rounds), sum(one["wrong"] for one in rounds)
    first = next((one["first"] for one in rounds if one["first"]), "")
    absolute = f"{wrong:,} of {replies:,}" + (f"; the first: {first}" if first else "")
    return Row("G11", "wrong replies", name, [100 * wrong / replies], limit, absolute, "%")


def moves(plan):
    """G12: how many exchanges a move takes, and how soon its outcome is known."""
    kinds = ((f"a move of {SHORT_UM} µm", SHORT_UM * PULSES_PER_UM, plan.count(20)), ("a move of 1 s", FULL_S, 2))
    series = Series()
    with bed(plan.builds, baud=BAUD, settings=QUIET) as made:
        for _ in range(plan.repeat):
            series.add("exchange", measure("direct", "--target", made.direct).figures["p50"])
            for gateway in made.gateways:
                # What is read before the first motion is read once.
                measure("moves", *gateway.targets["Unix"], "--pulses", "1", "--count", "1")
                for what, pulses, count in kinds:
                    _moves_of(gateway, what, pulses, count, series)
    for gateway in made.gateways:
        for what, _, _ in kinds:
            yield from _move_rows(gateway.name, what, series)


def _moves_of(gateway, what, pulses, count, series):
    before = gateway.exchanges_by_now()
    measured = measure("moves", *gateway.targets["Unix"], "--pulses", str(pulses), "--count", str(count))
    after = gateway.exchanges_by_now()
    by_command = {name: (after[name] - before[name]) / count for name in after if after[name] != before[name]}
    # ?:CMD is asked behind each pause of the line, also the one before the measurement: whether the controller has
    # restarted. It is shown, not counted.
    series.add(gateway.name, what, "exchanges", sum(by_command.values()) - by_command.get("?:CMD", 0))
    series.add(gateway.name, what, "commands", by_command)
    # The completion has its time when its last byte has been received.
    completion_us = COMPLETION_BYTES * 10 * 1e6 / BAUD
    series.add(gateway.name, what, "after_ready", measured.figures["p50"] + completion_us - SETTLING_US)
    series.add(gateway.name, what, "started", measured.figures["started"]["p50"])


def _move_rows(name, what, series):
    commands = ", ".join(f"{command} {shown(each)}" for command, each in series[name, what, "commands"][-1].items())
    yield Row("G12", f"exchanges of {what}", name, series[name, what, "exchanges"], Limit(3), commands)
    exchange = series.median("exchange")
    absolute = (f"one exchange of {shown(exchange / 1000)} ms + {OUTCOME_BEYOND_EXCHANGE_US // 1000}; the call that "
                f"starts it: {shown(series.median(name, what, 'started') / 1000)} ms")
    yield Row("G12", f"outcome of {what} known after READY", name,
              [each / 1000 for each in series[name, what, "after_ready"]],
              Limit((exchange + OUTCOME_BEYOND_EXCHANGE_US) / 1000), absolute, "ms")
