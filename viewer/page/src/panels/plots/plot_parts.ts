/** What the plots of the statistics and of pins share: axes, a mark at the present step, and the way to a step. */
import uPlot from "uplot";
import { OKABE_ITO } from "../../colours";
import { colourOf, remPixels } from "../dom";

/** No drag, because a click goes to a step. A tap moves the cursor first, which uPlot takes for a drag. */
export const CURSOR: uPlot.Cursor = { points: { show: false }, drag: { x: false, y: false, click: () => {} } };

export function axisLook(): uPlot.Axis {
  const grid = { stroke: colourOf("--line"), width: 1 };
  return { stroke: colourOf("--ink-soft"), grid, ticks: grid, font: `${remPixels() * 0.75}px system-ui` };
}

/** Calls `seek` with the number of the clicked row. The cursor of uPlot is not used: a tap need not move it. */
export function onClick(plot: uPlot, seek: (row: number) => void): void {
  plot.over.addEventListener("click", ({ clientX }) => {
    if (plot.data[0].length > 0) seek(plot.posToIdx(clientX - plot.over.getBoundingClientRect().left));
  });
}

export function markStep(plot: uPlot, step: number | undefined): void {
  if (step === undefined || plot.data[0].length === 0) return;
  const x = plot.valToPos(step, "x", true);
  const { left, top, width, height } = plot.bbox;
  if (x < left || x > left + width) return;
  plot.ctx.fillStyle = OKABE_ITO.vermillion;
  plot.ctx.fillRect(x - 0.75 * devicePixelRatio, top, 1.5 * devicePixelRatio, height);
}
