import { download, stamp } from "../panels/dom";
import type { SceneView } from "../view/scene_view";

/**
 * Encodes the current view as PNG. The view is captured before the function returns; only the encoding is
 * asynchronous.
 */
export function takePicture(view: SceneView): Promise<Blob> {
  view.draw();  // the browser keeps the canvas only until the end of this task
  return new Promise((resolve, reject) => {
    const { fault, canvas } = view;
    if (fault) return reject(new Error(fault));
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error(`The browser does not have enough memory for a picture of ${canvas.width} × ${canvas.height}. Choose a smaller size.`))),
      "image/png",
    );
  });
}

/** Saves the view of the window. */
export async function savePicture(view: SceneView): Promise<void> {
  download(await takePicture(view), `supple-${stamp()}.png`);
}
