/** Which part of time is seen: from `left`, so many seconds wide. While it follows, its right edge is now. */
export class View {
  left = 0;
  span = 20;
  follows = true;

  static readonly LEAST = 0.002;
  static readonly MOST = 24 * 3600;

  get right(): number {
    return this.left + this.span;
  }

  /** Now is `now`: move along, if it follows. */
  advance(now: number): void {
    if (this.follows) this.left = Math.max(now - this.span * 0.96, -this.span * 0.04);
  }

  /** Where a time is, in a width of pixels. */
  x(time: number, width: number): number {
    return ((time - this.left) / this.span) * width;
  }

  time(x: number, width: number): number {
    return this.left + (x / width) * this.span;
  }

  pan(seconds: number): void {
    this.follows = false;
    this.left += seconds;
  }

  /** Make the span `factor` times as wide; what is at `time` stays where it is. While it follows, the right edge does. */
  zoom(factor: number, time: number): void {
    const span = Math.min(View.MOST, Math.max(View.LEAST, this.span * factor));
    if (this.follows) this.left = this.right - span;
    else this.left = time - ((time - this.left) / this.span) * span;
    this.span = span;
  }

  /** See everything from one time to another. */
  fit(from: number, to: number): void {
    this.follows = false;
    const span = Math.max(to - from, View.LEAST * 10);
    this.left = from - span * 0.03;
    this.span = span * 1.06;
  }
}

/** Round steps for an axis: the least of 1, 2, 5 × 10ⁿ seconds (or of minutes) that leaves `gap` pixels between two. */
export function step(span: number, width: number, gap: number): number {
  const least = (span / Math.max(width, 1)) * gap;
  for (const seconds of [60, 120, 300, 600, 1800, 3600, 7200, 21600]) {
    if (least > 20 && seconds >= least) return seconds;
  }
  const power = 10 ** Math.floor(Math.log10(least));
  for (const factor of [1, 2, 5]) if (factor * power >= least) return factor * power;
  return 10 * power;
}

/** A time (seconds), as exact as the step between two marks asks for. */
export function label(time: number, between: number): string {
  if (between >= 60) {
    const minutes = Math.round(time / 60);
    return minutes >= 60 ? `${Math.floor(minutes / 60)} h ${minutes % 60} min` : `${minutes} min`;
  }
  if (between >= 0.001) {
    const digits = Math.max(0, Math.ceil(-Math.log10(between) - 1e-9));
    return `${time.toFixed(digits)} s`;
  }
  return `${(time * 1000).toFixed(2)} ms`;
}
