import { randomUUID } from "node:crypto";
import { inspect } from "node:util";

import { create } from "@bufbuild/protobuf";
import { type Duration, durationFromMs, durationMs, timestampFromMs, timestampMs } from "@bufbuild/protobuf/wkt";

import * as common from "./gen/axisgate/v1/common_pb.js";
import type { Device } from "./gen/axisgate/v1/device_pb.js";
import * as stage from "./gen/axisgate/v1/stage_pb.js";
import { type Amount, Distance, Speed, type Unit } from "./units.js";

const UNITS: Readonly<Record<Unit, common.Unit>> = {
  nm: common.Unit.NANOMETERS,
  um: common.Unit.MICROMETERS,
  mm: common.Unit.MILLIMETERS,
  deg: common.Unit.DEGREES,
  pulses: common.Unit.PULSES,
};

/** Returns the message of a Distance. Throws TypeError for anything else. */
export function distance(amount: Distance): common.Distance {
  if (!(amount instanceof Distance)) {
    throw new TypeError(`${inspect(amount)} is not a distance: write an amount with its unit, such as mm("1.5")`);
  }
  return create(common.DistanceSchema, { amount: distanceAmount(amount) });
}

function distanceAmount({ value, unit }: Distance): common.Distance["amount"] {
  if (typeof value === "number") return { case: "floating", value: floating(value, unit) };
  if (unit === "pulses") return { case: "pulses", value: whole(value) };
  return { case: unit === "deg" ? "degrees" : unit, value: String(value) };
}

/** Returns the message of a Distance, or undefined if there is none. */
export function optionalDistance(amount: Distance | undefined): common.Distance | undefined {
  return amount === undefined ? undefined : distance(amount);
}

/** Returns the message of a Speed. Throws TypeError for anything else. */
export function speed(amount: Speed): common.Speed {
  if (!(amount instanceof Speed)) {
    throw new TypeError(`${inspect(amount)} is not a speed: write a distance in each second, such as mm(2).perSecond`);
  }
  return create(common.SpeedSchema, { amount: speedAmount(amount.distance) });
}

/** Returns the message of a Speed, or undefined if there is none. */
export function optionalSpeed(amount: Speed | undefined): common.Speed | undefined {
  return amount === undefined ? undefined : speed(amount);
}

function speedAmount({ value, unit }: Distance): common.Speed["amount"] {
  if (typeof value === "number") return { case: "floating", value: floating(value, unit) };
  if (unit === "pulses") return { case: "pulsesPerS", value: whole(value) };
  return { case: unit === "deg" ? "degreesPerS" : `${unit}PerS`, value: String(value) };
}

function floating(value: number, unit: Unit): common.FloatingAmount {
  return create(common.FloatingAmountSchema, { value, unit: UNITS[unit], rounding: common.Rounding.NEAREST });
}

function whole(value: Amount): bigint {
  if (typeof value === "string" && !/^[+-]?\d+$/.test(value)) {
    throw new RangeError(`${value} is not a whole number of pulses`);
  }
  return BigInt(typeof value === "string" ? value.replace("+", "") : value);
}

/** Returns the message of a time span. */
export function duration(ms: number): Duration {
  return durationFromMs(Math.round(ms));
}

/** Terms of a request that is sent for the first time now. */
export interface ContextTerms {
  readonly memory: string;
  readonly leaseToken: Uint8Array;
  /** Difference of the daemon's clock to the clock of this machine. */
  readonly clockAheadMs: number;
  /** Time after which the request no longer counts. */
  readonly patienceMs: number;
}

/** Returns the context of a request, with an id of its own. */
export function newContext(terms: ContextTerms): common.CallContext {
  return create(common.CallContextSchema, {
    requestId: randomUUID(),
    leaseToken: terms.leaseToken,
    requestMemory: terms.memory,
    notAfter: timestampFromMs(Math.floor(Date.now() + terms.clockAheadMs + terms.patienceMs)),
  });
}

/**
 * Returns by how many milliseconds the daemon's clock is ahead of this machine's, just after the devices were listed. 0
 * if nothing was read from any device yet.
 */
export function clockAhead(devices: readonly Device[]): number {
  for (const { readTime, age } of devices) {
    if (readTime !== undefined && age !== undefined) return timestampMs(readTime) + durationMs(age) - Date.now();
  }
  return 0;
}

/** Options of a move. */
export interface MoveOptions {
  /** Highest speed of each axis. Undefined: as the axis is set. */
  speed?: Speed | undefined;
  /**
   * Displacement of the last part of the move of each axis, whose direction is then always the same, so that backlash
   * does not matter. Undefined: the axes move directly.
   */
  approach?: Distance | undefined;
}

/** Returns a move without its context. */
export function move(
  device: string,
  targets: Readonly<Record<string, Distance>>,
  options: MoveOptions & { relative?: boolean | undefined; validateOnly?: boolean },
): stage.MoveRequest {
  const axes = Object.entries(targets);
  if (axes.length === 0) throw new TypeError('a move needs at least one axis, such as { x: mm("1.5") }');
  return create(stage.MoveRequestSchema, {
    device,
    relative: options.relative ?? false,
    validateOnly: options.validateOnly ?? false,
    targets: axes.map(([axis, target]) => ({
      axis,
      distance: distance(target),
      profile: options.speed === undefined ? undefined : { maximum: speed(options.speed) },
      approach: optionalDistance(options.approach),
    })),
  });
}

/** Position for each axis, in their order. A single Distance is a point of one axis. */
export type Point = Distance | Iterable<Distance>;

/** Returns the targets of the axes at a point. Throws RangeError if the point has another number of axes. */
export function targetsOf(axes: readonly string[], point: Point): [string, Distance][] {
  const distances = point instanceof Distance ? [point] : [...point];
  if (distances.length === axes.length) return distances.map((target, at) => [axes[at] ?? "", target]);
  throw new RangeError(`a point has ${String(distances.length)} distances for ${String(axes.length)} axes`);
}

/** Returns the piece of a path that leads to a point. */
export function segment(axes: readonly string[], point: Point, fastest: Speed | undefined): stage.Segment {
  const steps = targetsOf(axes, point).map(([axis, amount]) => ({ axis, distance: distance(amount) }));
  const [single, second] = steps;
  return create(stage.SegmentSchema, {
    speed: optionalSpeed(fastest),
    shape:
      single !== undefined && second === undefined
        ? { case: "single", value: create(common.AxisDistanceSchema, single) }
        : { case: "line", value: create(stage.LineSchema, { distances: steps }) },
  });
}

/** Returns the jog of one axis. A negative speed is one in the minus direction. */
export function axisJog(axis: string, at: Speed): stage.AxisJog {
  const { amount } = speed(at);
  const direction = isNegative(at) ? stage.AxisJog_Direction.MINUS : stage.AxisJog_Direction.PLUS;
  return create(stage.AxisJogSchema, { axis, direction, speed: { amount: magnitude(amount) } });
}

function isNegative({ distance: { value } }: Speed): boolean {
  return typeof value === "string" ? value.startsWith("-") : value < 0;
}

function magnitude(amount: common.Speed["amount"]): common.Speed["amount"] {
  switch (amount.case) {
    case undefined:
      return amount;
    case "floating":
      return { case: amount.case, value: { ...amount.value, value: Math.abs(amount.value.value) } };
    case "pulsesPerS":
      return { case: amount.case, value: amount.value < 0n ? -amount.value : amount.value };
    default:
      return { case: amount.case, value: amount.value.replace(/^-/, "") };
  }
}
