import { expect, test } from "vitest";
import type { TraceRecord } from "../src/board/protocol";
import { type Bar, from, Trace } from "../src/board/trace";
import { gaveUp } from "../src/board/words";
import { born, restart, spikes } from "./records";

function held(
  time: number,
  activation: number,
  rule: string,
  spike: number,
  lacks: string[] = [],
): TraceRecord {
  return { kind: "held", time, activation, rule, clause: 0, spike, signal: "m:s", lacks };
}

function gaveup(
  time: number,
  activation: number,
  spike: number,
  reason: string,
  by = "",
  run?: number,
): TraceRecord {
  const lost = { time, activation, rule: "m:r", spike, signal: "m:s", reason, by };
  return { kind: "gaveup", ...lost, ...(run === undefined ? {} : { run }) };
}

function bars(trace: Trace, rule: string) {
  return trace
    .lane(rule)
    .bars.map((bar) => [bar.from, bar.to, bar.outcome, bar.phases.map((phase) => phase.state)]);
}

test("an activation gathers spikes, has all of them, waits, runs and is done", () => {
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

test("an activation ends with its last spike, and names the rule that answered", () => {
  const trace = new Trace();
  trace.add([held(1, 7, "m:r", 1, ["m:u"]), held(1, 7, "m:r", 2, ["m:u"]), gaveup(2, 7, 1, "age")]);
  expect(trace.bar(7)?.to).toBeNull();
  trace.add([gaveup(3, 7, 2, "consumed", "m:best")]);
  const bar = trace.bar(7) as Bar;
  expect([bar.to, bar.outcome, gaveUp(bar, trace)]).toEqual([3, "consumed", "m:best answered it"]);
});

test("the answering rule is named together with the rule that raised its input", () => {
  restart();
  const trace = new Trace();
  trace.add([
    born(0, "m:input"),
    { kind: "started", time: 0, run: 5, rule: "m:skill", clause: 0, spikes: [1] },
    born(1, "m:said", "null", { parents: [1], source: 5 }),
    { kind: "started", time: 1, run: 6, rule: "m:verbalise", clause: 0, spikes: [2] },
    held(1, 7, "m:r", 1),
    gaveup(2, 7, 1, "consumed", "m:verbalise", 6),
    held(1, 8, "m:r", 1),
    gaveup(2, 8, 1, "consumed", "m:verbalise"), // from an older trace, without runs
  ]);
  expect(gaveUp(trace.bar(7) as Bar, trace)).toBe("m:skill → m:verbalise answered it");
  expect(gaveUp(trace.bar(8) as Bar, trace)).toBe("m:verbalise answered it");
});

test("the run that answered is named, without rules of other causes", () => {
  restart();
  const trace = new Trace();
  trace.add([
    born(0, "m:boot", "null", { group: 2 }),
    { kind: "started", time: 0, run: 1, rule: "m:warm_up", clause: 0, spikes: [1] },
    born(0, "m:ready", "null", { group: 2, parents: [1], source: 1 }),
    born(1, "m:input"),
    { kind: "started", time: 1, run: 2, rule: "m:one", clause: 0, spikes: [3] },
    born(1, "m:first", "null", { parents: [3], source: 2 }),
    { kind: "started", time: 1, run: 3, rule: "m:two", clause: 0, spikes: [3] },
    born(1, "m:second", "null", { parents: [3], source: 3 }),
    held(1, 9, "m:r", 3),
    held(1, 4, "m:say", 4),
    held(1, 5, "m:say", 5),
    { kind: "started", time: 1, run: 5, rule: "m:say", clause: 0, spikes: [5] },
    { kind: "settled", time: 1, run: 5, rule: "m:say", outcome: "resigned", reason: "", fired: false },
    { kind: "started", time: 1, run: 4, rule: "m:say", clause: 1, spikes: [2, 4] },
    gaveup(1, 9, 3, "consumed", "m:say", 4),
  ]);
  expect(gaveUp(trace.bar(9) as Bar, trace)).toBe("m:one → m:say answered it");
});

test("a resignation of another run is named", () => {
  const trace = new Trace();
  trace.add([held(1, 7, "m:r", 1), gaveup(2, 7, 1, "resigned", "m:r", 6)]);
  expect(gaveUp(trace.bar(7) as Bar, trace)).toBe("the rule resigned");
});

test("the rule behind an answer is looked up on demand", () => {
  const trace = new Trace();
  let asked = 0;
  trace.spike =
    trace.behind =
    trace.group =
      () => {
        asked += 1;
        return undefined as never;
      };
  restart();
  for (let i = 1; i <= 500; i++) {
    trace.add([
      born(1, "m:tick"),
      { kind: "started", time: 1, run: 2 * i, rule: "m:best", clause: 0, spikes: [i] },
      held(1, 2 * i + 1, "m:r", i),
      gaveup(1, 2 * i + 1, i, "consumed", "m:best", 2 * i),
    ]);
  }
  expect(asked).toBe(0);
  expect(trace.bar(1001)?.run).toBe(1000);
});

test("an activation that loses a spike gathers again", () => {
  const trace = new Trace();
  trace.add([held(1, 7, "m:r", 1, ["m:t"]), held(2, 7, "m:r", 2), gaveup(3, 7, 2, "withdrawn")]);
  expect(bars(trace, "m:r")).toEqual([[1, null, "", ["gathering", "complete", "gathering"]]]);
});

test("simultaneous activations lie in rows, and rows are reused", () => {
  const trace = new Trace();
  trace.add([held(1, 1, "m:r", 1), held(2, 2, "m:r", 2)]);
  expect(trace.lane("m:r").rows).toBe(2);
  trace.add([gaveup(3, 1, 1, "age"), held(4, 3, "m:r", 3)]);
  expect(trace.bar(3)?.row).toBe(0);
  trace.add(Array.from({ length: 30 }, (_, i) => held(5, 10 + i, "m:r", 10 + i)));
  expect(trace.lane("m:r").rows).toBe(4);
});

test("a spike knows its rule, ancestors and descendants", () => {
  restart();
  const trace = new Trace();
  trace.add([
    born(0, "m:input"),
    { kind: "started", time: 0, run: 5, rule: "m:classify", clause: 0, spikes: [1] },
    born(1, "m:question", "null", { parents: [1], source: 5 }),
    born(2, "m:answer", "null", { parents: [2] }),
    born(3, "m:elsewhere", "null", { group: 2 }),
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
  const found = () => [3, 2, 1, 9].map((group) => trace.group(group));
  expect(found()).toEqual([1, 1, 1, 9]);
  expect(found()).toEqual([1, 1, 1, 9]); // the answer is the same when it is asked again
});

test("after a gap, bars that have ended meanwhile are closed, and new bars appear", () => {
  const trace = new Trace();
  trace.add([held(1, 1, "m:r", 1), { kind: "gap", time: 2, spikes: 40 }]);
  const alive = { condition: "", lacks: [], waits_for: [], until: null };
  trace.reconcile([{ id: 9, rule: "m:other", state: "running", holds: [["m:s", 2]], ...alive }], 10);
  expect(trace.bar(1)?.outcome).toBe("unseen");
  expect(bars(trace, "m:other")).toEqual([[8, null, "", ["running"]]]);
  expect(trace.gaps).toEqual([{ time: 2, spikes: 40 }]);
});

test("the oldest records are dropped, together with everything that depends on them", () => {
  restart();
  const trace = new Trace(1000);
  for (let i = 0; i < 3000; i++) {
    trace.add([
      born(i, "m:tick"),
      held(i, i, "m:r", spikes()),
      { kind: "started", time: i, run: i, rule: "m:r", clause: 0, spikes: [spikes()] },
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

test("a file with circular merges is readable", () => {
  const trace = new Trace();
  trace.add([
    { kind: "merged", time: 1, group: 2, into: 1 },
    { kind: "merged", time: 1, group: 1, into: 2 },
  ]);
  expect([trace.group(1), trace.group(2)]).toEqual([1, 1]);
});

test("groups stay merged when the groups between them are forgotten", () => {
  restart();
  const trace = new Trace(10);
  trace.add([
    born(1, "m:s", "null", { group: 2 }),
    { kind: "merged", time: 2, group: 3, into: 2 },
    { kind: "merged", time: 2, group: 2, into: 1 },
    ...Array.from({ length: 10 }, () => born(3, "m:s", "null", { group: 3 })),
  ]);
  expect(trace.spike(1)).toBeUndefined();
  expect(trace.group(3)).toBe(1);
});

test("100,000 records become lanes and spikes", () => {
  const trace = new Trace();
  restart();
  const records: TraceRecord[] = [];
  for (let i = 0; i < 25_000; i++) {
    records.push(born(i / 1000, "m:tick"), held(i / 1000, i, `m:r${i % 50}`, spikes()));
    records.push({
      kind: "started",
      time: i / 1000,
      run: i,
      rule: `m:r${i % 50}`,
      clause: 0,
      spikes: [spikes()],
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

test("the result of a cause has all activations on its group, in order", () => {
  const trace = new Trace();
  restart();
  trace.add([
    born(1, "m:s", "null", { group: 1 }),
    held(1, 1, "m:first", 1),
    held(1, 2, "m:early", 1, ["m:t"]),
    born(5, "m:t", "null", { group: 2 }),
    held(5, 2, "m:early", 2),
    held(5, 3, "m:late", 2),
    born(6, "m:s", "null", { group: 3 }),
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
