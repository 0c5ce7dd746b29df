/** Returns the name of an enum's number, or for a number of a newer daemon its kind and the number: "REASON 99". */
export function nameOf(names: Readonly<Record<number, string | undefined>>, number: number, kind: string): string {
  return names[number] ?? `${kind} ${String(number)}`;
}

/** Returns "stage" for "devices/stage". */
export function shortName(device: string): string {
  return device.replace(/^devices\//, "");
}

/** Returns the configured name of an axis, or its number as text. */
export function axisName(axis: { name: string }, number: number): string {
  return axis.name || String(number);
}
