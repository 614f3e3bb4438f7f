/** Ids and values of the picked elements, and the explanation why two triangles are or are not a contact. */
import type { Client } from "../client";
import { OKABE_ITO } from "../colours";
import { findContact, pointsOf, selectableIn, sidesOf } from "../contacts";
import type { Explanation, Measurement, Model } from "../model";
import type { Pins } from "../pins";
import { hasColumn, kindAt, numberAt, vectorAt } from "../records";
import { STAGES } from "../stages";
import { h, readable, refill } from "./dom";

/** Interval between updates of the values while things move. */
const REFRESH_MILLISECONDS = 250;

function show(value: unknown): string {
  if (typeof value === "number") return readable(value);
  if (Array.isArray(value)) return value.map(show).join(", ");
  return value === null ? "none" : String(value);
}

/** Formats numbers in full, for copying. */
function showExactly(value: unknown): string {
  return Array.isArray(value) ? value.map(showExactly).join("\n") : String(value);
}

/** Flattens nested objects into rows. */
function rowsOf(value: Record<string, unknown>): [string, unknown][] {
  return Object.entries(value).flatMap(([name, inner]) =>
    inner !== null && typeof inner === "object" && !Array.isArray(inner) ? rowsOf(inner as Record<string, unknown>) : [[name, inner] as [string, unknown]],
  );
}

type Row = [name: string, value: string | Node];

