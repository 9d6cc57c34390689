import type { Shown } from "./protocol";

/** A value in one line of at most so many characters. */
export function value(shown: Shown | undefined, most = 200): string {
  if (shown === undefined) return "";
  const text = shown.text.length > most ? `${shown.text.slice(0, most)}…` : shown.text;
  return shown.cut === true && shown.text.length <= most ? `${text}…` : text;
}

/** A value that somebody typed: JSON, or else the text itself. */
export function typed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
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
