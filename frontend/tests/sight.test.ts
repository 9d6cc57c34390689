import { cleanup, fireEvent, render, screen } from "@testing-library/svelte";
import { tick } from "svelte";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import Composer from "../src/chat/Composer.svelte";
import SightBar from "../src/chat/Sight.svelte";
import type { Camera } from "../src/lib/camera";
import { explain } from "../src/lib/camera";
import { Conversation } from "../src/lib/conversation.svelte";
import { TestSocket } from "./socket";

const NOTICE = "No picture is kept.";
let conversation: Conversation;
let lose: () => void;
let refusal: Error | null;
let asked: Promise<void>;
const picture = vi.fn<() => Promise<ArrayBuffer | null>>();
const close = vi.fn();

beforeEach(() => {
  vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout"] });
  TestSocket.all = [];
  sessionStorage.clear();
  localStorage.clear();
  refusal = null;
  asked = Promise.resolve();
  picture.mockResolvedValue(new ArrayBuffer(9));
  conversation = new Conversation({ open: TestSocket.make, camera: open });
  conversation.start();
});

afterEach(() => {
  conversation.stop();
  cleanup();
  vi.resetAllMocks();
  vi.useRealTimers();
});

async function open(onlost: () => void): Promise<Camera> {
  await asked;
  if (refusal !== null) throw refusal;
  lose = onlost;
  return { stream: new MediaStream(), picture, close };
}

function welcome(sight: string | undefined = NOTICE): void {
  const socket = TestSocket.newest;
  socket.open();
  const frame = { type: "welcome", v: 1, session: "s", resumed: false, first: 1, agent: "Elske" } as const;
  socket.tell(sight === undefined ? frame : { ...frame, sight });
}

async function turnOn(): Promise<void> {
  sight().press();
  sight().agree();
  await vi.advanceTimersByTimeAsync(0);
}

const told = () => TestSocket.newest.sent.filter((frame) => frame.type !== "hello");
const sight = () => conversation.sight;
const on = { type: "camera", on: true };
const off = { type: "camera", on: false };

test("only an agent that sees has a camera button", async () => {
  TestSocket.newest.welcome("s");
  const props = { agent: "Elske", closed: false, onwrite: vi.fn(), onsay: vi.fn(), sight: sight() };
  render(Composer, props);
  expect(screen.queryByRole("button", { name: "Let Elske see you" })).toBeNull();
  welcome();
  await tick();
  expect(screen.getByRole("button", { name: "Let Elske see you" })).toBeTruthy();
});

test("a notice comes before the camera goes on, until the visitor has agreed once", async () => {
  welcome();
  render(SightBar, { sight: sight(), agent: "Elske" });
  sight().press();
  await tick();
  expect(screen.getByText(NOTICE)).toBeTruthy();
  await fireEvent.click(screen.getByRole("button", { name: "Not now" }));
  expect([sight().state, told()]).toEqual(["off", []]);
  sight().press();
  await tick();
  await fireEvent.click(screen.getByRole("button", { name: "Turn the camera on" }));
  await vi.advanceTimersByTimeAsync(0);
  expect([sight().state, told()]).toEqual(["on", [on]]);
  sight().press();
  expect([sight().state, told()]).toEqual(["off", [on, off]]);
  expect(close).toHaveBeenCalledOnce();
  sight().press(); // they have agreed
  await vi.advanceTimersByTimeAsync(0);
  expect(sight().state).toBe("on");
});

test("a changed notice asks for consent again", async () => {
  welcome();
  await turnOn();
  sight().stop();
  welcome("Everything is kept.");
  sight().press();
  expect(sight().state).toBe("asking");
});

test("each request gets one picture, announced by its number", async () => {
  welcome();
  await turnOn();
  const socket = TestSocket.newest;
  expect(socket.sounds).toEqual([]);
  socket.tell({ type: "look", n: 1 });
  await vi.advanceTimersByTimeAsync(0);
  expect([told().at(-1), socket.sounds.length]).toEqual([{ type: "picture", n: 1 }, 1]);
  expect(sight().looks).toBe(true);
});

