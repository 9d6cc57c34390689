import { expect, test } from "vitest";
import type { TraceRecord } from "../src/board/protocol";
import { from, Trace } from "../src/board/trace";

let spikes = 0;

function born(time: number, signal: string, more: Partial<TraceRecord> = {}): TraceRecord {
  spikes += 1;
  const payload = { text: "null" };
  return {
    kind: "born",
    time,
    spike: spikes,
    signal,
    group: 1,
    parents: [],
    source: 0,
    payload,
    ...more,
  } as TraceRecord;
}

function held(
  time: number,
  activation: number,
  rule: string,
  spike: number,
  lacks: string[] = [],
): TraceRecord {
  return { kind: "held", time, activation, rule, clause: 0, spike, signal: "m:s", lacks };
}

function gaveup(time: number, activation: number, spike: number, reason: string, by = ""): TraceRecord {
  return { kind: "gaveup", time, activation, rule: "m:r", spike, signal: "m:s", reason, by };
}

function bars(trace: Trace, rule: string) {
  return trace
    .lane(rule)
    .bars.map((bar) => [bar.from, bar.to, bar.outcome, bar.phases.map((phase) => phase.state)]);
}

test("an activation gathers, has all, waits, runs and is done", () => {
  const trace = new Trace();
  trace.add([
    held(1, 7, "m:r", 1, ["m:t"]),
    held(2, 7, "m:r", 2),
    { kind: "waits", time: 2, activation: 7, rule: "m:r", for: ["m:other"], until: 3 },
    { kind: "started", time: 3, run: 7, rule: "m:r", clause: 0, spikes: [1, 2] },
    { kind: "settled", time: 5, run: 7, rule: "m:r", outcome: "done", reason: "", fired: true },
  ]);
  expect(bars(trace, "m:r")).toEqual([[1, 5, "done", ["gathering", "complete", "waiting", "running"]]]);
  const waiting = trace.lane("m:r").bars[0]?.phases[2];
  expect([waiting?.waits, waiting?.until]).toEqual([["m:other"], 3]);
  expect(trace.lane("m:r").open.size).toBe(0);
  expect(trace.lane("m:r").longest).toBe(4);
});

test("one that gives up its last spike has ended, and says who answered", () => {
  const trace = new Trace();
  trace.add([held(1, 7, "m:r", 1, ["m:u"]), held(1, 7, "m:r", 2, ["m:u"]), gaveup(2, 7, 1, "age")]);
  expect(trace.bar(7)?.to).toBeNull();
  trace.add([gaveup(3, 7, 2, "consumed", "m:best")]);
  expect([trace.bar(7)?.to, trace.bar(7)?.outcome, trace.bar(7)?.reason]).toEqual([
    3,
    "consumed",
    "m:best answered",
  ]);
});

test("who answered is told with the rule that raised what it heard", () => {
  spikes = 0;
  const trace = new Trace();
  trace.add([
    born(0, "m:input"),
    { kind: "started", time: 0, run: 5, rule: "m:skill", clause: 0, spikes: [1] },
    born(1, "m:said", { parents: [1], source: 5 } as Partial<TraceRecord>),
    { kind: "started", time: 1, run: 6, rule: "m:verbalise", clause: 0, spikes: [2] },
    held(1, 7, "m:r", 1),
    gaveup(2, 7, 1, "consumed", "m:verbalise"),
  ]);
  expect(trace.bar(7)?.reason).toBe("m:skill → m:verbalise answered");
});

test("one that loses a spike after it had all gathers again", () => {
  const trace = new Trace();
  trace.add([held(1, 7, "m:r", 1, ["m:t"]), held(2, 7, "m:r", 2), gaveup(3, 7, 2, "withdrawn")]);
  expect(bars(trace, "m:r")).toEqual([[1, null, "", ["gathering", "complete", "gathering"]]]);
});

test("activations of one rule at one time lie in rows, and rows are used again", () => {
  const trace = new Trace();
  trace.add([held(1, 1, "m:r", 1), held(2, 2, "m:r", 2)]);
  expect(trace.lane("m:r").rows).toBe(2);
  trace.add([gaveup(3, 1, 1, "age"), held(4, 3, "m:r", 3)]);
  expect(trace.bar(3)?.row).toBe(0);
  trace.add(Array.from({ length: 30 }, (_, i) => held(5, 10 + i, "m:r", 10 + i)));
  expect(trace.lane("m:r").rows).toBe(4);
});

