import { AGENT, type Band, type Mark, USER } from "./sound";
import { paintVoice } from "./sound-paint";
import type { Bar, Lane, Phase, Spike, Trace } from "./trace";
import { from } from "./trace";
import { label, step, type View } from "./view";
import { BODY, FACES, type Stretch } from "./vision";
import { paintVision } from "./vision-paint";

export const LANE = 26;
export const AXIS = 26;

/** The colours of the theme, from the style sheet. */
export interface Colours {
  paper: string;
  raised: string;
  rule: string;
  ink: string;
  quiet: string;
  accent: string;
  selected: string;
  gathering: string;
  waiting: string;
  running: string;
  done: string;
  interrupted: string;
  resigned: string;
  failed: string;
  dark: boolean;
}

export function colours(element: Element): Colours {
  const style = getComputedStyle(element);
  const get = (name: string) => style.getPropertyValue(`--${name}`).trim();
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const of = (name: string) => (dark ? get(`${name}-dark`) : get(`${name}-light`));
  return {
    paper: of("paper"),
    raised: of("raised"),
    rule: of("rule"),
    ink: of("ink"),
    quiet: of("quiet"),
    accent: of("accent"),
    selected: of("selected"),
    gathering: of("gathering"),
    waiting: of("waiting"),
    running: of("running"),
    done: of("done"),
    interrupted: of("interrupted"),
    resigned: of("resigned"),
    failed: of("failed"),
    dark,
  };
}

/** Return the colour of a causal group. Groups with neighbouring numbers have distant hues. */
export function groupColour(group: number, dark: boolean): string {
  const hue = (group * 137.508 + 20) % 360;
  return dark ? `hsl(${hue.toFixed(0)} 62% 66%)` : `hsl(${hue.toFixed(0)} 62% 40%)`;
}

export interface Scene {
  trace: Trace;
  view: View;
  now: number;
  lanes: readonly string[];
  /** The scroll offset of the lanes (pixels). */
  scroll: number;
  width: number;
  height: number;
  colours: Colours;
  rule: string | null;
  /** The emphasised spikes: the chosen spike, its ancestors and its descendants. */
  kin: ReadonlySet<number>;
  spike: number | null;
}

const OUTSIDE = "";
const FONT = '11px "Inter", system-ui, sans-serif';

/** Return the lane of a spike: that of the rule that raised it, or the first lane for a spike from outside. */
function laneOf(spike: Spike): string {
  return spike.rule;
}

/** Whether the context itself raised a spike (pressure, activity). Such a spike is small, below the input. */
function isOwn(spike: Spike): boolean {
  return spike.rule === OUTSIDE && spike.signal.startsWith("core:") && spike.signal !== "core:startup";
}

const OWN = 8; // pixels from the middle of the lane down to the dot of such a spike

export function paint(context: CanvasRenderingContext2D, scene: Scene): void {
  const { view, width, height, colours: c } = scene;
  context.clearRect(0, 0, width, height);
  const first = Math.max(0, Math.floor(scene.scroll / LANE));
  const last = Math.min(scene.lanes.length, Math.ceil((scene.scroll + height - AXIS) / LANE));
  context.font = FONT;
  context.textBaseline = "middle";
  context.save();
  context.beginPath();
  context.rect(0, AXIS, width, height - AXIS);
  context.clip();
  paintGrid(context, scene);
  for (let i = first; i < last; i++) {
    const top = AXIS + i * LANE - scene.scroll;
    const name = scene.lanes[i] as string;
    if (name === scene.rule && name !== OUTSIDE) {
      context.fillStyle = c.selected;
      context.fillRect(0, top, width, LANE);
    }
    context.fillStyle = c.rule;
    context.fillRect(0, top + LANE - 1, width, 1);
    const lane = scene.trace.lanes.get(name);
    if (lane !== undefined) paintLane(context, scene, lane, top);
    if (name === USER || name === AGENT) paintVoice(context, scene, name, top, LANE, shortened);
    if (name === FACES || name === BODY) paintVision(context, scene, name, top, LANE, shortened);
  }
  const places = new Map(scene.lanes.map((name, i) => [name, AXIS + i * LANE - scene.scroll + LANE / 2]));
  paintSpikes(context, scene, places);
  paintGaps(context, scene);
  if (scene.now >= view.left && scene.now <= view.right) {
    context.fillStyle = c.accent;
    context.fillRect(Math.round(view.x(scene.now, width)), AXIS, 1, height);
  }
  context.restore();
  paintAxis(context, scene);
}

