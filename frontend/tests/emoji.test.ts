import { expect, test } from "vitest";
import { isEmoji } from "../src/lib/emoji";

test.each(["🙂", "👍🏽", "👩‍🚀 🚀", "🇳🇱", "❤️", "🏴󠁧󠁢󠁳󠁣󠁴󠁿"])("%s is nothing but emoji", (text) => {
  expect(isEmoji(text)).toBe(true);
});

test.each(["", "  ", "12", "#", "good 🙂", "🙂".repeat(40)])("%j is not", (text) => {
  expect(isEmoji(text)).toBe(false);
});
