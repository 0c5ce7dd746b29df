'use strict';
// Calls of one channel, counted, with checks that say what was seen and what was expected.

const fs = require('node:fs');
const path = require('node:path');
const { isDeepStrictEqual } = require('node:util');
const grpc = require('@grpc/grpc-js');
const loader = require('@grpc/proto-loader');

const CALL_MS = 30000;
const PROTO = path.join(__dirname, 'proto');

function loadServices() {
  const files = fs.readdirSync(path.join(PROTO, 'axisgate/v1')).map((name) => `axisgate/v1/${name}`);
  const options = { includeDirs: [PROTO], keepCase: true, longs: String, enums: String, defaults: true, oneofs: true };
  return loader.loadSync(files, options);
}

function fail(what, seen, expected) {
  const text = (value) => (typeof value === 'string' ? value : JSON.stringify(value));
  throw new Error(`${what}: seen ${text(seen)}, expected ${text(expected)}`.replace(/\s+/g, ' '));
}

function expect(what, seen, expected) {
  if (!isDeepStrictEqual(seen, expected)) fail(what, seen, expected);
}

function codeOf(status) {
  return grpc.status[status.code];
}

// A Stream reads the messages of one streaming call in their order.
class Stream {
  constructor(name, call) {
    this.name = name;
    this.call = call;
    this.messages = [];
    this.status = null;
    this.wake = () => {};
    call.on('data', (message) => {
      this.messages.push(message);
      this.wake();
    });
    // The status repeats the error.
    call.on('error', () => {});
    const ended = new Promise((resolve) => call.on('end', resolve));
    call.on('status', (status) => ended.then(() => {
      this.status = status;
      this.wake();
    }));
  }

  // Returns the next message, or null if the call has ended.
  async next() {
    while (this.messages.length === 0 && !this.status) {
      await new Promise((resolve) => { this.wake = resolve; });
    }
    return this.messages.shift() ?? null;
  }

  said() {
    return `${codeOf(this.status)} ${this.status.details}`;
  }

  // Returns the next message. Throws if the call has ended.
  async message() {
    const message = await this.next();
    if (!message) fail(this.name, `end with ${this.said()}`, 'a message');
    return message;
  }

  // Reads to the end of the call and returns the messages. Throws if the call does not end with `code`.
  async end(code) {
    const messages = [];
    for (let message = await this.next(); message; message = await this.next()) messages.push(message);
    if (codeOf(this.status) !== code) fail(`end of ${this.name}`, this.said(), code);
    return messages;
  }
}

// Returns what a callback for an answer needs: the callback, and a promise of { code, details, answer }.
function settle() {
  let callback;
  const settled = new Promise((resolve) => {
    callback = (error, answer) => {
      resolve(error ? { code: codeOf(error), details: error.details } : { code: 'OK', details: '', answer });
    };
  });
  return [callback, settled];
}

// An Api makes calls on one channel. Methods are named "DeviceService.GetDevice".
class Api {
  constructor(target, channelOptions = {}) {
    this.calls = 0;
    this.services = loadServices();
    this.target = target;
    this.credentials = grpc.credentials.createInsecure();
    this.channelOptions = { 'grpc.enable_http_proxy': 0, ...channelOptions };
    this.renew();
  }

  // Makes another channel. The library gives all of them the same connection.
  renew() {
    this.client = new grpc.Client(this.target, this.credentials, this.channelOptions);
  }

  // Returns the arguments of a call before and after its request. `options`: deadlineMs, waitForReady, metadata.
  prepare(name, options) {
    const [service, method] = name.split('.');
    const { path: route, requestSerialize, responseDeserialize } = this.services[`axisgate.v1.${service}`][method];
    const metadata = new grpc.Metadata({ waitForReady: options.waitForReady ?? false });
    for (const [key, value] of Object.entries(options.metadata ?? {})) metadata.set(key, value);
    const deadline = Date.now() + (options.deadlineMs ?? CALL_MS);
    this.calls += 1;
    return [[route, requestSerialize, responseDeserialize], [metadata, { deadline }]];
  }

  // Returns the answer of a unary call. Throws if the call does not end with `code`.
  async call(name, request, { code = 'OK', ...options } = {}) {
    const [method, rest] = this.prepare(name, options);
    const [callback, settled] = settle();
    this.client.makeUnaryRequest(...method, request, ...rest, callback);
    const seen = await settled;
    if (seen.code !== code) fail(name, `${seen.code} ${seen.details}`, code);
    return seen.answer;
  }

  // Begins a call whose answer is a stream.
  read(name, request, options = {}) {
    const [method, rest] = this.prepare(name, options);
    return new Stream(name, this.client.makeServerStreamRequest(...method, request, ...rest));
  }

  // Begins a call with streams in both directions.
  converse(name) {
    const [method, rest] = this.prepare(name, {});
    return new Stream(name, this.client.makeBidiStreamRequest(...method, ...rest));
  }

  // Sends a stream of requests and returns { code, details, answer }.
  send(name, requests, options = {}) {
    const [method, rest] = this.prepare(name, options);
    const [callback, settled] = settle();
    const call = this.client.makeClientStreamRequest(...method, ...rest, callback);
    for (const request of requests) call.write(request);
    call.end();
    return settled;
  }
}

module.exports = { Api, expect, fail };
