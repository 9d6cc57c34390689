/**
 * The visible part of the timeline: `span` seconds from `left` on. While the view follows the clock, its right edge is
 * the present.
 */
export class View {
  left = 0;
  span = 20;
  follows = true;

  static readonly LEAST = 0.002;
  static readonly MOST = 24 * 3600;

  get right(): number {
    return this.left + this.span;
  }

  /** Move to the present, if the view follows. */
  advance(now: number): void {
    if (this.follows) this.left = Math.max(now - this.span * 0.96, -this.span * 0.04);
  }

  /** Return the place of a time (pixels). */
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

  /** Make the span `factor` times as wide around `time`, or around the right edge while the view follows. */
  zoom(factor: number, time: number): void {
    const span = Math.min(View.MOST, Math.max(View.LEAST, this.span * factor));
    if (this.follows) this.left = this.right - span;
    else this.left = time - ((time - this.left) / this.span) * span;
    this.span = span;
  }

  /** Fit a range of times into the view. */
  fit(from: number, to: number): void {
    this.follows = false;
    const span = Math.max(to - from, View.LEAST * 10);
    this.left = from - span * 0.03;
    this.span = span * 1.06;
  }
}

/**
 * Return the time between two marks of an axis (seconds), so that they are at least `gap` pixels apart. It is 1, 2 or
 * 5 × 10ⁿ seconds, or beyond 20 s a round number of minutes.
 */
export function step(span: number, width: number, gap: number): number {
  const least = (span / Math.max(width, 1)) * gap;
  for (const seconds of [60, 120, 300, 600, 1800, 3600, 7200, 21600]) {
    if (least > 20 && seconds >= least) return seconds;
  }
  const power = 10 ** Math.floor(Math.log10(least));
  for (const factor of [1, 2, 5]) if (factor * power >= least) return factor * power;
  return 10 * power;
}

/** Return a time (seconds) as text, as exact as the step between two marks requires. */
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
