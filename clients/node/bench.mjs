#!/usr/bin/env node
// Compares calls through the package with the same messages through a generated client. The daemon is at
// AXISGATE_TARGET, an address of gRPC without TLS. Moves the first axis of its only stage by single pulses, and prints
// the medians in microseconds:
//
//     ../conformance/example.py ./bench.mjs
import { Buffer } from "node:buffer";
import { randomUUID } from "node:crypto";

import { create, fromBinary, toBinary } from "@bufbuild/protobuf";
import { durationFromMs, timestampFromMs } from "@bufbuild/protobuf/wkt";
import { Client, credentials, Metadata } from "@grpc/grpc-js";

import { pulses, Stage } from "axisgate";
import {
  DeviceService,
  GetDeviceRequestSchema,
  ListDevicesRequestSchema,
  MoveRequestSchema,
  StageService,
  WaitMotionRequestSchema,
} from "axisgate/v1";

const READINGS = 300;
const MOVES = 60;
const WARM_UP = 20;
const TIMEOUT_MS = 10_000;

/** The calls of a program without the package. */
class Bare {
  constructor(target, device, axis) {
    this.client = new Client(target, credentials.createInsecure());
    this.metadata = new Metadata();
    this.metadata.set("axisgate-session", randomUUID());
    this.device = device;
    this.axis = axis;
  }

  send(method, request, timeoutMs = TIMEOUT_MS) {
    return new Promise((resolve, reject) => {
      this.client.makeUnaryRequest(
        `/${method.parent.typeName}/${method.name}`,
        (message) => Buffer.from(toBinary(method.input, message)),
        (content) => fromBinary(method.output, content),
        request,
        this.metadata,
        { deadline: Date.now() + timeoutMs },
        (error, answer) => (error ? reject(error) : resolve(answer)),
      );
    });
  }

  getDevice() {
    return this.send(DeviceService.method.getDevice, create(GetDeviceRequestSchema, { device: this.device }));
  }

  async move(step) {
    const listed = await this.send(DeviceService.method.listDevices, create(ListDevicesRequestSchema));
    const request = create(MoveRequestSchema, {
      context: {
        requestId: randomUUID(),
        requestMemory: listed.requestMemory,
        notAfter: timestampFromMs(Date.now() + TIMEOUT_MS / 2),
      },
      device: this.device,
      relative: true,
      targets: [{ axis: this.axis, distance: { amount: { case: "pulses", value: step } } }],
    });
    let { motion } = await this.send(StageService.method.move, request);
    while (motion.endTime === undefined) {
      const wait = create(WaitMotionRequestSchema, { motion: motion.name, maxWait: durationFromMs(10_000) });
      ({ motion } = await this.send(StageService.method.waitMotion, wait, 15_000));
    }
  }
}

function medianOf(times) {
  const sorted = times.toSorted((one, other) => one - other);
  return Math.round((sorted[(sorted.length - 1) >> 1] + sorted[sorted.length >> 1]) / 2);
}

/**
 * Returns the medians of two calls in microseconds. They alternate, so that both see the same load. The argument of a call
 * is 1 and -1 in turn.
 */
async function medians(viaPackage, bare, count) {
  const times = { package_us: [], bare_us: [] };
  const calls = [
    ["package_us", viaPackage],
    ["bare_us", bare],
  ];
  for (let number = 0; number < WARM_UP + count; number++) {
    for (const [name, call] of number % 2 ? calls : calls.toReversed()) {
      const begun = performance.now();
      await call(number % 2 ? -1 : 1);
      if (number >= WARM_UP) times[name].push((performance.now() - begun) * 1000);
    }
  }
  return { package_us: medianOf(times.package_us), bare_us: medianOf(times.bare_us) };
}

const stage = await Stage.connect();
const [axis] = stage.axes;
const bare = new Bare(process.env["AXISGATE_TARGET"], `devices/${stage.name}`, String(axis.number));
const figures = {
  get_device: await medians(
    () => stage.status(),
    () => bare.getDevice(),
    READINGS,
  ),
  move: await medians(
    (step) => axis.moveBy(pulses(step)),
    (step) => bare.move(BigInt(step)),
    MOVES,
  ),
};
process.stdout.write(`${JSON.stringify(figures)}\n`);
bare.client.close();
stage.close();
