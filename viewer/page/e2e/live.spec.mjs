// A simulation in the program, controlled in a page: it plays and pauses, its settings change, plots follow, others watch.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { camera, goesOn, hasFrame, pause, picture, scenes, settled, simulateTo, step, steps, until } from "./tools/harness.mjs";

const nine = join(scenes, "nine.toml");

async function movesPausesAndSteps(stage) {
  const { page } = await stage.view(nine);
  const drawn = await picture(page);
  const before = await page.evaluate(() => ({ step: supple.model.frame.text.step, at: supple.positionOf(0, 0) }));  // of the picture, or later
  await until(page, (before) => supple.model.frame.text.step > before + 5, before.step);
  assert.notDeepEqual(await page.evaluate(() => supple.positionOf(0, 0)), before.at);
  assert.notEqual(await picture(page), drawn);

  await page.getByRole("button", { name: "Pause" }).click();
  await until(page, () => !supple.model.frame.text.playing);
  const paused = await step(page);
  await goesOn(page);
  await settled(page);
  assert.equal(await step(page), paused);
  await page.getByRole("button", { name: "+1 step" }).click();
  await until(page, (wanted) => supple.model.frame.text.step === wanted, paused + 1);
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, (paused) => supple.model.frame.text.step > paused + 3, paused);
}

async function resetsWithASeedAndSpeed(stage) {
  const { page } = await stage.view(nine);
  await until(page, () => supple.model.frame.text.step > 10);
  await page.getByRole("combobox", { name: "Speed" }).selectOption("0.1");
  await until(page, () => supple.model.frame.text.speed === 0.1);
  const generation = await page.evaluate(() => supple.model.scene.generation);
  await page.getByRole("textbox", { name: "Seed" }).fill("18446744073709551615");
  await page.getByRole("textbox", { name: "Seed" }).press("Enter");
  await until(page, (old) => supple.model.scene.generation > old && supple.model.frame, generation);
  assert.equal(await page.evaluate(() => supple.model.scene.seed), "18446744073709551615");
  await simulateTo(page, 3);
  await page.getByRole("button", { name: "Reset" }).click();
  await until(page, () => supple.model.frame?.text.step === 0);
}

/** The collisions of the narrow phase are counted while their layer is on. */
async function eventsAreCounted(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  await page.getByText("counted with Colliding vertices").waitFor();
  await page.getByRole("checkbox", { name: "Colliding vertices" }).check();
  await simulateTo(page, 60);
  await page.getByRole("tab", { name: "Plots" }).click();
  for (const [kind, label] of [["contact", "contacts"], ["narrow_phase", "narrow phase"], ["volume", "broad phase"]]) {
    const { began, ended } = await page.evaluate((kind) => {
      const { begin, end } = supple.model.history.events[kind];
      return { began: begin.length, ended: end.length };
    }, kind);
    assert.ok(began > 0, `no events of the ${label}`);
    await page.locator(`dt:text-is("${label}") + dd:text-is("${began} began, ${ended} ended")`).waitFor();
  }
}

/** Values to try; for the others the next word or the other truth. */
const OTHER_VALUES = { max_level: "5", leaf_size: "8", tree_arity: "2", objects: "12", time_step: "0.01" };
const TRIED = ["bounding_volume", "broad_phase", "contacts", "undecided", "rebuild_degraded", "object_octree", ...Object.keys(OTHER_VALUES)];

