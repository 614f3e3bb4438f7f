// An exported page, opened as a file, without a program or a server.
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { atStep, hasFrame, isAt, pause, runProgram, said, scenes, seenTriangle, settled, step, TWO_BALLS, until } from "./tools/harness.mjs";

/** Exports a page and opens it. Any other request fails the test. */
const open = (stage, input) => openFrom(stage, input, (address) => address);

/** The same, at the address that `from` makes of that of the file. */
async function openFrom(stage, input, from) {
  const file = stage.file("page.html");
  await runProgram(stage.supple, ["view", input, "--export", file]);
  const page = await stage.page({ offline: true });
  page.on("request", (request) => {
    if (!/^(file|blob|data):/.test(request.url())) stage.errors.push(`it asks for ${request.url()}`);
  });
  await page.goto(from(pathToFileURL(file).href));
  await hasFrame(page);
  return page;
}

async function movesAndCollides(stage) {
  const page = await open(stage, join(scenes, "nine.toml"));
  await until(page, () => supple.model.frame.text.step > 10 && supple.model.frame.lists.contacts.count > 0);
  await pause(page);
  const paused = await step(page);
  await page.getByRole("button", { name: "+1 step" }).click();
  await isAt(page, paused + 1);
  await page.getByRole("checkbox", { name: "Object octrees" }).check();
  await until(page, () => supple.counts().boxes > 0);
}

/** After some steps the page has the same contacts as the program, bit by bit. */
async function agreesWithTheProgram(stage) {
  const scene = join(scenes, "nine.toml");
  const at12 = async (page) => {
    await isAt(page, 12);
    return page.evaluate(async () => {
      const { contacts, contact_points } = supple.model.frame.lists;
      const all = new Blob([...Object.values(contacts.columns), contact_points.columns.position, ...supple.model.objects.map(({ positions }) => positions)]);
      let hash = 0x811c9dc5;  // FNV-1a, because a page from a file has no crypto.subtle
      for (const byte of new Uint8Array(await all.arrayBuffer())) hash = Math.imul(hash ^ byte, 0x01000193) >>> 0;
      return { contacts: contacts.count, hash };
    });
  };
  const carried = await at12(await openFrom(stage, scene, (address) => atStep(address, 12)));
  const { page } = await stage.viewAt(12, scene);
  assert.ok(carried.contacts > 0);
  assert.deepEqual(carried, await at12(page));
}

async function isPulled(stage) {
  const page = await open(stage, stage.file("balls.toml", TWO_BALLS));
  await page.getByRole("combobox", { name: "Axis view" }).selectOption("front");
  await settled(page);
  const left = await page.evaluate(() => supple.project([-0.13, 0, 0.1]));
  const right = await page.evaluate(() => supple.project([0.5, 0, 0.1]));
  await page.getByRole("radio", { name: "Grab and pull" }).click();
  await page.mouse.move(left.x, left.y);
  await page.mouse.down();
  await page.mouse.move(right.x, right.y, { steps: 12 });
  await until(page, () => supple.model.frame.lists.contacts.count > 0);
  await page.mouse.up();
  await settled(page);
  const seen = await seenTriangle(page, 1);
  await page.getByRole("radio", { name: "Select" }).click();
  await page.mouse.click(seen.x, seen.y);
  await page.getByRole("region", { name: "Selection" }).getByText("area").waitFor();
}

async function playsARecording(stage) {
  const file = stage.file("run.h5");
  await runProgram(stage.supple, ["simulate", join(scenes, "nine.toml"), "--steps", "30", "--record", file, "--quiet"]);
  const page = await open(stage, file);
  await until(page, () => supple.model.history.frames.length > 0);
  await pause(page);
  await page.getByRole("slider", { name: "Timeline" }).fill("20");
  await isAt(page, 20);
  assert.equal(
    await page.evaluate(() => supple.model.frame.lists.contacts.count),
    await page.evaluate(() => supple.model.history.column("contacts")[20]),
  );
}

/** With Verlet's method its time step is too long. It is small, because the module is slower than the program. */
const STIFF = `
[scene]
time_step = 0.01
[[object]]
name = "block"
model = "icosphere"
motion = { kind = "mass_spring", integrator = "backward_euler", stiffness = 30000, random_force = 1, deform_seconds = 1 }
`;

/** The module is compiled without exceptions. A body that blows up must not end the session. */
async function survivesABodyThatBlowsUp(stage) {
  const page = await open(stage, stage.file("stiff.toml", STIFF));
  await page.getByRole("tab", { name: "Settings" }).click();
  const integrator = page.getByRole("combobox", { name: "Integrator" });
  await integrator.selectOption("verlet");
  await page.getByText("is too long for block").waitFor();
  await said(page, "flies off");
  await until(page, () => supple.model.frame?.text.playing === false);
  await integrator.selectOption("backward_euler");
  await isAt(page, 0);  // a change restarts the simulation
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await until(page, () => supple.model.frame.text.step > 10);
}

async function saysWhatIsBroken(stage) {
  const file = stage.file("page.html");
  await runProgram(stage.supple, ["view", join(scenes, "nine.toml"), "--export", file]);
  const page = await stage.page();
  await page.addInitScript(() => {
    document.addEventListener("readystatechange", () => {
      const show = document.getElementById("supple-scene");
      if (show) show.textContent = "AAAA";
    });
  });
  await page.goto(pathToFileURL(file).href);
  await page.getByRole("alertdialog", { name: "The session has failed" }).waitFor();
  await page.getByText("cannot be unpacked").waitFor();
}

export const tests = [
  ["moves and collides", movesAndCollides],
  ["agrees with the program to the bit", agreesWithTheProgram],
  ["a vertex is pulled", isPulled],
  ["plays a recording", playsARecording],
  ["survives a body that blows up", survivesABodyThatBlowsUp],
  ["says that what it carries is broken", saysWhatIsBroken],
];
