// Sizes of windows and themes, and pages in which tests act as in a wide window: where the panels are drawers,
// this opens the drawer of an element before a test uses it, and closes it before a test uses the view. In a
// window for fingers it taps and drags with a finger.

/** A phone has a screen for fingers. `deviceScaleFactor` keeps the number of pixels small. */
export const SIZES = {
  1440: { viewport: { width: 1440, height: 900 }, deviceScaleFactor: 0.5 },
  800: { viewport: { width: 800, height: 900 }, deviceScaleFactor: 0.5 },
  390: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 1, hasTouch: true },
};
export const THEMES = ["dark", "light"];
const WAIT_MILLISECONDS = 60_000;

/** One size and theme for each test, the same in every run: they follow from its name. */
export function windowOf(name) {
  let hash = 0x811c9dc5;  // FNV-1a
  for (const letter of name) hash = Math.imul(hash ^ letter.codePointAt(0), 0x01000193) >>> 0;
  const sizes = Object.keys(SIZES);
  return { size: sizes[hash % sizes.length], theme: THEMES[Math.floor(hash / sizes.length) % THEMES.length] };
}

/** What these pages need: whether fingers act, and the box of the last element in a drawer that was measured. */
const pages = new WeakMap();
const original = {};

/** Makes the tests' actions reach what a drawer hides. Pages of tests with a size of their own stay as they are. */
export function reachDrawers(page, hasTouch) {
  if (!original.click) wrap(page);
  pages.set(page, { hasTouch, box: null, finger: null, at: [0, 0] });
}

/** The open drawer, "" when none is; null where there are none, and while a dialog covers the page. */
const openDrawer = (page) =>
  page.evaluate(() => {
    const button = document.querySelector("header button.drawer");
    return button?.checkVisibility() && !document.querySelector("dialog[open]") ? (document.body.dataset.drawer ?? "") : null;
  });

const press = (page, selector) => original[pages.get(page).hasTouch ? "tap" : "click"].call(page.locator(selector));

/** Opens a drawer, or closes the open one, and waits until the page has laid it out. */
async function turnTo(page, name) {
  const open = await openDrawer(page);
  if (open === null || open === name) return;
  if (open) await press(page, `#panel-${open} > .drawer.close`);
  if (name) await press(page, `header [aria-controls="panel-${name}"]`);
  await frames(page, 3);
}

const frames = (page, count) =>
  page.evaluate(async (count) => {
    for (let i = 0; i < count; ++i) await new Promise((done) => requestAnimationFrame(done));
  }, count);

const isSeen = (locator) => original.isVisible.call(locator.first());

/** The closed drawer that has the element. Both are laid out for that, unseen, so that nothing changes for the page. */
async function drawerOf(locator) {
  const page = locator.page();
  const find = () => original.evaluateAll.call(locator, (found) => found.find((element) => element.checkVisibility())?.closest(".panel")?.id.replace("panel-", ""));
  await page.evaluate(() => {
    for (const { style } of document.querySelectorAll(".panel")) for (const [name, value] of [["display", "flex"], ["opacity", "0"], ["pointer-events", "none"]]) style.setProperty(name, value, "important");
  });
  let name = await find();
  if (!name) {
    await frames(page, 2);  // long lists fill their rows
    name = await find();
  }
  await page.evaluate(() => {
    for (const panel of document.querySelectorAll(".panel")) panel.removeAttribute("style");
  });
  return name;
}

/** Looks for an element in the page and in its drawers. Returns whether it is visible now. */
async function lookFor(locator) {
  if (await isSeen(locator)) return true;
  if ((await openDrawer(locator.page())) === null) return false;
  const name = await drawerOf(locator);
  if (name) await turnTo(locator.page(), name);
  return isSeen(locator);
}

