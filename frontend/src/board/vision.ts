import type { Born, TraceRecord } from "./protocol";

/** The lanes of the camera. No rule has such a name. */
export const FACES = "~faces";
export const BODY = "~body";
export type Seen = typeof FACES | typeof BODY;

/** Seconds without a face, a body or an activity after which a new stretch begins. */
const LOST = 1.5;

/** The maximum number of rows of faces in the lane. */
export const ROWS = 3;

/** A stretch of time (seconds) in which something is seen. */
export interface Stretch {
  kind: "face" | "body" | "activity";
  from: number;
  to: number;
  /** The name of the person or of the activity; empty for an unknown face, and for a body. */
  text: string;
  /** The distance to the nearest face in memory, or the confidence of the activity, as the trace has it. */
  figure: string;
  /** The number of the face's track; 0 for a body or an activity. */
  track: number;
  /** The row of the face in its lane. */
  row: number;
}

const FACE = /^FaceVec\(track=(\d+), person=(None|'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*"), distance=([^,]*)/;
const ACTIVITY =
  /^Activity\(name=('(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*"), confidence=([^,]*), start=([^,]*), end=([^,)]*)/;
const VISITOR =
  /Visitor\((?:'[^']*'|"[^"]*"), (None|'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*"), known=\w+, tracks=\[([\d, ]*)\]/;

/** The faces with their names, the bodies and the activities that the agent has seen, from the trace. */
export class Vision {
  stretches: Record<Seen, Stretch[]> = { [FACES]: [], [BODY]: [] };
  #last = new Map<string, Stretch>(); // by track or kind

  /** Whether the agent has seen anything. */
  get any(): boolean {
    return this.stretches[FACES].length > 0 || this.stretches[BODY].length > 0;
  }

  add(record: TraceRecord): void {
    if (record.kind !== "born") return;
    switch (record.signal) {
      case "visionio:facevec":
        this.#addFace(record);
        break;
      case "visionio:visitors:added":
      case "visionio:visitors:changed":
        this.#name(record.payload.text);
        break;
      case "visionio:pose":
        if (record.payload.text.includes("landmarks")) this.#see("body", record.time);
        break;
      case "activity:posed":
        this.#see("body", record.time);
        break;
      case "activity:recognised":
        this.#addActivity(record);
    }
  }

  /** Forget everything before a time. */
  forget(time: number): void {
    for (const lane of [FACES, BODY] as const)
      this.stretches[lane] = this.stretches[lane].filter((each) => each.to >= time);
    for (const [key, each] of this.#last) if (each.to < time) this.#last.delete(key);
  }

  /**
   * Return what was seen at a time, give or take `reach` seconds; the faces from top to bottom.
   *
   * An activity comes before the body that performs it.
   */
  at(lane: Seen, time: number, reach: number): Stretch[] {
    return this.stretches[lane]
      .filter((each) => each.from - reach <= time && each.to + reach >= time)
      .sort((one, other) => one.row - other.row || one.kind.localeCompare(other.kind));
  }

  #addFace(record: Born): void {
    const found = FACE.exec(record.payload.text);
    if (found === null) return;
    const [, number = "0", person = "None", distance = ""] = found;
    const face = this.#see("face", record.time, Number(number));
    if (person !== "None") face.text = unquoted(person);
    if (distance !== "None") face.figure = distance;
  }

  /** Name the faces of a visitor, who may have told a name that memory does not have yet. */
  #name(text: string): void {
    const found = VISITOR.exec(text);
    if (found === null) return;
    const [, name = "None", tracks = ""] = found;
    for (const track of tracks.split(", ")) {
      const face = this.#last.get(`face ${track}`);
      if (face !== undefined && name !== "None") face.text = unquoted(name);
    }
  }

  #addActivity(record: Born): void {
    const found = ACTIVITY.exec(record.payload.text);
    if (found === null) return;
    const [, quoted = "''", confidence = "", start = "", end = ""] = found;
    const text = unquoted(quoted);
    const from = Number(start);
    const to = Number(end);
    if (!Number.isFinite(from) || !Number.isFinite(to)) return;
    const last = this.#last.get("activity");
    if (last !== undefined && last.text === text && from - last.to <= LOST) {
      last.to = Math.max(last.to, to);
      last.figure = confidence;
      return;
    }
    // A recognition covers the last seconds, which may overlap with the previous activity.
    const begin = last === undefined ? from : Math.min(to, Math.max(from, last.to));
    this.#begin(
      { kind: "activity", from: begin, to, text, figure: confidence, track: 0, row: 0 },
      "activity",
    );
  }

  #see(kind: "face" | "body", time: number, track = 0): Stretch {
    const key = kind === "face" ? `face ${track}` : kind;
    const last = this.#last.get(key);
    if (last !== undefined && time - last.to <= LOST) {
      last.to = Math.max(last.to, time);
      return last;
    }
    const row = kind === "face" ? this.#freeRow(time) : 0;
    return this.#begin({ kind, from: time, to: time, text: "", figure: "", track, row }, key);
  }

  #begin(stretch: Stretch, key: string): Stretch {
    this.stretches[stretch.kind === "face" ? FACES : BODY].push(stretch);
    this.#last.set(key, stretch);
    return stretch;
  }

  #freeRow(time: number): number {
    const taken = new Set<number>();
    for (const each of this.#last.values())
      if (each.kind === "face" && time - each.to <= LOST) taken.add(each.row);
    for (let row = 0; row < ROWS; row++) if (!taken.has(row)) return row;
    return ROWS - 1;
  }
}

/** Return the text in a Python string. */
function unquoted(text: string): string {
  return text.slice(1, -1).replace(/\\(['"\\])/g, "$1");
}
