import { create, type MessageInitShape } from "@bufbuild/protobuf";

import { type AxisgateError, OutcomeUnknown } from "./errors.js";
import type { Motion } from "./gen/axisgate/v1/motion_pb.js";
import { type WaitMotionRequest, WaitMotionRequestSchema } from "./gen/axisgate/v1/stage_pb.js";
import { errorOf, type Failure } from "./outcomes.js";
import { Backoff } from "./repeat.js";
import { duration } from "./requests.js";

/** Time without an answer after which the outcome of a motion counts as unknown, in milliseconds. */
export const LOST_LIMIT_MS = 60_000;
const WAIT_MS = 10_000;
const ANSWER_MS = 5000;

/**
 * A Following decides how one motion is followed to its outcome, also over broken connections and restarts of the
 * daemon. It has neither a clock nor a connection. Times are in milliseconds.
 */
export class Following {
  private readonly backoff = new Backoff();

  constructor(
    private readonly motion: Motion,
    private readonly target: string,
    private answered: number,
  ) {}

  /** Returns the next request, which waits at most `waitMs`, and its deadline. */
  question(waitMs: number): [WaitMotionRequest, number] {
    const wait = Math.max(Math.min(waitMs, WAIT_MS), 0);
    const request: MessageInitShape<typeof WaitMotionRequestSchema> = {
      motion: this.motion.name,
      maxWait: duration(wait),
    };
    return [create(WaitMotionRequestSchema, request), wait + ANSWER_MS];
  }

  /**
   * Takes an answer. Returns an error if the answer is about another motion: a daemon without a journal gives the names
   * of motions again after a restart.
   */
  take(motion: Motion, now: number): AxisgateError | undefined {
    this.answered = now;
    this.backoff.reset();
    if (motion.requestId === this.motion.requestId) return undefined;
    return this.unknown("the daemon was restarted, and no longer has the motion");
  }

  /** Returns the pause after which the daemon is asked again, or the error if it is not. */
  after(failure: Failure, now: number): number | AxisgateError {
    if (!failure.passing && failure.reason !== "QUEUE_FULL") {
      return this.unknown("its outcome cannot be read", errorOf(failure, this.target));
    }
    if (now - this.answered > LOST_LIMIT_MS) {
      return this.unknown(`the daemon has not answered for ${String(LOST_LIMIT_MS / 1000)} s`);
    }
    return this.backoff.pause();
  }

  private unknown(why: string, cause?: AxisgateError): OutcomeUnknown {
    return new OutcomeUnknown(
      "OUTCOME_UNKNOWN",
      `the outcome of ${this.motion.name} is unknown: ${why}`,
      "look at the stage before you repeat the motion",
      { cause },
    );
  }
}
