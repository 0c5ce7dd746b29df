import { create } from "@bufbuild/protobuf";

import {
  DeletePositionRequestSchema,
  ListPositionsRequestSchema,
  MoveToPositionRequestSchema,
  PositionKind,
  PositionService,
  SavePositionRequestSchema,
} from "./gen/axisgate/v1/position_pb.js";
import { byAxis, positionOf, type Positions, type Result } from "./results.js";
import type { DeviceSession, WaitOptions } from "./session.js";

// Time that saving may wait for the end of a running motion.
const WAIT_MS = 20_000;

/** Places are the saved positions of a stage, by name. All functions reject with Refused. */
export class Places {
  constructor(private readonly session: DeviceSession) {}

  /**
   * Saves the present position. The position stays the same place when coordinates are set again, or with `coordinates`
   * the same coordinates.
   */
  async save(name: string, options: WaitOptions & { coordinates?: boolean } = {}): Promise<void> {
    const kind = options.coordinates ? PositionKind.COORDINATES : PositionKind.PLACE;
    const request = create(SavePositionRequestSchema, { position: this.resource(name), kind });
    const sent = { patienceMs: WAIT_MS, signal: options.signal };
    await this.session.act(PositionService.method.savePosition, request, sent);
  }

  /** Moves all axes to a saved position, and waits for the outcome. An aborted signal cancels the move. */
  moveTo(name: string, options: WaitOptions = {}): Promise<Result> {
    const request = create(MoveToPositionRequestSchema, { position: this.resource(name) });
    return this.session.finish(PositionService.method.moveToPosition, request, options.signal);
  }

  /** Deletes a saved position. */
  async delete(name: string): Promise<void> {
    const request = create(DeletePositionRequestSchema, { position: this.resource(name) });
    await this.session.act(PositionService.method.deletePosition, request);
  }

  /** Returns the saved positions by name, with the positions of the axes when they were saved. */
  async read(options: WaitOptions = {}): Promise<ReadonlyMap<string, Positions>> {
    const request = create(ListPositionsRequestSchema, { device: this.session.device });
    const { positions } = await this.session.connection.ask(PositionService.method.listPositions, request, options);
    return new Map(
      positions.map((one) => [
        one.name.slice(one.name.lastIndexOf("/") + 1),
        byAxis(one.coordinates.map((at) => positionOf(at, at.axis, at.pulses))),
      ]),
    );
  }

  private resource(name: string): string {
    return `${this.session.device}/positions/${name}`;
  }
}
