import { cleanup, fireEvent, render, screen } from "@testing-library/svelte";
import { tick } from "svelte";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import Composer from "../src/chat/Composer.svelte";
import Log from "../src/chat/Log.svelte";
import VoiceBar from "../src/chat/Voice.svelte";
import { Conversation } from "../src/lib/conversation.svelte";
import type { Devices, Listener } from "../src/lib/sound/devices";
import { TestSocket } from "./socket";

let conversation: Conversation;
let listener: Listener;
let refusal: Error | null;
let asked: Promise<void>;
const devices = { talk: vi.fn(), flush: vi.fn(), play: vi.fn(), resume: vi.fn(), close: vi.fn() };

beforeEach(() => {
  vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout", "performance"] });
  TestSocket.all = [];
  sessionStorage.clear();
  refusal = null;
  asked = Promise.resolve();
  conversation = new Conversation({ open: TestSocket.make, devices: open });
  conversation.start();
});

afterEach(() => {
  conversation.stop();
  cleanup();
  vi.clearAllMocks();
  vi.useRealTimers();
});

async function open(given: Listener): Promise<Devices> {
  await asked;
  if (refusal !== null) throw refusal;
  listener = given;
  return devices;
}

function welcome(voice = true): void {
  const socket = TestSocket.newest;
  socket.open();
  socket.tell({ type: "welcome", v: 1, session: "s", resumed: false, first: 1, agent: "Elske", voice });
}

/** Press the microphone's button for some milliseconds. */
async function press(milliseconds = 50): Promise<void> {
  conversation.voice.press();
  await vi.advanceTimersByTimeAsync(milliseconds);
  conversation.voice.release();
}

const told = () => TestSocket.newest.sent.filter((frame) => frame.type !== "hello");
const voice = () => conversation.voice;

test("only an agent that hears has a microphone button", async () => {
  welcome(false);
  const props = { agent: "Elske", closed: false, onwrite: vi.fn(), onsay: vi.fn(), voice: voice() };
  render(Composer, props);
  expect(screen.queryByRole("button", { name: "Talk with Elske" })).toBeNull();
  welcome();
  await tick();
  expect(screen.getByRole("button", { name: "Talk with Elske" })).toBeTruthy();
});

test("a short press opens the microphone, and another one turns it off", async () => {
  welcome();
  await press();
  expect([voice().state, voice().mode, voice().talking]).toEqual(["on", "open", true]);
  listener.onsound(new ArrayBuffer(640), 0.1);
  expect(TestSocket.newest.sounds.map((sound) => sound.byteLength)).toEqual([640]);
  expect(voice().level).toBeCloseTo(0.6);
  await press();
  expect([voice().state, voice().talking, voice().level]).toEqual(["off", false, 0]);
  expect(devices.close).toHaveBeenCalledOnce();
  expect(told()).toEqual([
    { type: "microphone", on: true },
    { type: "microphone", on: false },
  ]);
});

test("while the visitor holds the button, their sound goes to the agent; after that, silence does", async () => {
  welcome();
  await press(1000);
  expect([voice().state, voice().mode, voice().talking]).toEqual(["on", "hold", false]);
  expect(devices.talk.mock.calls.map(([on]) => on)).toEqual([true, false]);
  await press(100);
  expect(devices.talk.mock.calls.map(([on]) => on)).toEqual([true, false, true, false]);
  listener.onsound(new ArrayBuffer(640), 0);
  expect(TestSocket.newest.sounds.length).toBe(1);
  voice().setMode("open");
  expect(voice().talking).toBe(true);
  await press();
  expect(voice().state).toBe("off");
});

test("a microphone that starts after the visitor has changed their mind is turned off again", async () => {
  welcome();
  let allow = () => {};
  asked = new Promise((resolve) => {
    allow = resolve;
  });
  await press();
  expect(voice().state).toBe("starting");
  await press();
  allow();
  await vi.advanceTimersByTimeAsync(0);
  expect(voice().state).toBe("off");
  expect(devices.close).toHaveBeenCalledOnce();
  expect(told()).toEqual([]);
});

test("the button works with keys, and with the clicks of screen readers", async () => {
  welcome();
  render(Composer, { agent: "Elske", closed: false, onwrite: vi.fn(), onsay: vi.fn(), voice: voice() });
  const button = screen.getByRole("button", { name: "Talk with Elske" });
  await fireEvent.keyDown(button, { key: " " });
  await fireEvent.keyDown(button, { key: " ", repeat: true });
  await vi.advanceTimersByTimeAsync(1000);
  expect(voice().talking).toBe(true);
  await fireEvent.keyUp(button, { key: " " });
  expect([voice().state, voice().talking]).toEqual(["on", false]);
  await fireEvent.click(button, { detail: 0 });
  expect(voice().talking).toBe(true);
  await fireEvent.click(button, { detail: 1 }); // the click that follows a press of the pointer
  expect(voice().state).toBe("on");
  await fireEvent.click(button, { detail: 0 });
  expect(voice().state).toBe("off");
});

