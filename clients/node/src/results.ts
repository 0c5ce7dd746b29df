import { inspect } from "node:util";

import { create } from "@bufbuild/protobuf";
import { timestampMs } from "@bufbuild/protobuf/wkt";

import { type AxisgateError, type ErrorClass, MotionFailed, OutcomeUnknown, Stopped } from "./errors.js";
import { type Problem, ProblemSchema, Unit as UnitNumber } from "./gen/axisgate/v1/common_pb.js";
import { type Motion, MotionState } from "./gen/axisgate/v1/motion_pb.js";
import type { AxisStop as AxisStopMessage, StopResponse } from "./gen/axisgate/v1/stage_pb.js";
import { axisName } from "./names.js";
import { errorOfProblem } from "./outcomes.js";

const UNITS: ReadonlyMap<UnitNumber, string> = new Map([
  [UnitNumber.PULSES, "pulses"],
  [UnitNumber.NANOMETERS, "nm"],
  [UnitNumber.MICROMETERS, "um"],
  [UnitNumber.MILLIMETERS, "mm"],
  [UnitNumber.DEGREES, "deg"],
]);
const ERRORS: ReadonlyMap<MotionState, ErrorClass> = new Map<MotionState, ErrorClass>([
  [MotionState.STOPPED, Stopped],
  [MotionState.FAILED, MotionFailed],
  [MotionState.UNKNOWN, OutcomeUnknown],
]);

/** An object that console.log() shows as its text. */
export abstract class Shown {
  abstract toString(): string;

  [inspect.custom](): string {
    return this.toString();
  }
}

/** Position of one axis. */
export class Position extends Shown {
  /**
   * `axis` is the name of the axis. `value` is an exact decimal in `unit`, which Number() makes a number. `value` or
   * `pulses` is undefined if unknown.
   */
  constructor(
    readonly axis: string,
    readonly value: string | undefined,
    readonly unit: string,
    readonly pulses: bigint | undefined,
  ) {
    super();
  }

  override toString(): string {
    return `${this.axis} ${this.value === undefined ? "unknown" : `${this.value} ${this.unit}`}`;
  }
}

/** Positions by the names of the axes, in the order of their numbers. An axis without a name has its number: "1". */
export type Positions = ReadonlyMap<string, Position>;

/** Trigger pulses of a scan. Undefined: unknown. */
export interface Scan {
  /** Number of pulses due in the whole run. */
  readonly expected: bigint | undefined;
  /** Number of pulses due within the range. */
  readonly expectedInRange: bigint | undefined;
  /** Number of pulses computed from the displacement. */
  readonly observed: bigint | undefined;
}

/** Result of a motion that succeeded. */
export class Result extends Shown {
  /** `motion` is the name of the motion. `scan` is undefined unless the motion was a scan. */
  constructor(
    readonly motion: string,
    readonly positions: Positions,
    readonly durationMs: number,
    readonly scan?: Scan | undefined,
  ) {
    super();
  }

  override toString(): string {
    return [...this.positions.values()].join(", ");
  }
}

/** Result of a stop for one axis. */
export class AxisStop extends Shown {
  /** `stationary` is undefined if it was not seen after the stop. */
  constructor(
    readonly position: Position,
    readonly stationary: boolean | undefined,
  ) {
    super();
  }

  override toString(): string {
    const seen = this.stationary ? "stationary" : "still moving";
    return `${this.position.toString()} (${this.stationary === undefined ? "not seen stationary" : seen})`;
  }
}

/** What was seen of a stop. */
export class StopReport extends Shown {
  /**
   * `staysOpen` means that the axes were not confirmed stationary: the daemon repeats the stop, and refuses motion of
   * these axes. `problem` is undefined, or says why.
   */
  constructor(
    readonly axes: readonly AxisStop[],
    readonly staysOpen: boolean,
    readonly problem: AxisgateError | undefined,
  ) {
    super();
  }

  override toString(): string {
    const seen = this.axes.join(", ") + (this.staysOpen ? "; the stop stays open" : "");
    return this.problem === undefined ? seen : `${seen}: ${this.problem.toString()}`;
  }
}

/** Returns the symbol of a unit, or "UNIT 9" for the number of a newer daemon. */
export function unitOf(number: UnitNumber): string {
  return UNITS.get(number) ?? `UNIT ${String(number)}`;
}

/** Returns the position that a message of the API has. */
export function positionOf(
  at: { name: string; unit: UnitNumber; position: string },
  number: number,
  pulses: bigint | undefined,
): Position {
  return new Position(axisName(at, number), at.position || undefined, unitOf(at.unit), pulses);
}

/** Returns positions by the names of their axes. */
export function byAxis(positions: readonly Position[]): Positions {
  return new Map(positions.map((position) => [position.axis, position]));
}

/** Reports whether the motion has its outcome. */
export function isOver(motion: Motion): boolean {
  return motion.endTime !== undefined;
}

/** Returns the result of a motion that is over. Throws Stopped, MotionFailed or OutcomeUnknown unless it succeeded. */
export function outcomeOf(motion: Motion): Result {
  if (motion.state !== MotionState.SUCCEEDED) {
    throw errorOfProblem(motion.problem ?? create(ProblemSchema), "", ERRORS.get(motion.state) ?? MotionFailed);
  }
  const began = motion.startTime ?? motion.createTime;
  const durationMs = began && motion.endTime ? timestampMs(motion.endTime) - timestampMs(began) : 0;
  const positions = motion.results.map((one) => positionOf(one, one.axis, one.commandPulses));
  return new Result(motion.name, byAxis(positions), durationMs, scanOf(motion));
}

function scanOf({ scan }: Motion): Scan | undefined {
  return (
    scan && {
      expected: scan.expectedTriggers,
      expectedInRange: scan.expectedTriggersInRange,
      observed: scan.observedTriggers,
    }
  );
}

/** Returns the report of the answer to a stop of one device. */
export function reportOf(answer: Pick<StopResponse, "devices" | "staysOpen">): StopReport {
  const problem: Problem | undefined = answer.devices.find((device) => device.problem)?.problem;
  const axes = answer.devices.flatMap((device) => device.axes).map(axisStopOf);
  return new StopReport(axes, answer.staysOpen, problem && errorOfProblem(problem));
}

function axisStopOf(stop: AxisStopMessage): AxisStop {
  return new AxisStop(positionOf(stop, stop.axis, stop.positionPulses), stop.ready);
}
