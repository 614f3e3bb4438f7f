import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// The build is one self-contained HTML file. The program embeds it, and `--export` inserts data into it. The
// program replaces a comment with the data, so vite must keep that comment.
//
// To work on the page, run `SUPPLE_VIEW=http://127.0.0.1:PORT/?token=TOKEN npm run dev` with an address that
// `supple view` printed, and open the address that vite prints with the same `?token=TOKEN`.
const program = process.env.SUPPLE_VIEW && new URL(process.env.SUPPLE_VIEW).origin;

export default defineConfig({
  server: program ? { proxy: { "/session": { target: program, ws: true, changeOrigin: true, headers: { origin: program } } } } : {},
  plugins: [viteSingleFile()],
  build: { target: "es2022", chunkSizeWarningLimit: 2000, reportCompressedSize: false },
  worker: { format: "iife" },
});
