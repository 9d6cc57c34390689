import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { type Devices, explain, openDevices } from "../src/lib/sound/devices";

/** A browser's sound, with a microphone that can be refused. */
class Port {
  onmessage: ((event: { data: unknown }) => void) | null = null;
  posted: unknown[] = [];
  postMessage(data: unknown) {
    this.posted.push(data);
  }
}

class Node {
  static all: Record<string, Node> = {};
  port = new Port();
  constructor(
    _: unknown,
    readonly name: string,
  ) {
    Node.all[name] = this;
  }
  connect() {}
}

class Sound {
  static newest: Sound;
  state = "suspended";
  outputLatency = 0.05;
  destination = {};
  audioWorklet = { addModule: vi.fn(async () => {}) };
  close = vi.fn(async () => {});
  resume = vi.fn(async () => {
    this.state = "running";
  });
  createMediaStreamSource = () => ({ connect: () => {} });
  constructor() {
    Sound.newest = this;
  }
}

const track = Object.assign(new EventTarget(), { enabled: true, stop: vi.fn() });
const getUserMedia = vi.fn();
const listener = { onsound: vi.fn(), onplayed: vi.fn(), onlost: vi.fn() };

beforeEach(() => {
  vi.stubGlobal("isSecureContext", true);
  vi.stubGlobal("AudioContext", Sound);
  vi.stubGlobal("AudioWorkletNode", Node);
  vi.stubGlobal("navigator", { mediaDevices: { getUserMedia } });
  getUserMedia.mockResolvedValue({ getAudioTracks: () => [track], getTracks: () => [track] });
});

afterEach(() => {
  vi.unstubAllGlobals();
  vi.clearAllMocks();
});

async function failure(work: Promise<Devices>): Promise<string> {
  return work.then(
    () => "it opened",
    (error: unknown) => explain(error, false),
  );
}

test("the page asks the browser to remove the echo and to play sound", async () => {
  await openDevices(listener);
  expect(getUserMedia.mock.calls[0]?.[0].audio).toMatchObject({
    echoCancellation: true,
    noiseSuppression: true,
  });
  expect(Sound.newest.resume).toHaveBeenCalled();
});

test("sound passes in both directions, and the microphone can be muted", async () => {
  const devices = await openDevices(listener);
  Node.all.capture?.port.onmessage?.({ data: { sound: "sound", level: 0.5 } });
  expect(listener.onsound).toHaveBeenCalledWith("sound", 0.5);
  Node.all.playout?.port.onmessage?.({ data: { n: 3, samples: 100, busy: true } });
  expect(listener.onplayed).toHaveBeenCalledWith(3, 100, true);
  devices.talk(false);
  expect(track.enabled).toBe(false);
  const sound = new ArrayBuffer(2);
  devices.flush(4);
  devices.play(sound);
  expect(Node.all.playout?.port.posted).toEqual([{ flush: 4 }, { sound, latency: 0.05 }]);
  devices.close();
  expect(track.stop).toHaveBeenCalled();
  expect(Sound.newest.close).toHaveBeenCalled();
  track.dispatchEvent(new Event("ended")); // the page itself has stopped the track
  expect(listener.onlost).not.toHaveBeenCalled();
});

test("a microphone that is unplugged is noticed", async () => {
  await openDevices(listener);
  track.dispatchEvent(new Event("ended"));
  expect(listener.onlost).toHaveBeenCalled();
});

test.each([
  ["NotAllowedError", "Allow it beside the address"],
  ["NotFoundError", "Connect one"],
  ["NotReadableError", "Close other programs"],
])("after %s nothing stays open, and the visitor learns what to do", async (name, mend) => {
  getUserMedia.mockRejectedValue(new DOMException("", name));
  expect(await failure(openDevices(listener))).toContain(mend);
  expect(Sound.newest.close).toHaveBeenCalled();
});

test("if the worklet does not load, the microphone goes off", async () => {
  class Broken extends Sound {
    override audioWorklet = { addModule: vi.fn(() => Promise.reject(new Error("404"))) };
  }
  vi.stubGlobal("AudioContext", Broken);
  expect(await failure(openDevices(listener))).toBe("The sound does not start: 404. Load the page again.");
  expect(track.stop).toHaveBeenCalled();
});

test("an address without https, an old browser and an embedding site each have a message of their own", async () => {
  expect(explain(new DOMException("", "NotAllowedError"), true)).toContain("the web site around the chat");
  vi.stubGlobal("AudioWorkletNode", undefined);
  expect(await failure(openDevices(listener))).toContain("too old");
  vi.stubGlobal("isSecureContext", false);
  expect(await failure(openDevices(listener))).toContain("only over https");
  expect(getUserMedia).not.toHaveBeenCalled();
});
