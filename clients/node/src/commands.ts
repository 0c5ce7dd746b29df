import { randomUUID } from "node:crypto";

import { create } from "@bufbuild/protobuf";

import { type AxisgateError, MotionFailed, OutcomeUnknown, Refused, Unavailable } from "./errors.js";
import { CommandService, ExecuteRequestSchema } from "./gen/axisgate/v1/command_pb.js";
import { MotionSchema } from "./gen/axisgate/v1/motion_pb.js";
import { Motion } from "./motion.js";
import { errorOf, errorOfProblem, Failure } from "./outcomes.js";
import { duration } from "./requests.js";
import type { DeviceSession, WaitOptions } from "./session.js";

const TIMEOUT_MS = 20_000;
const ANSWER_MS = 5000;

/** Answers of the controller to lines. */
export interface Executed {
  readonly answers: readonly string[];
  /** Motion that the lines started, which may continue. Undefined: no motion. */
  readonly motion: Motion | undefined;
}

/** Options of Stage.execute(). */
export interface ExecuteOptions extends WaitOptions {
  /** Time limit of the lines. Undefined: 20 s. */
  timeoutMs?: number | undefined;
}

/** Sends lines, once. See Stage.execute(). */
export async function execute(
  session: DeviceSession,
  lines: readonly string[],
  options: ExecuteOptions,
): Promise<Executed> {
  const { connection, device, token } = session;
  const timeoutMs = options.timeoutMs ?? TIMEOUT_MS;
  const requestId = randomUUID();
  const context = { requestId, leaseToken: token };
  const request = create(ExecuteRequestSchema, { device, lines: [...lines], timeout: duration(timeoutMs), context });
  const signals = connection.with(options.signal);
  const call = connection.watch(CommandService.method.execute, request, signals, timeoutMs + ANSWER_MS);
  const answers: string[] = [];
  let name = "";
  for (;;) {
    const answer = await call.next();
    if (answer instanceof Failure) throw errorOfLines(answer, name !== "", connection.target.address);
    if (answer === "ended") break;
    const { change } = answer;
    if (change.case === "motion") name ||= change.value;
    if (change.case === "reply") answers.push(change.value.answer);
  }
  const motion = name ? new Motion(session, create(MotionSchema, { name, requestId })) : undefined;
  return { answers, motion };
}

/** Returns the error. It is not Refused, which means that nothing moved, if lines were sent that may move. */
function errorOfLines(failure: Failure, moves: boolean, target: string): AxisgateError {
  const error = errorOf(failure, target);
  if (!moves || failure.problem === undefined || !(error instanceof Refused)) return error;
  const isUncertain = error instanceof Unavailable || error.reason === "DEADLINE_PASSED";
  return errorOfProblem(failure.problem, error.code, isUncertain ? OutcomeUnknown : MotionFailed);
}
