import { expect, test } from "vitest";
import { Heights } from "../src/lib/heights";

const lines = Array.from({ length: 1000 }, (_, n) => ({ key: `${n}` }));

test("lines that are not yet measured count with the average height of the others", () => {
  const heights = new Heights();
  heights.measure("0", 20);
  heights.measure("1", 60);
  heights.measure("1", 40);
  expect(heights.sum(lines, 0, 10)).toBe(20 + 40 + 8 * 30);
  heights.clear();
  expect(heights.sum(lines, 0, 2)).toBe(96);
});

test("the heights tell which lines lie between two places", () => {
  const heights = new Heights();
  for (const { key } of lines) heights.measure(key, 10);
  expect(heights.between(lines, 0, 30)).toEqual({ first: 0, last: 2 });
  expect(heights.between(lines, 5000, 5025)).toEqual({ first: 500, last: 502 });
  expect(heights.between(lines, 1e9, 2e9)).toEqual({ first: 999, last: 999 });
  expect(heights.between([], 0, 30)).toEqual({ first: 0, last: 0 });
});
