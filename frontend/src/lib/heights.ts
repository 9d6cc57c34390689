/** A line, by its key. */
interface Keyed {
  readonly key: string;
}

/** The heights of lines (pixels), measured or guessed. */
export class Heights {
  #known = new Map<string, number>();
  #total = 0;

  /** Keep the height of a line that the page has laid out. */
  measure(key: string, height: number): void {
    if (height <= 0) return;
    this.#total += height - (this.#known.get(key) ?? 0);
    this.#known.set(key, height);
  }

  /** Forget all heights: the page has another width. */
  clear(): void {
    this.#known.clear();
    this.#total = 0;
  }

  /** Return the height of the lines `from` to `to - 1`. */
  sum(lines: readonly Keyed[], from: number, to: number): number {
    let sum = 0;
    for (let index = from; index < to; index += 1) sum += this.#of(lines, index);
    return sum;
  }

  /** Return the indices of the first and the last line between two places (pixels from the first line's top). */
  between(lines: readonly Keyed[], top: number, bottom: number): { first: number; last: number } {
    const end = lines.length - 1;
    let first = 0;
    let under = this.#of(lines, 0);
    for (; first < end && under <= top; under += this.#of(lines, first)) first += 1;
    let last = first;
    for (; last < end && under < bottom; under += this.#of(lines, last)) last += 1;
    return { first, last };
  }

  #of(lines: readonly Keyed[], index: number): number {
    const average = this.#known.size > 0 ? this.#total / this.#known.size : 48;
    return this.#known.get(lines[index]?.key ?? "") ?? average;
  }
}
