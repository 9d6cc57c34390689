// The stand-in robot's face: a page of its own, which ships with the module that serves it.
import { fileURLToPath } from "node:url";
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";

export default defineConfig({
  root: "src/robot",
  base: "./",
  plugins: [svelte({ configFile: fileURLToPath(new URL("svelte.config.js", import.meta.url)) })],
  build: {
    outDir: fileURLToPath(new URL("../src/ravestate/modules/platform/roboyio/page", import.meta.url)),
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    license: { fileName: "assets/script-licences.md" }, // of the bundled packages
    modulePreload: { polyfill: false },
    rolldownOptions: {
      output: {
        entryFileNames: "assets/robot.js",
        chunkFileNames: "assets/[name].js",
        assetFileNames: (asset) => `assets/${asset.names[0]?.endsWith(".css") ? "robot" : "[name]"}[extname]`,
      },
    },
  },
});
