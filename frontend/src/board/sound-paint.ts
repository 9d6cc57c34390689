import type { Scene } from "./paint";
import { type Mark, type Speaker, USER } from "./sound";

type Shorten = (context: CanvasRenderingContext2D, text: string, room: number) => string;

/** Paint the lane of a voice: a band for each stretch of speech, and its marks. */
export function paintVoice(
  context: CanvasRenderingContext2D,
  scene: Scene,
  speaker: Speaker,
  top: number,
  height: number,
  shorten: Shorten,
): void {
  const { view, width, colours: c, trace, now } = scene;
  context.fillStyle = speaker === USER ? c.done : c.running;
  context.globalAlpha = 0.55;
  for (const band of trace.sound.bands[speaker]) {
    const left = view.x(band.from, width);
    const right = view.x(band.to ?? now, width);
    if (right < 0 || left > width) continue;
    context.fillRect(left, top + 6, Math.max(2, right - left), height - 13);
  }
  context.globalAlpha = 1;
  const marks = trace.sound.marks[speaker];
  marks.forEach((mark, i) => {
    const x = Math.round(view.x(mark.time, width));
    const band = trace.sound.bands[speaker].find((each) => each.from > mark.time);
    const next = Math.min(marks[i + 1]?.time ?? view.right, band?.from ?? view.right);
    const end = Math.min(width, view.x(next, width));
    if (x >= 0 && x <= width) paintMark(context, scene, mark, x, top, height, end - x - 10, shorten);
  });
}

/** Paint a mark: a line with a head for the end of a turn, a wide one for an interruption, and the words beside it. */
function paintMark(
  context: CanvasRenderingContext2D,
  scene: Scene,
  mark: Mark,
  x: number,
  top: number,
  height: number,
  room: number,
  shorten: Shorten,
): void {
  const c = scene.colours;
  const stops = mark.kind === "barge-in";
  context.fillStyle = stops ? c.failed : mark.kind === "turn" || mark.kind === "heard" ? c.ink : c.quiet;
  // An interruption reaches into the next lane, which is the agent's.
  context.fillRect(x - 1, top + 3, stops ? 3 : 1.5, stops ? 2 * height - 6 : height - 7);
  if (mark.kind === "turn") {
    context.beginPath();
    context.moveTo(x - 4, top + 2);
    context.lineTo(x + 4, top + 2);
    context.lineTo(x, top + 7);
    context.fill();
  }
  const words = mark.text === "" ? "" : `“${mark.text}”${mark.cut ? " —" : ""}`;
  if (room < 30 || words === "") return;
  const text = shorten(context, words, room);
  context.strokeStyle = c.paper;
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeText(text, x + 6, top + height / 2);
  context.fillStyle = c.ink;
  context.fillText(text, x + 6, top + height / 2);
}
