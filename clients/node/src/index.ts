/**
 * Client of Axisgate, the gateway for stage controllers and mills.
 *
 * `Refused` means that nothing moved. Other errors are `Stopped`, `MotionFailed` and `OutcomeUnknown`. Amounts have
 * units: `mm("1.5")`, `um(200).perSecond`.
 */
export { Axis } from "./axis.js";
export type { Executed, ExecuteOptions } from "./commands.js";
export { type ConnectOptions, Device, type FindOptions } from "./device.js";
export {
  AxisgateError,
  LeaseHeld,
  LeaseLost,
  MotionFailed,
  NotAllowed,
  NotHomed,
  OutcomeUnknown,
  OutsideTravel,
  Refused,
  Stopped,
  StoppedBy,
  Unavailable,
} from "./errors.js";
export { Event, type EventOptions, Events, Gap } from "./events.js";
export { Jog } from "./jog.js";
export { Lease, type LeaseOptions } from "./lease.js";
export type { JobOptions } from "./job.js";
export type { Logger } from "./log.js";
export { Mill, MillStates, type Step } from "./mill.js";
export { Motion, type Progress } from "./motion.js";
export type { PathOptions, Points } from "./path.js";
export { Places } from "./places.js";
export type { MoveOptions, Point } from "./requests.js";
export { AxisStop, Position, type Positions, Result, type Scan, StopReport } from "./results.js";
export type { WaitOptions } from "./session.js";
export { type AxisChange, Settings } from "./settings.js";
export { type HomeOptions, type ScanOptions, Stage, type Targets } from "./stage.js";
export { type AxisState, Status } from "./state.js";
export { States, type WatchOptions } from "./states.js";
export { type Amount, deg, Distance, mm, nm, pulses, Speed, um, type Unit } from "./units.js";
