'use strict';
// The rows of ../../README.md. Each function runs one row on one Api and throws if something was not as described.

const { setTimeout: sleep } = require('node:timers/promises');
const { expect, fail } = require('./api');

const STAGE = 'devices/stage';
const MILL = 'devices/mill';
const GZIP = 2;
const PING_MS = 1000;
const NOW = { max_age: { seconds: 0 } };

const rows = {};

function say(line) {
  process.stdout.write(`${line}\n`);
}

// More: max_age, where the state may not be older.
function getStage(api, more = {}) {
  return api.call('DeviceService.GetDevice', { device: STAGE, ...more });
}

function getCaller(api) {
  return api.call('AccessService.GetCaller', {});
}

function nextRevision(event) {
  return String(BigInt(event.revision) + 1n);
}

// A Watch checks that each event's revision is the one before, plus 1.
class Watch {
  constructor(api, request = { from_revision: 0 }, options = {}) {
    this.stream = api.read('EventService.Watch', request, options);
    this.last = null;
  }

  check(event) {
    if (this.last) expect('revision', event.revision, nextRevision(this.last));
    this.last = event;
    return event;
  }

  async next() {
    return this.check((await this.stream.message()).event);
  }

  async end(code) {
    for (const message of await this.stream.end(code)) this.check(message.event);
  }

  // Reads events until the motion has its outcome, which must be SUCCEEDED.
  async succeeded(name) {
    for (;;) {
      const { motion } = await this.next();
      if (motion?.name !== name) continue;
      if (motion.state === 'MOTION_STATE_SUCCEEDED') return;
      if (motion.end_time) fail(name, motion.state, 'MOTION_STATE_SUCCEEDED');
    }
  }
}

async function move(api, watch, nth = 0) {
  const distance = { um: nth % 2 === 0 ? '10' : '-10' };
  const request = { device: STAGE, relative: true, targets: [{ axis: '1', distance }] };
  const { motion } = await api.call('StageService.Move', request);
  await watch.succeeded(motion.name);
}

rows['unary-front'] = async (api) => {
  for (let n = 0; n < 200; n += 1) {
    const { device } = await getStage(api);
    expect('name', device.name, STAGE);
    expect('link', device.link, 'LINK_STATE_UP');
  }
  for (let n = 0; n < 200; n += 1) {
    const { devices } = await api.call('DeviceService.ListDevices', {});
    expect('devices', devices.map((device) => device.name).sort(), [MILL, STAGE]);
  }
  await api.call('DeviceService.GetDevice', { device: 'devices/none' }, { code: 'NOT_FOUND' });
};

rows['unary-grpc'] = async (api) => {
  for (let n = 0; n < 200; n += 1) {
    if (!(await getCaller(api)).caller?.name) fail('who', 'nothing', 'a name');
  }
  const { commands } = await api.call('CommandService.ListCommands', { device: STAGE });
  if (commands.length <= 50) fail('commands', commands.length, 'more than 50');
  await api.call('StageService.GetMotion', { motion: `${STAGE}/motions/999999999` }, { code: 'NOT_FOUND' });
};

rows.watch = async (api) => {
  const watch = new Watch(api);
  for (let n = 0; n < 3; n += 1) await move(api, watch, n);
  watch.stream.call.cancel();
  await watch.end('CANCELLED');
};

async function executeOnce(api) {
  const stream = api.read('CommandService.Execute', { device: STAGE, lines: ['*IDN?', 'Q:', '?:N'] });
  const messages = await stream.end('OK');
  expect('reply.line', messages.map(({ reply }) => reply?.line), [1, 2, 3]);
  if (messages.some(({ reply }) => !reply.answer)) fail('reply.answer', 'nothing', 'an answer');
}

rows.execute = async (api) => {
  for (let n = 0; n < 50; n += 1) await executeOnce(api);
  const refused = await api.read('CommandService.Execute', { device: STAGE, lines: ['QQ:'] }).end('INVALID_ARGUMENT');
  expect('messages of a refused Execute', refused.length, 0);
};

// Returns the header, and `text` cut into `count` pieces of almost equal length.
function jobRequests(text, count, title) {
  const bytes = Buffer.from(text);
  const cut = (n) => Math.floor((bytes.length * n) / count);
  const requests = Array.from({ length: count }, (_, n) => ({ data: bytes.subarray(cut(n), cut(n + 1)) }));
  return [{ header: { device: MILL, title, tool: 'T1' } }, ...requests];
}

async function sendJob(api) {
  const text = `^IN;!MC0;!PZ-50,200;${'PU4000,0;PU0,0;'.repeat(4000)}H;\n`;
  const { code, details, answer } = await api.send('MillService.SendJob', jobRequests(text, 64, 'interop'));
  if (code !== 'OK') fail('SendJob', `${code} ${details}`, 'OK');
  expect('job.bytes', answer.job.bytes, String(text.length));
  expect('job.title', answer.job.title, 'interop');
  await api.call('MillService.CancelJob', { job: answer.job.name });
}
rows['send-job'] = sendJob;

function axis2(speed, direction) {
  return [{ axis: '2', direction, speed: { pulses_per_s: speed } }];
}

// Begins a jog and returns its stream after an answer in state RUNNING.
async function beginJog(api) {
  const stream = api.converse('StageService.Jog');
  stream.call.write({ device: STAGE, axes: axis2(1000, 'DIRECTION_PLUS') });
  while ((await stream.message()).motion.state !== 'MOTION_STATE_RUNNING');
  return stream;
}

