// The past: steps that a simulation or a program has taken, and recordings that grow.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, renameSync } from "node:fs";
import { join } from "node:path";
import { plotBox, runProgram, said, scenes, settled, simulateTo, step, until } from "./tools/harness.mjs";

const facts = (page) => page.evaluate(() => {
  const { text, lists } = supple.model.frame;
  return { step: text.step, past: text.past, playing: text.playing, range: text.range, contacts: lists.contacts.count, pairs: lists.object_pairs.count };
});
const isAt = (page, wanted) => until(page, (wanted) => supple.model.frame.text.step === wanted, wanted);

/** A simulation that has paused after some steps. */
async function simulated(stage, steps = 60) {
  const { page } = await stage.view(join(scenes, "nine.toml"));
  await simulateTo(page, steps);
  return page;
}

async function scrubsTheTimeLine(stage) {
  const page = await simulated(stage);
  const last = await step(page);
  const slider = page.getByRole("slider", { name: "Timeline" });
  const box = await slider.boundingBox();
  await page.mouse.move(box.x + box.width - 8, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.75 * box.width, box.y + box.height / 2, { steps: 8 });
  await until(page, () => supple.model.frame.text.past);
  await settled(page);
  const inPast = await slider.boundingBox();  // the bar has other buttons now
  await page.mouse.move(inPast.x + inPast.width / 2, inPast.y + inPast.height / 2, { steps: 8 });
  await page.mouse.up();
  await settled(page);
  const middle = await facts(page);
  assert.ok(Math.abs(middle.step - last / 2) <= 3, `at ${middle.step} of ${last}`);
  assert.deepEqual(middle.range, [0, last]);
  const column = await page.evaluate(() => supple.model.history.column("contacts")[supple.model.frame.text.step]);
  assert.equal(middle.contacts, column, "the contacts of the past are those that were found then");
  await page.getByRole("button", { name: "Newest step" }).click();
  await until(page, () => !supple.model.frame.text.past);
  assert.equal(await step(page), last);
  assert.ok(await page.getByRole("button", { name: "Newest step" }).isHidden());
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, (last) => supple.model.frame.text.step > last && !supple.model.frame.text.past, last);
}

async function stepsBackByKeysAndPlaysOn(stage) {
  const page = await simulated(stage);
  const last = await step(page);
  await page.getByRole("img", { name: "3D view" }).focus();
  for (let i = 1; i <= 3; ++i) {
    await page.keyboard.press("ArrowLeft");
    await isAt(page, last - i);
  }
  await page.keyboard.press("ArrowRight");
  await isAt(page, last - 2);
  assert.ok((await facts(page)).past);
  await page.keyboard.press("Home");
  await isAt(page, 0);
  await page.keyboard.press("End");
  await until(page, () => !supple.model.frame.text.past);
  await page.keyboard.press("ArrowLeft");
  await isAt(page, last - 1);
  await page.keyboard.press("Space");
  await until(page, (last) => supple.model.frame.text.step > last + 3, last);
  assert.equal((await facts(page)).past, false);
}

/** An event is named by its pair, at the pointer and after a jump. */
async function eventsAreNamed(stage) {
  const page = await simulated(stage, 100);
  const events = await page.evaluate(() => {
    const { begin, end } = supple.model.history.events.contact;
    return [...begin, ...end].map(({ frame, a, b }) => ({ frame, names: [supple.model.objects[a].name, supple.model.objects[b].name] })).filter(({ frame }) => frame > 0 && frame < supple.model.frame.text.step);
  });
  assert.ok(events.length > 2, `${events.length} events`);
  const newest = Math.max(...events.map(({ frame }) => frame));
  await page.getByRole("button", { name: "Previous event" }).click();
  await isAt(page, newest);
  await settled(page);
  const at = events.find(({ frame }) => frame === newest);
  const text = await page.getByRole("status", { name: "Event" }).innerText();
  assert.match(text, /^\d+: .+ – .+ (began|ended) to touch/);
  assert.ok(text.includes(at.names[0]) && text.includes(at.names[1]), text);
  const first = Math.min(...events.map(({ frame }) => frame));
  const box = await page.getByRole("slider", { name: "Timeline" }).boundingBox();
  const [from, to] = (await facts(page)).range;
  await page.mouse.move(box.x + 8 + ((box.width - 16) * (first - from)) / (to - from), box.y + 3);
  await until(page, (first) => document.querySelector(".named").textContent.includes(`${first}: `), first);
}

