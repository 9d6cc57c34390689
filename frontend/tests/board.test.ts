import { cleanup, fireEvent, render, screen } from "@testing-library/svelte";
import { flushSync } from "svelte";
import { afterEach, expect, test, vi } from "vitest";
import Bar from "../src/board/Bar.svelte";
import { Board } from "../src/board/board.svelte";
import Cause from "../src/board/Cause.svelte";
import Glyph from "../src/board/Glyph.svelte";
import type { Address } from "../src/board/link";
import type { Description, ServerFrame, TraceRecord } from "../src/board/protocol";
import Rule from "../src/board/Rule.svelte";
import Say from "../src/board/Say.svelte";
import Slots from "../src/board/Slots.svelte";
import Tools from "../src/board/Tools.svelte";
import { endState } from "../src/board/trace";
import WhyNot from "../src/board/WhyNot.svelte";
import { cause } from "../src/board/words";

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

const POLICY: Description = {
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
    ...["m:lit:true", "m:people:added", "rawio:input:changed"].map((name) => ({
      name,
      module: "m",
      slot: name.slice(0, name.lastIndexOf(":")),
      payload: "",
      input: true,
      hearers: [],
      raisers: [],
    })),
  ],
  slots: [
    { name: "m:input", module: "m", kind: "value", type: "str", signals: [], readers: [], writers: [] },
    { name: "m:lit", module: "m", kind: "flag", type: "bool", signals: [], readers: [], writers: [] },
    { name: "m:people", module: "m", kind: "collection", type: "", signals: [], readers: [], writers: [] },
    { name: "m:secret", module: "m", kind: "value", type: "", signals: [], readers: [], writers: [] },
  ],
  diagram: { nodes: [], edges: [] },
};

/** A server that records its frames. */
class Server {
  sent: Record<string, unknown>[] = [];
  kept: Address[] = [];
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