function marks(scene: Scene): [number[], number] {
  const between = step(scene.view.span, scene.width, 90);
  const found: number[] = [];
  for (let n = Math.ceil(scene.view.left / between); n * between <= scene.view.right; n++) {
    if (n >= 0) found.push(n * between);
  }
  return [found, between];
}

function paintGrid(context: CanvasRenderingContext2D, scene: Scene): void {
  context.fillStyle = scene.colours.rule;
  context.globalAlpha = 0.6;
  for (const time of marks(scene)[0]) {
    context.fillRect(Math.round(scene.view.x(time, scene.width)), AXIS, 1, scene.height);
  }
  context.globalAlpha = 1;
}

function paintAxis(context: CanvasRenderingContext2D, scene: Scene): void {
  const c = scene.colours;
  context.fillStyle = c.raised;
  context.fillRect(0, 0, scene.width, AXIS);
  context.fillStyle = c.rule;
  context.fillRect(0, AXIS - 1, scene.width, 1);
  const [times, between] = marks(scene);
  for (const time of times) {
    const x = Math.round(scene.view.x(time, scene.width));
    context.fillStyle = c.rule;
    context.fillRect(x, AXIS - 6, 1, 5);
    context.fillStyle = c.quiet;
    context.fillText(label(time, between), x + 4, AXIS / 2);
  }
}

function paintLane(context: CanvasRenderingContext2D, scene: Scene, lane: Lane, top: number): void {
  const { view } = scene;
  const start = from(lane.bars, view.left - lane.longest, (bar) => bar.from);
  const height = (LANE - 6) / lane.rows;
  const drawn: number[] = [];
  for (const bar of lane.open) paintBar(context, scene, bar, top + 3 + bar.row * height, height);
  for (let i = start; i < lane.bars.length; i++) {
    const bar = lane.bars[i] as Bar;
    if (bar.from > view.right) break;
    if (bar.to === null || bar.to < view.left) continue;
    const x = Math.round(view.x(bar.to, scene.width));
    // One bar represents all bars that end within one pixel.
    if (drawn[bar.row] === x && view.x(bar.from, scene.width) > x - 1) continue;
    drawn[bar.row] = x;
    paintBar(context, scene, bar, top + 3 + bar.row * height, height);
  }
}

const LEAST = 5;

function paintBar(
  context: CanvasRenderingContext2D,
  scene: Scene,
  bar: Bar,
  y: number,
  height: number,
): void {
  const { view, width, colours: c } = scene;
  const end = bar.to ?? scene.now;
  const left = view.x(bar.from, width);
  const right = Math.max(view.x(end, width), left);
  const inner = Math.max(2, height - 2);
  const whole = right - left;
  if (whole >= LEAST) {
    bar.phases.forEach((phase, i) => {
      const x0 = Math.max(-10, view.x(phase.from, width));
      const x1 = Math.min(width + 10, view.x(bar.phases[i + 1]?.from ?? end, width));
      if (x1 > x0) paintPhase(context, c, phase, x0, y, x1 - x0, inner);
    });
    if (bar.to !== null) paintEnd(context, c, bar, Math.max(left, right - 4), y, 4, inner);
  } else {
    paintEnd(context, c, bar, left - 1, y, LEAST, inner);
  }
  if (bar.spikes.some((spike) => scene.kin.has(spike))) {
    context.strokeStyle = c.ink;
    context.lineWidth = 1;
    context.strokeRect(
      Math.round(left) - 1.5,
      Math.round(y) - 0.5,
      Math.max(LEAST + 1, whole + 2),
      inner + 1,
    );
  }
}

