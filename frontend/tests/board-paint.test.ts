import { expect, test } from "vitest";
import { AXIS, at, paint, type Scene } from "../src/board/paint";
import type { TraceRecord } from "../src/board/protocol";
import { born, scene } from "./records";

const LANES = ["", "m:wait", "m:answer"];

/** A canvas that records its texts and their places. Each character is 6 pixels wide. */
function canvas() {
  const written: [string, number, number][] = [];
  const kept: Record<string, unknown> = {
    fillText: (text: string, x: number, y: number) => written.push([text, Math.round(x), Math.round(y)]),
    measureText: (text: string) => ({ width: 6 * text.length }),
  };
  const context = new Proxy(kept, { get: (found, name: string) => found[name] ?? (() => {}) });
  return { written, context: context as unknown as CanvasRenderingContext2D };
}

function words(records: TraceRecord[], more: Partial<Scene> = {}): string[] {
  const { written, context } = canvas();
  paint(context, scene(records, LANES, more));
  return written.map(([text]) => text).filter((text) => !/^\d+ s$/.test(text));
}

test("a text appears beside its dot", () => {
  expect(
    words([
      born(1, "m:heard", '"Who is there?"', { spike: 1 }),
      born(5, "m:heard", "null", { spike: 2 }),
      born(8, "m:heard", "7", { spike: 3 }),
    ]),
  ).toEqual(["“Who is there?”"]);
});

test("a text is shortened before the next dot, and left out without room", () => {
  expect(
    words([
      born(1, "m:heard", '"Who is there, and why?"', { spike: 1 }),
      born(2, "m:heard", "null", { spike: 2 }),
    ]),
  ).toEqual(["“Who is the…"]);
  expect(
    words([
      born(1, "m:heard", '"Who is there, and why?"', { spike: 1 }),
      born(1.4, "m:heard", "null", { spike: 2 }),
    ]),
  ).toEqual([]);
});

test("a text is not shortened before spikes of the context itself", () => {
  const own = born(1.1, "core:pressure:changed", "true", { spike: 2 });
  expect(words([born(1, "m:heard", '"Who is there?"', { spike: 1 }), own])).toEqual(["“Who is there?”"]);
});

test("the beginning of a cut payload appears with dots at its end", () => {
  expect(words([born(1, "m:heard", '"Who is th', { spike: 1 })])).toEqual(["“Who is th…"]);
});

test("a waiting bar names its rivals if it is wide enough", () => {
  const waits: TraceRecord[] = [
    {
      kind: "held",
      time: 1,
      activation: 1,
      rule: "m:wait",
      clause: 0,
      spike: 9,
      signal: "m:heard",
      lacks: [],
    },
    { kind: "waits", time: 1, activation: 1, rule: "m:wait", for: ["m:answer"], until: null },
  ];
  expect(words(waits)).toEqual(["waits for m:answer"]);
  expect(words(waits, { now: 1.2 })).toEqual([]);
});

test("the pointer finds input spikes, and below them the spikes of the context itself", () => {
  const both = scene(
    [
      born(1, "m:heard", '"Who is there?"', { spike: 1 }),
      born(1.01, "core:activity:true", "true", { spike: 2 }),
    ],
    LANES,
  );
  expect(at(both, 100, AXIS + 13).spike?.id).toBe(1);
  expect(at(both, 100, AXIS + 22).spike?.id).toBe(2);
  expect(at(both, 300, AXIS + 13)).toEqual({});
});

test("of many spikes close together, only the first, the last and the chosen one have lines", () => {
  const piece = (spike: number) => born(spike / 10, "m:piece", "null", { spike, parents: [1] });
  const lines = (pieces: number, kin: number[]) => {
    const numbers = Array.from({ length: pieces }, (_, i) => i + 2);
    const all = scene([born(0, "m:heard", "null", { spike: 1 }), ...numbers.map(piece)], LANES, {
      kin: new Set(kin.length > 0 ? kin : [1, ...numbers]),
    });
    let curves = 0;
    const context = new Proxy({} as Record<string, unknown>, {
      get: (_, name: string) => {
        if (name === "measureText") return () => ({ width: 6 });
        return name === "bezierCurveTo" ? () => curves++ : () => {};
      },
      set: () => true,
    });
    paint(context as unknown as CanvasRenderingContext2D, all);
    return curves;
  };
  expect([lines(6, []), lines(7, []), lines(37, []), lines(37, [1, 20])]).toEqual([6, 2, 2, 1]);
});
