// Written by tools/protocol.py from ravestate.board.protocol: change that file, and run the tool.

export const VERSION = 1;

export const CLOSING_CODES = {
  ended: 1000,
  closing: 1001,
  "too-large": 1009,
  full: 1013,
  malformed: 4400,
  token: 4401,
  gone: 4404,
  silent: 4408,
  behind: 4409,
};

/** Reason for which an activation gave up a spike → a phrase for people. */
export const LOSSES = {
  age: "the spike was too old",
  consumed: "another rule answered it",
  resigned: "the rule resigned",
  eliminated: "its patience ran out while others waited",
  withdrawn: "the spike was withdrawn",
  doubled: "another attempt of the rule holds it",
  retired: "the rule retired",
};

/** Verdict → its title and its tone (the colour on the page). */
export const VERDICTS = {
  fired: {
    title: "It fired",
    tone: "good",
  },
  running: {
    title: "It is running",
    tone: "busy",
  },
  waiting: {
    title: "It is ready and waiting",
    tone: "busy",
  },
  outrun: {
    title: "It was ready, but another rule answered",
    tone: "plain",
  },
  failed: {
    title: "It failed",
    tone: "bad",
  },
  resigned: {
    title: "It resigned",
    tone: "plain",
  },
  gated: {
    title: "A slot predicate was false",
    tone: "plain",
  },
  young: {
    title: "A spike was too young",
    tone: "plain",
  },
  eliminated: {
    title: "Its patience ran out",
    tone: "plain",
  },
  withdrawn: {
    title: "A spike was withdrawn",
    tone: "plain",
  },
  lacked: {
    title: "It lacked a signal",
    tone: "plain",
  },
  passed: {
    title: "It did not take the spike",
    tone: "plain",
  },
  untouched: {
    title: "Nothing it hears occurred",
    tone: "plain",
  },
  retired: {
    title: "It had retired",
    tone: "plain",
  },
};

/** A spike was born; `source` is the activation whose run raised it, or 0 if no run raised it. */
export interface Born {
  kind: "born";
  time: number;
  spike: number;
  signal: string;
  group: number;
  parents: number[];
  source: number;
  payload: Rendered;
}

/** A clause, and the parts of its utility (nats). */
export interface ClauseView {
  /** The clause as text. */
  condition: string;
  constraints: ConstraintView[];
  gates: GateView[];
  /** The addends of the pathway with the least utility. This pathway decides the clause's utility. */
  terms: Term[];
  /** The number of the clause's pathways; at most 256, even if the clause has more. */
  pathways: number;
  /** The number of the clause's predicates. Each predicate adds ln 2 to the utility. */
  predicates: number;
  /** The sum of all addends. */
  utility: number;
  /** The effective utility (utility × weight) when the cooldown of the rule is over. */
  base: number;
}

/** A signal in a clause, with ages in seconds (`max_age=None` sets no limit) and the names of its predicates. */
export interface ConstraintView {
  signal: string;
  min_age: number;
  max_age: number | null;
  detached: boolean;
  predicates: string[];
}

/** The nodes and edges of a picture, in declaration order. */
export interface Diagram {
  nodes: Node[];
  edges: Edge[];
}

/** A spike was withdrawn: its signal overflowed, it was wiped, or a later spike replaced it (L20, L23). */
export interface Dropped {
  kind: "dropped";
  time: number;
  spike: number;
  signal: string;
  reason: string;
}

/** An arrow between two nodes, which are given by their ids. The label may be empty. */
export interface Edge {
  source: string;
  target: string;
  kind: "reads" | "writes" | "emits" | "emits_detached" | "condition" | "condition_detached";
  label?: string;
}

/** A gap in the records. */
export interface Gap {
  kind: "gap";
  /** The start of the gap (seconds on the context's clock). */
  time: number;
  /** How many spikes the recorder missed; -1 while that is unknown. */
  spikes?: number;
}

/** A slot predicate of a clause: the slot, and the predicate as text. */
export interface GateView {
  slot: string;
  text: string;
}

/** An activation gave a spike up; `reason` is a `LossReason`. */
export interface GaveUp {
  kind: "gaveup";
  time: number;
  activation: number;
  rule: string;
  spike: number;
  signal: string;
  reason: string;
  by?: string;
  run?: number;
}

