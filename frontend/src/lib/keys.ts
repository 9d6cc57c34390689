/**
 * Return whether a key belongs to the composition of a character, as in Japanese. Safari reports the Enter that ends a
 * composition after its end; only the deprecated key code shows it.
 */
export function composing(event: KeyboardEvent): boolean {
  return event.isComposing || event.keyCode === 229;
}