function paintPhase(
  context: CanvasRenderingContext2D,
  c: Colours,
  phase: Phase,
  x: number,
  y: number,
  width: number,
  height: number,
): void {
  const middle = y + height / 2;
  if (phase.state === "running") {
    context.fillStyle = c.running;
    context.fillRect(x, y, width, height);
  } else if (phase.state === "waiting") {
    context.globalAlpha = 0.28;
    context.fillStyle = c.waiting;
    context.fillRect(x, y, width, height);
    context.globalAlpha = 1;
    context.strokeStyle = c.waiting;
    context.lineWidth = 1;
    context.beginPath();
    context.save();
    context.rect(x, y, width, height);
    context.clip();
    context.beginPath();
    for (let at = x - (x % 6) - height; at < x + width; at += 6) {
      context.moveTo(at, y + height);
      context.lineTo(at + height, y);
    }
    context.stroke();
    context.restore();
    context.strokeRect(x + 0.5, y + 0.5, Math.max(0, width - 1), height - 1);
    const room = x + width - Math.max(x, 0) - 16;
    if (room > 60 && height > 13) {
      const words = shortened(context, `waits for ${phase.waits?.join(", ") ?? ""}`, room);
      const left = Math.max(x, 0) + 5;
      context.fillStyle = c.paper;
      context.fillRect(left, y + 2, context.measureText(words).width + 8, height - 4);
      context.fillStyle = c.ink;
      context.fillText(words, left + 4, middle + 0.5);
    }
  } else {
    context.strokeStyle = c.gathering;
    context.lineWidth = phase.state === "complete" ? 2.5 : 1.25;
    context.setLineDash(phase.state === "complete" ? [] : [3, 3]);
    context.beginPath();
    context.moveTo(x, middle);
    context.lineTo(x + width, middle);
    context.stroke();
    context.setLineDash([]);
  }
}

/** Draw the end of a bar. Each outcome has its own shape and colour. */
function paintEnd(
  context: CanvasRenderingContext2D,
  c: Colours,
  bar: Bar,
  x: number,
  y: number,
  width: number,
  height: number,
): void {
  const middle = y + height / 2;
  switch (bar.outcome) {
    case "done":
    case "retired":
      context.fillStyle = c.done;
      context.fillRect(x, y, width, height);
      break;
    case "interrupted":
    case "wiped": // an open frame: the run did not reach its end
      context.fillStyle = c.paper;
      context.fillRect(x, y, width, height);
      context.strokeStyle = c.interrupted;
      context.lineWidth = 1.5;
      context.strokeRect(x + 0.75, y + 0.75, width - 1.5, height - 1.5);
      break;
    case "failed":
      context.fillStyle = c.failed;
      context.beginPath();
      context.moveTo(x - 1, y + height);
      context.lineTo(x + width / 2, y - 1);
      context.lineTo(x + width + 1, y + height);
      context.fill();
      break;
    case "resigned":
      context.strokeStyle = c.resigned;
      context.lineWidth = 1.75;
      context.beginPath();
      context.moveTo(x, y + 1);
      context.lineTo(x + width, y + height - 1);
      context.moveTo(x + width, y + 1);
      context.lineTo(x, y + height - 1);
      context.stroke();
      break;
    case "":
      context.fillStyle = bar.phases.at(-1)?.state === "running" ? c.running : c.waiting;
      context.fillRect(x, y, width, height);
      break;
    default: // the activation gave its spikes up
      context.strokeStyle = c.gathering;
      context.lineWidth = 1.5;
      context.beginPath();
      context.moveTo(x + width / 2, middle - Math.min(4, height / 2));
      context.lineTo(x + width / 2, middle + Math.min(4, height / 2));
      context.stroke();
  }
}

