"""Turns: many clients who want something else each, and a thousand watchers, on one paced line."""

import concurrent.futures

from beds import bed, measure
from figures import Limit, Row, Series, shown

BAUD = 38400
CLIENTS, WATCHERS = 200, 1000
# A command of its own for each: unlike questions, two are never one exchange.
COMMAND = "O:1"
# By polls of the daemon's own. Nothing of a client waits for them, so they show what the watchers cost.
SETTINGS = "idle_poll_ms = 100"
SHARES = 2  # nobody waits longer


def turns(plan):
    series = Series()
    with bed(plan.builds, baud=BAUD, settings=SETTINGS) as made:
        for _ in range(plan.repeat):
            for gateway in made.gateways:
                for watchers in (1, WATCHERS):
                    _round(plan, gateway, watchers, series)
    for build in plan.builds:
        yield from _rows(build.name, series)


def _round(plan, gateway, watchers, series):
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        seconds = plan.seconds(30)
        watching = pool.submit(measure, "streams", "--states", "--count", str(watchers), "--connections",
                               str(min(watchers, 20)), "--seconds", str(seconds + 4), *gateway.targets["Unix"])
        # Half of them by one name, half by another.
        measured = measure("execute", *gateway.targets["Unix"], *gateway.targets["TCP"], "--callers", str(CLIENTS),
                           "--question", COMMAND, "--seconds", str(seconds), look=gateway.exchanges)
        watching.result()
    (begun, before), (ended, after) = measured.before, measured.after
    share_us = CLIENTS / measured.figures["per_second"] * 1e6
    series.add(gateway.name, watchers, "longest", measured.figures["max"] / share_us)
    series.add(gateway.name, watchers, "share", share_us / 1e6)
    others = sum(after.values()) - sum(before.values()) - (after["O:"] - before["O:"])
    series.add(gateway.name, watchers, "others", others / (ended - begun))


def _rows(name, series):
    for watchers in (1, WATCHERS):
        absolute = f"a share is {shown(series.median(name, watchers, 'share'))} s"
        yield Row("turns", f"{CLIENTS} clients, {watchers:,} watchers: the longest wait, in shares", name,
                  series[name, watchers, "longest"], Limit(SHARES), absolute)
    yield Row("turns", f"exchanges a second of {WATCHERS:,} watchers beside those of one", name,
              [many / one for many, one in zip(series[name, WATCHERS, "others"], series[name, 1, "others"])],
              Limit(1.05), f"{shown(series.median(name, WATCHERS, 'others'))} a second")
