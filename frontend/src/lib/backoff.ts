/** Waiting times between attempts to connect: longer each time, with a random share. */
export class Backoff {
  #attempts = 0;

  constructor(
    private readonly shortest = 500,
    private readonly longest = 15_000,
    private readonly random: () => number = Math.random,
  ) {}

  /** Return the milliseconds until the next attempt. */
  next(): number {
    const most = Math.min(this.longest, this.shortest * 2 ** this.#attempts);
    this.#attempts += 1;
    return most * (0.5 + this.random() / 2);
  }

  /** Begin with a short wait again, after a success. */
  reset(): void {
    this.#attempts = 0;
  }
}
