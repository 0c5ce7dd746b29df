"""The rows, and how a client is run in one of them. What a client does is in README.md."""

import collections
import contextlib
import dataclasses
import os
import subprocess
import sys
import threading

from gateway import HERE, running

LIMIT_S = 120
# In each row the breaker does this wrong (breaker.py).
FAULTS = {
    "unary-front": "loses an answer",
    "unary-grpc": "loses an answer",
    "watch": "loses an event",
    "execute": "loses a reply",
    "send-job": "loses a part",
    "jog": "ends early",
    "keep-lease": "ends early",
    "gzip": "no gzip",
    "deadline": "ends watches",
    "cancel": "hears no cancel",
    "keepalive": "few pings",
    "metadata": "little metadata",
    "many": "refuses some",
    "restart": "loses the next event",
    "end-in-call": "acts twice",
}
IPV6 = ("unary-front", "unary-grpc")


@dataclasses.dataclass
class Cell:
    """What became of one row with one client."""

    calls: int = 0
    notes: list = dataclasses.field(default_factory=list)
    fault: str = ""  # empty: all was as it should be


@contextlib.contextmanager
def broken(fault, address):
    """The address of a breaker before the daemon at `address`."""
    breaker = subprocess.Popen(["/usr/bin/python3", HERE / "breaker.py", fault, address], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    try:
        yield breaker.stdout.readline().strip()
    finally:
        breaker.communicate()


def jobs_at_fault(gateway, sent, failed):
    """A job whose sender was told so is there once, any other at most once."""
    there = collections.Counter(gateway.titles())
    lost = [title for title in sent if there[title] != 1]
    twice = [title for title in failed if there[title] > 1]
    return f"sent and not there once: {lost}; failed and there twice: {twice}" if lost or twice else ""


def run_client(command, row, gateway, target, environment):
    client = subprocess.Popen([command, row, target], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, env=dict(os.environ, **environment))
    killer = threading.Timer(LIMIT_S, client.kill)
    killer.start()
    cell, sent, failed = Cell(), [], []
    for line in client.stdout:
        word, _, rest = line.strip().partition(" ")
        if word == "ready":
            gateway.restart()
        elif word == "calls":
            cell.calls = int(rest)
        elif word == "note":
            cell.notes.append(rest)
        elif word == "sent":
            sent.append(rest)
        elif word == "failed":
            failed.append(rest.split()[0])
    errors = client.stderr.read().strip()
    code = client.wait()
    killer.cancel()
    if code != 0:
        cell.fault = errors.splitlines()[-1] if errors else f"exit {code}"
    elif row == "end-in-call":
        cell.fault = jobs_at_fault(gateway, sent, failed) if len(sent) >= 10 else f"only {len(sent)} jobs were taken"
    elif cell.calls == 0:
        cell.fault = "it made no calls"
    return cell


def run_row(command, row, host="127.0.0.1", fault="", environment=None):
    """With a fault: with a breaker before the daemon."""
    with running(host) as gateway:
        if not fault:
            return run_client(command, row, gateway, gateway.address, environment or {})
        with broken(fault, gateway.address) as target:
            return run_client(command, row, gateway, target, environment or {})


if __name__ == "__main__":
    # For one cell: rows.py CLIENT ROW [FAULT]
    print(run_row(*sys.argv[1:3], fault="".join(sys.argv[3:4])))