  static open(address: Address = { session: "secret" }): [Server, Board] {
    const server = new Server();
    const board = new Board(
      address,
      (kept) => server.kept.push(kept),
      () => server.socket as unknown as WebSocket,
    );
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

test("the board asks for its conversation and the diagram", () => {
  const [server, board] = Server.open();
  expect(server.sent[0]).toEqual({ type: "hello", v: 1, session: "secret" });
  expect(server.sent[1]).toEqual({ type: "diagram", unfolded: ["m"] });
  expect([board.status, board.title, board.live]).toEqual(["open", "Elske", true]);
});

test("the title is the agent's name", () => {
  const [server, board] = Server.open();
  server.tell({ type: "renamed", title: "Robin" });
  expect(board.title).toBe("Robin");
});

test("why-not is about the newest input, and the answer links to rules", async () => {
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
  expect(screen.getByText("It was ready, but another rule answered")).toBeTruthy();
  await fireEvent.click(screen.getByRole("button", { name: "m:answer" }));
  expect(board.rule).toBe("m:answer");
});

test("an answer to an earlier question is ignored", () => {
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

test("missed spikes are counted, from gaps and from a slow connection", () => {
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
  expect(field).toHaveProperty("value", ""); // JSON cannot express the value, so the user can only replace it
  await fireEvent.input(field, { target: { value: '{"a": 1}' } });
  await fireEvent.click(screen.getByRole("button", { name: "Write" }));
  expect(server.sent.at(-1)).toEqual({ type: "put", slot: "m:secret", value: { a: 1 } });
});

test("the time stands still while the clock is paused", () => {
  const [server, board] = Server.open();
  server.tell({ type: "records", records: [], missed: 0, behind: 0, now: 7.25, paused: true });
  expect([board.paused, board.now()]).toEqual([true, 7.25]);
});

test("the board can open its export", () => {
  const [server, board] = Server.open();
  server.tell({ type: "records", records: [input(3, 1, "1")], missed: 0, behind: 0, now: 2, paused: false });
  const file = JSON.parse(board.export());
  expect([file.format, file.v, file.whole, file.records.length]).toEqual(["ravestate-trace", 1, true, 1]);
  expect(file.policy.rules[0].name).toBe("m:talk");
});

test("a chosen conversation that has ended is not tried again", () => {
  const [server, board] = Server.open({ session: "secret", chosen: true });
  server.socket.onclose?.({ code: 4404 });
  expect(board.status).toBe("gone");
  board.send({ type: "pause" });
  expect(board.trouble).toContain("not connected");
});

test("the search matches all words in names, conditions, slots and signals", () => {
  const [, board] = Server.open();
  expect(board.found).toBe(null);
  board.search = " Output ANSWER ";
  expect([...(board.found ?? [])]).toEqual(["m:answer"]);
  board.search = "nothing like it";
  expect(board.found?.size).toBe(0);
});

test("the result of the newest cause links to its rules", async () => {
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

test("why-not follows the newest cause unless the user chooses one", async () => {
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

test("a signal that a user raises is a cause, even if rules raise it, too", () => {
  const [server, board] = Server.open();
  const born = { ...input(3, 1, '"Hugo"'), signal: "m:named" } as TraceRecord; // no input of the policy
  server.tell({ type: "records", records: [born], missed: 0, behind: 0, now: 2, paused: false });
  expect(board.causes.map((spike) => spike.signal)).toEqual(["m:named"]);
});

test("a cause is called by its text, or by its slot or signal", () => {
  const [server, board] = Server.open();
  const came = (spike: number, signal: string, text: string, json = true): TraceRecord =>
    ({ ...input(spike, spike, text), signal, payload: json ? { text } : { text, json } }) as TraceRecord;
  const records = [
    came(1, "rawio:input:changed", '"hi"'),
    came(2, "m:lit:true", "true"),
    came(3, "m:people:added", '"Ada"', false),
    came(4, "m:named", '"Hugo"'),
    came(5, "m:rung", "null"),
  ];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 9, paused: false });
  expect(board.causes.map((spike) => cause(spike, POLICY)).reverse()).toEqual([
    '"hi"',
    "m:lit = true",
    'm:people: "Ada" added',
    'm:named: "Hugo"',
    "m:rung",
  ]);
});

test("a signal that only background rules hear does not replace the input", () => {
  const [server, board] = Server.open();
  const talk = { ...rule("m:talk"), background: false };
  const watch = { ...rule("m:watch"), background: true };
  const heard = (name: string, hearers: string[]) => ({ ...POLICY.signals[0], name, slot: null, hearers });
  const signals = [heard("m:typing", ["m:watch"]), heard("m:said", ["m:talk", "m:watch"])];
  server.tell({ type: "policy", policy: { ...POLICY, rules: [talk, watch], signals } as Description });
  const came = (spike: number, signal: string) => ({ ...input(spike, spike, "null"), signal }) as TraceRecord;
  const clock = { missed: 0, behind: 0, now: 9, paused: false };
  server.tell({ type: "records", records: [came(3, "m:typing")], ...clock });
  expect(board.cause?.id).toBe(3); // no input yet
  server.tell({ type: "records", records: [came(4, "m:said"), came(5, "m:typing")], ...clock });
  expect(board.cause?.id).toBe(4);
  board.point(5);
  expect(board.cause?.id).toBe(5);
});

test("typing does not replace the last input", () => {
  const [server, board] = Server.open();
  const signals = [
    { ...POLICY.signals[0], name: "m:typing", slot: null, hearers: ["m:watch"] },
    { ...POLICY.signals[0], name: "m:said", slot: null, hearers: ["m:talk"] },
  ];
  const rules = [rule("m:talk"), { ...rule("m:watch"), background: true }];
  server.tell({ type: "policy", policy: { ...POLICY, rules, signals } as Description });
  const records = [{ ...input(1, 1, "1"), signal: "m:said" }] as TraceRecord[];
  for (let n = 2; n < 200; n++) records.push({ ...input(n, n, "null"), signal: "m:typing" } as TraceRecord);
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 300, paused: false });
  expect(board.causes.map(({ id }) => id)).toEqual([199, 1]); // the newest of each signal can be chosen
  expect(board.cause?.id).toBe(1);
});

test("a write counts as heard if any of its signals is", () => {
  const [server, board] = Server.open();
  const signals = [
    { ...POLICY.signals[0], name: "m:lit:changed", hearers: ["m:talk"] },
    { ...POLICY.signals[0], name: "m:lit:true", hearers: ["m:watch"] },
  ];
  const rules = [rule("m:talk"), { ...rule("m:watch"), background: true }];
  server.tell({ type: "policy", policy: { ...POLICY, rules, signals } as Description });
  const records = [
    { ...input(3, 1, "true"), signal: "m:lit:changed" },
    { ...input(4, 2, "true"), signal: "m:lit:changed" },
    { ...input(5, 2, "true"), signal: "m:lit:true", group: 4 },
  ] as TraceRecord[];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 9, paused: false });
  expect(board.cause?.id).toBe(5);
});

test("a signal that a rule raised is not a cause, even if the record of its run was missed", () => {
  const [server, board] = Server.open();
  const born = { ...input(3, 1, "1"), source: 77 } as TraceRecord;
  server.tell({ type: "records", records: [born], missed: 5, behind: 0, now: 2, paused: false });
  expect(board.causes).toEqual([]);
});

test("the signals of one write are one cause, represented by the chosen one", () => {
  const [server, board] = Server.open();
  const records = [
    { ...input(3, 1, "true"), signal: "m:lit:changed" },
    { ...input(4, 1, "true"), signal: "m:lit:true", group: 3 },
    input(5, 2, "1"),
  ] as TraceRecord[];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 9, paused: false });
  expect(board.causes.map(({ id }) => id)).toEqual([5, 4]);
  board.point(3);
  expect(board.causes.map(({ id }) => id)).toEqual([5, 3]);
  expect(board.cause?.id).toBe(3);
});

