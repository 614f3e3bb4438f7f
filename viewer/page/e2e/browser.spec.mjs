// The browser that the program opens itself.
import assert from "node:assert/strict";
import { chmodSync, existsSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { hasFrame, TWO_BALLS } from "./harness.mjs";

/**
 * The browser gets a file instead of the address. The file leads to the page and does not reveal the token
 * to others.
 */
async function isLedToThePage(stage) {
  const opener = stage.file("xdg-open", `#!/bin/sh\nprintf '%s' "$*" > "$0.part"; mv "$0.part" "$0.asked"\n`);
  chmodSync(opener, 0o755);
  const scene = stage.file("balls.toml", TWO_BALLS);
  const program = await stage.programIn({ PATH: `${stage.folder}:${process.env.PATH}`, DISPLAY: ":0", XDG_RUNTIME_DIR: stage.folder }, scene);
  while (!existsSync(`${opener}.asked`)) await new Promise((done) => setTimeout(done, 20));
  const page = await stage.page();
  await page.goto(pathToFileURL(readFileSync(`${opener}.asked`, "utf8")).href);
  await page.waitForURL(program.address);
  await hasFrame(page);
  assert.equal(await page.evaluate(() => document.referrer), "");
}

export const tests = [["is led to the page by a file", isLedToThePage]];
