import type { Born, TraceRecord, Set as Write } from "./protocol";

/** The lanes of the voices. No rule has such a name. */
export const USER = "~user";
export const AGENT = "~agent";
export type Speaker = typeof USER | typeof AGENT;

/** The flags that are true while somebody speaks. */
const FLAGS: Record<string, Speaker> = {
  "voiceio:user_speaking": USER,
  "voiceio:agent_speaking": AGENT,
};

/** A stretch of speech (seconds); it has no end while it lasts. */
export interface Band {
  from: number;
  to: number | null;
}

/** A moment in a spoken conversation. */
export interface Mark {
  time: number;
  kind: "turn" | "barge-in" | "listening" | "nothing" | "heard";
  /** The words, or the reason; empty if there are none. */
  text: string;
  /** Whether the agent had more to say than the user heard. */
  cut: boolean;
}

const KINDS: Record<string, Mark["kind"]> = {
  "voiceio:utterance": "turn",
  "voiceio:barge_in": "barge-in",
  "rawio:hush": "barge-in",
  "voiceio:back_channel": "listening",
  "voiceio:false_alarm": "nothing",
};

/** The meaning of each mark. */
export const MEANINGS: Record<Mark["kind"], string> = {
  turn: "end of turn",
  "barge-in": "the user interrupts",
  listening: "the user shows that they listen",
  nothing: "false alarm, no turn of the user",
  heard: "heard by the user",
};

/** The voices of both sides, from the trace: stretches of speech, ends of turns, interruptions, and what was heard. */
export class Sound {
  bands: Record<Speaker, Band[]> = { [USER]: [], [AGENT]: [] };
  marks: Record<Speaker, Mark[]> = { [USER]: [], [AGENT]: [] };
  #turns = new Map<number, Mark>(); // by the spike of the utterance
  #output = ""; // the agent's last utterance

  /** Whether anybody has spoken. */
  get any(): boolean {
    return this.bands[USER].length > 0 || this.bands[AGENT].length > 0;
  }

  add(record: TraceRecord): void {
    if (record.kind === "set") this.#set(record);
    else if (record.kind === "born") this.#born(record);
  }

  /** Forget everything before a time. */
  forget(time: number): void {
    for (const speaker of [USER, AGENT] as const) {
      this.bands[speaker] = this.bands[speaker].filter((band) => band.to === null || band.to >= time);
      this.marks[speaker] = this.marks[speaker].filter((mark) => mark.time >= time);
    }
    for (const [spike, mark] of this.#turns) if (mark.time < time) this.#turns.delete(spike);
  }

  /** Return the band and the newest mark at a time, give or take `reach` seconds; an open band lasts until `now`. */
  at(speaker: Speaker, time: number, reach: number, now: number): { band?: Band; mark?: Mark } {
    const found: { band?: Band; mark?: Mark } = {};
    const mark = this.marks[speaker].findLast((each) => Math.abs(each.time - time) <= reach);
    const band = this.bands[speaker].findLast((each) => each.from <= time && (each.to ?? now) >= time);
    if (mark !== undefined) found.mark = mark;
    if (band !== undefined) found.band = band;
    return found;
  }

  #set(record: Write): void {
    const speaker = FLAGS[record.slot];
    if (speaker !== undefined) {
      const bands = this.bands[speaker];
      const open = bands.at(-1);
      if (record.value.text === "true") {
        if (open === undefined || open.to !== null) bands.push({ from: record.time, to: null });
      } else if (open !== undefined && open.to === null) open.to = record.time;
    } else if (record.slot === "rawio:output") this.#output = words(record.value.text);
    else if (record.slot === "rawio:heard" && this.any) {
      const text = words(record.value.text);
      this.marks[AGENT].push({ time: record.time, kind: "heard", text, cut: text !== this.#output });
    }
  }

  #born(record: Born): void {
    const kind = KINDS[record.signal];
    if (kind !== undefined) {
      const text = kind === "turn" ? "" : words(record.payload.text);
      const mark: Mark = { time: record.time, kind, text, cut: false };
      this.marks[USER].push(mark);
      if (kind === "turn") this.#turns.set(record.spike, mark);
    } else if (record.signal === "rawio:input:changed") {
      for (const parent of record.parents) {
        const turn = this.#turns.get(parent);
        if (turn !== undefined) turn.text = words(record.payload.text);
      }
    }
  }
}

/** Return the text in a rendered value; empty if the value is no text. A cut text is not valid JSON. */
function words(json: string): string {
  try {
    const value: unknown = JSON.parse(json);
    return typeof value === "string" ? value.trim() : "";
  } catch {
    return json.startsWith('"') ? `${json.slice(1)}…` : "";
  }
}