test("choosing a cause shows its time; Newest follows again", () => {
  const [server, board] = Server.open();
  const records: TraceRecord[] = [
    input(3, 1, '"hi"'),
    { kind: "started", time: 1, run: 2, rule: "m:answer", clause: 0, spikes: [3] },
    { kind: "settled", time: 1.25, run: 2, rule: "m:answer", outcome: "done", reason: "", fired: true },
    input(4, 60, '"and?"'),
  ];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 90, paused: false });
  board.visit(board.trace.spike(3) as never);
  expect([board.cause?.id, board.follows]).toEqual([3, false]);
  expect([board.view.left < 1, board.view.right > 1.25, board.view.span < 0.4]).toEqual([true, true, true]);
  board.visitNewest();
  expect([board.cause?.id, board.follows]).toEqual([4, true]);
});

test("an open cause is visible up to the present; a recording shows its newest cause", () => {
  const [server, board] = Server.open();
  const records: TraceRecord[] = [
    input(3, 10, '"hi"'),
    { kind: "started", time: 10, run: 2, rule: "m:answer", clause: 0, spikes: [3] },
  ];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 14, paused: true });
  board.visit(board.trace.spike(3) as never);
  expect(board.view.right).toBeGreaterThan(14);
  board.play("one", "monday.json");
  server.socket.onopen?.();
  server.tell({ type: "welcome", v: 1, live: false, visitor: null, whole: true, policy: POLICY, now: 60 });
  const kept = [input(3, 1, "1"), input(4, 50, "2")];
  server.tell({ type: "records", records: kept, missed: 0, behind: 0, now: 60, paused: true });
  board.visit(board.trace.spike(3) as never);
  board.visitNewest();
  expect([board.cause?.id, board.spike, board.follows]).toEqual([4, null, false]);
  expect([board.view.left < 50, board.view.right > 50]).toEqual([true, true]);
});

