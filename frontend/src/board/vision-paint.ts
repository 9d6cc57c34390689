import type { Scene } from "./paint";
import { FACES, ROWS, type Seen, type Stretch } from "./vision";

type Shorten = (context: CanvasRenderingContext2D, text: string, room: number) => string;

/** Paint a lane of the camera: a band for each face with its name, or for the body and what it does. */
export function paintVision(
  context: CanvasRenderingContext2D,
  scene: Scene,
  lane: Seen,
  top: number,
  height: number,
  shorten: Shorten,
): void {
  const { view, width, colours: c, trace } = scene;
  const stretches = trace.vision.stretches[lane];
  const visible = stretches.filter((each) => each.to >= view.left && each.from <= view.right);
  const rows = lane === FACES ? Math.max(1, ...visible.map((each) => each.row + 1)) : 1;
  const step = (height - 7) / Math.min(rows, ROWS);
  for (const each of visible) {
    const left = view.x(each.from, width);
    const right = Math.max(left + 2, view.x(each.to, width));
    const y = top + 3 + each.row * step;
    context.globalAlpha = each.kind === "body" ? 0.25 : 0.55;
    context.fillStyle = each.text === "" ? c.quiet : c.running;
    context.fillRect(left, y, right - left, step - 1);
    context.globalAlpha = 1;
    paintText(context, scene, each, Math.max(0, left) + 4, y + step / 2, right, shorten);
  }
}

function paintText(
  context: CanvasRenderingContext2D,
  scene: Scene,
  stretch: Stretch,
  x: number,
  y: number,
  right: number,
  shorten: Shorten,
): void {
  const room = Math.min(right, scene.width) - x - 4;
  const text = stretch.text === "" && stretch.kind === "face" ? "unknown" : stretch.text;
  if (room < 20 || text === "") return;
  const words = shorten(context, text, room);
  context.strokeStyle = scene.colours.paper;
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeText(words, x, y);
  context.fillStyle = scene.colours.ink;
  context.fillText(words, x, y);
}
