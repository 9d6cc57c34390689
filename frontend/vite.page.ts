// The configuration of a page that is built on its own, into the Python package that serves it.
import { fileURLToPath } from "node:url";
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";

/**
 * Return the configuration that builds src/NAME into a folder of the Python package. File names are fixed: the server
 * tells versions apart by a hash.
 */
export const page = (name: string, outDir: string) =>
  defineConfig({
    root: `src/${name}`,
    base: "./", // an application may mount the page anywhere
    plugins: [svelte({ configFile: fileURLToPath(new URL("svelte.config.js", import.meta.url)) })],
    build: {
      outDir: fileURLToPath(new URL(`../src/ravestate/${outDir}`, import.meta.url)),
      emptyOutDir: true,
      target: "es2022",
      assetsInlineLimit: 0,
      license: { fileName: "assets/script-licences.md" }, // of the bundled packages
      modulePreload: { polyfill: false },
      rolldownOptions: {
        output: {
          entryFileNames: `assets/${name}.js`,
          chunkFileNames: "assets/[name].js",
          assetFileNames: (asset) => `assets/${asset.names[0]?.endsWith(".css") ? name : "[name]"}[extname]`,
        },
      },
    },
  });