test("the result has all rules, however many parts an answer has", () => {
  const [server, board] = Server.open();
  const records: TraceRecord[] = [input(3, 1, '"hi"')];
  for (let run = 1; run <= 700; run++) {
    const of = { time: 1 + run / 100, run, rule: "m:talk" };
    records.push({ kind: "started", ...of, clause: 0, spikes: [3] });
    records.push({ kind: "settled", ...of, outcome: "done", reason: "", fired: true });
  }
  const of = { time: 9, run: 701, rule: "m:answer" };
  records.push({ kind: "started", ...of, clause: 0, spikes: [3] });
  records.push({ kind: "settled", ...of, outcome: "done", reason: "", fired: true });
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 20, paused: true });
  const { container } = render(Cause, { board });
  const rows = [...container.querySelectorAll("li")].map((row) => row.textContent);
  expect(rows).toHaveLength(2);
  expect([rows[0]?.includes("× 700"), rows[1]?.includes("m:answer")]).toEqual([true, true]);
  board.visit(board.trace.spike(3) as never);
  expect(board.view.right).toBeGreaterThan(9);
});

test("the result follows each step of a stopped clock", () => {
  vi.useFakeTimers();
  try {
    const [server, board] = Server.open();
    const tell = (...records: TraceRecord[]) => {
      server.tell({ type: "records", records, missed: 0, behind: 0, now: 1, paused: true });
      vi.advanceTimersByTime(400);
      flushSync();
    };
    const { container } = render(Cause, { board });
    const words = () => container.querySelector("li")?.textContent?.replace(/\s+/g, " ");
    const of = { time: 1, activation: 1, rule: "m:talk", clause: 0 };
    tell(input(3, 1, '"hi"'), { kind: "held", ...of, spike: 3, signal: "m:input:changed", lacks: [] });
    expect(words()).toContain("may not run yet");
    tell({ kind: "started", time: 1, run: 1, rule: "m:talk", clause: 0, spikes: [3] });
    expect(words()).toContain("has been running");
    tell({ kind: "settled", time: 1, run: 1, rule: "m:talk", outcome: "done", reason: "", fired: true });
    expect(words()).toContain("ran");
  } finally {
    vi.useRealTimers();
  }
});

test("closing a rule returns to the chosen cause, or to the newest if none is chosen", () => {
  const [server, board] = Server.open();
  const records = [input(3, 1, "1"), input(4, 2, "2")];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 9, paused: false });
  board.enter("m:talk", 4); // the newest
  board.enter("m:answer", 4);
  board.leave();
  expect([board.rule, board.spike]).toEqual([null, null]);
  board.point(3);
  board.enter("m:talk", 3);
  board.leave();
  expect([board.rule, board.spike]).toEqual([null, 3]);
});

test("invalid JSON is not sent as text", async () => {
  const [server, board] = Server.open();
  render(Slots, { board });
  await fireEvent.click(screen.getByRole("button", { name: "Edit m:secret" }));
  const field = screen.getByLabelText("New value of m:secret, as JSON or as text");
  for (const [typed, sent] of [
    ["[1", undefined],
    ['{"a":', undefined],
    ['"[1"', "[1"],
  ] as const) {
    await fireEvent.input(field, { target: { value: typed } });
    await fireEvent.click(screen.getByRole("button", { name: "Write" }));
    expect(server.sent.find(({ type }) => type === "put")?.value).toBe(sent);
    expect(screen.queryByRole("alert") === null).toBe(sent !== undefined);
    expect(board.trouble).toBe("");
  }
});

