"""The choice of a device among those of a daemon."""

from __future__ import annotations

from typing import List, Optional

from axisgate.v1 import device_pb2


def resource(device: str) -> str:
    """Returns "devices/stage" for "stage"."""
    return device if device.startswith("devices/") else f"devices/{device}"


def choose(listed: device_pb2.ListDevicesResponse, device: Optional[str], capability: int) -> device_pb2.Device:
    """Returns the device with the name, or the only device with the capability. Raises LookupError."""
    able: List[device_pb2.Device] = [one for one in listed.devices if capability in one.capabilities]
    if device is not None:
        able = [one for one in able if one.name == resource(device)]
    if len(able) == 1:
        return able[0]
    names = ", ".join(one.name[len("devices/"):] for one in listed.devices)
    if able:
        raise LookupError(f"the daemon has several such devices; choose one with device=: {names}")
    wanted = "a device for this" if device is None else f"a device {device} for this"
    raise LookupError(f"the daemon does not have {wanted}; its devices: {names}")
