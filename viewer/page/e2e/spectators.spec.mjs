// Pages that only watch beside the one that controls.
import assert from "node:assert/strict";
import { join } from "node:path";
import { camera, hasFrame, pause, scenes, until } from "./harness.mjs";

async function watches(stage) {
  const { program, page } = await stage.view(join(scenes, "nine.toml"), "--spectators");
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
  const facts = (of) => of.evaluate(() => [supple.model.frame.text.step, supple.model.frame.contacts.length, ...supple.model.objects.map(({ positions }) => positions.reduce((sum, x) => sum + x, 0))]);
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
  await late.waitForTimeout(300);
  assert.equal(await late.evaluate(() => supple.client.status.state), "connected");
  await program.stop();
  await until(late, () => supple.client.status.state === "ended");
}

export const tests = [["a spectator sees the same and controls nothing", watches]];
