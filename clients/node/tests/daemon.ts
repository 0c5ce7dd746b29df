// A daemon with a simulated stage, and a relay that cuts its connections. AXISGATE_BIN has the programs.
import assert from "node:assert/strict";
import { type ChildProcess, spawn } from "node:child_process";
import { existsSync, mkdtempSync, openSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createConnection, createServer, type Server, type Socket } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { TestContext } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { type ConnectOptions, Stage } from "axisgate";

const BIN = process.env["AXISGATE_BIN"] ?? join(import.meta.dirname, "../../../../build/bin");
const LIMIT_MS = 30_000;

/** Waits until `condition()` is true. */
export async function until(condition: () => boolean | Promise<boolean>, what: string): Promise<void> {
  const limit = performance.now() + LIMIT_MS;
  while (!(await condition())) {
    assert.ok(performance.now() < limit, `waited in vain: ${what}`);
    await sleep(20);
  }
}

/** The daemon of one test, and the simulator that it serves. */
export class Daemon {
  readonly folder = mkdtempSync(join(tmpdir(), "axisgate-node-"));
  readonly socket = join(this.folder, "axisgate.sock");
  private readonly control = join(this.folder, "control");
  private readonly config = join(this.folder, "axisgate.toml");
  private readonly tty = join(this.folder, "tty");
  private readonly simulator: ChildProcess;
  private process: ChildProcess | undefined;

  private constructor(journal: boolean, more: string) {
    const words = ["--pty", this.tty, "--speed", "4", "--control", this.control];
    this.simulator = spawn(join(BIN, "shrc203-sim"), words, { stdio: "ignore" });
    writeFileSync(this.config, this.configuration(journal) + more);
  }

  /** Starts a daemon that ends with the test. */
  static async of(test: TestContext, { journal = true, more = "" } = {}): Promise<Daemon> {
    const daemon = new Daemon(journal, more);
    test.after(() => daemon.end());
    await until(() => existsSync(daemon.tty), "the simulator's terminal");
    await daemon.start();
    return daemon;
  }

  /** Restarts the daemon, whose controller then does not answer. */
  async restartWithoutController(): Promise<void> {
    this.simulator.kill("SIGSTOP");
    await this.kill();
    await this.start("gRPC on");
  }

  /** Starts the daemon again, and waits until its log has the text `ready`: its controller answers. */
  async start(ready = "stage: link is UP"): Promise<void> {
    const log = openSync(this.log, "w");
    const env = { ...process.env, STATE_DIRECTORY: join(this.folder, "state") };
    this.process = spawn(join(BIN, "axisgated"), ["--config", this.config], { stdio: ["ignore", log, log], env });
    await until(() => readFileSync(this.log, "utf8").includes(ready), "a ready daemon");
  }

  async kill(): Promise<void> {
    if (this.process !== undefined) await ended(this.process);
  }

  /** Does what a person at the simulated stage does, such as "unplug 3". */
  async atStage(action: string): Promise<void> {
    const person = createConnection(this.control);
    person.write(`${action}\n`);
    for await (const answer of person) {
      assert.match(String(answer), /^ok/);
      break;
    }
    person.destroy();
  }

  /** Connects for as long as the test lasts. */
  async connect(test: TestContext, options: ConnectOptions = {}): Promise<Stage> {
    const stage = await Stage.connect({ target: this.socket, ...options });
    test.after(() => {
      stage.close();
    });
    return stage;
  }

  /** Connects over TCP, whose callers are anonymous, as another program. */
  async connectAsOther(test: TestContext): Promise<Stage> {
    const target = /gRPC on (\S+) and/.exec(readFileSync(this.log, "utf8"))?.[1];
    const stage = await this.connect(test, { target });
    // The session of this process is replaced by one of its own.
    Object.assign((stage as unknown as { session: { connection: { target: object } } }).session.connection.target, {
      session: "another-program",
    });
    return stage;
  }

  private get log(): string {
    return join(this.folder, "log");
  }

  private async end(): Promise<void> {
    await this.kill();
    await ended(this.simulator);
    rmSync(this.folder, { recursive: true });
  }

  private configuration(journal: boolean): string {
    return `
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "${this.socket}"
[journal]
kept = ${String(journal)}
[[device]]
name = "stage"
connection = "serial"
path = "${this.tty}"
[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_minimum = "-15mm"
travel_maximum = "15mm"
[[device.axis]]
number = 2
name = "y"
unit = "mm"
`;
  }
}

async function ended(child: ChildProcess): Promise<void> {
  if (child.exitCode !== null || child.signalCode !== null) return;
  const exit = new Promise((resolve) => child.once("exit", resolve));
  child.kill("SIGKILL");
  await exit;
}

/** A Relay passes bytes between clients and the daemon, and cuts connections once the daemon answers. */
export class Relay {
  readonly socket: string;
  cuts = 0;
  private readonly server: Server;
  private readonly open = new Set<Socket>();
  private firstStream = 1;
  private left = 0;

  private constructor(private readonly upstream: string) {
    this.socket = `${upstream}.relay`;
    this.server = createServer((client) => {
      this.pass(client);
    });
  }

  static async of(test: TestContext, daemon: Daemon): Promise<Relay> {
    const relay = new Relay(daemon.socket);
    await new Promise<void>((resolve) => relay.server.listen(relay.socket, resolve));
    test.after(() => {
      relay.server.close();
      for (const socket of relay.open) socket.destroy();
    });
    return relay;
  }

  /**
   * Drops the answers to a stream of HTTP/2 (1, 3, 5, ... of each connection) and closes the connection. After the first
   * cut, the first answer on each new connection is dropped, `times` times in all.
   */
  cutAnswers(stream: number, times = 1): void {
    this.firstStream = stream;
    this.left = times;
  }

  private pass(client: Socket): void {
    const daemon = createConnection(this.upstream);
    const streamsIn = frameReader();
    const pair = [client, daemon];
    for (const end of pair) {
      this.open.add(end);
      end.on("error", () => undefined);
      end.on("close", () => {
        for (const one of pair) one.destroy();
      });
    }
    client.on("data", (data) => daemon.write(data));
    daemon.on("data", (data) => {
      if (this.isCut(streamsIn(data))) client.destroy();
      else client.write(data);
    });
  }

  private isCut(streams: readonly number[]): boolean {
    if (this.left === 0 || !streams.some((stream) => stream >= this.firstStream)) return false;
    this.cuts++;
    this.left--;
    this.firstStream = 1;
    return true;
  }
}

/** Returns a function that takes bytes of a daemon and returns the streams whose headers or data begin in them. */
function frameReader(): (data: Buffer) => number[] {
  let unread = Buffer.alloc(0);
  return (data) => {
    unread = Buffer.concat([unread, data]);
    const found: number[] = [];
    while (unread.length >= 9) {
      if (unread.readUInt8(3) <= 1) found.push(unread.readUInt32BE(5));
      const end = 9 + unread.readUIntBE(0, 3);
      if (unread.length < end) break;
      unread = unread.subarray(end);
    }
    return found;
  };
}
