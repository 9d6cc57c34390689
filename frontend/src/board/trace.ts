import type { Alive, Rendered, Settled, TraceRecord } from "./protocol";
import { Sound } from "./sound";
import { Vision } from "./vision";

/** The state of an activation. */
export type State = "gathering" | "complete" | "waiting" | "running";

export interface Phase {
  state: State;
  from: number;
  /** The rules that the activation waits for, and the latest end of the wait (seconds). */
  waits?: string[];
  until?: number | null;
}

/** One activation of a rule, from its first spike to its end. */
export interface Bar {
  id: number;
  rule: string;
  clause: number;
  from: number;
  /** Its end (seconds); null while it is alive. */
  to: number | null;
  phases: Phase[];
  /** The outcome of its run (`done`, `resigned`, ...), or the reason why it gave up its spikes (`age`, `consumed`, ...). */
  outcome: string;
  reason: string;
  /** The rule that answered instead or resigned, and the number of its run (0 if the number is unknown). */
  by: string;
  run: number;
  holds: Set<number>;
  spikes: number[];
  lacks: string[];
  row: number;
}

export interface Lane {
  rule: string;
  bars: Bar[];
  open: Set<Bar>;
  /** The length of its longest bar (seconds). */
  longest: number;
  rows: number;
  /** The end of the last bar in each row. */
  ends: number[];
  retired: boolean;
}

export interface Spike {
  id: number;
  signal: string;
  time: number;
  group: number;
  parents: number[];
  children: number[];
  /** The rule that raised it; empty if none did, or if that is unknown. */
  rule: string;
  /** Whether it came from outside: neither a rule nor the context itself raised it. */
  outside: boolean;
  payload: Rendered;
  dropped: string;
}

export interface Gap {
  time: number;
  spikes: number;
}

const MOST_ROWS = 4;

/** The trace as lanes, spikes, groups and slots, updated as records arrive. */
export class Trace {
  records: TraceRecord[] = [];
  lanes = new Map<string, Lane>();
  spikes: Spike[] = [];
  slots = new Map<string, { shown: Rendered; time: number }>();
  gaps: Gap[] = [];
  /** The voices of a spoken conversation. */
  sound = new Sound();
  vision = new Vision();
  /** The runs that failed. */
  failures: Settled[] = [];
  /** The last time of each signal (seconds). */
  occurred = new Map<string, number>();
  first = 0;
  last = 0;
  #spikes = new Map<number, Spike>();
  #bars = new Map<number, Bar>();
  #into = new Map<number, number>();

  /** @param kept the minimum number of records to keep; the oldest go first */
  constructor(private readonly kept = 100_000) {}

  add(records: TraceRecord[]): void {
    for (const record of records) this.#add(record);
    if (this.records.length > this.kept * 1.25) this.#forget();
  }

