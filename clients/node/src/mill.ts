import { create } from "@bufbuild/protobuf";
import { durationMs } from "@bufbuild/protobuf/wkt";

import { type ConnectOptions, Device, find, type FindOptions, open } from "./device.js";
import { Capability } from "./gen/axisgate/v1/device_pb.js";
import {
  AbortJobRequestSchema,
  CancelJobRequestSchema,
  ConfirmJobRequestSchema,
  GetMillRequestSchema,
  type Job,
  type Mill as MillMessage,
  MillService,
  OperateMillRequestSchema,
  type OperateMillRequest,
  PauseJobRequestSchema,
  ReportJobDoneRequestSchema,
  ResumeJobRequestSchema,
  StartJobRequestSchema,
  type WatchMillRequest,
  WatchMillRequestSchema,
  type WatchMillResponse,
  type WatchMillResponseSchema,
} from "./gen/axisgate/v1/mill_pb.js";
import { type JobOptions, sendJob } from "./job.js";
import { optionalDistance, optionalSpeed } from "./requests.js";
import { type DeviceSession, received, type WaitOptions } from "./session.js";
import { ResumingStream } from "./stream.js";
import type { Distance, Speed } from "./units.js";

/** Displacements of a mill's tool. */
export interface Step {
  x?: Distance | undefined;
  y?: Distance | undefined;
  z?: Distance | undefined;
}

/** MillStates is the iterator of Mill.watch(). */
export class MillStates extends ResumingStream<
  MillMessage,
  typeof WatchMillRequestSchema,
  typeof WatchMillResponseSchema
> {
  private readonly watch: WatchMillRequest;

  constructor(session: DeviceSession, options: WaitOptions) {
    super(session.connection, MillService.method.watchMill, options.signal);
    this.watch = create(WatchMillRequestSchema, { device: session.device });
  }

  protected override request(): WatchMillRequest {
    return this.watch;
  }

  protected override take(answer: WatchMillResponse): MillMessage {
    return received(answer.mill);
  }
}

/**
 * A Mill is the connection to one mill.
 *
 * A mill never answers, so the progress of a job is a range that the daemon computes. Jobs and states are the API's
 * messages `Job` and `Mill`. A job is sent to the queue, confirmed by a person at the mill, started, and reported as
 * done. Not a safety function: use the mill's own emergency stop.
 */
export class Mill extends Device {
  /** Connects to the daemon, as Stage.connect() does. */
  static async connect(options: ConnectOptions = {}): Promise<Mill> {
    const [session] = await open(options, Capability.JOBS);
    return new Mill(session);
  }

  /** Returns the names of the daemon's mills. */
  static find(options: FindOptions = {}): Promise<string[]> {
    return find(options, Capability.JOBS);
  }

  /** Returns the state of the mill: its queue, the running job, tools and origins. */
  async read(options: WaitOptions = {}): Promise<MillMessage> {
    const request = create(GetMillRequestSchema, { device: this.session.device });
    return received((await this.session.connection.ask(MillService.method.getMill, request, options)).mill);
  }

  /** Returns the jobs in the order of the queue, with the running job. */
  async jobs(options: WaitOptions = {}): Promise<readonly Job[]> {
    return (await this.read(options)).jobs;
  }

  /** Iterates over the state of the mill, now and after every change, also over broken connections. */
  watch(options: WaitOptions = {}): MillStates {
    return new MillStates(this.session, options);
  }

  /**
   * Puts a job into the queue, once, even if an answer is lost. Returns the job.
   *
   * `parts` are the contents of the job's files. The operator changes the tool between two parts. Rejects with Refused
   * if the check of the job finds an error, or a warning that is not in `acceptedWarnings`.
   */
  async send(parts: readonly Uint8Array[], options: JobOptions): Promise<Job> {
    return await sendJob(this.session, parts, options);
  }

  /** Confirms that a person has set up the mill as `job.setup` says, for the next job or its next part. */
  async confirm(job: Job): Promise<Job> {
    const request = create(ConfirmJobRequestSchema, { job: job.name, seen: job.setup });
    return received((await this.session.act(MillService.method.confirmJob, request)).job);
  }

  /** Starts a confirmed job, or its next part. */
  async start(job: Job): Promise<Job> {
    const request = create(StartJobRequestSchema, { job: job.name });
    return received((await this.session.act(MillService.method.startJob, request)).job);
  }

  /**
   * Sends no more of the running job. The mill executes what it has received; with `raiseTool` the tool is then raised.
   */
  async pause(options: { raiseTool?: boolean } = {}): Promise<void> {
    const raiseTool = options.raiseTool ?? false;
    const request = create(PauseJobRequestSchema, { device: this.session.device, raiseTool });
    await this.session.act(MillService.method.pauseJob, request);
  }

  /** Continues a job that was paused with the tool in the cut. */
  async resume(): Promise<void> {
    const request = create(ResumeJobRequestSchema, { device: this.session.device });
    await this.session.act(MillService.method.resumeJob, request);
  }

  /**
   * Ends the running job, discards the mill's buffer, raises the tool and stops the spindle. Needs no lease.
   *
   * The mill does not report whether it has done so. The abort is sent again for half of the time limit if no daemon
   * answers.
   */
  async abort(): Promise<void> {
    const { device, token } = this.session;
    const request = create(AbortJobRequestSchema, { device, context: { leaseToken: token } });
    await this.session.connection.stop(MillService.method.abortJob, request);
  }

  /** Removes a job that does not run from the queue. */
  async cancel(job: Job): Promise<void> {
    await this.session.act(MillService.method.cancelJob, create(CancelJobRequestSchema, { job: job.name }));
  }

  /** Reports that a person has seen the workpiece of a job that is FED. */
  async reportDone(job: Job): Promise<void> {
    await this.session.act(MillService.method.reportJobDone, create(ReportJobDoneRequestSchema, { job: job.name }));
  }

  /**
   * Moves the tool by hand: `mill.step({ z: mm("-0.5") })`. Z grows upward. Nothing checks where a step leads.
   *
   * Returns the longest time in milliseconds until the mill has done it.
   */
  async step(step: Step, options: { speed?: Speed | undefined } = {}): Promise<number> {
    const { x, y, z } = step;
    const value = {
      x: optionalDistance(x),
      y: optionalDistance(y),
      z: optionalDistance(z),
      speed: optionalSpeed(options.speed),
    };
    return await this.operate(create(OperateMillRequestSchema, { act: { case: "step", value } }));
  }

  /** Sets Z0 at the height of the tool, of a configured origin, or of a machine coordinate. Returns as step(). */
  async setZ0(height?: string | Distance): Promise<number> {
    const value = typeof height === "string" ? { origin: height } : { z: optionalDistance(height) };
    return await this.operate(create(OperateMillRequestSchema, { act: { case: "surface", value } }));
  }

  /** Starts or stops the spindle. Returns as step(). */
  spindle(on: boolean): Promise<number> {
    return this.operate(create(OperateMillRequestSchema, { act: { case: "spindle", value: on } }));
  }

  /** Raises the tool to the top, with the spindle stopped. Returns as step(). */
  raiseTool(): Promise<number> {
    return this.operate(create(OperateMillRequestSchema, { act: { case: "raiseTool", value: {} } }));
  }

  private async operate(request: OperateMillRequest): Promise<number> {
    request.device = this.session.device;
    const { longestTime } = await this.session.act(MillService.method.operateMill, request);
    return durationMs(received(longestTime));
  }
}