async function aSectionLoops(stage) {
  const page = await simulated(stage);
  const last = await step(page);
  const section = page.locator(".player button", { hasText: "A–" });
  const view = page.getByRole("img", { name: "3D view" });
  await view.focus();
  for (let i = 0; i < 8; ++i) await page.keyboard.press("ArrowLeft");
  await isAt(page, last - 8);
  await settled(page);
  await section.click();
  assert.match(await section.getAttribute("aria-label"), new RegExp(`starts at step ${last - 8}`));
  await view.focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight");
  await isAt(page, last - 4);
  await page.evaluate(() => {
    window.steps = [];
    supple.model.on("frame", ({ text }) => steps.push(text.step));
  });
  await page.keyboard.press("Shift+L");
  await until(page, () => steps.filter((at, i) => at < steps[i - 1]).length >= 2);
  const seen = await page.evaluate(() => steps);
  // A slow page misses steps.
  assert.ok(Math.min(...seen.slice(1)) >= last - 8 && Math.max(...seen) <= last - 4, seen.join(" "));
  assert.equal(await section.getAttribute("aria-pressed"), "true");
  await section.click();
  await until(page, (last) => supple.model.frame.text.step > last, last);
}

async function otherOptionsDetectAPastStepAgain(stage) {
  const page = await simulated(stage);
  await page.getByRole("img", { name: "3D view" }).focus();
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowLeft");
  await until(page, () => supple.model.frame.text.past);
  await settled(page);
  const before = await facts(page);
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.getByLabel("Bounding volume").selectOption("sphere");
  await until(page, () => supple.model.scene.bounding_volume === "sphere" && supple.model.frame);
  const after = await facts(page);
  assert.deepEqual([after.step, after.past, after.contacts], [before.step, true, before.contacts]);
  await page.keyboard.press("Escape");
}

async function plotsSeek(stage) {
  const page = await simulated(stage);
  await page.getByRole("tab", { name: "Plots" }).click();
  const box = await plotBox(page);
  await page.mouse.move(box.x + box.width * 0.25, box.y + 20);
  await page.mouse.click(box.x + box.width * 0.5, box.y + 20);
  await until(page, () => supple.model.frame.text.past);
  await settled(page);
  const { step: at, range } = await facts(page);
  assert.ok(Math.abs(at - range[1] / 2) < range[1] / 6, `at ${at} of ${range[1]}`);
}

async function keepsAsMuchAsItsMemoryAllows(stage) {
  const { page } = await stage.view(join(scenes, "nine.toml"), "--history", "1");
  await simulateTo(page, 60);
  const { range } = await facts(page);
  assert.ok(range[0] > 20 && range[0] < range[1], range.join());
  await page.evaluate((first) => supple.client.ask({ do: "seek", frame: first - 1 }).catch((error) => (window.refusal = error.message)), range[0]);
  assert.match(await page.evaluate(() => refusal), new RegExp(`${range[0]} to ${range[1]}`));
  await page.getByRole("tab", { name: "Plots" }).click();
  const box = await plotBox(page);
  await page.mouse.move(box.x + 20, box.y + 20);
  await page.mouse.click(box.x + 3, box.y + 20);
  await said(page, "is no longer kept");
  const none = await stage.view(join(scenes, "nine.toml"), "--history", "0");
  await until(none.page, () => supple.model.frame.text.step > 3);
  assert.ok(await none.page.getByRole("slider", { name: "Timeline" }).isHidden());
}

