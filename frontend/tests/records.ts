import type { Colours, Scene } from "../src/board/paint";
import type { Born, TraceRecord } from "../src/board/protocol";
import { Trace } from "../src/board/trace";
import { View } from "../src/board/view";

let newest = 0;

/** The number of the newest spike. */
export function spikes(): number {
  return newest;
}

/** Number spikes from 1 on again. */
export function restart(): void {
  newest = 0;
}

/** Return the record of a spike with a new number. It is an input unless it has parents. */
export function born(time: number, signal: string, text = "null", more: Partial<Born> = {}): TraceRecord {
  newest = more.spike ?? newest + 1;
  const payload = { text } as Born["payload"];
  return { kind: "born", time, spike: newest, signal, group: 1, parents: [], source: 0, payload, ...more };
}

/** Return a scene that shows ten seconds of a trace on 1,000 by 300 pixels. */
export function scene(records: TraceRecord[], lanes: string[], more: Partial<Scene> = {}): Scene {
  const trace = new Trace();
  trace.add(records);
  const view = new View();
  view.left = 0;
  view.span = 10;
  const rest = { scroll: 0, width: 1000, height: 300, rule: null, kin: new Set<number>(), spike: null };
  return { trace, view, now: 20, lanes, colours: {} as Colours, ...rest, ...more };
}
