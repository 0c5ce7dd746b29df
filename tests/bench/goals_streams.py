"""G6 and G7: many streams, and many callers who want the same."""

from beds import bed, measure
from figures import Limit, Row, Series, shown

STREAMS = 1000
EVENTS_PER_SECOND = 50
EVENTS_OF_A_MOVE = 4
BAUD = 38400  # so that the events of a move are apart
BEYOND_BARE = 1.25
# So that few seconds have many polls of the daemon's own, or none.
POLLED, QUIET = "idle_poll_ms = 100", "idle_poll_ms = 60000"
SHARED_S = 4
ONE_MORE_OR_LESS = 1.05  # exchange, of the forty in this time


def events(plan):
    """G6: a thousand streams of events, beside a bare server that writes as much."""
    series = Series()
    for _ in range(plan.repeat):
        # Servers of their own each time, whose memory has not grown yet.
        with bed(plan.builds, baud=BAUD, minimal=True, events_per_second=EVENTS_PER_SECOND) as made:
            _round(plan, made.minimal, (), series)
            for gateway in made.gateways:
                _round(plan, gateway, ("--moves", str(EVENTS_PER_SECOND / EVENTS_OF_A_MOVE)), series)
    for build in plan.builds:
        yield from _rows(build.name, series)


def _round(plan, served, moves, series):
    idle = served.sample()
    measured = measure("streams", *served.targets["Unix"], *served.targets["TCP"], "--count", str(STREAMS),
                       "--seconds", str(plan.seconds(8)), *moves, look=served.sample)
    figures = measured.figures
    for part, value in (("p99", figures["p99"] / 1000), ("p50", figures["p50"] / 1000), ("lost", figures["lost"]),
                        ("cores", measured.cost.cores), ("messages", figures["messages_per_second"]),
                        ("kib", (measured.before.anonymous_kib - idle.anonymous_kib) / STREAMS)):
        series.add(served.name, part, value)


def _rows(name, series):
    messages = series.median(name, "messages")
    bare = series.median("minimal", "cores") * messages / series.median("minimal", "messages")
    what = f"{STREAMS:,} streams of events"
    yield Row("G6", f"{what}: lost", name, series[name, "lost"], Limit(0),
              f"{shown(messages / STREAMS)} events a second")
    yield Row("G6", f"{what}: p99", name, series[name, "p99"], Limit(10),
              f"p50 {shown(series.median(name, 'p50'))} ms; bare server {shown(series.median('minimal', 'p99'))} and "
              f"{shown(series.median('minimal', 'p50'))}", "ms", tail=True)
    yield Row("G6", f"{what}: CPU", name, series[name, "cores"], Limit(max(0.5, bare * BEYOND_BARE)),
              f"bare server, for as many messages: {shown(bare)}", "cores")
    yield Row("G6", f"{what}: memory a stream", name, series[name, "kib"], Limit(20),
              f"bare server {shown(series.median('minimal', 'kib'))}", "KiB")


def shared(plan):
    """G7: what many cost the wire who want the same, beside what one costs it."""
    yield from _shared(plan, f"WatchDevice, {STREAMS:,} streams", POLLED,
                       ("streams", "--states", "--connections", "1", "--count", "1"),
                       ("streams", "--states", "--count", str(STREAMS)))
    # With pauses, or a hundred callers would ask the processor for more than it has.
    yield from _shared(plan, "GetDevice, max_age 100 ms, 100 callers", QUIET,
                       ("get_device", "--max-age", "100", "--pause", "1"),
                       ("get_device", "--max-age", "100", "--callers", "100", "--pause", "50"))


def _shared(plan, what, settings, *one_and_many):
    series = Series()
    with bed(plan.builds, settings=settings) as made:
        for _ in range(plan.repeat):
            for gateway in made.gateways:
                one, many = (_exchanges_per_second(gateway, *words) for words in one_and_many)
                series.add(gateway.name, "ratio", many / one)
                series.add(gateway.name, "one", one)
                series.add(gateway.name, "many", many)
    for gateway in made.gateways:
        absolute = (f"{shown(series.median(gateway.name, 'many'))} exchanges a second beside "
                    f"{shown(series.median(gateway.name, 'one'))} for one")
        yield Row("G7", what, gateway.name, series[gateway.name, "ratio"], Limit(ONE_MORE_OR_LESS), absolute)


def _exchanges_per_second(gateway, *words):
    kind, *rest = words
    measured = measure(kind, *gateway.targets["Unix"], *rest, "--seconds", str(SHARED_S), look=gateway.exchanges)
    (begun, before), (ended, after) = measured.before, measured.after
    return (sum(after.values()) - sum(before.values())) / (ended - begun)
