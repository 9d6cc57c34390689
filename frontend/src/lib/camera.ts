import { LONGEST_PICTURE } from "./protocol";

/** The longest side of a picture (pixels). */
const SIZE = 640;

/** The qualities of a JPEG to try, until one is small enough. */
const QUALITIES = [0.75, 0.5, 0.25];

/** The visitor's camera. */
export interface Camera {
  /** The camera's pictures, for the preview. */
  stream: MediaStream;
  /** Return the newest picture as a small JPEG; null if there is none. */
  picture: () => Promise<ArrayBuffer | null>;
  close: () => void;
}

/**
 * Open the camera. If it does not open, `explain` says why.
 * @param onlost is called if the camera goes away, for example because it is unplugged
 */
export async function openCamera(onlost: () => void): Promise<Camera> {
  if (!window.isSecureContext || navigator.mediaDevices === undefined)
    throw new DOMException("", "SecurityError");
  const stream = await navigator.mediaDevices.getUserMedia({
    video: { width: { ideal: SIZE }, height: { ideal: 480 }, facingMode: "user" },
  });
  const video = document.createElement("video");
  video.muted = video.playsInline = true;
  video.srcObject = stream;
  const [track] = stream.getVideoTracks();
  const close = () => {
    track?.removeEventListener("ended", onlost);
    for (const each of stream.getTracks()) each.stop();
    video.srcObject = null;
  };
  track?.addEventListener("ended", onlost);
  try {
    await video.play();
  } catch (error) {
    close();
    throw error;
  }
  const canvas = document.createElement("canvas");
  return { stream, picture: () => picture(video, canvas), close };
}

async function picture(video: HTMLVideoElement, canvas: HTMLCanvasElement): Promise<ArrayBuffer | null> {
  const { videoWidth: width, videoHeight: height } = video;
  const context = canvas.getContext("2d");
  if (width === 0 || height === 0 || context === null) return null;
  const scale = Math.min(1, SIZE / Math.max(width, height));
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  context.drawImage(video, 0, 0, canvas.width, canvas.height);
  for (const quality of QUALITIES) {
    const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/jpeg", quality));
    if (blob !== null && blob.size <= LONGEST_PICTURE) return blob.arrayBuffer();
  }
  return null;
}

/** Return why the camera could not be opened, and what to do about it. */
export function explain(error: unknown, embedded: boolean): string {
  switch (error instanceof DOMException ? error.name : "") {
    case "SecurityError":
      return "Browsers let a page use the camera only over https, or on this machine (localhost). Open the page at such an address.";
    case "NotAllowedError":
      return embedded
        ? "The camera is not allowed. Allow it beside the address of the page; the web site around the chat has to allow it, too. Then press the button again."
        : "The camera is not allowed. Allow it beside the address of the page, then press the button again.";
    case "NotFoundError":
    case "OverconstrainedError":
      return "There is no camera. Connect one, then press the button again.";
    case "NotReadableError":
    case "AbortError":
      return "The camera does not start. Close other programs that use it, then press the button again.";
    default:
      return `The camera does not start: ${error instanceof Error ? error.message : error}. Load the page again.`;
  }
}
