import { debuglog } from "node:util";

/** A Logger receives the calls of this package as text: each call at `debug`, and what needs attention at `warn`. */
export interface Logger {
  debug(text: string): void;
  warn(text: string): void;
}

const log = debuglog("axisgate");

/** Logger that writes to the standard error output if the environment has NODE_DEBUG=axisgate. */
export const DEFAULT_LOGGER: Logger = {
  debug: (text) => {
    log("%s", text);
  },
  warn: (text) => {
    log("warning: %s", text);
  },
};
