/** Signals of which each ends an operation. */
export type Signals = readonly AbortSignal[];

/** Throws the reason of a signal that was aborted. */
export function throwIfAborted(signals: Signals): void {
  for (const signal of signals) signal.throwIfAborted();
}

/** Calls `act` once a signal is aborted. Returns a function that ends the waiting. */
export function whenAborted(signals: Signals, act: (reason: Error) => void): () => void {
  const end = (): void => {
    for (const signal of signals) signal.removeEventListener("abort", aborted);
  };
  const aborted = (event: Event): void => {
    end();
    act((event.target as AbortSignal).reason as Error);
  };
  for (const signal of signals) signal.addEventListener("abort", aborted);
  return end;
}

/** Waits. Rejects with the reason of a signal that is aborted before. */
export function sleep(ms: number, signals: Signals): Promise<void> {
  return new Promise((resolve, reject) => {
    throwIfAborted(signals);
    const timer = setTimeout(() => {
      end();
      resolve();
    }, ms);
    const end = whenAborted(signals, (reason) => {
      clearTimeout(timer);
      reject(reason);
    });
  });
}
