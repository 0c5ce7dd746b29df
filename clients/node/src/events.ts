import { timestampDate } from "@bufbuild/protobuf/wkt";

import { LIST } from "./connection.js";
import { Cursor } from "./cursor.js";
import { DeviceService } from "./gen/axisgate/v1/device_pb.js";
import {
  type Event as EventMessage,
  EventService,
  type WatchRequest,
  type WatchRequestSchema,
  type WatchResponse,
  type WatchResponseSchema,
} from "./gen/axisgate/v1/event_pb.js";
import type { Failure } from "./outcomes.js";
import { type DeviceSession, received, type WaitOptions } from "./session.js";
import { shortName } from "./names.js";
import { ResumingStream } from "./stream.js";

/** An Event is one fact about the device or the daemon. */
export class Event {
  readonly revision: bigint;
  readonly time: Date;
  /** Name of the device. Empty for an event of the daemon itself. */
  readonly device: string;
  /**
   * The fact: `case` is its kind, such as "motion", "stopRequested" or "condition", and `value` the API's message. `case`
   * is undefined for a fact of a newer daemon.
   */
  readonly fact: EventMessage["fact"];
  readonly run: string;

  constructor(message: EventMessage) {
    this.revision = message.revision;
    this.time = message.time ? timestampDate(message.time) : new Date(0);
    this.device = shortName(message.device);
    this.fact = message.fact;
    this.run = message.run;
  }
}

/** A Gap says that events were missed, because they are no longer kept. */
export class Gap {
  /** Watching continues at the event `resumeRevision`. */
  constructor(readonly resumeRevision: bigint) {}
}

/** Options of Stage.events(). */
export interface EventOptions extends WaitOptions {
  /** Event or revision after which the iteration begins. 0n: at the oldest kept event. Undefined: with new events. */
  since?: Event | bigint | undefined;
}

/** Events is the iterator of Stage.events(). */
export class Events extends ResumingStream<Event | Gap, typeof WatchRequestSchema, typeof WatchResponseSchema> {
  private constructor(
    session: DeviceSession,
    private readonly cursor: Cursor,
    signal: AbortSignal | undefined,
  ) {
    super(session.connection, EventService.method.watch, signal);
  }

  /** Begins to watch. */
  static async begin(session: DeviceSession, options: EventOptions): Promise<Events> {
    const events = new Events(session, await cursorOf(session, options), options.signal);
    await events.begin().started();
    return events;
  }

  protected override request(): WatchRequest {
    return this.cursor.request();
  }

  protected override take(answer: WatchResponse): Event {
    const event = received(answer.event);
    this.cursor.take(event);
    return new Event(event);
  }

  protected override skip(failure: Failure): Gap | undefined {
    const resume = this.cursor.gapAfter(failure);
    return resume === undefined ? undefined : new Gap(resume);
  }
}

/** Returns the place after `since`, or after all events until now. */
async function cursorOf({ connection, device }: DeviceSession, { since, signal }: EventOptions): Promise<Cursor> {
  if (since instanceof Event) return new Cursor(device, since.revision + 1n, since.run);
  if (since !== undefined) return new Cursor(device, since === 0n ? since : since + 1n, "");
  const { nextRevision, run } = await connection.ask(DeviceService.method.listDevices, LIST, { signal });
  return new Cursor(device, nextRevision, run);
}
