/** The number of zero crossings of the low-pass filter on each side. */
const CROSSINGS = 12;

/** The share of the lower Nyquist frequency that passes. */
const PASS = 0.92;

/** Positions between two input samples for which the filter is tabulated. */
const PHASES = 64;

/** Changes the sampling rate of a stream of sound, which may come in pieces of any size. */
export class Resampler {
  readonly #step: number;
  readonly #half: number;
  readonly #taps: Float32Array[];
  #history: Float32Array;
  /** The place of the next output sample in `history` (input samples). */
  #at: number;

  /** @param from the rate of the input (Hz); @param to the rate of the output (Hz) */
  constructor(from: number, to: number) {
    this.#step = from / to;
    const cutoff = Math.min(1, to / from) * PASS;
    this.#half = Math.ceil(CROSSINGS / cutoff);
    this.#taps = Array.from({ length: PHASES + 1 }, (_, phase) => filter(phase / PHASES, this.#half, cutoff));
    this.#history = new Float32Array(this.#half);
    this.#at = this.#half;
  }

  /** Return the output for the input so far, except the last samples: the filter also needs the samples after them. */
  push(input: Float32Array): Float32Array {
    const whole = new Float32Array(this.#history.length + input.length);
    whole.set(this.#history);
    whole.set(input, this.#history.length);
    const count = Math.max(0, Math.ceil((whole.length - this.#half - 1 - this.#at) / this.#step));
    const output = new Float32Array(count);
    let at = this.#at;
    for (let i = 0; i < count; i += 1, at += this.#step) {
      const centre = Math.floor(at);
      const taps = this.#taps[Math.round((at - centre) * PHASES)] as Float32Array;
      const first = centre - this.#half + 1;
      let sum = 0;
      for (let k = 0; k < taps.length; k += 1) sum += (whole[first + k] ?? 0) * (taps[k] as number);
      output[i] = sum;
    }
    const drop = Math.max(0, Math.floor(at) - this.#half);
    this.#history = whole.slice(drop);
    this.#at = at - drop;
    return output;
  }
}

/** Return the taps of a windowed sinc for a place `offset` (0 to 1) behind an input sample. Their sum is 1. */
function filter(offset: number, half: number, cutoff: number): Float32Array {
  const taps = new Float32Array(2 * half);
  let sum = 0;
  for (let k = 0; k < taps.length; k += 1) {
    const x = k - half + 1 - offset;
    const sinc = x === 0 ? 1 : Math.sin(Math.PI * x * cutoff) / (Math.PI * x * cutoff);
    const w = Math.max(-1, Math.min(1, x / half));
    taps[k] = sinc * (0.42 + 0.5 * Math.cos(Math.PI * w) + 0.08 * Math.cos(2 * Math.PI * w)); // Blackman
    sum += taps[k] as number;
  }
  return taps.map((tap) => tap / sum);
}

/** Return samples from -1 to 1 as 16-bit integers. */
export function toInt16(samples: Float32Array): Int16Array<ArrayBuffer> {
  const found = new Int16Array(samples.length);
  samples.forEach((sample, i) => {
    found[i] = Math.max(-32768, Math.min(32767, Math.round(sample * 32767)));
  });
  return found;
}

/** Return 16-bit integers as samples from -1 to 1. */
export function toFloat(samples: Int16Array): Float32Array {
  return Float32Array.from(samples, (sample) => sample / 32768);
}
