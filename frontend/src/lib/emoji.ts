const EMOJI =
  /^(?:\p{Extended_Pictographic}|\p{Emoji_Modifier}|\p{Regional_Indicator}|\u200d|\ufe0f|[\u{e0062}-\u{e007f}]|\s)+$/u;

/** Whether a text is nothing but a few emoji, which are then shown large. */
export function isEmoji(text: string): boolean {
  const seen = text.trim();
  return seen !== "" && seen.length <= 24 && EMOJI.test(seen);
}
