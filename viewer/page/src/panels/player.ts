/** Play, step, speed and reset; for a recording also the timeline with its events. */
import type { Client } from "../client";
import { OKABE_ITO } from "../colours";
import { EVENT_LABELS, type Model } from "../model";
import { EVENT_KINDS, type EventKind } from "../protocol/messages";
import { h, iconButton, readable, setIcon } from "./dom";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

export class Player {
  readonly element: HTMLElement;
  playing = false;
  private looping = false;
  private speed = 1;
  private readonly play = iconButton("play", "Play", "Space", () => this.togglePlay());
  private readonly loop = iconButton("loop", "Loop", "L", () => this.toggleLoop());
  private readonly speeds = h("select", { "aria-label": "Speed", title: "Speed ([ and ])", onchange: () => this.setSpeed(Number(this.speeds.value)) });
  private readonly kinds = h("select", { "aria-label": "Events", title: "Events on the timeline; those of the narrow phase are in recordings made with --colliding-vertices", onchange: () => this.drawMarks() });
  private readonly seed = h("input", { type: "text", inputmode: "numeric", "aria-label": "Seed", title: "Seed of the next reset" });
  private readonly slider = h("input", { type: "range", min: 0, max: 0, step: 1, value: 0, "aria-label": "Timeline", oninput: () => this.scrub() });
  private readonly marks = h("canvas", { class: "marks", "aria-hidden": "true" });
  private readonly place = h("output", { class: "place", "aria-label": "Place" });
  private readonly rate = h("output", { class: "rate", "aria-label": "Rate", title: "Frames per second that the page draws, and simulated or recorded seconds per second of the clock" });
  private readonly recordingOnly: HTMLElement[];
  private readonly simulationOnly: HTMLElement[];
  private readonly always: HTMLElement[];
  private readonly reset_ = iconButton("reset", "Reset", "R", () => this.reset());
  private wanted: number | null = null;
  private asked: number | null = null;

  constructor(private readonly model: Model, private readonly client: Client) {
    const first = iconButton("back", "First frame", "Home", () => this.seek(0));
    const last = iconButton("forward", "Last frame", "End", () => this.seek(Infinity));
    const previous = iconButton("previousEvent", "Previous event", ",", () => this.jump(-1));
    const next = iconButton("nextEvent", "Next event", ".", () => this.jump(1));
    const back = h("button", { type: "button", class: "text-button", "aria-label": "−1 step", title: "Step back (←)", onclick: () => this.step(-1) }, "−1");
    const forward = h("button", { type: "button", class: "text-button", "aria-label": "+1 step", title: "Step (→)", onclick: () => this.step(1) }, "+1");
    const track = h("div", { class: "track" }, this.marks, this.slider);
    const seed = h("label", { class: "seed" }, "Seed ", this.seed);
    this.kinds.append(...EVENT_KINDS.map((kind) => h("option", { value: kind }, EVENT_LABELS[kind])));
    this.recordingOnly = [first, last, previous, next, this.kinds, back, this.loop, track];
    this.simulationOnly = [this.reset_, seed];
    this.always = [this.play, forward, this.speeds, this.place, this.rate];
    this.speeds.append(h("option", { value: 0 }, "fastest"), ...SPEEDS.map((speed) => h("option", { value: speed }, `${speed}×`)));
    this.seed.addEventListener("change", () => this.reset());
    this.element = h(
      "footer", { class: "player", "aria-label": "Player", role: "toolbar" },
      first, previous, back, this.play, forward, next, last, this.kinds, this.loop, this.reset_, seed, this.speeds, track, this.place, this.rate,
    );
    model.on("scene", () => this.build());
    model.on("frame", (frame) => this.show(frame.text));
    model.on("history", () => this.drawMarks());
    model.on("pulled", () => this.fit());
    new ResizeObserver(() => this.drawMarks()).observe(track);
  }

  private get frames(): number | null {
    return this.model.scene?.frames ?? null;
  }

  private build(): void {
    const scene = this.model.scene!;
    const isRecording = scene.source === "recording";
    const isProgram = scene.source === "program";
    const { moves } = this.model;
    for (const element of this.recordingOnly) element.hidden = !isRecording || !moves;
    for (const element of this.simulationOnly) element.hidden = isRecording || isProgram || !moves;
    for (const element of this.always) element.hidden = !moves;
    this.speeds.hidden = !moves || isProgram;  // a program has its own speed
    this.fit();
    this.speeds.querySelector<HTMLOptionElement>("option[value='0']")!.hidden = isRecording;
    this.slider.max = String(Math.max(0, (scene.frames ?? 1) - 1));
    this.seed.value = scene.seed;
    this.wanted = this.asked = null;
    this.element.classList.toggle("recording", isRecording);
    this.drawMarks();
  }

  /** Meshes at rest need no player, unless they were pulled: then only a reset brings them back. */
  private fit(): void {
    const isAtRest = !this.model.moves;
    this.element.hidden = isAtRest && !this.model.wasPulled;
    if (isAtRest) this.reset_.hidden = !this.model.wasPulled;
  }