function table(rows: Row[]): HTMLElement {
  return h("dl", {}, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
}

export class Inspector {
  readonly element = h("div", { class: "inspector" });
  private readonly details = h("div", { class: "details", "aria-label": "Selection", role: "region" });
  private readonly verdict = h("div", { class: "verdict", role: "status", "aria-label": "Explanation" });
  private readonly fields: { object: HTMLInputElement; name: HTMLElement; triangle: HTMLInputElement }[];
  private answers = new Map<string, Record<string, unknown> | string>();
  private due: ReturnType<typeof setTimeout> | undefined;
  private round = 0;

  constructor(private readonly model: Model, private readonly client: Client, private readonly pins: Pins, private readonly fly: () => void) {
    const field = (label: string, title: string) =>
      h("input", { type: "number", min: 0, step: 1, value: 0, "aria-label": label, title, oninput: () => this.showNames() });
    this.fields = ["A", "B"].map((side) => ({
      object: field(`Object ${side}`, "Number of the object"),
      name: h("output", { class: "text", "aria-label": `Name of object ${side}` }),
      triangle: field(`Triangle ${side}`, "Number of the triangle"),
    }));
    this.element.append(this.details, this.explainForm());
    model.on("scene", () => this.reset());
    model.on("selection", () => this.changed());
    model.on("explanation", () => this.showVerdict());
    model.on("frame", () => this.later());
    pins.on("list", () => this.draw());
    this.draw();
  }

  private showNames(): void {
    for (const { object, name } of this.fields) name.textContent = this.model.objects[object.valueAsNumber]?.name ?? "none";
  }

  private explainForm(): HTMLElement {
    const rows = this.fields.map(({ object, name, triangle }, i) =>
      h("div", { class: "field" }, h("span", { class: "side", style: `background:${i === 0 ? OKABE_ITO.orange : OKABE_ITO.sky}` }, "AB"[i]!), object, name, triangle),
    );
    const submit = (event: Event) => {
      event.preventDefault();
      void this.explain(this.fields.map((field) => ({ object: field.object.valueAsNumber || 0, triangle: field.triangle.valueAsNumber || 0 })));
    };
    return h(
      "form", { class: "explain", onsubmit: submit },
      h("h3", {}, "Why no contact?"),
      h("p", { class: "hint" }, "Pick two triangles with the tool ", h("kbd", {}, "W"), ", or enter the numbers of objects and triangles."),
      ...rows,
      h("button", { type: "submit" }, "Explain"),
      this.verdict,
    );
  }

  /** Asks which stage separated two triangles. */
  async explain(pair: { object: number; triangle: number }[]): Promise<void> {
    pair.forEach(({ object, triangle }, i) => {
      this.fields[i]!.object.value = String(object);
      this.fields[i]!.triangle.value = String(triangle);
    });
    this.showNames();
    const [a, b] = pair;
    const missing = pair.find(({ object, triangle }) => !(triangle < (this.model.objects[object]?.triangles ?? 0)));
    if (missing) return this.complain(`There is no triangle ${missing.triangle} in ${this.model.objects[missing.object]?.name ?? "that object"}.`);
    if (!a || !b) {
      this.model.setExplained(pair, null);
      return;
    }
    try {
      const [why, nearest] = await Promise.all([
        this.client.ask({ do: "explain", a: [a.object, a.triangle], b: [b.object, b.triangle] }),
        this.client.ask({ do: "measure", a: a.object, b: b.object }),
      ]) as unknown as [Omit<Explanation, "nearest">, Measurement | { distance: null }];
      this.model.setExplained(pair, { ...why, nearest: nearest.distance === null ? null : nearest });
    } catch (error) {
      this.complain((error as Error).message);
    }
  }

  private complain(text: string): void {
    this.model.setExplained([], null);
    this.verdict.replaceChildren(h("p", {}, text));
  }

  private showVerdict(): void {
    const { explained, explanation } = this.model;
    if (!explanation) {
      const text = explained.length === 1 ? "Now pick the second triangle." : "";
      this.verdict.replaceChildren(...(text ? [h("p", {}, text)] : []));
      return;
    }
    const rows: Row[] = [];
    if (explanation.distance) rows.push(["Apart by", readable(explanation.distance)]);
    if (explanation.axis && explanation.distance) rows.push(["Along", show(explanation.axis)]);
    if (explanation.nearest) rows.push(["Distance of the objects", readable(explanation.nearest.distance)]);
    this.verdict.replaceChildren(
      h("h4", {}, STAGES[explanation.stage] ?? explanation.stage), h("p", {}, explanation.text), table(rows),
    );
  }

  private reset(): void {
    const last = Math.max(0, this.model.objects.length - 1);
    this.fields.forEach(({ object }, side) => {
      object.max = String(last);
      object.value = String(Math.min(side, last));
    });
    this.showNames();
    this.changed();
  }

  private changed(): void {
    this.answers.clear();
    clearTimeout(this.due);
    this.due = undefined;
    void this.read();
  }

  private later(): void {
    this.due ??= setTimeout(() => {
      this.due = undefined;
      void this.read();
    }, REFRESH_MILLISECONDS);
  }

  /** Requests exact values of the selection. */
  private async read(): Promise<void> {
    const { selection } = this.model;
    const round = ++this.round;
    if (!selection || !this.element.isConnected) return this.draw();
    const questions: [string, Record<string, unknown>][] = [["object", { object: selection.object }]];
    if (selection.triangle !== null) questions.push(["triangle", { object: selection.object, triangle: selection.triangle }]);
    if (selection.vertex !== null) questions.push(["vertex", { object: selection.object, vertex: selection.vertex }]);
    await Promise.all(
      questions.map(async ([name, about]) => {
        const answer = await this.client.ask({ do: "read", ...about }).catch((error: Error) => error.message);
        if (round === this.round) this.answers.set(name, answer);
      }),
    );
    if (round === this.round) this.draw();
  }

  private rowsOf(name: string, exact: string[] = []): Row[] {
    const answer = this.answers.get(name);
    if (answer === undefined) return [];
    if (typeof answer === "string") return [["", answer]];
    return rowsOf(answer).flatMap(([key, value]): Row[] => {
      if (["id", "name", "object", "triangle", "vertex"].includes(key)) return [];
      if (key === "contacts" && Array.isArray(value)) return [["contacts", this.contactLinks(value as [number, number][])]];
      if (key === "bounds" && Array.isArray(value)) return [["from", show(value[0])], ["to", show(value[1])]];
      return [[key.replace(/_/g, " "), exact.includes(key) ? h("code", {}, showExactly(value)) : show(value)]];
    });
  }

  private contactLinks(others: [number, number][]): Node {
    if (others.length === 0) return document.createTextNode("none");
    const links = others.slice(0, 50).map(([object, triangle]) => {
      const press = () => {
        this.model.select({ object, triangle, vertex: null });
        this.fly();
      };
      return h("button", { type: "button", class: "link", onclick: press }, `${this.model.objects[object]?.name ?? object} ${triangle}`);
    });
    const more = others.length > 50 ? [`and ${others.length - 50} more`] : [];
    return h("span", { class: "links" }, ...links, ...more);
  }

  private contactRows(): Row[] {
    const { contact, frame } = this.model;
    if (!contact || !frame) return [];
    const sides = sidesOf(contact).map(({ object, elements }) => `${this.model.objects[object]!.name} ${elements.join("–")}`);
    const table: Row[] = [["between", sides.join(" and ")]];
    const place = findContact(frame, contact);
    if (place < 0) return [...table, ["now", "no longer a contact"]];
    const rows = selectableIn(frame);
    const points = pointsOf(frame, this.model.objects, rows, place);
    const center = this.model.scene!.center;
    table.push(["kind", kindAt(rows, place)], ["points", String(points.length)]);
    points.forEach((point, k) => table.push([k === 0 ? "at" : "", point.map((x, axis) => readable(x + center[axis]!)).join(", ")]));
    if (points.length > 0) table.push(["normal", show(Array.from(vectorAt(rows, "normal", place)))]);
    if (hasColumn(rows.list, "toi")) table.push(["time in step", readable(numberAt(rows, "toi", place)!)]);
    return table;
  }

  /** The heading of what the pin of the selection is about, with a button that adds or removes it. */
  private pinned(title: string): HTMLElement {
    const text = this.pins.ofSelection ? "unpin" : "pin";
    const button = h("button", { type: "button", class: "link", title: "Follow its values over time (Shift+I)", onclick: () => this.pins.toggleSelection() }, text);
    return h("div", { class: "titled" }, h("h3", {}, title), button);
  }

  private draw(): void {
    const { selection } = this.model;
    if (!selection) {
      refill(this.details, h("p", { class: "hint empty" }, "Click an object, a triangle or a contact point to read its ids and values."));
      return;
    }
    const object = this.model.objects[selection.object];
    if (!object) return;
    const parts: HTMLElement[] = [];
    const contact = this.contactRows();
    if (contact.length > 0) parts.push(this.pinned("Contact"), table(contact));
    if (selection.vertex !== null) parts.push(h("h3", {}, `Vertex ${selection.vertex}`), table(this.rowsOf("vertex", ["position"])));
    if (selection.triangle !== null) parts.push(h("h3", {}, `Triangle ${selection.triangle}`), table(this.rowsOf("triangle")));
    parts.push(
      contact.length > 0 ? h("h3", {}, object.name) : this.pinned(object.name),
      table([["object", `${object.index}, ${object.kind}`], ["size", `${readable(object.vertices)} vertices, ${readable(object.triangles)} triangles`], ...this.rowsOf("object").filter(([name]) => name !== "vertices" && name !== "triangles")]),
    );
    refill(this.details, ...parts);
  }
}
