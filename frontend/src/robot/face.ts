// The geometry of the face: what an expression, a head pose and a spoken text look like.

/** The server's description of the robot; see `Looks` in roboyio/stand_in.py. */
export interface Looks {
  name: string;
  face: string;
  yaw: number;
  pitch: number;
  roll: number;
  text: string;
  seconds: number;
  gesture: [string, number];
  people: string[];
}

export const ASLEEP: Looks = {
  name: "",
  face: "neutral",
  yaw: 0,
  pitch: 0,
  roll: 0,
  text: "",
  seconds: 0,
  gesture: ["", 0],
  people: [],
};

/** The parts of an expression. Lids and brows: 0 is neutral. `smile`: -1 to 1. `open`: 0 to 1. `blush`: 0 to 1. */
export interface Expression {
  smile: number;
  open: number;
  lid: number;
  cheek: number;
  brow: number;
  tilt: number;
  blush: number;
  pupil: number;
  hearts: boolean;
}

const CALM: Expression = {
  smile: 0.35,
  open: 0,
  lid: 0.08,
  cheek: 0,
  brow: 0,
  tilt: 0,
  blush: 0,
  pupil: 1,
  hearts: false,
};

const EXPRESSIONS: Record<string, Expression> = {
  neutral: CALM,
  happy: { ...CALM, smile: 1, open: 0.35, cheek: 0.45, brow: 0.3, blush: 0.3 },
  shy: { ...CALM, smile: 0.5, lid: 0.3, brow: 0.35, tilt: 0.4, blush: 1, pupil: 0.95 },
  surprised: { ...CALM, smile: 0, open: 0.9, lid: 0, brow: 1, pupil: 0.75 },
  affectionate: { ...CALM, smile: 0.8, cheek: 0.2, brow: 0.3, blush: 0.6, pupil: 1.15, hearts: true },
  sad: { ...CALM, smile: -0.7, lid: 0.25, brow: -0.1, tilt: 0.9, pupil: 1.05 },
  thinking: { ...CALM, smile: 0.05, lid: 0.2, brow: 0.5, tilt: -0.5, pupil: 0.95 },
};

/** Return the parts of an expression; for an unknown name, those of the neutral expression. */
export function expressionOf(name: string): Expression {
  return EXPRESSIONS[name] ?? CALM;
}

const WIDE = new Map<string, number>([
  ["a", 1],
  ["e", 0.7],
  ["i", 0.5],
  ["o", 0.85],
  ["u", 0.6],
  ["y", 0.5],
]);
const SHUT = new Set(["m", "b", "p", " ", ".", ",", "!", "?", "\n"]);

/** How far the mouth is open (0 to 1) at a share (0 to 1) of a spoken text. */
export function mouthAt(text: string, share: number): number {
  if (text === "" || share < 0 || share >= 1) return 0;
  const letter = text[Math.floor(share * text.length)]?.toLowerCase() ?? " ";
  return WIDE.get(letter) ?? (SHUT.has(letter) ? 0.05 : 0.3);
}

/** The words of a text that are spoken at a share (0 to 1) of its time, for the bubble. */
export function spokenAt(text: string, share: number): [string, string] {
  const end = Math.round(Math.min(1, Math.max(0, share)) * text.length);
  const space = text.indexOf(" ", end);
  const place = space < 0 ? text.length : space;
  return [text.slice(0, place), text.slice(place)];
}

/** The path of the lips, around (0, 0). */
export function lips(smile: number, open: number): string {
  const half = 46 - 12 * open;
  const corner = -14 * smile;
  const upper = 10 * smile - 12 * open;
  const lower = 16 * smile + 44 * open;
  return `M ${-half} ${corner} Q 0 ${upper + 4} ${half} ${corner} Q 0 ${lower + 8} ${-half} ${corner} Z`;
}

/** Move a value towards its target; the half-life is in seconds. */
export function ease(value: number, target: number, seconds: number, halfLife: number): number {
  return target + (value - target) * 0.5 ** (seconds / halfLife);
}

/** Return the time (seconds) of the blink after the one at `now`. People blink every two to six seconds. */
export function nextBlink(now: number, random: () => number): number {
  return now + 2 + 4 * random();
}