function paintSpikes(context: CanvasRenderingContext2D, scene: Scene, places: Map<string, number>): void {
  const { view, width, height, trace, colours: c } = scene;
  const start = from(trace.spikes, view.left, (spike) => spike.time);
  const drawn = new Map<string, number>();
  const labels = new Map<string, Label>();
  const ready: [Label, number][] = [];
  const special: Spike[] = [];
  for (let i = start; i < trace.spikes.length; i++) {
    const spike = trace.spikes[i] as Spike;
    if (spike.time > view.right) break;
    const lane = laneOf(spike);
    const y = places.get(lane);
    if (y === undefined || y < AXIS - LANE || y > height + LANE) continue;
    const x = Math.round(view.x(spike.time, width));
    const own = isOwn(spike);
    const label = labels.get(lane);
    if (own) {
      // leave room for the text of an input
    } else if (label === undefined || x > label.x) {
      if (label !== undefined) ready.push([label, x - 10]);
      labels.set(lane, { spike, x, y });
    }
    if (scene.kin.has(spike.id) || spike.id === scene.spike) {
      special.push(spike);
      continue;
    }
    const colour = groupColour(trace.group(spike.group), c.dark);
    if (own) {
      dot(context, x, y + OWN, 2.25, colour, c.paper);
      continue;
    }
    if (drawn.get(lane) === x) continue;
    drawn.set(lane, x);
    dot(context, x, y, 3.25, colour, c.paper);
  }
  for (const label of labels.values()) ready.push([label, width - 6]);
  paintAncestry(context, scene, places);
  for (const [label, end] of ready) paintLabel(context, scene, label, end);
  for (const spike of special) {
    const y = places.get(laneOf(spike));
    if (y === undefined) continue;
    const x = view.x(spike.time, width);
    const colour = groupColour(trace.group(spike.group), c.dark);
    dot(context, x, y, spike.id === scene.spike ? 6 : 4.5, colour, c.ink);
  }
}

function dot(
  context: CanvasRenderingContext2D,
  x: number,
  y: number,
  radius: number,
  fill: string,
  edge: string,
): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = fill;
  context.fill();
  context.lineWidth = 1.25;
  context.strokeStyle = edge;
  context.stroke();
}

function paintAncestry(context: CanvasRenderingContext2D, scene: Scene, places: Map<string, number>): void {
  const { trace, view, width, colours: c } = scene;
  const many = scene.kin.size > 12;
  context.lineWidth = many ? 1 : 1.5;
  context.globalAlpha = many ? 0.5 : 0.8;
  const unlined = crowds(trace, scene.kin);
  for (const id of scene.kin) {
    if (unlined.has(id)) continue;
    const spike = trace.spike(id);
    const y = spike === undefined ? undefined : places.get(laneOf(spike));
    if (spike === undefined || y === undefined) continue;
    const x = view.x(spike.time, width);
    context.strokeStyle = groupColour(trace.group(spike.group), c.dark);
    context.beginPath();
    for (const parent of spike.parents) {
      const other = trace.spike(parent);
      const above = other === undefined || !scene.kin.has(parent) ? undefined : places.get(laneOf(other));
      if (other === undefined || above === undefined) continue;
      const before = view.x(other.time, width);
      const bend = Math.max(8, Math.min(60, (x - before) / 2));
      context.moveTo(before, above);
      context.bezierCurveTo(before + bend, above, x - bend, y, x, y);
    }
    context.stroke();
  }
  context.globalAlpha = 1;
}

/** The maximum number of lines from a spike to its children of one signal. With more children, only the first and the
 * last child have a line. */
const CROWD = 6;

/** Return the spikes without a line: the children of each crowd (see `CROWD`), except the first and the last. */
function crowds(trace: Trace, kin: ReadonlySet<number>): Set<number> {
  const found = new Set<number>();
  for (const id of kin) {
    const signals = new Map<string, number[]>();
    for (const child of trace.spike(id)?.children ?? []) {
      if (!kin.has(child)) continue;
      const signal = trace.spike(child)?.signal ?? "";
      const those = signals.get(signal);
      if (those === undefined) signals.set(signal, [child]);
      else those.push(child);
    }
    for (const those of signals.values()) {
      if (those.length > CROWD) for (const child of those.slice(1, -1)) found.add(child);
    }
  }
  return found;
}

interface Label {
  spike: Spike;
  x: number;
  y: number;
}

