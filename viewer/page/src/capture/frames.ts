/** Saves frames as pictures: waits for each step, draws it once and stores it, however long that takes. */
import type { Client } from "../client";
import type { Model } from "../model";
import { download, readable, stamp } from "../panels/dom";
import type { FrameText } from "../protocol/messages";
import type { PictureSize, SceneView } from "../view/scene_view";
import { Archive } from "./archive";
import { takePicture } from "./picture";

export interface FramesPlan {
  /** Number of pictures, ≥ 1. The first shows the current step. */
  count: number;
  /** Steps between two pictures, ≥ 1. */
  every: number;
  size: PictureSize;
  /** Omits the ground and makes the background transparent. */
  transparent: boolean;
}

interface Taken {
  file: string;
  step: number;
  time: number;
}

const nameOf = (step: number): string => `frame_${String(step).padStart(6, "0")}.png`;

/**
 * Takes the pictures of a plan and saves them: one picture as PNG, more as a ZIP with `frames.json`. The
 * session is paused first and stays at the last step. If the session ends or `signal` aborts, the pictures
 * taken so far are saved.
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
      this.view.setPicture(this.plan.size, this.plan.transparent);
      await this.take();
    } catch (error) {
      fault = this.client.status.state === "ended" ? "The session has ended." : (error as Error).message;
    } finally {
      this.view.setPicture(null);
      this.client.send({ do: "pause" });  // drops steps that are no longer needed
    }
    return this.save(fault);
  }

  private async take(): Promise<void> {
    await this.client.ask({ do: "pause" });
    let at = await this.client.frameThat((frame) => !frame.playing, this.signal);
    for (;;) {
      const picture = takePicture(this.view);
      const next = this.hasMore(at) ? this.advance(at) : null;  // runs while this picture is encoded
      next?.catch(() => {});  // the error is reported after the picture is stored
      await this.keep(await picture, at);
      if (!next) return;
      at = await next;
    }
  }

  private hasMore({ step }: FrameText): boolean {
    return this.taken.length + 1 < this.plan.count && step + this.plan.every < (this.model.scene!.frames ?? Infinity);
  }

  private advance({ step }: FrameText): Promise<FrameText> {
    const wanted = step + this.plan.every;
    const arrival = this.client.frameThat((frame) => frame.step === wanted, this.signal);
    this.client.send(this.model.can("seek") ? { do: "seek", frame: wanted } : { do: "step", count: this.plan.every });
    return arrival;
  }

  private async keep(picture: Blob, { step, time }: FrameText): Promise<void> {
    const file = nameOf(step);
    if (this.plan.count > 1) await this.archive.add(file, picture);
    this.newest = picture;
    this.taken.push({ file, step, time });
    this.progress(this.taken.length);
  }

  private async save(fault: string | null): Promise<string> {
    const count = this.taken.length;
    if (count === 0) return `No picture was taken. ${fault}`;
    const isAlone = this.plan.count === 1;
    const name = `supple-${stamp()}.${isAlone ? "png" : "zip"}`;
    if (!isAlone) await this.archive.add("frames.json", new Blob([JSON.stringify(this.description(fault), null, 1)]));
    download(isAlone ? this.newest! : this.archive.end(), name);
    const all = count === 1 ? `The picture is saved: ${name}.` : `${readable(count)} pictures are saved: ${name}.`;
    return fault ? `${fault} ${readable(count)} of ${readable(this.plan.count)} pictures are saved: ${name}.` : all;
  }

  /** The content of `frames.json`. Positions are relative to the scene's `center`, as in all messages. */
  private description(fault: string | null): Record<string, unknown> {
    const { title, version, source, center } = this.model.scene!;
    const { size, transparent, count } = this.plan;
    return {
      title, version, source, ...size, transparent, center, camera: this.view.rig.description(),
      planned: count, ended: fault, frames: this.taken,
    };
  }
}
