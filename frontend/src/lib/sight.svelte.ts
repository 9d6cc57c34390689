import { type Camera, explain, openCamera } from "./camera";
import type { ClientFrame, Face, ServerFrame } from "./protocol";
import { isAgreed, markAgreed } from "./store";

/** If the camera has no picture yet, the page tries again after this many milliseconds. */
const AGAIN = 250;

export interface Options {
  send: (frame: ClientFrame) => boolean;
  /** Send a picture with its number; return whether there was a connection. */
  sendPicture: (n: number, picture: ArrayBuffer) => boolean;
  open?: typeof openCamera;
}

/**
 * The visitor's camera. Before it goes on for the first time, the page shows a notice.
 *
 * The agent asks for each picture, and gets the newest one.
 */
export class Sight {
  /** The text to show before the camera goes on; empty if the agent cannot see. */
  notice = $state("");
  state: "off" | "asking" | "starting" | "on" = $state("off");
  /** The camera's pictures; null while it is off. */
  stream: MediaStream | null = $state.raw(null);
  /** The faces that the agent sees. */
  faces: readonly Face[] = $state.raw([]);
  /** Whether the agent has looked at a picture since the camera went on. */
  looks = $state(false);
  /** Why the camera is off. */
  trouble = $state("");

  #camera: Camera | null = null;
  #attempt = 0;
  #connected = false;
  #asked = 0;

  constructor(private readonly options: Options) {}

  /** The visitor presses the button. */
  press(): void {
    if (this.state !== "off") this.stop();
    else if (isAgreed(this.notice)) void this.#start();
    else {
      this.trouble = "";
      this.state = "asking";
    }
  }

  /** The visitor has read the notice, and wants the camera on. */
  agree(): void {
    markAgreed(this.notice);
    void this.#start();
  }

  /** Turn the camera off. `why` tells the visitor the reason, unless they turn it off themselves. */
  stop(why = ""): void {
    this.#attempt += 1;
    if (this.state === "on") this.options.send({ type: "camera", on: false });
    this.#camera?.close();
    this.#camera = null;
    this.stream = null;
    this.state = "off";
    this.trouble = why;
    this.#forget();
  }

  /** Turn the camera off if it is on, and hide the notice. */
  pause(why: string): void {
    if (this.state === "asking") this.stop();
    else if (this.state !== "off") this.stop(why);
  }

  /** The server has welcomed this window. */
  connected(notice: string): void {
    this.#connected = true;
    this.notice = notice;
    this.#forget();
    if (notice === "") this.pause("");
    else if (this.state === "on") this.options.send({ type: "camera", on: true });
  }

  /** The connection is lost: no pictures are sent until it is back. */
  disconnected(): void {
    this.#connected = false;
    this.#forget();
  }

  take(frame: ServerFrame): void {
    if (frame.type === "look") void this.#answer(frame.n);
    else if (frame.type === "faces") this.faces = this.state === "on" ? frame.faces : [];
    else if (frame.type === "unseen") {
      this.state = this.state === "on" ? "starting" : this.state; // so that `stop` sends nothing: the server knows
      this.pause(`The camera is off: ${frame.text}.`);
    }
  }

  #forget(): void {
    this.#asked = 0;
    this.faces = [];
    this.looks = false;
  }

  async #start(): Promise<void> {
    this.#attempt += 1;
    const attempt = this.#attempt;
    this.state = "starting";
    this.trouble = "";
    try {
      const camera = await (this.options.open ?? openCamera)(() =>
        this.stop("The camera is gone. Connect it, then press the button again."),
      );
      if (attempt !== this.#attempt) {
        camera.close();
        return;
      }
      this.#camera = camera;
      this.stream = camera.stream;
      this.state = "on";
      if (this.#connected) this.options.send({ type: "camera", on: true });
    } catch (error) {
      if (attempt === this.#attempt) this.stop(explain(error, window.parent !== window));
    }
  }

  /** Send the newest picture, unless the agent has asked for a later one meanwhile. */
  async #answer(n: number): Promise<void> {
    this.#asked = n;
    const camera = this.#camera;
    while (camera !== null && camera === this.#camera && n === this.#asked) {
      const picture = await camera.picture().catch(() => null);
      if (camera !== this.#camera || n !== this.#asked || !this.#connected) return;
      if (picture !== null) {
        this.looks = this.options.sendPicture(n, picture) || this.looks;
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, AGAIN));
    }
  }
}
