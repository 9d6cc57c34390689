// The connection to the stand-in robot. If it breaks, the page connects again.
import { ASLEEP, type Looks } from "./face.ts";

const AGAIN = 1000; // milliseconds until the next attempt

export class Link {
  looks = $state<Looks>(ASLEEP);
  connected = $state(false);
  #socket: WebSocket | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly address: string) {}

  open(): void {
    const socket = new WebSocket(this.address);
    this.#socket = socket;
    socket.onopen = () => {
      this.connected = true;
    };
    socket.onmessage = (event) => {
      this.looks = JSON.parse(String(event.data)) as Looks;
    };
    socket.onclose = () => {
      this.connected = false;
      this.looks = { ...this.looks, text: "", seconds: 0 };
      this.#timer = setTimeout(() => this.open(), AGAIN);
    };
  }

  close(): void {
    if (this.#socket !== null) this.#socket.onclose = null;
    clearTimeout(this.#timer);
    this.#socket?.close();
  }

  say(text: string, direction: number): void {
    this.#socket?.send(JSON.stringify({ say: text, direction }));
  }

  show(people: string[]): void {
    this.#socket?.send(JSON.stringify({ people }));
  }
}
