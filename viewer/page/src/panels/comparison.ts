/** Two recordings: where they differ first, and which of them is shown. */
import { usualLook, type Model } from "../model";
import { h, readable } from "./dom";

const CHOICES = ["both", "beside", "A", "B"] as const;
type Choice = (typeof CHOICES)[number];

export class ComparisonPanel {
  readonly element = h("section", { "aria-label": "Comparison", hidden: true });
  private readonly sentence = h("p", { role: "status", "aria-label": "First difference" });
  private readonly go = h("button", { type: "button", class: "link", onclick: () => this.seek(this.model.scene!.comparison!.frame!) }, "Go there");
  private readonly choices = new Map<Choice, HTMLInputElement>();

  constructor(private readonly model: Model, private readonly seek: (frame: number) => void) {
    model.on("scene", () => this.build());
    model.on("display", () => this.refresh());
  }

  private build(): void {
    const comparison = this.model.scene!.comparison;
    this.element.hidden = comparison === null;
    if (!comparison) return;
    const { frame, text, names } = comparison;
    this.sentence.textContent = text === "" ? "The two recordings are equal." : frame === null ? `They differ: ${text}` : `They differ first in frame ${readable(frame)}: ${text}`;
    this.go.hidden = frame === null;
    this.choices.clear();
    const label: Record<Choice, string> = { both: "Over each other, B transparent", beside: "Side by side", A: `A: ${names[0]}`, B: `B: ${names[1]}` };
    const rows = CHOICES.map((choice) => {
      const input = h("input", { type: "radio", name: "compared", onchange: () => this.show(choice) });
      this.choices.set(choice, input);
      return h("label", { class: "check" }, input, label[choice]);
    });
    this.element.replaceChildren(h("h2", {}, "Comparison"), this.sentence, this.go, h("div", { role: "radiogroup", "aria-label": "Recordings" }, ...rows));
    this.refresh();
  }

  private isOfA(index: number): boolean {
    return index < this.model.scene!.comparison!.objects_of_a;
  }

  private show(choice: Choice): void {
    for (const object of this.model.objects) {
      object.visible = choice === "both" || choice === "beside" || (choice === "A") === this.isOfA(object.index);
      // A recording that hides nothing is opaque.
      object.opacity = choice === "B" || choice === "beside" ? 1 : usualLook(this.model.scene!, object.index).opacity;
    }
    this.model.setSideBySide(choice === "beside");
    this.model.emit("display", null);
    this.model.emit("request", null);
  }

  private refresh(): void {
    if (!this.model.scene?.comparison) return;
    const { objects } = this.model;
    const sees = (a: boolean) => objects.some(({ index, visible }) => visible && this.isOfA(index) === a);
    const choice: Choice = sees(true) && sees(false) ? (this.model.shift !== 0 ? "beside" : "both") : sees(true) ? "A" : "B";
    this.choices.get(choice)!.checked = true;
  }
}