/** Draw the text of a spike beside its dot, where there is room. */
function paintLabel(context: CanvasRenderingContext2D, scene: Scene, label: Label, end: number): void {
  const { spike, x, y } = label;
  const left = x + 8;
  if (end - left < 40 || !spike.payload.text.startsWith('"')) return;
  const lane = scene.trace.lanes.get(laneOf(spike));
  let right = end;
  if (lane !== undefined && laneOf(spike) !== OUTSIDE) {
    for (let i = from(lane.bars, spike.time - lane.longest, (bar) => bar.from); i < lane.bars.length; i++) {
      const bar = lane.bars[i] as Bar;
      const begin = scene.view.x(bar.from, scene.width);
      if (begin > right) break;
      if (bar.from > spike.time) right = begin - 4;
      else if (scene.view.x(bar.to ?? scene.now, scene.width) > left) return;
    }
  }
  if (right - left < 40) return;
  const text = shortened(context, spoken(spike.payload.text), right - left);
  context.strokeStyle = laneOf(spike) === scene.rule ? scene.colours.selected : scene.colours.paper;
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeText(text, left, y + 0.5); // an outline, against lines behind it
  context.fillStyle = laneOf(spike) === OUTSIDE ? scene.colours.ink : scene.colours.quiet;
  context.fillText(text, left, y + 0.5);
}

/** Return a JSON string in quotation marks. A cut text is not valid JSON. */
function spoken(json: string): string {
  try {
    return `“${String(JSON.parse(json))}”`;
  } catch {
    return `“${json.slice(1)}…`;
  }
}

/** Shorten a text to a width. */
function shortened(context: CanvasRenderingContext2D, text: string, room: number): string {
  const line = text.replace(/\s+/g, " ").slice(0, 200);
  const whole = context.measureText(line).width;
  if (whole <= room) return line;
  return `${line.slice(0, Math.max(1, Math.floor((line.length * room) / whole) - 2)).trimEnd()}…`;
}

function paintGaps(context: CanvasRenderingContext2D, scene: Scene): void {
  context.fillStyle = scene.colours.failed;
  for (const gap of scene.trace.gaps) {
    const x = scene.view.x(gap.time, scene.width);
    if (x < 0 || x > scene.width) continue;
    context.globalAlpha = 0.5;
    for (let y = AXIS; y < scene.height; y += 8) context.fillRect(Math.round(x), y, 2, 4);
    context.globalAlpha = 1;
  }
}

/**
 * Return the spike at a place, or else the bar. In the lane of a voice, return the stretch of speech and the mark. In a
 * lane of the camera, return what was seen.
 */
export function at(
  scene: Scene,
  x: number,
  y: number,
): { spike?: Spike; bar?: Bar; band?: Band; mark?: Mark; seen?: Stretch[] } {
  const index = Math.floor((y - AXIS + scene.scroll) / LANE);
  const name = scene.lanes[index];
  if (y < AXIS || name === undefined) return {};
  const { view, width, trace } = scene;
  const reach = (7 / width) * view.span;
  const time = view.time(x, width);
  if (name === USER || name === AGENT) return trace.sound.at(name, time, reach, scene.now);
  if (name === FACES || name === BODY) {
    const seen = trace.vision.at(name, time, reach);
    return seen.length > 0 ? { seen } : {};
  }
  const middle = AXIS + index * LANE - scene.scroll + LANE / 2;
  // The dots of spikes that the context itself raised are below the other dots.
  const below = name === OUTSIDE && y > middle + OWN / 2;
  const away = (spike: Spike) => Math.abs(spike.time - time) + (isOwn(spike) === below ? 0 : reach);
  let best: Spike | undefined;
  for (let i = from(trace.spikes, time - reach, (spike) => spike.time); i < trace.spikes.length; i++) {
    const spike = trace.spikes[i] as Spike;
    if (spike.time > time + reach) break;
    if (laneOf(spike) === name && (best === undefined || away(spike) <= away(best))) best = spike;
  }
  const lane = trace.lanes.get(name);
  if (best !== undefined && (lane === undefined || Math.abs(y - middle) < 7)) return { spike: best };
  if (lane === undefined) return {};
  const row = Math.min(
    lane.rows - 1,
    Math.max(0, Math.floor((y - middle + LANE / 2 - 3) / ((LANE - 6) / lane.rows))),
  );
  let bar: Bar | undefined;
  for (let i = from(lane.bars, time - lane.longest - reach, (b) => b.from); i < lane.bars.length; i++) {
    const one = lane.bars[i] as Bar;
    if (one.from > time + reach) break;
    if (one.row === row && (one.to ?? scene.now) >= time - reach) bar = one;
  }
  for (const one of lane.open) if (one.row === row && one.from <= time + reach) bar ??= one;
  return bar === undefined ? {} : { bar };
}