/** After each setting, the step and the positions are kept, or the restart was announced at the field. */
async function settingsKeepTheStateOrSayThatTheyRestart(stage) {
  const { page } = await stage.view(nine);
  await pause(page);
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.getByText("More options").click();
  const settings = await page.evaluate(() => supple.model.scene.settings);
  assert.deepEqual(settings.filter(({ restarts }) => restarts).map(({ key }) => key), ["objects", "time_step"]);
  for (const key of TRIED) {
    const setting = settings.find((each) => each.key === key);
    const at = await step(page);
    await page.evaluate(() => supple.client.ask({ do: "step", count: 3 }));
    await until(page, (wanted) => supple.model.frame.text.step === wanted, at + 3);
    await settled(page);
    const state = () => page.evaluate(() => ({
      step: supple.model.frame.text.step, run: supple.model.scene.run, generation: supple.model.scene.generation, at: supple.positionOf(0, 0),
      rows: supple.model.history.frames.length, pairs: supple.model.history.events.contact.begin.length,
    }));
    const before = await state();
    assert.ok(before.step > 0);
    const field = page.locator(`.setting:has(#setting-${key})`);
    assert.equal((await field.innerText()).includes("restarts"), setting.restarts, `${key} announces a wrong thing`);
    const input = page.locator(`#setting-${key}`);
    if (setting.kind === "truth") await input.click();
    else if (setting.kind === "word") await input.selectOption(await input.evaluate((select) => select.options[(select.selectedIndex + 1) % select.options.length].value));
    else {
      await input.fill(OTHER_VALUES[key]);
      await input.press("Enter");
    }
    await until(page, (old) => supple.model.scene.generation > old && supple.model.frame, before.generation);
    const after = await state();
    if (setting.restarts) {
      assert.deepEqual({ step: after.step, run: after.run }, { step: 0, run: before.run + 1 }, `${key} does not restart`);
    } else {
      const { generation, pairs, ...kept } = before;
      assert.deepEqual({ ...after, generation: 0, pairs: 0 }, { ...kept, generation: 0, pairs: 0 }, `${key} changes the state`);
      if (key === "max_level") assert.equal(after.pairs, pairs, "contacts begin again");
    }
    assert.ok(await field.getByRole("alert").isHidden(), `${key} is refused`);
  }
  assert.ok(await page.evaluate(() => supple.model.objects.some(({ name }) => name.endsWith("#2"))));
}

/** The reason is at the field, with the range; the value in effect stays. */
async function wrongValuesAreRefused(stage) {
  const { page } = await stage.viewAt(3, nine);
  await page.getByRole("tab", { name: "Settings" }).click();
  const refused = [
    ["time_step", "-1", "a finite number above 0", "0.02"], ["time_step", "0", "above 0", "0.02"], ["time_step", "soon", "\"soon\"", "0.02"],
    ["max_level", "99", "a whole number from 0 to 32", "16"], ["max_level", "2.5", "a whole number from 0 to 32", "16"],
    ["leaf_size", "-5", "a whole number", "64"], ["objects", "100001", "from 1 to 100000", "9"],
  ];
  const inEffect = (key) => page.evaluate((key) => String(key === "objects" ? supple.model.objects.length : supple.model.scene[key]), key);
  for (const [key, value, reason, stays] of refused) {
    assert.equal(await inEffect(key), stays);
    const input = page.locator(`#setting-${key}`);
    await input.fill(value);
    await input.press("Enter");
    const alert = page.locator(`.setting:has(#setting-${key})`).getByRole("alert");
    await alert.getByText(reason).waitFor();
    await alert.getByText(`The value stays ${stays}`).waitFor();
    assert.equal(await input.getAttribute("aria-invalid"), "true");
    assert.equal(await input.inputValue(), value, "the user can correct it");
    await input.press("Escape");
    assert.equal(await input.inputValue(), stays);
    assert.ok(await alert.isHidden());
    assert.equal(await inEffect(key), stays);
  }
  const seed = page.getByRole("textbox", { name: "Seed" });
  await seed.fill("-1");
  await seed.press("Enter");
  await until(page, () => document.querySelector("[aria-label=Seed]").validationMessage.includes("from 0 to 18446744073709551615"));
  await steps(page, 3);
}

