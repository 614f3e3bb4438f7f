/** Keyboard shortcuts; `panels/help.ts` lists them. */
import { LAYER_ROWS } from "./panels/scene_panel";
import type { App } from "./app";
import type { AxisView } from "./view/camera";

const VIEWS: AxisView[] = ["front", "back", "right", "left", "top", "bottom"];
const ARROWS: Record<string, [number, number]> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Elements that handle these keys themselves. */
function takesKeys(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog")) return true;
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement) {
    if (target.type === "checkbox" || target.type === "radio") return key === " " || key.startsWith("Arrow");
    if (target.type === "range") return key.startsWith("Arrow") || ["Home", "End", "PageUp", "PageDown"].includes(key);
    return true;
  }
  if (target instanceof HTMLButtonElement) return key === " " || key === "Enter";
  return target.getAttribute("role") === "grid" && (key.startsWith("Arrow") || key === "Home" || key === "End");
}

function onArrow(app: App, event: KeyboardEvent): boolean {
  const [right, up] = ARROWS[event.key]!;
  if (event.shiftKey) app.view.rig.orbit(right * 0.12, up * 0.12);
  else if (event.altKey) app.view.rig.pan(right * 0.05, up * 0.05);
  else if (app.tools.isPulling) app.tools.nudge(right, up);
  else if (right !== 0) app.player.step(right);
  else return false;
  return true;
}

function onShifted(app: App, key: string): boolean {
  const actions: Record<string, () => void> = {
    f: () => app.view.frameSelection(),
    s: () => app.picture(),
    v: () => app.film(),
    p: () => app.frames(),
  };
  actions[key]?.();
  return key in actions;
}

function onPlain(app: App, key: string): boolean {
  const { player, view, model } = app;
  const actions: Record<string, () => void> = {
    " ": () => player.togglePlay(),
    home: () => player.seek(0),
    end: () => player.seek(Infinity),
    ".": () => player.jump(1),
    ",": () => player.jump(-1),
    "[": () => player.faster(-1),
    "]": () => player.faster(1),
    l: () => player.toggleLoop(),
    r: () => player.reset(),
    f: () => view.frameAll(),
    o: () => app.toggleOrthographic(),
    "+": () => view.rig.zoom(1.15),
    "=": () => view.rig.zoom(1.15),
    "-": () => view.rig.zoom(1 / 1.15),
    v: () => model.setTool("select"),
    g: () => model.setTool("grab"),
    w: () => model.setTool("explain"),
    enter: () => app.tools.toggleGrip(),
    escape: () => app.escape(),
    t: () => app.toggleTheme(),
    h: () => app.togglePanels(),
    "?": () => app.help.showModal(),
  };
  for (const [i, name] of VIEWS.entries()) actions[String(i + 1)] = () => view.rig.lookAlong(name);
  for (const { layer, key: layerKey } of LAYER_ROWS) actions[layerKey.toLowerCase()] = () => model.setLayer(layer, !model.layers[layer]);
  actions[key]?.();
  return key in actions;
}

export function listenToKeys(app: App): void {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.defaultPrevented || takesKeys(event.target, event.key)) return;
    const key = event.key.toLowerCase();
    let done = false;
    if (event.key in ARROWS) done = onArrow(app, event);
    else if (event.altKey) return;
    else if (event.shiftKey && /^[a-z]$/.test(key)) done = onShifted(app, key);
    else done = onPlain(app, key);
    if (done) event.preventDefault();
  });
}
