/** Keyboard shortcuts; `panels/help.ts` lists them. */
import { LAYER_ROWS } from "./panels/scene_panel";
import type { App } from "./app";
import type { AxisView } from "./view/camera";

const VIEWS: AxisView[] = ["front", "back", "right", "left", "top", "bottom"];
const ARROWS: Record<string, [number, number]> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function isTextField(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return !["checkbox", "radio", "range", "color", "button"].includes(target.type);
  return target instanceof HTMLTextAreaElement;
}

/** Whether Space plays or pauses: everywhere except in fields for text and in dialogs. Enter presses buttons. */
const takesSpace = (event: KeyboardEvent): boolean =>
  event.key === " " && !event.ctrlKey && !event.metaKey && !event.altKey && !isTextField(event.target) && !(event.target as Element).closest?.("dialog");

/** Elements that handle these keys themselves. */
function takesKeys(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog") || isTextField(target)) return true;
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement) {
    if (target.type === "checkbox" || target.type === "radio") return key.startsWith("Arrow");
    return target.type !== "range" || key.startsWith("Arrow") || ["Home", "End", "PageUp", "PageDown"].includes(key);
  }
  if (target instanceof HTMLButtonElement || target.tagName === "SUMMARY") return key === "Enter";
  return (target.getAttribute("role") ?? "").endsWith("grid") && (key.startsWith("Arrow") || key === "Home" || key === "End");
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
    l: () => app.player.markSection(),
  };
  actions[key]?.();
  return key in actions;
}

function onPlain(app: App, key: string): boolean {
  const { player, view, model } = app;
  const actions: Record<string, () => void> = {
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
    if (takesSpace(event)) {
      event.preventDefault();
      if (!event.repeat) app.player.togglePlay();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.defaultPrevented || takesKeys(event.target, event.key)) return;
    const key = event.key.toLowerCase();
    let done = false;
    if (event.key === "Enter" && event.target instanceof HTMLInputElement && event.target.type === "checkbox") {
      event.target.click();  // as Space does elsewhere
      done = true;
    } else if (event.key in ARROWS) done = onArrow(app, event);
    else if (event.altKey) return;
    else if (event.shiftKey && /^[a-z]$/.test(key)) done = onShifted(app, key);
    else done = onPlain(app, key);
    if (done) event.preventDefault();
  });
  // Firefox presses a button when the key goes up.
  document.addEventListener("keyup", (event) => {
    if (takesSpace(event)) event.preventDefault();
  });
}
