import type { Capability, Device } from "./gen/axisgate/v1/device_pb.js";
import { shortName } from "./names.js";

/** Returns the names of the devices with the capability. */
export function namesAmong(devices: readonly Device[], capability: Capability): string[] {
  return devices.filter((one) => one.capabilities.includes(capability)).map((device) => shortName(device.name));
}

/** Returns the device with the name, or the only device with the capability. Throws RangeError. */
export function chooseDevice(devices: readonly Device[], name: string | undefined, capability: Capability): Device {
  const able = devices.filter((one) => one.capabilities.includes(capability));
  const [found, second] = name === undefined ? able : able.filter((one) => shortName(one.name) === shortName(name));
  if (found !== undefined && second === undefined) return found;
  const names = devices.map((device) => shortName(device.name)).join(", ");
  if (found !== undefined)
    throw new RangeError(`the daemon has several such devices; choose one with device: ${names}`);
  const wanted = name === undefined ? "a device for this" : `a device ${name} for this`;
  throw new RangeError(`the daemon does not have ${wanted}; its devices: ${names}`);
}
