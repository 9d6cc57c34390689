import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Conversation } from "../src/lib/conversation.svelte";
import type { Message } from "../src/lib/protocol";
import { TestSocket } from "./socket";

let conversation: Conversation;

beforeEach(() => {
  vi.useFakeTimers();
  TestSocket.all = [];
  sessionStorage.clear();
  history.replaceState(null, "", "/");
  open();
});

afterEach(() => {
  conversation.stop();
  vi.useRealTimers();
});

function open(): void {
  conversation = new Conversation({ open: TestSocket.make });
  conversation.start();
}

function reload(): void {
  conversation.stop();
  open();
}

function message(n: number, from: "user" | "agent", text: string, id?: string): Message {
  return { type: "message", n, from, text, time: 1000 * n, ...(id === undefined ? {} : { id }) };
}

function texts(): string[] {
  return conversation.lines.map((line) => line.text);
}

function lastSaid(): string {
  const frame = TestSocket.newest.sent.at(-1);
  if (frame?.type !== "say") throw new Error("nothing was said");
  return frame.id;
}

test("words wait for the server's confirmation, and then appear only once", () => {
  TestSocket.newest.welcome("s");
  conversation.say("hello");
  expect(conversation.lines).toMatchObject([{ text: "hello", from: "user" }]);
  expect(conversation.lines[0]?.time).toBeUndefined();
  TestSocket.newest.tell(message(1, "user", "hello", lastSaid()), message(2, "agent", "Hi!"));
  expect(texts()).toEqual(["hello", "Hi!"]);
  expect(conversation.lines[0]?.time).toBe(1000);
});

test("after a lost connection, the page asks for missing messages, and repeats unconfirmed words", () => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.tell(message(1, "agent", "Hi!"));
  TestSocket.newest.lose();
  conversation.say("are you there?");
  vi.advanceTimersByTime(1000);
  TestSocket.newest.welcome("s", true);
  expect(TestSocket.newest.sent[0]).toEqual({ type: "hello", v: 1, session: "s", last: 1 });
  const id = lastSaid();
  TestSocket.newest.tell(message(2, "user", "are you there?", id), message(3, "agent", "Yes."));
  expect(texts()).toEqual(["Hi!", "are you there?", "Yes."]);
});

test("a message that comes twice is shown once", () => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.tell(message(1, "agent", "Hi!"), message(1, "agent", "Hi!"));
  expect(texts()).toEqual(["Hi!"]);
});

test("after a reload, the page resumes the conversation, and repeats unconfirmed words", () => {
  TestSocket.newest.welcome("s");
  conversation.say("hello");
  const id = lastSaid();
  reload();
  TestSocket.newest.welcome("s", true);
  expect(TestSocket.newest.sent).toEqual([
    { type: "hello", v: 1, session: "s", last: 0 },
    { type: "say", id, text: "hello" },
  ]);
  TestSocket.newest.tell(message(1, "user", "hello", id));
  reload();
  TestSocket.newest.welcome("s", true);
  expect(TestSocket.newest.sent).toHaveLength(1);
});

test("new messages appear before words that the server has not confirmed", () => {
  TestSocket.newest.welcome("s");
  conversation.say("one");
  TestSocket.newest.tell(message(1, "agent", "Hi!"));
  expect(texts()).toEqual(["Hi!", "one"]);
});

test("an utterance grows, may be corrected, and is whole at its end", () => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.tell({ type: "piece", at: 0, text: "Vermeer " }, { type: "piece", at: 8, text: "did." });
  expect(conversation.partial).toBe("Vermeer did.");
  TestSocket.newest.tell({ type: "piece", at: 0, text: "Rem" });
  expect(conversation.partial).toBe("Rem");
  TestSocket.newest.tell(message(1, "agent", "Rembrandt."));
  expect([conversation.partial, ...texts()]).toEqual(["", "Rembrandt."]);
});

test("if the server has forgotten the conversation, a new one begins below the old lines, with a mark", () => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.tell(message(1, "agent", "Hi!"), message(2, "agent", "Welcome."));
  TestSocket.newest.lose();
  conversation.say("are you there?");
  vi.advanceTimersByTime(1000);
  TestSocket.newest.welcome("t");
  TestSocket.newest.tell(message(1, "agent", "Hi again!"));
  expect(conversation.lines).toMatchObject([
    { text: "Hi!" },
    { text: "Welcome." },
    { text: "Hi again!", anew: true },
    { text: "are you there?" },
  ]);
  expect(new Set(conversation.lines.map((line) => line.key)).size).toBe(4);
});