test("the result lists a rule with many runs once", () => {
  const [server, board] = Server.open();
  const records: TraceRecord[] = [input(3, 1, '"hi"')];
  for (let run = 1; run <= 14; run++) {
    const of = { time: 1 + run / 100, run, rule: "m:talk" };
    records.push({ kind: "started", ...of, clause: 0, spikes: [3] });
    records.push({ kind: "settled", ...of, outcome: "done", reason: "", fired: true });
  }
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 2, paused: true });
  const { container } = render(Cause, { board });
  const rows = [...container.querySelectorAll("li")].map((row) => row.textContent.trim());
  expect(rows).toHaveLength(1);
  expect(rows[0]).toContain("ran × 14");
});

test("an ended conversation takes no input, and says so", () => {
  const [server, board] = Server.open();
  const slots = { "m:input": { text: "1" } };
  server.tell({ type: "state", slots, activations: [], now: 1, paused: false });
  render(Say, { board });
  render(Slots, { board });
  expect(screen.getByRole("button", { name: "Say" })).toHaveProperty("disabled", false);
  expect(screen.queryByRole("button", { name: "Edit m:input" })).not.toBeNull();
  server.tell({ type: "ended", text: "the visitor left" });
  server.socket.onclose?.({ code: 1000 });
  flushSync();
  expect(screen.getByRole("button", { name: "Say" })).toHaveProperty("disabled", true);
  const field = screen.getByLabelText("Say something to the agent");
  expect(field).toHaveProperty("placeholder", "This conversation has ended");
  expect(screen.queryByRole("button", { name: "Edit m:input" })).toBeNull();
});

test("a refused value comes back to its field, with the reason beside it", async () => {
  const [server, board] = Server.open();
  render(Slots, { board });
  await fireEvent.click(screen.getByRole("button", { name: "Edit m:secret" }));
  const label = "New value of m:secret, as JSON or as text";
  await fireEvent.input(screen.getByLabelText(label), { target: { value: "banana" } });
  await fireEvent.click(screen.getByRole("button", { name: "Write" }));
  expect(screen.queryByLabelText(label)).toBeNull();
  server.tell({ type: "error", code: "refused", text: "true or false", of: "put" });
  flushSync();
  expect(screen.getByLabelText(label)).toHaveProperty("value", "banana");
  expect(screen.getByRole("alert").closest("form")?.textContent).toContain("true or false"); // beside its field
  expect(board.trouble).toBe("");
  await fireEvent.click(screen.getByRole("button", { name: "Cancel" }));
  expect(screen.queryByLabelText(label)).toBeNull();
});

test("a refused value comes back after a change of panels, once", () => {
  const [server, board] = Server.open();
  board.send({ type: "put", slot: "m:secret", value: "7" }, ' "7"');
  server.tell({ type: "error", code: "refused", text: "no", of: "put" });
  const label = "New value of m:secret, as JSON or as text";
  const first = render(Slots, { board });
  flushSync();
  expect(screen.getByLabelText(label)).toHaveProperty("value", ' "7"');
  first.unmount();
  render(Slots, { board });
  flushSync();
  expect(screen.queryByLabelText(label)).toBeNull();
});

test("an accepted value does not come back after another refusal or conversation", () => {
  const [server, board] = Server.open();
  board.send({ type: "say", text: "Hello" });
  server.tell({ type: "error", code: "refused", text: "the spike is forgotten", of: "why" });
  expect([board.trouble, board.refused]).toEqual(["the spike is forgotten", null]);
  board.turnTo({ visitor: "w" });
  server.socket.onopen?.();
  server.tell({ type: "error", code: "refused", text: "", of: "say" });
  expect(board.refused).toBeNull();
});

test("a field gives the focus back to the button that opened it", async () => {
  const [, board] = Server.open();
  render(Slots, { board });
  const button = screen.getByRole("button", { name: "Edit m:secret" });
  button.focus();
  await fireEvent.click(button);
  const field = screen.getByLabelText("New value of m:secret, as JSON or as text");
  expect(document.activeElement).toBe(field);
  await fireEvent.keyDown(field, { key: "Escape" });
  flushSync();
  expect(document.activeElement).toBe(button);
});

