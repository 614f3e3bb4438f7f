/** Play, step, speed and reset, and the timeline of a recording or of the steps that a session keeps. */
import type { Client } from "../client";
import type { Model } from "../model";
import type { FrameText } from "../protocol/messages";
import { h, iconButton, readable, setIcon } from "./dom";
import { Timeline } from "./timeline";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

export class Player {
  readonly element: HTMLElement;
  playing = false;
  private looping = false;
  private speed = 1;
  private readonly play = iconButton("play", "Play", "Space", () => this.togglePlay());
  private readonly loop = iconButton("loop", "Loop", "L", () => this.toggleLoop());
  private readonly speeds = h("select", { "aria-label": "Speed", title: "Speed ([ and ])", onchange: () => this.setSpeed(Number(this.speeds.value)) });
  private readonly seed = h("input", { type: "text", inputmode: "numeric", "aria-label": "Seed", title: "Seed of the next reset" });
  private readonly timeline: Timeline;
  private readonly newest = h("button", { type: "button", class: "text-button past", title: "Go to the newest step (End)", hidden: true, onclick: () => this.seek(Infinity) }, "Newest step");
  private readonly place = h("output", { class: "place", "aria-label": "Place" });
  private readonly rate = h("output", { class: "rate", "aria-label": "Rate", title: "Frames per second that the page draws, and simulated or recorded seconds per second of the clock" });
  private readonly seekable: HTMLElement[];
  private readonly simulationOnly: HTMLElement[];
  private readonly always: HTMLElement[];
  private readonly reset_ = iconButton("reset", "Reset", "R", () => this.reset());
  /** Commands to play or pause without an answer yet: frames that were sent before do not know of them. */
  private unanswered = 0;
  private wanted: number | null = null;
  private asked: number | null = null;

  constructor(private readonly model: Model, private readonly client: Client) {
    const first = iconButton("back", "First frame", "Home", () => this.seek(-Infinity));
    const last = iconButton("forward", "Last frame", "End", () => this.seek(Infinity));
    const previous = iconButton("previousEvent", "Previous event", ",", () => this.jump(-1));
    const next = iconButton("nextEvent", "Next event", ".", () => this.jump(1));
    const back = h("button", { type: "button", class: "text-button", "aria-label": "−1 step", title: "Step back (←)", onclick: () => this.step(-1) }, "−1");
    const forward = h("button", { type: "button", class: "text-button", "aria-label": "+1 step", title: "Step (→)", onclick: () => this.step(1) }, "+1");
    const timeline = (this.timeline = new Timeline(model));
    timeline.onScrub = (step) => this.goTo(step);
    timeline.onSection = (section) => this.loopSection(section);
    const seed = h("label", { class: "seed" }, "Seed ", this.seed);
    this.seekable = [first, last, previous, next, timeline.kinds, back, this.loop, timeline.section, timeline.element, timeline.named];
    this.simulationOnly = [this.reset_, seed];
    const readout = h("div", { class: "readout" }, timeline.named, this.newest, this.place, this.rate);
    this.always = [this.play, forward, this.speeds, readout];
    this.speeds.append(h("option", { value: 0 }, "fastest"), ...SPEEDS.map((speed) => h("option", { value: speed }, `${speed}×`)));
    this.seed.addEventListener("change", () => this.reset());
    this.element = h(
      "footer", { class: "player", "aria-label": "Player", role: "toolbar" },
      first, previous, back, this.play, forward, next, last, timeline.kinds, this.loop, timeline.section, this.reset_, seed, this.speeds, timeline.element, readout,
    );
    model.on("scene", () => this.build());
    model.on("frame", (frame) => this.show(frame.text));
    model.on("pulled", () => this.fit());
  }

  /** Whether there are steps to go to. */
  private get canSeek(): boolean {
    const [first, last] = this.model.range;
    return this.model.moves && last > first;
  }

  /** Whether there are steps to go to, or will be: then the bar has the controls from the start, and none moves later. */
  private get keepsSteps(): boolean {
    return this.canSeek || (this.model.moves && this.model.history.frames.length < 2);
  }

