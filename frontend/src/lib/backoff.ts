/** How long to wait before the next attempt: longer each time, and never the same for all. */
export class Backoff {
  #attempts = 0;

  constructor(
    private readonly shortest = 500,
    private readonly longest = 15_000,
    private readonly random: () => number = Math.random,
  ) {}

  /** Milliseconds to wait. */
  next(): number {
    const most = Math.min(this.longest, this.shortest * 2 ** this.#attempts);
    this.#attempts += 1;
    return most * (0.5 + this.random() / 2);
  }

  /** It has worked: the next wait is short again. */
  reset(): void {
    this.#attempts = 0;
  }
}
