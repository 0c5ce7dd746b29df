import { create } from "@bufbuild/protobuf";

import {
  ChangeSettingsRequestSchema,
  GetSettingsRequestSchema,
  type Settings as SettingsMessage,
  SettingService,
  SettingsSchema,
} from "./gen/axisgate/v1/settings_pb.js";
import { duration, optionalSpeed } from "./requests.js";
import { type DeviceSession, received, type WaitOptions } from "./session.js";
import type { Speed } from "./units.js";

// Time for which a change may wait for running commands.
const WAIT_MS = 20_000;

/** Changes to the settings of an axis. Undefined leaves a setting as it is. */
export interface AxisChange {
  motorOn?: boolean | undefined;
  closedLoop?: boolean | undefined;
  minimumSpeed?: Speed | undefined;
  maximumSpeed?: Speed | undefined;
  /** Time from the minimum to the maximum speed: whole milliseconds. */
  accelerationMs?: number | undefined;
}

/**
 * Settings of a stage. Speeds, outputs and the trigger that are set under a lease return to their values after it. All
 * functions reject with Refused.
 */
export class Settings {
  constructor(private readonly session: DeviceSession) {}

  /** Reads the settings from the controller, as the API's message. */
  async read(options: WaitOptions = {}): Promise<SettingsMessage> {
    const request = create(GetSettingsRequestSchema, { device: this.session.device });
    const { settings } = await this.session.connection.ask(SettingService.method.getSettings, request, options);
    return received(settings);
  }

  /** Changes settings of an axis. */
  async change(axis: string, change: AxisChange, options: WaitOptions = {}): Promise<void> {
    const speeds = {
      minimum: optionalSpeed(change.minimumSpeed),
      maximum: optionalSpeed(change.maximumSpeed),
      accelerationTime: change.accelerationMs === undefined ? undefined : duration(change.accelerationMs),
    };
    const isSpeed = Object.values(speeds).some((one) => one !== undefined);
    const { motorOn: excited, closedLoop } = change;
    const changed = { axis, excited, closedLoop, speeds: isSpeed ? speeds : undefined };
    await this.write(create(SettingsSchema, { axes: [changed] }), options);
  }

  /** Changes the settings that are set in the API's message, and no others. */
  async write(settings: SettingsMessage, options: WaitOptions = {}): Promise<void> {
    const request = create(ChangeSettingsRequestSchema, { device: this.session.device, settings });
    const sent = { patienceMs: WAIT_MS, signal: options.signal };
    await this.session.act(SettingService.method.changeSettings, request, sent);
  }
}
