import { fromBinary, isMessage } from "@bufbuild/protobuf";
import { anyUnpack } from "@bufbuild/protobuf/wkt";
import { type ServiceError, status } from "@grpc/grpc-js";

import {
  type AxisgateError,
  type ErrorClass,
  LeaseHeld,
  LeaseLost,
  MotionFailed,
  NotAllowed,
  NotHomed,
  OutcomeUnknown,
  OutsideTravel,
  Refused,
  Stopped,
  StoppedBy,
  Unavailable,
} from "./errors.js";
import { type Problem, ProblemSchema, Reason } from "./gen/axisgate/v1/common_pb.js";
import { type Motion, MotionSchema } from "./gen/axisgate/v1/motion_pb.js";
import { StatusSchema } from "./gen/status_pb.js";
import { withMethods } from "./hints.js";
import { nameOf } from "./names.js";

const DETAILS = "grpc-status-details-bin";

// Starts of gRPC's texts for a call that never had a connection. Texts that differ only make an outcome unknown.
const NEVER_CONNECTED = ["No connection established", "Name resolution failed", "No addresses resolved"];

const CLASSES: ReadonlyMap<string, ErrorClass> = new Map<string, ErrorClass>([
  ["OUTSIDE_TRAVEL", OutsideTravel],
  ["NOT_HOMED", NotHomed],
  ["LEASE_HELD", LeaseHeld],
  ["LEASE_LOST", LeaseLost],
  ["STOPPED_BY", StoppedBy],
  ["NOT_ALLOWED", NotAllowed],
  ["UNAUTHENTICATED", NotAllowed],
  ["LINK_DOWN", Unavailable],
  ["NOT_SENT", Unavailable],
  ["REPLY_TIMED_OUT", Unavailable],
  ["LINE_FAULT", Unavailable],
  ["COMPLETION_OUTSTANDING", Unavailable],
  ["JOURNAL_UNAVAILABLE", Unavailable],
  ["DAEMON_ENDING", Unavailable],
  ["STOPPED", Stopped],
  ["TARGET_NOT_REACHED", MotionFailed],
  ["OUTCOME_UNKNOWN", OutcomeUnknown],
  ["REQUEST_MEMORY_LOST", OutcomeUnknown],
]);

// Reasons that the daemon may give before it compares the request's id with earlier requests.
const BEFORE_MEMORY: ReadonlySet<string> = new Set([
  "INVALID_REQUEST",
  "UNKNOWN_DEVICE",
  "UNKNOWN_AXIS",
  "QUEUE_FULL",
  "NOT_ALLOWED",
  "UNAUTHENTICATED",
  "LEASE_LOST",
  "INTERNAL",
  "REQUEST_ID_REUSED",
]);

// Codes of calls that are refused before a problem can be sent. RESOURCE_EXHAUSTED is not among them: grpc-js also
// reports it for a stream that was reset, and for an answer that is too long.
const EARLY: ReadonlyMap<status, string> = new Map([
  [status.UNAUTHENTICATED, "UNAUTHENTICATED"],
  [status.PERMISSION_DENIED, "NOT_ALLOWED"],
  [status.UNIMPLEMENTED, "UNIMPLEMENTED"],
]);

/** A Failure is a call that ended without an answer. */
export class Failure {
  /** `problem` is undefined if the daemon did not report one. */
  constructor(
    readonly code: status,
    readonly text: string,
    readonly problem?: Problem | undefined,
  ) {}

  /** Name of the gRPC code. */
  get codeName(): string {
    return status[this.code];
  }

  /** Name of the reason, or empty without a problem. */
  get reason(): string {
    return this.problem === undefined ? (EARLY.get(this.code) ?? "") : nameOf(Reason, this.problem.reason, "REASON");
  }

  /** True if the answer was lost: the request may have acted. */
  get lost(): boolean {
    return this.problem === undefined && !EARLY.has(this.code);
  }

  /** True if there was no connection, so the request cannot have acted. */
  get neverSent(): boolean {
    return this.lost && NEVER_CONNECTED.some((start) => this.text.startsWith(start));
  }

  /** True if the same request may succeed a moment later. */
  get passing(): boolean {
    return this.lost || this.code === status.UNAVAILABLE;
  }

  /** True if this refusal of a repeated request means that the first request did not act either. */
  get decidesRepeat(): boolean {
    return !this.passing && !BEFORE_MEMORY.has(this.reason);
  }
}

/** Returns the failure that gRPC reports. */
export function failureOf(error: ServiceError): Failure {
  const [details] = error.metadata.get(DETAILS);
  return new Failure(error.code, error.details, details instanceof Uint8Array ? problemIn(details) : undefined);
}

function problemIn(details: Uint8Array): Problem | undefined {
  try {
    for (const detail of fromBinary(StatusSchema, details).details) {
      const problem = anyUnpack(detail, ProblemSchema);
      if (problem !== undefined) return problem;
    }
  } catch {
    // The details are not the daemon's.
  }
  return undefined;
}

/** Returns the error for a call that failed and is not repeated. `target` is the daemon's address. */
export function errorOf(failure: Failure, target: string): AxisgateError {
  const code = failure.codeName;
  if (failure.problem !== undefined) return errorOfProblem(failure.problem, code);
  if (!failure.lost) return new (CLASSES.get(failure.reason) ?? Refused)(failure.reason, failure.text, "", { code });
  if (failure.neverSent) return unavailable(failure, target);
  return new OutcomeUnknown(
    "OUTCOME_UNKNOWN",
    `the answer of the daemon at ${target} was lost: ${failure.text}`,
    "look at the stage before you repeat the request",
    { code },
  );
}

/** Returns the error for a request that acted nowhere because the daemon did not answer. */
export function unavailable(failure: Failure, target: string): Unavailable {
  return new Unavailable(
    "UNAVAILABLE",
    `no daemon answers at ${target}: ${failure.text}`,
    "start axisgated, or set AXISGATE_TARGET to its address",
    { code: failure.codeName },
  );
}

/** Returns the error for a stop that reached no daemon. It is not Refused: the axes may be moving. */
export function undeliveredStop(error: Unavailable): OutcomeUnknown {
  return new OutcomeUnknown(
    error.reason,
    `the stop was not delivered: ${error.message}`,
    "press the emergency stop at the device",
    { code: error.code },
  );
}

/** Returns the answer to the request with this id. Throws OutcomeUnknown if its motion is that of another request. */
export function own<T>(answer: T, requestId: string): T {
  const motion = isMessage(answer, MotionSchema) ? answer : (answer as { motion?: Motion }).motion;
  if (motion === undefined || motion.requestId === requestId) return answer;
  throw new OutcomeUnknown(
    "OUTCOME_UNKNOWN",
    `the daemon answered with ${motion.name}, which another request started`,
    "look at the stage before you repeat the request",
  );
}

/** Returns the error for a problem, of the given class, or of the class for its reason. */
export function errorOfProblem(problem: Problem, code = "", kind?: ErrorClass): AxisgateError {
  const reason = nameOf(Reason, problem.reason, "REASON");
  const hint = withMethods(problem.hint, problem.axis === undefined ? "" : String(problem.axis));
  return new (kind ?? CLASSES.get(reason) ?? Refused)(reason, problem.message, hint, {
    axis: problem.axis,
    sent: problem.sent,
    wireReply: problem.wireReply,
    code,
  });
}