/** While the page has not drawn the first frame, no time passes. */
async function waitsForTheFirstFrame(stage) {
  const program = await stage.program(join(scenes, "cloth_over_ball.toml"));
  const page = await stage.page();
  // Without frames of animation, on which `until` would wait.
  const wait = (condition) => page.waitForFunction(condition, null, { polling: 20 });
  await page.addInitScript(() => {
    const request = window.requestAnimationFrame.bind(window);
    let held = [];
    window.requestAnimationFrame = (turn) => (held ? held.push(turn) : request(turn));
    window.release = () => {
      const turns = held;
      held = null;
      for (const turn of turns) request(turn);
    };
    window.steps = [];
  });
  await page.goto(program.address);
  await wait(() => window.supple?.model.scene);  // without it, the page gives no credit
  await page.evaluate(() => {
    supple.model.on("frame", ({ text }) => steps.push(text.step));
    // What `giveCredit` of a page that draws does: so the first frame comes, but is not drawn.
    supple.client.giveCredit();
  });
  await wait(() => steps.length > 0);
  const asks = await page.evaluate(async () => {
    const before = performance.now();
    let count = 0;
    while (performance.now() < before + 300) {  // 30 steps, if time passed
      await supple.client.ask({ do: "read", object: 0 });
      count += 1;
    }
    return count;
  });
  assert.ok(asks > 0);
  assert.deepEqual(await page.evaluate(() => steps), [0]);
  await page.evaluate(() => release());
  await until(page, () => steps.length > 5);
  assert.equal(await page.evaluate(() => steps[1]), 1, "steps before the first frame was drawn");
}

async function integratorsChange(stage) {
  const { page } = await stage.view(join(scenes, "soft_block.toml"));
  await page.getByRole("tab", { name: "Settings" }).click();
  await page.locator(".setting", { has: page.getByLabel("Integrator") }).getByText("restarts").first().waitFor();
  const other = await page.evaluate(() => (supple.model.scene.integrator === "verlet" ? "symplectic_euler" : "verlet"));
  await page.getByLabel("Integrator").selectOption(other);
  await until(page, (wanted) => supple.model.scene.integrator === wanted && supple.model.frame?.text.step > 0, other);
}

async function plotsFollow(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  await until(page, () => supple.model.history.frames.length > 20);
  assert.equal(await page.locator("figure canvas").count(), 3);
  const rows = await page.evaluate(() => supple.model.history.column("contacts").at(-1));
  assert.ok(Number.isFinite(rows));
  for (const figure of await page.locator("figure:has(canvas)").all()) {
    const markers = figure.locator(".u-marker");
    const colours = await markers.evaluateAll((all) => all.map((marker) => getComputedStyle(marker).borderColor));
    assert.ok(colours.length > 0 && new Set(colours).size === colours.length, `two lines have one colour: ${colours.join("; ")}`);
  }
}

/** The total of the plots has the time of the motion, which that of the library has not. */
async function theTotalHasTheMotion(stage) {
  // One body alone: there is nothing to detect, so the motion takes most of the time.
  const { page } = await stage.view(stage.file("body.toml", `[scene]\ntime_step = 0.001\n[[object]]\nmodel = "icosphere"\nfrequency = 20\nmotion = { kind = "mass_spring", stiffness = 10 }\n`));
  await page.getByRole("tab", { name: "Plots" }).click();
  await simulateTo(page, 24);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save Time per stage, milliseconds as SVG" }).click()]);
  const path = stage.file("plot.svg");
  await download.saveAs(path);
  const { motion, total, own } = await page.evaluate((svg) => {
    const names = supple.model.history.names.filter((name) => name.endsWith("_seconds"));
    const lines = [...new DOMParser().parseFromString(svg, "image/svg+xml").querySelectorAll("path[stroke-linejoin]")].map((line) => line.getAttribute("d").split(/[ML]/).slice(1).map((point) => Number(point.split(" ")[1])));
    const place = (name) => names.indexOf(name);
    const { history } = supple.model;
    return { motion: lines[place("motion_seconds")], total: lines[place("total_seconds")], own: history.column("motion_seconds").filter((value, i) => value > history.column("total_seconds")[i]).length };
  }, readFileSync(path, "utf8"));
  assert.ok(motion.length > 20 && own > 0, "the motion never takes longer than the rest, so this test shows nothing");
  total.forEach((y, i) => assert.ok(y <= motion[i] + 0.1, `step ${i}: the total is lower in the plot than the motion`));
}