test("a spike knows the rule that raised it, and its kin in both directions", () => {
  spikes = 0;
  const trace = new Trace();
  trace.add([
    born(0, "m:input"),
    { kind: "started", time: 0, run: 5, rule: "m:classify", clause: 0, spikes: [1] },
    born(1, "m:question", { parents: [1], source: 5 } as Partial<TraceRecord>),
    born(2, "m:answer", { parents: [2] } as Partial<TraceRecord>),
    born(3, "m:elsewhere", { group: 2 } as Partial<TraceRecord>),
  ]);
  expect(trace.spike(2)?.rule).toBe("m:classify");
  expect([...trace.kin(2)].sort()).toEqual([1, 2, 3]);
  expect([...trace.kin(4)]).toEqual([4]);
  expect(trace.inputs(9).map((spike) => spike.id)).toEqual([4, 1]);
});

test("groups that merge are one", () => {
  const trace = new Trace();
  trace.add([
    { kind: "merged", time: 1, group: 3, into: 2 },
    { kind: "merged", time: 2, group: 2, into: 1 },
  ]);
  expect([trace.group(3), trace.group(2), trace.group(1), trace.group(9)]).toEqual([1, 1, 1, 9]);
});

test("after a gap, bars that are alive no more are ended, and those that are new are shown", () => {
  const trace = new Trace();
  trace.add([held(1, 1, "m:r", 1), { kind: "gap", time: 2, spikes: 40 }]);
  const alive = { condition: "", lacks: [], waits_for: [], until: null };
  trace.reconcile([{ id: 9, rule: "m:other", state: "running", holds: [["m:s", 2]], ...alive }], 10);
  expect(trace.bar(1)?.outcome).toBe("unseen");
  expect(bars(trace, "m:other")).toEqual([[8, null, "", ["running"]]]);
  expect(trace.gaps).toEqual([{ time: 2, spikes: 40 }]);
});

test("the oldest is forgotten, with all that is of it, and the rest stays", () => {
  spikes = 0;
  const trace = new Trace(1000);
  for (let i = 0; i < 3000; i++) {
    trace.add([
      born(i, "m:tick"),
      held(i, i, "m:r", spikes),
      { kind: "started", time: i, run: i, rule: "m:r", clause: 0, spikes: [spikes] },
      { kind: "settled", time: i, run: i, rule: "m:r", outcome: "done", reason: "", fired: true },
    ]);
  }
  expect(trace.records.length).toBeLessThanOrEqual(1250);
  expect(trace.spikes.length).toBeLessThan(400);
  expect(trace.lane("m:r").bars.length).toBeLessThan(400);
  expect(trace.spike(1)).toBeUndefined();
  expect(trace.spike(3000)?.time).toBe(2999);
  expect(trace.first).toBe(trace.records[0]?.time);
});

test("100,000 records are folded", () => {
  const trace = new Trace();
  spikes = 0;
  const records: TraceRecord[] = [];
  for (let i = 0; i < 25_000; i++) {
    records.push(born(i / 1000, "m:tick"), held(i / 1000, i, `m:r${i % 50}`, spikes));
    records.push({
      kind: "started",
      time: i / 1000,
      run: i,
      rule: `m:r${i % 50}`,
      clause: 0,
      spikes: [spikes],
    });
    records.push({
      kind: "settled",
      time: i / 1000,
      run: i,
      rule: `m:r${i % 50}`,
      outcome: "done",
      reason: "",
      fired: true,
    });
  }
  trace.add(records);
  expect(trace.lanes.size).toBe(50);
  expect(trace.spikes.length).toBe(25_000);
});

test("the first item at or after a time is found", () => {
  expect([-1, 0, 1.5, 9].map((time) => from([0, 1, 2, 3], time, (item) => item))).toEqual([0, 0, 2, 4]);
});

test("what came of a cause is what took a spike of its group, merged ones too, in order", () => {
  const trace = new Trace();
  spikes = 0;
  trace.add([
    born(1, "m:s", { group: 1 } as Partial<TraceRecord>),
    held(1, 1, "m:first", 1),
    held(1, 2, "m:early", 1, ["m:t"]),
    born(5, "m:t", { group: 2 } as Partial<TraceRecord>),
    held(5, 2, "m:early", 2),
    held(5, 3, "m:late", 2),
    born(6, "m:s", { group: 3 } as Partial<TraceRecord>),
    held(6, 4, "m:other", 3),
  ]);
  const of = (id: number) => {
    const spike = trace.spike(id);
    return spike === undefined ? [] : trace.made(spike).map((bar) => bar.rule);
  };
  expect(of(2)).toEqual(["m:early", "m:late"]);
  expect(of(3)).toEqual(["m:other"]);
  trace.add([{ kind: "merged", time: 7, group: 2, into: 1 }]);
  expect(of(1)).toEqual(["m:first", "m:early", "m:late"]);
});
