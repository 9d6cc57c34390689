import { Connection, type Options, type Status } from "./connection";
import { type Message, type Say, type ServerFrame, VERSION } from "./protocol";
import { Sight, type Options as SightOptions } from "./sight.svelte";
import { announce, isSeen, type Kept, keep, markSeen, recall, tokenOfLink } from "./store";
import { Voice, type Options as VoiceOptions } from "./voice.svelte";

export interface Line {
  key: string;
  from: "user" | "agent";
  text: string;
  /** Milliseconds since 1970; undefined until the server confirms the line. */
  time?: number;
  /** The first line of a conversation that replaces a lost one. */
  anew?: boolean;
  /** The server refused the line, and would refuse it again. */
  refused?: boolean;
  /** The part that the visitor heard, if the agent's speech was cut. */
  heard?: string;
}

/** Milliseconds between two `writing` frames. */
const WRITING = 2000;

/** A conversation as a window shows it: its lines, the growing utterance, and the state of the connection. */
export class Conversation {
  /** Each change replaces the list. Its lines are plain objects, because there may be thousands. */
  lines: readonly Line[] = $state.raw([]);
  partial = $state("");
  typing = $state(false);
  /** Whether the agent's clock stands still. */
  paused = $state(false);
  /** Things that the visitor could say first. */
  suggestions: readonly string[] = $state.raw([]);
  /** The note above the suggestions; empty if this browser has shown it before. */
  note = $state("");
  agent = $state("Ravestate");
  status: Status = $state("connecting");
  /** Whether earlier lines are still arriving after a reload; screen readers need not read them. */
  recalling = $state(false);
  /** A link to the board, with its secrets; empty if there is none. */
  inside = $state("");
  /** Why the conversation has ended. */
  ending = $state("");
  /** The latest error of the server. */
  trouble = $state("");
  readonly voice: Voice;
  readonly sight: Sight;

  #kept: Kept = recall();
  #outbox: Say[];
  #last = 0; // The number of the last message that the window has.
  #recalled = 0; // The number of the last message from before a reload.
  #anew = false; // Whether the next message begins a conversation that replaces a lost one.
  #epoch = 0; // The number of conversations so far, for unique keys of lines.
  #listens = false; // Whether the server accepts `writing`.
  #told = Number.NEGATIVE_INFINITY; // The time of the last `writing`.
  #connection: Connection;

  constructor(
    options: Pick<Options, "open" | "backoff"> & {
      devices?: VoiceOptions["open"];
      camera?: SightOptions["open"];
    } = {},
  ) {
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
      onsound: (sound) => this.voice.play(sound),
      onstatus: (status) => {
        this.status = status;
        if (status === "open" || status === "silent") return;
        this.typing = this.paused = false;
        if (status !== "lost" && status !== "connecting") {
          this.voice.pause("");
          this.sight.pause("");
        }
        this.voice.disconnected();
        this.sight.disconnected();
      },
    });
    this.voice = new Voice({
      send: (frame) => this.#connection.send(frame),
      sendSound: (sound) => this.#connection.sendSound(sound),
      ...(options.devices === undefined ? {} : { open: options.devices }),
    });
    this.sight = new Sight({
      send: (frame) => this.#connection.send(frame),
      sendPicture: (n, picture) => this.#connection.sendPicture(n, picture),
      ...(options.camera === undefined ? {} : { open: options.camera }),
    });
  }

  start(): void {
    this.status = "connecting";
    this.#connection.start();
  }

  stop(): void {
    this.voice.pause("");
    this.sight.pause("");
    this.#connection.stop();
  }

  nudge(): void {
    this.#connection.nudge();
  }

  /** Tell the server now and then that the visitor is writing. */
  write(): void {
    const now = performance.now();
    if (!this.#listens || now - this.#told < WRITING) return;
    if (this.#connection.send({ type: "writing" })) this.#told = now;
  }

  /** Say something. It arrives exactly once, even if the connection breaks. */
  say(text: string): void {
    markSeen(this.note);
    this.note = "";
    const say: Say = { type: "say", id: crypto.getRandomValues(new Uint32Array(3)).join("-"), text };
    this.trouble = "";
    this.#told = Number.NEGATIVE_INFINITY; // the next key press sends `writing` again
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

  /** Leave for good; the agent may still say goodbye. */
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
      this.note = frame.note !== undefined && !isSeen(frame.note) ? frame.note : "";
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
      this.voice.connected(frame.voice === true);
      this.sight.connected(frame.sight ?? "");
      for (const say of this.#outbox) this.#connection.send(say); // the server ignores texts that it has already
    } else if (frame.type === "renamed") this.agent = frame.agent;
    else if (frame.type === "message") this.#hear(frame);
    else if (frame.type === "piece") this.partial = this.partial.slice(0, frame.at) + frame.text;
    else if (frame.type === "typing") this.typing = frame.on;
    else if (frame.type === "paused") this.paused = frame.on;
    else if (frame.type === "heard") this.#mark(frame.n, frame.text);
    else if (frame.type === "error") {
      this.trouble = frame.text;
      if (frame.id !== undefined) this.#giveUp(frame.id);
    } else if (frame.type === "ended") {
      this.ending = frame.text;
      this.#forget();
    } else if (frame.type === "look" || frame.type === "faces" || frame.type === "unseen")
      this.sight.take(frame);
    else this.voice.take(frame);
  }

  #mark(n: number, heard: string): void {
    const key = `${this.#epoch}/${n}`;
    this.lines = this.lines.map((line) => (line.key === key ? { ...line, heard } : line));
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
      ...(message.heard === undefined ? {} : { heard: message.heard }),
    };
    if (this.#anew) {
      line.anew = true;
      this.#anew = false;
    }
    // Lines that the server has not confirmed stay at the end.
    const others =
      message.id === undefined ? this.lines : this.lines.filter((other) => other.key !== line.key);
    let end = others.length;
    while (end > 0 && others[end - 1]?.time === undefined) end -= 1;
    this.lines = [...others.slice(0, end), line, ...others.slice(end)];
    if (message.from === "agent") {
      this.partial = "";
    } else if (message.id !== undefined) this.#settle(message.id);
  }

  /** Remove confirmed words from the outbox. */
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

  /** Return a link to the board. The secrets are in its fragment, which browsers send nowhere. */
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