test("an ended conversation has no clock controls", () => {
  const [server, board] = Server.open();
  server.tell({ type: "records", records: [], missed: 0, behind: 0, now: 2, paused: true });
  server.tell({ type: "ended", text: "the visitor left" });
  server.socket.onclose?.({ code: 1000 });
  render(Bar, { board, main: "timeline", ondownload() {}, onopen() {}, onturn() {} });
  for (const name of ["Continue", "Step"]) {
    expect(screen.getByRole("button", { name })).toHaveProperty("disabled", true);
  }
});

test("without a connection, a typed text stays in its field", async () => {
  const [server, board] = Server.open();
  render(Say, { board });
  const field = screen.getByLabelText("Say something to the agent");
  await fireEvent.input(field, { target: { value: "Hello" } });
  server.socket.onclose?.({ code: 1006 });
  await fireEvent.submit(field.closest("form") as HTMLFormElement);
  expect(field).toHaveProperty("value", "Hello");
  expect(board.trouble).toContain("not connected");
  board.stop();
});

test("Enter writes a slot, Shift and Enter starts a line", async () => {
  const [server, board] = Server.open();
  render(Slots, { board });
  await fireEvent.click(screen.getByRole("button", { name: "Edit m:secret" }));
  const field = screen.getByLabelText("New value of m:secret, as JSON or as text");
  await fireEvent.input(field, { target: { value: "7" } });
  await fireEvent.keyDown(field, { key: "Enter", shiftKey: true });
  expect(server.sent.some(({ type }) => type === "put")).toBe(false);
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(server.sent.at(-1)).toEqual({ type: "put", slot: "m:secret", value: 7 });
});

test("Enter chooses the first match of the search, Escape clears it", async () => {
  const [, board] = Server.open();
  render(Tools, { board, main: "timeline", idle: true, modules: false, onzoom() {}, onfit() {} });
  const field = screen.getByLabelText("Filter rules");
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(board.rule).toBeNull(); // an empty search
  await fireEvent.input(field, { target: { value: "ans" } });
  await fireEvent.keyDown(field, { key: "Enter" });
  expect([board.rule, board.search]).toEqual(["m:answer", ""]);
  await fireEvent.input(field, { target: { value: "talk" } });
  await fireEvent.keyDown(field, { key: "Escape" });
  expect([board.rule, board.search]).toEqual(["m:answer", ""]);
});

test("a recording shows its file name, and closing it returns to the conversation", async () => {
  const [server, board] = Server.open();
  const handlers = { ondownload() {}, onopen() {}, onturn() {} };
  render(Bar, { board, main: "timeline", ...handlers });
  board.play("one", "monday.json");
  server.socket.onopen?.();
  board.play("two", "tuesday.json"); // a second recording does not replace the conversation to return to
  server.socket.onopen?.();
  flushSync();
  expect(server.sent.at(-1)).toEqual({ type: "hello", v: 1, recording: "two" });
  expect(screen.getByText("tuesday.json")).toBeTruthy();
  await fireEvent.click(screen.getByRole("button", { name: "Close this recording" }));
  server.socket.onopen?.();
  expect(server.sent.at(-1)).toEqual({ type: "hello", v: 1, session: "secret" });
  expect([board.recording, board.follows]).toEqual([null, true]);
});

test("the board keeps its conversation after a recording and a lost connection", () => {
  const [server, board] = Server.open({ token: "key" });
  const asked = () => server.sent.filter(({ type }) => type === "hello").at(-1);
  expect(asked()).toEqual({ type: "hello", v: 1, token: "key" });
  expect(server.kept).toEqual([{ visitor: "v", token: "key" }]); // for a reload
  board.play("one", "monday.json");
  server.socket.onopen?.();
  expect(asked()).toEqual({ type: "hello", v: 1, recording: "one", token: "key" });
  board.back();
  server.socket.onopen?.();
  expect(asked()).toEqual({ type: "hello", v: 1, visitor: "v", token: "key" });
});

