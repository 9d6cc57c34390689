import type { Socket } from "../src/lib/connection";
import type { ClientFrame, ServerFrame } from "../src/lib/protocol";

/** A socket whose other end is the test. */
export class TestSocket implements Socket {
  static all: TestSocket[] = [];
  readyState = 0;
  bufferedAmount = 0;
  binaryType: BinaryType = "blob";
  sent: ClientFrame[] = [];
  sounds: ArrayBuffer[] = [];
  closed = false;
  onopen: ((event: Event) => void) | null = null;
  onmessage: ((event: MessageEvent) => void) | null = null;
  onclose: ((event: CloseEvent) => void) | null = null;

  static make = (): TestSocket => {
    const socket = new TestSocket();
    TestSocket.all.push(socket);
    return socket;
  };

  static get newest(): TestSocket {
    const socket = TestSocket.all.at(-1);
    if (socket === undefined) throw new Error("no socket was opened");
    return socket;
  }

  send(data: string | ArrayBuffer): void {
    if (this.closed) throw new Error("sent after the close");
    if (typeof data === "string") this.sent.push(JSON.parse(data));
    else this.sounds.push(data);
  }

  close(): void {
    this.closed = true;
  }

  open(): void {
    this.readyState = 1;
    this.onopen?.(new Event("open"));
  }

  tell(...frames: ServerFrame[]): void {
    for (const frame of frames) {
      this.onmessage?.(new MessageEvent("message", { data: JSON.stringify(frame) }));
    }
  }

  welcome(session: string, resumed = false, last = 0): void {
    this.open();
    this.tell({ type: "welcome", v: 1, session, resumed, first: 1, agent: "Elske", last, writing: true });
  }

  lose(code = 1006): void {
    this.readyState = 3;
    this.onclose?.({ code } as CloseEvent);
  }
}
