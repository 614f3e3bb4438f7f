/** One picture of the view: its size, its background and what is drawn over it. */
import { barOf } from "../fields/colour_bar";
import { readField, showsColour } from "../fields/fields";
import type { Model } from "../model";
import { colourOf } from "../panels/dom";
import type { Background, PictureSize, SceneView } from "../view/scene_view";
import { drawOverlay, type Overlay } from "./overlay";
import { canvasPen, millimetresOf } from "./pen";
import { encode } from "./picture";
import { withResolution } from "./png";
import { svgOf } from "./svg";

/** CSS pixels per inch. */
export const CSS_DPI = 96;

export interface Figure {
  size: PictureSize;
  /** Pixels per inch: the file says it, and texts and marks have their size in print. Null: as in the window. */
  dpi: number | null;
  background: Background;
  format: "png" | "svg";
  legend: boolean;
  scaleBar: boolean;
  colourBar: boolean;
}

/** Pixels of the picture in a CSS pixel. */
export const ratioOf = ({ size, dpi }: Figure, view: SceneView): number =>
  dpi === null ? size.height / (view.canvas.clientHeight || size.height) : dpi / CSS_DPI;

function overlayOf(model: Model, view: SceneView, figure: Figure): Overlay {
  const ratio = ratioOf(figure, view);
  const { size: { width, height }, background, format, legend, scaleBar, colourBar } = figure;
  const isWhite = background === "white";
  const field = format === "svg" ? null : readField(model);  // an SVG has no fields
  return {
    width: width / ratio, height: height / ratio,
    ink: isWhite ? "#1b2027" : colourOf("--ink"),
    halo: isWhite ? "#ffffff" : background === "transparent" ? null : colourOf("--ground"),
    objects: legend ? model.objects.filter((object) => object.visible && object.vertices > 0 && showsColour(field, object)) : null,
    scale: scaleBar ? { perPixel: (view.rig.visibleHeight * ratio) / height, unit: model.unit, isPerspective: !view.rig.isOrthographic } : null,
    bar: colourBar ? barOf(model) : null,
  };
}

function svgFigure(model: Model, view: SceneView, figure: Figure): Blob {
  const overlay = overlayOf(model, view, figure);
  const { width, height, ink, halo } = overlay;
  const svg = svgOf(model, {
    width, height, ink, ground: halo, matrix: view.matrix(), usesColours: figure.legend,
    millimetres: figure.dpi === null ? null : millimetresOf(figure.size.width, figure.dpi),
  }, (pen) => drawOverlay(pen, overlay));
  return new Blob([svg], { type: "image/svg+xml" });
}

/**
 * Draws the view, which must have been set up by `SceneView.setPicture`. The view is captured before the function
 * returns; only the encoding is asynchronous.
 */
export async function drawFigure(model: Model, view: SceneView, figure: Figure): Promise<Blob> {
  view.draw();  // the browser keeps the canvas only until the end of this task
  if (view.fault) throw new Error(view.fault);
  if (figure.format === "svg") return svgFigure(model, view, figure);
  let canvas = view.canvas;
  if (figure.legend || figure.scaleBar || figure.colourBar) {
    const copy = document.createElement("canvas");
    copy.width = figure.size.width;
    copy.height = figure.size.height;
    const context = copy.getContext("2d")!;
    context.drawImage(view.canvas, 0, 0);
    drawOverlay(canvasPen(context, ratioOf(figure, view)), overlayOf(model, view, figure));
    canvas = copy;
  }
  const png = await encode(canvas);
  return figure.dpi === null ? png : withResolution(png, figure.dpi);
}