test("the list shows each conversation's start, visitor and last words", () => {
  const [server, board] = Server.open();
  const began = new Date(2026, 4, 1, 11, 32).getTime();
  server.tell({
    type: "conversations",
    more: 130,
    conversations: [
      { visitor: "v", name: null, began, said: "my name is Ada" },
      { visitor: "w", name: "Hugo", began, said: null },
    ],
  });
  server.socket.onclose?.({ code: 1000 });
  const { container } = render(Bar, {
    board,
    main: "timeline",
    ondownload() {},
    onopen() {},
    onturn() {},
  });
  const time = new Date(began).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" });
  expect([...container.querySelectorAll("option")].map((option) => option.textContent)).toEqual([
    `${time}, “my name is Ada”, ended`,
    `${time}, Hugo, nothing said yet`,
    "and 130 older ones",
  ]);
});

test("the board follows the newest conversation of its browser until the user chooses one", () => {
  const [server, board] = Server.open({});
  expect(server.sent[0]).toEqual({ type: "hello", v: 1 });
  const hello = () => {
    server.socket.onopen?.();
    return server.sent.at(-1);
  };
  board.meet("second");
  expect(hello()).toEqual({ type: "hello", v: 1, session: "second" });
  board.play("recorded", "old-trace.json");
  board.meet("third"); // the recording stays
  expect(hello()).toEqual({ type: "hello", v: 1, recording: "recorded" });
  board.back();
  expect(hello()).toEqual({ type: "hello", v: 1, session: "third" });
  board.turnTo({ visitor: "other", chosen: true });
  board.meet("fourth");
  expect(hello()).toEqual({ type: "hello", v: 1, visitor: "other" });
});

test("if its browser's conversation is over, the board shows the server's newest conversation", () => {
  const [server] = Server.open({ session: "over" });
  server.socket.onclose?.({ code: 4404 });
  server.socket.onopen?.();
  expect(server.sent.at(-1)).toEqual({ type: "hello", v: 1 });
});

test("the export is named after the conversation", () => {
  const [server, board] = Server.open();
  expect(board.fileName).toBe("elske-v-trace.json");
  const began = new Date(2026, 10, 22, 14, 5).getTime();
  const conversations = [{ visitor: "v", name: "Ada Lovelace", began, said: null }];
  server.tell({ type: "conversations", conversations, more: 0 });
  expect(board.fileName).toBe("elske-ada-lovelace-2026-11-22t14-05-trace.json");
});

test("a failed rule shows its traceback, and the header counts failures", async () => {
  const [server, board] = Server.open();
  render(Bar, { board, main: "timeline", ondownload: () => {}, onopen: () => {}, onturn: () => {} });
  expect(screen.queryByText(/failed/)).toBeNull();
  const error = "Traceback (most recent call last):\nValueError: out of ink\n";
  const of = { time: 1, run: 1, rule: "m:talk" };
  const records: TraceRecord[] = [
    input(3, 1, '"hi"'),
    { kind: "started", ...of, clause: 0, spikes: [3] },
    { kind: "settled", ...of, outcome: "failed", reason: "out of ink", fired: false, error },
  ];
  server.tell({ type: "records", records, missed: 0, behind: 0, now: 2, paused: true });
  flushSync();
  await fireEvent.click(screen.getByText("1 failed"));
  expect(board.rule).toBe("m:talk");
  const { container } = render(Rule, { board });
  expect(container.querySelector("pre")?.textContent).toBe(error);
});

test("an interrupted run has its own glyph", () => {
  const shapes = ["done", "interrupted", "resigned", "failed"].map(
    (state) => render(Glyph, { state }).container.innerHTML,
  );
  expect(new Set(shapes).size).toBe(4);
  expect(["done", "interrupted", "wiped", "retired", "failed"].map(endState)).toEqual([
    "done",
    "interrupted",
    "interrupted",
    "done",
    "failed",
  ]);
});