/** An activation took a spike; `lacks` are the signals that it still lacks (L12). */
export interface Held {
  kind: "held";
  time: number;
  activation: number;
  rule: string;
  clause: number;
  spike: number;
  signal: string;
  lacks: string[];
}

/** The causal group `group` became part of the group `into` (L11). */
export interface Merged {
  kind: "merged";
  time: number;
  group: number;
  into: number;
}

/** A signal that the rule lacked, the reason why it was missing (`words`), and the rules that may raise it. */
export interface Missing {
  signal: string;
  words: string;
  raisers: Raiser[];
}

/** Something that happened to the rule for the cause, at `time` (seconds); `rules` are the other rules involved. */
export interface Moment {
  time: number;
  words: string;
  rules?: string[];
}

/** A slot, a signal, a rule, a folded module, or the junction of a conjunction or disjunction. */
export interface Node {
  /** The node's unique name within the diagram. */
  id: string;
  /** The node's kind. */
  kind: "slot" | "signal" | "rule" | "module" | "and" | "or";
  /** The text inside the node; empty for a junction. */
  label?: string;
  /** The module that declares the slot, signal or rule; empty for a junction and for a module. */
  module?: string;
  /** Options such as a weight, or the number of rules of a module; may be empty. */
  note?: string;
}

/**
 * A rule did not take a spike.
 *
 * `reason` is a `PassReason`: the spike's `payload` did not fit, its cause was `consumed`, or the rule itself had `caused` the spike.
 */
export interface Passed {
  kind: "passed";
  time: number;
  rule: string;
  clause: number;
  spike: number;
  signal: string;
  reason: string;
  by?: string;
  run?: number;
}

/**
 * The rival `rule` is under pressure: the rule `by` waits for it (L16).
 *
 * The rival lacks the signals `lacks`. Its patience ends at `until`.
 */
export interface Pressed {
  kind: "pressed";
  time: number;
  rule: string;
  by: string;
  lacks: string[];
  until: number;
}

/** A rule that may raise a missing signal, and the outcome of its run for the cause. */
export interface Raiser {
  rule: string;
  /** The outcome of the rule's run, or `running`, or `not run`. */
  outcome: string;
  /** The time at which the run ended (seconds). Without a run, the time at which the rule's furthest attempt stopped. The time is None while the run or the attempt is in progress, or if there was neither. */
  time: number | null;
  /** The outcome as a sentence. */
  words: string;
}

/**
 * A rule as declared. Its times are in seconds, and its `origin` is a file and a line.
 *
 * `raises` has all signals that the rule may raise, including those of the slots that it writes.
 */
