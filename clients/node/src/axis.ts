import { Shown, type Position, type Result, type StopReport } from "./results.js";
import type { MoveOptions } from "./requests.js";
import type { Motion } from "./motion.js";
import type { WaitOptions } from "./session.js";
import type { HomeOptions, Stage } from "./stage.js";
import type { AxisState } from "./state.js";
import type { Distance } from "./units.js";

/** An Axis of a stage. Its functions reject with Refused if the daemon refuses a request. */
export class Axis extends Shown {
  /** Name from the configuration, or the number as text. */
  readonly name: string;
  /** Number, from 1. */
  readonly number: number;
  /** Unit in which positions are shown: "mm". */
  readonly unit: string;

  constructor(
    private readonly stage: Stage,
    state: AxisState,
  ) {
    super();
    this.name = state.name;
    this.number = state.number;
    this.unit = state.unit;
  }

  /** Reads the present state from the controller. */
  async state(options: WaitOptions = {}): Promise<AxisState> {
    const state = (await this.stage.status({ ...options, maxAgeMs: 0 })).axes.get(this.name);
    if (state === undefined) throw new RangeError(`${this.stage.name} no longer has an axis ${this.name}`);
    return state;
  }

  /** Reads the present position from the controller. */
  async position(options: WaitOptions = {}): Promise<Position> {
    return (await this.state(options)).position;
  }

  /** Starts a move to a position, or if `relative` by a displacement. */
  start(target: Distance, options: MoveOptions & WaitOptions & { relative?: boolean } = {}): Promise<Motion> {
    return this.stage.start(this.only(target), options);
  }

  /**
   * Moves to a position, and waits for the outcome. An aborted signal cancels the move.
   *
   * Rejects with Refused, Stopped, MotionFailed or OutcomeUnknown.
   */
  moveTo(target: Distance, options: MoveOptions & WaitOptions = {}): Promise<Result> {
    return this.stage.moveTo(this.only(target), options);
  }

  /** Does the same as moveTo() with a displacement from the present position. */
  moveBy(displacement: Distance, options: MoveOptions & WaitOptions = {}): Promise<Result> {
    return this.stage.moveBy(this.only(displacement), options);
  }

  /** Homes the axis, and waits for the outcome. See Stage.home(). */
  home(options: HomeOptions = {}): Promise<Result> {
    return this.stage.home([this.name], options);
  }

  /** Stops the axis. See Stage.stop(). */
  stop(): Promise<StopReport> {
    return this.stage.stop([this.name]);
  }

  override toString(): string {
    return `axis ${this.name} of ${this.stage.name}`;
  }

  private only(target: Distance): Record<string, Distance> {
    return { [String(this.number)]: target };
  }
}
