import type { Policy, Shown } from "./protocol";
import type { Bar, Spike, Trace } from "./trace";

/** A value in one line of at most so many characters. */
export function value(shown: Shown | undefined, most = 200): string {
  if (shown === undefined) return "";
  const text = shown.text.length > most ? `${shown.text.slice(0, most)}…` : shown.text;
  return shown.cut === true && shown.text.length <= most ? `${text}…` : text;
}

/** What a spike stands for: what was said, which slot was written, or which signal was raised. */
export function cause(spike: Spike, policy: Policy): string {
  const text = value(spike.payload, 48);
  const slot = policy.signals.find(({ name }) => name === spike.signal)?.slot;
  if (slot === undefined || slot === null) return text === "null" ? spike.signal : `${spike.signal}: ${text}`;
  if (slot === SAID) return text;
  if (policy.slots.find(({ name }) => name === slot)?.kind !== "collection") return `${slot} = ${text}`;
  return `${slot}: ${text} ${spike.signal.slice(slot.length + 1)}`;
}

/** The slot of what is said to the agent. */
export const SAID = "rawio:input";

/** A value that somebody typed: JSON, or else the text itself. */
export function typed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

/** Why an activation gave its spikes up: the words of `why_given_up` in ravestate.engine.explain. */
export function gaveUp(bar: Bar, trace: Trace): string {
  if (bar.reason !== "") return bar.reason;
  if (bar.outcome !== "consumed" || bar.by === "") return REASONS[bar.outcome] ?? bar.outcome;
  const behind = trace.behind(bar);
  return `${behind === "" ? "" : `${behind} → `}${bar.by} answered it`;
}

const REASONS: Record<string, string> = {
  age: "the spike was too old",
  consumed: "another rule answered it",
  resigned: "the rule resigned for it",
  eliminated: "its patience ran out while others waited",
  withdrawn: "the spike was withdrawn",
  retired: "the rule retired",
};

/** What is wrong with a value that somebody typed: it begins like JSON, and is none. */
export function slip(text: string): string {
  if (!/^\s*[[{"]/.test(text) || typed(text) !== text) return "";
  return `This begins like JSON, and is none: ${text.slice(0, 40)} – put a text that is meant so in quotes.`;
}

export function nats(value: number): string {
  return value.toFixed(3);
}

export function seconds(value: number): string {
  return `${value.toFixed(3)} s`;
}

/** The verdicts of "why not" in a word or two, and what they count as. */
export const VERDICTS: Record<string, { title: string; tone: "good" | "busy" | "bad" | "plain" }> = {
  fired: { title: "It did fire", tone: "good" },
  running: { title: "It is running", tone: "busy" },
  waiting: { title: "Ready, and kept waiting", tone: "busy" },
  outrun: { title: "Ready, but another answered", tone: "plain" },
  resigned: { title: "It resigned", tone: "plain" },
  failed: { title: "It failed", tone: "bad" },
  gated: { title: "A predicate on a slot was false", tone: "plain" },
  young: { title: "A spike was too young", tone: "plain" },
  eliminated: { title: "Its patience ran out", tone: "plain" },
  withdrawn: { title: "A spike was withdrawn", tone: "plain" },
  lacked: { title: "It lacked a signal", tone: "plain" },
  passed: { title: "It did not take the spike", tone: "plain" },
  untouched: { title: "Nothing it hears occurred", tone: "plain" },
  retired: { title: "It had retired", tone: "plain" },
};
