import type { ClientFrame, ServerFrame } from "./protocol";
import { type Devices, explain, openDevices } from "./sound/devices";

/** A press of at least this many milliseconds is a long press. */
const HOLD = 400;

/** Milliseconds between two reports of the play-out position. */
const REPORT = 95;

/** Milliseconds after which a caption disappears if it has neither changed nor become a message. */
const CAPTION = 6000;

export interface Options {
  send: (frame: ClientFrame) => boolean;
  sendSound: (sound: ArrayBuffer) => void;
  open?: typeof openDevices;
}

/**
 * The visitor's microphone, and the loudspeaker for the agent's voice.
 *
 * A short press of the button opens the microphone, or turns it off. A long press lets the visitor talk while they
 * hold the button.
 */
export class Voice {
  /** Whether the agent can hear. */
  available = $state(false);
  state: "off" | "starting" | "on" = $state("off");
  mode: "open" | "hold" = $state("open");
  /** Whether the agent takes the microphone's sound; it may have to load its models first. */
  listening = $state(false);
  /** Whether the microphone's sound goes to the agent. */
  talking = $state(false);
  /** The loudness of the visitor, from 0 (silence) to 1. */
  level = $state(0);
  /** Whether the agent's sound plays. */
  speaking = $state(false);
  /** The words so far of what the visitor is saying. */
  caption = $state("");
  /** Why the microphone is off. */
  trouble = $state("");

  #devices: Devices | null = null;
  #attempt = 0; // The number of attempts to open the devices; an older attempt is out of date.
  #pressed: number | null = null; // When the press began (milliseconds); null if the button is not held.
  #began = false; // Whether this press has turned the voice on.
  #connected = false;
  #stream = -1; // The number of the agent's stream of sound; -1 without one.
  #hushed = false; // Whether the visitor has stopped this stream.
  #told = Number.NEGATIVE_INFINITY; // The time of the last `played`.
  #fading: ReturnType<typeof setTimeout> | undefined; // The timer that removes the caption.

  constructor(private readonly options: Options) {}

  /** The visitor presses the button at the time `at` (milliseconds). A busy page may get the event late. */
  press(at = performance.now()): void {
    if (this.#pressed !== null) return;
    this.#pressed = at;
    this.#devices?.resume();
    if (this.state === "off") {
      this.mode = "hold"; // until the button is released
      void this.#start();
    } else if (this.mode === "hold") this.#talk(true);
  }

  /** The visitor releases the button. */
  release(at = performance.now()): void {
    if (this.#pressed === null) return;
    const long = at - this.#pressed >= HOLD;
    const began = this.#began;
    this.#began = false;
    this.#pressed = null;
    this.#devices?.resume();
    if (began && !long) this.setMode("open");
    else if (this.mode === "hold") this.#talk(false);
    else if (!began) this.stop();
  }

  /** Let the visitor talk all the time, or while they hold the button. */
  setMode(mode: "open" | "hold"): void {
    this.mode = mode;
    this.#talk(mode === "open");
  }

  /** Turn the microphone and the sound off. `why` tells the visitor the reason, unless they turn it off themselves. */
  stop(why = ""): void {
    this.#attempt += 1;
    this.#pressed = null;
    if (this.state === "on") this.options.send({ type: "microphone", on: false });
    this.#devices?.close();
    this.#devices = null;
    this.state = "off";
    this.trouble = why;
    this.talking = this.speaking = this.listening = false;
    this.level = 0;
    this.show("");
  }

  /** Turn the microphone and the sound off if they are on. */
  pause(why: string): void {
    if (this.state !== "off") this.stop(why);
  }

  /** Make the agent stop speaking. */
  hush(): void {
    this.#hushed = true;
    this.#devices?.flush(this.#stream);
    this.speaking = false;
    this.options.send({ type: "hush" });
  }

  /** The server has welcomed this window. */
  connected(available: boolean): void {
    this.#connected = true;
    this.available = available;
    if (!available) this.pause("");
    else if (this.state === "on") this.options.send({ type: "microphone", on: true });
  }

  /** The connection is lost: the sound stops until it is back. */
  disconnected(): void {
    if (!this.#connected) return;
    this.#connected = false;
    this.#stream = -1;
    this.#devices?.flush(-1);
    this.speaking = this.listening = false;
    this.show("");
  }

  take(frame: ServerFrame): void {
    if (frame.type === "caption") this.show(frame.text);
    else if (frame.type === "listening") this.listening = true;
    else if (frame.type === "flush") {
      this.#stream = frame.n;
      this.#hushed = false;
      this.speaking = false;
      this.#devices?.flush(frame.n);
    } else if (frame.type === "taken") {
      const why = `The microphone is off: ${frame.text}.`;
      this.state = this.state === "on" ? "starting" : this.state; // so that `stop` sends nothing: the server knows
      this.pause(why);
    }
  }

  /** Play sound of the agent. */
  play(sound: ArrayBuffer): void {
    if (this.#devices === null || this.#stream < 0 || this.#hushed || sound.byteLength % 2 > 0) return;
    this.speaking = true;
    this.#devices.play(sound);
  }

  show(caption: string): void {
    clearTimeout(this.#fading);
    this.caption = caption;
    if (caption !== "") this.#fading = setTimeout(() => this.show(""), CAPTION);
  }

  async #start(): Promise<void> {
    this.#attempt += 1;
    const attempt = this.#attempt;
    this.#began = true;
    this.state = "starting";
    this.trouble = "";
    await new Promise((resolve) => setTimeout(resolve)); // the button responds first
    if (attempt !== this.#attempt) return;
    try {
      const devices = await (this.options.open ?? openDevices)({
        onsound: (sound, level) => this.#hear(sound, level),
        onplayed: (n, samples, busy) => this.#played(n, samples, busy),
        onlost: () => this.stop("The microphone is gone. Connect it, then press the button again."),
      });
      if (attempt !== this.#attempt) {
        devices.close();
        return;
      }
      this.#devices = devices;
      this.state = "on";
      this.#talk(this.mode === "open" || this.#pressed !== null);
      if (this.#connected) this.options.send({ type: "microphone", on: true });
    } catch (error) {
      if (attempt === this.#attempt) this.stop(explain(error, window.parent !== window));
    }
  }

  #talk(on: boolean): void {
    this.talking = on && this.state === "on";
    this.#devices?.talk(on);
    if (!on) this.level = 0;
  }

  #hear(sound: ArrayBuffer, level: number): void {
    const loud = Math.max(0, Math.min(1, 1 + Math.log10(Math.max(level, 1e-6)) / 2.5)); // -50 dB is silence
    this.level = this.talking ? Math.max(loud, this.level * 0.85) : 0;
    if (this.#connected) this.options.sendSound(sound);
  }

  #played(n: number, samples: number, busy: boolean): void {
    if (n !== this.#stream || n < 0 || this.#hushed) return;
    this.speaking = busy;
    const now = performance.now();
    if (busy && now - this.#told < REPORT) return;
    this.#told = now;
    this.options.send({ type: "played", n, samples });
  }
}
