// What touches what, at a glance: marks with a size in pixels, and the first line of the side bar.
import assert from "node:assert/strict";
import { join } from "node:path";
import { picture, scenes, settled, simulateTo, until } from "./tools/harness.mjs";

const ball = (name, x, more = "") => `[[object]]\nname = "${name}"\nmodel = "icosphere"\nfrequency = 6\ntranslate = [${x}, 0, 0]\n${more}\n`;
const touchLine = (page) => page.getByRole("status", { name: "What touches" });

/** The number of pixels in which two pictures differ. */
const difference = (page, one, other) =>
  page.evaluate(async (urls) => {
    const [a, b] = await Promise.all(urls.map(async (url) => {
      const bytes = Uint8Array.from(atob(url.split(",")[1]), (letter) => letter.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      return new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    }));
    return a.reduce((count, pixel, i) => count + (pixel === b[i] ? 0 : 1), 0);
  }, [one, other]);

/** A gap of a millionth of the scene is as easy to see as a large one. */
async function smallGapsAreSeen(stage) {
  const scene = `[scene]\ncontacts = "proximity"\n${ball("left", -1, "margin = 0.001")}${ball("right", 1.000001, "margin = 0.001")}`;
  const { page } = await stage.view(stage.file("gap.toml", scene));
  await until(page, () => supple.counts().proximity > 0);
  await settled(page);
  const shown = await picture(page);
  await page.getByRole("checkbox", { name: "Proximity pairs" }).uncheck();
  await until(page, () => supple.counts().proximity === 0);
  await settled(page);
  const pixels = await difference(page, shown, await picture(page));
  assert.ok(pixels >= 8, `the mark has ${pixels} pixels, at half the resolution`);
}

/** Thousands of gaps are counted in words, but not all are drawn; more of them from nearby. */
async function denseMarksThinOut(stage) {
  const { page } = await stage.view(join(scenes, "cloth_over_ball.toml"));
  await simulateTo(page, 40);
  const drawn = () => page.evaluate(() => {
    supple.draw();
    return supple.drawn().points / 3;  // marks behind surfaces, halos and colours
  });
  const gaps = await page.evaluate(() => supple.model.frame.lists.proximity_pairs.count);
  assert.ok(gaps > 1500, `${gaps} gaps`);
  assert.equal(await page.evaluate(() => supple.counts().proximity), gaps);
  await page.getByRole("list", { name: "Layers" }).getByText(gaps.toLocaleString("en")).waitFor();
  const far = await drawn();
  assert.ok(far > 10 && far < gaps / 4, `${far} of ${gaps} marks are drawn`);
  await page.getByRole("treegrid", { name: "Contacts" }).getByText("ball").click();
  for (let i = 0; i < 5; ++i) await page.keyboard.press("+");
  await settled(page);
  const near = await drawn();
  assert.ok(near > 0 && near !== far, `${near} marks are drawn from nearby, ${far} from far away`);
}

async function theFirstLineSaysWhatTouches(stage) {
  const touching = await stage.view(stage.file("touch.toml", `${ball("a", 0)}${ball("b", 1.9)}${ball("c", 3.8)}${ball("d", 9)}`));
  await touchLine(touching.page).getByText("touching: 2 pairs (2 began)", { exact: true }).waitFor();

  const near = await stage.view(stage.file("near.toml", `[scene]\ncontacts = "proximity"\n${ball("a", 0, "margin = 0.1")}${ball("b", 2.1, "margin = 0.1")}`));
  await touchLine(near.page).getByText("near: 1 pair (1 began)", { exact: true }).waitFor();

  const apart = await stage.view(stage.file("apart.toml", `${ball("a", 0)}${ball("b", 5)}`));
  await touchLine(apart.page).getByText("nothing touches: all are apart", { exact: true }).waitFor();

  // The boxes of the balls overlap, the balls do not.
  const diagonal = `[[object]]\nmodel = "icosphere"\nfrequency = 6\n[[object]]\nmodel = "icosphere"\nfrequency = 6\ntranslate = [1.3, 1.3, 1.3]\n`;
  const tested = await stage.view(stage.file("tested.toml", diagonal));
  await touchLine(tested.page).getByText("nothing touches: 1 pair tested", { exact: true }).waitFor();

  const alone = await stage.view(stage.file("alone.toml", ball("a", 0)));
  await touchLine(alone.page).getByText("nothing was tested: one object", { exact: true }).waitFor();
}

/** Layers that a scene has not produced wait under “More layers”. */
async function emptyLayersAreFolded(stage) {
  const scene = `[scene]\ncontacts = "intersection,proximity"\n${ball("a", 0, "margin = 0.1")}${ball("b", 2.1, "margin = 0.1")}`;
  const { page } = await stage.view(stage.file("near.toml", scene));
  const layers = page.getByRole("list", { name: "Layers", exact: true });
  await layers.getByRole("checkbox", { name: "Proximity pairs" }).waitFor();
  assert.equal(await page.getByRole("checkbox", { name: "Intersecting triangles" }).isVisible(), false);
  await page.getByText("More layers").click();
  await page.getByRole("list", { name: "More layers" }).getByRole("checkbox", { name: "Intersecting triangles" }).waitFor();
  // Pulled together, the balls intersect, and the row moves up.
  await page.evaluate(() => {
    supple.client.send({ do: "grab", object: 0, vertex: 0 });
    supple.client.send({ do: "drag", to: [1.2, 0, 0] });
  });
  await until(page, () => supple.model.frame.lists.contacts.count > 0);
  await layers.getByRole("checkbox", { name: "Intersecting triangles" }).waitFor();
}

/** A click on a column sorts by it, the next one reverses, the third restores the order of objects. */
async function pairsAreSorted(stage) {
  const balls = ball("ball 10", 0) + ball("ball 9", 1.2) + ball("ball 2", 3) + ball("ball 1", 4.9);
  const { page } = await stage.view(stage.file("sorted.toml", balls));
  const table = page.getByRole("treegrid", { name: "Contacts" });
  await table.getByText("ball 1", { exact: true }).waitFor();
  const column = (number) => table.locator(`.row:visible > :nth-child(${number})`).allTextContents();
  const names = async () => (await column(1)).map((text) => text.replace("▸ ", ""));
  const first = ["ball 10", "ball 9", "ball 2"];
  assert.deepEqual(await names(), first);
  const byName = page.getByRole("button", { name: "Sort by object a" });
  await byName.click();
  assert.deepEqual(await names(), ["ball 2", "ball 9", "ball 10"]);
  const order = () => page.getByRole("columnheader", { name: "object a" }).getAttribute("aria-sort");
  assert.equal(await order(), "ascending");
  await byName.click();
  assert.deepEqual(await names(), ["ball 10", "ball 9", "ball 2"]);
  await byName.click();
  assert.deepEqual(await names(), first);
  assert.equal(await order(), "none");
  await page.getByRole("button", { name: "Sort by contacts" }).press("Enter");
  const counts = (await column(3)).map(Number);
  assert.ok(counts[0] >= counts[1] && counts[1] >= counts[2] && counts[0] > counts[2], counts.join());
  await page.getByRole("button", { name: "Sort by object b" }).click();
  assert.deepEqual(await column(2), ["ball 1", "ball 2", "ball 9"]);
}

/** Names of usual length are not cut, because numbers at their end tell them apart. */
async function namesAreWhole(stage) {
  const { page } = await stage.view(stage.file("names.toml", ball("end wall 1", 0) + ball("rabbit 16", 1.9)));
  const table = page.getByRole("treegrid", { name: "Contacts" });
  await table.getByText("rabbit 16").click();  // lists its contacts
  await table.getByText(/^face \d{3}$/).first().waitFor();
  const cut = await table.locator(".row:visible > *").evaluateAll((cells) => cells.filter((cell) => cell.scrollWidth > cell.clientWidth).map((cell) => cell.textContent));
  assert.deepEqual(cut, []);
}

export const tests = [
  ["pairs are sorted by each column", pairsAreSorted],
  ["names are whole", namesAreWhole],
  ["a small gap is seen", smallGapsAreSeen],
  ["dense marks thin out", denseMarksThinOut],
  ["the first line says what touches", theFirstLineSaysWhatTouches],
  ["layers without content are folded away", emptyLayersAreFolded],
];
