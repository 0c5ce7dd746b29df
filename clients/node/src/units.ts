import { inspect } from "node:util";

/**
 * A decimal text or a bigint is exact: the daemon refuses an amount that is not a whole number of pulses. A number
 * becomes the nearest whole number of pulses, and the result of the motion has the position.
 */
export type Amount = string | number | bigint;

/** Unit of a distance. `pulses` are drive pulses, the smallest steps of an axis. */
export type Unit = "nm" | "um" | "mm" | "deg" | "pulses";

const DECIMAL = /^[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?$/;

function checked(value: unknown): Amount {
  if (typeof value === "bigint") return value;
  if (typeof value === "number") {
    if (Number.isFinite(value)) return value;
    throw new RangeError(`${String(value)} is not an amount: it must be a finite number`);
  }
  if (typeof value !== "string") throw new TypeError(`${inspect(value)} is not an amount`);
  const text = value.trim();
  if (!DECIMAL.test(text)) throw new RangeError(`"${value}" is not a decimal number`);
  return text;
}

/** A Distance is a position or a displacement: an amount with its unit, as in `mm("1.5")`. It is immutable. */
export class Distance {
  readonly value: Amount;
  readonly unit: Unit;

  /** Throws RangeError if the amount is not a finite number or not a decimal text. */
  constructor(value: Amount, unit: Unit) {
    this.value = checked(value);
    this.unit = unit;
  }

  /** The speed of this distance in each second: `mm(2).perSecond`. */
  get perSecond(): Speed {
    return new Speed(this);
  }

  toString(): string {
    return `${String(this.value)} ${this.unit}`;
  }

  [inspect.custom](): string {
    return this.toString();
  }
}

/** A Speed is a distance in each second. A jog in the minus direction has a negative speed. It is immutable. */
export class Speed {
  constructor(readonly distance: Distance) {}

  toString(): string {
    return `${this.distance.toString()}/s`;
  }

  [inspect.custom](): string {
    return this.toString();
  }
}

/** Returns a distance in nanometres. */
export const nm = (value: Amount): Distance => new Distance(value, "nm");
/** Returns a distance in micrometres. */
export const um = (value: Amount): Distance => new Distance(value, "um");
/** Returns a distance in millimetres. */
export const mm = (value: Amount): Distance => new Distance(value, "mm");
/** Returns an angle in degrees, for rotary axes. */
export const deg = (value: Amount): Distance => new Distance(value, "deg");
/** Returns a distance in drive pulses. */
export const pulses = (value: Amount): Distance => new Distance(value, "pulses");
