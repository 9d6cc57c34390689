import address from "./worklet.ts?worker&url";

/** A listener to the reports of a pair of devices. */
export interface Listener {
  /** 20 ms of the visitor's sound: 16-bit samples at 16 kHz, and their level (0 to 1). */
  onsound: (sound: ArrayBuffer, level: number) => void;
  /** The number of samples of stream `n` that the loudspeaker has played, and whether there is more to play. */
  onplayed: (n: number, samples: number, busy: boolean) => void;
  /** The microphone has gone, for example unplugged. */
  onlost: () => void;
}

/** The visitor's microphone and loudspeaker. */
export interface Devices {
  /** Let the microphone's sound through, or silence instead. */
  talk: (on: boolean) => void;
  /** Drop the sound that has not been played; the sound after this call is stream `n`. */
  flush: (n: number) => void;
  play: (sound: ArrayBuffer) => void;
  /** Let the browser play sound; to be called while the visitor presses something. */
  resume: () => void;
  close: () => void;
}

/** Open the microphone and the loudspeaker. If that fails, `explain` says why. */
export async function openDevices(listener: Listener): Promise<Devices> {
  if (!window.isSecureContext || navigator.mediaDevices === undefined)
    throw new DOMException("", "SecurityError");
  if (typeof AudioWorkletNode === "undefined") throw new DOMException("", "NotSupportedError");
  const context = new AudioContext({ latencyHint: "interactive" });
  let stream: MediaStream | undefined;
  try {
    stream = await navigator.mediaDevices.getUserMedia({
      audio: { echoCancellation: true, noiseSuppression: true, autoGainControl: true, channelCount: 1 },
    });
    await context.audioWorklet.addModule(address);
  } catch (error) {
    stop(stream);
    await context.close();
    throw error;
  }
  return connect(context, stream, listener);
}

function connect(context: AudioContext, stream: MediaStream, listener: Listener): Devices {
  const [track] = stream.getAudioTracks();
  const capture = new AudioWorkletNode(context, "capture", { numberOfOutputs: 0 });
  const playout = new AudioWorkletNode(context, "playout", { numberOfInputs: 0, outputChannelCount: [1] });
  context.createMediaStreamSource(stream).connect(capture);
  playout.connect(context.destination);
  capture.port.onmessage = ({ data }) => listener.onsound(data.sound, data.level);
  playout.port.onmessage = ({ data }) => listener.onplayed(data.n, data.samples, data.busy);
  track?.addEventListener("ended", listener.onlost);
  const resume = () => {
    if (context.state !== "running" && context.state !== "closed") context.resume().catch(() => {});
  };
  resume();
  return {
    talk: (on) => {
      if (track !== undefined) track.enabled = on;
    },
    flush: (n) => playout.port.postMessage({ flush: n }),
    play: (sound) => {
      const latency = context.outputLatency || context.baseLatency || 0; // browsers know it only after a while
      playout.port.postMessage({ sound, latency }, [sound]);
    },
    resume,
    close: () => {
      track?.removeEventListener("ended", listener.onlost);
      capture.port.onmessage = playout.port.onmessage = null;
      stop(stream);
      context.close().catch(() => {});
    },
  };
}

function stop(stream: MediaStream | undefined): void {
  for (const track of stream?.getTracks() ?? []) track.stop();
}

/** Return why the devices could not be opened, and what to do about it. */
export function explain(error: unknown, embedded: boolean): string {
  switch (error instanceof DOMException ? error.name : "") {
    case "SecurityError":
      return "Browsers let a page use the microphone only over https, or on this machine (localhost). Open the page at such an address.";
    case "NotAllowedError":
      return embedded
        ? "The microphone is not allowed. Allow it beside the address of the page; the web site around the chat has to allow it, too. Then press the button again."
        : "The microphone is not allowed. Allow it beside the address of the page, then press the button again.";
    case "NotFoundError":
    case "OverconstrainedError":
      return "There is no microphone. Connect one, then press the button again.";
    case "NotReadableError":
    case "AbortError":
      return "The microphone does not start. Close other programs that use it, then press the button again.";
    case "NotSupportedError":
      return "This browser is too old for sound. Update it, or use another one.";
    default:
      return `The sound does not start: ${error instanceof Error ? error.message : error}. Load the page again.`;
  }
}
