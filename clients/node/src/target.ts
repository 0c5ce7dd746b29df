import { randomUUID } from "node:crypto";
import { existsSync, readFileSync } from "node:fs";

import { ChannelCredentials, type ChannelOptions, credentials, Metadata } from "@grpc/grpc-js";

const SYSTEM_SOCKET = "/run/axisgate/axisgate.sock";
const PORT = 50203;
const TLS_PORT = 50204;
const SCHEMES = ["unix:", "dns:", "ipv4:", "ipv6:"];
const LOOPBACK = /^(?:ipv[46]:|dns:\/*)?(?:localhost|127\.[0-9.]+|\[::1\]|::1)(?::\d+)?$/;

/** Session of this process: the daemon treats all of its connections as one program. */
export const SESSION = randomUUID();

/** Options of every channel. Nothing that moves is repeated by gRPC itself. */
export const OPTIONS: ChannelOptions = {
  "grpc.enable_retries": 0,
  "grpc.service_config_disable_resolution": 1,
  "grpc.use_local_subchannel_pool": 1,
  // A proxy would receive the token of a plaintext call.
  "grpc.enable_http_proxy": 0,
  "grpc.initial_reconnect_backoff_ms": 250,
  "grpc.max_reconnect_backoff_ms": 1000,
  // The connection for stops stays open, however long it is not used.
  "grpc.client_idle_timeout_ms": 2 ** 31 - 1,
  "grpc.keepalive_time_ms": 20_000,
  "grpc.keepalive_timeout_ms": 10_000,
  "grpc.keepalive_permit_without_calls": 1,
};

/** Address of a daemon, and the caller's credentials. */
export interface TargetOptions {
  /** Path of a Unix socket, or HOST[:PORT]. Undefined: $AXISGATE_TARGET, or the local daemon. */
  target?: string | undefined;
  /** Token of the caller. Undefined: $AXISGATE_TOKEN. */
  token?: string | undefined;
  /** File with the authority of the daemon's certificate, for TLS. Undefined: $AXISGATE_CA. */
  ca?: string | undefined;
  /** File with the caller's certificate. Undefined: $AXISGATE_CERTIFICATE. */
  certificate?: string | undefined;
  /** File with the key of the certificate. Undefined: $AXISGATE_KEY. */
  key?: string | undefined;
}

type Environment = Readonly<Record<string, string | undefined>>;

/** A Target is the daemon's address in gRPC's form, with what identifies the caller. */
export class Target {
  readonly #token: string;

  constructor(
    readonly address: string,
    token: string,
    private readonly files: { ca: string; certificate: string; key: string },
    private readonly session: string,
  ) {
    this.#token = token;
    if (token && !this.tls && !this.isLocal) {
      throw new TypeError(`the token is not sent unencrypted to ${address}: give ca, or set AXISGATE_CA`);
    }
  }

  /** True if the daemon runs on this machine. */
  get isLocal(): boolean {
    return this.address.startsWith("unix:") || LOOPBACK.test(this.address);
  }

  /** Returns the metadata of a call. */
  metadata(): Metadata {
    const metadata = new Metadata();
    metadata.set("axisgate-session", this.session);
    if (this.#token) metadata.set("authorization", `Bearer ${this.#token}`);
    return metadata;
  }

  /** Returns the credentials of a connection. Throws if a file is unreadable. */
  credentials(): ChannelCredentials {
    if (!this.tls) return credentials.createInsecure();
    const { ca, certificate, key } = this.files;
    return credentials.createSsl(contentOf(ca), contentOf(key), contentOf(certificate));
  }

  private get tls(): boolean {
    return usesTls(this.files);
  }
}

function usesTls(files: { ca: string; certificate: string }): boolean {
  return files.ca !== "" || files.certificate !== "";
}

function contentOf(path: string): Buffer | null {
  return path ? readFileSync(path) : null;
}

/**
 * Returns the target that the options name. An option that is undefined comes from the environment.
 *
 * Throws TypeError if certificate and key do not come together, or a token would be sent unencrypted to another machine.
 */
export function resolve(options: TargetOptions, environment: Environment = process.env, session = SESSION): Target {
  const chosen = (option: string | undefined, variable: string): string => option ?? environment[variable] ?? "";
  const files = {
    ca: chosen(options.ca, "AXISGATE_CA"),
    certificate: chosen(options.certificate, "AXISGATE_CERTIFICATE"),
    key: chosen(options.key, "AXISGATE_KEY"),
  };
  if ((files.certificate === "") !== (files.key === "")) {
    throw new TypeError("certificate and key must be given together");
  }
  const address = addressOf(chosen(options.target, "AXISGATE_TARGET"), usesTls(files), environment);
  return new Target(address, chosen(options.token, "AXISGATE_TOKEN"), files, session);
}

function addressOf(target: string, tls: boolean, environment: Environment): string {
  if (!target) return `unix:${defaultSocket(environment)}`;
  if (target.startsWith("unix-abstract:")) throw new TypeError("grpc-js cannot connect to abstract sockets");
  if (SCHEMES.some((scheme) => target.startsWith(scheme))) return target;
  if (target.includes("/") || target.endsWith(".sock")) return `unix:${target}`;
  return withPort(target, tls ? TLS_PORT : PORT);
}

function withPort(host: string, port: number): string {
  const bracketed = host.startsWith("[");
  const colons = host.split(":").length - 1;
  if (bracketed ? !host.endsWith("]") : colons === 1) return host;
  return !bracketed && colons > 0 ? `[${host}]:${String(port)}` : `${host}:${String(port)}`;
}

function defaultSocket(environment: Environment): string {
  if (environment["AXISGATE_SOCKET"]) return environment["AXISGATE_SOCKET"];
  const user = process.geteuid?.() ?? 0;
  if (user === 0 || existsSync(SYSTEM_SOCKET)) return SYSTEM_SOCKET;
  const runtime = environment["XDG_RUNTIME_DIR"];
  return runtime ? `${runtime}/axisgate.sock` : `/tmp/axisgate-${String(user)}/axisgate.sock`;
}
