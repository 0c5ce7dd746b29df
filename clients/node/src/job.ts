import { create } from "@bufbuild/protobuf";

import type { Signals } from "./abort.js";
import type { CallContext } from "./gen/axisgate/v1/common_pb.js";
import {
  type Job,
  type JobHeader,
  JobHeaderSchema,
  MillService,
  SendJobPieceRequestSchema,
} from "./gen/axisgate/v1/mill_pb.js";
import { Failure } from "./outcomes.js";
import { distance } from "./requests.js";
import type { DeviceSession, WaitOptions } from "./session.js";
import type { Distance } from "./units.js";

const PIECE_BYTES = 1 << 19;
// Bytes that are sent in a second at the least; the time for them is added to the limit of the request.
const BYTES_PER_S = 1_000_000;

/** Options of Mill.send(). */
export interface JobOptions extends WaitOptions {
  /** Text of 1 to 100 bytes. */
  title: string;
  /** Names of the tools, one for each part. */
  tools: readonly string[];
  /** Name of a configured origin. Undefined: the origin set at the panel. */
  origin?: string | undefined;
  /** Warnings of the check that are accepted. */
  acceptedWarnings?: readonly string[] | undefined;
  /** Size of the workpiece. */
  stock?: { x: Distance; y: Distance; z: Distance } | undefined;
}

/** Puts a job into the queue of a mill. See Mill.send(). */
export async function sendJob(session: DeviceSession, parts: readonly Uint8Array[], options: JobOptions): Promise<Job> {
  const header = headerOf(session.device, parts, options);
  const content = Buffer.concat(parts);
  const attemptWith = (context: CallContext) => {
    header.context = context;
    return (timeoutMs: number, signals: Signals): Promise<Job | Failure> =>
      sendPieces(session, header, content, timeoutMs, signals);
  };
  const patienceMs = (content.length / BYTES_PER_S) * 1000;
  return session.connection.actBy(attemptWith, { leaseToken: session.token, patienceMs, signal: options.signal });
}

function headerOf(device: string, parts: readonly Uint8Array[], options: JobOptions): JobHeader {
  const { title, tools, origin = "", acceptedWarnings = [], stock } = options;
  if (parts.length === 0 || parts.length !== tools.length) {
    throw new RangeError(`there are ${String(tools.length)} tools for ${String(parts.length)} parts of the job`);
  }
  return create(JobHeaderSchema, {
    device,
    title,
    origin,
    acceptedWarnings: [...acceptedWarnings],
    parts: parts.map((part, at) => ({ tool: tools[at] ?? "", bytes: BigInt(part.length) })),
    stock: stock && { x: distance(stock.x), y: distance(stock.y), z: distance(stock.z) },
  });
}

/** Sends the job from the byte on that the daemon does not have yet. */
async function sendPieces(
  session: DeviceSession,
  header: JobHeader,
  content: Uint8Array,
  timeoutMs: number,
  signals: Signals,
): Promise<Job | Failure> {
  for (let at = 0; ;) {
    const data = content.subarray(at, at + PIECE_BYTES);
    const last = at + data.length === content.length;
    const piece = create(SendJobPieceRequestSchema, { header, offset: BigInt(at), data, last });
    const answer = await session.connection.once(MillService.method.sendJobPiece, piece)(timeoutMs, signals);
    if (answer instanceof Failure) return answer;
    if (answer.job !== undefined) return answer.job;
    at = Number(answer.received);
  }
}
