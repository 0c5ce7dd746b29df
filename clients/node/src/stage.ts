import { create } from "@bufbuild/protobuf";

import { Axis } from "./axis.js";
import { execute, type Executed, type ExecuteOptions } from "./commands.js";
import { type ConnectOptions, Device, find, type FindOptions, open } from "./device.js";
import {
  Capability,
  ClearErrorsRequestSchema,
  type Device as DeviceMessage,
  DeviceService,
} from "./gen/axisgate/v1/device_pb.js";
import {
  EmergencyStopRequestSchema,
  HomeRequestSchema,
  ListMotionsRequestSchema,
  type MoveRequest,
  ScanRequestSchema,
  StageService,
  StopRequestSchema,
} from "./gen/axisgate/v1/stage_pb.js";
import { Jog } from "./jog.js";
import { Motion } from "./motion.js";
import { type PathOptions, type Points, startPath } from "./path.js";
import { Places } from "./places.js";
import { distance, duration, move, type MoveOptions, optionalSpeed, targetsOf } from "./requests.js";
import { reportOf, Result, type StopReport } from "./results.js";
import type { DeviceSession, WaitOptions } from "./session.js";
import { Settings } from "./settings.js";
import { type Status, statusOf } from "./state.js";
import { States, type WatchOptions } from "./states.js";
import type { Distance, Speed } from "./units.js";

// Longest time until the answer to a stop, which then has what is known.
const STOP_MS = 4000;

/** Positions or displacements by the names or numbers of the axes. */
export type Targets = Readonly<Record<string, Distance>>;

/** Options of Stage.home(). */
export interface HomeOptions extends WaitOptions {
  /** Leave out axes that the daemon has homed already. The result has no positions if none is left. */
  ifNeeded?: boolean | undefined;
}

/** Options of Stage.scan(). */
export interface ScanOptions extends WaitOptions {
  /** Distance between two trigger pulses. */
  every: Distance;
  /** Constant speed. Undefined: as the axis is set. */
  speed?: Speed | undefined;
}

/**
 * A Stage is the connection to one device that moves axes. Its calls may run at the same time; the objects belong to the
 * thread that made them. Axes are named as in the configuration, or by their numbers.
 *
 * Every function rejects with Refused if the daemon refuses a request: nothing moved.
 */
export class Stage extends Device {
  private readonly byName: ReadonlyMap<string, Axis>;

  private constructor(session: DeviceSession, device: DeviceMessage) {
    super(session);
    this.byName = new Map([...statusOf(device).axes.values()].map((state) => [state.name, new Axis(this, state)]));
  }

  /**
   * Connects to the daemon: `await using stage = await Stage.connect()`, or with a close() at the end.
   *
   * Rejects with Unavailable if no daemon answers, with RangeError if there is no such device, and with TypeError if the
   * options contradict each other.
   */
  static async connect(options: ConnectOptions = {}): Promise<Stage> {
    const [session, device] = await open(options, Capability.MOVE);
    return new Stage(session, device);
  }

  /** Returns the names of the daemon's stages. */
  static find(options: FindOptions = {}): Promise<string[]> {
    return find(options, Capability.MOVE);
  }

  /** The axes that can be moved, in the order of their numbers. */
  get axes(): readonly Axis[] {
    return [...this.byName.values()];
  }

  /** Settings of the stage. */
  get settings(): Settings {
    return new Settings(this.session);
  }

  /** Saved positions of the stage. */
  get places(): Places {
    return new Places(this.session);
  }

  /** Returns an axis by its name or number. Throws RangeError. */
  axis(axis: string | number): Axis {
    const found = this.byName.get(String(axis)) ?? this.axes.find((one) => String(one.number) === String(axis));
    if (found !== undefined) return found;
    throw new RangeError(
      `${this.name} has no axis ${String(axis)}; its axes are ${[...this.byName.keys()].join(", ")}`,
    );
  }

  /** Returns the state of the device, which is read from the controller if it is older than `maxAgeMs`. */
  async status(options: WaitOptions & { maxAgeMs?: number | undefined } = {}): Promise<Status> {
    return statusOf(await this.session.read(options));
  }

  /**
   * Iterates over the newest state of the device, now and after every change. A slow reader skips states. The iteration
   * continues after a broken connection.
   */
  watch(options: WatchOptions = {}): States {
    return new States(this.session, options);
  }

  /** Checks a move as far as possible without moving. Rejects with Refused if it would be refused. */
  async check(targets: Targets, options: MoveOptions & WaitOptions & { relative?: boolean } = {}): Promise<void> {
    await this.session.act(StageService.method.move, this.move(targets, { ...options, validateOnly: true }), {
      signal: options.signal,
    });
  }

  /** Starts a move of some axes, all at once: `stage.start({ x: mm("1.5"), y: um("200") })`. */
  async start(targets: Targets, options: MoveOptions & WaitOptions & { relative?: boolean } = {}): Promise<Motion> {
    const { signal } = options;
    return await this.session.start(StageService.method.move, this.move(targets, options), { signal });
  }

  /**
   * Moves axes to positions, and waits for the outcome. An aborted signal cancels the move.
   *
   * Rejects with Refused, Stopped, MotionFailed or OutcomeUnknown.
   */
  async moveTo(targets: Targets, options: MoveOptions & WaitOptions = {}): Promise<Result> {
    const request = this.move(targets, { ...options, relative: false });
    return await this.session.finish(StageService.method.move, request, options.signal);
  }

