// What the board's server and this page say to each other, version 1: see docs/reference/board-protocol.md.

export const VERSION = 1;

/** A value as text; `json` is false where it is no JSON, or not the whole. */
export interface Shown {
  text: string;
  json?: boolean;
  cut?: boolean;
}

export interface Term {
  signal: string;
  rules: number;
  nats: number;
}

export interface Clause {
  condition: string;
  constraints: {
    signal: string;
    min_age: number;
    max_age: number | null;
    detached: boolean;
    predicates: string[];
  }[];
  gates: { slot: string; text: string }[];
  terms: Term[];
  pathways: number;
  predicates: number;
  utility: number;
  base: number;
}

export interface Rule {
  name: string;
  module: string;
  doc: string;
  origin: string;
  when: string;
  until: string;
  clauses: Clause[];
  reads: string[];
  writes: string[];
  emits: string[];
  raises: string[];
  weight: number;
  cooldown: number;
  patience: number | null;
  timeout: number | null;
  detached: boolean;
  background: boolean;
}

export interface Signal {
  name: string;
  module: string;
  slot: string | null;
  payload: string;
  input: boolean;
  hearers: string[];
  raisers: string[];
}

export interface Slot {
  name: string;
  module: string;
  kind: "value" | "flag" | "collection";
  type: string;
  signals: string[];
  readers: string[];
  writers: string[];
}

export interface Policy {
  modules: string[];
  rules: Rule[];
  signals: Signal[];
  slots: Slot[];
  diagram: unknown;
}

interface OfRule {
  time: number;
  rule: string;
}

interface OfSpike {
  spike: number;
  signal: string;
}

export type TraceRecord =
  | ({
      kind: "born";
      time: number;
      group: number;
      parents: number[];
      source: number;
      payload: Shown;
    } & OfSpike)
  | ({ kind: "dropped"; time: number; reason: string } & OfSpike)
  | { kind: "merged"; time: number; group: number; into: number }
  | { kind: "set"; time: number; slot: string; value: Shown; run: number }
  | ({ kind: "held"; activation: number; clause: number; lacks: string[] } & OfRule & OfSpike)
  | ({ kind: "gaveup"; activation: number; reason: string; by: string; run?: number } & OfRule & OfSpike)
  | ({ kind: "passed"; clause: number; reason: string } & OfRule & OfSpike)
  | ({ kind: "waits"; activation: number; for: string[]; until: number | null } & OfRule)
  | ({ kind: "pressed"; by: string; lacks: string[]; until: number } & OfRule)
  | ({ kind: "started"; run: number; clause: number; spikes: number[] } & OfRule)
  | ({ kind: "told"; run: number; reason: string } & OfRule)
  | ({ kind: "settled"; run: number; outcome: string; reason: string; fired: boolean } & OfRule)
  | { kind: "gap"; time: number; spikes: number };

export interface Activation {
  id: number;
  state: string;
  condition: string;
  holds: [string, number][];
  lacks: string[];
  waits_for: [string, number][];
  until: number | null;
}

export interface Why {
  rule: string;
  spike: number;
  signal: string;
  time: number;
  verdict: string;
  words: string;
  at: number | null;
  clause: number | null;
  missing: { signal: string; words: string; raisers: { rule: string; outcome: string; words: string }[] }[];
  moments: { time: number; words: string; rules: string[] }[];
  whole: boolean;
}

export interface Explained {
  rule: string;
  now: number;
  retired: boolean;
  clauses: { effective: number; gates: [string, boolean][] }[];
  activations: Activation[];
}

export interface DiagramNode {
  id: string;
  kind: "slot" | "signal" | "rule" | "and" | "or" | "module";
  label: string;
  module: string;
  note: string;
  box: [number, number, number, number];
}

export interface DiagramEdge {
  source: string;
  target: string;
  kind: string;
  label: string;
  points: [number, number][];
  box: [number, number, number, number] | null;
}

export interface Diagram {
  width: number;
  height: number;
  unfolded: string[];
  nodes: DiagramNode[];
  edges: DiagramEdge[];
}

interface Clock {
  now: number;
  paused: boolean;
}

export type ServerFrame =
  | ({
      type: "welcome";
      v: number;
      title: string;
      live: boolean;
      visitor: string | null;
      whole: boolean;
      policy: Policy;
    } & Clock)
  | ({
      type: "state";
      slots: Record<string, Shown>;
      activations: (Activation & { rule: string })[];
    } & Clock)
  | ({ type: "records"; records: TraceRecord[]; missed: number; behind: number } & Clock)
  | { type: "renamed"; title: string }
  | { type: "policy"; policy: Policy }
  | {
      type: "conversations";
      conversations: { visitor: string; name: string | null; began: number; said: string | null }[];
      more: number;
    }
  | ({ type: "why" } & Why)
  | ({ type: "explained" } & Explained)
  | ({ type: "diagram" } & Diagram)
  | { type: "ended"; text: string }
  | { type: "error"; code: string; text: string; of?: string }
  | { type: "pong" };

export type Command =
  | { type: "pause" | "step" | "resume" | "look" | "ping" }
  | { type: "put"; slot: string; value: unknown }
  | { type: "emit"; signal: string; payload?: unknown }
  | { type: "say"; text: string }
  | { type: "explain"; rule: string }
  | { type: "why"; rule: string; spike: number }
  | { type: "diagram"; unfolded: string[] };

/** With which code the server closes a connection, where trying again is of no use. */
export const CLOSED = { ended: 1000, notUnderstood: 4400, token: 4401, gone: 4404 } as const;
