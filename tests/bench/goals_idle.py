"""G13: what the daemon needs while nobody asks anything, and what it has given back after a load."""

import time

import machine
from beds import bed, measure
from figures import Limit, Row, Series, shown

POLLED = "idle_poll_ms = 100"
WINDOW_S = 10  # the kernel counts hundredths of a second
SETTLED_S = 2
LOAD_S = 5


def idle(plan):
    series = Series()
    with bed(plan.builds, settings=POLLED) as made:
        time.sleep(SETTLED_S)
        for _ in range(plan.repeat):
            before = [gateway.sample() for gateway in made.gateways]
            time.sleep(WINDOW_S)
            for gateway, sample in zip(made.gateways, before):
                series.add(gateway.name, "cpu", 100 * machine.cost(sample, gateway.sample()).cores)
                series.add(gateway.name, "mib", gateway.sample().anonymous_kib / 1024)
        for gateway in made.gateways:
            for _ in range(2):
                measure("execute", *gateway.targets["Unix"], "--callers", "16", "--own-questions", "--seconds",
                        str(LOAD_S))
            series.add(gateway.name, "loaded", gateway.sample().anonymous_kib / 1024)
        after_s = plan.seconds(60)
        time.sleep(after_s)
        for gateway in made.gateways:
            series.add(gateway.name, "later", gateway.sample().anonymous_kib / 1024)
    for gateway in made.gateways:
        loaded = series.median(gateway.name, "loaded")
        yield Row("G13", "idle, polled at 10 Hz: CPU", gateway.name, series[gateway.name, "cpu"], Limit(0.5), unit="%")
        yield Row("G13", "idle: anonymous memory", gateway.name, series[gateway.name, "mib"], Limit(12), unit="MiB")
        yield Row("G13", f"anonymous memory {shown(after_s)} s after a load", gateway.name,
                  series[gateway.name, "later"], Limit(loaded), f"right after its second repetition {shown(loaded)}",
                  "MiB")
