import {
  type DescMessage,
  type DescMethodBiDiStreaming,
  type DescMethodServerStreaming,
  type DescMethodUnary,
  fromBinary,
  type MessageShape,
  toBinary,
} from "@bufbuild/protobuf";
import {
  type CallOptions,
  Client,
  type ClientDuplexStream,
  type ClientReadableStream,
  type ServiceError,
} from "@grpc/grpc-js";

import { type Signals, throwIfAborted, whenAborted } from "./abort.js";
import { type Failure, failureOf } from "./outcomes.js";
import { OPTIONS, type Target } from "./target.js";

/** Call with one answer. */
export type Unary<I extends DescMessage, O extends DescMessage> = DescMethodUnary<I, O>;
/** Call with a stream of answers. */
export type Streaming<I extends DescMessage, O extends DescMessage> =
  DescMethodServerStreaming<I, O> | DescMethodBiDiStreaming<I, O>;

const asBytes = (content: Uint8Array): Buffer => Buffer.from(content);
const parserOf =
  <O extends DescMessage>(method: { output: O }) =>
  (content: Buffer): MessageShape<O> =>
    fromBinary(method.output, content);
const optionsOf = (timeoutMs: number | undefined): CallOptions =>
  timeoutMs === undefined ? {} : { deadline: Date.now() + timeoutMs };
const pathOf = (method: Unary<DescMessage, DescMessage> | Streaming<DescMessage, DescMessage>): string =>
  `/${method.parent.typeName}/${method.name}`;

/** A Channel is one connection to the daemon. It repeats nothing. */
export class Channel {
  private readonly client: Client;

  constructor(private readonly target: Target) {
    this.client = new Client(target.address, target.credentials(), OPTIONS);
  }

  /** Sends a request once. Resolves to the answer, or to the failure of the call. */
  unary<I extends DescMessage, O extends DescMessage>(
    method: Unary<I, O>,
    content: Uint8Array,
    timeoutMs: number,
    signals: Signals,
  ): Promise<MessageShape<O> | Failure> {
    return new Promise((resolve, reject) => {
      throwIfAborted(signals);
      const answered = (error: ServiceError | null, answer?: MessageShape<O>): void => {
        end();
        if (error !== null) resolve(failureOf(error));
        else if (answer !== undefined) resolve(answer);
      };
      const [metadata, options] = [this.target.metadata(), optionsOf(timeoutMs)];
      const call = this.client.makeUnaryRequest(
        pathOf(method),
        asBytes,
        parserOf(method),
        content,
        metadata,
        options,
        answered,
      );
      const end = whenAborted(signals, (reason) => {
        call.cancel();
        reject(reason);
      });
    });
  }

  /** Begins a call that streams answers to one request. `timeoutMs` is as for stream(). */
  watch<I extends DescMessage, O extends DescMessage>(
    method: DescMethodServerStreaming<I, O>,
    request: MessageShape<I>,
    signals: Signals,
    timeoutMs?: number,
  ): Answers<MessageShape<O>> {
    throwIfAborted(signals);
    const content = toBinary(method.input, request);
    const [metadata, options] = [this.target.metadata(), optionsOf(timeoutMs)];
    return new Answers(
      this.client.makeServerStreamRequest(pathOf(method), asBytes, parserOf(method), content, metadata, options),
      signals,
    );
  }

  /** Begins a call that streams both ways. `timeoutMs` is its deadline; undefined: it lasts as long as its caller says. */
  stream<I extends DescMessage, O extends DescMessage>(
    method: DescMethodBiDiStreaming<I, O>,
    signals: Signals,
    timeoutMs?: number,
  ): Exchange<I, O> {
    throwIfAborted(signals);
    const [metadata, options] = [this.target.metadata(), optionsOf(timeoutMs)];
    return new Exchange(
      method,
      this.client.makeBidiStreamRequest(pathOf(method), asBytes, parserOf(method), metadata, options),
      signals,
    );
  }

  /** Closes the connection once its calls have ended. */
  close(): void {
    this.client.close();
  }
}

/** Answers are the stream of answers of one call. They are read by one reader. */
export class Answers<T> {
  private end: Failure | "ended" | undefined;
  private begun = false;
  private wake: () => void = () => undefined;
  private readonly stopWaiting: () => void;

  constructor(
    private readonly call: ClientReadableStream<T>,
    private readonly signals: Signals,
  ) {
    call.on("metadata", () => {
      this.begun = true;
      this.wake();
    });
    call.on("readable", () => {
      this.wake();
    });
    call.on("end", () => {
      this.finish("ended");
    });
    call.on("error", (error: ServiceError) => {
      this.finish(failureOf(error));
    });
    this.stopWaiting = whenAborted(signals, () => {
      this.cancel();
    });
  }

  /** Waits until the daemon has begun the stream, or the call has failed, which next() then returns. */
  async started(): Promise<void> {
    while (!this.begun && this.end === undefined) await this.change();
  }

  /** Returns the next answer, the failure of the call, or "ended" if the daemon ended the stream. */
  async next(): Promise<T | Failure | "ended"> {
    for (;;) {
      throwIfAborted(this.signals);
      const answer = this.call.read() as T | null;
      if (answer !== null) return answer;
      if (this.end !== undefined) return this.end;
      await this.change();
    }
  }

  /** Ends the call. */
  cancel(): void {
    this.call.cancel();
    this.finish("ended");
  }

  private finish(end: Failure | "ended"): void {
    this.end ??= end;
    this.stopWaiting();
    this.wake();
  }

  private change(): Promise<void> {
    return new Promise((resolve) => {
      this.wake = resolve;
    });
  }
}

/** An Exchange is a call that streams requests and answers. */
export class Exchange<I extends DescMessage, O extends DescMessage> {
  readonly answers: Answers<MessageShape<O>>;

  constructor(
    private readonly method: DescMethodBiDiStreaming<I, O>,
    private readonly call: ClientDuplexStream<Uint8Array, MessageShape<O>>,
    signals: Signals,
  ) {
    this.answers = new Answers<MessageShape<O>>(call, signals);
  }

  /** Sends a request. */
  send(request: MessageShape<I>): void {
    this.call.write(toBinary(this.method.input, request));
  }

  /** Ends the requests; the answers continue. */
  end(): void {
    this.call.end();
  }
}
