import { Backoff } from "../lib/backoff";
import { CLOSING_CODES, type ClientFrame, type ServerFrame, VERSION } from "./protocol";

export type Status = "connecting" | "open" | "lost" | "ended" | "token" | "refused" | "gone";

/** The conversation or recording to show, and the server's token. */
export interface Address {
  session?: string;
  visitor?: string;
  recording?: string;
  token?: string;
  /** Whether the user chose the conversation on the board, so that the board does not follow newer conversations. */
  chosen?: boolean;
}

interface Options {
  address: () => Address;
  onframe: (frame: ServerFrame) => void;
  onstatus: (status: Status) => void;
  open?: () => WebSocket;
}

const FINAL: Record<number, Status> = {
  [CLOSING_CODES.ended]: "ended",
  [CLOSING_CODES.token]: "token",
  [CLOSING_CODES.malformed]: "refused",
  [CLOSING_CODES.gone]: "gone",
};

/** The connection to the board's server. It reconnects by itself. */
export class Link {
  #socket: WebSocket | null = null;
  #retry: ReturnType<typeof setTimeout> | undefined;
  #backoff = new Backoff();
  #open = false;

  constructor(private readonly options: Options) {}

  start(): void {
    this.stop();
    this.options.onstatus("connecting");
    const socket = (this.options.open ?? openHere)();
    this.#socket = socket;
    socket.onopen = () => {
      const { chosen: _, ...address } = this.options.address();
      socket.send(JSON.stringify({ type: "hello", v: VERSION, ...address }));
    };
    socket.onmessage = (event) => this.#receive(event.data);
    socket.onclose = (event) => this.#closed(event.code);
  }

  /** Send a command; return whether there is a connection. */
  send(command: ClientFrame): boolean {
    if (!this.#open) return false;
    this.#socket?.send(JSON.stringify(command));
    return true;
  }

  stop(): void {
    clearTimeout(this.#retry);
    this.#open = false;
    const socket = this.#socket;
    this.#socket = null;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }

  #receive(data: unknown): void {
    if (typeof data !== "string") return;
    const frame = JSON.parse(data) as ServerFrame;
    if (frame.type === "welcome") {
      this.#open = true;
      this.#backoff.reset();
      this.options.onstatus("open");
    }
    this.options.onframe(frame);
  }

  #closed(code: number): void {
    this.stop();
    const final = FINAL[code];
    if (final !== undefined) {
      this.options.onstatus(final);
      return;
    }
    this.options.onstatus("lost");
    this.#retry = setTimeout(() => this.start(), this.#backoff.next());
  }
}

function openHere(): WebSocket {
  const url = new URL("ws", document.baseURI);
  url.protocol = url.protocol.replace("http", "ws");
  url.hash = "";
  return new WebSocket(url);
}