  private show(text: { step: number; time: number; playing: boolean; speed: number; loop?: boolean }): void {
    this.setPlaying(text.playing);
    this.speed = text.speed;
    if (document.activeElement !== this.speeds) this.speeds.value = String(this.speed);
    if (text.loop !== undefined) this.setLooping(text.loop);
    if (this.asked === text.step) this.asked = null;
    if (this.asked === null && this.wanted === null) this.slider.value = String(text.step);
    const of = this.frames === null ? "" : ` / ${readable(this.frames - 1)}`;
    this.place.textContent = `${this.frames === null ? "step" : "frame"} ${readable(text.step)}${of}${this.model.scene!.time_step > 0 ? ` · ${text.time.toFixed(3)} s` : ""}`;
    this.slider.setAttribute("aria-valuetext", this.place.textContent);
  }

  /** `factor`: simulated seconds per second of the clock; null when it is not known. */
  showRate(rate: number, factor: number | null): void {
    const pace = factor === null ? "" : ` · ${factor.toPrecision(2)}× real time`;
    this.rate.textContent = rate > 0 ? `${Math.round(rate)} fps${pace}` : "";
  }

  private setPlaying(on: boolean): void {
    if (this.playing === on) return;
    this.playing = on;
    setIcon(this.play, on ? "pause" : "play", on ? "Pause" : "Play", "Space");
  }

  private setLooping(on: boolean): void {
    this.looping = on;
    this.loop.setAttribute("aria-pressed", String(on));
  }

  togglePlay(): void {
    if (!this.model.moves) return;
    this.client.send({ do: this.playing ? "pause" : "play" });
    this.setPlaying(!this.playing);
  }

  pause(): void {
    if (!this.playing) return;
    this.client.send({ do: "pause" });
    this.setPlaying(false);
  }

  step(count: number): void {
    if (count < 0 && !this.model.can("seek")) return;
    this.client.send({ do: "step", count });
    this.setPlaying(false);
  }

  toggleLoop(): void {
    if (!this.model.can("seek")) return;
    this.setLooping(!this.looping);
    this.client.send({ do: "loop", on: this.looping });
  }

  setSpeed(factor: number): void {
    this.client.send({ do: "speed", factor });
    this.speed = factor;
    this.speeds.value = String(factor);
  }

  faster(direction: 1 | -1): void {
    const at = SPEEDS.indexOf(this.speed);
    const now = at < 0 ? (direction > 0 ? SPEEDS.length - 2 : SPEEDS.length) : at;
    this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, now + direction))]!);
  }

  reset(): void {
    if (!this.model.can("reset")) return;
    const seed = this.seed.value.trim();
    this.seed.setCustomValidity("");
    this.client.ask(seed ? { do: "reset", seed } : { do: "reset" }).catch((error: Error) => {
      this.seed.setCustomValidity(`${error.message.replace(/^reset: /, "")}. The seed stays ${this.model.scene?.seed}.`);
      this.seed.reportValidity();
    });
  }

  seek(frame: number): void {
    if (this.frames === null || !this.model.can("seek")) return;
    this.wanted = Math.max(0, Math.min(this.frames - 1, frame));
    this.slider.value = String(this.wanted);
  }

  private scrub(): void {
    this.pause();
    this.seek(this.slider.valueAsNumber);
  }

  /** Sends at most one seek per drawn frame, however fast the slider moves. */
  turn(): void {
    if (this.wanted === null) return;
    if (this.wanted !== this.model.frame?.text.step) {
      this.client.send({ do: "seek", frame: this.wanted });
      this.asked = this.wanted;
    }
    this.wanted = null;
  }

  private get events() {
    return this.model.history.events[this.kinds.value as EventKind];
  }

  /** Goes to the next or previous frame in which pairs of objects begin or end. */
  jump(direction: 1 | -1): void {
    if (!this.model.can("seek")) return;
    const now = this.wanted ?? this.asked ?? this.model.frame?.text.step ?? 0;
    const { begin, end } = this.events;
    let best: number | null = null;
    for (const { frame } of [...begin, ...end])
      if ((frame - now) * direction > 0 && (best === null || (best - frame) * direction > 0)) best = frame;
    if (best === null) return;
    this.pause();
    this.seek(best);
  }

  /** Draws begin events above the timeline and end events below it. */
  private drawMarks(): void {
    const { marks, frames } = this;
    const ratio = devicePixelRatio;
    const { clientWidth: width, clientHeight: height } = marks;
    if (width === 0 || frames === null) return;
    marks.width = width * ratio;
    marks.height = height * ratio;
    const context = marks.getContext("2d")!;
    context.scale(ratio, ratio);
    const inset = 8;  // half the width of the slider's handle
    const place = (frame: number) => inset + ((width - 2 * inset) * frame) / Math.max(1, frames - 1);
    const { begin, end } = this.events;
    for (const [events, colour, top] of [[begin, OKABE_ITO.vermillion, 0], [end, OKABE_ITO.blue, height - 6]] as const) {
      context.fillStyle = colour;
      const columns = new Set(events.map(({ frame }) => Math.round(place(frame))));
      for (const x of columns) context.fillRect(x - 0.75, top, 1.5, 6);
    }
  }
}
