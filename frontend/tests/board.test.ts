import { cleanup, fireEvent, render, screen } from "@testing-library/svelte";
import { afterEach, expect, test } from "vitest";
import { Board } from "../src/board/board.svelte";
import Cause from "../src/board/Cause.svelte";
import type { Policy, ServerFrame, TraceRecord } from "../src/board/protocol";
import Slots from "../src/board/Slots.svelte";
import WhyNot from "../src/board/WhyNot.svelte";

afterEach(cleanup);

const rule = (name: string) => ({
  name,
  module: "m",
  doc: "",
  origin: "",
  when: "m:input:changed",
  until: "",
  clauses: [],
  reads: [],
  writes: ["m:output"],
  emits: [],
  raises: [],
  weight: 1,
  cooldown: 0,
  patience: null,
  timeout: null,
  detached: false,
  background: false,
});

const POLICY: Policy = {
  modules: ["m"],
  rules: [rule("m:talk"), rule("m:answer")],
  signals: [
    {
      name: "m:input:changed",
      module: "m",
      slot: "m:input",
      payload: "",
      input: true,
      hearers: [],
      raisers: [],
    },
  ],
  slots: [
    { name: "m:input", module: "m", kind: "value", type: "str", signals: [], readers: [], writers: [] },
    { name: "m:secret", module: "m", kind: "value", type: "", signals: [], readers: [], writers: [] },
  ],
  diagram: null,
};

/** A server that only remembers what it was told. */
class Server {
  sent: Record<string, unknown>[] = [];
  socket = {
    onopen: null as (() => void) | null,
    onmessage: null as ((event: { data: string }) => void) | null,
    onclose: null as ((event: { code: number }) => void) | null,
    send: (text: string) => this.sent.push(JSON.parse(text)),
    close: () => {},
  };

  tell(frame: Partial<ServerFrame> & { type: string }): void {
    this.socket.onmessage?.({ data: JSON.stringify(frame) });
  }

  static open(): [Server, Board] {
    const server = new Server();
    const board = new Board({ session: "secret" }, () => server.socket as unknown as WebSocket);
    board.start();
    server.socket.onopen?.();
    const clock = { now: 1, paused: false };
    server.tell({
      type: "welcome",
      v: 1,
      title: "Elske",
      live: true,
      visitor: "v",
      whole: true,
      policy: POLICY,
      ...clock,
    });
    return [server, board];
  }
}

const input = (spike: number, time: number, text: string): TraceRecord => ({
  kind: "born",
  time,
  spike,
  signal: "m:input:changed",
  group: spike,
  parents: [],
  source: 0,
  payload: { text },
});

test("it says what it looks at, and asks for the diagram", () => {
  const [server, board] = Server.open();
  expect(server.sent[0]).toEqual({ type: "hello", v: 1, session: "secret" });
  expect(server.sent[1]).toEqual({ type: "diagram", unfolded: ["m"] });
  expect([board.status, board.title, board.live]).toEqual(["open", "Elske", true]);
});

test("why not is asked of the newest input, and the answer shows rules that can be followed", async () => {
  const [server, board] = Server.open();
  server.tell({
    type: "records",
    records: [input(3, 1, '"hi"')],
    missed: 0,
    behind: 0,
    now: 2,
    paused: false,
  });
  board.select("m:talk");
  render(WhyNot, { board });
  await Promise.resolve();
  expect(server.sent).toContainEqual({ type: "why", rule: "m:talk", spike: 3 });
  server.tell({
    type: "why",
    rule: "m:talk",
    spike: 3,
    signal: "m:input:changed",
    time: 1,
    verdict: "outrun",
    words: "it was ready, and waited for m:answer (1.000 nats ahead)",
    at: 2,
    clause: 0,
    missing: [],
    moments: [],
    whole: true,
  });
  await Promise.resolve();
  expect(screen.getByText("Ready, but another answered")).toBeTruthy();
  await fireEvent.click(screen.getByRole("button", { name: "m:answer" }));
  expect(board.rule).toBe("m:answer");
});

test("an answer to what was asked before is left aside", () => {
  const [server, board] = Server.open();
  server.tell({
    type: "records",
    records: [input(3, 1, "1"), input(4, 2, "2")],
    missed: 0,
    behind: 0,
    now: 2,
    paused: false,
  });
  board.select("m:talk");
  board.point(4);
  server.tell({ type: "why", rule: "m:talk", spike: 3, words: "", verdict: "fired" } as never);
  expect(board.why).toBeNull();
});

test("what went unseen is counted: by the server's gaps, and by who was too slow", () => {
  const [server, board] = Server.open();
  server.tell({
    type: "records",
    records: [{ kind: "gap", time: 1, spikes: 12 }],
    missed: 30,
    behind: 0,
    now: 2,
    paused: false,
  });
  expect(board.missed).toBe(42);
});

