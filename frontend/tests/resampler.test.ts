import { expect, test } from "vitest";
import { Resampler, toFloat, toInt16 } from "../src/lib/sound/resampler";

function tone(hertz: number, rate: number, seconds: number): Float32Array {
  return Float32Array.from({ length: rate * seconds }, (_, n) => Math.sin((2 * Math.PI * hertz * n) / rate));
}

/** The amplitude of a tone in the middle of a sound. */
function amplitude(sound: Float32Array, hertz: number, rate: number): number {
  let [re, im, count] = [0, 0, 0];
  for (let n = Math.floor(sound.length / 4); n < (3 * sound.length) / 4; n += 1) {
    const turn = (2 * Math.PI * hertz * n) / rate;
    re += (sound[n] ?? 0) * Math.cos(turn);
    im += (sound[n] ?? 0) * Math.sin(turn);
    count += 1;
  }
  return (2 * Math.hypot(re, im)) / count;
}

test.each([
  [48_000, 16_000],
  [44_100, 16_000],
  [16_000, 16_000],
  [8_000, 16_000],
  [24_000, 48_000],
  [24_000, 44_100],
])("from %i to %i Hz a tone keeps its pitch, its loudness and its length", (from, to) => {
  const made = new Resampler(from, to).push(tone(1000, from, 1));
  expect(made.length).toBeGreaterThan(to * 0.99);
  expect(made.length).toBeLessThanOrEqual(to);
  expect(amplitude(made, 1000, to)).toBeCloseTo(1, 1);
  expect(amplitude(made, 1500, to)).toBeLessThan(0.01);
});

test("tones above half of the new rate are removed, instead of becoming lower tones", () => {
  const made = new Resampler(48_000, 16_000).push(tone(10_000, 48_000, 1));
  for (const hertz of [2000, 4000, 6000]) expect(amplitude(made, hertz, 16_000)).toBeLessThan(0.003);
});

test("pieces of any size make the same sound as the whole", () => {
  const sound = tone(300, 44_100, 0.5);
  const whole = new Resampler(44_100, 16_000).push(sound);
  const resampler = new Resampler(44_100, 16_000);
  const made: number[] = [];
  for (let at = 0, size = 1; at < sound.length; at += size, size = (size * 7) % 311) {
    size ||= 1;
    made.push(...resampler.push(sound.subarray(at, at + size)));
  }
  expect(made.length).toBe(whole.length);
  made.forEach((sample, n) => {
    expect(sample).toBeCloseTo(whole[n] ?? 0, 4);
  });
});

test("samples become integers and then floats again; values beyond the range are clipped", () => {
  expect([...toInt16(Float32Array.of(-2, -1, 0, 0.5, 2))]).toEqual([-32768, -32767, 0, 16384, 32767]);
  expect([...toFloat(Int16Array.of(-32768, 0, 16384))]).toEqual([-1, 0, 0.5]);
});
