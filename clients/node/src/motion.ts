import { create } from "@bufbuild/protobuf";

import type { Device } from "./gen/axisgate/v1/device_pb.js";
import { type Motion as MotionMessage, MotionState } from "./gen/axisgate/v1/motion_pb.js";
import { CancelMotionRequestSchema, StageService } from "./gen/axisgate/v1/stage_pb.js";
import { nameOf } from "./names.js";
import { byAxis, isOver, outcomeOf, type Positions, type Result, Shown } from "./results.js";
import type { DeviceSession, WaitOptions } from "./session.js";
import { statusOf } from "./state.js";

const PROGRESS_MS = 200;

/** Progress of a motion. */
export interface Progress {
  /** Part of the distance that was covered, from 0 to 1. Undefined: unknown. */
  readonly fraction: number | undefined;
  readonly positions: Positions;
  /** Number of finished segments of a path. */
  readonly segment: number;
}

/**
 * A Motion is one request to move. It was started, and continues whatever this program does.
 *
 * With `await using motion = await stage.start(...)`, the motion is cancelled at the end of the block unless it has its
 * outcome.
 */
export class Motion extends Shown {
  constructor(
    private readonly session: DeviceSession,
    private message: MotionMessage,
  ) {
    super();
  }

  /** Name of the motion: "devices/stage/motions/12". */
  get name(): string {
    return this.message.name;
  }

  /** Id of the request that started the motion. */
  get requestId(): string {
    return this.message.requestId;
  }

  /** State as last received: "QUEUED", "RUNNING", "STOPPING", "SUCCEEDED", "STOPPED", "FAILED" or "UNKNOWN". */
  get state(): string {
    return nameOf(MotionState, this.message.state, "STATE");
  }

  /** Reports whether the motion has its outcome. */
  async isDone(options: WaitOptions = {}): Promise<boolean> {
    return isOver(await this.follow(0, options.signal));
  }

  /**
   * Waits for the outcome, also over broken connections and restarts of the daemon.
   *
   * Rejects with Stopped, MotionFailed or OutcomeUnknown unless the motion succeeds. Rejects with a TimeoutError after
   * `timeoutMs`, and with the reason of an aborted signal; the motion then continues.
   */
  async wait(options: WaitOptions & { timeoutMs?: number | undefined } = {}): Promise<Result> {
    const message = await this.follow(options.timeoutMs ?? Infinity, options.signal);
    if (isOver(message)) return outcomeOf(message);
    const text = `${this.name} has no outcome after ${String(options.timeoutMs)} ms, and continues`;
    throw new DOMException(text, "TimeoutError");
  }

  /** Yields the progress every `intervalMs` until the motion has its outcome, which wait() then returns. */
  async *progress(options: WaitOptions & { intervalMs?: number } = {}): AsyncGenerator<Progress, void, undefined> {
    let first: ReadonlyMap<number, bigint> | undefined;
    while (!isOver(await this.follow(options.intervalMs ?? PROGRESS_MS, options.signal))) {
      const device = await this.session.read(options);
      const now = pulsesOf(device);
      first ??= now;
      yield this.progressAt(device, first, now);
    }
  }

  /** Stops the motion, or drops it if it has not started. Has no effect on a motion with an outcome. */
  async cancel(): Promise<void> {
    await this.session.act(
      StageService.method.cancelMotion,
      create(CancelMotionRequestSchema, { motion: this.message.name }),
    );
  }

  async [Symbol.asyncDispose](): Promise<void> {
    if (!isOver(this.message)) await this.cancel();
  }

  override toString(): string {
    return `${this.name} ${this.state}`;
  }

  private async follow(timeoutMs: number, signal: AbortSignal | undefined): Promise<MotionMessage> {
    if (!isOver(this.message)) this.message = await this.session.connection.follow(this.message, timeoutMs, signal);
    return this.message;
  }

  private progressAt(device: Device, first: ReadonlyMap<number, bigint>, now: ReadonlyMap<number, bigint>): Progress {
    const moving = [...statusOf(device).axes.values()].filter((axis) => this.message.axes.includes(axis.number));
    return {
      fraction: fractionOf(this.message, first, now),
      positions: byAxis(moving.map((axis) => axis.position)),
      segment: this.message.segmentsDone,
    };
  }
}

function pulsesOf(device: Device): ReadonlyMap<number, bigint> {
  return new Map(device.axes.map((axis) => [axis.number, axis.positionPulses ?? 0n]));
}

/** Returns the least part of its distance that an axis has covered, or the part of a path's segments. */
function fractionOf(
  motion: MotionMessage,
  first: ReadonlyMap<number, bigint>,
  now: ReadonlyMap<number, bigint>,
): number | undefined {
  if (motion.segmentsTotal > 0) return motion.segmentsDone / motion.segmentsTotal;
  const parts = motion.results.flatMap(({ axis, targetPulses }) => {
    const from = first.get(axis) ?? 0n;
    if (targetPulses === undefined || targetPulses === from) return [];
    return [Number((now.get(axis) ?? 0n) - from) / Number(targetPulses - from)];
  });
  return parts.length > 0 ? Math.min(...parts) : undefined;
}
