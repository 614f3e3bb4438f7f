/** Saves, loads and links what the page shows, and goes to the moment of a link. */
import type { Client } from "../client";
import type { Model } from "../model";
import { download, h, readable, sheet, stamp } from "../panels/dom";
import type { ViewState } from "../view_state";
import { hashOfView, readViewFile } from "./view_file";

/** A link does not take more steps of a simulation than these. */
const MOST_STEPS = 100_000;

interface Page {
  view(): ViewState;
  apply(view: Partial<ViewState>): void;
  say(text: string): void;
}

export class Views {
  readonly element: HTMLElement;
  readonly dialog: HTMLDialogElement;
  private readonly link = h("input", { type: "text", readonly: true, "aria-label": "Link", onfocus: () => this.link.select() });
  private readonly file = h("input", { type: "file", accept: ".json,application/json", hidden: true, "aria-label": "View file", onchange: () => this.load(this.file.files![0]) });

  constructor(private readonly model: Model, private readonly client: Client, private readonly page: Page) {
    const button = (label: string, title: string, press: () => void) => h("button", { type: "button", class: "link", title, onclick: press }, label);
    this.element = h(
      "section", { "aria-label": "View file" }, h("h2", {}, "View file"),
      h("div", { class: "links", role: "group", "aria-label": "View file" },
        button("Save view", "Saves camera, layers and colours as a file, for this page and for supple render", () => this.save()),
        button("Load view…", "Or drop a view file on the page", () => this.file.click()),
        button("Copy link", "Copies an address that opens this view at this moment", () => void this.copyLink())),
      this.file,
    );
    this.dialog = sheet("Link to this moment", "share", this.link, h("p", { class: "hint" }, "The browser does not let the page copy it."));
    document.addEventListener("dragover", (event) => event.dataTransfer?.types.includes("Files") && event.preventDefault());
    document.addEventListener("drop", (event) => {
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      this.load(file);
    });
  }

  private save(): void {
    if (!this.model.scene) return;
    download(new Blob([JSON.stringify(this.page.view(), null, 1)], { type: "application/json" }), `supple-view-${stamp()}.json`);
  }

  private load(file: File | undefined): void {
    this.file.value = "";  // the same file can be chosen again
    if (!file || !this.model.scene) return;
    readViewFile(file).then((view) => this.page.apply(view), (error: Error) => this.page.say(error.message));
  }

  private async copyLink(): Promise<void> {
    const step = this.model.frame?.text.step;
    const address = location.href.replace(/#.*/, "") + (await hashOfView({ ...this.page.view(), ...(step !== undefined && { step }) }));
    try {
      await navigator.clipboard.writeText(address);
      this.page.say("The link to this moment is copied.");
    } catch {
      this.link.value = address;
      this.dialog.showModal();
      this.link.focus();
    }
  }

  /** Goes to a step, once there is a frame and the session is paused. Says why when it cannot. */
  goTo(step: number): void {
    const { scene, frame } = this.model;
    const now = frame!.text.step;
    if (now === step) return;
    const [first, last] = this.model.range;
    if (step >= first && step <= last) return this.client.send({ do: "seek", frame: step });
    if (scene!.frames !== null) return this.page.say(`The link shows frame ${readable(step)}, but the last one is ${readable(last)}.`);
    if (step > now && step - now <= MOST_STEPS && scene!.source === "simulation") return this.client.send({ do: "step", count: step - now });
    this.page.say(`The link shows step ${readable(step)}, but the page has steps ${readable(first)} to ${readable(last)}. ${this.model.can("reset") ? "Reset, then open the link again." : "This program cannot go there."}`);
  }
}
