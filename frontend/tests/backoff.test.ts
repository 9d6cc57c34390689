import { expect, test } from "vitest";
import { Backoff } from "../src/lib/backoff";

test("each wait is longer, up to a limit; the first wait after a success is short again", () => {
  const backoff = new Backoff(500, 3000, () => 1);
  expect([1, 2, 3, 4, 5].map(() => backoff.next())).toEqual([500, 1000, 2000, 3000, 3000]);
  backoff.reset();
  expect(backoff.next()).toBe(500);
});

test("chance shortens a wait by half at most, so that not all pages reconnect at once", () => {
  expect(new Backoff(500, 3000, () => 0).next()).toBe(250);
});
