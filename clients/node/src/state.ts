import { type Distance as DistanceMessage, Mode } from "./gen/axisgate/v1/common_pb.js";
import { type Axis, Condition, type Device, LinkState } from "./gen/axisgate/v1/device_pb.js";
import { axisName, nameOf, shortName } from "./names.js";
import { type Position, positionOf, Shown, unitOf } from "./results.js";
import { Distance } from "./units.js";

/** State of one axis. Undefined means unknown; a limit that is undefined does not exist. */
export interface AxisState {
  readonly number: number;
  readonly name: string;
  readonly unit: string;
  readonly position: Position;
  readonly moving: boolean | undefined;
  readonly motorOn: boolean | undefined;
  readonly homed: boolean;
  readonly minimum: Distance | undefined;
  readonly maximum: Distance | undefined;
  /** Names of conditions, such as "CW_LIMIT". */
  readonly conditions: readonly string[];
}

/** State of a device. */
export class Status extends Shown {
  /**
   * `link` is "UP" if the controller answers, and `linkProblem` says why not. `message` is the whole state, as the API's
   * message `Device`.
   */
  constructor(
    readonly device: string,
    readonly link: string,
    readonly linkProblem: string,
    readonly mode: string,
    readonly axes: ReadonlyMap<string, AxisState>,
    readonly message: Device,
  ) {
    super();
  }

  override toString(): string {
    const positions = [...this.axes.values()].map((axis) => axis.position.toString());
    return `${this.device} ${this.link}: ${this.linkProblem || positions.join(", ")}`;
  }
}

/** Returns the state of a device. Axes that the controller does not allow to be moved are left out. */
export function statusOf(device: Device): Status {
  const axes = device.axes.filter((axis) => axis.controllable).map(axisState);
  return new Status(
    shortName(device.name),
    nameOf(LinkState, device.link, "LINK_STATE"),
    device.linkProblem,
    nameOf(Mode, device.mode, "MODE"),
    new Map(axes.map((axis) => [axis.name, axis])),
    device,
  );
}

function axisState(axis: Axis): AxisState {
  return {
    number: axis.number,
    name: axisName(axis, axis.number),
    unit: unitOf(axis.unit),
    position: positionOf(axis, axis.number, axis.positionPulses),
    moving: axis.busy,
    motorOn: axis.excited,
    homed: axis.homed,
    minimum: limitOf(axis.travelMinimum),
    maximum: limitOf(axis.travelMaximum),
    conditions: axis.conditions.map((one) => nameOf(Condition, one, "CONDITION")),
  };
}

function limitOf(limit: DistanceMessage | undefined): Distance | undefined {
  const amount = limit?.amount;
  if (amount?.case === undefined || amount.case === "floating") return undefined;
  return new Distance(amount.value, amount.case === "degrees" ? "deg" : amount.case);
}
