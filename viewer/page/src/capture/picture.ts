import { download, stamp } from "../panels/dom";
import type { SceneView } from "../view/scene_view";

/** Encodes what a canvas shows now as PNG. */
export function encode(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) => {
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error(`The browser does not have enough memory for a picture of ${canvas.width} × ${canvas.height}. Choose a smaller size.`))),
      "image/png",
    );
  });
}

/** Saves the view of the window. */
export async function savePicture(view: SceneView): Promise<void> {
  view.draw();  // the browser keeps the canvas only until the end of this task
  if (view.fault) throw new Error(view.fault);
  download(await encode(view.canvas), `supple-${stamp()}.png`);
}
