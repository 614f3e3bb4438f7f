/**
 * Draws pictures for `supple render`. The page contains the job, draws without a window, and sends each picture to
 * the program as a binary message (viewer/PROTOCOL.md).
 */
import type { Client } from "../client";
import type { Model } from "../model";
import type { Pins } from "../pins";
import type { Background, SceneView } from "../view/scene_view";
import { takeFrames } from "./frames";
import { takePlot } from "./plots";

interface Job {
  /** First, last, every n-th; null for the step of the view, or 0. A plot has all frames of a recording then. */
  frames: [number, number, number] | null;
  width: number;
  height: number;
  dpi: number;
  format: "png" | "svg";
  background: Background;
  theme: "light" | "dark";
  legend: boolean;
  scale_bar: boolean;
  colour_bar: boolean;
  /** The plot to draw instead of the scene, or null. */
  plot: string | null;
}

/** The job in this page; null in a page for people. */
export function embeddedJob(): Job | null {
  const text = document.getElementById("supple-job")?.textContent;
  return text ? (JSON.parse(text) as Job) : null;
}

/** Call when the first frame is there. Sends all pictures, then the end or what went wrong. */
export async function runJob(job: Job, step: number, model: Model, client: Client, view: SceneView, pins: Pins): Promise<void> {
  const [first, last, every] = job.frames ?? [step, step, 1];
  const { width, height, dpi, format, background } = job;
  const figure = { size: { width, height }, dpi, format, background, legend: job.legend, scaleBar: job.scale_bar, colourBar: job.colour_bar };
  try {
    if (job.plot !== null) {
      const plan = { ...job, name: job.plot, size: figure.size };
      const { plot, failure } = await takePlot(model, client, pins, plan, (step) => client.deliver({ kind: "step", step }));
      await client.deliver({ kind: "picture", step: last }, plot);
      return await (failure === null ? client.deliver({ kind: "end" }) : failJob(client, failure));
    }
    const plan = { first, count: Math.floor((last - first) / every) + 1, every, figure };
    await takeFrames(model, client, view, plan, new AbortController().signal, (picture, at) => client.deliver({ kind: "picture", step: at.step }, picture));
    await client.deliver({ kind: "end" });
  } catch (error) {
    await failJob(client, (error as Error).message);
  }
}

export const failJob = (client: Client, message: string): Promise<void> => client.deliver({ kind: "failure", message: message.replace(/\.$/, "") });
