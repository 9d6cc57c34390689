import { expect, test } from "vitest";
import { label, step, View } from "../src/board/view";
import { typed, value } from "../src/board/words";

test("while the view follows, the present is at the right edge", () => {
  const view = new View();
  view.advance(100);
  expect(view.x(100, 1000)).toBeCloseTo(960);
  view.zoom(0.5, 90);
  view.advance(101);
  expect(view.x(101, 1000)).toBeCloseTo(960);
});

test("at first, the start is at the left edge", () => {
  const view = new View();
  view.advance(3);
  expect(view.x(0, 1000)).toBeCloseTo(40);
});

test("moving the view stops it from following", () => {
  const view = new View();
  view.advance(100);
  view.pan(-5);
  const { left } = view;
  view.advance(200);
  expect(view.left).toBe(left);
});

test("zooming keeps the time under the pointer where it is, within bounds", () => {
  const view = new View();
  view.fit(0, 10);
  const x = view.x(4, 800);
  view.zoom(0.3, 4);
  expect(view.x(4, 800)).toBeCloseTo(x);
  expect(view.time(view.x(7, 800), 800)).toBeCloseTo(7);
  for (let i = 0; i < 200; i++) view.zoom(0.5, 4);
  expect(view.span).toBe(View.LEAST);
  for (let i = 0; i < 200; i++) view.zoom(2, 4);
  expect(view.span).toBe(View.MOST);
});

test("the marks of an axis are round", () => {
  expect(step(10, 1000, 90)).toBe(1);
  expect(step(0.01, 1000, 90)).toBeCloseTo(0.001);
  expect(step(3600, 1000, 90)).toBe(600);
  expect([label(2.5, 0.5), label(2, 1), label(0.0125, 0.0005), label(3900, 600)]).toEqual([
    "2.5 s",
    "2 s",
    "12.50 ms",
    "1 h 5 min",
  ]);
});

test("a typed value is read as JSON if possible, and otherwise as text", () => {
  expect([typed("7"), typed('{"a": [1]}'), typed("hello"), typed('"7"')]).toEqual([
    7,
    { a: [1] },
    "hello",
    "7",
  ]);
});

test("a cut value ends with dots", () => {
  expect(value({ text: "abc", cut: true })).toBe("abc…");
  expect(value({ text: "abcdef" }, 3)).toBe("abc…");
});
