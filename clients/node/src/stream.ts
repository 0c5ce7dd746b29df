import type { DescMessage, DescMethodServerStreaming, MessageShape } from "@bufbuild/protobuf";
import { status } from "@grpc/grpc-js";

import { sleep } from "./abort.js";
import type { Answers } from "./channel.js";
import type { Connection } from "./connection.js";
import { errorOf, Failure } from "./outcomes.js";
import { Backoff } from "./repeat.js";

/**
 * A ResumingStream is an iterator over the answers to a request, which is sent again after a broken connection.
 *
 * The iteration ends at `break`, or with close(). An aborted signal makes it reject. It has one reader at a time.
 */
export abstract class ResumingStream<T, I extends DescMessage, O extends DescMessage> {
  private readonly backoff = new Backoff();
  private answers: Answers<MessageShape<O>> | undefined;
  private closed = false;

  constructor(
    private readonly connection: Connection,
    private readonly method: DescMethodServerStreaming<I, O>,
    private readonly signal: AbortSignal | undefined,
  ) {}

  /** Returns the request for all answers that were not received yet. */
  protected abstract request(): MessageShape<I>;

  /** Returns the item of an answer. */
  protected abstract take(answer: MessageShape<O>): T;

  /** Returns the item for answers that can no longer be received. Undefined: the failure is another one. */
  protected skip(_failure: Failure): T | undefined {
    return undefined;
  }

  [Symbol.asyncIterator](): this {
    return this;
  }

  /** Returns the next item. */
  async next(): Promise<IteratorResult<T, undefined>> {
    while (!this.isClosed()) {
      const answer = await (this.answers ??= this.begin()).next();
      if (this.isClosed()) break;
      const item = answer instanceof Failure || answer === "ended" ? await this.resume(answer) : this.received(answer);
      if (item !== undefined) return { done: false, value: item };
    }
    return { done: true, value: undefined };
  }

  /** Ends the iteration. */
  close(): void {
    this.closed = true;
    this.answers?.cancel();
  }

  /** Ends the iteration, at `break`. */
  return(): Promise<IteratorResult<T, undefined>> {
    this.close();
    return Promise.resolve({ done: true, value: undefined });
  }

  [Symbol.asyncDispose](): Promise<void> {
    this.close();
    return Promise.resolve();
  }

  protected begin(): Answers<MessageShape<O>> {
    this.answers = this.connection.watch(this.method, this.request(), this.connection.with(this.signal));
    return this.answers;
  }

  private isClosed(): boolean {
    return this.closed;
  }

  private received(answer: MessageShape<O>): T {
    this.backoff.reset();
    return this.take(answer);
  }

  /** Begins the call again. Returns the item for what was missed. */
  private async resume(end: Failure | "ended"): Promise<T | undefined> {
    const failure = end === "ended" ? new Failure(status.UNAVAILABLE, "the stream has ended") : end;
    const item = this.skip(failure);
    if (item === undefined) {
      if (!failure.passing && failure.reason !== "QUEUE_FULL") throw errorOf(failure, this.connection.target.address);
      await sleep(this.backoff.pause(), this.connection.with(this.signal));
    }
    if (this.isClosed()) return undefined;
    await this.begin().started();
    return item;
  }
}
