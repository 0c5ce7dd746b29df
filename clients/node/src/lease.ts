import { setMaxListeners } from "node:events";

import { create } from "@bufbuild/protobuf";

import { type Signals, sleep } from "./abort.js";
import { AxisgateError, LeaseLost, Unavailable } from "./errors.js";
import { CallContextSchema } from "./gen/axisgate/v1/common_pb.js";
import {
  AcquireLeaseRequestSchema,
  AtLoss,
  ControlService,
  HandOverLeaseRequestSchema,
  type Lease as LeaseMessage,
  ReleaseLeaseRequestSchema,
  RenewLeaseRequestSchema,
} from "./gen/axisgate/v1/control_pb.js";
import { duration } from "./requests.js";
import { type DeviceSession, received, type WaitOptions } from "./session.js";

const AT_LOSS = { stop: AtLoss.STOP, finish: AtLoss.FINISH };
const TTL_MS = 10_000;

/** Options of Stage.lease(). */
export interface LeaseOptions extends WaitOptions {
  /** Longest wait for the axes. Undefined: do not wait. */
  waitMs?: number | undefined;
  /** Time after which the lease ends if the program or the connection has failed. Undefined: 10 s. */
  ttlMs?: number | undefined;
  /** Effect on a running motion if the lease is lost. Undefined: "stop". */
  atLoss?: "stop" | "finish" | undefined;
  /** Text for others: "scan of sample 12". */
  purpose?: string | undefined;
}

/**
 * A Lease is the exclusive right to move some axes. It is kept alive in the background until it is released.
 *
 * All calls of its Stage carry the newest lease until it is released: a program that needs several leases at once opens
 * a Stage for each. A lease is lost if it cannot be kept alive, or if an administrator takes the axes over. Motion then
 * fails with LeaseLost until the lease is released.
 */
export class Lease {
  /** Token of the lease. It is a secret: every program that has it can use the lease. */
  readonly token: Uint8Array;
  /** Numbers of the axes. */
  readonly axes: readonly number[];
  private readonly ended = new AbortController();
  private readonly loss = new AbortController();
  private readonly keeper: Promise<void>;

  private constructor(
    private readonly session: DeviceSession,
    lease: LeaseMessage,
    private readonly ttlMs: number,
  ) {
    this.token = lease.token;
    this.axes = lease.axes;
    setMaxListeners(0, this.loss.signal);
    session.enterLease(this.token);
    this.keeper = this.keep();
  }

  /** Acquires a lease. See Stage.lease(). */
  static async acquire(session: DeviceSession, axes: readonly string[], options: LeaseOptions): Promise<Lease> {
    const ttlMs = options.ttlMs ?? TTL_MS;
    const waitMs = options.waitMs ?? 0;
    const request = create(AcquireLeaseRequestSchema, {
      device: session.device,
      terms: {
        axes: [...axes],
        timeToLive: duration(ttlMs),
        atLoss: AT_LOSS[options.atLoss ?? "stop"],
        purpose: options.purpose ?? "",
      },
      wait: waitMs > 0 ? duration(waitMs) : undefined,
    });
    const sent = { patienceMs: waitMs, signal: options.signal };
    const { lease } = await session.act(ControlService.method.acquireLease, request, sent);
    return new Lease(session, received(lease), ttlMs);
  }

  /** True if the lease was lost. */
  get lost(): boolean {
    return this.loss.signal.aborted;
  }

  /**
   * Signal that is aborted once the lease is lost. Its reason is the error. A move with this signal is cancelled then:
   * `stage.moveTo(targets, { signal: lease.lostSignal })`.
   */
  get lostSignal(): AbortSignal {
    return this.loss.signal;
  }

  /**
   * Gives the axes to a waiting caller, such as "unix anna". The lease ends.
   *
   * Rejects with Refused if this caller does not wait for exactly these axes, or while a motion runs under the lease.
   */
  async handOver(caller: string): Promise<void> {
    const request = create(HandOverLeaseRequestSchema, { device: this.session.device, caller });
    await this.session.connection.act(ControlService.method.handOverLease, request, { leaseToken: this.token });
    await this.end();
  }

  /** Ends the lease. A motion that runs under it continues. */
  async release(): Promise<void> {
    const isFirst = !this.ended.signal.aborted;
    await this.end();
    if (!isFirst || this.lost) return;
    const request = create(ReleaseLeaseRequestSchema, { device: this.session.device });
    await this.session.connection.act(ControlService.method.releaseLease, request, { leaseToken: this.token });
  }

  /** Does the same as release(). If the daemon does not answer, the lease ends when it expires. */
  async [Symbol.asyncDispose](): Promise<void> {
    try {
      await this.release();
    } catch (error) {
      this.session.connection.log.warn(`the lease was not released: ${String(error)}`);
    }
  }

  private async end(): Promise<void> {
    this.session.leaveLease(this.token);
    this.ended.abort();
    await this.keeper;
  }

  private async keep(): Promise<void> {
    const signals = this.session.connection.with(this.ended.signal);
    try {
      await this.renewAgainAndAgain(signals);
    } catch (error) {
      if (signals.some((signal) => signal.aborted)) return;
      this.session.connection.log.warn(`the lease was lost: ${String(error)}`);
      this.loss.abort(error);
    }
  }

  private async renewAgainAndAgain(signals: Signals): Promise<never> {
    const context = create(CallContextSchema, { leaseToken: this.token });
    const request = create(RenewLeaseRequestSchema, { device: this.session.device, context });
    const options = { patienceMs: 0, signal: this.ended.signal };
    let kept = performance.now();
    for (;;) {
      await sleep(this.ttlMs / 3, signals);
      try {
        await this.session.connection.ask(ControlService.method.renewLease, request, options);
        kept = performance.now();
      } catch (error) {
        if (!(error instanceof Unavailable)) throw error;
        if (performance.now() - kept > this.ttlMs) throw expired(error);
      }
    }
  }
}

function expired(error: AxisgateError): LeaseLost {
  return new LeaseLost("LEASE_LOST", `the lease has expired: ${error.message}`, error.hint, { cause: error });
}
