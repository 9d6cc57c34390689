const EMOJI =
  /^(?:\p{Extended_Pictographic}|\p{Emoji_Modifier}|\p{Regional_Indicator}|\u200d|\ufe0f|[\u{e0062}-\u{e007f}]|\s)+$/u;

/** Return whether a text consists of a few emoji only; the page shows such a text large. */
export function isEmoji(text: string): boolean {
  const seen = text.trim();
  return seen !== "" && seen.length <= 24 && EMOJI.test(seen);
}
