/** The list of objects: show, hide, colour, select, and find by name. */
import type { Model, ObjectState } from "../../model";
import { h, readable } from "../dom";
import { RowWindow, type Row } from "./row_window";
import { TableControls } from "./table_controls";

/** In rem. Fingers need higher rows than a mouse. */
const ROW_HEIGHT = matchMedia("(pointer: coarse)").matches ? 2.5 : 1.6875;
/** The filter and the header appear from this many objects on. */
const FEWEST_TO_FILTER = 13;

/** A row of controls that can be reused for another object. */
class ObjectRow implements Row {
  readonly element: HTMLLIElement;
  readonly name: HTMLButtonElement;
  private object!: ObjectState;
  private readonly visible = h("input", { type: "checkbox", title: "Show or hide" });
  private readonly colour = h("input", { type: "color", title: "Colour" });
  private readonly opacity = h("input", { type: "range", min: 0, max: 1, step: 0.05, class: "opacity", title: "Opacity" });
  private readonly text = h("span", { class: "text" });
  private readonly count = h("span", { class: "count" });

  constructor(private readonly model: Model, private readonly listed: () => ObjectState[], shown: () => void, frame: () => void) {
    this.name = h("button", { type: "button", class: "name", ondblclick: frame }, this.text, this.count);
    this.element = h("li", {}, this.visible, this.colour, this.name, this.opacity);
    this.name.addEventListener("click", () => model.select({ object: this.object.index, triangle: null, vertex: null }));
    this.visible.addEventListener("change", () => {
      this.object.visible = this.visible.checked;
      shown();
    });
    this.colour.addEventListener("input", () => {
      this.object.colour = this.colour.value;
      model.emit("display", null);
    });
    this.opacity.addEventListener("input", () => {
      this.object.opacity = this.opacity.valueAsNumber;
      model.emit("display", null);
    });
  }

  show(index: number): void {
    const listed = this.listed();
    const object = listed[index]!;
    if (this.object !== object) this.take(object);
    const selected = this.model.selection?.object === object.index;
    this.element.setAttribute("aria-posinset", String(index + 1));
    this.element.setAttribute("aria-setsize", String(listed.length));
    this.element.classList.toggle("selected", selected);
    this.name.setAttribute("aria-pressed", String(selected));
    this.visible.checked = object.visible;
    if (this.colour.value !== object.colour) this.colour.value = object.colour;
    if (this.opacity.valueAsNumber !== object.opacity) this.opacity.valueAsNumber = object.opacity;
  }

  private take(object: ObjectState): void {
    this.object = object;
    const { index, name, kind, vertices, triangles } = object;
    this.visible.setAttribute("aria-label", `Show ${name}`);
    this.colour.setAttribute("aria-label", `Colour of ${name}`);
    this.opacity.setAttribute("aria-label", `Opacity of ${name}`);
    this.name.title = `${name}: object ${index}, ${kind}, ${readable(vertices)} vertices, ${readable(triangles)} triangles. Double-click to frame it.`;
    this.text.textContent = name;
    this.count.textContent = readable(triangles);
  }
}

export class ObjectList {
  readonly element: HTMLElement;
  private readonly list = h("ul", { "aria-label": "Objects" });
  private readonly window: RowWindow<ObjectRow>;
  private readonly controls = new TableControls<ObjectState>(
    [
      { key: "name", label: "name", value: ({ name }) => name }, { key: "kind", label: "kind", title: "How the object moves", value: ({ kind }) => kind },
      { key: "triangles", label: "triangles", value: ({ triangles }) => triangles }, { key: "vertices", value: ({ vertices }) => vertices },
      { key: "shown", value: ({ visible }) => (visible ? "yes" : "no") },
    ],
    ["triangles", "vertices"], "objects", null, () => this.update(),
  );
  private readonly nothing = h("p", { class: "hint", role: "status", hidden: true });
  private listed: ObjectState[] = [];

  constructor(private readonly model: Model, frameObject: () => void) {
    this.window = new RowWindow(
      { class: "objects", tabindex: -1, onkeydown: (event: KeyboardEvent) => this.key(event) }, this.list, ROW_HEIGHT,
      () => new ObjectRow(model, () => this.listed, () => this.shown(), frameObject),
    );
    const all = h("button", { type: "button", class: "link", title: "Show or hide all listed objects", onclick: () => this.toggleAll() }, "all");
    const only = h("button", { type: "button", class: "link", title: "Show only the selected object, or all again", onclick: () => this.isolate() }, "only selected");
    this.element = h("section", { class: "grow" }, h("h2", {}, "Objects", h("span", { class: "links" }, only, all)), this.controls.field, this.controls.refusal, this.nothing, this.controls.head, this.window.element);
    model.on("scene", () => this.build());
    only.disabled = true;
    model.on("selection", () => {
      only.disabled = model.selection === null;
      this.showSelected();
    });
    model.on("display", () => this.window.draw());
  }

  private build(): void {
    const { field, head } = this.controls;
    field.hidden = head.hidden = this.model.objects.length < FEWEST_TO_FILTER;
    if (field.hidden) field.value = "";
    this.update();
  }

  /** Lists the objects whose names match the filter. */
  private update(): void {
    this.listed = this.controls.apply(this.model.objects);
    this.nothing.hidden = this.listed.length > 0 || !this.controls.isFiltered;
    this.nothing.textContent = this.nothing.hidden ? "" : `No object is like “${this.controls.field.value.trim()}”.`;
    this.window.setCount(this.listed.length);
    this.showSelected();
  }

  private shown(): void {
    this.model.emit("display", null);
    if (this.model.layers.octree) this.model.emit("request", null);
  }

  private toggleAll(): void {
    const show = this.listed.some((object) => !object.visible);
    for (const object of this.listed) object.visible = show;
    this.shown();
  }

  /** Hides all other objects; shows all when they are hidden already. */
  private isolate(): void {
    const selected = this.model.selection?.object;
    if (selected === undefined) return;
    const isAlone = this.model.objects.every(({ index, visible }) => visible === (index === selected));
    for (const object of this.model.objects) object.visible = isAlone || object.index === selected;
    this.shown();
  }

  private get selectedRow(): number {
    const selected = this.model.selection?.object;
    return selected === undefined ? -1 : this.listed.findIndex(({ index }) => index === selected);
  }

  private showSelected(): void {
    const row = this.selectedRow;
    if (row >= 0) this.window.reveal(row);
    this.window.draw();
  }

  /** Arrow keys move between objects. */
  private key(event: KeyboardEvent): void {
    const isPlain = !event.shiftKey && !event.altKey && !event.ctrlKey && !event.metaKey;
    if (!isPlain || event.target instanceof HTMLInputElement || event.key === "Home" || event.key === "End") return;
    const next = this.window.rowAfter(event.key, this.selectedRow);
    if (next === null) return;
    event.preventDefault();
    event.stopPropagation();
    this.model.select({ object: this.listed[next]!.index, triangle: null, vertex: null });
    this.window.rowOf(next)?.name.focus();
  }
}
