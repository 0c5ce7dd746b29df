"""Moves an axis, shows its progress, and says why if it does not arrive."""

import sys

from axisgate import AxisgateError, Refused, Stage, mm, s

with Stage() as stage:
    try:
        motion = stage["x"].start(2 * mm, speed=1 * mm / s)
        for progress in motion.progress():
            print(f"{progress.fraction or 0:4.0%}  {progress.positions['x']}")
        result = motion.wait()
        print(f"arrived: {result} in {result.duration:.1f} s")
    except Refused as error:
        sys.exit(f"nothing moved: {error}")
    except AxisgateError as error:
        sys.exit(f"the move ended otherwise: {error}; now at {stage['x'].position}")
