// <script src="https://.../widget.js" defer></script> adds a button to the corner of a page; the button opens the chat.
//
// Attributes of the script, all optional:
//   data-title   the name of the button, by default "Talk with us"
//   data-token   the token, if the agent needs one; everybody can read it in the page's source

import { RAVEN } from "../lib/raven";

const STYLE = `
  :host { all: initial; }
  button {
    position: fixed; right: 1.25rem; bottom: 1.25rem; z-index: 2147483000;
    width: 3.5rem; height: 3.5rem; padding: 0.75rem; border: 0; border-radius: 50%;
    background: #2b2740; box-shadow: 0 4px 18px rgb(15 12 25 / 32%); cursor: pointer;
  }
  button:focus-visible { outline: 3px solid #8a7cf0; outline-offset: 3px; }
  svg { display: block; width: 100%; height: 100%; fill: #efeaff; }
  iframe {
    position: fixed; right: 1.25rem; bottom: 5.75rem; z-index: 2147483000;
    width: min(25rem, calc(100vw - 2.5rem)); height: min(38rem, calc(100dvh - 7.5rem));
    border: 1px solid rgb(128 120 140 / 45%); border-radius: 1.125rem;
    background: Canvas; box-shadow: 0 10px 40px rgb(15 12 25 / 28%);
  }
  iframe[hidden] { display: none; }
  @media (max-width: 30rem) {
    iframe { inset: 0; width: 100%; height: 100%; border: 0; border-radius: 0; }
  }
`;

/** If the chat does not report within this many milliseconds after its frame has loaded, something is wrong. */
const PATIENCE = 1000;

const script = document.currentScript;
if (script instanceof HTMLScriptElement) {
  const put = () => embed(new URL("./", script.src), script.dataset);
  if (document.body === null) document.addEventListener("DOMContentLoaded", put);
  else put();
}

/** Add the button and the chat to the page. */
function embed(page: URL, options: DOMStringMap): void {
  const host = document.createElement("ravestate-widget");
  const root = host.attachShadow({ mode: "open" });
  const sheet = new CSSStyleSheet(); // the page may forbid inline styles
  sheet.replaceSync(STYLE);
  root.adoptedStyleSheets = [sheet];

  const button = document.createElement("button");
  button.type = "button";
  button.setAttribute("aria-label", options.title ?? "Talk with us");
  button.setAttribute("aria-expanded", "false");
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 48 48");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("fill-rule", "evenodd");
  path.setAttribute("d", RAVEN);
  svg.append(path);
  button.append(svg);
  root.append(button);
  document.body.append(host);

  let frame: HTMLIFrameElement | null = null;
  let shown = false;

  function show(open: boolean): void {
    if (open && frame === null) {
      frame = document.createElement("iframe"); // only now, so that visitors who never open the chat do not connect
      frame.title = options.title ?? "Talk with us";
      frame.allow = "microphone; camera; autoplay";
      frame.referrerPolicy = "origin"; // so that the server's log can name a site that may not embed the chat
      frame.addEventListener("load", () => setTimeout(complain, PATIENCE));
      frame.src =
        page.href + (options.token === undefined ? "" : `#token=${encodeURIComponent(options.token)}`);
      root.append(frame);
    }
    if (frame !== null) frame.hidden = !open;
    if (!open) frame?.contentWindow?.postMessage("ravestate:hidden", page.origin);
    button.setAttribute("aria-expanded", String(open));
    if (open) frame?.focus();
    else button.focus();
  }

  function complain(): void {
    if (!shown)
      console.error(
        `A page of ${location.origin} may not embed the chat: add it to the setting webio.origins. (Or no agent runs at ${page.href}.)`,
      );
  }

  button.addEventListener("click", () => show(frame === null || frame.hidden));
  window.addEventListener("message", (event) => {
    if (frame === null || event.source !== frame.contentWindow) return;
    if (event.data === "ravestate:here") shown = true;
    if (event.data === "ravestate:close") show(false);
  });
}
