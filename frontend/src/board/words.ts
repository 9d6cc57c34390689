import { type Description, LOSSES, type Rendered } from "./protocol";
import type { Bar, Spike, Trace } from "./trace";

/** Return a value as text of at most `most` characters. */
export function value(rendered: Rendered | undefined, most = 200): string {
  if (rendered === undefined) return "";
  const { text, cut } = rendered;
  if (text.length > most) return `${text.slice(0, most)}…`;
  return cut === true ? `${text}…` : text;
}

/** Name a cause: by the visitor's words, the written slot, or the raised signal. */
export function cause(spike: Spike, policy: Description): string {
  const text = value(spike.payload, 48);
  const slot = policy.signals.find(({ name }) => name === spike.signal)?.slot;
  if (slot === undefined || slot === null) return text === "null" ? spike.signal : `${spike.signal}: ${text}`;
  if (slot === SAID) return text;
  if (policy.slots.find(({ name }) => name === slot)?.kind !== "collection") return `${slot} = ${text}`;
  return `${slot}: ${text} ${spike.signal.slice(slot.length + 1)}`;
}

/** The slot of the visitor's words. */
export const SAID = "rawio:input";

/** Return the value of a text that a user typed: the JSON value, or else the text itself. */
export function typed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

/** Say why an activation gave up its spikes, as `why_given_up` in ravestate.engine.explain does. */
export function gaveUp(bar: Bar, trace: Trace): string {
  if (bar.reason !== "") return bar.reason;
  if (bar.outcome !== "consumed" || bar.by === "")
    return LOSSES[bar.outcome as keyof typeof LOSSES] ?? bar.outcome;
  const behind = trace.behind(bar);
  return `${behind === "" ? "" : `${behind} → `}${bar.by} answered it`;
}

/** Return what is wrong with a user's text that looks like JSON; empty if nothing is wrong. */
export function slip(text: string): string {
  if (!/^\s*[[{"]/.test(text) || typed(text) !== text) return "";
  return `This looks like JSON but is not valid: ${text.slice(0, 40)} – to write it as text, put it in quotes.`;
}

export function nats(value: number): string {
  return value.toFixed(3);
}

export function seconds(value: number): string {
  return `${value.toFixed(3)} s`;
}