  /** Compare the bars with the live activations on the server, and end the bars whose end was missed. */
  reconcile(activations: Alive[], now: number): void {
    const alive = new Set(activations.map((activation) => activation.id));
    for (const lane of this.lanes.values()) {
      for (const bar of [...lane.open]) {
        if (!alive.has(bar.id)) this.#end(bar, now, "unseen", "the board missed its end");
      }
    }
    for (const activation of activations) {
      if (this.#bars.has(activation.id)) continue;
      const oldest = Math.max(0, ...activation.holds.map(([, age]) => age));
      const bar = this.#bar(activation.id, activation.rule, 0, now - oldest);
      const known: State[] = ["waiting", "running", "gathering"];
      const state = activation.state === "cancelling" ? "running" : (activation.state as State);
      bar.lacks = activation.lacks;
      this.#phase(bar, known.includes(state) ? state : "complete", now - oldest);
    }
    this.last = Math.max(this.last, now);
  }

  spike(id: number): Spike | undefined {
    return this.#spikes.get(id);
  }

  bar(id: number): Bar | undefined {
    return this.#bars.get(id);
  }

  lane(rule: string): Lane {
    let lane = this.lanes.get(rule);
    if (lane === undefined) {
      lane = { rule, bars: [], open: new Set(), longest: 0, rows: 1, ends: [], retired: false };
      this.lanes.set(rule, lane);
    }
    return lane;
  }

  /** Return the group that a causal group has finally merged into. */
  group(id: number): number {
    let root = id;
    for (let into = this.#into.get(root); into !== undefined; into = this.#into.get(root)) root = into;
    for (let at = id; at !== root; ) {
      const into = this.#into.get(at) ?? root;
      this.#into.set(at, root); // shorten the path for the next call
      at = into;
    }
    return root;
  }

  /** Return the rule that raised the input of the run that answered instead; empty if unknown, or if no rule did. */
  behind(bar: Bar): string {
    const groups = new Set(bar.spikes.map((id) => this.#groupOf(id)));
    for (const id of this.#bars.get(bar.run)?.spikes ?? []) {
      const rule = this.#spikes.get(id)?.rule ?? "";
      if (rule !== "" && rule !== bar.by && groups.has(this.#groupOf(id))) return rule;
    }
    return "";
  }

  /** Return a spike with its ancestors and descendants. */
  kin(id: number): Set<number> {
    const found = new Set<number>();
    const follow = (start: number, next: (spike: Spike) => number[]) => {
      const stack = [start];
      for (let at = stack.pop(); at !== undefined; at = stack.pop()) {
        const spike = this.#spikes.get(at);
        if (spike === undefined) continue;
        found.add(at);
        for (const other of next(spike)) if (!found.has(other)) stack.push(other);
      }
    };
    follow(id, (spike) => spike.parents);
    found.delete(id);
    follow(id, (spike) => spike.children);
    return found;
  }

  /**
   * Return the spikes from outside, newest first. A write of a slot raises several signals of one causal group: the last
   * spike represents them.
   */
  inputs(most: number, counts: (spike: Spike) => boolean = () => true): Spike[] {
    const found: Spike[] = [];
    let group = 0;
    for (let i = this.spikes.length - 1; i >= 0 && found.length < most; i--) {
      const spike = this.spikes[i] as Spike;
      if (!spike.outside || spike.group === group) continue;
      group = spike.group;
      if (counts(spike)) found.push(spike);
    }
    return found;
  }

  /** Return all spikes of the write that raised a spike, including this spike. */
  siblings(spike: Spike): Spike[] {
    const found: Spike[] = [];
    for (let i = from(this.spikes, spike.time, ({ time }) => time); i < this.spikes.length; i++) {
      const other = this.spikes[i] as Spike;
      if (other.time > spike.time) break;
      if (other.outside && other.group === spike.group) found.push(other);
    }
    return found;
  }

  /** Return the activations on the causal group of a spike, in the order of their start. */
  made(spike: Spike): Bar[] {
    const group = this.group(spike.group);
    const ofGroup = (id: number) => {
      const other = this.#spikes.get(id);
      return other !== undefined && this.group(other.group) === group;
    };
    const found: Bar[] = [];
    for (const lane of this.lanes.values()) {
      const since = spike.time - lane.longest;
      for (const bar of lane.open) if (bar.from < since && bar.spikes.some(ofGroup)) found.push(bar);
      for (let i = from(lane.bars, since, (bar) => bar.from); i < lane.bars.length; i++) {
        const bar = lane.bars[i] as Bar;
        if (bar.spikes.some(ofGroup)) found.push(bar);
      }
    }
    return found.sort((a, b) => a.from - b.from || a.id - b.id);
  }

  #add(record: TraceRecord): void {
    if (this.records.length === 0) this.first = record.time;
    this.records.push(record);
    this.last = Math.max(this.last, record.time);
    this.sound.add(record);
    this.vision.add(record);
    switch (record.kind) {
      case "born": {
        const spike: Spike = {
          id: record.spike,
          signal: record.signal,
          time: record.time,
          group: record.group,
          parents: record.parents,
          children: [],
          rule: this.#bars.get(record.source)?.rule ?? "",
          outside: record.source === 0 && record.parents.length === 0 && !record.signal.startsWith("core:"),
          payload: record.payload,
          dropped: "",
        };
        this.spikes.push(spike);
        this.#spikes.set(spike.id, spike);
        for (const parent of spike.parents) this.#spikes.get(parent)?.children.push(spike.id);
        this.occurred.set(spike.signal, spike.time);
        break;
      }
      case "dropped": {
        const spike = this.#spikes.get(record.spike);
        if (spike !== undefined) spike.dropped = record.reason;
        break;
      }
      case "merged":
        if (this.group(record.into) !== record.group) this.#into.set(record.group, record.into); // a damaged file may merge groups in a circle
        break;
      case "set":
        this.slots.set(record.slot, { shown: record.value, time: record.time });
        break;
      case "held": {
        const bar = this.#bar(record.activation, record.rule, record.clause, record.time);
        bar.holds.add(record.spike);
        bar.spikes.push(record.spike);
        bar.lacks = record.lacks;
        this.#phase(bar, record.lacks.length > 0 ? "gathering" : "complete", record.time);
        break;
      }
      case "gaveup": {
        const bar = this.#bars.get(record.activation);
        if (bar === undefined || bar.to !== null) break;
        bar.holds.delete(record.spike);
        bar.lacks = [...bar.lacks, record.signal];
        if (bar.holds.size > 0) {
          this.#phase(bar, "gathering", record.time);
          break;
        }
        bar.by = record.by ?? "";
        bar.run = record.run ?? 0;
        this.#end(bar, record.time, record.reason, "");
        break;
      }
      case "waits": {
        const bar = this.#bars.get(record.activation);
        if (bar !== undefined) this.#phase(bar, "waiting", record.time, record.for, record.until);
        break;
      }
      case "started": {
        const bar = this.#bar(record.run, record.rule, record.clause, record.time);
        if (bar.spikes.length === 0) bar.spikes.push(...record.spikes);
        this.#phase(bar, "running", record.time);
        break;
      }
      case "settled": {
        const bar = this.#bars.get(record.run);
        if (bar !== undefined) this.#end(bar, record.time, record.outcome, record.reason);
        if (record.outcome === "failed") this.failures.push(record);
        if (record.outcome === "retired") this.lane(record.rule).retired = true;
        break;
      }
      case "gap":
        this.gaps.push({ time: record.time, spikes: record.spikes ?? -1 });
        break;
    }
  }

  #bar(id: number, rule: string, clause: number, time: number): Bar {
    const known = this.#bars.get(id);
    if (known !== undefined) return known;
    const lane = this.lane(rule);
    let row = 0;
    while (row < MOST_ROWS - 1 && (lane.ends[row] ?? Number.NEGATIVE_INFINITY) > time) row++;
    lane.ends[row] = Number.POSITIVE_INFINITY;
    lane.rows = Math.max(lane.rows, row + 1);
    const bar: Bar = {
      id,
      rule,
      clause,
      from: time,
      to: null,
      phases: [],
      outcome: "",
      reason: "",
      by: "",
      run: 0,
      holds: new Set(),
      spikes: [],
      lacks: [],
      row,
    };
    this.#bars.set(id, bar);
    lane.bars.push(bar);
    lane.open.add(bar);
    return bar;
  }

  #groupOf(spike: number): number | undefined {
    const group = this.#spikes.get(spike)?.group;
    return group === undefined ? undefined : this.group(group);
  }

  #phase(bar: Bar, state: State, from: number, waits?: string[], until?: number | null): void {
    const last = bar.phases.at(-1);
    if (last !== undefined && last.state === state && waits === undefined) return;
    const phase: Phase = { state, from };
    if (waits !== undefined) {
      phase.waits = waits;
      phase.until = until ?? null;
    }
    bar.phases.push(phase);
  }

  #end(bar: Bar, time: number, outcome: string, reason: string): void {
    const lane = this.lane(bar.rule);
    bar.to = time;
    bar.outcome = outcome;
    bar.reason = reason;
    bar.holds.clear();
    lane.open.delete(bar);
    lane.longest = Math.max(lane.longest, time - bar.from);
    lane.ends[bar.row] = time;
  }

  /** Forget the oldest records, and everything that depends on them. */
  #forget(): void {
    this.records = this.records.slice(-this.kept);
    this.first = this.records[0]?.time ?? 0;
    const gone = (time: number) => time < this.first;
    this.sound.forget(this.first);
    this.vision.forget(this.first);
    for (const spike of this.spikes) if (gone(spike.time)) this.#spikes.delete(spike.id);
    this.spikes = this.spikes.filter((spike) => !gone(spike.time));
    this.gaps = this.gaps.filter((gap) => !gone(gap.time));
    this.failures = this.failures.filter((failure) => !gone(failure.time));
    for (const lane of this.lanes.values()) {
      for (const bar of lane.bars) if (bar.to !== null && gone(bar.to)) this.#bars.delete(bar.id);
      lane.bars = lane.bars.filter((bar) => bar.to === null || !gone(bar.to));
    }
    const groups = new Set(this.spikes.map((spike) => spike.group));
    for (const group of groups) this.group(group); // shorten the paths, whose middle is deleted next
    for (const group of this.#into.keys()) if (!groups.has(group)) this.#into.delete(group);
  }
}

/** The glyph of a run's end. */
export function endState(outcome: string): "done" | "failed" | "resigned" | "interrupted" {
  if (outcome === "failed" || outcome === "resigned") return outcome;
  return outcome === "interrupted" || outcome === "wiped" ? "interrupted" : "done";
}

/** Return the index of the first item at or after a time. */
export function from<T>(items: readonly T[], time: number, of: (item: T) => number): number {
  let low = 0;
  let high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (of(items[middle] as T) < time) low = middle + 1;
    else high = middle;
  }
  return low;
}
