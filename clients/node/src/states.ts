import { create } from "@bufbuild/protobuf";

import {
  DeviceService,
  type WatchDeviceRequest,
  WatchDeviceRequestSchema,
  type WatchDeviceResponse,
  type WatchDeviceResponseSchema,
} from "./gen/axisgate/v1/device_pb.js";
import { duration } from "./requests.js";
import { type DeviceSession, received, type WaitOptions } from "./session.js";
import { type Status, statusOf } from "./state.js";
import { ResumingStream } from "./stream.js";

const INTERVAL_MS = 50;

/** Options of Stage.watch(). */
export interface WatchOptions extends WaitOptions {
  /** Minimum time between two states. Undefined: 50 ms. */
  minIntervalMs?: number | undefined;
}

/** States is the iterator of Stage.watch(). */
export class States extends ResumingStream<Status, typeof WatchDeviceRequestSchema, typeof WatchDeviceResponseSchema> {
  private readonly watch: WatchDeviceRequest;

  constructor(session: DeviceSession, options: WatchOptions) {
    super(session.connection, DeviceService.method.watchDevice, options.signal);
    const minInterval = duration(options.minIntervalMs ?? INTERVAL_MS);
    this.watch = create(WatchDeviceRequestSchema, { device: session.device, minInterval });
  }

  protected override request(): WatchDeviceRequest {
    return this.watch;
  }

  protected override take(answer: WatchDeviceResponse): Status {
    return statusOf(received(answer.device));
  }
}
