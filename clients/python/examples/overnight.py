"""A long scan that survives broken connections, a restarted daemon, and its own restart.

overnight.csv has one line for each point that was measured. A point without a line is measured next, so that no point
is left out, and none is measured twice. A stop by a person ends the program.
"""

import csv
import os
import time

from axisgate import LeaseHeld, LeaseLost, OutcomeUnknown, Stage, Unavailable, mm

FILE = "overnight.csv"
POINTS = [(column * 0.1, row * 0.1) for row in range(5) for column in range(6)]  # in mm


def measure():
    """Stands for the reading of your detector."""
    return time.time()


def points_done():
    if not os.path.exists(FILE):
        return 0
    with open(FILE, newline="", encoding="utf-8") as file:
        return sum(1 for row in csv.reader(file) if len(row) == 3)


def wait_until_still(stage):
    """Returns once no axis moves and no stop is being repeated, for instance after an unknown outcome."""
    while True:
        status = stage.status(max_age=0)
        if status.link == "UP" and not status.message.open_stops and not any(
                axis.moving for axis in status.axes.values()):
            return
        time.sleep(0.5)


def scan(stage, points):
    with stage.lease("x", "y", wait=60, purpose="overnight scan"), \
            open(FILE, "a", newline="", encoding="utf-8") as file:
        for x, y in points:
            stage.move_to(x=x * mm, y=y * mm)  # a target, not a step: it may be repeated
            csv.writer(file).writerow([f"{x:.1f}", f"{y:.1f}", measure()])
            file.flush()


while points_done() < len(POINTS):
    try:
        with Stage() as stage:
            wait_until_still(stage)
            scan(stage, POINTS[points_done():])
    except (LeaseHeld, LeaseLost, OutcomeUnknown, Unavailable) as error:
        print(f"{points_done()} of {len(POINTS)} points are done; interrupted by {error}", flush=True)
        time.sleep(1)
print(f"all {len(POINTS)} points are done")
