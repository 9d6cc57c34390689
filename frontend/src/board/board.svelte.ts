import { type Address, Link, type Status } from "./link";
import type {
  Answer,
  ClientFrame,
  Conversation,
  Description,
  Drawing,
  Explained,
  Rendered,
  ServerFrame,
  Settled,
  TraceRecord,
} from "./protocol";
import { type Spike, Trace } from "./trace";
import { View } from "./view";

const RECENT = 60; // the maximum number of causes in the list

/** A command that the server refused, the user's text, and the reason. */
interface Refused {
  command: ClientFrame;
  typed: string;
  text: string;
}

const EMPTY: Description = {
  modules: [],
  rules: [],
  signals: [],
  slots: [],
  diagram: { nodes: [], edges: [] },
};

/** The state of the page: the policy, the trace, the selection and the connection. */
export class Board {
  status: Status = $state("connecting");
  title = $state("Ravestate");
  live = $state(true);
  visitor: string | null = $state(null);
  conversations: Conversation[] = $state.raw([]);
  /** How many conversations the list leaves out. */
  unlisted = $state(0);
  /** The file name of the shown recording. */
  recording: string | null = $state(null);
  policy: Description = $state.raw(EMPTY);
  paused = $state(false);
  /** How many records and spikes the board has missed. */
  missed = $state(0);
  /** How many past records are still to come. */
  behind = $state(0);
  /** Whether the trace has all records from the start of the context on. */
  whole = $state(true);
  /** The latest error, for the user. */
  trouble = $state("");
  /** The command that the server refused, until its form takes it back. */
  refused: Refused | null = $state.raw(null);
  /** Why the conversation has ended. */
  ending = $state("");
  /** The number of frames so far. Views of the trace depend on it, so each frame updates them. */
  version = $state(0);
  /** The chosen rule. */
  rule: string | null = $state(null);
  /** The chosen spike; null for the newest cause. */
  spike: number | null = $state(null);
  /** The answer to the question why the chosen rule did not fire. */
  why: Answer | null = $state.raw(null);
  /** Whether this question waits for its answer. */
  asking = $state(false);
  explained: Explained | null = $state.raw(null);
  diagram: Drawing | null = $state.raw(null);
  search = $state("");
  #found = $derived.by(() => {
    const words = this.search.toLowerCase().split(/\s+/).filter(Boolean);
    if (words.length === 0) return null;
    const found = this.policy.rules.filter((rule) => {
      const text = `${rule.name} ${rule.when} ${rule.writes.join(" ")} ${rule.emits.join(" ")}`.toLowerCase();
      return words.every((word) => text.includes(word));
    });
    return new Set(found.map((rule) => rule.name));
  });
  #causes = $derived.by(() => {
    void this.version;
    const asides = new Set<string>();
    const inputs = this.trace.inputs(RECENT, (spike) => {
      const first = !asides.has(spike.signal);
      if (!this.#isAside(spike)) return true;
      asides.add(spike.signal);
      return first;
    });
    const pointed = this.spike === null ? undefined : this.trace.spike(this.spike);
    if (pointed === undefined || inputs.includes(pointed)) return inputs;
    const same = inputs.findIndex(({ group }) => group === pointed.group);
    return same >= 0 && pointed.outside ? inputs.with(same, pointed) : [pointed, ...inputs];
  });
  /** The signals that only background rules hear. */
  #aside = $derived.by(() => {
    const background = new Set(this.policy.rules.filter((rule) => rule.background).map(({ name }) => name));
    const heard = this.policy.signals.filter(({ hearers }) => hearers.length > 0);
    return new Set(
      heard.filter(({ hearers }) => hearers.every((name) => background.has(name))).map(({ name }) => name),
    );
  });
  view = new View();
  follows = $state(true);
  trace = new Trace();
  #asked: number | null = null; // The spike of the last "why not".
  #sent: { command: ClientFrame; typed: string } | null = null; // The last command.
  #lent = false; // Whether closing the rule returns to the newest cause.
  #before: Address = {}; // The address that the board showed before a recording.
  #address: Address;
  #link: Link;
  #now = 0; // The context's time in the last frame (seconds).
  #at = 0; // The time at which the last frame came (milliseconds).

  /**
   * @param address the first conversation or recording
   * @param keep stores the address, for a reload
   * @param open opens the connection
   */
  constructor(
    address: Address,
    private readonly keep: (address: Address) => void = () => {},
    open?: () => WebSocket,
  ) {
    this.#address = address;
    this.#link = new Link({
      address: () => this.#address,
      onframe: (frame) => this.take(frame),
      onstatus: (status) => {
        this.status = status;
        const { session, chosen } = this.#address;
        if (status === "gone" && session !== undefined && !chosen) this.turnTo({}); // that conversation is over
      },
      ...(open === undefined ? {} : { open }),
    });
  }

  start(): void {
    this.#link.start();
  }

  stop(): void {
    this.#link.stop();
  }

  /** Show another conversation or recording. */
  turnTo(address: Address): void {
    const { token } = this.#address;
    this.#address = { ...(token === undefined ? {} : { token }), ...address };
    this.rule = this.spike = this.recording = null;
    this.refused = this.#sent = null;
    this.ending = this.trouble = "";
    this.view = new View();
    this.follows = true;
    this.start();
  }

  /** Show a conversation that began in this browser, unless the user has chosen another one. */
  meet(session: string): void {
    const address = this.recording === null ? this.#address : this.#before;
    if (address.chosen || address.session === session) return;
    if (this.recording === null) this.turnTo({ session });
    else this.#before = { session };
  }

  /** Show a recording from a file. */
  play(recording: string, file: string): void {
    if (this.recording === null) this.#before = this.#address;
    this.turnTo({ recording });
    this.recording = file;
  }

  /** Return from a recording to the conversation before it. */
  back(): void {
    this.turnTo(this.#before);
  }

  present(token: string): void {
    this.#address = { ...this.#address, token };
    this.start();
  }

  get token(): string | undefined {
    return this.#address.token;
  }

  /**
   * Send a command; return whether there is a connection.
   * @param typed the user's text for it, which comes back if the server refuses the command
   */
  send(command: ClientFrame, typed = ""): boolean {
    const sent = this.#link.send(command);
    this.refused = null;
    this.#sent = sent ? { command, typed } : null;
    this.trouble = sent ? "" : "The board is not connected to the agent.";
    return sent;
  }

  /** Take back a refused command of a type, for the form that sent it. */
  takeBack<T extends ClientFrame["type"]>(type: T): (Refused & { command: { type: T } }) | null {
    const { refused } = this;
    if (refused?.command.type !== type) return null;
    this.refused = null;
    this.trouble = ""; // the form shows the reason
    return refused as Refused & { command: { type: T } };
  }

  /** Whether a running agent takes commands. */
  get acts(): boolean {
    return this.live && this.status === "open";
  }

  /** The context's time now (seconds). */
  now(): number {
    if (!this.live || this.paused || this.status !== "open") return this.#now;
    return this.#now + (performance.now() - this.#at) / 1000;
  }

  select(rule: string | null): void {
    if (rule !== null && !this.policy.rules.some((known) => known.name === rule)) return;
    this.rule = rule;
    this.explained = null;
    this.#ask();
    this.explain();
  }

  /** Ask about the cause of a spike from now on; null: about the newest cause. */
  point(spike: number | null): void {
    this.#lent = false;
    this.spike = spike;
    this.#ask();
  }

  /** Show how a rule handled a cause. */
  enter(rule: string, spike: number): void {
    const lent = this.#lent || this.spike === null;
    this.select(rule);
    this.point(spike);
    this.#lent = lent;
  }

  /** Close the rule, and return to the newest cause unless the user chose another one. */
  leave(): void {
    this.select(null);
    if (this.#lent) this.point(null);
  }

  /** Ask about a cause from now on. Show the time of its runs or, without runs, of the activations that took it. */
  visit(spike: Spike): void {
    this.point(spike.id);
    const bars = this.trace.made(spike);
    const ran = bars.filter((bar) => bar.phases.some((phase) => phase.state === "running"));
    let end = spike.time + 0.01;
    for (const bar of ran.length > 0 ? ran : bars) end = Math.max(end, bar.to ?? this.now());
    this.view.fit(spike.time, end);
    this.follow(false);
  }

  /** Ask about the newest cause from now on. */
  visitNewest(): void {
    this.point(null);
    if (this.live) this.follow(true);
    else if (this.cause !== undefined) {
      this.visit(this.cause);
      this.point(null);
    }
  }

  /** Ask the last question again. */
  again(): void {
    this.#ask();
  }

  explain(): void {
    if (this.rule !== null && this.live && this.status === "open") {
      this.#link.send({ type: "explain", rule: this.rule });
    }
  }

  unfold(modules: string[]): void {
    this.#link.send({ type: "diagram", unfolded: modules });
  }

  follow(follows: boolean): void {
    this.view.follows = this.follows = follows;
  }

  /** The name of the conversation's file: the agent, the visitor, and the time of its start. */
  get fileName(): string {
    const known = this.conversations.find(({ visitor }) => visitor === this.visitor);
    const parts = [this.title, known?.name ?? this.visitor ?? this.recording?.replace(/\.json$/, "") ?? ""];
    if (known !== undefined) {
      const began = new Date(known.began - new Date(known.began).getTimezoneOffset() * 60_000);
      parts.push(began.toISOString().slice(0, 16));
    }
    const name = parts.filter(Boolean).join("-").toLowerCase();
    return `${name.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/-trace$/, "")}-trace.json`;
  }

  /** The trace as text, for a file that the board opens. */
  export(): string {
    return JSON.stringify({
      format: "ravestate-trace",
      v: 1,
      title: this.title,
      whole: this.whole && this.missed === 0,
      policy: this.policy,
      records: this.trace.records,
    });
  }

  /** The runs that failed. */
  get failures(): readonly Settled[] {
    void this.version;
    return this.trace.failures;
  }

  /** The rules that the search finds; null without a search. */
  get found(): ReadonlySet<string> | null {
    return this.#found;
  }

  /**
   * The causes that a user may ask about: input from outside, newest first, with the chosen spike before it. A signal
   * that only background rules hear, such as typing, appears once, with its newest spike.
   */
  get causes(): readonly Spike[] {
    return this.#causes;
  }

  /** The cause of the question: the chosen spike, or else the newest cause that a foreground rule hears. */
  get cause(): Spike | undefined {
    const causes = this.#causes;
    return (
      causes.find((spike) => spike.id === this.spike) ??
      causes.find((spike) => !this.#isAside(spike)) ??
      causes[0]
    );
  }

  #isAside(spike: Spike): boolean {
    return this.trace.siblings(spike).every(({ signal }) => this.#aside.has(signal));
  }

  value(slot: string): Rendered | undefined {
    return this.trace.slots.get(slot)?.shown;
  }

  #ask(): void {
    this.#asked = this.cause?.id ?? null;
    if (this.why?.rule !== this.rule || this.why?.spike !== this.#asked) this.why = null;
    if (this.rule === null || this.#asked === null) return;
    this.asking = this.#link.send({ type: "why", rule: this.rule, spike: this.#asked });
  }

  take(frame: ServerFrame): void {
    if ("now" in frame && frame.type !== "explained") {
      this.#now = frame.now;
      this.#at = performance.now();
      this.paused = frame.paused;
    }
    switch (frame.type) {
      case "welcome":
        this.refused = this.#sent = null;
        this.trace = new Trace();
        this.missed = this.behind = 0;
        this.title = frame.title;
        this.live = frame.live;
        this.visitor = frame.visitor;
        this.#settle(frame.visitor);
        this.whole = frame.whole;
        if (!frame.live) this.follow(false);
        this.#know(frame.policy);
        this.diagram = null;
        this.unfold(frame.policy.rules.length <= 40 ? frame.policy.modules : []);
        if (this.rule !== null) this.select(this.rule);
        break;
      case "renamed":
        this.title = frame.title;
        break;
      case "policy":
        this.#know(frame.policy);
        break;
      case "state":
        for (const [slot, shown] of Object.entries(frame.slots)) {
          const known = this.trace.slots.get(slot);
          this.trace.slots.set(slot, { shown, time: known?.time ?? Number.NEGATIVE_INFINITY });
        }
        if (this.live && this.behind === 0 && this.trace.records.length > 0) {
          this.trace.reconcile(frame.activations, frame.now);
        }
        break;
      case "records": {
        const begins = this.trace.records.length === 0;
        this.missed += frame.missed + gaps(frame.records);
        this.behind = frame.behind;
        this.trace.add(frame.records);
        if (!this.live && (begins || frame.behind === 0)) this.view.fit(this.trace.first, this.trace.last);
        break;
      }
      case "conversations":
        this.conversations = frame.conversations;
        this.unlisted = frame.more;
        break;
      case "why":
        if (frame.rule === this.rule && frame.spike === this.#asked) {
          this.why = frame;
          this.asking = false;
        }
        break;
      case "explained":
        if (frame.rule === this.rule) this.explained = frame;
        break;
      case "diagram":
        this.diagram = frame;
        break;
      case "ended":
        this.ending = frame.text;
        break;
      case "error":
        this.trouble = frame.text;
        if (this.#sent !== null && frame.of === this.#sent.command.type) {
          this.refused = { ...this.#sent, text: frame.text };
        }
        this.asking = false;
        break;
    }
    this.version++;
    if (frame.type === "records" && this.behind === 0 && this.cause?.id !== this.#asked) this.#ask();
  }

  /** Keep the address of the conversation, for the next connection. */
  #settle(visitor: string | null): void {
    if (visitor === null) return;
    const { session, token, chosen } = this.#address;
    this.#address = { ...(session === undefined ? { visitor } : { session }) };
    if (token !== undefined) this.#address.token = token;
    if (chosen) this.#address.chosen = true;
    this.keep(this.#address);
  }

  #know(policy: Description): void {
    this.policy = policy;
  }
}

function gaps(records: TraceRecord[]): number {
  let spikes = 0;
  for (const record of records) if (record.kind === "gap") spikes += Math.max(0, record.spikes ?? 0);
  return spikes;
}
