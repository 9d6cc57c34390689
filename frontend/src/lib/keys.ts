/**
 * Return whether a key belongs to the composition of a character, as in Japanese. Safari reports the last Enter too
 * late: the composition has already ended. Then only the deprecated key code shows that the key belonged to it.
 */
export function composing(event: KeyboardEvent): boolean {
  return event.isComposing || event.keyCode === 229;
}
