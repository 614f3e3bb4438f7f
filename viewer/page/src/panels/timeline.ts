/** The steps that can be shown, with the events of pairs of objects, and a section that loops. */
import { OKABE_ITO } from "../colours";
import { EVENT_LABELS, type Event } from "../history";
import type { Model } from "../model";
import { EVENT_KINDS, type EventKind } from "../protocol/messages";
import { h, readable } from "./dom";

const INSET = 8;  // half the width of the slider's handle
const NEAR = 4;  // pixels
const MOST_NAMED = 3;

const DOES: Record<EventKind, [string, string]> = {
  contact: ["began to touch", "ended to touch"], narrow_phase: ["leaves began to collide", "leaves ended to collide"], volume: ["volumes began to overlap", "volumes ended to overlap"],
};

export class Timeline {
  readonly kinds = h("select", { "aria-label": "Events", title: "Events on the timeline; those of the narrow phase are in recordings made with --colliding-vertices", onchange: () => this.draw() });
  readonly slider = h("input", { type: "range", min: 0, max: 0, step: 1, value: 0, "aria-label": "Timeline", oninput: () => this.onScrub(this.slider.valueAsNumber) });
  /** The events at the pointer, or those of the last jump. */
  readonly named = h("output", { class: "named", "aria-label": "Event" });
  readonly section = h("button", { type: "button", class: "text-button section", onclick: () => this.markSection() });
  readonly element: HTMLElement;
  onScrub: (step: number) => void = () => {};
  /** The ends of a section to loop; null when it no longer loops. */
  onSection: (section: [number, number] | null) => void = () => {};
  private readonly marks = h("canvas", { class: "marks", "aria-hidden": "true" });
  private from: number | null = null;
  private looped: [number, number] | null = null;

  constructor(private readonly model: Model) {
    this.kinds.append(...EVENT_KINDS.map((kind) => h("option", { value: kind }, EVENT_LABELS[kind])));
    this.element = h("div", { class: "track" }, this.marks, this.slider);
    this.element.addEventListener("pointermove", (event) => this.point(event));
    this.element.addEventListener("pointerleave", () => this.name([]));
    model.on("history", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.element);
    this.showSection();
  }

  /** Call when there is another scene. */
  reset(): void {
    this.from = null;
    this.name([]);
    this.draw();
  }

  show(section: [number, number] | null, loops: boolean): void {
    const [first, last] = this.model.range;
    const looped = loops ? section : null;
    const isSame = this.slider.min === String(first) && this.slider.max === String(last) && looped?.join() === this.looped?.join();
    if (isSame) return;
    this.slider.min = String(first);
    this.slider.max = String(last);
    this.looped = looped;
    this.showSection();
    this.draw();
  }

  /** The first press marks the start of a section, the second its end, and the third ends the loop. */
  markSection(): void {
    const now = this.model.frame?.text.step;
    if (now === undefined) return;
    if (this.looped) this.onSection(null);
    else if (this.from === null) this.from = now;
    else {
      const [from, to] = [Math.min(this.from, now), Math.max(this.from, now)];
      this.from = null;
      if (to > from) this.onSection([from, to]);
    }
    this.showSection();
    this.draw();
  }

  private showSection(): void {
    const [text, title] = this.looped
      ? ["A–B ×", `Steps ${readable(this.looped[0])} to ${readable(this.looped[1])} loop. Press to play on (Shift+L)`]
      : this.from !== null ? ["A–…", `The section starts at step ${readable(this.from)}. Go to its end and press again (Shift+L)`] : ["A–B", "Loop a section: press at its start, and again at its end (Shift+L)"];
    this.section.textContent = text;
    this.section.title = title;
    this.section.setAttribute("aria-label", `${text} ${title}`);
    this.section.setAttribute("aria-pressed", String(this.looped !== null));
  }

  private get events() {
    return this.model.history.events[this.kinds.value as EventKind];
  }

  /** The next or previous step in which pairs of objects begin or end; names its events. */
  find(now: number, direction: 1 | -1): number | null {
    const [first, last] = this.model.range;
    const { begin, end } = this.events;
    let best: number | null = null;
    for (const { frame } of [...begin, ...end])
      if (frame >= first && frame <= last && (frame - now) * direction > 0 && (best === null || (best - frame) * direction > 0)) best = frame;
    if (best !== null) this.name([best, best]);
    return best;
  }

  private place(step: number): number {
    const [first, last] = this.model.range;
    return INSET + ((this.marks.clientWidth - 2 * INSET) * (step - first)) / Math.max(1, last - first);
  }

  private point(event: PointerEvent): void {
    const x = event.clientX - this.marks.getBoundingClientRect().left;
    const { begin, end } = this.events;
    const steps = [...begin, ...end].map(({ frame }) => frame).filter((frame) => Math.abs(this.place(frame) - x) <= NEAR);
    this.name(steps.length > 0 ? [Math.min(...steps), Math.max(...steps)] : []);
  }

  /** Names the events from one step to another. */
  private name(steps: number[]): void {
    const { begin, end } = this.events;
    const does = DOES[this.kinds.value as EventKind];
    const { objects } = this.model;
    const inside = (list: Event[], what: string) =>
      list.filter(({ frame }) => frame >= steps[0]! && frame <= steps[1]!)
        .map(({ frame, a, b }) => ({ frame, text: `${readable(frame)}: ${objects[a]?.name ?? "?"} – ${objects[b]?.name ?? "?"} ${what}` }));
    const found = steps.length === 0 ? [] : [...inside(begin, does[0]), ...inside(end, does[1])].sort((one, other) => one.frame - other.frame);
    const more = found.length > MOST_NAMED ? ` and ${readable(found.length - MOST_NAMED)} more` : "";
    this.named.textContent = found.slice(0, MOST_NAMED).map(({ text }) => text).join("; ") + more;
    this.named.title = this.named.textContent;
  }

  /** Draws begin events above the timeline, end events below it, and the section that loops. */
  draw(): void {
    const { marks } = this;
    const ratio = devicePixelRatio;
    const { clientWidth: width, clientHeight: height } = marks;
    if (width === 0) return;
    marks.width = width * ratio;
    marks.height = height * ratio;
    const context = marks.getContext("2d")!;
    context.scale(ratio, ratio);
    const [first, last] = this.model.range;
    const section = this.looped ?? (this.from === null ? null : [this.from, this.from]);
    if (section) {
      context.fillStyle = `${OKABE_ITO.orange}66`;
      const [left, right] = [this.place(section[0]!), this.place(section[1]!)];
      context.fillRect(left - 1, 0, Math.max(2, right - left + 2), height);
    }
    const { begin, end } = this.events;
    for (const [events, colour, top] of [[begin, OKABE_ITO.vermillion, 0], [end, OKABE_ITO.blue, height - 6]] as const) {
      context.fillStyle = colour;
      const columns = new Set(events.filter(({ frame }) => frame >= first && frame <= last).map(({ frame }) => Math.round(this.place(frame))));
      for (const x of columns) context.fillRect(x - 0.75, top, 1.5, 6);
    }
  }
}
