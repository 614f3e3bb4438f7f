/** What the palette offers besides commands: objects, tabs and settings. */
import type { App } from "../app";
import { labelOf } from "./field";
import type { Offer } from "./palette";

export function offersOfObject(app: App, index: number): Offer[] {
  const { model, view, pins } = app;
  const object = model.objects[index]!;
  const shown = () => {
    model.emit("display", null);
    if (model.layers.octree) model.emit("request", null);
  };
  const select = () => model.select({ object: index, triangle: null, vertex: null });
  const offer = (verb: string, run: () => void): Offer => ({ name: `${verb} ${object.name}`, group: "Object", subject: object.name, run });
  return [
    offer("Select", () => {
      select();
      view.frameSelection();
    }),
    offer("Show only", () => {
      for (const other of model.objects) other.visible = other === object;
      shown();
    }),
    offer(object.visible ? "Hide" : "Show", () => {
      object.visible = !object.visible;
      shown();
    }),
    offer("Pin", () => pins.add([index])),
  ];
}

/** Goes to a tab, and to the field of a setting. */
export function offersOfTabs(app: App, tabs: string[]): Offer[] {
  const settings = app.model.scene?.settings.filter(({ kind }) => kind !== "cube") ?? [];
  return [
    ...tabs.map((name) => ({ name: `Tab ${name}`, group: "Page", run: () => app.showTab(name) })),
    ...settings.map(({ key }) => ({ name: `Setting: ${labelOf(key)}`, group: "Settings", run: () => goToSetting(app, key) })),
  ];
}

function goToSetting(app: App, key: string): void {
  app.showTab("Settings");
  const field = document.getElementById(`setting-${key}`);
  const folded = field?.closest("details");
  if (folded) folded.open = true;
  field?.scrollIntoView({ block: "center" });
  field?.focus();
}