test("the agent's sound plays, the page reports its position ten times a second, and a flush drops it", async () => {
  welcome();
  await press();
  const socket = TestSocket.newest;
  const sound = new ArrayBuffer(960);
  const send = (data: ArrayBuffer) => socket.onmessage?.(new MessageEvent("message", { data }));
  send(sound); // no stream has begun
  expect(devices.play).not.toHaveBeenCalled();
  socket.tell({ type: "flush", n: 7 });
  expect(devices.flush).toHaveBeenLastCalledWith(7);
  send(sound);
  send(new ArrayBuffer(3)); // not whole samples
  expect(devices.play.mock.calls).toEqual([[sound]]);
  expect(voice().speaking).toBe(true);
  for (const samples of [100, 200, 300]) {
    listener.onplayed(7, samples, true);
    await vi.advanceTimersByTimeAsync(50);
  }
  listener.onplayed(6, 999, true); // of an earlier stream
  listener.onplayed(7, 480, false);
  expect(told().filter((frame) => frame.type === "played")).toEqual([
    { type: "played", n: 7, samples: 100 },
    { type: "played", n: 7, samples: 300 },
    { type: "played", n: 7, samples: 480 },
  ]);
  expect(voice().speaking).toBe(false);
});

test("Stop silences the agent at once, and drops sound that is on its way", async () => {
  welcome();
  await press();
  const socket = TestSocket.newest;
  socket.tell({ type: "flush", n: 1 });
  voice().play(new ArrayBuffer(2));
  render(VoiceBar, { voice: voice(), agent: "Elske" });
  expect(screen.getByText("Elske is speaking.")).toBeTruthy();
  await fireEvent.click(screen.getByRole("button", { name: "Stop" }));
  expect(devices.flush).toHaveBeenLastCalledWith(1);
  expect(told().at(-1)).toEqual({ type: "hush" });
  voice().play(new ArrayBuffer(2));
  expect(devices.play).toHaveBeenCalledOnce();
  expect(screen.queryByRole("button", { name: "Stop" })).toBeNull();
  socket.tell({ type: "flush", n: 2 });
  voice().play(new ArrayBuffer(2));
  expect(devices.play).toHaveBeenCalledTimes(2);
});

test("the page says when the agent begins to listen", async () => {
  welcome();
  await press();
  render(VoiceBar, { voice: voice(), agent: "Elske" });
  expect(screen.getByText("Elske prepares to listen…")).toBeTruthy();
  TestSocket.newest.tell({ type: "listening" });
  await tick();
  expect(screen.getByText("The microphone is on.")).toBeTruthy();
});

test("a caption shows, and disappears if no message follows it", async () => {
  welcome();
  await press();
  render(VoiceBar, { voice: voice(), agent: "Elske" });
  TestSocket.newest.tell({ type: "caption", text: "how are" });
  await tick();
  expect(screen.getByText("how are").getAttribute("aria-live")).toBe("polite");
  await vi.advanceTimersByTimeAsync(6000);
  expect(voice().caption).toBe("");
});

test("another window takes the microphone", async () => {
  welcome();
  await press();
  TestSocket.newest.tell({ type: "taken", text: "the microphone is on in another window" });
  expect(voice().state).toBe("off");
  expect(voice().trouble).toBe("The microphone is off: the microphone is on in another window.");
  expect(told()).toEqual([{ type: "microphone", on: true }]);
});

test("a refused microphone shows the reason, and the button tries again", async () => {
  welcome();
  refusal = new DOMException("", "NotAllowedError");
  render(VoiceBar, { voice: voice(), agent: "Elske" });
  await press();
  await tick();
  expect(screen.getByRole("alert").textContent).toContain("Allow it beside the address of the page");
  refusal = null;
  await press();
  await tick();
  expect(voice().state).toBe("on");
  expect(screen.queryByRole("alert")).toBeNull();
});

test("an unplugged microphone turns everything off", async () => {
  welcome();
  await press();
  listener.onlost();
  expect([voice().state, voice().trouble]).toEqual([
    "off",
    "The microphone is gone. Connect it, then press the button again.",
  ]);
});

test("the sound stops when the connection is lost, and starts again when it returns", async () => {
  welcome();
  await press();
  TestSocket.newest.tell({ type: "flush", n: 1 });
  voice().play(new ArrayBuffer(2));
  TestSocket.newest.lose();
  expect(devices.flush).toHaveBeenLastCalledWith(-1);
  expect(voice().speaking).toBe(false);
  listener.onsound(new ArrayBuffer(640), 0.1);
  voice().play(new ArrayBuffer(2));
  await vi.advanceTimersByTimeAsync(1000);
  welcome();
  expect(TestSocket.newest.sounds).toEqual([]);
  expect(told()).toEqual([{ type: "microphone", on: true }]);
  TestSocket.newest.tell({ type: "ended", text: "you left" });
  TestSocket.newest.lose(1000);
  expect(voice().state).toBe("off");
});

test("sound that a slow network would delay is dropped", async () => {
  welcome();
  await press();
  TestSocket.newest.bufferedAmount = 100_000;
  listener.onsound(new ArrayBuffer(640), 0.1);
  expect(TestSocket.newest.sounds).toEqual([]);
});

test("a message that was cut off ends at the last word that was heard", async () => {
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe() {}
      disconnect() {}
    },
  );
  welcome();
  const line = { type: "message", from: "agent", text: "Once upon a time.", time: 0 } as const;
  TestSocket.newest.tell({ ...line, n: 1 }, { ...line, n: 2, heard: "Once" }, { ...line, n: 3 });
  TestSocket.newest.tell({ type: "heard", n: 1, text: "Once upon" });
  render(Log, { conversation });
  await tick();
  const shown = [...document.querySelectorAll(".line")].map((each) => each.textContent?.replace(/\s+/g, " "));
  expect(shown.map((text) => text?.trim())).toEqual([
    "Elske: Once upon(interrupted)",
    "Elske: Once(interrupted)",
    "Elske: Once upon a time.",
  ]);
  TestSocket.newest.tell({ type: "heard", n: 1, text: "Once upon a time." });
  await tick();
  expect(document.querySelector(".line")?.textContent).toContain("Once upon a time.");
  vi.unstubAllGlobals();
});
