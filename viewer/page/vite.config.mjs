import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One HTML file with everything in it: the program embeds it, and `--export` adds cargo to it. The program
// puts the cargo in place of a comment, which vite must therefore leave alone.
//
// For work on the page: `SUPPLE_VIEW=http://127.0.0.1:PORT/?token=TOKEN npm run dev`, with an address that
// `supple view` printed; open what vite prints with the same `?token=TOKEN`.
const program = process.env.SUPPLE_VIEW && new URL(process.env.SUPPLE_VIEW).origin;

export default defineConfig({
  server: program ? { proxy: { "/session": { target: program, ws: true, changeOrigin: true, headers: { origin: program } } } } : {},
  plugins: [viteSingleFile()],
  build: { target: "es2022", chunkSizeWarningLimit: 2000, reportCompressedSize: false },
  worker: { format: "iife" },
});
