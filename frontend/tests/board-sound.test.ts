import { expect, test } from "vitest";
import { AXIS, at, LANE, paint } from "../src/board/paint";
import type { TraceRecord } from "../src/board/protocol";
import { AGENT, USER } from "../src/board/sound";
import { born, scene, spikes } from "./records";

function write(time: number, slot: string, value: unknown): TraceRecord {
  return { kind: "set", time, slot, value: { text: JSON.stringify(value) }, run: 0 } as TraceRecord;
}

/** A question, an answer, and an interruption. */
function talk(): TraceRecord[] {
  const turn = born(2.2, "voiceio:utterance", "Utterance(text='how are you')");
  return [
    write(1, "voiceio:user_speaking", true),
    write(2, "voiceio:user_speaking", false),
    turn,
    born(2.2, "rawio:input:changed", '"how are you"', { parents: [spikes()] }),
    write(2.3, "rawio:output", "Well, thank you for asking."),
    write(3, "voiceio:agent_speaking", true),
    write(4, "voiceio:user_speaking", true),
    write(4.2, "voiceio:agent_speaking", false),
    born(4.2, "voiceio:barge_in"),
    write(4.2, "rawio:heard", "Well, thank"),
  ];
}

test("speech makes bands; the end of a turn, an interruption and what was heard make marks", () => {
  const { sound } = scene(talk(), []).trace;
  expect(sound.bands).toEqual({
    [USER]: [
      { from: 1, to: 2 },
      { from: 4, to: null },
    ],
    [AGENT]: [{ from: 3, to: 4.2 }],
  });
  expect(sound.marks).toEqual({
    [USER]: [
      { time: 2.2, kind: "turn", text: "how are you", cut: false },
      { time: 4.2, kind: "barge-in", text: "", cut: false },
    ],
    [AGENT]: [{ time: 4.2, kind: "heard", text: "Well, thank", cut: true }],
  });
});

test("an answer that was heard to its end is not marked as cut, and a back-channel does not count as a turn", () => {
  const { sound } = scene(
    [
      write(0, "rawio:output", "Well, thank you."),
      write(1, "voiceio:agent_speaking", true),
      write(1, "voiceio:agent_speaking", true),
      born(2, "voiceio:back_channel", '"mhm"'),
      born(2.5, "voiceio:false_alarm", '"a cough'),
      write(3, "voiceio:agent_speaking", false),
      write(3, "voiceio:agent_speaking", false),
      write(3, "rawio:heard", "Well, thank you. "),
    ],
    [],
  ).trace;
  expect(sound.bands[AGENT]).toEqual([{ from: 1, to: 3 }]);
  expect(sound.marks[AGENT]).toEqual([{ time: 3, kind: "heard", text: "Well, thank you.", cut: false }]);
  expect(sound.marks[USER].map(({ kind, text }) => [kind, text])).toEqual([
    ["listening", "mhm"],
    ["nothing", "a cough…"],
  ]);
});

test("a written conversation has no voices, and old speech is forgotten", () => {
  const written = scene([write(0, "rawio:output", "Hello"), write(0, "rawio:heard", "Hello")], []).trace;
  expect(written.sound.any).toBe(false);
  const { sound } = scene(talk(), []).trace;
  sound.forget(4.1);
  expect(sound.bands[USER]).toEqual([{ from: 4, to: null }]);
  expect(sound.bands[AGENT]).toEqual([{ from: 3, to: 4.2 }]);
  expect(sound.marks[USER].map((mark) => mark.kind)).toEqual(["barge-in"]);
});

test("the lanes of the voices show bands and words, and the pointer finds both", () => {
  const drawn = scene(talk(), [USER, AGENT, ""], { now: 5 });
  const boxes: number[][] = [];
  const texts: [string, number][] = [];
  const kept: Record<string, unknown> = {
    fillRect: (...box: number[]) => boxes.push(box.map(Math.round)),
    fillText: (text: string, _: number, y: number) => texts.push([text, y]),
    measureText: (text: string) => ({ width: 6 * text.length }),
  };
  const context = new Proxy(kept, { get: (found, name: string) => found[name] ?? (() => {}) });
  paint(context as unknown as CanvasRenderingContext2D, drawn);
  expect(boxes).toContainEqual([100, AXIS + 6, 100, LANE - 13]); // the user from 1 to 2 s
  expect(boxes).toContainEqual([400, AXIS + 6, 100, LANE - 13]); // the user again, from 4 s until now
  expect(boxes).toContainEqual([300, AXIS + LANE + 6, 120, LANE - 13]);
  expect(boxes).toContainEqual([419, AXIS + 3, 3, 2 * LANE - 6]); // the interruption, through both
  expect(texts).toContainEqual(["“how are you”", AXIS + LANE / 2]);
  expect(texts).toContainEqual(["“Well, thank” —", AXIS + LANE + LANE / 2]);
  expect(at(drawn, 150, AXIS + 5).band).toEqual({ from: 1, to: 2 });
  expect(at(drawn, 221, AXIS + 5).mark?.kind).toBe("turn");
  expect(at(drawn, 421, AXIS + LANE + 5).mark?.text).toBe("Well, thank");
  expect(at(drawn, 700, AXIS + 5)).toEqual({});
});
