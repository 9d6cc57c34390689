// The language between an agent and its visitors, version 1: see docs/reference/web-protocol.md.

export const VERSION = 1;

export type ClientFrame =
  | { type: "hello"; v: number; session?: string; last?: number; token?: string }
  | Say
  | { type: "writing" }
  | { type: "bye" }
  | { type: "ping" };

export interface Say {
  type: "say";
  id: string;
  text: string;
}

export interface Message {
  type: "message";
  n: number;
  from: "user" | "agent";
  text: string;
  time: number;
  id?: string;
}

export interface Welcome {
  type: "welcome";
  v: number;
  session: string;
  resumed: boolean;
  first: number;
  agent: string;
  /** Where one may look inside of the agent, relative to the page. */
  inside?: string;
  /** The number of the newest message. */
  last?: number;
  /** Whether the server takes `writing`. */
  writing?: boolean;
}

export type ServerFrame =
  | Welcome
  | { type: "renamed"; agent: string }
  | Message
  | { type: "piece"; at: number; text: string }
  | { type: "typing"; on: boolean }
  | { type: "ended"; text: string }
  | { type: "error"; code: string; text: string; id?: string }
  | { type: "pong" };

/** With which code the server closes a connection, where that says more than that it is closed. */
export const CLOSED = { ended: 1000, tokenNeeded: 4401, notUnderstood: 4400 } as const;

type Shape = Record<string, "string" | "number" | "boolean">;

/** How many characters are taken at once, at least: what JavaScript counts as two may count as one. */
export const LONGEST = 10_000;

const SHAPES: Record<ServerFrame["type"], Shape> = {
  welcome: { v: "number", session: "string", resumed: "boolean", first: "number", agent: "string" },
  renamed: { agent: "string" },
  message: { n: "number", from: "string", text: "string", time: "number" },
  piece: { at: "number", text: "string" },
  typing: { on: "boolean" },
  ended: { text: "string" },
  error: { code: "string", text: "string" },
  pong: {},
};

/** The frame that a text from the server stands for; null if it is none that is known here. */
export function parse(text: unknown): ServerFrame | null {
  if (typeof text !== "string") return null;
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return null;
  }
  if (typeof value !== "object" || value === null) return null;
  const frame = value as Record<string, unknown>;
  const type = frame.type;
  if (typeof type !== "string" || !Object.hasOwn(SHAPES, type)) return null;
  const shape = SHAPES[type as ServerFrame["type"]];
  for (const [field, kind] of Object.entries(shape)) {
    if (typeof frame[field] !== kind) return null;
  }
  return frame as unknown as ServerFrame;
}
