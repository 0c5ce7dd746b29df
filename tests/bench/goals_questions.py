"""G1 to G3: what a question costs by the daemon, beside what it costs without."""

import re
import shutil
import signal
import subprocess
import tempfile
import time

from beds import NotMeasured, bed, measure
from figures import Limit, Row, Series, ratios, shown

G1_BEYOND_MINIMAL = 0.05
QUESTIONS = ("Q:SPC", "?:D1")
# What is asked of the daemon, how, and the question that this is on the line.
KINDS = (("Execute Q:SPC", ("execute", "--question", "Q:SPC"), "Q:SPC"),
         ("Execute ?:D1", ("execute", "--question", "?:D1"), "?:D1"),
         ("GetDevice, max_age 0", ("get_device",), "Q:SPC"))
BARE = "GetCaller"


def instant(plan):
    """G1: on a line that takes no time."""
    with bed(plan.builds, minimal=True, certificates=True) as made:
        for transport in ("Unix", "TCP", "TLS"):
            series = Series()
            for _ in range(plan.repeat):
                _instant_round(plan, made, transport, series)
            for gateway in made.gateways:
                yield from _instant_rows(transport, gateway.name, series)


def _instant_round(plan, made, transport, series):
    lasting = ("--seconds", str(plan.seconds(0.7)))
    minimal = made.minimal.targets[transport]
    for question in QUESTIONS:
        direct = measure("direct", "--target", made.direct, "--question", question, *lasting)
        series.add("direct", question, direct.figures["p50"])
        series.add("minimal", question, measure("minimal", *minimal, "--question", question, *lasting).figures["p50"])
    series.add("hello", measure("hello", *minimal, *lasting).figures["p50"])
    for gateway in made.gateways:
        for what, words, _ in (*KINDS, (BARE, ("get_caller",), None)):
            measured = measure(*words, *gateway.targets[transport], *lasting, look=gateway.sample)
            count = measured.figures["count"]
            series.add(gateway.name, what, measured.figures["p50"])
            series.add(gateway.name, what, "cpu", 1e6 * measured.cost.cpu_s / count)
            series.add(gateway.name, what, "switches", measured.cost.switches / count)


def _instant_rows(transport, name, series):
    hello = series["hello",]
    for what, _, question in KINDS:
        direct, minimal = series["direct", question], series["minimal", question]
        minimal_ratios = Row("", "", "", ratios(minimal, direct, hello))
        beside = (f"beside {shown(series.median('direct', question))} direct + {shown(series.median('hello'))} hello; "
                  f"minimal {shown(series.median('minimal', question))}: {shown(minimal_ratios.figure)}")
        yield Row("G1", f"{what}, {transport}", name, ratios(series[name, what], direct, hello),
                  Limit(minimal_ratios.figure + G1_BEYOND_MINIMAL), f"{_cost(series, name, what)}; {beside}")
    yield Row("G1", f"{BARE} beside hello, {transport}", name, ratios(series[name, BARE], hello),
              absolute=_cost(series, name, BARE))


def _cost(series, name, what):
    return (f"{shown(series.median(name, what))} µs, CPU {shown(series.median(name, what, 'cpu'))} µs, "
            f"{shown(series.median(name, what, 'switches'))} switches a call")


def paced(plan):
    """G2: on a line that takes its time, one client."""
    for baud in (38400, 115200):
        series = Series()
        lasting = ("--question", "Q:SPC", "--seconds", str(plan.seconds(4)))
        with bed(plan.builds, baud=baud) as made:
            for _ in range(plan.repeat):
                direct = measure("direct", "--target", made.direct, *lasting).figures
                for gateway in made.gateways:
                    figures = measure("execute", *gateway.targets["Unix"], *lasting).figures
                    for part in ("p50", "p99"):
                        series.add(gateway.name, part, figures[part] / direct[part])
                        series.add(gateway.name, part, "absolute", figures[part])
                        series.add("direct", gateway.name, part, direct[part])
        for gateway in made.gateways:
            for part, limit in (("p50", 1.05), ("p99", 1.25)):
                absolute = (f"{shown(series.median(gateway.name, part, 'absolute'))} µs beside "
                            f"{shown(series.median('direct', gateway.name, part))} direct")
                yield Row("G2", f"{part} at {baud} baud", gateway.name, series[gateway.name, part], Limit(limit),
                          absolute, tail=part == "p99")


def many_callers(plan):
    """G3: how much of the line sixteen callers use, beside one program that asks one question after another."""
    yield from _use_of_line(plan, "38400 baud", 38400, 3, 0.99, ("Unix",))
    # Over both, because the daemon limits what one source may ask for a second.
    yield from _use_of_line(plan, "line not paced", 0, 2, 0.6, ("Unix", "TCP"))


def _use_of_line(plan, what, baud, seconds, limit, transports):
    series = Series()
    lasting = ("--own-questions", "--seconds", str(plan.seconds(seconds)))
    with bed(plan.builds, baud=baud) as made:
        for _ in range(plan.repeat):
            direct = measure("direct", "--target", made.direct, *lasting).figures["per_second"]
            for gateway in made.gateways:
                targets = [word for transport in transports for word in gateway.targets[transport]]
                per_second = measure("execute", *targets, "--callers", "16", *lasting).figures["per_second"]
                series.add(gateway.name, "ratio", per_second / direct)
                series.add(gateway.name, per_second)
                series.add("direct", gateway.name, direct)
    for gateway in made.gateways:
        absolute = (f"{shown(series.median(gateway.name))} a second beside "
                    f"{shown(series.median('direct', gateway.name))} direct")
        yield Row("G3", f"16 callers, {what}", gateway.name, series[gateway.name, "ratio"],
                  Limit(limit, at_least=True), absolute)


def costs(plan):
    """Which threads and which system calls an Execute takes."""
    with bed(plan.builds) as made:
        for gateway in made.gateways:
            words = ("execute", *gateway.targets["Unix"], "--seconds", str(plan.seconds(2)))
            shares = measure(*words, look=gateway.sample).cost.shares
            threads = ", ".join(f"{name} {share:.0%}" for name, share in shares.items() if share >= 0.01)
            yield Row("–", "threads of an Execute", gateway.name, [], absolute=threads)
            yield Row("–", "system calls of an Execute", gateway.name, [], absolute=_system_calls(gateway.pid, words))


def _system_calls(pid, words):
    if not shutil.which("strace"):
        return "not measured: strace is missing (Debian package strace)"
    with tempfile.NamedTemporaryFile("r", encoding="utf-8") as summary:
        tracer = subprocess.Popen(["strace", "-c", "-f", "-o", summary.name, "-p", str(pid)], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            time.sleep(0.5)  # it attaches to all threads
            if tracer.poll() is not None:
                return f"not measured: {tracer.stderr.read().strip()}"
            calls = measure(*words).figures["calls"]
        except NotMeasured as why:
            return f"not measured: {why}"
        finally:
            tracer.send_signal(signal.SIGINT)
            tracer.communicate()
        rows = re.findall(r"^\s*[\d.]+\s+[\d.]+\s+\d+\s+(\d+)\s+(?:\d+\s+)?([a-z]\w*)$", summary.read(), re.MULTILINE)
    counted = sorted(((int(count) / calls, name) for count, name in rows if name != "total"), reverse=True)
    return ", ".join(f"{name} {count:.1f}" for count, name in counted if count >= 0.1)
