"""Scans a line: the controller gives a trigger pulse every 10 um, and the program saves where they were due.

A counter at the trigger output has one value for each line of line.csv. The positions are nominal.
"""

import sys

from axisgate import Stage, mm, s, um

with Stage() as stage, stage.lease(purpose="line scan"):  # a scan needs all axes of the stage
    result = stage.scan("x", 0 * mm, 1 * mm, every=10 * um, speed=0.5 * mm / s).wait()

result.to_csv("line.csv")
scan = result.scan
print(f"{scan.expected} pulses, {scan.expected_in_range} of them from 0 to 1 mm")
if scan.observed != scan.expected:
    sys.exit(f"the displacement says {scan.observed} pulses: do not trust the positions")
