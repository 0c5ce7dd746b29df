"""The asyncio form of the package, with the same names and meanings.

::

    from axisgate import mm
    from axisgate.aio import Stage

    async with Stage() as stage:
        print(await stage["x"].move_to(1.5 * mm))

The differences: functions that ask the daemon are awaited, and so are the properties that do, as in
``await stage["x"].position``. A cancelled task cancels the motion of `move_to`, `move_by` and `home`, as Ctrl-C does in
the blocking form. A Stage and its objects belong to one event loop, and are not thread safe. Errors, results, units and
the objects that do not send are those of `axisgate`.
"""

from axisgate.aio.axis import Axis
from axisgate.aio.events import Events, States
from axisgate.aio.jog import Jog
from axisgate.aio.lease import Lease
from axisgate.aio.motion import Motion
from axisgate.aio.stage import Stage

__all__ = ["Axis", "Events", "Jog", "Lease", "Motion", "Stage", "States"]
