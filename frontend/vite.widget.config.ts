// The widget: one classic script, so that any page can load it from anywhere and it leaves no names behind.
import { defineConfig } from "vite";
import { outDir } from "./vite.config.ts";

export default defineConfig({
  publicDir: false,
  build: {
    outDir,
    emptyOutDir: false,
    target: "es2022",
    rolldownOptions: {
      input: "src/widget/widget.ts",
      output: { format: "iife", entryFileNames: "widget.js" },
    },
  },
});