rows.jog = async (api) => {
  const stream = await beginJog(api);
  stream.call.write({ axes: axis2(2000) });
  stream.call.end();
  const answers = await stream.end('OK');
  expect('last state', answers.at(-1)?.motion.state ?? 'no answer', 'MOTION_STATE_SUCCEEDED');
};

rows['keep-lease'] = async (api) => {
  const terms = { axes: ['3'], time_to_live: { seconds: 10 } };
  const { lease } = await api.call('ControlService.AcquireLease', { device: STAGE, terms });
  expect('bytes of the token', lease.token.length, 24);
  const stream = api.converse('ControlService.KeepLeaseAlive');
  for (let n = 0; n < 10; n += 1) {
    stream.call.write({ device: STAGE, lease_token: lease.token });
    expect('lease.axes', (await stream.message()).lease.axes, [3]);
  }
  stream.call.end();
  expect('further answers', (await stream.end('OK')).length, 0);
  await api.call('ControlService.ReleaseLease', { device: STAGE, context: { lease_token: lease.token } });
};

// Makes a channel for each call: a channel no longer compresses once an answer of gRPC C++ came. The library splits
// that answer's "grpc-accept-encoding: identity, deflate, gzip" at the commas, and does not know " gzip".
rows.gzip = async (api) => {
  for (const call of [getStage, getCaller, executeOnce]) {
    for (let n = 0; n < 20; n += 1) {
      api.renew();
      await call(api);
    }
  }
  api.renew();
  await sendJob(api);
  say('note a channel for each call, since grpc-js stops compressing after an answer of gRPC C++');
};

rows.deadline = async (api) => {
  const begun = performance.now();
  await api.read('EventService.Watch', {}, { deadlineMs: 500 }).end('DEADLINE_EXCEEDED');
  const seconds = (performance.now() - begun) / 1000;
  if (seconds < 0.4 || seconds > 5) fail('end of Watch after', `${seconds} s`, '0.4 to 5 s');
  await getStage(api);
  await getCaller(api);
};

rows.cancel = async (api) => {
  const stream = await beginJog(api);
  stream.call.cancel();
  await stream.end('CANCELLED');
  const read = async () => (await sleep(50), (await getStage(api, NOW)).device.axes.find((axis) => axis.number === 2));
  const limit = performance.now() + 10000;
  while ((await read()).busy !== false) {
    if (performance.now() > limit) fail('axis 2 after the cancel', 'busy for 10 s', 'not busy');
  }
  const position = (await read()).position_pulses;
  if (position === undefined) fail('position_pulses', 'unset', 'a number');
  expect('second position_pulses', (await read()).position_pulses, position);
};

rows.keepalive = async (api) => {
  const watch = new Watch(api);
  await sleep(2.5 * PING_MS + 1000);
  await move(api, watch);
};

rows.metadata = async (api) => {
  const watch = new Watch(api);
  await watch.next();
  for (const [kib, code] of [[8, 'OK'], [15, 'OK'], [40, 'RESOURCE_EXHAUSTED']]) {
    const options = { metadata: { 'x-note': 'a'.repeat(kib * 1024) }, code };
    await api.call('AccessService.GetCaller', {}, options);
    await api.call('DeviceService.GetDevice', { device: STAGE }, options);
  }
  await move(api, watch);
};

rows.many = async (api) => {
  const watch = new Watch(api);
  const answered = Promise.all(Array.from({ length: 500 }, () => getStage(api)));
  // Node ends the process for a failure that nobody awaits yet.
  answered.catch(() => {});
  for (let n = 0; n < 10; n += 1) await move(api, watch, n);
  await answered;
};

rows.restart = async (api) => {
  const first = new Watch(api);
  await move(api, first);
  say('ready');
  await first.end('UNAVAILABLE');
  const revision = nextRevision(first.last);
  const request = { from_revision: revision, run: first.last.run };
  const second = new Watch(api, request, { waitForReady: true });
  expect('first revision after the restart', (await second.next()).revision, revision);
  while (second.last.fact !== 'daemon_started') await second.next();
  const limit = performance.now() + 30000;
  for (let link; (link = (await getStage(api)).device.link) !== 'LINK_STATE_UP'; await sleep(100)) {
    if (performance.now() > limit) fail('link 30 s after the restart', link, 'LINK_STATE_UP');
  }
};

rows['end-in-call'] = async (api) => {
  const titles = Array.from({ length: 40 }, (_, n) => `end-${n}`);
  let sent = 0;
  const sendAll = async () => {
    for (let title = titles.shift(); title; title = titles.shift()) {
      const requests = jobRequests('^IN;!MC0;PU0,0;H;\n', 4, title);
      const { code } = await api.send('MillService.SendJob', requests, { waitForReady: true });
      say(code === 'OK' ? `sent ${title}` : `failed ${title} ${code}`);
      if (code === 'OK' && (sent += 1) === 10) say('ready');
    }
  };
  await Promise.all([sendAll(), sendAll(), sendAll(), sendAll()]);
};

const channelOptions = {
  gzip: { 'grpc.default_compression_algorithm': GZIP },
  keepalive: {
    'grpc.keepalive_time_ms': PING_MS,
    'grpc.keepalive_timeout_ms': 2 * PING_MS,
    'grpc.keepalive_permit_without_calls': 1,
  },
};

module.exports = { rows, channelOptions };
