import { create } from "@bufbuild/protobuf";

import type { Exchange } from "./channel.js";
import type { Motion as MotionMessage } from "./gen/axisgate/v1/motion_pb.js";
import { JogRequestSchema, type JogResponseSchema, StageService } from "./gen/axisgate/v1/stage_pb.js";
import { Motion } from "./motion.js";
import { errorOf, Failure } from "./outcomes.js";
import { axisJog } from "./requests.js";
import type { Result } from "./results.js";
import { type DeviceSession, received, type WaitOptions } from "./session.js";
import type { Speed } from "./units.js";

// The daemon stops the axes after 500 ms without a message.
const EVERY_MS = 100;

/**
 * A Jog runs axes until its end() or the end of its block: `await using jog = await stage.jog({ x: um(200).perSecond })`.
 *
 * The daemon stops the axes if the program ends, or its event loop does not run for 500 ms.
 */
export class Jog {
  private constructor(
    private readonly call: Exchange<typeof JogRequestSchema, typeof JogResponseSchema>,
    /** The motion of the jog. */
    readonly motion: Motion,
    private readonly timer: NodeJS.Timeout,
  ) {
    void this.untilOutcome();
  }

  /** Starts a jog. See Stage.jog(). */
  static async start(
    session: DeviceSession,
    speeds: Readonly<Record<string, Speed>>,
    options: WaitOptions,
  ): Promise<Jog> {
    const axes = Object.entries(speeds).map(([axis, speed]) => axisJog(axis, speed));
    const { connection, device, token } = session;
    const call = connection.stream(StageService.method.jog, connection.with(options.signal));
    call.send(create(JogRequestSchema, { device, axes, context: { leaseToken: token } }));
    const message = create(JogRequestSchema);
    const timer = setInterval(() => {
      call.send(message);
    }, EVERY_MS);
    try {
      return new Jog(call, new Motion(session, await firstOf(call, connection.target.address)), timer);
    } catch (error) {
      clearInterval(timer);
      throw error;
    }
  }

  /**
   * Ends the jog: the axes slow down. Returns the result.
   *
   * Rejects with Stopped, MotionFailed or OutcomeUnknown if something else ended the jog.
   */
  async end(): Promise<Result> {
    clearInterval(this.timer);
    this.call.end();
    return this.motion.wait();
  }

  async [Symbol.asyncDispose](): Promise<void> {
    await this.end();
  }

  /** Reads the answers, so that the end of the call is noticed. */
  private async untilOutcome(): Promise<void> {
    try {
      for (;;) {
        const answer = await this.call.answers.next();
        if (answer instanceof Failure || answer === "ended") break;
      }
    } catch {
      // The signal of the jog was aborted; the call is cancelled.
    }
    clearInterval(this.timer);
  }
}

async function firstOf(
  call: Exchange<typeof JogRequestSchema, typeof JogResponseSchema>,
  target: string,
): Promise<MotionMessage> {
  const answer = await call.answers.next();
  if (answer instanceof Failure) throw errorOf(answer, target);
  if (answer === "ended") throw new Error("the daemon ended a jog without its motion");
  return received(answer.motion);
}
