/** Fields of an error that not every error has. */
export interface ErrorDetails {
  axis?: number | undefined;
  sent?: string;
  wireReply?: string;
  code?: string;
  cause?: unknown;
}

/**
 * Base of all errors that the daemon reports, or that the connection to it causes.
 *
 * Its `message` is one sentence. As text, an error is its reason, the sentence, and the hint in parentheses.
 */
export class AxisgateError extends Error {
  /** Stable name of the reason, such as "OUTSIDE_TRAVEL". A reason that this package does not know is "REASON 99". */
  readonly reason: string;
  /** Advice. May be empty. */
  readonly hint: string;
  /** Number of the axis. Undefined if the error does not concern a single axis. */
  readonly axis: number | undefined;
  /** Command line concerned. May be empty. */
  readonly sent: string;
  /** The controller's reply. May be empty. */
  readonly wireReply: string;
  /** Name of the gRPC code. Empty if the error is not the answer to a call. */
  readonly code: string;

  constructor(reason: string, message: string, hint = "", details: ErrorDetails = {}) {
    super(message, details.cause === undefined ? {} : { cause: details.cause });
    this.name = new.target.name;
    this.reason = reason;
    this.hint = hint;
    this.axis = details.axis;
    this.sent = details.sent ?? "";
    this.wireReply = details.wireReply ?? "";
    this.code = details.code ?? "";
  }

  override toString(): string {
    return `${this.reason}: ${this.message}${this.hint && ` (${this.hint})`}`;
  }
}

/** The request was refused: nothing moved. */
export class Refused extends AxisgateError {}

/** The target is outside the travel limits of the axis. */
export class OutsideTravel extends Refused {}

/** The axis must be homed before any other motion. */
export class NotHomed extends Refused {}

/** Somebody else holds the axes, or moves them. */
export class LeaseHeld extends Refused {}

/** The lease of this program has ended. */
export class LeaseLost extends Refused {}

/** Somebody else stopped the axes. This program must call `Stage.rearm` before it moves them again. */
export class StoppedBy extends Refused {}

/** The daemon does not know this caller, or the caller's role does not allow the request. */
export class NotAllowed extends Refused {}

/** The daemon or the controller cannot be reached. */
export class Unavailable extends Refused {}

/** A stop ended the motion, or prevented it. */
export class Stopped extends AxisgateError {}

/** The motion ended with an error. */
export class MotionFailed extends AxisgateError {}

/** The outcome of the request is unknown. The axes may be moving: look at the stage before you repeat the request. */
export class OutcomeUnknown extends AxisgateError {}

/** Class of an error of this package. */
export type ErrorClass = new (reason: string, message: string, hint?: string, details?: ErrorDetails) => AxisgateError;
