import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One HTML file with everything in it: the program embeds it, and `--export` adds cargo to it. The program
// puts the cargo in place of a comment, which vite must therefore leave alone.
export default defineConfig({
  plugins: [viteSingleFile()],
  build: { target: "es2022", chunkSizeWarningLimit: 2000, reportCompressedSize: false },
  worker: { format: "iife" },
});
