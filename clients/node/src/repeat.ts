import { type AxisgateError, OutcomeUnknown } from "./errors.js";
import { errorOf, type Failure, unavailable } from "./outcomes.js";

const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 5000;

/** A Backoff is a series of pauses, each twice as long as the previous one. */
export class Backoff {
  private next = FIRST_PAUSE_MS;

  /** Returns the next pause in milliseconds. */
  pause(): number {
    const pause = this.next;
    this.next = Math.min(2 * pause, LONGEST_PAUSE_MS);
    return pause;
  }

  /** Begins with the shortest pause again. */
  reset(): void {
    this.next = FIRST_PAUSE_MS;
  }
}

/** Terms on which a request is sent again. */
export interface RepeatTerms {
  /** Latest time of an attempt, in milliseconds on the clock of the caller. */
  readonly until: number;
  /** Address of the daemon. */
  readonly target: string;
  /** Time for the answer to an attempt, in milliseconds. */
  readonly answerMs: number;
  /** False for a question, which may always be repeated. */
  readonly acts: boolean;
  /** False if the daemon does not remember requests: one that may have reached the daemon is then not repeated. */
  readonly remembered: boolean;
}

/**
 * A Repeat decides after each failed attempt whether the same request is sent again. It has neither a clock nor a
 * connection.
 */
export class Repeat {
  private readonly backoff = new Backoff();
  private mayHaveActed = false;

  constructor(private readonly terms: RepeatTerms) {}

  /** Returns the deadline of the attempt that is sent now, in milliseconds from now. */
  attemptTimeout(now: number): number {
    return Math.max(this.terms.until - now, 0) + this.terms.answerMs;
  }

  /** Returns the pause in milliseconds after which the same request is sent again, or the error if it is not. */
  after(failure: Failure, now: number): number | AxisgateError {
    this.mayHaveActed ||= this.terms.acts && failure.lost && !failure.neverSent;
    if (this.mayBeRepeated(failure)) {
      const pause = Math.min(this.backoff.pause(), this.terms.until - now);
      if (pause > 0) return pause;
    }
    return this.errorOf(failure);
  }

  private mayBeRepeated(failure: Failure): boolean {
    if (this.mayHaveActed && !this.terms.remembered) return false;
    return failure.passing || (this.mayHaveActed && failure.reason === "QUEUE_FULL");
  }

  private errorOf(failure: Failure): AxisgateError {
    if (!this.terms.acts && failure.lost) return unavailable(failure, this.terms.target);
    const error = errorOf(failure, this.terms.target);
    if (!this.mayHaveActed || failure.decidesRepeat || error instanceof OutcomeUnknown) return error;
    return new OutcomeUnknown(
      "OUTCOME_UNKNOWN",
      `the answer to the request was lost, and a repeat was refused: ${error.message}`,
      "look at the stage before you repeat the request",
      { code: error.code, cause: error },
    );
  }
}