test("a conversation that has ended is not resumed", () => {
  TestSocket.newest.welcome("s");
  conversation.leave();
  expect(TestSocket.newest.sent.at(-1)).toEqual({ type: "bye" });
  TestSocket.newest.tell(message(1, "agent", "Bye!"), { type: "ended", text: "you left" });
  TestSocket.newest.lose(1000);
  expect([conversation.status, conversation.ending]).toEqual(["ended", "you left"]);
  conversation.again();
  TestSocket.newest.welcome("t");
  expect(TestSocket.newest.sent[0]).toEqual({ type: "hello", v: 1, last: 0 });
  expect(texts()).toEqual([]);
});

test("the page sends the token of its link, keeps it across reloads, and removes it from the address", () => {
  history.replaceState(null, "", "/#token=sesame");
  reload();
  expect(location.hash).toBe("");
  reload();
  TestSocket.newest.open();
  expect(TestSocket.newest.sent[0]).toMatchObject({ token: "sesame" });
});

test("the reason for a refusal shows until the server welcomes the page", () => {
  TestSocket.newest.open();
  TestSocket.newest.tell({ type: "error", code: "full", text: "9 visitors are here already" });
  TestSocket.newest.lose(1013);
  expect([conversation.status, conversation.trouble]).toEqual(["lost", "9 visitors are here already"]);
  vi.advanceTimersByTime(1000);
  TestSocket.newest.welcome("s");
  expect(conversation.trouble).toBe("");
});

test("the visitor may replace a token that was refused", () => {
  TestSocket.newest.open();
  TestSocket.newest.tell({ type: "error", code: "token", text: "a token is needed" });
  TestSocket.newest.lose(4401);
  expect([conversation.status, conversation.trouble]).toEqual(["token", "a token is needed"]);
  conversation.present("sesame");
  TestSocket.newest.open();
  expect(TestSocket.newest.sent[0]).toMatchObject({ token: "sesame" });
});

test("a conversation works in a browser that refuses to store anything", () => {
  const refuse = vi.spyOn(Storage.prototype, "setItem").mockImplementation(() => {
    throw new DOMException("refused", "SecurityError");
  });
  TestSocket.newest.welcome("s");
  conversation.say("hello");
  expect(texts()).toEqual(["hello"]);
  refuse.mockRestore();
});

test("words that the server refuses are marked, and are not sent again", () => {
  TestSocket.newest.welcome("s");
  conversation.say("\u0085");
  const text = 'say: "text" has nothing in it';
  TestSocket.newest.tell({ type: "error", code: "empty", text, id: lastSaid() });
  expect(conversation.lines).toMatchObject([{ text: "\u0085", refused: true }]);
  expect(conversation.trouble).toBe(text);
  reload();
  TestSocket.newest.welcome("s", true);
  expect(TestSocket.newest.sent).toHaveLength(1);
  expect(texts()).toEqual([]);
});

test("after a reload, the page distinguishes earlier lines from new ones", () => {
  TestSocket.newest.welcome("s");
  expect(conversation.recalling).toBe(false);
  TestSocket.newest.tell(message(1, "agent", "Hi!"), message(2, "agent", "Welcome."));
  reload();
  TestSocket.newest.welcome("s", true, 2);
  expect(conversation.recalling).toBe(true);
  TestSocket.newest.tell(message(1, "agent", "Hi!"));
  expect(conversation.recalling).toBe(true);
  TestSocket.newest.tell(message(2, "agent", "Welcome."));
  expect(conversation.recalling).toBe(false);
  TestSocket.newest.lose();
  vi.advanceTimersByTime(1000);
  TestSocket.newest.welcome("s", true, 3); // the missed message is new
  expect(conversation.recalling).toBe(false);
});

test("the page reports typing every two seconds, and again after an utterance", () => {
  TestSocket.newest.welcome("s");
  const kinds = () => TestSocket.newest.sent.slice(1).map((frame) => frame.type);
  for (let key = 0; key < 41; key += 1) {
    conversation.write(); // ten keys a second
    vi.advanceTimersByTime(100);
  }
  expect(kinds()).toEqual(["writing", "writing", "writing"]);
  conversation.say("hello");
  conversation.write();
  expect(kinds().slice(3)).toEqual(["say", "writing"]);
});

test("typing without a connection is not reported; later typing is", () => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.lose();
  conversation.write();
  vi.advanceTimersByTime(1000);
  TestSocket.newest.welcome("s", true);
  conversation.write();
  expect(TestSocket.newest.sent.map((frame) => frame.type)).toEqual(["hello", "writing"]);
});

test("a server that does not accept reports of typing gets none", () => {
  TestSocket.newest.open();
  TestSocket.newest.tell({ type: "welcome", v: 1, session: "s", resumed: false, first: 1, agent: "Elske" });
  conversation.write();
  expect(TestSocket.newest.sent.map((frame) => frame.type)).toEqual(["hello"]);
});

test("the page shows the agent's new name", () => {
  TestSocket.newest.welcome("s");
  expect(conversation.agent).toBe("Elske");
  TestSocket.newest.tell({ type: "renamed", agent: "Robin" });
  expect(conversation.agent).toBe("Robin");
});
