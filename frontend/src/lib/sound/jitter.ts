import { Resampler } from "./resampler";

/** The sampling rate of the agent's sound (Hz). */
export const OUT_RATE = 24_000;

/**
 * The buffer collects this many seconds of sound before the loudspeaker begins, so that a late piece makes no gap. The
 * number is `LEAST` at first. Each gap multiplies it by `GROWTH`, up to `MOST`.
 */
const LEAST = 0.08;
const MOST = 0.4;
const GROWTH = 1.5;

/** If sound resumes within this many seconds after its end, the pause was a gap. */
const GAP = 0.5;

/** Samples over which dropped sound fades, so that it does not click. */
const FADE = 128;

/**
 * A jitter buffer: sound at 24 kHz comes in pieces at uneven times, and goes out evenly at the loudspeaker's rate.
 *
 * It counts the samples of the present stream that have gone out. The count lags behind by the latency of the device.
 */
export class JitterBuffer {
  #resampler: Resampler;
  #pieces: Float32Array[] = [];
  #waiting = 0; // samples at the loudspeaker's rate
  #taken = 0; // samples at the loudspeaker's rate that have gone out of this stream
  #received = 0; // samples at 24 kHz of this stream
  #playing = false;
  #need = LEAST;
  #age = 0; // seconds for which the first sound has been waiting
  #dry = Number.POSITIVE_INFINITY; // seconds since the sound ended
  #fade: Float32Array | null = null;
  #past: { at: number; taken: number }[] = [];
  #clock = 0;

  /** @param rate the rate of the loudspeaker (Hz); @param latency its delay (seconds) */
  constructor(
    private readonly rate: number,
    public latency = 0,
  ) {
    this.#resampler = new Resampler(OUT_RATE, rate);
  }

  /** Whether there is sound to play. */
  get busy(): boolean {
    return this.#waiting > 0 || this.played < this.#received;
  }

  /** The samples at 24 kHz of this stream that the loudspeaker has played. */
  get played(): number {
    const before = this.#clock - this.latency;
    let taken = 0;
    for (const entry of this.#past) if (entry.at <= before) taken = entry.taken;
    if (taken > 0 && taken === this.#taken && this.#waiting === 0) return this.#received;
    return Math.min(this.#received, Math.floor((taken * OUT_RATE) / this.rate));
  }

  push(sound: Float32Array): void {
    if (this.#waiting === 0) {
      if (this.#dry < GAP) this.#need = Math.min(MOST, this.#need * GROWTH);
      this.#age = 0;
    }
    this.#received += sound.length;
    const piece = this.#resampler.push(sound);
    this.#pieces.push(piece);
    this.#waiting += piece.length;
  }

  /** Drop all sound, and begin a new stream. */
  flush(): void {
    if (this.#playing) this.#fade = this.#take(Math.min(FADE, this.#waiting));
    this.#pieces = [];
    this.#past = [];
    this.#waiting = this.#taken = this.#received = 0;
    this.#playing = false;
    this.#dry = Number.POSITIVE_INFINITY;
    this.#resampler = new Resampler(OUT_RATE, this.rate);
  }

  /** Fill a block for the loudspeaker. */
  pull(out: Float32Array): void {
    out.fill(0);
    const seconds = out.length / this.rate;
    if (this.#fade !== null) {
      const fade = this.#fade;
      fade.forEach((sample, i) => {
        if (i < out.length) out[i] = sample * (1 - i / fade.length);
      });
      this.#fade = null;
    }
    if (!this.#playing && this.#waiting > 0) {
      this.#age += seconds;
      this.#playing = this.#waiting >= this.#need * this.rate || this.#age >= this.#need;
    }
    if (this.#playing) {
      const piece = this.#take(Math.min(out.length, this.#waiting));
      out.set(piece);
      this.#taken += piece.length;
      if (this.#waiting === 0) {
        this.#playing = false;
        this.#dry = 0;
      }
    } else if (this.#waiting === 0) this.#dry += seconds;
    this.#clock += seconds;
    const last = this.#past.at(-1);
    if (this.#taken > (last?.taken ?? 0)) this.#past.push({ at: this.#clock, taken: this.#taken });
    while (this.#past.length > 1 && (this.#past[1]?.at ?? 0) <= this.#clock - this.latency)
      this.#past.shift();
  }

  #take(count: number): Float32Array {
    const found = new Float32Array(count);
    let at = 0;
    while (at < count) {
      const first = this.#pieces[0] as Float32Array;
      const some = first.subarray(0, count - at);
      found.set(some, at);
      at += some.length;
      if (some.length === first.length) this.#pieces.shift();
      else this.#pieces[0] = first.subarray(some.length);
    }
    this.#waiting -= count;
    return found;
  }
}