/** Also steps without a frame: the page takes none while there are steps. */
async function plotsHoldEveryStep(stage) {
  const { page } = await stage.view(nine);
  await page.getByRole("tab", { name: "Plots" }).click();
  await page.getByRole("combobox", { name: "Speed" }).selectOption("0");
  await page.getByText(/^\d+ fps · [\d.e+-]+× real time$/).waitFor();
  await simulateTo(page, 0);
  const last = 100;
  const before = await page.evaluate(async (last) => {
    const { client, model } = supple;
    const { framesSeen } = model;
    client.giveCredit = () => {};
    for (let i = 0; i < last; ++i) await client.ask({ do: "step", count: 1 });  // the answer comes after the step
    delete client.giveCredit;  // the method of the class is found again
    return framesSeen;
  }, last);
  await until(page, (last) => supple.model.frame.text.step === last, last);
  await settled(page);
  const { frames, times, seen, contacts, now } = await page.evaluate(() => ({
    frames: supple.model.history.frames, times: supple.model.history.column("time"), seen: supple.model.framesSeen,
    contacts: supple.model.history.column("contacts").at(-1), now: supple.model.frame.lists.contacts.count,
  }));
  assert.ok(seen - before < last, "each step had a frame, so this test shows nothing");
  assert.deepEqual(frames, Array.from({ length: last + 1 }, (_, i) => i));
  times.forEach((time, i) => assert.ok(Math.abs(time - 0.02 * i) < 1e-9));
  assert.equal(contacts, now);
  // The steps survive a reload.
  await page.reload();
  await until(page, () => supple.model.frame !== null);
  assert.deepEqual(await page.evaluate(() => supple.model.history.frames), frames);
}

/** A page that only watches beside the one that controls. */
async function watches(stage) {
  const { program, page } = await stage.view(nine, "--spectators");
  const address = /Watch (\S+)/.exec(program.output)[1];
  assert.notEqual(address, program.address);
  await until(page, () => supple.model.frame.text.step > 10);
  const spectator = await stage.page();
  await spectator.goto(address);
  await hasFrame(spectator);
  await spectator.getByText("watching").waitFor();
  await until(spectator, () => supple.model.frame.text.step > 15);
  assert.ok(await spectator.getByRole("button", { name: "Pause" }).isHidden());
  assert.ok(await spectator.getByRole("radio", { name: "Grab and pull" }).isHidden());
  await spectator.getByRole("img", { name: "3D view" }).focus();
  await spectator.keyboard.press("Space");
  await spectator.keyboard.press("r");
  const before = await camera(page);
  await spectator.keyboard.press("1");
  assert.deepEqual(await camera(page), before, "each page has its own camera");
  const refusal = await spectator.evaluate(() => supple.client.ask({ do: "pause" }).then(() => "", (error) => error.message));
  assert.match(refusal, /only watches/);
  await pause(page);
  const facts = (of) => of.evaluate(() => [supple.model.frame.text.step, supple.model.frame.lists.contacts.count, ...supple.model.objects.map(({ positions }) => positions.reduce((sum, x) => sum + x, 0))]);
  const wanted = await facts(page);
  assert.ok(wanted[0] > 15, "the spectator stopped nothing");
  await until(spectator, (step) => supple.model.frame.text.step === step, wanted[0]);
  assert.deepEqual(await facts(spectator), wanted);

  const late = await stage.page();
  await late.goto(address);
  await hasFrame(late);
  assert.deepEqual(await facts(late), wanted, "one that comes later gets all objects");
  await page.getByRole("button", { name: "Reset" }).click();
  await until(late, () => supple.model.scene.run === 2 && supple.model.frame);
  await page.close();
  await goesOn(late);
  assert.equal(await late.evaluate(() => supple.client.status.state), "connected");
  await program.stop();
  await until(late, () => supple.client.status.state === "ended");
}

export const tests = [
  ["moves, pauses and steps", movesPausesAndSteps],
  ["resets with a seed, at another speed", resetsWithASeedAndSpeed],
  ["events of both phases are counted", eventsAreCounted],
  ["settings keep the state, or say that they restart", settingsKeepTheStateOrSayThatTheyRestart],
  ["wrong values are refused at the field", wrongValuesAreRefused],
  ["waits until the first frame is drawn", waitsForTheFirstFrame],
  ["integrators change", integratorsChange],
  ["plots follow", plotsFollow],
  ["the total of the plots has the motion", theTotalHasTheMotion],
  ["plots hold every step", plotsHoldEveryStep],
  ["a spectator sees the same and controls nothing", watches],
];
