/** Settings that restart the session when they change. */
import GUI, { type Controller } from "lil-gui";
import type { Client } from "../client";
import type { Model } from "../model";
import { h } from "./dom";

export class Settings {
  readonly element = h("div", { class: "settings" });
  private gui: GUI | null = null;
  private values: Record<string, string | number> = {};

  constructor(private readonly model: Model, private readonly client: Client) {
    model.on("scene", () => this.build());
  }

  private build(): void {
    const focused = (document.activeElement as HTMLElement | null)?.closest("[data-setting]")?.getAttribute("data-setting");
    this.gui?.destroy();
    const gui = new GUI({ container: this.element, title: "Collision detection", width: 1 });
    this.gui = gui;
    const { scene } = this.model;
    if (!scene) return;
    const { bounding_volume, broad_phase, contacts, max_level, leaf_size, time_step } = scene;
    this.values = { bounding_volume, broad_phase, contacts, max_level, leaf_size, time_step, objects: scene.objects.length };
    if (scene.integrator !== null) this.values["integrator"] = scene.integrator;
    if (this.model.can("set")) {
      this.choice("bounding_volume", "Bounding volume");
      this.number("max_level", "Octree levels", 0, 32, 1);
      this.number("leaf_size", "Triangles per leaf", 1, null, 1);
      this.choice("broad_phase", "Broad phase");
      this.choice("contacts", "Contacts");
      if (scene.source === "simulation") this.ofSimulation();
    }
    this.drawing(gui.addFolder("Drawing"));
    if (focused) this.element.querySelector<HTMLElement>(`[data-setting="${focused}"] :is(input, select)`)?.focus();
  }

  private ofSimulation(): void {
    this.number("objects", "Objects", 1, null, 1);
    if ("integrator" in this.values) this.choice("integrator", "Integrator");
    this.number("time_step", "Time step", 1e-6, null, null);
  }

  private choice(name: string, label: string): void {
    const choices: string[] = [...(this.model.scene?.choices[name] ?? [])];
    const now = String(this.values[name]);
    if (!choices.includes(now)) choices.push(now);  // a value of a later version
    this.tie(this.gui!.add(this.values, name, choices), name, label);
  }

  /** A slider when both limits are given, else a field. */
  private number(name: string, label: string, least: number, most: number | null, step: number | null): void {
    const controller = this.gui!.add(this.values, name).min(least);
    if (most !== null) controller.max(most);
    if (step !== null) controller.step(step);
    this.tie(controller, name, label);
  }

  private tie(controller: Controller, name: string, label: string): void {
    controller.name(label);
    controller.domElement.dataset["setting"] = name;
    for (const input of controller.domElement.querySelectorAll("input, select")) input.setAttribute("aria-label", label);
    controller.onFinishChange((value: string | number) => {
      this.client
        .ask({ do: "set", [name]: value })
        .then(() => undefined)
        .catch((error: Error) => {
          this.client.emit("notice", error.message);
          this.build();  // shows the values that still apply
        });
    });
  }

  private drawing(folder: GUI): void {
    const changed = () => this.model.emit("display", null);
    folder.add(this.model, "throughSurfaces").name("Marks through surfaces").onChange(changed);
    folder.add(this.model, "pointSize", 2, 20, 1).name("Point size").onChange(changed);
    folder.add(this.model, "normalLength", 0.002, 0.1).name("Normal length").onChange(changed);
    for (const controller of folder.controllers)
      for (const input of controller.domElement.querySelectorAll("input")) input.setAttribute("aria-label", controller._name);
  }
}
