import { expect, test } from "vitest";
import { JitterBuffer } from "../src/lib/sound/jitter";

const RATE = 48_000;
const BLOCK = 480; // 10 ms

function sound(seconds: number): Float32Array {
  return new Float32Array(24_000 * seconds).fill(0.5);
}

/** Pull blocks; return for each block whether it had sound. */
function pull(buffer: JitterBuffer, blocks: number): boolean[] {
  const out = new Float32Array(BLOCK);
  return Array.from({ length: blocks }, () => {
    buffer.pull(out);
    return out.some((sample) => Math.abs(sample) > 0.1);
  });
}

const count = (blocks: boolean[]) => blocks.filter(Boolean).length;

test("sound plays evenly, and to its end", () => {
  const buffer = new JitterBuffer(RATE);
  buffer.push(sound(0.5));
  expect(buffer.busy).toBe(true);
  expect(pull(buffer, 25)).toEqual(Array(25).fill(true));
  expect(buffer.played / 24_000).toBeCloseTo(0.25, 2);
  expect(count(pull(buffer, 30))).toBeGreaterThanOrEqual(24);
  expect(buffer.played).toBe(12_000);
  expect(buffer.busy).toBe(false);
});

test("a short sound waits for more, but not for ever", () => {
  const buffer = new JitterBuffer(RATE);
  buffer.push(sound(0.03));
  const heard = pull(buffer, 20);
  expect(heard.slice(0, 7)).not.toContain(true);
  expect(count(heard)).toBeGreaterThanOrEqual(2);
  expect(buffer.played).toBe(720);
});

test("after a gap more sound waits before it plays, so that there is no second gap", () => {
  const buffer = new JitterBuffer(RATE);
  const before: number[] = [];
  for (let piece = 0; piece < 4; piece += 1) {
    buffer.push(sound(0.05));
    before.push(pull(buffer, 40).indexOf(true));
  }
  expect(before[1]).toBeGreaterThan(before[0] ?? 0);
  expect(before[3]).toBeGreaterThan(before[1] ?? 0);
});

test("the position lags behind by the latency of the loudspeaker", () => {
  const buffer = new JitterBuffer(RATE, 0.1);
  buffer.push(sound(0.5));
  pull(buffer, 10);
  expect(buffer.played).toBe(0);
  pull(buffer, 10);
  expect(buffer.played / 24_000).toBeCloseTo(0.1, 2);
  pull(buffer, 32);
  expect(buffer.busy).toBe(true); // the last of it is on its way
  pull(buffer, 10);
  expect(buffer.played).toBe(12_000);
  expect(buffer.busy).toBe(false);
});

test("dropped sound fades within a few milliseconds, and a new stream begins at 0", () => {
  const buffer = new JitterBuffer(RATE);
  buffer.push(sound(1));
  pull(buffer, 30);
  buffer.flush();
  expect(buffer.played).toBe(0);
  expect(buffer.busy).toBe(false);
  const out = new Float32Array(BLOCK);
  buffer.pull(out);
  expect(Math.abs(out[0] ?? 0)).toBeGreaterThan(0.4);
  expect([...out.subarray(128)]).toEqual(Array(BLOCK - 128).fill(0));
  expect(pull(buffer, 50)).not.toContain(true);
  buffer.push(sound(0.5));
  pull(buffer, 60);
  expect(buffer.played).toBe(12_000);
});
