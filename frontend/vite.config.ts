// The chat page. The build goes into the Python package and is committed, so users need no Node.
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vitest/config";

export const outDir = "../src/ravestate/modules/platform/webio/page";

export default defineConfig({
  base: "./", // an application may mount the page anywhere
  plugins: [svelte()],
  build: {
    outDir,
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    license: { fileName: "assets/script-licences.md" }, // of the bundled packages
    modulePreload: { polyfill: false },
    rolldownOptions: {
      input: { chat: "index.html" },
      output: {
        // Fixed names: the server tells versions apart by a hash of their content.
        entryFileNames: "assets/[name].js",
        chunkFileNames: "assets/[name].js",
        assetFileNames: "assets/[name][extname]",
      },
    },
  },
  worker: { format: "es", rolldownOptions: { output: { entryFileNames: "assets/[name].js" } } }, // the audio worklet
  server: { proxy: { "/ws": { target: "ws://127.0.0.1:8420", ws: true } } },
  resolve: process.env.VITEST ? { conditions: ["browser"] } : {},
  test: { environment: "happy-dom", include: ["tests/**/*.test.ts"] },
});