export interface RuleView {
  name: string;
  module: string;
  doc: string;
  origin: string;
  when: string;
  until: string;
  clauses: ClauseView[];
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

/** A slot got a value; `run` is the activation whose run wrote it, or 0 if no run wrote it. */
export interface Set {
  kind: "set";
  time: number;
  slot: string;
  value: Rendered;
  run: number;
}

/**
 * The run of the activation `run` has ended; `outcome` is an `Outcome` (L18).
 *
 * `fired` says whether the run consumed its spikes.
 */
export interface Settled {
  kind: "settled";
  time: number;
  run: number;
  rule: string;
  outcome: string;
  reason: string;
  fired: boolean;
  error?: string;
}

/** A signal: its module, slot and payload, whether it is an input, and the rules that wait for it or raise it. */
export interface SignalView {
  name: string;
  module: string;
  slot: string | null;
  payload: string;
  input: boolean;
  hearers: string[];
  raisers: string[];
}

/** A slot: its kind (`value`, `flag` or `collection`), type and signals, and the rules that use it. */
export interface SlotView {
  name: string;
  module: string;
  kind: string;
  type: string;
  signals: string[];
  readers: string[];
  writers: string[];
}

/**
 * A rule's function starts to run (L17).
 *
 * The records number a run by its activation: `run`. Events, effects and `ctx.run` number it by `number`.
 */
export interface Started {
  kind: "started";
  time: number;
  run: number;
  rule: string;
  clause: number;
  spikes: number[];
  number?: number;
}

/**
 * One addend of a utility, in nats: −ln(rules / |Λ|). See law L9 in docs/explanation/utility.md.
 *
 * `rules` is the number of rules that have the signal on a pathway, and |Λ| is the number of all rules.
 */
export interface Term {
  signal: string;
  rules: number;
  nats: number;
}

/** The engine asked the run of the activation `run` to end; `reason` is a `StopReason`. */
export interface Told {
  kind: "told";
  time: number;
  run: number;
  rule: string;
  reason: string;
}

export type TraceRecord =
  | Born
  | Dropped
  | Merged
  | Set
  | Held
  | GaveUp
  | Passed
  | Waits
  | Pressed
  | Started
  | Told
  | Settled
  | Gap;

/**
 * A ready activation waits for the rules `for_`: those of rivals, and those of runs that have taken a slot (L15).
 *
 * The wait ends at `until` at the latest, because the patience of the rivals ends then. Without such a limit, `until` is None.
 */
export interface Waits {
  kind: "waits";
  time: number;
  activation: number;
  rule: string;
  for: string[];
  until: number | null;
}

/** A value as text. */
export interface Rendered {
  /** The value as JSON, or its `repr`; for an `Entry`, its key and item. */
  text: string;
  /** Whether the text is the whole value as JSON. A user may then edit the text and write it back. */
  json?: boolean;
  /** Whether the text is only the beginning of a longer text. */
  cut?: boolean;
}

/** An activation: the spikes that it holds, the signals that it lacks, and the rules that it waits for. */
export interface ActivationState {
  id: number;
  /** `gathering`, `ripening` (a spike is too young), `gated` (a slot predicate is false), `ready`, `waiting`, `running` or `cancelling`. */
  state: string;
  condition: string;
  /** The signal and the age (seconds) of each spike that the activation holds. */
  holds: [string, number][];
  /** The signals of the spikes that it lacks. */
  lacks: string[];
  /** The rules that it waits for, and by how many nats each is ahead. This lead is 0 for a tie, for utilities of 0, and for a rule that has taken a slot without being ahead. */
  waits_for: [string, number][];
  /** The time (seconds) by which the activation runs, times out or gives a spike up; None without a limit. */
  until: number | null;
}

/**
 * The first frame: it names the conversation or the recording to show.
 *
 * If `session`, `visitor` and `recording` are missing, the server shows the recording that it was started with, or else the newest conversation. If there is no conversation, the server begins one.
 */
export interface Hello {
  type: "hello";
  /** The version of the protocol. */
  v: number;
  /** The secret id of the conversation to show; the visitor's chat page has this id. */
  session?: string;
  /** The name of the conversation to show, as in `Conversations`. */
  visitor?: string;
  /** The name of the uploaded recording to show. */
  recording?: string;
  /** The server's token, if the server asks for one. */
  token?: string;
}

/** Stop the context's clock, perform the agent's next step while the clock is stopped, or start the clock again. */
export interface Clock {
  type: "pause" | "step" | "resume";
}

/** Write a slot from outside the rules. */
export interface Put {
  type: "put";
  slot: string;
  value?: unknown;
}

/** Raise a signal from outside the rules. */
export interface Emit {
  type: "emit";
  signal: string;
  payload?: unknown;
}

/** The stage that a rule reached for an input; the furthest stage comes first. */
export type Verdict =
  | "fired"
  | "running"
  | "waiting"
  | "outrun"
  | "failed"
  | "resigned"
  | "gated"
  | "young"
  | "eliminated"
  | "withdrawn"
  | "lacked"
  | "passed"
  | "untouched"
  | "retired";

/** Say something as the visitor. */
export interface Say {
  type: "say";
  text: string;
}

/** A request for a `State`. */
export interface Look {
  type: "look";
}

/** A request for an `Explained`: the spikes that a rule holds and lacks now, and the rules that it waits for. */
export interface Explain {
  type: "explain";
  rule: string;
}

/** A request for an `Answer`: why a rule did not fire for the cause of a spike. */
export interface Why {
  type: "why";
  rule: string;
  spike: number;
}

/** A request for a `Drawing`: the modules `unfolded` show their rules; each other module is one node. */
export interface Unfold {
  type: "diagram";
  unfolded: string[];
}

/** A policy as plain values. */
export interface Description {
  modules: string[];
  rules: RuleView[];
  signals: SignalView[];
  slots: SlotView[];
  diagram: Diagram;
}

/** A request for a `Pong`. */
export interface Ping {
  type: "ping";
}

/** The answer to `Hello`. */
export interface Welcome {
  type: "welcome";
  /** The version of the protocol. */
  v: number;
  /** The agent's name. */
  title: string;
  /** Whether this is a running conversation, not a recording. */
  live: boolean;
  /** The name of the conversation; None for a recording. */
  visitor: string | null;
  /** Whether the records that follow reach back to the start of the context. */
  whole: boolean;
  /** The policy of the agent. */
  policy: Description;
  /** The seconds since the context began. */
  now: number;
  /** Whether the context's clock is stopped. */
  paused: boolean;
}

/** A live activation, and the name of its rule. */
export interface Alive {
  id: number;
  state: string;
  condition: string;
  holds: [string, number][];
  lacks: string[];
  waits_for: [string, number][];
  until: number | null;
  rule: string;
}

/** The values of all slots, and the live activations. For a recording: the slots' last values in the trace. */
export interface State {
  type: "state";
  slots: Record<string, Rendered>;
  activations: Alive[];
  now: number;
  paused: boolean;
}

/** The next records of the trace, in order. */
export interface Records {
  type: "records";
  /** The records. */
  records: TraceRecord[];
  /** How many records the server left out just before these. */
  missed: number;
  /** How many records the server has not sent yet. */
  behind: number;
  now: number;
  paused: boolean;
}

/** The agent's new name. */
export interface Renamed {
  type: "renamed";
  title: string;
}

/** The new policy, after a rule was added. */
export interface Changed {
  type: "policy";
  policy: Description;
}

/** A conversation in a list. */
export interface Conversation {
  /** The conversation's name. */
  visitor: string;
  /** The name of the person; None if it is unknown. */
  name: string | null;
  /** The time of its start, in milliseconds since 1970 (UTC). */
  began: number;
  /** The start of the visitor's last words; None if they have said nothing. */
  said: string | null;
}

/** The newest conversations, oldest first; `more` is the number of conversations that the list leaves out. */
export interface Conversations {
  type: "conversations";
  conversations: Conversation[];
  more: number;
}

/**
 * A clause: its effective utility (nats), and its slot predicates.
 *
 * Each predicate is a pair: the predicate as text, and whether it is true now.
 */
export interface ExplainedClause {
  effective: number;
  gates: [string, boolean][];
}

/** The current state of a rule: the spikes that it holds and lacks, and the rules that it waits for. */
export interface Explained {
  type: "explained";
  rule: string;
  now: number;
  retired: boolean;
  clauses: ExplainedClause[];
  activations: ActivationState[];
}

/** The answer to `Why`: why a rule did not fire. */
export interface Answer {
  type: "why";
  rule: string;
  spike: number;
  signal: string;
  time: number;
  verdict: Verdict;
  words: string;
  at: number | null;
  clause: number | null;
  missing: Missing[];
  moments: Moment[];
  whole: boolean;
}

/** A node of the diagram; `box` is its left, top, width and height (pixels). */
export interface DrawnNode {
  id: string;
  kind: "slot" | "signal" | "rule" | "and" | "or" | "module";
  label: string;
  module: string;
  note: string;
  box: [number, number, number, number];
}

/** An edge of the diagram: the points of its line, and the box of its label (pixels). */
export interface DrawnEdge {
  source: string;
  target: string;
  kind: string;
  label: string;
  points: [number, number][];
  box: [number, number, number, number] | null;
}

/** The diagram: the modules `unfolded` show their rules; each other module is one node. Lengths are in pixels. */
export interface Drawing {
  type: "diagram";
  unfolded: string[];
  width: number;
  height: number;
  nodes: DrawnNode[];
  edges: DrawnEdge[];
}

/** The conversation is over; `text` says why. The server then closes the connection. */
export interface Ended {
  type: "ended";
  text: string;
}

/** A fault in a frame from the page, or in the connection. */
export interface Error {
  type: "error";
  /** One word for programs. */
  code: string;
  /** An explanation for people. */
  text: string;
  /** The type of the refused frame; empty if the fault is not in a frame that the server could read. */
  of?: string;
}

/** The answer to `Ping`. */
export interface Pong {
  type: "pong";
}

export type ClientFrame = Hello | Clock | Put | Emit | Say | Look | Explain | Why | Unfold | Ping;

export type ServerFrame =
  | Welcome
  | State
  | Records
  | Renamed
  | Changed
  | Conversations
  | Explained
  | Answer
  | Drawing
  | Ended
  | Error
  | Pong;
