/** What a window remembers across reloads. */
export interface Kept {
  session?: string;
  token?: string;
  /** Said, but not known to have been heard. */
  outbox?: { id: string; text: string }[];
}

const KEY = "ravestate";

/** What is kept; nothing where the browser keeps nothing, as in some frames. */
export function recall(): Kept {
  try {
    const value: unknown = JSON.parse(sessionStorage.getItem(KEY) ?? "{}");
    return typeof value === "object" && value !== null ? (value as Kept) : {};
  } catch {
    return {};
  }
}

/** Keep something from now on. */
export function keep(kept: Kept): void {
  try {
    sessionStorage.setItem(KEY, JSON.stringify(kept));
  } catch {
    // then it lasts until the reload
  }
}

/** Tell the boards of this browser that a conversation has begun. They follow the newest one. */
export function announce(session: string): void {
  try {
    localStorage.setItem("ravestate.newest", session);
  } catch {
    // then a board shows the newest conversation of the server
  }
}

/** The token of a link, `#token=...`, which is taken out of the address so that it is not shown or passed on. */
export function tokenOfLink(): string | undefined {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (token === null) return undefined;
  history.replaceState(null, "", location.pathname + location.search);
  return token;
}
