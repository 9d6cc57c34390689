import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Backoff } from "../src/lib/backoff";
import { Connection, type Status } from "../src/lib/connection";
import { TestSocket } from "./socket";

let statuses: Status[];
let connection: Connection;

beforeEach(() => {
  vi.useFakeTimers();
  TestSocket.all = [];
  statuses = [];
  connection = new Connection({
    hello: () => ({ type: "hello", v: 1 }),
    onframe: () => undefined,
    onstatus: (status) => statuses.push(status),
    open: TestSocket.make,
    backoff: new Backoff(500, 4000, () => 1),
  });
  connection.start();
});

afterEach(() => {
  connection.stop();
  expect(vi.getTimerCount()).toBe(0);
  vi.useRealTimers();
});

test("a connection says hello, and is open once the server welcomes it", () => {
  TestSocket.newest.open();
  expect(TestSocket.newest.sent).toEqual([{ type: "hello", v: 1 }]);
  expect(connection.send({ type: "ping" })).toBe(false);
  TestSocket.newest.welcome("s");
  expect(statuses).toEqual(["open"]);
  expect(connection.send({ type: "ping" })).toBe(true);
});

test("a lost connection reconnects, each time after a longer wait", () => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.lose();
  expect(statuses).toEqual(["open", "lost"]);
  vi.advanceTimersByTime(499);
  expect(TestSocket.all).toHaveLength(1);
  vi.advanceTimersByTime(1);
  expect(TestSocket.all).toHaveLength(2);
  TestSocket.newest.lose();
  vi.advanceTimersByTime(1000);
  expect(TestSocket.all).toHaveLength(3);
  TestSocket.newest.welcome("s", true);
  TestSocket.newest.lose();
  vi.advanceTimersByTime(500);
  expect(TestSocket.all).toHaveLength(4);
});

test.each([
  [1000, "ended"],
  [4401, "token"],
  [4400, "refused"],
] as const)("a connection that is closed with code %i is %s, and does not reconnect", (code, status) => {
  TestSocket.newest.welcome("s");
  TestSocket.newest.lose(code);
  expect(statuses.at(-1)).toBe(status);
  vi.advanceTimersByTime(60_000);
  expect(TestSocket.all).toHaveLength(1);
});

test("a server that sends no pong counts as silent, and later as lost", () => {
  const first = TestSocket.newest;
  first.welcome("s");
  vi.advanceTimersByTime(15_000);
  expect(first.sent.at(-1)).toEqual({ type: "ping" });
  first.tell({ type: "pong" });
  vi.advanceTimersByTime(15_000 + 4_999);
  expect(statuses).toEqual(["open"]);
  vi.advanceTimersByTime(1);
  expect(statuses).toEqual(["open", "silent"]);
  vi.advanceTimersByTime(19_999);
  expect(first.closed).toBe(false);
  vi.advanceTimersByTime(1);
  expect(statuses).toEqual(["open", "silent", "lost"]);
  expect(first.closed).toBe(true);
});

test("a server that does not confirm an utterance counts as silent until its next frame", () => {
  const first = TestSocket.newest;
  first.welcome("s");
  connection.send({ type: "say", id: "a", text: "hello" });
  vi.advanceTimersByTime(5_000);
  expect(statuses).toEqual(["open", "silent"]);
  expect(connection.send({ type: "say", id: "b", text: "hello?" })).toBe(true);
  first.tell({ type: "pong" });
  expect(statuses).toEqual(["open", "silent", "open"]);
});

test("a connection without a welcome counts as lost", () => {
  TestSocket.newest.open();
  vi.advanceTimersByTime(10_000);
  expect(statuses).toEqual(["lost"]);
});

test("a lost connection reconnects at once if it is nudged", () => {
  TestSocket.newest.lose();
  connection.nudge();
  expect(TestSocket.all).toHaveLength(2);
});

test("messages from a socket that was given up are ignored", () => {
  const first = TestSocket.newest;
  connection.start();
  expect(first.closed).toBe(true);
  expect(first.onmessage).toBeNull();
});