  /** Does the same as moveTo() with displacements from the present positions. */
  async moveBy(displacements: Targets, options: MoveOptions & WaitOptions = {}): Promise<Result> {
    const request = this.move(displacements, { ...options, relative: true });
    return await this.session.finish(StageService.method.move, request, options.signal);
  }

  /** Homes axes, without names all, and waits for the outcome. An aborted signal cancels the motion. */
  async home(axes: readonly string[] = [], options: HomeOptions = {}): Promise<Result> {
    const chosen = options.ifNeeded ? await this.notHomed(axes) : axes;
    if (chosen === undefined) return new Result("", new Map(), 0);
    const request = create(HomeRequestSchema, { device: this.session.device, axes: [...chosen] });
    return this.session.finish(StageService.method.home, request, options.signal);
  }

  /**
   * Starts a path through points without a halt: `stage.path(grid(), ["x", "y"], { speed: mm(2).perSecond })`.
   *
   * All points are read first, so nothing moves if `points` throws.
   */
  path(points: Points, axes: readonly string[], options: PathOptions = {}): Promise<Motion> {
    return startPath(this.session, points, axes, options);
  }

  /**
   * Moves to one point after another, and yields the result once the axes are stationary at each point.
   *
   * Use it inside a lease, so that nobody moves the axes in between.
   */
  async *visit(
    points: Points,
    axes: readonly string[],
    options: MoveOptions & WaitOptions = {},
  ): AsyncGenerator<Result, void, undefined> {
    for await (const point of points) {
      yield await this.moveTo(Object.fromEntries(targetsOf(axes, point)), options);
    }
  }

  /**
   * Runs axes until the end of the jog: `await using jog = await stage.jog({ x: um(200).perSecond })`. A negative speed is
   * one in the minus direction. An aborted signal stops the axes.
   */
  async jog(speeds: Readonly<Record<string, Speed>>, options: WaitOptions = {}): Promise<Jog> {
    return await Jog.start(this.session, speeds, options);
  }

  /**
   * Sends lines in the controller's own language, once, as one transaction, and returns their answers.
   *
   * A motion that the lines started may continue: `(await stage.execute(["M:1+P100", "G:1"])).motion?.wait()`. Rejects
   * with Refused if nothing moved; otherwise with Stopped, MotionFailed or OutcomeUnknown.
   */
  execute(lines: readonly string[], options: ExecuteOptions = {}): Promise<Executed> {
    return execute(this.session, lines, options);
  }

  /**
   * Starts a run of one axis at constant speed. The trigger output gives a pulse every `every` from `from` on.
   *
   * `Result.scan` has the expected and the observed number of pulses.
   */
  async scan(axis: string, from: Distance, to: Distance, options: ScanOptions): Promise<Motion> {
    const request = create(ScanRequestSchema, {
      device: this.session.device,
      axis,
      start: distance(from),
      end: distance(to),
      interval: { case: "distance", value: distance(options.every) },
      speed: optionalSpeed(options.speed),
    });
    return await this.session.start(StageService.method.scan, request, { signal: options.signal });
  }

  /**
   * Slows down and stops axes, without names all of the stage. Needs no lease.
   *
   * Returns what was seen within 4 s. The stop is sent again for half of the Stage's time limit if no daemon answers.
   * Not a safety function.
   */
  async stop(axes: readonly string[] = []): Promise<StopReport> {
    const request = create(StopRequestSchema, { ...this.stopFields(), axes: [...axes] });
    return reportOf(await this.session.connection.stop(StageService.method.stop, request));
  }

  /** Stops all axes at once without slowing down. Nothing moves until clearErrors(). Not a safety function. */
  async emergencyStop(): Promise<StopReport> {
    const request = create(EmergencyStopRequestSchema, this.stopFields());
    return reportOf(await this.session.connection.stop(StageService.method.emergencyStop, request));
  }

  /** Clears limit, overflow and emergency errors of axes, without names of all. Starts no motion. */
  async clearErrors(axes: readonly string[] = []): Promise<void> {
    const request = create(ClearErrorsRequestSchema, { device: this.session.device, axes: [...axes] });
    await this.session.act(DeviceService.method.clearErrors, request);
  }

  /** Returns the newest 100 motions, newest first, also those of other callers. */
  async motions(options: WaitOptions = {}): Promise<Motion[]> {
    const request = create(ListMotionsRequestSchema, { device: this.session.device });
    const { motions } = await this.session.connection.ask(StageService.method.listMotions, request, options);
    return motions.map((one) => new Motion(this.session, one));
  }

  private move(
    targets: Targets,
    options: MoveOptions & { relative?: boolean | undefined; validateOnly?: boolean },
  ): MoveRequest {
    return move(this.session.device, targets, options);
  }

  private stopFields() {
    const { device, token } = this.session;
    return { device, maxWait: duration(STOP_MS), context: { leaseToken: token } };
  }

  /** Returns the axes that the daemon has not homed. Undefined: it has homed all. */
  private async notHomed(axes: readonly string[]): Promise<readonly string[] | undefined> {
    const states = (await this.status()).axes;
    // After its start, the daemon does not know the axes until the controller answers. It then refuses to home them.
    if (states.size === 0) return axes;
    const names = axes.length > 0 ? axes.map((axis) => this.axis(axis).name) : [...states.keys()];
    const left = names.filter((name) => !states.get(name)?.homed);
    return left.length > 0 ? left : undefined;
  }
}
