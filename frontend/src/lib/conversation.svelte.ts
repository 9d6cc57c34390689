import { Connection, type Options, type Status } from "./connection";
import { type Message, type Say, type ServerFrame, VERSION } from "./protocol";
import { announce, type Kept, keep, recall, tokenOfLink } from "./store";

export interface Line {
  key: string;
  from: "user" | "agent";
  text: string;
  /** Milliseconds since 1970; undefined while nobody is known to have heard it. */
  time?: number;
  /** The first of a conversation that follows on one that is lost. */
  anew?: boolean;
  /** The server did not take it, and would not if it were said again. */
  refused?: boolean;
}

/** Milliseconds in which the server is told at most once that something is being written. */
const WRITING = 2000;

/** A conversation as a window shows it: what was said, what is being said, and how the connection is. */
export class Conversation {
  /** Plain objects, replaced on each change: there may be thousands. */
  lines: readonly Line[] = $state.raw([]);
  partial = $state("");
  typing = $state(false);
  /** Whether the agent's clock stands still. */
  paused = $state(false);
  /** Things that the visitor could say first. */
  suggestions: readonly string[] = $state.raw([]);
  agent = $state("Ravestate");
  status: Status = $state("connecting");
  /** What was said before the page was loaded is still coming: nothing that has to be read out. */
  recalling = $state(false);
  /** Where one may look inside of the agent, with what it takes to be let in; empty: nowhere. */
  inside = $state("");
  /** Why it has ended, once it has. */
  ending = $state("");
  /** What the server did not take, and why. */
  trouble = $state("");

  #kept: Kept = recall();
  #outbox: Say[];
  #last = 0;
  #recalled = 0;
  #anew = false;
  #epoch = 0;
  #listens = false; // the server wants to know when something is being written
  #told = Number.NEGATIVE_INFINITY; // when it was told so
  #connection: Connection;

  constructor(options: Pick<Options, "open" | "backoff"> = {}) {
    const token = tokenOfLink();
    if (token !== undefined) this.#keep({ token });
    this.#outbox = (this.#kept.outbox ?? []).map(({ id, text }) => ({ type: "say", id, text }));
    this.lines = this.#outbox.map(({ id, text }) => ({ key: id, from: "user", text }));
    this.#connection = new Connection({
      ...options,
      hello: () => ({
        type: "hello",
        v: VERSION,
        last: this.#last,
        ...(this.#kept.session === undefined ? {} : { session: this.#kept.session }),
        ...(this.#kept.token === undefined ? {} : { token: this.#kept.token }),
      }),
      onframe: (frame) => this.#take(frame),
      onstatus: (status) => {
        this.status = status;
        if (status !== "open" && status !== "silent") this.typing = this.paused = false;
      },
    });
  }

  start(): void {
    this.status = "connecting";
    this.#connection.start();
  }

  stop(): void {
    this.#connection.stop();
  }

  nudge(): void {
    this.#connection.nudge();
  }

  /** Something is being written: tell the server so, now and then. */
  write(): void {
    const now = performance.now();
    if (!this.#listens || now - this.#told < WRITING) return;
    if (this.#connection.send({ type: "writing" })) this.#told = now;
  }

  /** Say something; it arrives once, also if the connection is lost meanwhile. */
  say(text: string): void {
    const say: Say = { type: "say", id: crypto.getRandomValues(new Uint32Array(3)).join("-"), text };
    this.trouble = "";
    this.#told = Number.NEGATIVE_INFINITY; // what is written next is news
    this.lines = [...this.lines, { key: say.id, from: "user", text }];
    this.#outbox.push(say);
    this.#keep({ outbox: this.#outbox });
    this.#connection.send(say);
  }

  /** Try another token. */
  present(token: string): void {
    this.#keep({ token });
    this.start();
  }

  /** Leave for good; the agent may still bid farewell. */
  leave(): void {
    this.#connection.send({ type: "bye" });
  }

  /** Begin a new conversation after one has ended. */
  again(): void {
    this.lines = [];
    this.partial = this.ending = this.trouble = "";
    this.#forget();
    this.start();
  }

  #take(frame: ServerFrame): void {
    if (frame.type === "welcome") {
      this.agent = frame.agent;
      this.suggestions = frame.suggestions ?? [];
      this.#listens = frame.writing === true;
      this.trouble = "";
      if (!frame.resumed) {
        this.#anew = this.lines.some((line) => line.time !== undefined);
        this.#last = 0;
        this.#epoch += 1;
      }
      this.#recalled = frame.resumed && this.#last === 0 ? (frame.last ?? 0) : 0;
      this.recalling = this.#recalled > 0;
      this.#keep({ session: frame.session });
      if (frame.inside !== undefined && !frame.resumed) announce(frame.session);
      this.inside = frame.inside === undefined ? "" : this.#linkInside(frame.inside);
      this.partial = "";
      for (const say of this.#outbox) this.#connection.send(say); // what was heard already is not heard again
    } else if (frame.type === "renamed") this.agent = frame.agent;
    else if (frame.type === "message") this.#hear(frame);
    else if (frame.type === "piece") this.partial = this.partial.slice(0, frame.at) + frame.text;
    else if (frame.type === "typing") this.typing = frame.on;
    else if (frame.type === "paused") this.paused = frame.on;
    else if (frame.type === "error") {
      this.trouble = frame.text;
      if (frame.id !== undefined) this.#giveUp(frame.id);
    } else if (frame.type === "ended") {
      this.ending = frame.text;
      this.#forget();
    }
  }

  #hear(message: Message): void {
    if (message.n <= this.#last) return;
    this.#last = message.n;
    if (message.n >= this.#recalled) this.recalling = false;
    const line: Line = {
      key: message.id ?? `${this.#epoch}/${message.n}`,
      from: message.from,
      text: message.text,
      time: message.time,
    };
    if (this.#anew) {
      line.anew = true;
      this.#anew = false;
    }
    // Lines that nobody has heard yet stay at the end.
    const others =
      message.id === undefined ? this.lines : this.lines.filter((other) => other.key !== line.key);
    let end = others.length;
    while (end > 0 && others[end - 1]?.time === undefined) end -= 1;
    this.lines = [...others.slice(0, end), line, ...others.slice(end)];
    if (message.from === "agent") {
      this.partial = "";
    } else if (message.id !== undefined) this.#settle(message.id);
  }

  /** What was said under an id need not be said again. */
  #settle(id: string): void {
    this.#outbox = this.#outbox.filter((say) => say.id !== id);
    this.#keep({ outbox: this.#outbox });
  }

  #giveUp(id: string): void {
    this.#settle(id);
    this.lines = this.lines.map((line) =>
      line.key === id ? { ...line, refused: true, time: Date.now() } : line,
    );
  }

  /** A link to what shows this conversation from inside; the secrets are in its fragment, which is sent nowhere. */
  #linkInside(path: string): string {
    const { session, token } = this.#kept;
    const secrets = new URLSearchParams();
    if (session !== undefined) secrets.set("session", session);
    if (token !== undefined) secrets.set("token", token);
    return `${path}#${secrets}`;
  }

  #forget(): void {
    this.#last = 0;
    this.#outbox = [];
    const { token } = this.#kept;
    this.#kept = {};
    this.#keep(token === undefined ? {} : { token });
  }

  #keep(more: Kept): void {
    this.#kept = { ...this.#kept, ...more };
    keep(this.#kept);
  }
}
