import { Backoff } from "./backoff";
import { parse } from "./frames";
import { CLOSING_CODES, type ClientFrame, type ServerFrame } from "./protocol";

export type Status =
  /** The page tries to connect for the first time. */
  | "connecting"
  /** The server has welcomed us. */
  | "open"
  /** The connection is open, but the server does not answer. */
  | "silent"
  /** There is no connection; the next attempt follows. */
  | "lost"
  /** The server has ended the conversation. */
  | "ended"
  /** The server asks for a token, or the token is wrong. */
  | "token"
  /** The server does not understand this page. */
  | "refused";

/** The part of a WebSocket that a connection uses. */
export interface Socket {
  readonly readyState: number;
  readonly bufferedAmount: number;
  binaryType: BinaryType;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(data: string | ArrayBuffer): void;
  close(): void;
}

export interface Options {
  /** Returns the first frame of each connection. */
  hello: () => ClientFrame;
  onframe: (frame: ServerFrame) => void;
  onsound?: (sound: ArrayBuffer) => void;
  onstatus: (status: Status) => void;
  open?: () => Socket;
  backoff?: Backoff;
}

const OPEN = 1;

/** If more than this many bytes wait to be sent, sound is dropped, because late sound is useless. */
const MOST_WAITING = 64_000;

/** Frames that the server does not answer. */
const UNANSWERED = new Set(["writing", "played", "hush", "camera", "picture"]);

/** The milliseconds to wait for a frame from the server, by the reason of the wait. */
const TIMEOUTS = {
  /** The answer to hello. Without it the connection is lost. */
  welcome: 10_000,
  /** Any frame. Without one the page sends a ping. */
  frame: 15_000,
  /** The answer to a ping or an utterance. Without it the server counts as silent. */
  answer: 5_000,
  /** A frame of a silent server. Without it the connection is lost. */
  return: 20_000,
} as const;

/** A WebSocket that reconnects by itself. */
export class Connection {
  #socket: Socket | null = null;
  #status: Status = "connecting";
  #retry: ReturnType<typeof setTimeout> | undefined;
  #watch: ReturnType<typeof setTimeout> | undefined; // the end of the present wait
  #awaited: keyof typeof TIMEOUTS = "welcome"; // the reason of the present wait
  #backoff: Backoff;

  constructor(private readonly options: Options) {
    this.#backoff = options.backoff ?? new Backoff();
  }

  /** Connect now, without waiting for the next attempt. */
  start(): void {
    clearTimeout(this.#retry);
    this.#drop();
    const socket = (this.options.open ?? openHere)();
    this.#socket = socket;
    socket.binaryType = "arraybuffer";
    this.#expect("welcome");
    socket.onopen = () => socket.send(JSON.stringify(this.options.hello()));
    socket.onmessage = (event) => this.#receive(event.data);
    socket.onclose = (event) => this.#closed(event.code);
  }

  /** Send a frame if there is a connection; return whether there was one. */
  send(frame: ClientFrame): boolean {
    if ((this.#status !== "open" && this.#status !== "silent") || this.#socket?.readyState !== OPEN)
      return false;
    this.#socket.send(JSON.stringify(frame));
    if (this.#awaited === "frame" && !UNANSWERED.has(frame.type)) this.#expect("answer");
    return true;
  }

  /** Send sound if there is a connection that keeps up. */
  sendSound(sound: ArrayBuffer): void {
    const socket = this.#socket;
    if (this.#status === "open" && socket?.readyState === OPEN && socket.bufferedAmount < MOST_WAITING)
      socket.send(sound);
  }

  /** Send a picture, the answer to `look` number `n`, if there is a connection; return whether there was one. */
  sendPicture(n: number, picture: ArrayBuffer): boolean {
    if (!this.send({ type: "picture", n })) return false;
    this.#socket?.send(picture);
    return true;
  }

  /** Check the connection, for example because the network may be back or the user looks at the page again. */
  nudge(): void {
    if (this.#status === "lost") this.start();
    else this.send({ type: "ping" });
  }

  /** Disconnect for good. */
  stop(): void {
    clearTimeout(this.#retry);
    this.#drop();
  }

  #receive(data: unknown): void {
    this.#expect("frame");
    if (this.#status === "silent") this.#become("open");
    if (data instanceof ArrayBuffer) {
      this.options.onsound?.(data);
      return;
    }
    const frame = parse(data);
    if (frame === null) return; // a later version of the server may send frames that this page does not know
    if (frame.type === "welcome") {
      this.#backoff.reset();
      this.#become("open");
    }
    this.options.onframe(frame);
  }

  #expect(awaited: keyof typeof TIMEOUTS): void {
    clearTimeout(this.#watch);
    this.#awaited = awaited;
    this.#watch = setTimeout(() => this.#late(), TIMEOUTS[awaited]);
  }

  #late(): void {
    if (this.#awaited === "frame" && this.send({ type: "ping" })) return;
    if (this.#awaited !== "answer") {
      this.#closed(0);
      return;
    }
    this.#become("silent");
    this.#expect("return");
  }

  #closed(code: number): void {
    this.#drop();
    if (code === CLOSING_CODES.ended) this.#become("ended");
    else if (code === CLOSING_CODES.token) this.#become("token");
    else if (code === CLOSING_CODES.malformed) this.#become("refused");
    else {
      this.#become("lost");
      this.#retry = setTimeout(() => this.start(), this.#backoff.next());
    }
  }

  #drop(): void {
    clearTimeout(this.#watch);
    const socket = this.#socket;
    this.#socket = null;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }

  #become(status: Status): void {
    this.#status = status;
    this.options.onstatus(status);
  }
}

/** Open the WebSocket beside this page. */
function openHere(): Socket {
  const url = new URL("ws", document.baseURI);
  url.protocol = url.protocol.replace("http", "ws");
  url.hash = "";
  return new WebSocket(url);
}
