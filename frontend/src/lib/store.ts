/** The values that a window keeps across reloads. */
export interface Kept {
  session?: string;
  token?: string;
  /** Words that the server has not confirmed. */
  outbox?: { id: string; text: string }[];
}

const KEY = "ravestate";

/** Return the kept values; empty where the browser keeps none, as in some frames. */
export function recall(): Kept {
  try {
    const value: unknown = JSON.parse(sessionStorage.getItem(KEY) ?? "{}");
    return typeof value === "object" && value !== null ? (value as Kept) : {};
  } catch {
    return {};
  }
}

/** Keep values across reloads. */
export function keep(kept: Kept): void {
  try {
    sessionStorage.setItem(KEY, JSON.stringify(kept));
  } catch {
    // without storage, the values last until the reload
  }
}

/** Tell the boards of this browser that a conversation has begun. The boards follow the newest conversation. */
export function announce(session: string): void {
  try {
    localStorage.setItem("ravestate.newest", session);
  } catch {
    // without storage, a board shows the server's newest conversation
  }
}

const NOTE = "ravestate.note";

/** Return whether this browser has shown a note. */
export function isSeen(note: string): boolean {
  try {
    return localStorage.getItem(NOTE) === note;
  } catch {
    return false;
  }
}

/** Remember that this browser has shown a note. */
export function markSeen(note: string): void {
  if (note === "") return;
  try {
    localStorage.setItem(NOTE, note);
  } catch {
    // without storage, the note appears again
  }
}

const AGREED = "ravestate.camera";

/** Return whether the visitor has agreed to this notice in this browser. */
export function isAgreed(notice: string): boolean {
  try {
    return localStorage.getItem(AGREED) === notice;
  } catch {
    return false;
  }
}

/** Remember that the visitor has agreed to a notice. */
export function markAgreed(notice: string): void {
  try {
    localStorage.setItem(AGREED, notice);
  } catch {
    // without storage, the page asks again
  }
}

/** Return the token of the page's link (`#token=...`), and remove it from the address so that nobody shares it. */
export function tokenOfLink(): string | undefined {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (token === null) return undefined;
  history.replaceState(null, "", location.pathname + location.search);
  return token;
}
