"""Runs a circle of two arcs at constant speed, and measures how far the recorded positions are from it."""

import math

from axisgate import Arc, Stage, mm, s

RADIUS = 0.5

right, top, left, bottom = [(x * mm, y * mm) for x, y in ((RADIUS, 0), (0, RADIUS), (-RADIUS, 0), (0, -RADIUS))]

with Stage() as stage, stage.lease(purpose="circle"):
    stage.move_to(x=right[0], y=right[1])
    with stage.sample() as samples:
        motion = stage.path([Arc(top, left), Arc(bottom, right)], "xy", speed=0.5 * mm / s)
        with motion:  # Ctrl-C stops the circle
            result = motion.wait()

x, y = samples.axes.index("x"), samples.axes.index("y")
errors = [math.hypot(row[x], row[y]) - RADIUS for row in samples.positions]
samples.to_csv("circle.csv")
print(f"back at {result} after {result.duration:.1f} s")
print(f"{len(samples)} positions, at most {1000 * max(map(abs, errors)):.2f} um from the circle")
