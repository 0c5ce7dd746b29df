"""Client of Axisgate, the gateway for stage controllers and mills.

::

    from axisgate import Refused, Stage, mm

    with Stage() as stage:
        try:
            print(stage["x"].move_to(1.5 * mm))
        except Refused as e:
            print(e.reason, e.hint)

`Refused` means that nothing moved. Other errors are `Stopped`, `MotionFailed` and `OutcomeUnknown`. Amounts have units:
``1.5 * mm``, ``200 * um / s``. All objects can be used by several threads.
"""

from axisgate.axis import Axis
from axisgate.commands import Executed
from axisgate.device import Device
from axisgate.errors import (AxisgateError, LeaseHeld, LeaseLost, MotionFailed, NotAllowed, NotHomed, OutcomeUnknown,
                             OutsideTravel, Refused, Stopped, StoppedBy, Unavailable)
from axisgate.events import Event, Events, Gap
from axisgate.jog import Jog
from axisgate.lease import Lease
from axisgate.mill import Mill, MillStates
from axisgate.motion import Motion
from axisgate.places import Places
from axisgate._record import Progress
from axisgate.points import Arc, raster
from axisgate.results import AxisStop, Position, Result, Scan, StopReport
from axisgate.samples import Samples, States
from axisgate.settings import Settings
from axisgate.stage import Stage
from axisgate.state import AxisState, Status
from axisgate._version import VERSION
from axisgate.units import Distance, Distances, Speed, SpeedUnit, Unit, deg, mm, nm, pulses, s, um

__version__ = VERSION

__all__ = [
    "Arc", "Axis", "AxisState", "AxisStop", "AxisgateError", "Device", "Distance", "Distances", "Event", "Events",
    "Executed", "Gap", "Jog", "Lease", "LeaseHeld", "LeaseLost", "Mill", "MillStates", "Motion", "MotionFailed",
    "NotAllowed", "NotHomed", "OutcomeUnknown", "OutsideTravel", "Places", "Position", "Progress", "Refused",
    "Result", "Samples", "Scan", "Settings", "Speed", "SpeedUnit", "Stage", "States", "Status", "StopReport",
    "Stopped", "StoppedBy", "Unavailable", "Unit", "deg", "mm", "nm", "pulses", "raster", "s", "um",
]