async function thePastCannotBePulled(stage) {
  const page = await simulated(stage);
  await page.keyboard.press("ArrowLeft");
  await until(page, () => supple.model.frame.text.past);
  await page.evaluate(() => supple.client.ask({ do: "grab", object: 0, vertex: 0 }).catch((error) => (window.refusal = error.message)));
  assert.match(await page.evaluate(() => refusal), /go to the newest step/);
}

async function everythingIsReachableInANarrowWindow(stage) {
  const page = await simulated(stage);
  for (const [width, colorScheme] of [[1440, "light"], [800, "dark"], [390, "light"]]) {
    await page.setViewportSize({ width, height: 844 });
    await page.emulateMedia({ colorScheme });
    for (const name of ["−1 step", "First frame", "Previous event", "Loop"]) {
      const button = page.getByRole("button", { name, exact: true });
      await button.click({ trial: true });
      const box = await button.boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= width, `${name} at ${width}`);
    }
    const slider = await page.getByRole("slider", { name: "Timeline" }).boundingBox();
    assert.ok(slider.width >= 70 && slider.x + slider.width <= width, `a timeline of ${slider.width} at ${width}`);
  }
}

/** The page shows the frames that a recording gets. */
async function followsARecording(stage) {
  const record = async (steps) => {
    const file = stage.file(`${steps}.h5`);
    await runProgram(stage.supple, ["simulate", join(scenes, "nine.toml"), "--steps", String(steps), "--record", file, "--quiet"]);
    return file;
  };
  const [file, longer] = [await record(20), await record(40)];
  const { page } = await stage.view(file, "--follow");
  await isAt(page, 19);
  assert.ok((await facts(page)).playing, "it waits for more frames");
  renameSync(longer, file);  // at once, so that the program never reads a part of it
  await isAt(page, 39);
  assert.ok((await facts(page)).playing);
  assert.equal(await page.evaluate(() => supple.model.history.frames.length), 40, "rows in the plots");
  await page.getByRole("button", { name: "Pause" }).click();
  await until(page, () => !supple.model.frame.text.playing);
  await page.getByRole("button", { name: "First frame" }).click();
  await isAt(page, 0);
  await page.getByRole("button", { name: "Last frame" }).click();
  await isAt(page, 39);
}

/** The page shows frames of a recording while a program writes them. */
async function followsAProgramThatRecords(stage) {
  const file = stage.file("run.h5");
  const writer = spawn(stage.supple, ["simulate", join(scenes, "rabbit_pile.toml"), "--steps", "1000000", "--record", file, "--quiet"]);
  stage.programs.push({ child: writer, stop: (signal) => writer.kill(signal) });
  while (!existsSync(file)) await new Promise((done) => setTimeout(done, 20));
  const { page } = await stage.view(file, "--follow");
  const { range } = await facts(page);
  await until(page, (last) => supple.model.frame.text.step > last + 5, range[1]);
  writer.kill("SIGINT");
  const { playing, past } = await facts(page);
  assert.ok(playing && !past);
}

export const tests = [
  ["follows a program that records", followsAProgramThatRecords],
  ["the past scrubs", scrubsTheTimeLine],
  ["keys step back, and it plays on", stepsBackByKeysAndPlaysOn],
  ["events are named by their pair", eventsAreNamed],
  ["a section loops", aSectionLoops],
  ["other options detect a past step again", otherOptionsDetectAPastStepAgain],
  ["plots seek in the past", plotsSeek],
  ["the memory of the past is bounded", keepsAsMuchAsItsMemoryAllows],
  ["the past cannot be pulled", thePastCannotBePulled],
  ["the timeline is reachable at every width", everythingIsReachableInANarrowWindow],
  ["follows a recording that grows", followsARecording],
];
