// The widget: one classic script, which any page can load and which defines no global names.
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
