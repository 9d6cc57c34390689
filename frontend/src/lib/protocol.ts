// Written by tools/protocol.py from ravestate.modules.platform.webio.protocol: change that file, and run the tool.

/** The version of the protocol. A new frame or field keeps the number; any other change raises it. */
export const VERSION = 1;

/** The maximum number of characters that a visitor may say at once. */
export const LONGEST_TEXT = 10000;

/** The WebSocket's closing code for each error; any other error closes with the code of `malformed`. */
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

/** The first frame: it asks for a conversation. */
export interface Hello {
  type: "hello";
  /** The version of the protocol. */
  v: number;
  /** The conversation to resume; without one, a new conversation begins. */
  session?: string;
  /** The number of the last message that the client has. */
  last?: number;
  /** The server's token, if the server asks for one. */
  token?: string;
  /** The visitor's name, if it is known. */
  name?: string;
}

/** The visitor says something. A text that arrives twice under one `id` counts once. */
export interface Say {
  type: "say";
  id: string;
  text: string;
}

/** The visitor is writing; the client repeats this now and then. */
export interface Writing {
  type: "writing";
}

/** The visitor leaves for good. */
export interface Bye {
  type: "bye";
}

/** A question for a `Pong`. Browsers need it: they cannot send the WebSocket's own pings. */
export interface Ping {
  type: "ping";
}

/** The answer to `Hello`. */
export interface Welcome {
  type: "welcome";
  /** The version of the protocol. */
  v: number;
  /** The conversation: a secret, with which a client resumes it. */
  session: string;
  /** Whether the client asked for this conversation. */
  resumed: boolean;
  /** The number of the oldest message that the server keeps. */
  first: number;
  /** The agent's name. */
  agent: string;
  /** The address of the board for this conversation, relative to the page. */
  inside?: string;
  /** The number of the newest message; 0 before the first. */
  last?: number;
  /** Whether the server takes `Writing`. The first servers did not. */
  writing?: boolean;
  /** A few things that the visitor could say first. */
  suggestions?: string[];
  /** A line to show once, until the visitor has said something. */
  note?: string;
}

/** The agent's new name. */
export interface Renamed {
  type: "renamed";
  agent: string;
}

/** An utterance. */
export interface Message {
  type: "message";
  /** Its number: the first message has 1, and no number is left out. */
  n: number;
  from: "user" | "agent";
  /** Plain text. */
  text: string;
  /** Milliseconds since 1970 (UTC). */
  time: number;
  /** The `id` of the client's `Say`, if it came from one. */
  id?: string;
}

/** A piece of an utterance that is still growing: `text` replaces everything from character `at` on. */
export interface Piece {
  type: "piece";
  /** A place in the utterance, in UTF-16 units as JavaScript counts. */
  at: number;
  /** The new end of the utterance. */
  text: string;
}

/** Whether the agent is working on an answer. */
export interface Typing {
  type: "typing";
  on: boolean;
}

/** Whether the agent's clock is paused, for example by the board. */
export interface Paused {
  type: "paused";
  on: boolean;
}

/** The conversation is over, and why; the server closes the connection. */
export interface Ended {
  type: "ended";
  text: string;
}

/** A fault in a frame or a connection. */
export interface Error {
  type: "error";
  /** One word for programs. */
  code: string;
  /** An explanation for people. */
  text: string;
  /** The `id` of the `Say` that is refused, if it is one. */
  id?: string;
}

/** The answer to `Ping`. */
export interface Pong {
  type: "pong";
}

export type ClientFrame = Hello | Say | Writing | Bye | Ping;

export type ServerFrame = Welcome | Renamed | Message | Piece | Typing | Paused | Ended | Error | Pong;

/** The fields that each ServerFrame must have, by what `typeof` calls them. */
export const FIELDS: Record<ServerFrame["type"], Record<string, string>> = {
  welcome: {
    v: "number",
    session: "string",
    resumed: "boolean",
    first: "number",
    agent: "string",
  },
  renamed: {
    agent: "string",
  },
  message: {
    n: "number",
    from: "string",
    text: "string",
    time: "number",
  },
  piece: {
    at: "number",
    text: "string",
  },
  typing: {
    on: "boolean",
  },
  paused: {
    on: "boolean",
  },
  ended: {
    text: "string",
  },
  error: {
    code: "string",
    text: "string",
  },
  pong: {},
};