/** Looks until the element is visible, or at least exists when `isRead`. */
async function reveal(locator, isRead) {
  const page = locator.page();
  for (const end = Date.now() + WAIT_MILLISECONDS; Date.now() < end; ) {
    if (await lookFor(locator)) return;
    if ((isRead && (await original.count.call(locator))) || page.isClosed()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
}

/** In the page, not in a drawer: a drawer may cover it. */
async function uncover(locator) {
  const isInDrawer = await original.evaluate.call(locator.first(), (element) => element.closest(".panel") !== null);
  if (!isInDrawer) await turnTo(locator.page(), "");
}

function wrap(page) {
  const of = (object) => Object.getPrototypeOf(object);
  const replace = (prototype, name, make) => {
    const before = prototype[name];
    if (prototype === locators) original[name] = before;
    prototype[name] = async function (...args) {
      const page = this._page ?? this.page();
      return pages.has(page) ? make.call(this, before.bind(this), pages.get(page), page, ...args) : before.apply(this, args);
    };
  };
  const locators = of(page.locator("body"));
  for (const name of ["click", "tap", "dblclick", "check", "uncheck", "fill", "selectOption", "hover", "press", "focus"])
    replace(locators, name, async function (act, { hasTouch }, page, ...args) {
      await reveal(this, false);
      await uncover(this);
      return name === "click" && hasTouch && args.length === 0 ? original.tap.call(this) : act(...args);
    });
  for (const name of ["innerText", "textContent", "getAttribute", "inputValue", "isChecked", "isDisabled", "evaluate", "scrollIntoViewIfNeeded"])
    replace(locators, name, async function (read, state, page, ...args) {
      await reveal(this, true);
      return read(...args);
    });
  for (const name of ["count", "all", "allTextContents", "allInnerTexts", "evaluateAll", "isVisible"])
    replace(locators, name, async function (read, state, page, ...args) {
      await lookFor(this);
      return read(...args);
    });
  replace(locators, "isHidden", async function () {
    return !(await lookFor(this));
  });
  replace(locators, "waitFor", async function (wait, state, page, options) {
    if (!options?.state || options.state === "visible") await reveal(this, false);
    return wait(options);
  });
  replace(locators, "boundingBox", async function (measure, state) {
    await reveal(this, true);
    const isInDrawer = await original.evaluate.call(this, (element) => element.closest(".panel") !== null);
    if (isInDrawer) await original.scrollIntoViewIfNeeded.call(this);
    const box = await measure();
    state.box = isInDrawer ? box : null;
    return box;
  });
  wrapPointer(replace, of(page.mouse), of(page.keyboard));
}

/** Actions at a point of the window: in a drawer if the test has measured an element there, else in the view. */
function wrapPointer(replace, mice, keyboards) {
  const reach = async (page, { box }, x, y) => {
    const isInBox = box && x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + box.height;
    if (!isInBox) await turnTo(page, "");
  };
  const touch = async ({ finger, at: [x, y] }, type) => finger.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x, y }] });
  replace(mice, "move", async function (move, state, page, x, y, options) {
    const from = state.at;
    if (!state.finger) await reach(page, state, x, y);
    state.at = [x, y];
    if (!state.finger) return move(x, y, options);
    const steps = options?.steps ?? 1;
    for (let i = 1; i <= steps; ++i) {
      state.at = [x, y].map((to, axis) => from[axis] + ((to - from[axis]) * i) / steps);
      await touch(state, "touchMove");
    }
  });
  replace(mice, "down", async function (down, state, page, options) {
    if (!state.hasTouch) return down(options);
    if (options?.button) {
      await this.move(...state.at);  // the pointer stayed where the finger began
      return down(options);
    }
    state.finger = await page.context().newCDPSession(page);
    return touch(state, "touchStart");
  });
  replace(mice, "up", async function (up, state, page, options) {
    if (!state.finger) return up(options);
    await touch(state, "touchEnd");
    await state.finger.detach();
    state.finger = null;
  });
  for (const name of ["click", "dblclick"])
    replace(mice, name, async function (click, state, page, x, y, options) {
      await reach(page, state, x, y);
      return name === "click" && state.hasTouch && !options ? page.touchscreen.tap(x, y) : click(x, y, options);
    });
  replace(keyboards, "press", async function (press, state, page, key) {
    if (key === "Escape") await turnTo(page, "");
    return press(key);
  });
}
