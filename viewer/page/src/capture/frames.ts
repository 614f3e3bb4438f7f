/** Saves frames as pictures: waits for each step, draws it once and stores it, however long that takes. */
import type { Client } from "../client";
import type { Model } from "../model";
import { download, readable, stamp } from "../panels/dom";
import type { FrameText } from "../protocol/messages";
import type { SceneView } from "../view/scene_view";
import { Archive } from "./archive";
import { drawFigure, ratioOf, type Figure } from "./figure";

export interface FramesPlan {
  /** The step of the first picture; null for the current one. */
  first: number | null;
  /** Number of pictures, ≥ 1. */
  count: number;
  /** Steps between two pictures, ≥ 1. */
  every: number;
  figure: Figure;
}

interface Taken {
  file: string;
  step: number;
  time: number;
}

type Keep = (picture: Blob, at: FrameText) => Promise<void>;

/** Goes to a frame of a recording, or to a later step of a simulation, and waits for it. */
export function goTo(model: Model, client: Client, wanted: number, signal: AbortSignal): Promise<FrameText> {
  const arrival = client.frameThat((frame) => frame.step === wanted, signal);
  client.send(model.can("seek") ? { do: "seek", frame: wanted } : { do: "step", count: wanted - model.frame!.text.step });
  return arrival;
}

/**
 * Takes the pictures of a plan, one after the other. The session is paused first and stays at the last step.
 * Throws a sentence when the session ends or fails, with the reason of `signal`, or what `keep` throws.
 */
export async function takeFrames(model: Model, client: Client, view: SceneView, plan: FramesPlan, signal: AbortSignal, keep: Keep): Promise<void> {
  const { figure, first, every, count } = plan;
  try {
    view.setPicture(figure.size, figure.background, ratioOf(figure, view), figure.format === "svg" || figure.scaleBar);
    await client.ask({ do: "pause" });
    const { key } = model.field;
    const isOffered = model.scene!.fields.some((form) => form.key === key);
    if (figure.colourBar && !isOffered) throw new Error(key === null ? "No field is chosen, so there is no colour bar." : `This scene has no field ${key}.`);
    let at = await client.frameThat((frame) => !frame.playing && (!isOffered || frame.field === key), signal);
    if (first !== null && at.step !== first) at = await goTo(model, client, first, signal);
    for (let taken = 1; ; ++taken) {
      const picture = drawFigure(model, view, figure);
      const hasMore = taken < count && at.step + every < (model.scene!.frames ?? Infinity);
      const next = hasMore ? goTo(model, client, at.step + every, signal) : null;  // runs while this picture is encoded
      next?.catch(() => {});  // the error is reported after the picture is stored
      await keep(await picture, at);
      if (!next) return;
      at = await next;
    }
  } catch (error) {
    throw client.status.state === "ended" ? new Error("The session has ended.") : error;
  } finally {
    view.setPicture(null);
    client.send({ do: "pause" });  // drops steps that are no longer needed
  }
}

/**
 * Takes the pictures of a plan and saves them: one picture alone, more as a ZIP with `frames.json`. If the session
 * ends or `signal` aborts, the pictures taken so far are saved.
 */
export class FramesRun {
  private readonly taken: Taken[] = [];
  private readonly archive = new Archive();
  private newest: Blob | null = null;

  constructor(
    private readonly model: Model, private readonly client: Client, private readonly view: SceneView,
    private readonly plan: FramesPlan, private readonly signal: AbortSignal, private readonly progress: (taken: number) => void,
  ) {}

  /** Returns a sentence about what was saved. */
  async go(): Promise<string> {
    let fault: string | null = null;
    try {
      await takeFrames(this.model, this.client, this.view, this.plan, this.signal, (picture, at) => this.keep(picture, at));
    } catch (error) {
      fault = (error as Error).message;
    }
    return this.save(fault);
  }

  private async keep(picture: Blob, { step, time }: FrameText): Promise<void> {
    const file = `frame_${String(step).padStart(6, "0")}.${this.plan.figure.format}`;
    if (this.plan.count > 1) await this.archive.add(file, picture);
    this.newest = picture;
    this.taken.push({ file, step, time });
    this.progress(this.taken.length);
  }

  private async save(fault: string | null): Promise<string> {
    const count = this.taken.length;
    if (count === 0) return `No picture was taken. ${fault}`;
    const isAlone = this.plan.count === 1;
    const name = `supple-${stamp()}.${isAlone ? this.plan.figure.format : "zip"}`;
    if (!isAlone) await this.archive.add("frames.json", new Blob([JSON.stringify(this.description(fault), null, 1)]));
    download(isAlone ? this.newest! : this.archive.end(), name);
    const all = count === 1 ? `The picture is saved: ${name}.` : `${readable(count)} pictures are saved: ${name}.`;
    return fault ? `${fault} ${readable(count)} of ${readable(this.plan.count)} pictures are saved: ${name}.` : all;
  }

  /** The content of `frames.json`. Positions are relative to the scene's `center`, as in all messages. */
  private description(fault: string | null): Record<string, unknown> {
    const { title, version, source, center } = this.model.scene!;
    const { figure: { size, dpi, background }, count } = this.plan;
    return {
      title, version, source, ...size, dpi, background, center, camera: this.view.rig.description(),
      planned: count, ended: fault, frames: this.taken,
    };
  }
}
