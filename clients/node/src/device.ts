import { create } from "@bufbuild/protobuf";

import { Connection } from "./connection.js";
import { chooseDevice, namesAmong } from "./devices.js";
import { type EventOptions, Events } from "./events.js";
import { AccessService, GetCallerRequestSchema, Role } from "./gen/axisgate/v1/access_pb.js";
import { ControlService, RearmRequestSchema } from "./gen/axisgate/v1/control_pb.js";
import type { Capability, Device as DeviceMessage } from "./gen/axisgate/v1/device_pb.js";
import { Lease, type LeaseOptions } from "./lease.js";
import { DEFAULT_LOGGER, type Logger } from "./log.js";
import { nameOf, shortName } from "./names.js";
import { Shown } from "./results.js";
import { DeviceSession, type WaitOptions } from "./session.js";
import { resolve, type TargetOptions } from "./target.js";

const TIMEOUT_MS = 10_000;

/** Options of connect(). */
export interface ConnectOptions extends TargetOptions, WaitOptions {
  /** Name of the device. Undefined: the only one of its kind. */
  device?: string | undefined;
  /**
   * Time limit of each call. Undefined: 10 s. While it is in its first half, a request whose answer is lost is sent
   * again; the daemon acts once.
   */
  timeoutMs?: number | undefined;
  /** Receives the calls as text. Undefined: they are written if the environment has NODE_DEBUG=axisgate. */
  logger?: Logger | undefined;
}

/** Options of find(). */
export type FindOptions = Omit<ConnectOptions, "device">;

/**
 * A Device is the connection to one device of a daemon. Its calls may run at the same time; the objects belong to the
 * thread that made them.
 *
 * Every function rejects with Refused if the daemon refuses a request: nothing moved.
 */
export abstract class Device extends Shown {
  protected constructor(protected readonly session: DeviceSession) {
    super();
  }

  /** Ends all calls and closes the connection. Motions and jobs continue. Leases that were not released expire. */
  close(): void {
    this.session.connection.close();
  }

  [Symbol.asyncDispose](): Promise<void> {
    this.close();
    return Promise.resolve();
  }

  /** Name of the device. */
  get name(): string {
    return shortName(this.session.device);
  }

  /** Returns the caller's name and role, as the daemon identifies this program. */
  async whoami(options: WaitOptions = {}): Promise<{ name: string; role: string }> {
    const request = create(GetCallerRequestSchema);
    const { caller, role } = await this.session.connection.ask(AccessService.method.getCaller, request, options);
    return { name: caller?.name ?? "", role: nameOf(Role, role, "ROLE").toLowerCase() };
  }

  /**
   * Watches every event from now on, each once and in order, also over broken connections and restarts. A Gap in the
   * series means that events were missed. Resolves once watching has begun.
   */
  events(options: EventOptions = {}): Promise<Events> {
    return Events.begin(this.session, options);
  }

  /** Allows motion after a stop by another caller. Returns the numbers of the axes that may move again. */
  async rearm(): Promise<readonly number[]> {
    const request = create(RearmRequestSchema, { device: this.session.device });
    return (await this.session.act(ControlService.method.rearm, request)).axes;
  }

  /**
   * Acquires the exclusive right to axes of a stage, without names to the device: `await using lease = await
   * stage.lease(["x"])`.
   *
   * Rejects with LeaseHeld if the axes are not free.
   */
  lease(axes: readonly string[] = [], options: LeaseOptions = {}): Promise<Lease> {
    return Lease.acquire(this.session, axes, options);
  }

  override toString(): string {
    return `${this.constructor.name} ${this.name}`;
  }
}

/** Connects to the device of the options, which has the capability. Returns its session and its state. */
export async function open(options: ConnectOptions, capability: Capability): Promise<[DeviceSession, DeviceMessage]> {
  const connection = connectionOf(options);
  try {
    const listed = await connection.open(options.signal);
    const device = chooseDevice(listed.devices, options.device, capability);
    return [new DeviceSession(connection, device.name), device];
  } catch (error) {
    connection.close();
    throw error;
  }
}

/** Returns the names of the daemon's devices with the capability. */
export async function find(options: FindOptions, capability: Capability): Promise<string[]> {
  const connection = connectionOf(options);
  try {
    return namesAmong((await connection.open(options.signal)).devices, capability);
  } finally {
    connection.close();
  }
}

function connectionOf(options: FindOptions): Connection {
  const { timeoutMs = TIMEOUT_MS, logger = DEFAULT_LOGGER } = options;
  return new Connection(resolve(options), timeoutMs, logger);
}
