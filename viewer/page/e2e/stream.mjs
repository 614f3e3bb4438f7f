// How many frames a second come from the program to a page, in a Chromium that nothing else watches, beside a client that only reads.
//   node e2e/stream.mjs PATH/TO/supple
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import WebSocket from "ws";
import { BareChromium } from "./bare_chromium.mjs";
import { CHROMIUM_FLAGS, chromiumPath, Stage, swayingBalls } from "./harness.mjs";

const SECONDS = 6;
const WARM_UP_SECONDS = 2;
/** Frames that a client lets be under way, as the page does. */
const CREDIT = 2;
const KIND_SCENE = 1;
const KIND_FRAME = 2;

const wait = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));

/** A client that reads a message's header and nothing more: what program and socket can do. */
async function bareClient(address) {
  const { host, search } = new URL(address);
  const socket = new WebSocket(`ws://${host}/session${search}`, { origin: `http://${host}`, perMessageDeflate: false });
  const tell = (command) => socket.send(JSON.stringify(command));
  let [frames, bytes] = [0, 0];
  socket.on("message", (data) => {
    const kind = data.readUInt16LE(6);
    if (kind === KIND_SCENE) {
      tell({ do: "speed", factor: 0 });
      tell({ do: "play" });
      tell({ do: "credit", frames: CREDIT });
    } else if (kind === KIND_FRAME) {
      frames += 1;
      bytes += data.length;
      tell({ do: "credit", frames: 1 });
    }
  });
  await new Promise((done, fail) => socket.on("open", done).on("error", fail));
  await wait(WARM_UP_SECONDS);
  [frames, bytes] = [0, 0];
  const begin = performance.now();
  await wait(SECONDS);
  const seconds = (performance.now() - begin) / 1000;
  socket.close();
  return { rate: frames / seconds, megabytes: bytes / frames / 1e6 };
}

async function inPage(address, draws) {
  const browser = new BareChromium(chromiumPath(), [...CHROMIUM_FLAGS, "--window-size=900,600"], address);
  try {
    await browser.until(() => (window.supple?.model.framesSeen ?? 0) > 0);
    await browser.evaluate((draws) => {
      supple.model.setLayer("surface", draws);
      supple.client.send({ do: "speed", factor: 0 });
      window.turns = 0;
      const turn = () => {
        window.turns += 1;
        requestAnimationFrame(turn);
      };
      turn();
    }, draws);
    await wait(WARM_UP_SECONDS);
    const look = () => ({ frames: supple.model.framesSeen, turns, step: supple.model.frame.text.step, at: performance.now() });
    const before = await browser.evaluate(look);
    await wait(SECONDS);
    const after = await browser.evaluate(look);
    const seconds = (after.at - before.at) / 1000;
    return { rate: (after.frames - before.frames) / seconds, turns: (after.turns - before.turns) / seconds, steps: (after.step - before.step) / seconds };
  } finally {
    await browser.close();
  }
}

async function measure(supple, count, frequency) {
  const stage = new Stage(resolve(supple), null);
  try {
    const { address } = await stage.program(stage.file("balls.toml", swayingBalls(count, frequency)));
    const vertices = count * (10 * frequency ** 2 + 2);
    console.log(`${vertices.toLocaleString("en")} vertices in ${count === 1 ? "one object" : `${count} objects`}`);
    const bare = await bareClient(address);
    console.log(`  a client that only reads: ${bare.rate.toFixed(0)} frames/s of ${bare.megabytes.toFixed(2)} MB`);
    for (const draws of [false, true]) {
      const { rate, turns, steps } = await inPage(address, draws);
      console.log(`  the page${draws ? ", surfaces drawn" : ""}: ${rate.toFixed(1)} frames/s of ${steps.toFixed(1)} steps/s, at ${turns.toFixed(1)} turns of the browser/s`);
    }
  } finally {
    await stage.cleanUp();
  }
}

const [supple] = process.argv.slice(2);
if (!supple || !existsSync(supple)) {
  console.error("usage: node e2e/stream.mjs PATH/TO/supple");
  process.exit(2);
}
await measure(supple, 1, 100);
await measure(supple, 10, 32);
