import { type Address, Link, type Status } from "./link";
import type { Command, Diagram, Explained, Policy, ServerFrame, Shown, TraceRecord, Why } from "./protocol";
import { type Spike, Trace } from "./trace";
import { View } from "./view";

export interface Conversation {
  visitor: string;
  name: string | null;
  /** Milliseconds since 1970. */
  began: number;
  /** The visitor's last words. */
  said: string | null;
}

const RECENT = 60; // causes that may be chosen from

const EMPTY: Policy = { modules: [], rules: [], signals: [], slots: [], diagram: null };

/** All that the page knows: the policy, the trace, what is selected, and the connection. */
export class Board {
  status: Status = $state("connecting");
  title = $state("Ravestate");
  live = $state(true);
  visitor: string | null = $state(null);
  conversations: Conversation[] = $state.raw([]);
  /** How many more there are. */
  unlisted = $state(0);
  /** The file of the recording that is looked at. */
  recording: string | null = $state(null);
  policy: Policy = $state.raw(EMPTY);
  paused = $state(false);
  /** Records and spikes that were not seen. */
  missed = $state(0);
  /** Records that are still to come, of the past. */
  behind = $state(0);
  whole = $state(true);
  trouble = $state("");
  /** What was to be done and was refused, until somebody takes it up to mend it. */
  refused: { command: Command; typed: string } | null = $state.raw(null);
  ending = $state("");
  /** Counts the batches of records: whoever shows something of the trace looks at it. */
  version = $state(0);
  rule: string | null = $state(null);
  spike: number | null = $state(null);
  why: Why | null = $state.raw(null);
  asking = $state(false);
  explained: Explained | null = $state.raw(null);
  diagram: Diagram | null = $state.raw(null);
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
  /** The signals that background rules hear, and nobody else. */
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
  #asked: number | null = null; // the spike that "why not" was asked of last
  #sent: { command: Command; typed: string } | null = null; // what was to be done last
  #lent = false; // whether the cause was the newest when a rule was looked at for it
  #before: Address = {}; // what was looked at before a recording
  #address: Address;
  #link: Link;
  #now = 0;
  #at = 0;

  /**
   * @param address what is looked at first
   * @param keep is told what is looked at, so that it can be found again after a reload
   * @param open makes the connection
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

  /** Look at something else. */
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

  /** Look at a recording, from a file of some name. */
  play(recording: string, file: string): void {
    if (this.recording === null) this.#before = this.#address;
    this.turnTo({ recording });
    this.recording = file;
  }

  /** Look at what was looked at before the recording. */
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
   * Send a command; whether it went out.
   * @param typed what somebody typed for it, to be mended if it is refused
   */
  send(command: Command, typed = ""): boolean {
    const sent = this.#link.send(command);
    this.refused = null;
    this.#sent = sent ? { command, typed } : null;
    this.trouble = sent ? "" : "There is no connection to the agent.";
    return sent;
  }

  /** Whether there is an agent that could do something. */
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

  /** Ask about the cause of a spike from now on; without one, about whichever is the newest. */
  point(spike: number | null): void {
    this.#lent = false;
    this.spike = spike;
    this.#ask();
  }

  /** Look at what a rule made of a cause. */
  enter(rule: string, spike: number): void {
    const lent = this.#lent || this.spike === null;
    this.select(rule);
    this.point(spike);
    this.#lent = lent;
  }

  /** Look at no rule any more; and at the newest cause, unless somebody has chosen one. */
  leave(): void {
    this.select(null);
    if (this.#lent) this.point(null);
  }

  /** Ask about a cause from now on, and see what came of it: of its runs, or else of whatever took it. */
  visit(spike: Spike): void {
    this.point(spike.id);
    const bars = this.trace.made(spike);
    const ran = bars.filter((bar) => bar.phases.some((phase) => phase.state === "running"));
    let end = spike.time + 0.01;
    for (const bar of ran.length > 0 ? ran : bars) end = Math.max(end, bar.to ?? this.now());
    this.view.fit(spike.time, end);
    this.follow(false);
  }

  /** Whatever is the newest cause is asked about from now on. */
  visitNewest(): void {
    this.point(null);
    if (this.live) this.follow(true);
    else if (this.cause !== undefined) {
      this.visit(this.cause);
      this.point(null);
    }
  }

  /** Ask again, of what has happened since. */
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

  /** The trace as a file that the board opens. */
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

  /** The rules that the search finds; null while nothing is searched for. */
  get found(): ReadonlySet<string> | null {
    return this.#found;
  }

  /**
   * What one may ask about: what came from outside, the newest first; before it the spike that was pointed at. Of what only
   * background rules hear, such as that somebody is writing, the newest of each signal.
   */
  get causes(): readonly Spike[] {
    return this.#causes;
  }

  /** What is asked about: the spike that was pointed at, or else the newest cause that not only background rules hear. */
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

  value(slot: string): Shown | undefined {
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
        if (frame.of !== undefined && frame.of === this.#sent?.command.type) this.refused = this.#sent;
        this.asking = false;
        break;
    }
    this.version++;
    if (frame.type === "records" && this.behind === 0 && this.cause?.id !== this.#asked) this.#ask();
  }

  /** Whose conversation it is, is known now: after a lost connection, or a recording, it is that one again. */
  #settle(visitor: string | null): void {
    if (visitor === null) return;
    const { session, token } = this.#address;
    this.#address = { ...(session === undefined ? { visitor } : { session }) };
    if (token !== undefined) this.#address.token = token;
    this.keep(this.#address);
  }

  #know(policy: Policy): void {
    this.policy = policy;
  }
}

function gaps(records: TraceRecord[]): number {
  let spikes = 0;
  for (const record of records) if (record.kind === "gap") spikes += Math.max(0, record.spikes);
  return spikes;
}
