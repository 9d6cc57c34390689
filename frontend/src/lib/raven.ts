import svg from "./raven.svg?raw";

/** The outline of the raven's head, for an SVG path in a view box of 48 by 48. */
export const RAVEN = /\sd="([^"]+)"/.exec(svg)?.[1] ?? "";
