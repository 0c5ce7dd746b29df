import { setMaxListeners } from "node:events";

import {
  create,
  type DescMessage,
  type DescMethodBiDiStreaming,
  type DescMethodServerStreaming,
  type MessageShape,
  toBinary,
} from "@bufbuild/protobuf";

import { type Signals, sleep } from "./abort.js";
import { type Answers, Channel, type Exchange, type Unary } from "./channel.js";
import { AxisgateError, Unavailable } from "./errors.js";
import { Following } from "./following.js";
import type { CallContext } from "./gen/axisgate/v1/common_pb.js";
import { DeviceService, ListDevicesRequestSchema, type ListDevicesResponse } from "./gen/axisgate/v1/device_pb.js";
import type { Motion } from "./gen/axisgate/v1/motion_pb.js";
import { StageService } from "./gen/axisgate/v1/stage_pb.js";
import type { Logger } from "./log.js";
import { Failure, own, undeliveredStop } from "./outcomes.js";
import { Repeat } from "./repeat.js";
import { clockAhead, newContext } from "./requests.js";
import { isOver } from "./results.js";
import type { Target } from "./target.js";

/** Function that sends a request once, always with the same bytes. */
export type Attempt<T> = (timeoutMs: number, signals: Signals) => Promise<T | Failure>;

/** Options of a request that changes something. */
export interface ActOptions {
  readonly leaseToken: Uint8Array;
  /** Time that the request may wait for something, in milliseconds. */
  readonly patienceMs?: number | undefined;
  readonly signal?: AbortSignal | undefined;
  /** Receives the id of the request before the request is sent. */
  readonly started?: ((requestId: string) => void) | undefined;
}

/** Request for the devices. */
export const LIST = create(ListDevicesRequestSchema);

/**
 * A Connection is the daemon as one program sees it. Repeat and Following decide what it sends.
 *
 * Stops have a connection of their own, which is open from the start, so that no other call delays them.
 */
export class Connection {
  private readonly calls: Channel;
  private readonly stops: Channel;
  private readonly closing = new AbortController();
  private readonly answerMs: number;

  /** `timeoutMs` is the time limit of a call. In its first half, a request whose answer was lost is sent again. */
  constructor(
    readonly target: Target,
    timeoutMs: number,
    readonly log: Logger,
  ) {
    this.answerMs = timeoutMs / 2;
    setMaxListeners(0, this.closing.signal);
    this.calls = new Channel(target);
    this.stops = new Channel(target);
  }

  /** Connects for stops and lists the devices. Rejects with Unavailable at once if no daemon answers. */
  open(signal?: AbortSignal): Promise<ListDevicesResponse> {
    const repeat = this.question(0);
    return this.send(repeat, this.attempt(this.stops, DeviceService.method.listDevices, LIST), this.with(signal));
  }

  /** Ends all calls and closes the connections. Motions continue. */
  close(): void {
    if (this.closing.signal.aborted) return;
    this.closing.abort(new Error("this Stage is closed"));
    this.calls.close();
    this.stops.close();
  }

  /** Returns the signals that end an operation: the end of the connection, and the caller's. */
  with(signal: AbortSignal | undefined): Signals {
    return signal === undefined ? [this.closing.signal] : [this.closing.signal, signal];
  }

