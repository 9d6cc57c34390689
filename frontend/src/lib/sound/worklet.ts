// The audio worklet: it runs in the browser's audio thread, and has a file of its own.

import { JitterBuffer } from "./jitter";
import { Resampler, toFloat, toInt16 } from "./resampler";

declare const sampleRate: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

/** The sampling rate of the visitor's sound (Hz). */
const IN_RATE = 16_000;

/** Samples in a block of the visitor's sound: 20 ms. */
const BLOCK = 320;

/** Turns the microphone's sound into blocks of 16-bit samples, and measures their level. */
class Capture extends AudioWorkletProcessor {
  #resampler = new Resampler(sampleRate, IN_RATE);
  #block = new Float32Array(BLOCK);
  #filled = 0;

  process(inputs: Float32Array[][]): boolean {
    const channels = inputs[0] ?? [];
    const first = channels[0];
    if (first === undefined) return true;
    const mono = first.map(
      (_, i) => channels.reduce((sum, channel) => sum + (channel[i] ?? 0), 0) / channels.length,
    );
    for (const sample of this.#resampler.push(mono)) {
      this.#block[this.#filled] = sample;
      this.#filled += 1;
      if (this.#filled === BLOCK) this.#send();
    }
    return true;
  }

  #send(): void {
    const level = Math.sqrt(this.#block.reduce((sum, sample) => sum + sample * sample, 0) / BLOCK);
    const { buffer } = toInt16(this.#block);
    this.port.postMessage({ sound: buffer, level }, [buffer]);
    this.#filled = 0;
  }
}

/** Seconds between two reports of the play-out position. */
const REPORT = 0.05;

/** Plays the agent's sound, and reports the play-out position (how much of the sound was played). */
class Playout extends AudioWorkletProcessor {
  #buffer = new JitterBuffer(sampleRate);
  #stream = -1;
  #since = 0;
  #told = -1;

  constructor() {
    super();
    this.port.onmessage = (event: MessageEvent) => {
      const { sound, flush, latency } = event.data as {
        sound?: ArrayBuffer;
        flush?: number;
        latency?: number;
      };
      if (latency !== undefined) this.#buffer.latency = latency;
      if (flush !== undefined) {
        this.#stream = flush;
        this.#buffer.flush();
        this.#tell();
      }
      if (sound !== undefined) this.#buffer.push(toFloat(new Int16Array(sound)));
    };
  }

  process(_: Float32Array[][], outputs: Float32Array[][]): boolean {
    const channels = outputs[0] ?? [];
    const first = channels[0];
    if (first === undefined) return true;
    this.#buffer.pull(first);
    for (const other of channels.slice(1)) other.set(first);
    this.#since += first.length / sampleRate;
    if (this.#since >= REPORT) this.#tell();
    return true;
  }

  #tell(): void {
    this.#since = 0;
    const { played, busy } = this.#buffer;
    if (played === this.#told && !busy) return;
    this.#told = busy ? -1 : played;
    this.port.postMessage({ n: this.#stream, samples: played, busy });
  }
}

registerProcessor("capture", Capture);
registerProcessor("playout", Playout);
