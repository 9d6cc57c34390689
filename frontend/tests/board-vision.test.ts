import { expect, test } from "vitest";
import { AXIS, at, LANE, paint } from "../src/board/paint";
import type { TraceRecord } from "../src/board/protocol";
import { Trace } from "../src/board/trace";
import { BODY, FACES } from "../src/board/vision";
import { born, scene } from "./records";

function face(time: number, track: number, person = "None", distance = "None"): TraceRecord {
  const text = `FaceVec(track=${track}, person=${person}, distance=${distance}, box=(1, 2, 3, 4), quality=0.9)`;
  return born(time, "visionio:facevec", text);
}

function visitor(time: number, name: string, tracks: string): TraceRecord {
  const text = `"webio-1": Visitor('webio-1', ${name}, known=True, tracks=[${tracks}])`;
  return born(time, "visionio:visitors:changed", text);
}

function activity(time: number, name: string, confidence: number): TraceRecord {
  const text = `Activity(name='${name}', confidence=${confidence}, start=${time - 3}, end=${time}, others={})`;
  return born(time, "activity:recognised", text);
}

function faces(records: TraceRecord[]): unknown[] {
  const { vision } = scene(records, []).trace;
  return vision.stretches[FACES].map(({ from, to, text, track, row }) => ({ from, to, text, track, row }));
}

test("a face makes a stretch with its name, which ends when the face is lost", () => {
  expect(faces([face(1, 1), face(2, 1, "'Ann O\\'Hara'", "0.31"), face(3, 1), face(6, 1)])).toEqual([
    { from: 1, to: 3, text: "Ann O'Hara", track: 1, row: 0 },
    { from: 6, to: 6, text: "", track: 1, row: 0 },
  ]);
});

test("a visitor's name is shown even before memory has their face", () => {
  expect(
    faces([face(1, 1), face(1, 2), visitor(1.5, '"O\'Hara"', "2, 5"), visitor(1.6, "None", "1")]),
  ).toEqual([
    { from: 1, to: 1, text: "", track: 1, row: 0 },
    { from: 1, to: 1, text: "O'Hara", track: 2, row: 1 },
  ]);
});

test("faces at one time have rows of their own, and the last row takes the rest", () => {
  const crowd = [1, 2, 3, 4].map((track) => face(1, track));
  expect(faces(crowd).map((each) => (each as { row: number }).row)).toEqual([0, 1, 2, 2]);
});

test("a body and its activity make stretches", () => {
  const { vision } = scene(
    [
      born(1, "visionio:pose", "Pose(33 landmarks, time=1.0)"),
      born(2, "activity:posed", "Pose(...)"),
      born(3, "visionio:pose", "Pose(no body, time=3.0)"),
      activity(4, "waving", 0.8),
      activity(4.5, "waving", 0.9),
      activity(5, "rowing", 0.7),
      born(5, "activity:recognised", "what is it"),
    ],
    [],
  ).trace;
  const found = vision.stretches[BODY].map(({ kind, from, to, text, figure }) => [
    kind,
    from,
    to,
    text,
    figure,
  ]);
  expect(found).toEqual([
    ["body", 1, 2, "", ""],
    ["activity", 1, 4.5, "waving", "0.9"],
    ["activity", 4.5, 5, "rowing", "0.7"],
  ]);
});

test("an agent without a camera has no such lanes, and old faces are forgotten", () => {
  const { vision } = scene([born(1, "rawio:input:changed", '"hi"'), face(2, 1), face(7, 1)], []).trace;
  expect(new Trace().vision.any).toBe(false);
  vision.forget(5);
  expect(vision.stretches[FACES].map((each) => each.from)).toEqual([7]);
  vision.forget(8);
  expect(vision.any).toBe(false);
});

test("the lanes show bands and names, and the pointer finds both", () => {
  const records = [
    face(1, 1, "'Anna'", "0.3"),
    face(1.1, 2),
    face(2, 1),
    face(2, 2),
    activity(5, "waving", 0.9),
  ];
  const drawn = scene(records, [FACES, BODY, ""], { now: 9 });
  const boxes: number[][] = [];
  const texts: string[] = [];
  const kept: Record<string, unknown> = {
    fillRect: (...box: number[]) => boxes.push(box.map(Math.round)),
    fillText: (text: string) => texts.push(text),
    measureText: (text: string) => ({ width: 6 * text.length }),
  };
  const context = new Proxy(kept, { get: (found, name: string) => found[name] ?? (() => {}) });
  paint(context as unknown as CanvasRenderingContext2D, drawn);
  expect(boxes).toContainEqual([100, AXIS + 3, 100, Math.round((LANE - 7) / 2 - 1)]);
  expect(boxes).toContainEqual([200, AXIS + LANE + 3, 300, LANE - 8]);
  expect(texts).toEqual(expect.arrayContaining(["Anna", "unknown", "waving"]));
  expect(at(drawn, 150, AXIS + 5).seen?.map((each) => each.text)).toEqual(["Anna", ""]);
  expect(at(drawn, 300, AXIS + LANE + 5).seen?.map((each) => each.text)).toEqual(["waving"]);
  expect(at(drawn, 700, AXIS + 5)).toEqual({});
});
