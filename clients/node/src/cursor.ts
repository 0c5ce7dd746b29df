import { create } from "@bufbuild/protobuf";

import { type Event, type WatchRequest, WatchRequestSchema } from "./gen/axisgate/v1/event_pb.js";
import type { Failure } from "./outcomes.js";

/** A Cursor knows the first event that a watcher has not received yet. It does not send. */
export class Cursor {
  /**
   * `first` is the revision of that event. 0: all kept events. `run` is the run to which the revision belongs, or empty.
   */
  constructor(
    private readonly device: string,
    private first: bigint,
    private run: string,
  ) {}

  /** Returns the request for all events from here on. */
  request(): WatchRequest {
    return create(WatchRequestSchema, { device: this.device, run: this.run, fromRevision: this.first });
  }

  /** Moves past an event. */
  take(event: Event): void {
    this.first = event.revision + 1n;
    this.run = event.run;
  }

  /** Returns the revision at which watching continues because earlier events are no longer kept. Undefined: no gap. */
  gapAfter(failure: Failure): bigint | undefined {
    const resume = failure.reason === "COMPACTED" ? failure.problem?.metadata["resume_revision"] : undefined;
    if (resume === undefined) return undefined;
    this.first = BigInt(resume);
    this.run = "";
    return this.first;
  }
}
