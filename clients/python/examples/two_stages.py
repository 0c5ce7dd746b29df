"""Moves two stages at the same time, one of which follows the other one."""

import contextlib

from axisgate import Stage, mm

names = Stage.find()
print(f"stages: {', '.join(names)}")

with contextlib.ExitStack() as block:
    first, second = [block.enter_context(Stage(device=name)) for name in names[:2]]
    for stage in (first, second):
        block.enter_context(stage.lease(purpose="two stages"))

    for position in (0.5, 1.0):
        motions = [first.start(x=position * mm), second.start(x=-position * mm)]
        for motion in motions:
            block.enter_context(motion)  # an error of one cancels both
        print(" | ".join(f"{motion.name.split('/')[1]}: {motion.wait()}" for motion in motions))
