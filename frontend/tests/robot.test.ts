import { describe, expect, it } from "vitest";
import { ease, expressionOf, lips, mouthAt, nextBlink, spokenAt } from "../src/robot/face.ts";

describe("the robot's face", () => {
  it("has its own look for each feeling, and a calm one for an unknown name", () => {
    const names = ["neutral", "happy", "shy", "surprised", "affectionate", "sad", "thinking"];
    const all = names.map((name) => JSON.stringify(expressionOf(name)));
    expect(new Set(all).size).toBe(names.length);
    expect(expressionOf("furious")).toEqual(expressionOf("neutral"));
    expect(expressionOf("sad").smile).toBeLessThan(0);
  });

  it("moves the mouth in time with the letters", () => {
    const text = "mama";
    expect(mouthAt(text, 0)).toBeLessThan(0.1);
    expect(mouthAt(text, 0.3)).toBe(1);
    expect(mouthAt(text, 0.55)).toBeLessThan(0.1);
    expect(mouthAt(text, 1)).toBe(0);
    expect(mouthAt("", 0.5)).toBe(0);
  });

  it("splits the bubble at words", () => {
    expect(spokenAt("How are you?", 0)).toEqual(["How", " are you?"]);
    expect(spokenAt("How are you?", 0.5)).toEqual(["How are", " you?"]);
    expect(spokenAt("How are you?", 1)).toEqual(["How are you?", ""]);
  });

  it("opens lips downwards and eases towards a target", () => {
    expect(lips(0, 1)).not.toBe(lips(0, 0));
    expect(ease(0, 1, 0.1, 0.1)).toBeCloseTo(0.5);
    expect(ease(0, 1, 100, 0.1)).toBeCloseTo(1);
    expect(nextBlink(10, () => 0.5)).toBe(14);
  });
});