  /** Returns the answer to a question, which is repeated for `patienceMs` while no daemon answers. */
  ask<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I>,
    options: { patienceMs?: number; signal?: AbortSignal | undefined } = {},
  ): Promise<MessageShape<O>> {
    const repeat = this.question(options.patienceMs ?? this.answerMs);
    return this.send(repeat, this.once(method, request), this.with(options.signal));
  }

  /** Sends a request that changes something, so that it acts at most once, and returns its answer. */
  act<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I> & { context?: CallContext },
    options: ActOptions,
  ): Promise<MessageShape<O>> {
    const attemptWith = (context: CallContext): Attempt<MessageShape<O>> => {
      request.context = context;
      return this.once(method, request);
    };
    return this.actBy(attemptWith, options);
  }

  /** Does the same as act() for a call of another form: `attemptWith` returns the function that sends it once. */
  async actBy<T>(attemptWith: (context: CallContext) => Attempt<T>, options: ActOptions): Promise<T> {
    const listed = await this.ask(DeviceService.method.listDevices, LIST, { signal: options.signal });
    const memory = listed.requestsKept ? listed.requestMemory : "";
    const patienceMs = (options.patienceMs ?? 0) + this.answerMs;
    const clockAheadMs = this.target.isLocal ? 0 : clockAhead(listed.devices);
    const context = newContext({ memory, leaseToken: options.leaseToken, clockAheadMs, patienceMs });
    const repeat = this.repeat(patienceMs, true, memory !== "");
    options.started?.(context.requestId);
    return own(await this.send(repeat, attemptWith(context), this.with(options.signal)), context.requestId);
  }

  /** Sends a stop over its own connection, and returns the answer. */
  async stop<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I>,
  ): Promise<MessageShape<O>> {
    const repeat = this.repeat(this.answerMs, true, true);
    try {
      return await this.send(repeat, this.attempt(this.stops, method, request), this.with(undefined));
    } catch (error) {
      throw error instanceof Unavailable ? undeliveredStop(error) : error;
    }
  }

  /** Returns the motion with its outcome, or as it is after `timeoutMs`. */
  async follow(motion: Motion, timeoutMs: number, signal?: AbortSignal): Promise<Motion> {
    const end = performance.now() + timeoutMs;
    const following = new Following(motion, this.target.address, performance.now());
    const signals = this.with(signal);
    let newest = motion;
    while (!isOver(newest)) {
      const left = end - performance.now();
      const [request, limitMs] = following.question(left);
      const answer = await this.once(StageService.method.waitMotion, request)(limitMs, signals);
      if (answer instanceof Failure) {
        const pause = pauseOf(following.after(answer, performance.now()));
        await sleep(Math.min(pause, Math.max(left, 0)), signals);
      } else if (answer.motion !== undefined) {
        const error = following.take(answer.motion, performance.now());
        if (error !== undefined) throw error;
        newest = answer.motion;
      }
      if (left <= 0) break;
    }
    return newest;
  }

  /** Begins a call that streams answers to one request. Without `timeoutMs` it lasts as long as its caller says. */
  watch<I extends DescMessage, O extends DescMessage>(
    method: DescMethodServerStreaming<I, O>,
    request: MessageShape<I>,
    signals: Signals,
    timeoutMs?: number,
  ): Answers<MessageShape<O>> {
    this.log.debug(`${method.name} begins`);
    return this.calls.watch(method, request, signals, timeoutMs);
  }

  /** Begins a call that streams both ways. `timeoutMs` is as for watch(). */
  stream<I extends DescMessage, O extends DescMessage>(
    method: DescMethodBiDiStreaming<I, O>,
    signals: Signals,
    timeoutMs?: number,
  ): Exchange<I, O> {
    this.log.debug(`${method.name} begins`);
    return this.calls.stream(method, signals, timeoutMs);
  }

  /** Returns a function that sends the request once. */
  once<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    request: MessageShape<I>,
  ): Attempt<MessageShape<O>> {
    return this.attempt(this.calls, method, request);
  }

  private question(patienceMs: number): Repeat {
    return this.repeat(patienceMs, false, false);
  }

  private repeat(patienceMs: number, acts: boolean, remembered: boolean): Repeat {
    const until = performance.now() + patienceMs;
    return new Repeat({ until, target: this.target.address, answerMs: this.answerMs, acts, remembered });
  }

  private attempt<I extends DescMessage, O extends DescMessage>(
    channel: Channel,
    method: Unary<I, O>,
    request: MessageShape<I>,
  ): Attempt<MessageShape<O>> {
    const content = toBinary(method.input, request);
    return (timeoutMs, signals) => {
      this.log.debug(`${method.name} is sent`);
      return channel.unary(method, content, timeoutMs, signals);
    };
  }

  private async send<T>(repeat: Repeat, attempt: Attempt<T>, signals: Signals): Promise<T> {
    for (;;) {
      const answer = await attempt(repeat.attemptTimeout(performance.now()), signals);
      if (!(answer instanceof Failure)) return answer;
      this.log.debug(`failed with ${answer.codeName} ${answer.reason}: ${answer.text}`);
      await sleep(pauseOf(repeat.after(answer, performance.now())), signals);
    }
  }
}

/** Returns the pause, or throws the error. */
function pauseOf(pause: number | AxisgateError): number {
  if (pause instanceof AxisgateError) throw pause;
  return pause;
}