test("a slot is written as JSON or as text; markup in a value is shown as text", async () => {
  const [server, board] = Server.open();
  const markup = "<img src=x onerror=alert(1)>";
  server.tell({
    type: "state",
    slots: { "m:input": { text: JSON.stringify(markup) }, "m:secret": { text: "<Odd>", json: false } },
    activations: [],
    now: 1,
    paused: false,
  });
  const { container } = render(Slots, { board });
  expect(container.querySelector("img")).toBeNull();
  expect(container.textContent).toContain(markup);
  await fireEvent.click(screen.getByRole("button", { name: "Edit m:secret" }));
  const field = screen.getByLabelText("New value of m:secret, as JSON or as text");
  expect(field).toHaveProperty("value", ""); // what is no JSON cannot be edited, only replaced
  await fireEvent.input(field, { target: { value: '{"a": 1}' } });
  await fireEvent.click(screen.getByRole("button", { name: "Write" }));
  expect(server.sent.at(-1)).toEqual({ type: "put", slot: "m:secret", value: { a: 1 } });
});

test("the time stands still while the clock is paused", () => {
  const [server, board] = Server.open();
  server.tell({ type: "records", records: [], missed: 0, behind: 0, now: 7.25, paused: true });
  expect([board.paused, board.now()]).toEqual([true, 7.25]);
});

test("what is exported is a trace that the board opens", () => {
  const [server, board] = Server.open();
  server.tell({ type: "records", records: [input(3, 1, "1")], missed: 0, behind: 0, now: 2, paused: false });
  const file = JSON.parse(board.export());
  expect([file.format, file.v, file.whole, file.records.length]).toEqual(["ravestate-trace", 1, true, 1]);
  expect(file.policy.rules[0].name).toBe("m:talk");
});

test("a conversation that has ended is not tried again", () => {
  const [server, board] = Server.open();
  server.socket.onclose?.({ code: 4404 });
  expect(board.status).toBe("gone");
  board.send({ type: "pause" });
  expect(board.trouble).toContain("no connection");
});

test("the search finds rules by all of its words, in what they are called, hear, write or emit", () => {
  const [, board] = Server.open();
  expect(board.found).toBe(null);
  board.search = " Output ANSWER ";
  expect([...(board.found ?? [])]).toEqual(["m:answer"]);
  board.search = "nothing like it";
  expect(board.found?.size).toBe(0);
});

test("what came of the newest cause is told, and leads to the rules", async () => {
  const [server, board] = Server.open();
  const took = (rule: string, activation: number): TraceRecord => ({
    kind: "held",
    time: 1,
    activation,
    rule,
    clause: 0,
    spike: 3,
    signal: "m:input:changed",
    lacks: [],
  });
  const records: TraceRecord[] = [
    input(3, 1, '"hi"'),
    took("m:talk", 1),
    took("m:answer", 2),
    { kind: "waits", time: 1, activation: 1, rule: "m:talk", for: ["m:answer"], until: null },
    { kind: "started", time: 1, run: 2, rule: "m:answer", clause: 0, spikes: [3] },
    { kind: "settled", time: 1.25, run: 2, rule: "m:answer", outcome: "done", reason: "", fired: true },
  ];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 2, paused: true });
  const { container } = render(Cause, { board });
  await Promise.resolve();
  const rows = () =>
    [...container.querySelectorAll("li")].map((row) => row.textContent.replace(/\s+/g, " ").trim());
  expect(rows()).toEqual(["m:talk waits for m:answer", "m:answer ran, 250 ms"]);
  await fireEvent.click(screen.getByRole("button", { name: /^m:answer/ }));
  expect([board.rule, board.spike]).toEqual(["m:answer", 3]);
});

test("why not follows the newest cause until one is chosen by hand, and again when that is let go", async () => {
  const [server, board] = Server.open();
  const came = (...records: TraceRecord[]) =>
    server.tell({ type: "records", records, missed: 0, behind: 0, now: 2, paused: false });
  const asked = () => server.sent.filter(({ type }) => type === "why").map(({ spike }) => spike);
  board.select("m:talk");
  came(input(3, 1, "1"));
  came(input(4, 2, "2"));
  came();
  expect(asked()).toEqual([3, 4]);
  board.point(3);
  came(input(5, 3, "3"));
  expect(asked()).toEqual([3, 4, 3]);
  render(WhyNot, { board });
  await fireEvent.click(screen.getByRole("button", { name: "Newest" }));
  expect(asked()).toEqual([3, 4, 3, 5]);
});

test("what is raised by hand is a cause, although rules raise it as well", () => {
  const [server, board] = Server.open();
  const born = { ...input(3, 1, '"Hugo"'), signal: "m:named" } as TraceRecord; // no input of the policy
  server.tell({ type: "records", records: [born], missed: 0, behind: 0, now: 2, paused: false });
  expect(board.causes.map((spike) => spike.signal)).toEqual(["m:named"]);
});
