import { FIELDS, type ServerFrame } from "./protocol";

/** Return the server's frame that a text stands for; null for a frame that this page does not know. */
export function parse(text: unknown): ServerFrame | null {
  if (typeof text !== "string") return null;
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return null;
  }
  if (typeof value !== "object" || value === null) return null;
  const frame = value as Record<string, unknown>;
  const type = frame.type;
  if (typeof type !== "string" || !Object.hasOwn(FIELDS, type)) return null;
  const fields = FIELDS[type as ServerFrame["type"]];
  for (const [field, kind] of Object.entries(fields)) {
    if (typeof frame[field] !== kind) return null;
  }
  return frame as unknown as ServerFrame;
}
