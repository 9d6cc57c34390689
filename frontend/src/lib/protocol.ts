// Written by tools/protocol.py from ravestate.modules.platform.webio.frames: change that file, and run the tool.

/** The version of the protocol. A new type of frame or a new field keeps the version; any other change increases it. */
export const VERSION = 1;

/** The maximum number of characters in one utterance of a visitor. */
export const LONGEST_TEXT = 10000;

/** The maximum number of bytes of a picture. */
export const LONGEST_PICTURE = 100000;

/** The WebSocket's closing code for each reason. An error without an entry has the closing code of `malformed`. */
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

/** The first frame: the client asks for a new conversation, or resumes one. */
export interface Hello {
  type: "hello";
  /** The version of the protocol. */
  v: number;
  /** The id of the conversation to resume. Without it, or if that conversation is over, a new one begins. */
  session?: string;
  /** The number of the last message that the client has; 0 if it has none. */
  last?: number;
  /** The server's token, if the server asks for one. */
  token?: string;
  /** The visitor's name, if it is known. */
  name?: string;
}

/** The visitor says something. The server ignores a second `Say` with the same `id`. */
export interface Say {
  type: "say";
  id: string;
  text: string;
}

/** The visitor is typing; the client repeats this frame while they type. */
export interface Writing {
  type: "writing";
}

/** The visitor leaves for good. */
export interface Bye {
  type: "bye";
}

/** A request for a `Pong`. It exists because browsers cannot send the WebSocket's own pings. */
export interface Ping {
  type: "ping";
}

/**
 * The visitor's microphone goes on or off in this window.
 *
 * While the microphone is on, binary frames carry its sound, and this window plays the agent's sound. At most one window of a conversation has the microphone: the last window that turned it on.
 */
export interface Microphone {
  type: "microphone";
  on: boolean;
}

/** How much the loudspeaker has played. The client sends this frame every 100 ms of sound, and when the sound ends. */
export interface Played {
  type: "played";
  /** The number of the stream, from the last `Flush`. */
  n: number;
  /** The number of samples of this stream that the loudspeaker has played. */
  samples: number;
}

/** The visitor asks the agent to stop speaking. */
export interface Hush {
  type: "hush";
}

/**
 * The visitor's camera goes on or off in this window.
 *
 * At most one window of a conversation has the camera: the last window that turned it on.
 */
export interface Camera {
  type: "camera";
  on: boolean;
}

/** The answer to a `Look`: the next binary frame is the camera's newest picture, a JPEG. */
export interface Picture {
  type: "picture";
  /** The number of the `Look`. */
  n: number;
}

/** The answer to `Hello`. */
export interface Welcome {
  type: "welcome";
  /** The version of the protocol. */
  v: number;
  /** The conversation's secret id. A client sends it to resume the conversation. */
  session: string;
  /** Whether the server has resumed the conversation that the client asked for. */
  resumed: boolean;
  /** The number of the oldest message that the server keeps; 1 before the first message. */
  first: number;
  /** The agent's name. */
  agent: string;
  /** The address of the board (Raveboard) for this conversation, relative to the page; None if there is none. */
  inside?: string;
  /** The number of the newest message; 0 before the first message. */
  last?: number;
  /** Whether the server accepts `Writing` frames. Servers of the first releases did not. */
  writing?: boolean;
  /** A few things that the visitor could say first. */
  suggestions?: string[];
  /** A line of text that the page shows until the visitor has said something; None if there is none. */
  note?: string;
  /** Whether the agent can hear and speak. If so, the server accepts `Microphone` frames and sound. */
  voice?: boolean;
  /** The notice to show before the camera goes on, if the agent can see; None if it cannot. */
  sight?: string;
}

/** The agent's new name. */
export interface Renamed {
  type: "renamed";
  agent: string;
}

/** An utterance. */
export interface Message {
  type: "message";
  /** The message's number: the first message of a conversation has 1, and no number is left out. */
  n: number;
  from: "user" | "agent";
  /** Plain text. */
  text: string;
  /** The time of the utterance, in milliseconds since 1970 (UTC). */
  time: number;
  /** The `id` of the client's `Say`, if the utterance came from a `Say`. */
  id?: string;
  /** The part of the utterance that the visitor heard, if the agent's speech was cut off. */
  heard?: string;
}

/** A change to an utterance that is still growing: `text` replaces everything from position `at` on. */
export interface Piece {
  type: "piece";
  /** The position in the utterance where `text` begins, in UTF-16 units, as in JavaScript. */
  at: number;
  /** The utterance from `at` to its new end. */
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

/** The words so far of an utterance that the visitor is still speaking; empty once the utterance is a `Message`. */
export interface Caption {
  type: "caption";
  text: string;
}

/** The part of an agent's message that the visitor heard: all of it, unless the agent's speech was cut off. */
export interface Heard {
  type: "heard";
  /** The message's number. */
  n: number;
  /** The part that was heard. */
  text: string;
}

/** An order to drop all unplayed sound. The sound after this frame belongs to a new stream. */
export interface Flush {
  type: "flush";
  /** The number of the new stream. */
  n: number;
}

/** The agent has begun to listen to this window's microphone. Before that, the agent may load its models. */
export interface Listening {
  type: "listening";
}

/** This window no longer has the microphone; `text` says why. */
export interface Taken {
  type: "taken";
  text: string;
}

/** The agent wants a picture from this window's camera. */
export interface Look {
  type: "look";
  /** The number of this request. The server ignores a `Picture` with another number. */
  n: number;
}

/** A face that the agent sees. */
export interface Face {
  /** x, y, width and height, as shares of the picture's width and height. (0, 0) is the upper left corner. */
  box: [number, number, number, number];
  /** The person's name; missing if the agent does not know it. */
  name?: string;
}

/** All faces that the agent sees in this window's pictures now. */
export interface Faces {
  type: "faces";
  faces: Face[];
}

/** This window no longer has the camera; `text` says why. */
export interface Unseen {
  type: "unseen";
  text: string;
}

/** The conversation is over; `text` says why. The server then closes the connection. */
export interface Ended {
  type: "ended";
  text: string;
}

/** A fault in a frame from the client, or in the connection. */
export interface Error {
  type: "error";
  /** One word for programs. */
  code: string;
  /** An explanation for people. */
  text: string;
  /** The refused frame's `id`, if that frame is a `Say`. */
  id?: string;
}

/** The answer to `Ping`. */
export interface Pong {
  type: "pong";
}

export type ClientFrame = Hello | Say | Writing | Bye | Ping | Microphone | Played | Hush | Camera | Picture;

export type ServerFrame =
  | Welcome
  | Renamed
  | Message
  | Piece
  | Typing
  | Paused
  | Caption
  | Heard
  | Flush
  | Listening
  | Taken
  | Look
  | Faces
  | Unseen
  | Ended
  | Error
  | Pong;

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
  caption: {
    text: "string",
  },
  heard: {
    n: "number",
    text: "string",
  },
  flush: {
    n: "number",
  },
  listening: {},
  taken: {
    text: "string",
  },
  look: {
    n: "number",
  },
  faces: {
    faces: "object",
  },
  unseen: {
    text: "string",
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
