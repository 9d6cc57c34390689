import { Backoff } from "./backoff";
import { parse } from "./frames";
import { CLOSING_CODES, type ClientFrame, type ServerFrame } from "./protocol";

/**
 * - `connecting`: for the first time
 * - `open`: the server has welcomed us
 * - `lost`: it is tried again and again
 * - `ended`: the server has ended the conversation
 * - `token`: the server asks for a token, or for another one
 * - `refused`: the server does not understand this page
 */
export type Status = "connecting" | "open" | "lost" | "ended" | "token" | "refused";

/** A WebSocket, as far as it is used. */
export interface Socket {
  readonly readyState: number;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(text: string): void;
  close(): void;
}

export interface Options {
  /** The first frame of each connection. */
  hello: () => ClientFrame;
  onframe: (frame: ServerFrame) => void;
  onstatus: (status: Status) => void;
  open?: () => Socket;
  backoff?: Backoff;
}

const OPEN = 1;

/** Milliseconds without a word from the server after which it is asked whether it is there. */
const QUIET = 25_000;

/** Milliseconds that it has to answer. */
const PATIENCE = 10_000;

/** A connection that comes back by itself. */
export class Connection {
  #socket: Socket | null = null;
  #status: Status = "connecting";
  #retry: ReturnType<typeof setTimeout> | undefined;
  #watch: ReturnType<typeof setTimeout> | undefined;
  #backoff: Backoff;

  constructor(private readonly options: Options) {
    this.#backoff = options.backoff ?? new Backoff();
  }

  /** Connect now, whatever was waited for. */
  start(): void {
    clearTimeout(this.#retry);
    this.#drop();
    const socket = (this.options.open ?? openHere)();
    this.#socket = socket;
    this.#expect(PATIENCE);
    socket.onopen = () => socket.send(JSON.stringify(this.options.hello()));
    socket.onmessage = (event) => this.#receive(event.data);
    socket.onclose = (event) => this.#closed(event.code);
  }

  /** Send a frame, if there is a connection; whether there was. */
  send(frame: ClientFrame): boolean {
    if (this.#status !== "open" || this.#socket?.readyState !== OPEN) return false;
    this.#socket.send(JSON.stringify(frame));
    return true;
  }

  /** The network may be back, or the page is looked at again: try now if it is lost, and make sure if it is not. */
  nudge(): void {
    if (this.#status === "lost") this.start();
    else if (this.send({ type: "ping" })) this.#expect(PATIENCE);
  }

  /** Disconnect for good. */
  stop(): void {
    clearTimeout(this.#retry);
    this.#drop();
  }

  #receive(data: unknown): void {
    this.#expect(QUIET);
    const frame = parse(data);
    if (frame === null) return; // of a later version
    if (frame.type === "welcome") {
      this.#backoff.reset();
      this.#become("open");
    }
    this.options.onframe(frame);
  }

  /** Wait for a word from the server; ask for one; take the connection for lost. */
  #expect(milliseconds: number): void {
    clearTimeout(this.#watch);
    this.#watch = setTimeout(() => {
      if (milliseconds === QUIET && this.send({ type: "ping" })) this.#expect(PATIENCE);
      else this.#closed(0);
    }, milliseconds);
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

/** The WebSocket beside this page. */
function openHere(): Socket {
  const url = new URL("ws", document.baseURI);
  url.protocol = url.protocol.replace("http", "ws");
  url.hash = "";
  return new WebSocket(url);
}