test("the page asks a camera without a picture again, and answers only the last request", async () => {
  welcome();
  await turnOn();
  const socket = TestSocket.newest;
  picture.mockResolvedValueOnce(null).mockRejectedValueOnce(new Error("busy"));
  socket.tell({ type: "look", n: 1 });
  await vi.advanceTimersByTimeAsync(0);
  socket.tell({ type: "look", n: 2 });
  await vi.advanceTimersByTimeAsync(2000);
  expect(told().filter((frame) => frame.type === "picture")).toEqual([{ type: "picture", n: 2 }]);
  sight().stop();
  socket.tell({ type: "look", n: 3 });
  await vi.advanceTimersByTimeAsync(2000);
  expect(socket.sounds.length).toBe(1);
});

test("the preview shows a box and a name for each face, mirrored", async () => {
  welcome();
  await turnOn();
  const { container } = render(SightBar, { sight: sight(), agent: "Elske" });
  expect(screen.getByRole("status").textContent).toBe("Elske opens its eyes…");
  TestSocket.newest.tell({ type: "look", n: 1 });
  await vi.advanceTimersByTimeAsync(0);
  expect(screen.getByRole("status").textContent).toBe("Elske sees no face.");
  const anna = { box: [0.125, 0.25, 0.5, 0.5] as [number, number, number, number], name: "Anna" };
  TestSocket.newest.tell({ type: "faces", faces: [anna, { box: [0, 0, 0.1, 0.1] }] });
  await tick();
  const boxes = [...container.querySelectorAll<HTMLElement>(".face")];
  expect(boxes.map((box) => box.textContent?.trim())).toEqual(["Anna", "unknown"]);
  expect([boxes[0]?.style.left, boxes[0]?.style.width]).toEqual(["37.50%", "50.00%"]);
  expect(screen.getByRole("status").textContent).toBe("Elske sees Anna.");
});

test("after a refusal of the camera, the page says what to do, and the button tries again", async () => {
  welcome();
  refusal = new DOMException("", "NotAllowedError");
  await turnOn();
  expect(sight().trouble).toContain("The camera is not allowed. Allow it");
  expect([sight().state, told()]).toEqual(["off", []]);
  refusal = null;
  sight().press();
  await vi.advanceTimersByTimeAsync(0);
  expect([sight().state, sight().trouble]).toEqual(["on", ""]);
  lose();
  expect([sight().state, sight().trouble]).toEqual([
    "off",
    "The camera is gone. Connect it, then press the button again.",
  ]);
});

test("each failure of the camera has a message with its remedy", () => {
  const names = ["SecurityError", "NotFoundError", "NotReadableError"];
  const texts = names.map((name) => explain(new DOMException("", name), false));
  expect(texts.map((text) => text.split(/[,.]/)[0])).toEqual([
    "Browsers let a page use the camera only over https",
    "There is no camera",
    "The camera does not start",
  ]);
  expect(explain(new DOMException("", "NotAllowedError"), true)).toContain("the web site around the chat");
  expect(explain(new Error("odd"), false)).toContain("odd");
});

test("a camera that opens too late is closed at once", async () => {
  welcome();
  let opens: () => void = () => {};
  asked = new Promise((resolve) => {
    opens = resolve;
  });
  await turnOn();
  sight().press();
  opens();
  await vi.advanceTimersByTimeAsync(0);
  expect(close).toHaveBeenCalledOnce();
  expect([sight().state, told()]).toEqual(["off", []]);
});

test("after a lost connection the camera is still on; another window may take it", async () => {
  welcome();
  await turnOn();
  TestSocket.newest.tell({ type: "faces", faces: [{ box: [0, 0, 1, 1] }] });
  TestSocket.newest.lose();
  expect([sight().state, sight().faces]).toEqual(["on", []]);
  conversation.nudge();
  welcome();
  expect(told()).toEqual([on]);
  TestSocket.newest.tell({ type: "unseen", text: "the camera is on in another window" });
  expect([sight().state, sight().trouble]).toEqual([
    "off",
    "The camera is off: the camera is on in another window.",
  ]);
  expect(told()).toEqual([on]); // the server knows
});
