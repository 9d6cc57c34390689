/**
 * Whether a key is a part of writing a character, as in Japanese. Safari ends a composition before it tells of the Enter
 * that ended it; the old code gives it away.
 */
export function composing(event: KeyboardEvent): boolean {
  return event.isComposing || event.keyCode === 229;
}
