// Measures frames per second from the program to a page in an unobserved Chromium, and to a client that only
// reads.
//
// usage: node e2e/tools/stream.mjs PATH/TO/supple
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import WebSocket from "ws";
import { BareChromium } from "./bare_chromium.mjs";
import { CHROMIUM_FLAGS, chromiumPath, Stage, SWAYING_CROWD, swayingBalls } from "./harness.mjs";

const SECONDS = 6;
const WARM_UP_SECONDS = 2;
/** Frames that may be in transit, as in the page. */
const CREDIT = 2;
const KIND_SCENE = 1;
const KIND_FRAME = 2;
/** Offset of the first section of a message. */
const SECTION = 16;

const wait = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));

/** The text of a message, which is its first section. */
const textOf = (message) => JSON.parse(message.subarray(SECTION + 16, SECTION + 16 + message.readUInt32LE(SECTION + 12)));

/** A client that reads only message headers: the limit of program and socket. */
async function bareClient(address) {
  const { host, search } = new URL(address);
  const socket = new WebSocket(`ws://${host}/session${search}`, { origin: `http://${host}`, perMessageDeflate: false });
  const tell = (command) => socket.send(JSON.stringify(command));
  let [frames, bytes] = [0, 0];
  let objects;
  socket.on("message", (data) => {
    const kind = data.readUInt16LE(6);
    if (kind === KIND_SCENE) {
      ({ objects } = textOf(data));
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
  const vertices = objects.reduce((sum, object) => sum + object.vertices, 0);
  return { rate: frames / seconds, megabytes: bytes / frames / 1e6, objects: objects.length, vertices };
}

/** Counts messages and measures their cost; runs in the page. */
function count(draws) {
  supple.model.setLayer("surface", draws);
  supple.client.send({ do: "speed", factor: 0 });
  window.counted = { turns: 0, reading: 0 };
  const turn = () => {
    counted.turns += 1;
    requestAnimationFrame(turn);
  };
  turn();
  const receive = supple.client.receive;
  supple.client.receive = function (message) {
    const from = performance.now();
    receive.call(this, message);
    counted.reading += performance.now() - from;
  };
}

async function inPage(address, draws) {
  const browser = new BareChromium(chromiumPath(), [...CHROMIUM_FLAGS, "--window-size=900,600"], address);
  try {
    await browser.until(() => (window.supple?.model.framesSeen ?? 0) > 0);
    await browser.evaluate(count, draws);
    await wait(WARM_UP_SECONDS);
    const look = () => ({ ...counted, frames: supple.model.framesSeen, steps: supple.model.frame.text.step, seconds: performance.now() / 1000 });
    const before = await browser.evaluate(look);
    await wait(SECONDS);
    const after = await browser.evaluate(look);
    const spent = Object.fromEntries(Object.entries(after).map(([name, value]) => [name, value - before[name]]));
    const { frames, steps, turns, reading, seconds } = spent;
    return { rate: frames / seconds, steps: steps / seconds, turns: turns / seconds, reading: reading / frames };
  } finally {
    await browser.close();
  }
}

async function measure(supple, scene) {
  const stage = new Stage(resolve(supple), null);
  try {
    const { address } = await stage.program(stage.file("balls.toml", scene));
    const bare = await bareClient(address);
    console.log(`${bare.vertices.toLocaleString("en")} vertices, objects: ${bare.objects.toLocaleString("en")}`);
    console.log(`  a client that only reads: ${bare.rate.toFixed(0)} frames/s of ${bare.megabytes.toFixed(2)} MB`);
    for (const draws of [false, true]) {
      const { rate, turns, steps, reading } = await inPage(address, draws);
      console.log(
        `  the page${draws ? ", surfaces drawn" : ""}: ${rate.toFixed(1)} frames/s of ${steps.toFixed(1)} steps/s, at ${turns.toFixed(1)} turns of the browser/s; ` +
          `${reading.toFixed(2)} ms a frame to read and take over`,
      );
    }
  } finally {
    await stage.cleanUp();
  }
}

const [supple] = process.argv.slice(2);
if (!supple || !existsSync(supple)) {
  console.error("usage: node e2e/tools/stream.mjs PATH/TO/supple");
  process.exit(2);
}
for (const scene of [swayingBalls(1, 100), swayingBalls(10, 32), SWAYING_CROWD]) await measure(supple, scene);
