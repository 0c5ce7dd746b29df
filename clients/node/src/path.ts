import { create } from "@bufbuild/protobuf";

import type { Signals } from "./abort.js";
import type { Exchange } from "./channel.js";
import type { CallContext } from "./gen/axisgate/v1/common_pb.js";
import type { Motion as MotionMessage } from "./gen/axisgate/v1/motion_pb.js";
import {
  RunPathRequestSchema,
  type RunPathRequest,
  type RunPathResponseSchema,
  type Segment,
  StageService,
} from "./gen/axisgate/v1/stage_pb.js";
import { Motion } from "./motion.js";
import { Failure } from "./outcomes.js";
import { type Point, segment } from "./requests.js";
import type { DeviceSession, WaitOptions } from "./session.js";
import type { Speed } from "./units.js";

// Segments that are sent in a second at the least; the time for them is added to the limit of the request.
const SEGMENTS_PER_S = 2000;

/** Points of a path, also as a generator. */
export type Points = Iterable<Point> | AsyncIterable<Point>;

/** Options of a path. */
export interface PathOptions extends WaitOptions {
  /** Speed along the path. Undefined: as the axes are set. */
  speed?: Speed | undefined;
}

/** Starts a path. See Stage.path(). */
export async function startPath(
  session: DeviceSession,
  points: Points,
  axes: readonly string[],
  options: PathOptions,
): Promise<Motion> {
  const segments: Segment[] = [];
  for await (const point of points) segments.push(segment(axes, point, options.speed));
  const attemptWith = (context: CallContext) => {
    const messages = requestsOf(session.device, context, segments);
    return (timeoutMs: number, signals: Signals): Promise<MotionMessage | Failure> => {
      const call = session.connection.stream(StageService.method.runPath, signals, timeoutMs);
      for (const message of messages) call.send(message);
      call.end();
      return startedBy(call);
    };
  };
  const patienceMs = (segments.length / SEGMENTS_PER_S) * 1000;
  const sent = { leaseToken: session.token, patienceMs, signal: options.signal };
  return new Motion(session, await session.connection.actBy(attemptWith, sent));
}

function requestsOf(device: string, context: CallContext, segments: readonly Segment[]): RunPathRequest[] {
  const header = create(RunPathRequestSchema, { part: { case: "header", value: { context, device } } });
  return [
    header,
    ...segments.map((value) => create(RunPathRequestSchema, { part: { case: "segment" as const, value } })),
  ];
}

/** Returns the motion once it has started. The path continues without the call. */
async function startedBy({
  answers,
}: Exchange<typeof RunPathRequestSchema, typeof RunPathResponseSchema>): Promise<MotionMessage | Failure> {
  for (;;) {
    const answer = await answers.next();
    if (answer instanceof Failure) return answer;
    if (answer === "ended") throw new Error("the daemon ended a path without its motion");
    if (answer.change.case !== "motion") continue;
    answers.cancel();
    return answer.change.value;
  }
}