  private build(): void {
    const scene = this.model.scene!;
    const isRecording = scene.source === "recording";
    const isProgram = scene.source === "program";
    const { moves } = this.model;
    for (const element of this.simulationOnly) element.hidden = isRecording || isProgram || !moves;
    for (const element of this.always) element.hidden = !moves;
    this.speeds.hidden = !moves || isProgram;  // a program has its own speed
    this.fit();
    this.speeds.querySelector<HTMLOptionElement>("option[value='0']")!.hidden = isRecording;
    this.seed.value = scene.seed;
    this.wanted = this.asked = null;
    this.timeline.reset();
    this.fitTimeline();
  }

  private fitTimeline(): void {
    for (const element of this.seekable) element.hidden = !this.keepsSteps;
  }

  /** Meshes at rest need no player, unless they were pulled: then only a reset brings them back. */
  private fit(): void {
    const isAtRest = !this.model.moves;
    this.element.hidden = isAtRest && !this.model.wasPulled;
    if (isAtRest) this.reset_.hidden = !this.model.wasPulled;
  }

  private show(text: FrameText): void {
    const isRecording = this.model.scene!.source === "recording";
    if (this.unanswered === 0) this.setPlaying(text.playing);
    this.speed = text.speed;
    if (document.activeElement !== this.speeds) this.speeds.value = String(this.speed);
    if (text.loop !== undefined) this.setLooping(text.loop);
    if (this.seekable[0]!.hidden === this.keepsSteps) this.fitTimeline();
    this.timeline.show(text.section, text.loop === true);
    const { slider } = this.timeline;
    // Not every step of a program is kept.
    if (this.asked === text.step || this.model.scene!.source === "program") this.asked = null;
    if (this.asked === null && this.wanted === null) slider.value = String(text.step);
    const of = isRecording || text.past ? ` / ${readable(text.range[1])}` : "";
    this.newest.hidden = !text.past;
    this.place.textContent = `${isRecording ? "frame" : "step"} ${readable(text.step)}${of}${this.model.scene!.time_step > 0 ? ` · ${text.time.toFixed(3)} s` : ""}`;
    slider.setAttribute("aria-valuetext", this.place.textContent);
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
    if (this.model.moves) this.tell({ do: this.playing ? "pause" : "play" }, !this.playing);
  }

  pause(): void {
    if (this.playing) this.tell({ do: "pause" }, false);
  }

  private tell(command: Record<string, unknown>, playing: boolean): void {
    this.unanswered += 1;
    const answered = (): void => void (this.unanswered -= 1);
    this.client.ask(command).then(answered, answered);
    this.setPlaying(playing);
  }

  /** Pauses at a step. */
  goTo(step: number): void {
    this.pause();
    this.seek(step);
  }

  step(count: number): void {
    if (count < 0 && !this.canSeek) return;
    this.tell({ do: "step", count }, false);
  }

  toggleLoop(): void {
    if (!this.canSeek) return;
    this.setLooping(!this.looping);
    this.client.send({ do: "loop", on: this.looping });
  }

  markSection(): void {
    if (this.canSeek) this.timeline.markSection();
  }

  private loopSection(section: [number, number] | null): void {
    if (!section) return this.client.send({ do: "loop", on: false });
    this.client.send({ do: "seek", frame: section[0] });
    this.client.send({ do: "loop", on: true, from: section[0], to: section[1] });
    this.client.send({ do: "play" });
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

  seek(step: number): void {
    if (!this.canSeek) return;
    const [first, last] = this.model.range;
    if (Number.isFinite(step) && step < first) {
      this.client.emit("notice", `Step ${readable(step)} is no longer kept. Steps ${readable(first)} to ${readable(last)} are.`);
      return;
    }
    this.wanted = Math.max(first, Math.min(last, step));
    this.timeline.slider.value = String(this.wanted);
  }

  /** Sends at most one seek per drawn frame, however fast the slider moves. */
  turn(): void {
    if (this.wanted === null) return;
    this.client.send({ do: "seek", frame: this.wanted });
    this.asked = this.wanted;
    this.wanted = null;
  }

  /** Goes to the next or previous step in which pairs of objects begin or end. */
  jump(direction: 1 | -1): void {
    if (!this.canSeek) return;
    const best = this.timeline.find(this.wanted ?? this.asked ?? this.model.frame?.text.step ?? 0, direction);
    if (best === null) return;
    this.goTo(best);
  }
}
