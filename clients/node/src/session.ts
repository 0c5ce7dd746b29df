import { setTimeout as delay } from "node:timers/promises";

import { create, type DescMessage, type MessageShape } from "@bufbuild/protobuf";

import type { Unary } from "./channel.js";
import type { ActOptions, Connection } from "./connection.js";
import { AxisgateError } from "./errors.js";
import type { CallContext } from "./gen/axisgate/v1/common_pb.js";
import { type Device, DeviceService, GetDeviceRequestSchema } from "./gen/axisgate/v1/device_pb.js";
import type { Motion as MotionMessage } from "./gen/axisgate/v1/motion_pb.js";
import { ListMotionsRequestSchema, StageService } from "./gen/axisgate/v1/stage_pb.js";
import { Motion } from "./motion.js";
import { duration } from "./requests.js";
import type { Result } from "./results.js";

const TOKEN = /^(?:[0-9a-fA-F]{48})?$/;
// Attempts to find a motion whose start was interrupted, and the time between them.
const FIND_ATTEMPTS = 3;
const FIND_PAUSE_MS = 100;

/** Options of a call that waits. */
export interface WaitOptions {
  /** Ends the waiting, which then rejects with the reason of the signal. */
  signal?: AbortSignal | undefined;
}

/** A DeviceSession sends the requests for one device, with the lease that they carry. */
export class DeviceSession {
  private readonly leases: Uint8Array[] = [];
  private readonly inherited = inheritedToken();

  constructor(
    readonly connection: Connection,
    readonly device: string,
  ) {}

  /** Token of the newest lease, or that of `axisctl lease run`. Empty: no lease. */
  get token(): Uint8Array {
    return this.leases.at(-1) ?? this.inherited;
  }

  /** Makes the calls carry the token. */
  enterLease(token: Uint8Array): void {
    this.leases.push(token);
  }

  /** Ends enterLease(). */
  leaveLease(token: Uint8Array): void {
    const place = this.leases.indexOf(token);
    if (place >= 0) this.leases.splice(place, 1);
  }

  /** Sends a request that changes something, and returns its answer. */
  act<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I> & { context?: CallContext },
    options: Omit<ActOptions, "leaseToken"> = {},
  ): Promise<MessageShape<O>> {
    return this.connection.act(method, request, { leaseToken: this.token, ...options });
  }

  /** Returns the state of the device, which is read again if it is older than `maxAgeMs`. */
  async read(options: WaitOptions & { maxAgeMs?: number | undefined } = {}): Promise<Device> {
    const maxAge = options.maxAgeMs === undefined ? undefined : duration(options.maxAgeMs);
    const request = create(GetDeviceRequestSchema, { device: this.device, maxAge });
    const { device } = await this.connection.ask(DeviceService.method.getDevice, request, { signal: options.signal });
    return received(device);
  }

  /** Starts a motion. */
  async start<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I> & { context?: CallContext },
    options: Omit<ActOptions, "leaseToken"> = {},
  ): Promise<Motion> {
    const answer = (await this.act(method, request, options)) as { motion?: MotionMessage };
    return new Motion(this, received(answer.motion));
  }

  /** Starts a motion and waits for its outcome. If the signal is aborted, the motion is cancelled. */
  async finish<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I> & { context?: CallContext },
    signal?: AbortSignal,
  ): Promise<Result> {
    let motion: Motion | undefined;
    let sent: string | undefined;
    const started = (requestId: string): void => {
      sent = requestId;
    };
    try {
      motion = await this.start(method, request, { signal, started });
      return await motion.wait({ signal });
    } catch (error) {
      if (signal?.aborted && !(error instanceof AxisgateError)) await this.cancel(motion, sent);
      throw error;
    }
  }

  private async cancel(motion: Motion | undefined, requestId: string | undefined): Promise<void> {
    try {
      await (motion ?? (await this.find(requestId)))?.cancel();
    } catch (error) {
      this.connection.log.warn(`the motion was not cancelled: ${String(error)}`);
    }
  }

  /** Returns the motion of a request whose answer did not arrive, if there is one. */
  private async find(requestId: string | undefined): Promise<Motion | undefined> {
    for (let attempt = 0; requestId !== undefined && attempt < FIND_ATTEMPTS; attempt++) {
      const request = create(ListMotionsRequestSchema, { device: this.device, requestId });
      const { motions } = await this.connection.ask(StageService.method.listMotions, request);
      const found = motions.find((one) => one.requestId === requestId);
      if (found !== undefined) return new Motion(this, found);
      await delay(FIND_PAUSE_MS);
    }
    return undefined;
  }
}

/** Returns a field that the daemon always sets. */
export function received<T>(value: T | undefined): T {
  if (value === undefined) throw new Error("the daemon's answer is incomplete");
  return value;
}

function inheritedToken(): Uint8Array {
  const text = process.env["AXISGATE_LEASE"] ?? "";
  if (!TOKEN.test(text)) {
    throw new TypeError("AXISGATE_LEASE is not the token of a lease: unset it, or use `axisctl lease run`");
  }
  return Buffer.from(text, "hex");
}
